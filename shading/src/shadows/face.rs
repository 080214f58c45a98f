//! One face of a shadow map: where it looks, its place in the atlas, and how far what it shows matters.

use glam::{DMat3, DVec3, Mat4, Vec3, Vec4};

/// Faces of a map that looks to all sides: each looks along an axis of the light.
pub(super) const FACES: usize = 6;

/// How far the rasteriser may move a vertex, texels: the least of the 8 bits that wgpu's back ends have below a texel.
const SNAP_PX: f64 = 1.0 / 256.0;

/// One face of a map: a picture of depth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Face {
    /// World to view space: x right, y down, and -z forward. It may mirror.
    pub(super) world_to_view: Mat4,
    /// View to clip space, with reversed infinite depth.
    pub(super) view_to_clip: Mat4,
    /// Upper left corner in the atlas, texels.
    pub(super) origin: [u32; 2],
    /// Width and height, texels.
    pub(super) size: [u32; 2],
    /// Its eye, world space.
    pub(super) eye: Vec3,
    /// Distance from the eye beyond which nothing hides a sample that the light reaches, metres: [`beyond`].
    pub(super) reach_m: f32,
    /// Whether it is a paraboloid, whose radius is 1 in `view_to_clip` where directions lie across the axis.
    pub(super) is_curved: bool,
}

/// Right, down and forward of each face: `face_of` in `shadow.wesl`.
pub(super) fn turned(axes: DMat3) -> [(DVec3, DVec3, DVec3); FACES] {
    let (x, y, z) = (axes.x_axis, axes.y_axis, axes.z_axis);
    [(x, y, z), (y, z, x), (y, z, -x), (x, z, y), (x, z, -y), (x, y, -z)]
}

/// The farthest texel centre that a look-up reads, along one axis, texels.
pub(super) fn across(taps: f64) -> f64 {
    0.5 * taps + SNAP_PX
}

/// How much farther from the eye than a sample the farthest thing may be that hides it, at most.
///
/// A look-up reads texels up to `shift` texels from the sample's, per axis: the offset moves it by at most 1.5 of the
/// reach (`occluders.rs`, for the widest cone), and the filter is `taps` wide. It compares a depth that is at most
/// `1 / (1 - r / 2)` times the sample's. At equal depth, a point whose tangents differ by `t` is at most `1 + t` times as far.
pub(super) fn beyond(texel: f64, taps: f64) -> f64 {
    let reach = across(taps) * std::f64::consts::SQRT_2;
    let shift = 1.5 * reach + taps + 1.0;
    (1.0 + std::f64::consts::SQRT_2 * shift * texel) / (1.0 - 0.5 * reach * texel).max(0.1)
}

/// A rigid or mirrored transform with these unit rows, and `eye` at its origin.
pub(super) fn world_to_view(x: DVec3, y: DVec3, z: DVec3, eye: DVec3) -> Mat4 {
    let row = |axis: DVec3| axis.extend(-axis.dot(eye));
    glam::DMat4::from_cols(row(x), row(y), row(z), glam::DVec4::W).transpose().as_mat4()
}

/// Clip x runs from -`side` to `side` and clip y downwards from `rows[0]` to `rows[1]`, at depth 1. Clip depth is near
/// over depth: 1 at the near plane and 0 at infinity.
pub(super) fn view_to_clip(side: f64, rows: [f64; 2], near_m: f64) -> Mat4 {
    let height = rows[1] - rows[0];
    // The image's top, clip y = 1, is row 0.
    let (down, top) = (-2.0 / height, 1.0 + 2.0 * rows[0] / height);
    Mat4::from_cols(
        Vec4::new((1.0 / side) as f32, 0.0, 0.0, 0.0),
        Vec4::new(0.0, down as f32, 0.0, 0.0),
        Vec4::new(0.0, -top as f32, 0.0, -1.0),
        Vec4::new(0.0, 0.0, near_m as f32, 0.0),
    )
}

/// Single precision, as bits.
pub(super) fn bits(value: f64) -> u32 {
    (value as f32).to_bits()
}
