use assign::Gpu;

use super::super::{Axis, GREY, Method, Role, StrategyId};
use super::*;
use crate::choice::Choice;

fn with_role(role: Role) -> Vec<&'static str> {
    rows().filter(|row| row.role == role).map(|row| row.family).collect()
}

#[test]
fn one_row_has_each_role_that_others_are_compared_with() {
    assert_eq!(with_role(Role::Baseline), [BASELINE]);
    assert_eq!(with_role(Role::EarlyExit), [EARLY_EXIT]);
    assert_eq!(with_role(Role::Control), [CONTROL]);
    assert_eq!(with_role(Role::ComparisonPaper).len(), 8, "table 4.3 of the paper, and M");
    assert_eq!(row(RASTER_SPHERE).map(|row| row.tolerance.is_some()), Some(true));
}

#[test]
fn families_differ_without_regard_to_case() {
    let mut families: Vec<String> = rows().map(|row| row.family.to_lowercase()).collect();
    let count = families.len();
    families.sort();
    families.dedup();
    assert_eq!(families.len(), count);
}

#[test]
fn rows_say_what_their_strategies_say() {
    let gpu = Gpu::noop().expect("a device");
    for row in rows() {
        let choice = Choice::parse(row.family).expect("a choice");
        let Method::Lists { strategy, .. } = choice.make(&gpu).expect("a method") else {
            assert!(!row.has_groups, "{}", row.family);
            continue;
        };
        assert_eq!(strategy.needs(), row.needs, "{}", row.family);
        assert_eq!(row.has_axis(Axis::Cap), row.has_axis(Axis::Reuse), "{}", row.family);
        if row.has_groups && row.family != made_up::FAMILY {
            assert_eq!(strategy.id(), row.default_id());
        }
    }
}

/// The id that the registry writes and the one that the strategy says of itself are one.
#[test]
fn ids_are_those_of_the_strategies() {
    let gpu = Gpu::noop().expect("a device");
    for id in [
        "T-I/hs/bvh",
        "T-E/16x16/ball/hs+sat-p",
        "HalfZ/bvh/mask",
        "ModifiedHalfZ/16x16",
        "T-25D/hs/bvh",
        "DC-I/40x40x24/bvh",
        "DC-I/even/hs",
        "SC-E/near5/n6/bvh/mask",
        "DC-E/ball",
        "SC-I/hs",
        "SC-E/n24/s0.001/bvh",
        "SC-E/n6/cone45",
        "SC-E/dif/bvh",
        "SC-E/cascades2/reach8/bvh",
        "G/8x8x8/supports/bvh",
        "G/surfaces/ball",
        "G/8x8x8/frustum/bvh",
        "G/visible/mask",
        "HC/24/bvh",
        "HC/ball",
        "M/2/bvh",
        "M/0.5/ball",
        "HG/32x32x8",
        "T-E/bvh/reuse4",
        "W",
        "W/bvh",
        "T-E1/16x16/hs/bvh",
        "T-I/prune",
        "T-I/tree",
        "SC-E/bvh/scalar",
        "SC-E/96x96x16/bvh/prune",
        "ZB/hs/bvh",
        "T-I/16x16/hs/bvh/rect",
        "DC-I/mask/rect/half",
        "SC-E/half/unordered",
        "T-E/half/plain-depth",
        "W1",
    ] {
        let choice = Choice::parse(id).expect(id);
        let Method::Lists { strategy, .. } = choice.make(&gpu).expect(id) else { panic!("{id}") };
        assert_eq!(strategy.id(), choice.id().as_str());
    }
}

/// Whether a name can end a CSS class and an HTML id: `strategy-sc-e`.
fn is_class(name: &str) -> bool {
    name.starts_with(|c: char| c.is_ascii_alphabetic())
        && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '-')
}

#[test]
fn families_can_name_classes() {
    for bad in ["2.5D", "Z+", "A B", "a/b", "", "\u{e9}"] {
        assert!(!is_class(bad), "{bad:?}");
    }
    for row in rows() {
        assert!(is_class(row.family) && is_class(&row.class()), "{}", row.family);
    }
}

