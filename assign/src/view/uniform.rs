//! The camera as shaders read it.

use bytemuck::{Pod, Zeroable};

use super::View;

/// A [`View`] as shaders read it: `view.wesl`, `struct View`. 272 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct ViewUniform {
    /// World to view.
    pub world_to_view: [[f32; 4]; 4],
    /// View to world.
    pub view_to_world: [[f32; 4]; 4],
    /// View to clip, jitter included.
    pub view_to_clip: [[f32; 4]; 4],
    /// `ray_scale * ndc + ray_offset` is the view-space position at view depth 1 (perspective), or
    /// at every depth (orthographic). It is negative where the window is flipped.
    pub ray_scale: [f32; 2],
    /// See `ray_scale`.
    pub ray_offset: [f32; 2],
    /// Upper left corner of the viewport, pixels.
    pub viewport_origin: [f32; 2],
    /// Size of the viewport, pixels.
    pub viewport_size: [f32; 2],
    /// View depth of the near plane, metres.
    pub near_m: f32,
    /// View depth of the far plane, metres; `f32::MAX` when infinite.
    pub far_m: f32,
    /// 1 for perspective, 0 for orthographic. A pixel's footprint grows with view depth to this
    /// power.
    pub perspective: f32,
    /// How far rounding can move a world-space position that is rebuilt from depth, metres per
    /// metre of its distance from the world's origin or from the camera.
    pub position_error: f32,
    /// The clip depth to which the depth buffer is cleared.
    pub depth_clear: f32,
    /// [`Frame::seed`](crate::Frame::seed).
    pub seed: u32,
    /// Aligns `depth_tilt` to 16 bytes.
    pub padding: [f32; 2],
    /// How clip depth depends on the pixel: `x` per pixel to the right, `y` per pixel down, and `z` at pixel (0, 0) of
    /// the target. 0 unless the near plane is oblique.
    pub depth_tilt: [f32; 3],
    /// Pads to 272 bytes.
    pub padding_end: f32,
}

impl View {
    /// The record shaders read, with seed 0.
    pub fn uniform(&self) -> ViewUniform {
        let (perspective, min, max) = self.window();
        ViewUniform {
            world_to_view: self.world_to_view.to_cols_array_2d(),
            view_to_world: self.world_to_view.inverse().to_cols_array_2d(),
            view_to_clip: self.view_to_clip().to_cols_array_2d(),
            ray_scale: (0.5 * (max - min)).to_array(),
            ray_offset: (0.5 * (max + min)).to_array(),
            viewport_origin: [self.viewport.x as f32, self.viewport.y as f32],
            viewport_size: [self.viewport.width as f32, self.viewport.height as f32],
            near_m: self.near_m,
            far_m: self.far_m.unwrap_or(f32::MAX),
            perspective: if perspective { 1.0 } else { 0.0 },
            position_error: POSITION_ERROR,
            depth_clear: self.depth_clear(),
            seed: 0,
            padding: [0.0; 2],
            depth_tilt: self.depth_tilt(),
            padding_end: 0.0,
        }
    }
}

/// A position rebuilt from depth goes through three matrix products, each rounded. 16 units in the
/// last place bound them with room; the conformance suite's far camera checks it.
const POSITION_ERROR: f32 = 16.0 * f32::EPSILON;
