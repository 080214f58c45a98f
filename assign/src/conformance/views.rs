//! Cameras of the cases.

use glam::{Mat4, Vec2, Vec3, Vec4};

use crate::{DepthMapping, Projection, View, Viewport};

/// Size of most targets, pixels. It spans a few tiles and has few enough samples for software
/// adapters.
pub(super) const SIZE: [u32; 2] = [72, 48];

const EYE: Vec3 = Vec3::new(1.3, 1.7, 2.1);
const TARGET: Vec3 = Vec3::new(4.0, 1.2, -6.0);

/// Perspective, reversed infinite depth.
pub(super) fn sized(size: [u32; 2]) -> View {
    View::look_at(EYE, TARGET, 1.0, 0.1, size)
}

/// Perspective, depth not reversed.
pub(super) fn standard(near_m: f32, far_m: Option<f32>) -> View {
    View { near_m, far_m, depth: DepthMapping::Standard, ..sized(SIZE) }
}

/// A near plane at 1 mm.
pub(super) fn thin_near() -> View {
    View { near_m: 0.001, ..sized(SIZE) }
}

/// Orthographic, near plane at the eye.
pub(super) fn orthographic(depth: DepthMapping) -> View {
    View {
        projection: Projection::Orthographic {
            min: Vec2::new(-4.0, -2.5),
            max: Vec2::new(4.0, 3.0),
        },
        near_m: 0.0,
        far_m: Some(30.0),
        depth,
        ..sized(SIZE)
    }
}

/// A window to the upper right of the viewing axis.
pub(super) fn off_centre() -> View {
    View {
        projection: Projection::Perspective { min: Vec2::new(0.1, -0.3), max: Vec2::new(0.9, 0.2) },
        ..sized(SIZE)
    }
}

/// The window of a planar mirror: left and right are swapped.
pub(super) fn mirrored() -> View {
    View {
        projection: Projection::Perspective {
            min: Vec2::new(0.7, -0.4),
            max: Vec2::new(-0.8, 0.5),
        },
        ..sized(SIZE)
    }
}

/// The plane of a `view` that is `plane_view` in its space.
fn in_front_of(view: View, plane_view: Vec4) -> View {
    view.with_near_plane(view.world_to_view.transpose() * plane_view)
}

/// A mirror that cuts through the room, seen in a flipped window with jitter inside a larger target.
pub(super) fn oblique() -> View {
    let viewport = Viewport { x: 9, y: 5, ..mirrored().viewport };
    let view = View { jitter: Vec2::new(0.4, -0.3), viewport, ..mirrored() };
    in_front_of(view, Vec4::new(0.5, -0.35, -0.8, -2.6))
}

/// A plane almost along the axis: rays in the lower half of the window never come before it.
pub(super) fn grazing() -> View {
    in_front_of(standard(0.1, Some(40.0)), Vec4::new(0.05, 1.0, -0.02, -0.3))
}

/// Parallel rays that meet the plane at view depths from 0.9 to 5 m.
pub(super) fn oblique_orthographic() -> View {
    in_front_of(orthographic(DepthMapping::Reversed), Vec4::new(0.3, 0.3, -1.0, -3.0))
}

/// Looks along +Z in a left-handed space, with OpenGL's clip depth.
pub(super) fn own_matrices() -> View {
    let flip = Mat4::from_scale(Vec3::new(1.0, 1.0, -1.0));
    let plain = standard(0.1, Some(40.0));
    let mut rows = (plain.view_to_clip() * flip).transpose();
    rows.z_axis = 2.0 * rows.z_axis - rows.w_axis;
    let made = View::from_gl_matrices(flip * plain.world_to_view, rows.transpose(), plain.viewport);
    // The case fails with a view that is refused.
    made.unwrap_or(View { near_m: f32::NAN, ..plain })
}

/// Half a pixel to the left and a third down.
pub(super) fn jittered() -> View {
    View { jitter: Vec2::new(-0.5, 0.33), ..sized(SIZE) }
}

/// A viewport away from the target's corner.
pub(super) fn offset() -> View {
    View { viewport: Viewport { x: 21, y: 13, width: 83, height: 57 }, ..sized([83, 57]) }
}

/// 1,000 km from the origin, where f32 positions are accurate to 6 cm.
pub(super) fn far_from_origin() -> View {
    let away = Vec3::new(800_000.0, 1_000.0, -600_000.0);
    View::look_at(EYE + away, TARGET + away, 1.0, 0.1, SIZE)
}

/// Another place and direction.
pub(super) fn elsewhere() -> View {
    View::look_at(Vec3::new(-20.0, 9.0, 30.0), Vec3::ZERO, 1.2, 0.1, SIZE)
}