#[test]
fn a_row_that_forgets_how_it_is_made_cannot_be_made() {
    let gpu = Gpu::noop().expect("a device");
    let made = (Row::PLAIN.make)(&gpu, &Default::default());
    assert!(made.is_err_and(|error| error.to_string().starts_with("make is missing")));
}

#[test]
fn the_default_comparison_is_in_the_rows() {
    assert_eq!(default_ids(), "None,Sphere,DC-I,SC-E/bvh");
    for row in rows() {
        let family = row.in_default.map(|id| StrategyId::read(id).family().to_owned());
        assert!(family.is_none_or(|family| family == row.family), "{}", row.family);
    }
}

#[test]
fn rows_are_complete() {
    for row in rows() {
        let family = row.family;
        for text in [row.name, row.about, row.source, row.krate] {
            assert!(!text.is_empty() && !text.contains("  "), "{family}: {text:?}");
        }
        let needs_lists = |axis: &Axis| !matches!(axis, Axis::Source | Axis::Exit);
        assert!(row.has_groups || !row.axes.iter().any(needs_lists), "{family}");
        assert!(row.parameters.is_empty() == row.sizes.few.is_empty(), "{family}: sizes to search");
        assert!(!row.sizes.few.contains(&row.default), "{family}: advice has measured the default");
        assert!(
            row.parameters.is_empty()
                || row.default.is_empty()
                || row.sizes.many.contains(&row.default)
        );
        for refusal in row.refuses {
            assert!(!refusal.modes.is_empty() && !refusal.why.is_empty(), "{family}");
        }
        assert!(StrategyId::read(family).row().is_some(), "{family}");
    }
}

/// OKLab of an sRGB colour such as `#0f8a77` (Ottosson 2020), and its relative luminance (WCAG 2).
fn lab_and_luminance(hex: &str) -> ([f64; 3], f64) {
    let channel = |at: usize| {
        let value = u8::from_str_radix(&hex[at..at + 2], 16).expect(hex);
        let value = f64::from(value) / 255.0;
        if value <= 0.04045 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
    };
    let [r, g, b] = [channel(1), channel(3), channel(5)];
    let l = (0.4122214708 * r + 0.5363325363 * g + 0.0514459929 * b).cbrt();
    let m = (0.2119034982 * r + 0.6806995451 * g + 0.1073969566 * b).cbrt();
    let s = (0.0883024619 * r + 0.2817188376 * g + 0.6299787005 * b).cbrt();
    let lab = [
        0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s,
        1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s,
        0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s,
    ];
    (lab, 0.2126 * r + 0.7152 * g + 0.0722 * b)
}

#[test]
fn colours_are_readable_and_differ() {
    // The least distance of two of the nine colours that charts had before, and the least contrast of
    // graphics (WCAG 2, criterion 1.4.11).
    const DISTANCE: f64 = 0.055;
    const CONTRAST: f64 = 3.0;
    for (paper, pick) in [
        ("#fdfdfb", (|row: &Row| row.colour.light) as fn(&Row) -> &'static str),
        ("#141618", |row| row.colour.dark),
    ] {
        let (_, paper) = lab_and_luminance(paper);
        let coloured: Vec<&Row> = rows().filter(|row| row.colour != GREY).collect();
        assert!(rows().all(|row| row.colour != GREY || !row.has_groups));
        for (ix, row) in coloured.iter().enumerate() {
            let (lab, luminance) = lab_and_luminance(pick(row));
            let (low, high) = (luminance.min(paper), luminance.max(paper));
            let contrast = (high + 0.05) / (low + 0.05);
            assert!(contrast >= CONTRAST, "{}: contrast {contrast}", row.family);
            for other in &coloured[..ix] {
                let (theirs, _) = lab_and_luminance(pick(other));
                let square: f64 = lab.iter().zip(theirs).map(|(a, b)| (a - b).powi(2)).sum();
                let names = (row.family, other.family);
                assert!(square.sqrt() >= DISTANCE, "{names:?}: {} apart", square.sqrt());
            }
        }
    }
}
