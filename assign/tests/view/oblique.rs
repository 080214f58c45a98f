//! Oblique near planes cut where they lie, and nowhere else.

use assign::{DepthMapping, View};
use glam::{DVec2, Vec2, Vec3, Vec4};
use proptest::prelude::*;

use crate::views::{oblique, plain, point_view, window_of};

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    /// Along a ray, the shown view depths begin at the plane, and contain all that the far plane showed before.
    #[test]
    fn rays_begin_at_the_plane((view, plane) in oblique(), place in prop::array::uniform2(0.0_f64..1.0)) {
        let [min, max] = window_of(&view);
        let window = min + (max - min) * DVec2::from(place);
        let to_world = view.world_to_view.as_dmat4().inverse();
        let distance = |depth_m: f64| {
            let point = to_world.transform_point3(point_view(&view, window, depth_m));
            plane.as_dvec4().dot(point.extend(1.0))
        };
        let Some((near_m, far_m)) = view.shown_m(window) else {
            // No depth comes before the plane. Rounding may leave a far one.
            prop_assert!(distance(1e3) < 1e-3 * 1e3);
            return Ok(());
        };
        prop_assert!(near_m < far_m);
        let to_clip = view.view_to_clip().as_dmat4();
        let depth_at = |depth_m: f64| {
            let clip = to_clip * point_view(&view, window, depth_m).extend(1.0);
            clip.z / clip.w
        };
        let [at_near, at_far] = match view.depth {
            DepthMapping::Standard => [0.0, 1.0],
            DepthMapping::Reversed => [1.0, 0.0],
        };
        // f32 rounds the row, so distant rays meet the plane elsewhere.
        prop_assert!((depth_at(near_m) - at_near).abs() < 1e-9);
        if near_m < 1e3 {
            let eye = distance(0.0).abs() + 1e-3;
            prop_assert!(distance(near_m).abs() < 1e-4 * (eye + near_m * (1.0 + near_m)), "{} {}", near_m, distance(near_m));
        }
        if far_m.is_finite() {
            prop_assert!((depth_at(far_m) - at_far).abs() < 1e-9);
        }
    }

    /// The bounds of a view hold what any ray shows.
    #[test]
    fn bounds_of_a_view_hold_its_rays(
        (view, _) in oblique(),
        places in prop::collection::vec(prop::array::uniform2(0.0_f64..1.0), 30),
    ) {
        let [min, max] = window_of(&view);
        for place in places {
            let Some((near_m, far_m)) = view.shown_m(min + (max - min) * DVec2::from(place)) else { continue };
            prop_assert!(f64::from(view.nearest_rebuilt_m()) <= near_m);
            prop_assert!(view.farthest_rebuilt_m().is_none_or(|end_m| far_m <= f64::from(end_m)));
            // Jitter moves the window by a part of a pixel, beyond that of `near_m`.
            let slack = if view.jitter == Vec2::ZERO { 1.0 - 1e-5 } else { 0.5 };
            prop_assert!(f64::from(view.near_m) * slack <= near_m + 1e-4);
        }
    }

    /// A plane across the axis, where the near plane is already, is an ordinary near plane.
    #[test]
    fn a_plane_across_the_axis_is_no_oblique_one(view in plain()) {
        let plane = view.world_to_view.transpose() * Vec4::new(0.0, 0.0, -1.0, -view.near_m);
        let made = view.with_near_plane(plane);
        if view.near_m > 0.0 {
            prop_assert_eq!(made.check(), Ok(()));
            let size = 1.0 + view.near_m.recip();
            let [row, wanted] = [made, view].map(|view| view.view_to_clip().row(2));
            // Positions up to 87 m from the origin round the plane.
            prop_assert!(row.abs_diff_eq(wanted, 1e-4 * size * (1.0 + wanted.abs().max_element())), "{} {}", row, wanted);
        }
    }
}

fn view() -> View {
    View::look_at(Vec3::new(0.0, -1.0, 4.0), Vec3::new(0.0, -0.5, 0.0), 1.0, 0.1, [64, 48])
}

/// The eye of a reflection lies below the floor, which must not hide the room.
#[test]
fn a_floor_hides_what_lies_below_it() {
    let above = Vec4::new(0.0, 1.0, 0.0, 0.0);
    for (depth, far_m) in [
        (DepthMapping::Standard, Some(50.0)),
        (DepthMapping::Standard, None),
        (DepthMapping::Reversed, Some(50.0)),
        (DepthMapping::Reversed, None),
    ] {
        let view = View { depth, far_m, ..view() }.with_near_plane(above);
        assert_eq!(view.check(), Ok(()));
        let is_shown = |point: Vec3| {
            let clip = view.world_to_clip() * point.extend(1.0);
            clip.z >= 0.0 && clip.z <= clip.w
        };
        for z in [-30.0, -3.0, 0.0] {
            assert!(is_shown(Vec3::new(0.2, 0.1, z)), "{depth:?} {far_m:?} {z}");
            assert!(!is_shown(Vec3::new(0.2, -0.1, z)), "{depth:?} {far_m:?} {z}");
        }
    }
}

#[test]
fn rows_that_disagree_with_their_view_are_refused() {
    let above = Vec4::new(0.0, 1.0, 0.0, 0.0);
    let good = View { far_m: Some(50.0), ..view() }.with_near_plane(above);
    assert_eq!(good.check(), Ok(()));
    for (what, bad) in [
        ("the eye in front of the plane", view().with_near_plane(above + 5.0 * Vec4::W)),
        ("a plane behind all that is seen", view().with_near_plane(Vec4::new(0.0, 0.0, 1.0, -9.0))),
        ("another near plane", View { near_m: 0.1, ..good }),
        ("the other direction", View { depth: DepthMapping::Standard, ..good }),
        ("NaN", View { depth_row: Some(Vec4::NAN), ..good }),
        ("nothing", View { depth_row: Some(Vec4::ZERO), ..good }),
    ] {
        let error = bad.check().expect_err(what);
        assert_eq!(error.field, "depth_row", "{what}: {error}");
    }
}
