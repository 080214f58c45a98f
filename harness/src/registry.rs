//! Every method that can be compared: one row each. The command line, the lists and the report
//! derive from it.

use assign::{
    AssignError, Assignment,
    Bounds::{Explicit, Implicit},
    CullSettings, Everything, Gpu,
};
use assign_clustered::{
    Clustered, HybridGrid, Normals,
    Occupancy::{Dense, Sparse},
    SpecularCut,
};
use assign_grid::{Grid, GridBox};
use assign_model::PerModel;
use assign_tiled::Tiled;

/// How a method lights its pixels.
pub enum Method {
    /// A strategy fills lists, the shared pipeline shades by them.
    Lists {
        /// The strategy.
        strategy: Box<dyn Assignment>,
        /// Whether lighting leaves out lights that add nothing to a sample.
        early_exit: bool,
    },
    /// Light volumes are rasterised; deferred only.
    RasterSphere,
    /// The control: surfaces drawn at the cost of no lights.
    Clay,
}

impl Method {
    fn lists(strategy: impl Assignment + 'static) -> Self {
        Self::Lists { strategy: Box::new(strategy), early_exit: true }
    }
}

/// An axis that a method can be varied on, beside its parameters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// The union of frustum tests: `hs+sat-n`.
    Tests,
    /// Where lights come from: `linear` or `bvh`.
    Source,
    /// What bounds the reach of an area light: `ball` instead of its outline.
    AreaBounds,
    /// The box that is cut into cells: `positions`, `supports` or `surfaces`.
    Box,
    /// Bins of normals that clusters are split into: `n6`.
    Normals,
    /// Which specular light of area lights is left out: `s0.001`, `cone45` or `dif`. Lossy.
    Specular,
    /// The most lights of a list, the others dropped: `cap32`. Lossy.
    Cap,
    /// Frames for which lists are used: `reuse4`. Lossy where groups or lights move.
    Reuse,
    /// Whether shading evaluates every listed light, also where it adds nothing: `no-exit`.
    Exit,
}

impl Axis {
    /// What a segment of an id may say of it.
    pub fn accepted(self) -> &'static str {
        match self {
            Self::Tests => "a union of hs, sat-e, sat-n, sat-p and sat-v",
            Self::Source => "linear or bvh",
            Self::AreaBounds => "ball or outline",
            Self::Box => "positions, supports or surfaces",
            Self::Normals => "n and the bins of normals: n1, n6, n24 or n54",
            Self::Specular => {
                "what specular light is left out: s and a radiance, such as s0.001, cone and the half \
                 angle of a lobe in degrees, such as cone45 (Swarbrick 2025), or dif, all beyond the \
                 reach of diffuse light"
            }
            Self::Cap => "cap and the most lights of a list, such as cap32",
            Self::Reuse => "reuse and the frames for which lists are used, such as reuse4",
            Self::Exit => "no-exit, which evaluates every listed light",
        }
    }
}

/// One point on all axes of a method.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spec {
    /// Parameters, joined by `x`; empty where there are none.
    pub parameters: String,
    /// Tests and source of the culling driver.
    pub settings: CullSettings,
    /// The box of a grid.
    pub grid_box: GridBox,
    /// Bins of normals.
    pub normals: Normals,
    /// Which specular light of area lights is left out.
    pub specular: SpecularCut,
    /// The most lights of a list.
    pub cap: Option<u32>,
    /// Frames for which lists are used.
    pub reuse: Option<u32>,
    /// Whether shading evaluates every listed light.
    pub evaluates_all: bool,
}

/// One row: a method, or a family of methods with parameters.
pub struct StrategyEntry {
    /// The id without parameters, as in the comparison paper.
    pub family: &'static str,
    /// Names of the parameters, which stand behind a slash and are joined by `x`.
    pub parameters: &'static [&'static str],
    /// Parameters where none are given.
    pub default: &'static str,
    /// Further axes, each a segment behind a slash of its own.
    pub axes: &'static [Axis],
    /// What it is, one line.
    pub summary: &'static str,
    /// Whether it reads the depth of surfaces before it assigns lights, so that a renderer without a
    /// depth pre-pass must draw one for it.
    pub reads_depth: bool,
    /// Makes it.
    pub(crate) make: fn(&Gpu, &Spec) -> Result<Method, AssignError>,
}

