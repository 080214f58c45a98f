//! The constants of the laws of motion as WESL, so that `law.rs` is their only source.

use std::{f32::consts::TAU, fmt::Write};

use super::{
    MotionLaw,
    law::{
        AMPLITUDE, AXIS, DEATH, DRIFT_WAY, JUMP_SHARE, JUMPERS, JUMPS, LAW, LEVEL, MAX_HZ, PACE,
        PLACE, SINE, START, STEPS, WANDER_SHARE, WAVE, WAVE_RATIO,
    },
};

/// A WESL module with the constants of the laws, under their names in `law.rs`. [`MotionLaw::Drift`]
/// is `LAW_DRIFT`, and so on.
pub fn motion_constants() -> String {
    let mut wesl = String::from("// The constants of the laws of motion.\n");
    // Writing to a string cannot fail.
    for (name, value) in [
        ("WANDER_SHARE", WANDER_SHARE),
        ("DRIFT_WAY", DRIFT_WAY),
        ("WAVE_RATIO", WAVE_RATIO),
        ("JUMP_SHARE", JUMP_SHARE),
        ("MAX_HZ", MAX_HZ),
        ("STEPS", STEPS),
        ("TAU", TAU),
    ] {
        let _ = writeln!(wesl, "const {name}: f32 = {value:?}f;");
    }
    for (name, values) in [("WAVE", &WAVE[..]), ("SINE", &SINE[..])] {
        for (ix, value) in values.iter().enumerate() {
            let _ = writeln!(wesl, "const {name}_{ix}: f32 = {value:?}f;");
        }
    }
    for (name, value) in [
        ("JUMPERS", JUMPERS),
        ("DEATH", DEATH),
        ("AMPLITUDE", AMPLITUDE),
        ("PACE", PACE),
        ("START", START),
        ("AXIS", AXIS),
        ("JUMPS", JUMPS),
        ("PLACE", PLACE),
        ("LEVEL", LEVEL),
        ("LAW", LAW),
    ] {
        let _ = writeln!(wesl, "const {name}: u32 = {value}u;");
    }
    for law in MotionLaw::LIST {
        let name = law.name().to_uppercase();
        let _ = writeln!(wesl, "const LAW_{name}: u32 = {}u;", law as u32);
    }
    wesl
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_keep_their_bits() {
        let wesl = motion_constants();
        let float = |name: &str| -> f32 {
            let (_, rest) = wesl.split_once(&format!("const {name}: f32 = ")).expect("named");
            rest.split_once("f;").expect("a suffix").0.parse().expect("a number")
        };
        assert_eq!([float("STEPS"), float("MAX_HZ"), float("TAU")], [STEPS, MAX_HZ, TAU]);
        assert_eq!([0, 1, 2, 3, 4].map(|ix| float(&format!("SINE_{ix}"))), SINE);
        assert_eq!([0, 1].map(|ix| float(&format!("WAVE_{ix}"))), WAVE);
        assert!(wesl.contains("const LAW_DRIFT: u32 = 0u;\n"), "{wesl}");
        assert!(wesl.contains("const LAW_ALL: u32 = 6u;\n"), "{wesl}");
    }
}
