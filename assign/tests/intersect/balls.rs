//! Point lights: a ball that touches a group must reach the group.

use glam::DVec3;
use proptest::prelude::*;

use crate::aims::{Kind, aim};
use crate::cases::group;
use crate::deterministic;
use crate::groups::{UNIONS, box_of, union};

proptest! {
    #![proptest_config(deterministic(6_000))]

    #[test]
    fn a_ball_within_range_reaches(group in group(), aims in prop::collection::vec(aim(Kind::Point), 4)) {
        let bounds = group.bounds();
        for aim in aims {
            let light = aim.light(&group);
            let center = light.position.as_dvec3();
            let range = f64::from(light.range_m);
            let distance = group.hull(center, range).distance(DVec3::ZERO);
            if distance <= range {
                for tests in UNIONS {
                    prop_assert!(
                        bounds.reaches(&light, union(tests)),
                        "{tests} is too tight by {:e} m, at a range of {range:e} m: {light:?}",
                        range - distance,
                    );
                }
                let (min_world, max_world) = box_of(&light);
                prop_assert!(bounds.reaches_box(min_world, max_world), "the box test misses a light that reaches: {light:?}");
            }
        }
    }
}
