//! Computes mip chains, averaged in linear light.

use std::sync::LazyLock;

use scenes::{Encoding, Image};

/// The linear value of an sRGB byte.
pub(crate) static TO_LINEAR: LazyLock<[f32; 256]> = LazyLock::new(|| {
    std::array::from_fn(|byte| {
        let v = byte as f32 / 255.0;
        if v <= 0.04045 { v / 12.92 } else { ((v + 0.055) / 1.055).powf(2.4) }
    })
});

/// The sRGB byte of a linear value, from a table of 4,096 steps.
static TO_SRGB: LazyLock<[u8; 4096]> = LazyLock::new(|| {
    std::array::from_fn(|step| (linear_to_srgb(step as f32 / 4095.0) * 255.0 + 0.5) as u8)
});

/// sRGB's transfer function, 0..1 to 0..1.
pub(crate) fn linear_to_srgb(v: f32) -> f32 {
    if v <= 0.003_130_8 { 12.92 * v } else { 1.055 * v.powf(1.0 / 2.4) - 0.055 }
}

/// All levels of an image, largest first, and their number.
pub(crate) fn mip_chain(image: &Image) -> (u32, Vec<u8>) {
    let mut bytes = image.rgba.clone();
    let mut size = [image.width as usize, image.height as usize];
    let mut first = 0;
    let mut levels = 1;
    while size != [1, 1] {
        let level = halve(&bytes[first..], size, image.encoding);
        first = bytes.len();
        bytes.extend_from_slice(&level);
        size = size.map(|s| (s / 2).max(1));
        levels += 1;
    }
    (levels, bytes)
}

/// The next smaller level: each texel is the average of the texels that it covers.
fn halve(level: &[u8], size: [usize; 2], encoding: Encoding) -> Vec<u8> {
    let half = size.map(|s| (s / 2).max(1));
    let mut out = Vec::with_capacity(half[0] * half[1] * 4);
    for y in 0..half[1] {
        let rows = covered(y, half[1], size[1]);
        for x in 0..half[0] {
            let columns = covered(x, half[0], size[0]);
            let count = (rows.len() * columns.len()) as f32;
            for channel in 0..4 {
                let linear = encoding == Encoding::Linear || channel == 3;
                let mut sum = 0.0;
                for row in rows.clone() {
                    for column in columns.clone() {
                        let byte = level[(row * size[0] + column) * 4 + channel];
                        sum += if linear { f32::from(byte) } else { TO_LINEAR[usize::from(byte)] };
                    }
                }
                let mean = sum / count;
                out.push(if linear {
                    (mean + 0.5) as u8
                } else {
                    TO_SRGB[(mean * 4095.0 + 0.5) as usize]
                });
            }
        }
    }
    out
}

/// The texels of the larger level under texel `i` of the smaller one: two, or three at an odd end.
fn covered(i: usize, half: usize, full: usize) -> std::ops::Range<usize> {
    let end = if i + 1 == half { full } else { 2 * i + 2 };
    2 * i..end.min(full).max(2 * i + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: u32, height: u32, encoding: Encoding, texel: impl Fn(u32) -> [u8; 4]) -> Image {
        Image {
            name: "test".into(),
            width,
            height,
            rgba: (0..width * height).flat_map(texel).collect(),
            encoding,
        }
    }

    #[test]
    fn levels_end_at_one_texel() {
        let (levels, bytes) = mip_chain(&image(5, 3, Encoding::Linear, |_| [7; 4]));
        // The levels are 5x3, 2x1 and 1x1.
        assert_eq!((levels, bytes.len()), (3, (15 + 2 + 1) * 4));
        assert!(bytes.iter().all(|&b| b == 7));
    }

    #[test]
    fn colours_average_in_linear_light() {
        let checker = |i: u32| if i.is_multiple_of(2) { [255; 4] } else { [0, 0, 0, 255] };
        let (_, bytes) = mip_chain(&image(2, 1, Encoding::Srgb, checker));
        // Half of full light is 188 in sRGB, not 128.
        assert_eq!(bytes[8..], [188, 188, 188, 255]);
    }
}
