//! Images beside that of no culling.

use std::sync::Arc;

use assign::Gpu;
use shading::{HdrImage, KeptImage};

use super::read;
use crate::{error::HarnessError, image_errors::ImagePair, stage::Stage};

/// The image of a frame, beside that of no culling.
pub enum Shown {
    /// It is the image of no culling in every bit, and has no channel that is not a number.
    Same,
    /// It differs.
    Differs {
        /// The image.
        image: HdrImage,
        /// That of no culling.
        reference: Arc<HdrImage>,
    },
}

impl Shown {
    /// Whether it differs.
    pub fn differs(&self) -> bool {
        matches!(self, Self::Differs { .. })
    }

    /// Both images, if they differ. `exposure` is the factor before the tone curve.
    pub fn pair(&self, exposure: f32) -> Option<ImagePair<'_>> {
        match self {
            Self::Same => None,
            Self::Differs { image, reference } => Some(ImagePair { image, reference, exposure }),
        }
    }
}

/// The image of no culling, on the GPU and, once it was asked for, on the CPU.
pub(super) struct Kept {
    kept: KeptImage,
    read: Option<Arc<HdrImage>>,
}

impl Kept {
    /// Keeps the image that a frame left in the targets, in place of one that was kept before.
    pub(super) fn keep(
        kept: &mut Option<Self>,
        gpu: &Gpu,
        stage: &Stage,
    ) -> Result<(), HarnessError> {
        let (targets, viewport) = (stage.renderer.targets(), stage.view.viewport);
        match kept.as_mut().filter(|known| known.kept.viewport() == viewport) {
            Some(known) => {
                known.kept.keep_again(targets)?;
                known.read = None;
            }
            None => {
                *kept = Some(Self { kept: KeptImage::keep(gpu, targets, viewport)?, read: None });
            }
        }
        Ok(())
    }

    /// The kept image.
    pub(super) fn image(&mut self) -> Result<Arc<HdrImage>, HarnessError> {
        let image = match self.read.take() {
            Some(image) => image,
            None => Arc::new(self.kept.read()?),
        };
        Ok(Arc::clone(self.read.insert(image)))
    }

    /// Compares the image that a frame left in the targets with the kept one.
    pub(super) fn look(&mut self, gpu: &Gpu, stage: &Stage) -> Result<Shown, HarnessError> {
        if self.kept.differing_channels(stage.renderer.targets())? == 0 {
            return Ok(Shown::Same);
        }
        Ok(Shown::Differs { image: read(gpu, stage)?, reference: self.image()? })
    }
}
