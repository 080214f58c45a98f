//! Where a camera's image lies: in its window, in the render target, and in clip depth.

use assign::DepthMapping;
use glam::{Vec2, Vec4};

/// How a camera's image differs from the plain one: a window around the viewing axis, drawn into the whole
/// target, with reversed depth. glTF cameras are plain. Stability scenarios are not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Framing {
    /// Shift of the window, as a share of its width and height: +X right and +Y up. At 0.5 the viewing axis
    /// meets the window's edge.
    pub shift: Vec2,
    /// Shift of the image, pixels: +X right and +Y down, as temporal anti-aliasing uses it.
    pub jitter_px: Vec2,
    /// Whether left and right are swapped, as in the image of a planar mirror.
    pub is_mirrored: bool,
    /// Pixels of the target to the left of the image, and above it.
    pub before_px: [u32; 2],
    /// Pixels of the target to the right of the image, and below it.
    pub after_px: [u32; 2],
    /// How many pixels narrower and lower than asked the image is, so that its size is no multiple of a tile.
    /// At least one pixel is left.
    pub less_px: [u32; 2],
    /// Whether there is no far plane, although the scene's bounds would give one. Perspective only.
    pub is_endless: bool,
    /// Direction of clip depth.
    pub depth: DepthMapping,
    /// An oblique near plane, world space: only points `p` with `dot(plane.xyz, p) + plane.w >= 0` are drawn. The eye
    /// lies on its other side, as that of a reflection lies behind the mirror.
    pub clip_plane: Option<Vec4>,
}

impl Framing {
    /// The plain framing.
    pub const PLAIN: Self = Self {
        shift: Vec2::ZERO,
        jitter_px: Vec2::ZERO,
        is_mirrored: false,
        before_px: [0; 2],
        after_px: [0; 2],
        less_px: [0; 2],
        is_endless: false,
        depth: DepthMapping::Reversed,
        clip_plane: None,
    };
}

impl Default for Framing {
    fn default() -> Self {
        Self::PLAIN
    }
}
