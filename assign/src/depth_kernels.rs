//! Kernels that read depth, with one or with several samples per pixel.

use crate::{AssignError, DepthImage};

/// The kernels of a pass for depth with one sample per pixel, and those for several. WGSL has a texture type for each.
///
/// Both stay, so that a renderer may alternate. The first are made with the pass, and the second for the first image
/// that needs them.
#[derive(Debug)]
pub struct DepthKernels<T> {
    one: T,
    several: Option<T>,
    is_multisampled: bool,
}

impl<T> DepthKernels<T> {
    /// Keeps the kernels for one sample per pixel.
    pub fn new(one: T) -> Self {
        Self { one, several: None, is_multisampled: false }
    }

    /// Chooses the kernels for an image. `make` makes those for several samples per pixel.
    ///
    /// # Errors
    ///
    /// Those of `make`.
    pub fn choose(
        &mut self,
        depth: &DepthImage,
        make: impl FnOnce() -> Result<T, AssignError>,
    ) -> Result<(), AssignError> {
        self.is_multisampled = depth.is_multisampled();
        if self.is_multisampled && self.several.is_none() {
            self.several = Some(make()?);
        }
        Ok(())
    }

    /// The kernels for the image of the last [`choose`](Self::choose), at first those for one sample per pixel.
    pub fn chosen(&self) -> &T {
        match &self.several {
            Some(several) if self.is_multisampled => several,
            _ => &self.one,
        }
    }
}
