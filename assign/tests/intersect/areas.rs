//! Area lights: a light whose support contains a point of a group must reach the group.

use glam::DVec3;
use proptest::prelude::*;

use crate::aims::{Kind, aim, witness};
use crate::cases::group;
use crate::deterministic;
use crate::groups::{UNIONS, box_of, union};

proptest! {
    #![proptest_config(deterministic(2_500))]

    #[test]
    fn a_support_that_contains_a_point_of_the_group_reaches_it(
        group in group(),
        aims in prop::collection::vec(prop_oneof![aim(Kind::Area), aim(Kind::Curved)], 4),
    ) {
        let bounds = group.bounds();
        for aim in aims {
            let light = aim.light(&group);
            let center = light.position.as_dvec3();
            let hull = group.hull(center, f64::from(light.radius_m()));
            let found = witness(&group, &light);
            let nearest = center + hull.nearest(DVec3::ZERO);
            let mut points = hull.0.iter().map(|corner| center + corner).chain([nearest]);
            if found.is_some() || points.any(|p| light.reach(p) > 0.0) {
                for tests in UNIONS {
                    prop_assert!(bounds.reaches(&light, union(tests)), "{tests} misses a light that reaches: {light:?}");
                }
                let (min_world, max_world) = box_of(&light);
                prop_assert!(bounds.reaches_box(min_world, max_world), "the box test misses a light that reaches: {light:?}");
            }
        }
    }

    /// Two independent methods say whether a light reaches a point: support points, and distances.
    /// The light's size and range bound their difference: the normal of a thin strip is only as
    /// accurate as its vertices' rounding over its width.
    #[test]
    fn overlapping_points_are_within_reach(group in group(), aims in prop::collection::vec(aim(Kind::Area), 4)) {
        for aim in aims {
            let light = aim.light(&group);
            if let Some(point) = witness(&group, &light) {
                let offset = point.distance(light.position.as_dvec3());
                let rounding = f64::from(f32::EPSILON) * point.length();
                let size = f64::from(light.radius_m()) + offset;
                let by_m = light.reach(point) * f64::from(light.range_m);
                prop_assert!(by_m > -1e-4 * size - rounding, "the point is {by_m:e} m inside a light of {size} m: {light:?}");
            }
        }
    }
}
