//! Point lights: a ball that touches a group reaches it.

use glam::DVec3;
use proptest::prelude::*;

use crate::cases::{aim, group};
use crate::deterministic;

proptest! {
    #![proptest_config(deterministic(6_000))]

    #[test]
    fn a_ball_within_range_reaches(group in group(), aims in prop::collection::vec(aim(false), 4)) {
        let bounds = group.bounds();
        for aim in aims {
            let light = aim.light(&group);
            let center = light.position.as_dvec3();
            let range = f64::from(light.range_m);
            let distance = group.hull(center, range).distance(DVec3::ZERO);
            if distance <= range {
                for sat_n in [false, true] {
                    prop_assert!(
                        bounds.reaches(&light, sat_n),
                        "tight by {:e} m of {range:e} m, sat_n {sat_n}: {light:?}",
                        range - distance,
                    );
                }
            }
        }
    }
}
