//! HG as a strategy: its look-up, its lists and its passes.

use assign::{
    AssignError, Assignment, Frame, Gpu, LightLists, LightTraits, ListsBindings, Lookup, Needs,
    Passes, SampleDomain, StrategyModule, check_limits, entry, storage_buffer_limits,
    uniform_entry,
};
use bytemuck::bytes_of;

use super::{Scatter, passes::HybridPasses, shader::HYBRID_WESL};
use crate::Slices;
use crate::froxels::{FROXELS_BINDING, FroxelSize, FroxelsUniform};

/// HG: a grid of cells that lights add themselves to.
#[derive(Debug)]
pub struct HybridGrid {
    size: FroxelSize,
    scatter: Scatter,
    froxels: wgpu::Buffer,
    lists: LightLists,
    look_up: ListsBindings,
    passes: HybridPasses,
}

impl HybridGrid {
    /// Makes the strategy with compute lanes that add lights to cells. Checks `size`.
    pub fn new(gpu: &Gpu, size: FroxelSize) -> Result<Self, AssignError> {
        Self::with_scatter(gpu, size, Scatter::Compute)
    }

    /// Makes the strategy. Checks `size`.
    pub fn with_scatter(
        gpu: &Gpu,
        size: FroxelSize,
        scatter: Scatter,
    ) -> Result<Self, AssignError> {
        size.check()?;
        check_limits(gpu, "HG", &Self::required_limits())?;
        let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
        Ok(Self {
            size,
            scatter,
            froxels: gpu.uniform("froxels", size_of::<FroxelsUniform>() as u64),
            lists: LightLists::new(gpu)?,
            look_up: ListsBindings::of_look_up(
                gpu,
                "HG",
                &[uniform_entry(FROXELS_BINDING, stages)],
            ),
            passes: HybridPasses::new(gpu, scatter)?,
        })
    }

    /// What the strategy needs of a device. `reserve` reads or writes records, entries, three buffers of cells and the
    /// live cells; `count` reads three buffers of lights and writes three of cells.
    pub fn required_limits() -> wgpu::Limits {
        storage_buffer_limits(6)
    }

    /// The same strategy for another view: [`Assignment::for_view`].
    ///
    /// # Errors
    ///
    /// [`AssignError::OutOfMemory`] if the device has no memory left.
    pub fn view(&self, gpu: &Gpu) -> Result<Self, AssignError> {
        let mut view = Self::with_scatter(gpu, self.size, self.scatter)?;
        view.lists.limit_as(&self.lists);
        view.passes.share(&self.passes);
        Ok(view)
    }
}

impl Assignment for HybridGrid {
    fn id(&self) -> String {
        format!("HG/{}{}", self.size, self.scatter.segment())
    }

    fn needs(&self) -> Needs {
        Needs { depth: true, ..Needs::default() }
    }

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(self.view(gpu)?))
    }

    fn compile(&mut self, gpu: &Gpu, lights: LightTraits) -> Result<(), AssignError> {
        self.passes.compile(gpu, lights.kinds).map(|_| ())
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        frame.view.check()?;
        let mut froxels =
            FroxelsUniform::new(self.size, Slices::default(), frame.view, frame.lights.bounds())?;
        froxels.serve(frame, &self.id())?;
        // Cells that only other samples can lie in would have no lists.
        let depth = match frame.samples {
            SampleDomain::OpaqueSurfaces => Some(frame.depth_image(&self.id())?),
            SampleDomain::NearSurfaces | SampleDomain::InFront | SampleDomain::AnyDepth => None,
        };
        froxels.surfaces_only = u32::from(depth.is_some());
        self.lists.prepare(gpu, frame.lights, froxels.froxel_count())?;
        self.lists.writes_mut().write(&self.froxels, 0, bytes_of(&froxels))?;
        self.look_up.bind(gpu, &self.lists, &[entry(FROXELS_BINDING, &self.froxels)]);
        self.passes.prepare(gpu, frame, &froxels, &self.froxels, &mut self.lists, depth.as_ref())
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        self.lists.record_reset(passes.encoder(), frame.lights.live_count());
        self.passes.record(frame, passes);
        self.lists.record_readback(passes.encoder());
    }

    fn lookup(&self) -> Lookup<'_> {
        // SAFETY: its modules have no loop.
        #[allow(unsafe_code, reason = "they have no loop")]
        let module = unsafe { StrategyModule::new(HYBRID_WESL) };
        Lookup { module, bindings: &self.look_up, shape: None }
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
        self.froxels.size() + self.lists.memory_bytes() + self.passes.bytes()
    }
}
