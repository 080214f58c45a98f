//! HG: the grid of hybrid lighting, filled from the side of the lights.
//!
//! # Idea
//!
//! Cells are those of clusters: screen tiles cut into depth slices, of which only those that hold
//! samples count. But no cell looks for its lights. Each light finds its outline on the screen at tile
//! resolution, the depths that it takes up over each tile, and adds itself to the cells between (Archer
//! et al. 2019, section 3.2, after their hybrid lighting of 2018). The cost of a light is then the
//! cells that it touches, not all of them, which suits many small lights.
//!
//! # Phases
//!
//! 1. `occupancy`: empties the grid, reads the depth buffer once and sets a bit for each slice of a
//!    tile that holds samples.
//! 2. `count`: 32 lanes a light, each every 32nd tile of its outline. A tile without samples at the
//!    light's depths is left. Else the range of depths over which the light's ball meets the tile's
//!    pyramid is found, and 1 added to the cells in it that hold samples. The range is that of a convex
//!    function of depth below the squared radius: Newton's method comes to either end from outside
//!    and never passes it. Cones and half balls shrink the outline, and are tried against a ball
//!    around the tile's part.
//! 3. `reserve`: a lane a cell. Its list takes its place in the pool, or becomes all lights.
//! 4. `fill`: `count` once more, by the same pipeline, so that both find the same pairs to the bit. A
//!    cursor a cell now points to places instead of counting.
//! 5. `sort`: a workgroup a list. Atomic cursors leave lists in another order on every run; ascending,
//!    they are the same. Lists are written anew from a second pool, since a light comes once: short
//!    ones by rank, long ones by a bit a light, without rounds of merges.
//!
//! Worked example: lights 0 to 2, of which 0 and 2 reach cell 5 and 1 reaches cell 6. The cursors of 5
//! and 6 count to 2 and 1, their places are 0 to 1 and 2, `fill` may leave `[2 0 | 1]`, and `sort` makes
//! it `[0 2 | 1]`.
//!
//! # Cost
//!
//! `occupancy` grows with pixels, `count` and `fill` with the tiles of the lights' outlines, `reserve`
//! with cells, `sort` with entries. Lights take no hierarchy: none is tested against what it does not
//! touch, so that a hierarchy would save no work. Memory is 16 bytes a cell and a bit, and 8 bytes a
//! listed light, twice what other strategies take.
//!
//! Of the points and cells that are listed together, 0.7 % or fewer do not meet, in perspective and
//! orthographic views, for ranges of 0.2 to 40 m (`tests/hybrid_rates.rs`).
//!
//! # Where it fails
//!
//! Lights that fill the screen are added to every cell, one atomic each, twice; many of them wait for
//! one another. A light is tested against a whole tile and slice, not against the samples in it: lists
//! are those of clusters with implicit bounds, and longer than those of explicit ones. A one-sided
//! light beyond its plane, and a cone beside a tile, are told apart by a ball around the tile's part
//! alone. Area lights list both terms.
//!
//! Look-ups at any depth are served: then every cell holds samples. A surface whose depth equals the
//! cleared one cannot be told from background: its samples get all lights.

use assign::{
    AssignError, Assignment, FIRST_STRATEGY_BINDING, Frame, Gpu, LightLists, ListsBindings, Lookup,
    Needs, Passes, SampleDomain, StrategyModule, entry, uniform_entry,
};
use bytemuck::bytes_of;

use crate::{
    hybrid_cells::{CellSize, CellsUniform},
    hybrid_passes::HybridPasses,
};

/// The WESL module of the cells: `group_of`.
pub const HYBRID_WESL: &str = include_str!("shaders/hybrid_cells.wesl");

/// A grid of cells that lights add themselves to.
#[derive(Debug)]
pub struct HybridGrid {
    size: CellSize,
    cells: wgpu::Buffer,
    lists: LightLists,
    look_up: ListsBindings,
    passes: HybridPasses,
}

impl HybridGrid {
    /// Makes the strategy; `size` is checked.
    pub fn new(gpu: &Gpu, size: CellSize) -> Result<Self, AssignError> {
        size.check()?;
        let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
        Ok(Self {
            size,
            cells: gpu.uniform("hybrid cells", size_of::<CellsUniform>() as u64),
            lists: LightLists::new(gpu)?,
            look_up: ListsBindings::of_look_up(
                gpu,
                "HG",
                &[uniform_entry(FIRST_STRATEGY_BINDING, stages)],
            ),
            passes: HybridPasses::new(gpu)?,
        })
    }
}

impl Assignment for HybridGrid {
    fn id(&self) -> String {
        format!("HG/{}", self.size)
    }

    fn needs(&self) -> Needs {
        Needs { depth: true, ..Needs::default() }
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        frame.view.check()?;
        let mut cells = CellsUniform::new(self.size, frame.view, frame.lights.bounds())?;
        let depth =
            match frame.samples {
                SampleDomain::AnyDepth => None,
                SampleDomain::OpaqueSurfaces => Some(frame.depth.ok_or_else(|| {
                    AssignError::Missing { strategy: self.id(), missing: "depth" }
                })?),
            };
        cells.surfaces_only = u32::from(depth.is_some());
        self.lists.prepare(gpu, frame.lights.count(), cells.cell_count())?;
        gpu.queue.write_buffer(&self.cells, 0, bytes_of(&cells));
        self.look_up.bind(gpu, &self.lists, &[entry(FIRST_STRATEGY_BINDING, &self.cells)]);
        self.passes.prepare(gpu, frame, &cells, &self.cells, &self.lists, depth)
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        self.lists.record_reset(passes.encoder());
        self.passes.record(frame, passes);
        self.lists.record_readback(passes.encoder());
    }

    fn lookup(&self) -> Lookup<'_> {
        // SAFETY: it has no loop.
        #[allow(unsafe_code, reason = "it has no loop")]
        let module = unsafe { StrategyModule::new(HYBRID_WESL) };
        Lookup { module, layout: self.look_up.layout() }
    }

    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.look_up.bind_group()
    }

    fn lists(&self) -> &LightLists {
        &self.lists
    }

    fn lists_mut(&mut self) -> &mut LightLists {
        &mut self.lists
    }

    fn memory_bytes(&self) -> u64 {
        self.cells.size() + self.lists.memory_bytes() + self.passes.bytes()
    }
}
