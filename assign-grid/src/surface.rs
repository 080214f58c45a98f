//! What the passes that read the depth buffer share: `surface.wesl`, and how many workgroups they take.

use assign::{AssignError, Frame, SampleDomain, View};

/// Path and source of the module that rebuilds the sample of a pixel.
pub(crate) const SURFACE: (&str, &str) = ("package::surface", include_str!("shaders/surface.wesl"));

/// Width and height of the block that one workgroup reads, pixels: `BLOCK_PX` of `surface.wesl`.
const BLOCK_PX: u32 = 32;

/// The workgroups of a pass over a view's pixels, along x and y.
pub(crate) fn blocks(view: &View) -> [u32; 2] {
    [view.viewport.width, view.viewport.height].map(|pixels| pixels.div_ceil(BLOCK_PX))
}

/// The depth buffer of a frame for a strategy that serves only the surfaces in it. `id` gives its id.
pub(crate) fn depth_of<'a>(
    frame: &Frame<'a>,
    id: impl Fn() -> String,
) -> Result<&'a wgpu::TextureView, AssignError> {
    if frame.samples == SampleDomain::AnyDepth {
        return Err(AssignError::Unsupported {
            strategy: id(),
            asked: "look-ups at any depth".into(),
            reason: "its lists serve only the opaque surfaces in the depth buffer".into(),
        });
    }
    frame.depth.ok_or_else(|| AssignError::Missing { strategy: id(), missing: "depth" })
}
