//! How a strategy lights its pixels, and the point on its axes at which it does.

use assign::{
    AreaBounds, AssignError, Assignment, CullSettings, Everything, FrustumTests, Gpu, Kept,
    LightSource, Storage,
};
use assign_clustered::{Normals, Scatter, Slices, SpecularCut};
use assign_grid::GridBox;
use shading::OCCLUSION_TEST;

/// How a strategy lights its pixels.
pub enum Method {
    /// An assignment fills lists, and the shared pipeline shades by them.
    Lists {
        /// The assignment.
        strategy: Box<dyn Assignment>,
        /// Whether shading leaves out lights that add nothing to a sample.
        early_exit: bool,
        /// The irradiance below which lights stay at random.
        stochastic: Option<f32>,
        /// Whether its lists are random, so that each frame needs a seed.
        is_random: bool,
    },
    /// Light volumes are rasterised; deferred shading only.
    RasterSphere,
    /// The control: the surfaces are drawn without lights.
    Clay,
}

impl Method {
    /// Lists that shading reads with the early exit.
    pub(super) fn lists(strategy: impl Assignment + 'static) -> Self {
        let strategy = Box::new(strategy);
        Self::Lists { strategy, early_exit: true, stochastic: None, is_random: false }
    }

    /// No culling, by which all others are judged: every light is evaluated.
    pub(crate) fn everything(gpu: &Gpu) -> Result<Self, AssignError> {
        let strategy = Box::new(Everything::new(gpu)?);
        Ok(Self::Lists { strategy, early_exit: false, stochastic: None, is_random: false })
    }
}

/// One point on all axes of a family.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Options {
    /// The parameters, joined by `x`: `48x48x40`. Empty where there are none.
    pub parameters: String,
    /// The tests of a light against a frustum, where the id names them.
    pub tests: Option<FrustumTests>,
    /// Where lights come from, where the id says so.
    pub source: Option<LightSource>,
    /// What bounds the reach of an area light.
    pub area_bounds: AreaBounds,
    /// How depth is cut into slices.
    pub slices: Slices,
    /// What adds lights to the cells that they reach.
    pub scatter: Scatter,
    /// Where a group's lights are kept.
    pub storage: Storage,
    /// The box that a grid cuts into cells.
    pub grid_box: GridBox,
    /// Bins of normals.
    pub normals: Normals,
    /// Which specular light of area lights is left out.
    pub specular: SpecularCut,
    /// Out to how many of its ranges a light is listed for its specular term, at most.
    pub reach: Option<f32>,
    /// The most lights of a list.
    pub cap: Option<u32>,
    /// Which lights of a frame have lists, and how many.
    pub fewer: Option<(Kept, u32)>,
    /// The irradiance below which lights stay at random.
    pub stochastic: Option<f32>,
    /// The number of frames for which lists are used.
    pub reuse: Option<u32>,
    /// The most frames for which lists of larger lights are kept.
    pub keep: Option<u32>,
    /// Whether only those lists are made again that a changed light touches.
    pub is_touched: bool,
    /// Whether lists leave out lights that shadow maps hide.
    pub leaves_out_hidden: bool,
    /// Whether shading evaluates every listed light.
    pub evaluates_all: bool,
    /// Whether lights must also touch a rectangle on the screen that is too small.
    pub is_rectangle: bool,
    /// Whether lists are made for positions and ranges in half precision.
    pub is_half: bool,
    /// Whether lists are made for view depths that ignore an oblique near plane.
    pub is_plain_depth: bool,
    /// Whether lists have a random order in each frame.
    pub is_unordered: bool,
}

impl Options {
    /// What the culling driver is told: defaults where the id says nothing.
    pub fn settings(&self) -> CullSettings {
        CullSettings {
            tests: self.tests.unwrap_or_default(),
            source: self.source.unwrap_or_default(),
            area_bounds: self.area_bounds,
            storage: self.storage,
            screen_rectangle: self.is_rectangle,
            occlusion: self.leaves_out_hidden.then_some(OCCLUSION_TEST),
        }
    }
}
