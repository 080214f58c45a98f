//! The pipelines of depth, G-buffer and clay.

use assign::{FrameBindings, Gpu};

use crate::{
    ShadingError,
    geometry::SceneGpu,
    raster::{Orientation, RasterPass, RasterPipelines},
};

/// The pipelines of the passes that all strategies share. Clones share them.
#[derive(Clone, Debug)]
pub(crate) struct SharedPasses {
    pub(crate) depth: RasterPipelines,
    pub(crate) model_ids: RasterPipelines,
    pub(crate) gbuffer: RasterPipelines,
    pub(crate) gbuffer_ids: RasterPipelines,
    pub(crate) clay: RasterPipelines,
}

impl SharedPasses {
    pub(crate) fn new(
        gpu: &Gpu,
        frame: &FrameBindings,
        scene: &SceneGpu,
        orientation: Orientation,
    ) -> Result<Self, ShadingError> {
        let pipelines = |pass| RasterPipelines::new(gpu, frame.layout(), scene, orientation, pass);
        Ok(Self {
            depth: pipelines(RasterPass::Depth)?,
            gbuffer: pipelines(RasterPass::GBuffer { ids: false })?,
            gbuffer_ids: pipelines(RasterPass::GBuffer { ids: true })?,
            model_ids: pipelines(RasterPass::ModelIds)?,
            clay: pipelines(RasterPass::Clay)?,
        })
    }
}