impl StrategyEntry {
    /// The id with the parameters it takes where none are given.
    pub fn default_id(&self) -> String {
        match self.default {
            "" => self.family.to_owned(),
            parameters => format!("{}/{parameters}", self.family),
        }
    }
}

const CLUSTER: &[&str] = &["tile_width_px", "tile_height_px", "slices"];
const TILE: &[&str] = &["tile_width_px", "tile_height_px"];
const FRUSTA: &[Axis] =
    &[Axis::Tests, Axis::Source, Axis::AreaBounds, Axis::Cap, Axis::Reuse, Axis::Exit];
const BOXES: &[Axis] = &[Axis::Source, Axis::AreaBounds, Axis::Cap, Axis::Reuse, Axis::Exit];

/// All methods; those of the comparison paper at its parameters (Enhuber 2019, table 4.3).
pub const STRATEGIES: &[StrategyEntry] = &[
    StrategyEntry {
        family: "None",
        parameters: &[],
        default: "",
        axes: &[],
        summary: "no culling: every light for every sample; the reference of all images",
        reads_depth: false,
        make: |gpu, _| {
            Ok(Method::Lists { strategy: Box::new(Everything::new(gpu)?), early_exit: false })
        },
    },
    StrategyEntry {
        family: "Clay",
        parameters: &[],
        default: "",
        axes: &[],
        summary: "control: surfaces without lights or textures, what drawing alone costs",
        reads_depth: false,
        make: |_, _| Ok(Method::Clay),
    },
    StrategyEntry {
        family: "Sphere",
        parameters: &[],
        default: "",
        axes: &[],
        summary: "no culling with an early exit: every light for every sample, left out where it adds nothing",
        reads_depth: false,
        make: |gpu, _| Ok(Method::lists(Everything::new(gpu)?)),
    },
    StrategyEntry {
        family: "RasterSphere",
        parameters: &[],
        default: "",
        axes: &[],
        summary: "no lists: light volumes rasterised and added up; deferred only",
        reads_depth: false,
        make: |_, _| Ok(Method::RasterSphere),
    },
    StrategyEntry {
        family: "T-I",
        parameters: TILE,
        default: "28x28",
        axes: FRUSTA,
        summary: "tiles, implicit bounds: every tile has a list from near to far",
        reads_depth: false,
        make: |gpu, spec| {
            let size = spec.parameters.parse()?;
            Ok(Method::lists(Tiled::new(gpu, size, Implicit, spec.settings)?))
        },
    },
    StrategyEntry {
        family: "T-E",
        parameters: TILE,
        default: "28x28",
        axes: FRUSTA,
        summary: "tiles, explicit bounds: the depth range of each tile's samples",
        reads_depth: true,
        make: |gpu, spec| {
            let size = spec.parameters.parse()?;
            Ok(Method::lists(Tiled::new(gpu, size, Explicit, spec.settings)?))
        },
    },
    StrategyEntry {
        family: "DC-I",
        parameters: CLUSTER,
        default: "128x128x64",
        axes: FRUSTA,
        summary: "dense clusters, implicit bounds: every tile and depth slice has a list",
        reads_depth: false,
        make: |gpu, spec| {
            let size = spec.parameters.parse()?;
            Ok(Method::lists(Clustered::new(gpu, size, Implicit, Dense, spec.settings)?))
        },
    },
    StrategyEntry {
        family: "DC-E",
        parameters: CLUSTER,
        default: "64x64x40",
        axes: BOXES,
        summary: "dense clusters, explicit bounds: the box around each cluster's samples",
        reads_depth: true,
        make: |gpu, spec| {
            let size = spec.parameters.parse()?;
            Ok(Method::lists(Clustered::new(gpu, size, Explicit, Dense, spec.settings)?))
        },
    },
    StrategyEntry {
        family: "SC-I",
        parameters: CLUSTER,
        default: "48x48x40",
        axes: FRUSTA,
        summary: "sparse clusters, implicit bounds: only clusters that hold samples have a list",
        reads_depth: true,
        make: |gpu, spec| {
            let size = spec.parameters.parse()?;
            Ok(Method::lists(Clustered::new(gpu, size, Implicit, Sparse, spec.settings)?))
        },
    },
    StrategyEntry {
        family: "SC-E",
        parameters: CLUSTER,
        default: "48x48x40",
        axes: &[
            Axis::Normals,
            Axis::Specular,
            Axis::Source,
            Axis::AreaBounds,
            Axis::Cap,
            Axis::Reuse,
            Axis::Exit,
        ],
        summary: "sparse clusters, explicit bounds: both at once",
        reads_depth: true,
        make: |gpu, spec| {
            let size = spec.parameters.parse()?;
            let Spec { normals, specular, settings, .. } = *spec;
            Ok(Method::lists(Clustered::with_normals(
                gpu, size, Explicit, Sparse, normals, specular, settings,
            )?))
        },
    },
    StrategyEntry {
        family: "G",
        parameters: &["cells_x", "cells_y", "cells_z"],
        default: "20x20x20",
        axes: &[Axis::Box, Axis::Source, Axis::AreaBounds, Axis::Cap, Axis::Reuse, Axis::Exit],
        summary: "a grid of cells in world space, over the box of the lights' positions, of their supports, or of the surfaces",
        reads_depth: false,
        make: |gpu, spec| {
            let counts = spec.parameters.parse()?;
            Ok(Method::lists(Grid::new(gpu, counts, spec.grid_box, spec.settings)?))
        },
    },
    StrategyEntry {
        family: "M",
        parameters: &["part_size_m"],
        default: "",
        axes: BOXES,
        summary: "a list for each model, or, with a size, for each part of it",
        reads_depth: false,
        make: |gpu, spec| {
            Ok(Method::lists(PerModel::new(gpu, part_size(&spec.parameters)?, spec.settings)?))
        },
    },
    StrategyEntry {
        family: "HG",
        parameters: CLUSTER,
        default: "48x48x40",
        axes: &[Axis::Cap, Axis::Reuse, Axis::Exit],
        summary: "the grid of hybrid lighting: lights add themselves to the cells that hold samples",
        reads_depth: true,
        make: |gpu, spec| Ok(Method::lists(HybridGrid::new(gpu, spec.parameters.parse()?)?)),
    },
];

/// Whether the methods of a family read the depth of surfaces; `false` of an unknown one.
pub fn family_reads_depth(family: &str) -> bool {
    STRATEGIES.iter().any(|entry| entry.family == family && entry.reads_depth)
}

fn part_size(text: &str) -> Result<Option<f32>, AssignError> {
    if text.is_empty() {
        return Ok(None);
    }
    text.parse().map(Some).map_err(|_| AssignError::Parameter {
        field: "size of a part".into(),
        value: text.into(),
        accepted: "a number of metres, such as 2".into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::choice::Choice;

    #[test]
    fn rows_say_what_their_strategies_read() {
        let gpu = Gpu::noop().expect("a device");
        for entry in STRATEGIES {
            let choice = Choice::parse(&entry.default_id()).expect("a choice");
            let reads_depth = match choice.make(&gpu).expect("a method") {
                Method::Lists { strategy, .. } => strategy.needs().depth,
                Method::RasterSphere | Method::Clay => false,
            };
            assert_eq!(entry.reads_depth, reads_depth, "{}", entry.family);
        }
        assert!(STRATEGIES.iter().any(|entry| entry.reads_depth));
    }
}
