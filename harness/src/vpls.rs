//! The virtual point lights of a stage.

use assign::{Gpu, Light};
use scenes::Scene;
use shading::Renderer;

use crate::{cli::StageArgs, error::HarnessError, results::Vpls};

/// Makes virtual point lights, and keeps what does not change from one set to the next.
#[derive(Default)]
pub struct VplMaker {}

/// Lights and what they took.
pub struct Made {
    /// The lights.
    pub lights: Vec<Light>,
    /// What they took.
    pub figures: Vpls,
}

impl VplMaker {
    /// Makes them.
    pub fn make(
        &mut self,
        _gpu: &Gpu,
        _scene: &Scene,
        _renderer: &Renderer,
        _primary: Light,
        _args: &StageArgs,
    ) -> Result<Made, HarnessError> {
        Ok(Made { lights: Vec::new(), figures: Vpls::default() })
    }
}
