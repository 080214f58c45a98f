//! Random views of every kind.

use assign::{DepthMapping, Projection, View, Viewport};
use glam::{DVec2, DVec3, Mat4, Quat, Vec2, Vec3};
use proptest::prelude::*;

pub(crate) fn vector(half: f32) -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-half..half).prop_map(Vec3::from_array)
}

fn unit() -> impl Strategy<Value = Vec3> {
    vector(1.0).prop_map(|v| v.normalize_or(Vec3::X))
}

fn window(offset: f32, size: f32) -> impl Strategy<Value = (Vec2, Vec2)> {
    let flip = prop::array::uniform2(any::<bool>());
    let size = prop::array::uniform2(0.1 * size..size);
    (prop::array::uniform2(-offset..offset), size, flip).prop_map(|(min, size, flip)| {
        let (min, max) = (Vec2::from(min), Vec2::from(min) + Vec2::from(size));
        let pick = |ix: usize| if flip[ix] { (max[ix], min[ix]) } else { (min[ix], max[ix]) };
        let ((left, right), (bottom, top)) = (pick(0), pick(1));
        (Vec2::new(left, bottom), Vec2::new(right, top))
    })
}

/// Window, near and far plane.
fn projection() -> impl Strategy<Value = (Projection, f32, Option<f32>)> {
    let far = || prop_oneof![Just(None), (1.5_f32..1e4).prop_map(Some)];
    let perspective =
        (window(1.5, 3.0), 0.005_f32..1.0, far()).prop_map(|((min, max), near, far)| {
            (Projection::Perspective { min, max }, near, far.map(|share| share * near))
        });
    let near = prop_oneof![Just(0.0_f32), 0.01_f32..9.0];
    let orthographic =
        (window(20.0, 40.0), near, 1.0_f32..300.0).prop_map(|((min, max), near, depth)| {
            (Projection::Orthographic { min, max }, near, Some(near + depth))
        });
    prop_oneof![2 => perspective, 1 => orthographic]
}

/// A view whose near plane is perpendicular to the axis.
pub(crate) fn plain() -> impl Strategy<Value = View> {
    let viewport = (0_u32..300, 0_u32..300, 1_u32..4000, 1_u32..2000);
    let turn = (unit(), 0.0_f32..6.3);
    (vector(50.0), turn, projection(), viewport, any::<bool>(), vector(0.5)).prop_map(
        |(eye, (axis, angle), (projection, near_m, far_m), (x, y, width, height), flip, jitter)| {
            let turn = Mat4::from_quat(Quat::from_axis_angle(axis, angle));
            View {
                world_to_view: turn * Mat4::from_translation(-eye),
                projection,
                near_m,
                far_m,
                depth: if flip { DepthMapping::Reversed } else { DepthMapping::Standard },
                depth_row: None,
                viewport: Viewport { x, y, width, height },
                jitter: if jitter.z > 0.0 { jitter.truncate() } else { Vec2::ZERO },
            }
        },
    )
}

/// A view with an oblique near plane, and the plane, world space. The plane lies between the eye and a point in the
/// window.
pub(crate) fn oblique() -> impl Strategy<Value = (View, glam::Vec4)> {
    let place = (0.0_f32..1.0, 0.0_f32..1.0, 0.05_f32..1.0);
    (plain(), unit(), place)
        .prop_map(|(view, normal, (u, v, share))| {
            let [min, max] = window_of(&view);
            let window = min + (max - min) * DVec2::new(u.into(), v.into());
            // Not so far that f32 cannot tell the plane's depths apart.
            let end_m = view.far_m.unwrap_or(30.0 * view.near_m).min(100.0 * view.near_m.max(0.1));
            let depth_m = view.near_m + share * (end_m - view.near_m);
            let point = point_view(&view, window, depth_m.into());
            let to_world = view.world_to_view.inverse();
            let point = to_world.transform_point3(point.as_vec3());
            let eye_side = match view.projection {
                Projection::Perspective { .. } => view.eye() - point,
                Projection::Orthographic { .. } => to_world.transform_vector3(Vec3::Z),
            };
            let normal = if normal.dot(eye_side) > 0.0 { -normal } else { normal };
            let plane = normal.extend(-normal.dot(point));
            (view.with_near_plane(plane), plane)
        })
        // Planes that lie along the rays, or cut an orthographic view behind its eye.
        .prop_filter("is a view", |(view, _)| view.check().is_ok())
}

/// Corners of the window, jitter included.
pub(crate) fn window_of(view: &View) -> [DVec2; 2] {
    let uniform = view.uniform();
    let [scale, offset] =
        [uniform.ray_scale, uniform.ray_offset].map(|pair| Vec2::from(pair).as_dvec2());
    [offset - scale, offset + scale]
}

/// The view-space point at a view depth that a point of the window shows.
pub(crate) fn point_view(view: &View, window: DVec2, depth_m: f64) -> DVec3 {
    match view.projection {
        Projection::Perspective { .. } => (window * depth_m).extend(-depth_m),
        Projection::Orthographic { .. } => window.extend(-depth_m),
    }
}
