//! DC-I: dense clusters with implicit bounds.

use assign::{
    AssignError, Assignment, Culler, CullerDescriptor, FIRST_STRATEGY_BINDING, Frame, FrustumTests,
    Gpu, GroupShape, LightLists, Lookup, Needs, Passes, entry, uniform_entry,
};
use bytemuck::bytes_of;

use crate::clusters::{ClusterSize, ClustersUniform};

/// Dense clusters, each tested by its own frustum.
#[derive(Debug)]
pub struct DenseImplicit {
    size: ClusterSize,
    clusters: wgpu::Buffer,
    culler: Culler,
}

/// The strategy's WESL module: `group_of` and `group_bounds`.
pub const DENSE_IMPLICIT_WESL: &str = include_str!("shaders/dense_implicit.wesl");

impl DenseImplicit {
    /// Makes the strategy; `size` is checked, `tests` are HS plus what is asked for.
    pub fn new(gpu: &Gpu, size: ClusterSize, tests: FrustumTests) -> Result<Self, AssignError> {
        size.check()?;
        let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
        Ok(Self {
            size,
            clusters: gpu.uniform("clusters", size_of::<ClustersUniform>() as u64),
            culler: Culler::new(
                gpu,
                &CullerDescriptor {
                    label: "DC-I",
                    shape: GroupShape::Frustum(tests),
                    module: DENSE_IMPLICIT_WESL,
                    bindings: &[uniform_entry(FIRST_STRATEGY_BINDING, stages)],
                },
            )?,
        })
    }
}

impl Assignment for DenseImplicit {
    fn id(&self) -> String {
        format!("DC-I/{}", self.size)
    }

    fn needs(&self) -> Needs {
        Needs::default()
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        frame.view.check()?;
        let clusters = ClustersUniform::new(self.size, frame.view, frame.lights.bounds())?;
        gpu.queue.write_buffer(&self.clusters, 0, bytes_of(&clusters));
        self.culler.prepare(
            gpu,
            frame,
            clusters.group_count(),
            &[entry(FIRST_STRATEGY_BINDING, &self.clusters)],
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
}
