//! The strategy G: a grid of cells in world space.

use assign::{
    AssignError, Assignment, CullSettings, Culler, CullerDescriptor, FIRST_STRATEGY_BINDING,
    Facing, Frame, Gpu, GroupShape, Groups, LightLists, LightTraits, Lookup, Needs, Passes,
    StrategyModule, entry, uniform_entry,
};
use bytemuck::bytes_of;
use glam::Vec3;

use crate::{
    cells::{CellCounts, CellsUniform, GRID_WESL},
    grid_box::{GridBox, frustum_box, position_slack_m},
    visible::{AskedCells, VisibleBox},
};

/// The grid strategy: each cell has a list of lights.
#[derive(Debug)]
pub struct Grid {
    counts: CellCounts,
    grid_box: GridBox,
    settings: CullSettings,
    cells: wgpu::Buffer,
    /// Makes the cells on the GPU; only for [`GridBox::Visible`].
    visible: Option<VisibleBox>,
    culler: Culler,
}

impl Grid {
    /// Makes the strategy. Checks `counts`.
    pub fn new(
        gpu: &Gpu,
        counts: CellCounts,
        grid_box: GridBox,
        settings: CullSettings,
    ) -> Result<Self, AssignError> {
        counts.check()?;
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
                    bindings: &bindings(),
                },
            )?,
            // After the check of limits.
            visible: match grid_box {
                GridBox::Visible => Some(VisibleBox::new(gpu)?),
                _ => None,
            },
        })
    }

    /// What the strategy needs of a device with such settings.
    pub fn required_limits(settings: CullSettings) -> wgpu::Limits {
        Culler::required_limits(&bindings(), false, settings)
    }

    /// The same strategy for another view: [`Assignment::for_view`].
    ///
    /// # Errors
    ///
    /// [`AssignError::OutOfMemory`] if the device has no memory left.
    pub fn view(&self, gpu: &Gpu) -> Result<Self, AssignError> {
        let mut view = Self::new(gpu, self.counts, self.grid_box, self.settings)?;
        view.culler.share(&self.culler);
        Ok(view)
    }

    /// The cells that the CPU makes. Without lights they divide a unit box.
    fn cells(&self, frame: &Frame<'_>) -> Result<CellsUniform, AssignError> {
        let lights = frame.light_bounds();
        let supports = lights.unwrap_or((Vec3::ZERO, Vec3::ONE));
        let overlap = |(low, high): (Vec3, Vec3)| (supports.0.max(low), supports.1.min(high));
        let cells = |cut| CellsUniform::new(self.counts, cut, lights);
        Ok(match self.grid_box {
            GridBox::Positions => cells(frame.light_position_bounds().unwrap_or(supports)),
            GridBox::Supports | GridBox::Visible => cells(supports),
            // If the boxes do not overlap, no light reaches a surface, and any cells are right.
            GridBox::Surfaces => cells(overlap(self.surfaces(frame)?)),
            GridBox::Frustum => {
                let frustum = frustum_box(frame.view, supports);
                let slack_m = position_slack_m(frame.view, frustum);
                cells(overlap(frustum)).within(frustum, slack_m)
            }
        })
    }

    /// The box around all surfaces, world space.
    fn surfaces(&self, frame: &Frame<'_>) -> Result<(Vec3, Vec3), AssignError> {
        let missing = || AssignError::Missing { strategy: self.id(), missing: "surface_bounds" };
        let surfaces = frame.surface_bounds.ok_or_else(missing)?;
        if surfaces.0.is_nan() || surfaces.1.is_nan() {
            return Err(AssignError::Parameter {
                field: "surface_bounds".into(),
                value: format!("{} to {}", surfaces.0, surfaces.1),
                accepted: "two corners, in numbers".into(),
            });
        }
        Ok(surfaces)
    }

    /// Makes the cells on the CPU, or has the GPU make them. Returns the number of groups.
    fn prepare_cells(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<u32, AssignError> {
        let id = self.id();
        let Some(visible) = &mut self.visible else {
            let cells = self.cells(frame)?;
            self.culler.writes_mut().write(&self.cells, 0, bytes_of(&cells))?;
            return Ok(cells.group_count());
        };
        let depths = frame.surface_and_layer_depths(&id)?;
        let lights = frame.light_bounds().unwrap_or((Vec3::ZERO, Vec3::ONE));
        let asked = AskedCells::new(self.counts, lights);
        visible.prepare(gpu, frame, &depths, asked, self.culler.writes_mut())?;
        Ok(self.counts.0.iter().product())
    }
}

/// The strategy's resources that culling and the look-up read.
fn bindings() -> [wgpu::BindGroupLayoutEntry; 1] {
    let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
    [uniform_entry(FIRST_STRATEGY_BINDING, stages)]
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
        Needs {
            depth: self.visible.is_some(),
            hierarchy: self.culler.reads_hierarchy(),
            occluders: self.culler.reads_occluders(),
            ..Needs::default()
        }
    }

    fn is_view_bound(&self) -> bool {
        self.grid_box.is_view_bound()
    }

    fn updates_groups(&self) -> bool {
        true
    }

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(self.view(gpu)?))
    }

    fn compile(&mut self, gpu: &Gpu, lights: LightTraits) -> Result<(), AssignError> {
        self.culler.compile(gpu, lights)
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        frame.view.check()?;
        let count = self.prepare_cells(gpu, frame)?;
        self.culler.prepare(
            gpu,
            frame,
            Groups::All(count),
            &[entry(FIRST_STRATEGY_BINDING, &self.cells)],
        )
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        if let Some(visible) = &self.visible
            && frame.changes.is_none()
        {
            self.culler.record_writes(passes);
            visible.record(frame.view, &self.cells, passes);
        }
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
        let visible = self.visible.as_ref().map_or(0, VisibleBox::bytes);
        self.cells.size() + visible + self.culler.memory_bytes()
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
            let cells = grid.cells(&frame).unwrap();
            let cut = CellsUniform::new(
                grid.counts,
                (Vec3::splat(low), Vec3::splat(high)),
                lights.bounds(),
            );
            assert_eq!((cells, grid.id().as_str()), (cut, id));
            // Samples outside the box find every light that may reach them.
            assert_eq!((cells.reach_min, cells.reach_max), ([-2.0; 3], [10.0; 3]), "{id}");
            assert!(!grid.is_view_bound() && !grid.needs().depth, "{id}");
        }
        for grid_box in [GridBox::Frustum, GridBox::Visible] {
            let settings = CullSettings::default();
            let grid = Grid::new(&gpu, CellCounts([4, 4, 4]), grid_box, settings).unwrap();
            assert_eq!(grid.id(), format!("G/4x4x4/{}", grid_box.name()));
            assert_eq!(grid.needs().depth, grid_box == GridBox::Visible);
            assert!(grid.is_view_bound());
        }
    }
}
