//! G: a grid of cells in world space.

use std::str::FromStr;

use assign::{
    AssignError, Assignment, CullSettings, Culler, CullerDescriptor, FIRST_STRATEGY_BINDING,
    Facing, Frame, Gpu, GroupShape, Groups, LightLists, Lookup, Needs, Passes, StrategyModule,
    entry, uniform_entry,
};
use bytemuck::bytes_of;
use glam::Vec3;

use crate::cells::{CellCounts, CellsUniform};

/// Which box is cut into cells.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum GridBox {
    /// The box around the lights' supports: beyond it no list holds a light.
    #[default]
    Lights,
    /// The same, cut to the box around the surfaces. Look-ups outside stay exact, through the
    /// cells at the border.
    Surfaces,
}

impl FromStr for GridBox {
    type Err = AssignError;

    /// Reads `lights` or `surfaces`.
    fn from_str(text: &str) -> Result<Self, AssignError> {
        match text {
            "lights" => Ok(Self::Lights),
            "surfaces" => Ok(Self::Surfaces),
            _ => Err(AssignError::Parameter {
                field: "grid box".into(),
                value: text.into(),
                accepted: "lights or surfaces".into(),
            }),
        }
    }
}

/// Cells, each with a list of lights.
#[derive(Debug)]
pub struct Grid {
    counts: CellCounts,
    grid_box: GridBox,
    settings: CullSettings,
    cells: wgpu::Buffer,
    culler: Culler,
}

/// The strategy's WESL module: `group_of` and `group_bounds`.
pub const GRID_WESL: &str = include_str!("shaders/grid.wesl");

impl Grid {
    /// Makes the strategy; `counts` are checked.
    pub fn new(
        gpu: &Gpu,
        counts: CellCounts,
        grid_box: GridBox,
        settings: CullSettings,
    ) -> Result<Self, AssignError> {
        counts.check()?;
        let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
        Ok(Self {
            counts,
            grid_box,
            settings,
            cells: gpu.uniform("cells", size_of::<CellsUniform>() as u64),
            culler: Culler::new(
                gpu,
                &CullerDescriptor {
                    label: "G",
                    shape: GroupShape::Box,
                    settings,
                    sparse: false,
                    facing: Facing::Unknown,
                    // SAFETY: it has no loop.
                    #[allow(unsafe_code, reason = "it has no loop")]
                    module: unsafe { StrategyModule::new(GRID_WESL) },
                    bindings: &[uniform_entry(FIRST_STRATEGY_BINDING, stages)],
                },
            )?,
        })
    }

    /// The box to cut, world space; a unit box where there are no lights.
    fn cut(&self, frame: &Frame<'_>) -> Result<(Vec3, Vec3), AssignError> {
        let lights = frame.lights.bounds().unwrap_or((Vec3::ZERO, Vec3::ONE));
        if self.grid_box == GridBox::Lights {
            return Ok(lights);
        }
        let missing = || AssignError::Missing { strategy: self.id(), missing: "surface_bounds" };
        let surfaces = frame.surface_bounds.ok_or_else(missing)?;
        if surfaces.0.is_nan() || surfaces.1.is_nan() {
            return Err(AssignError::Parameter {
                field: "surface_bounds".into(),
                value: format!("{} to {}", surfaces.0, surfaces.1),
                accepted: "two corners, in numbers".into(),
            });
        }
        // Where the boxes are apart no light reaches a surface, and any cells will do.
        Ok((lights.0.max(surfaces.0), lights.1.min(surfaces.1)))
    }
}

impl Assignment for Grid {
    fn id(&self) -> String {
        let grid_box = match self.grid_box {
            GridBox::Lights => "",
            GridBox::Surfaces => "/surfaces",
        };
        format!("G/{}{grid_box}{}", self.counts, self.settings.suffix(GroupShape::Box))
    }

    fn needs(&self) -> Needs {
        Needs::default()
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        frame.view.check()?;
        let cells = CellsUniform::new(self.counts, self.cut(frame)?, frame.lights.bounds());
        gpu.queue.write_buffer(&self.cells, 0, bytes_of(&cells));
        self.culler.prepare(
            gpu,
            frame,
            Groups::All(cells.group_count()),
            &[entry(FIRST_STRATEGY_BINDING, &self.cells)],
        )
    }

    fn record(&mut self, _frame: &Frame<'_>, passes: &mut dyn Passes) {
        self.culler.record(passes);
    }

    fn lookup(&self) -> Lookup<'_> {
        self.culler.lookup()
    }

    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.culler.bind_group()
    }

    fn lists(&self) -> &LightLists {
        self.culler.lists()
    }

    fn lists_mut(&mut self) -> &mut LightLists {
        self.culler.lists_mut()
    }

    fn memory_bytes(&self) -> u64 {
        self.cells.size() + self.culler.memory_bytes()
    }
}
