//! What the passes that read the depth buffer share: `surface.wesl`, and how many workgroups they take.

use assign::View;

/// Path and source of the module that rebuilds the sample of a pixel.
pub(crate) const SURFACE: (&str, &str) = ("package::surface", include_str!("shaders/surface.wesl"));

/// Width and height of the block that one workgroup reads, pixels: `BLOCK_PX` of `surface.wesl`.
const BLOCK_PX: u32 = 32;

/// The workgroups of a pass over a view's pixels, along x and y.
pub(crate) fn blocks(view: &View) -> [u32; 2] {
    [view.viewport.width, view.viewport.height].map(|pixels| pixels.div_ceil(BLOCK_PX))
}
