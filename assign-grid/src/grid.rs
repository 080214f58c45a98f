//! The strategy G: a grid of cells in world space.

use std::str::FromStr;

use assign::{
    AssignError, Assignment, CullSettings, Culler, CullerDescriptor, FIRST_STRATEGY_BINDING,
    Facing, Frame, Gpu, GroupShape, Groups, LightLists, Lookup, Needs, Passes, StrategyModule,
    entry, uniform_entry,
};
use bytemuck::bytes_of;
use glam::Vec3;

use crate::cells::{CellCounts, CellsUniform};

/// The box that is cut into cells. Look-ups outside the box stay exact: a sample belongs to the
/// nearest cell, and cells at the border extend outwards as far as any light reaches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum GridBox {
    /// The box around the lights' positions, as in the comparison paper (Enhuber 2019, sections 3.3
    /// and 4.1).
    ///
    /// Extending a border cell adds no point light to its list: the light's centre lies in the box,
    /// so the nearest point of the extended cell lies in the box as well.
    #[default]
    Positions,
    /// The box around the lights' supports. No light reaches a sample outside it. It is larger than
    /// the box of the positions by a range on each side, so cells are coarser.
    Supports,
    /// The intersection of the box around the supports and the box around the surfaces.
    Surfaces,
}

impl GridBox {
    /// The name in ids: `positions`, `supports` or `surfaces`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Positions => "positions",
            Self::Supports => "supports",
            Self::Surfaces => "surfaces",
        }
    }
}

impl FromStr for GridBox {
    type Err = AssignError;

    /// Reads `positions`, `supports` or `surfaces`. Also reads `lights`, the former name of
    /// `supports`.
    fn from_str(text: &str) -> Result<Self, AssignError> {
        match text {
            "positions" => Ok(Self::Positions),
            "supports" | "lights" => Ok(Self::Supports),
            "surfaces" => Ok(Self::Surfaces),
            _ => Err(AssignError::Parameter {
                field: "grid box".into(),
                value: text.into(),
                accepted: "positions, supports or surfaces".into(),
            }),
        }
    }
}

/// The grid strategy: each cell has a list of lights.
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
    /// Makes the strategy. Checks `counts`.
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

    /// The box to cut, world space; a unit box without lights.
    fn cut(&self, frame: &Frame<'_>) -> Result<(Vec3, Vec3), AssignError> {
        let none = (Vec3::ZERO, Vec3::ONE);
        let lights = frame.light_bounds().unwrap_or(none);
        match self.grid_box {
            GridBox::Positions => return Ok(frame.light_position_bounds().unwrap_or(none)),
            GridBox::Supports => return Ok(lights),
            GridBox::Surfaces => {}
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
        // If the boxes do not overlap, no light reaches a surface, and any cells are right.
        Ok((lights.0.max(surfaces.0), lights.1.min(surfaces.1)))
    }
}

impl Assignment for Grid {
    fn id(&self) -> String {
        let grid_box = match self.grid_box {
            GridBox::Positions => String::new(),
            other => format!("/{}", other.name()),
        };
        format!("G/{}{grid_box}{}", self.counts, self.settings.suffix(GroupShape::Box))
    }

    fn needs(&self) -> Needs {
        Needs { hierarchy: self.culler.reads_hierarchy(), ..Needs::default() }
    }

    fn is_view_bound(&self) -> bool {
        false
    }

    fn updates_groups(&self) -> bool {
        true
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        frame.view.check()?;
        let cells = CellsUniform::new(self.counts, self.cut(frame)?, frame.light_bounds());
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

#[cfg(test)]
mod tests {
    use assign::{Light, LightBuffer, View};

    use super::*;

    #[test]
    fn ids_name_the_box_that_is_cut() {
        let gpu = Gpu::noop().unwrap();
        let at = |place: f32| Light::point(Vec3::splat(place), 2.0, Vec3::ONE);
        let lights = LightBuffer::new(&gpu, &[at(0.0), at(8.0)]).unwrap();
        let view = View::look_at(Vec3::ONE, Vec3::ZERO, 1.0, 0.1, [64, 48]);
        let frame = Frame::new(&view, &lights).with_surface_bounds(Vec3::NEG_ONE, Vec3::splat(9.0));
        for (grid_box, low, high, id) in [
            (GridBox::default(), 0.0, 8.0, "G/4x4x4"),
            (GridBox::Positions, 0.0, 8.0, "G/4x4x4"),
            (GridBox::Supports, -2.0, 10.0, "G/4x4x4/supports"),
            (GridBox::Surfaces, -1.0, 9.0, "G/4x4x4/surfaces"),
        ] {
            let settings = CullSettings::default();
            let grid = Grid::new(&gpu, CellCounts([4, 4, 4]), grid_box, settings).unwrap();
            let cut = (Vec3::splat(low), Vec3::splat(high));
            assert_eq!((grid.cut(&frame).unwrap(), grid.id().as_str()), (cut, id));
            assert_eq!(grid_box.name().parse::<GridBox>().unwrap(), grid_box);
            // Samples outside the box find every light that may reach them.
            let cells = CellsUniform::new(grid.counts, cut, lights.bounds());
            assert_eq!((cells.lights_min, cells.lights_max), ([-2.0; 3], [10.0; 3]), "{id}");
        }
        assert_eq!("lights".parse::<GridBox>().unwrap(), GridBox::Supports);
        let error = "cells".parse::<GridBox>().unwrap_err().to_string();
        assert!(error.contains("positions, supports or surfaces"), "{error}");
    }
}
