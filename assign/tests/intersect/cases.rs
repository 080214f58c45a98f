//! Random views and groups, chosen to be difficult: thin slices, far cameras, flat boxes.

use assign::intersect::UNBOUNDED;
use assign::{DepthMapping, Projection, View, Viewport};
use glam::{Mat3, Quat, Vec2, Vec3};
use proptest::prelude::*;

use crate::groups::{Group, Shape};

pub(crate) fn power_of_ten(exponents: std::ops::Range<f32>) -> impl Strategy<Value = f32> {
    exponents.prop_map(|e| 10_f32.powf(e))
}

fn vector(half: f32) -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-half..half).prop_map(Vec3::from_array)
}

pub(crate) fn unit() -> impl Strategy<Value = Vec3> {
    prop_oneof![
        4 => vector(1.0).prop_map(|v| v.normalize_or(Vec3::X)),
        1 => prop::sample::select(vec![Vec3::X, Vec3::NEG_Y, Vec3::NEG_Z]),
    ]
}

/// A place in the world: the origin, in a room, in a town, or 1,000 km away.
fn place() -> impl Strategy<Value = Vec3> {
    prop_oneof![
        2 => Just(Vec3::ZERO),
        4 => vector(50.0),
        1 => vector(1e3),
        1 => vector(1e6),
    ]
}

/// Window and range of view depths.
fn projection() -> impl Strategy<Value = (Projection, f32, Option<f32>)> {
    let near = || prop_oneof![Just(1e-3_f32), 0.01_f32..1.0];
    let far = || prop_oneof![Just(None), power_of_ten(0.3..5.0).prop_map(Some)];
    let symmetric = (0.04_f32..3.0, 0.3_f32..3.0).prop_map(|(top, aspect)| {
        let max = Vec2::new(top * aspect, top);
        Projection::Perspective { min: -max, max }
    });
    let window = |offset: f32, size: f32| {
        (prop::array::uniform2(-offset..offset), prop::array::uniform2(0.01 * size..size))
            .prop_map(|(min, size)| (Vec2::from(min), Vec2::from(min) + Vec2::from(size)))
    };
    let off_centre = window(2.0, 3.0).prop_map(|(min, max)| Projection::Perspective { min, max });
    let orthographic =
        window(100.0, 200.0).prop_map(|(min, max)| Projection::Orthographic { min, max });
    // A planar mirror's window is flipped.
    let mirrored = window(2.0, 3.0).prop_map(|(min, max)| Projection::Perspective {
        min: Vec2::new(max.x, min.y),
        max: Vec2::new(min.x, max.y),
    });
    let perspective = (prop_oneof![3 => symmetric, 1 => off_centre, 1 => mirrored], near(), far())
        .prop_map(|(window, near, far)| (window, near, far.map(|f| near * f)));
    prop_oneof![
        3 => perspective,
        1 => (orthographic, prop_oneof![Just(0.0_f32), 0.01_f32..9.0], 1.0_f32..1e3)
            .prop_map(|(window, near, depth)| (window, near, Some(near + depth))),
    ]
}

pub(crate) fn view() -> impl Strategy<Value = View> {
    let viewport = (0_u32..300, 0_u32..300, 1_u32..4000, 1_u32..2000);
    (place(), unit(), unit(), projection(), viewport, any::<bool>(), vector(0.5)).prop_map(
        |(eye, forward, up, (projection, near_m, far_m), (x, y, width, height), flip, jitter)| {
            let up =
                if up.cross(forward).length() < 0.1 { forward.any_orthogonal_vector() } else { up };
            let view = View {
                world_to_view: glam::camera::rh::view::look_to_mat4(eye, forward, up.normalize()),
                projection,
                near_m,
                far_m,
                depth: if flip { DepthMapping::Reversed } else { DepthMapping::Standard },
                depth_row: None,
                viewport: Viewport { x, y, width, height },
                jitter: if flip { jitter.truncate() } else { Vec2::ZERO },
            };
            view.check().unwrap();
            view
        },
    )
}

/// A tile of pixels anywhere in the viewport, or the whole viewport, between two depths.
pub(crate) fn frustum() -> impl Strategy<Value = Group> {
    let tile = (0.0_f32..1.0, 0.0_f32..1.0, prop_oneof![4 => 1_u32..100, 1 => Just(4000)]);
    let first = prop_oneof![1 => Just(0.0_f32), 3 => power_of_ten(-3.0..3.3)];
    let thickness = prop_oneof![
        2 => power_of_ten(-1.0..2.7).prop_map(|m| (0.0, m)),
        2 => power_of_ten(-4.0..0.5).prop_map(|share| (share, 0.0)),
        1 => Just((0.0, UNBOUNDED)),
    ];
    (view(), tile, first, thickness).prop_map(|(view, (u, v, size), first, (share, metres))| {
        let Viewport { x, y, width, height } = view.viewport;
        let edge = |share: f32, pixels: u32| (share * pixels as f32) as u32 / size * size;
        let (left, top) = (x + edge(u, width), y + edge(v, height));
        let ndc = |px: u32, py: u32| {
            let uv = Vec2::new((px - x) as f32, (py - y) as f32)
                / Vec2::new(width as f32, height as f32);
            Vec2::new(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y)
        };
        let (upper_left, lower_right) = (ndc(left, top), ndc(left + size, top + size));
        let depth_min = view.near_m + first;
        let shape = Shape::Frustum {
            ndc_min: Vec2::new(upper_left.x, lower_right.y),
            ndc_max: Vec2::new(lower_right.x, upper_left.y),
            depth_min,
            depth_max: depth_min * (1.0 + share) + metres,
        };
        Group { view, shape }
    })
}

fn extents() -> impl Strategy<Value = Vec3> {
    let extent = || prop_oneof![8 => power_of_ten(-3.0..2.7), 1 => Just(0.0_f32)];
    // The box of a single sample has no extent.
    prop_oneof![
        4 => (extent(), extent(), extent()).prop_map(|(x, y, z)| Vec3::new(x, y, z)),
        1 => Just(Vec3::ZERO),
    ]
}

pub(crate) fn aabb() -> impl Strategy<Value = Group> {
    (view(), place(), extents()).prop_map(|(view, min_world, size)| Group {
        view,
        shape: Shape::Aabb { min_world, max_world: min_world + size },
    })
}

pub(crate) fn oriented() -> impl Strategy<Value = Group> {
    let turn = (unit(), 0.0_f32..6.3, any::<bool>());
    (view(), place(), extents(), turn).prop_map(
        |(view, center_world, half_extents_m, (about, angle, mirrored))| {
            let axes = Mat3::from_quat(Quat::from_axis_angle(about, angle));
            let x = if mirrored { -axes.x_axis } else { axes.x_axis };
            let shape = Shape::Oriented {
                center_world,
                axes: [x, axes.y_axis, axes.z_axis],
                half_extents_m,
            };
            Group { view, shape }
        },
    )
}

pub(crate) fn group() -> impl Strategy<Value = Group> {
    prop_oneof![3 => frustum(), 1 => aabb(), 1 => oriented()]
}
