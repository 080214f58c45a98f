//! Values that cause trouble in readers.

use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use serde_json::{Value, json};

/// One element of a list.
pub(crate) fn any<'a, T: ?Sized>(list: &[&'a T], rng: &mut Pcg64Mcg) -> &'a T {
    list[rng.random_range(0..list.len())]
}

/// A float that is not a usable place or size, or is far away.
pub(crate) fn float(rng: &mut Pcg64Mcg) -> f32 {
    let odd = [
        f32::NAN,
        f32::INFINITY,
        f32::NEG_INFINITY,
        f32::MAX,
        f32::MIN_POSITIVE,
        f32::from_bits(1),
        -0.0,
        0.0,
        1e-30,
        1e11,
        -3e7,
        1.0,
    ];
    odd[rng.random_range(0..odd.len())]
}

/// Text with odd characters, or a lot of it.
pub(crate) fn text(rng: &mut Pcg64Mcg) -> String {
    let long = "long name ".repeat(rng.random_range(1..20_000));
    let odd = [
        "",
        " ",
        ".",
        "..",
        "../up.bin",
        "/dev/zero",
        "/etc/passwd",
        "%",
        "%00",
        "%2e%2e%2fup.bin",
        "part.bin",
        "part.png",
        "link.bin",
        "gone.bin",
        "\u{1b}[31m\n",
        "\u{202e}rtl",
        "data:,",
        "data:;base64,",
        "data:;base64,AAAA",
        "data:image/png;base64,iVBORw0KGgo",
        "http://x/y.bin",
        "C:\\x",
        "perspective",
        "SCALAR",
        "VEC3",
        "MASK",
        "BLEND",
        "translation",
        "weights",
        "CUBICSPLINE",
        "directional",
        "spot",
        "image/webp",
        "KHR_draco_mesh_compression",
        "EXT_unheard_of",
        &long,
    ];
    any(&odd, rng).to_owned()
}

/// A value of any kind.
pub(crate) fn value(rng: &mut Pcg64Mcg) -> Value {
    let deep = |depth: usize| {
        let text = format!("{}{}", "[".repeat(depth), "]".repeat(depth));
        serde_json::from_str(&text).unwrap_or(Value::Null)
    };
    match rng.random_range(0..10) {
        0..4 => {
            let odd = [
                json!(0),
                json!(1),
                json!(2),
                json!(3),
                json!(7),
                json!(-1),
                json!(255),
                json!(65_535),
                json!(100_000),
                json!(1 << 24),
                json!(u32::MAX),
                json!(1_u64 << 40),
                json!(u64::MAX),
                json!(i64::MIN),
                json!(5120),
                json!(5121),
                json!(5123),
                json!(5125),
                json!(5126),
            ];
            odd[rng.random_range(0..odd.len())].clone()
        }
        4..6 => {
            let odd = [1e30, -1e30, 1e300, 1e-300, 0.5, -0.5, 1e-45, 3.5e38, 1e7, 1e12];
            json!(odd[rng.random_range(0..odd.len())])
        }
        6..8 => json!(text(rng)),
        8 => {
            let odd = [
                json!(null),
                json!(true),
                json!([]),
                json!({}),
                json!([0]),
                json!([[1.0, 2.0, 3.0]]),
            ];
            odd[rng.random_range(0..odd.len())].clone()
        }
        _ => deep(rng.random_range(1..120)),
    }
}
