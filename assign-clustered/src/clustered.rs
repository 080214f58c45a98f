//! DC-I, DC-E, SC-I and SC-E: clusters on the axes of bounds, occupancy and normals.

use assign::{
    AssignError, Assignment, Bounds, CullSettings, Culler, CullerDescriptor,
    FIRST_STRATEGY_BINDING, Frame, Gpu, GroupShape, Groups, LightLists, Lookup, Needs, Passes,
    SampleDomain, StrategyModule, entry, storage_entry, uniform_entry,
};
use bytemuck::bytes_of;

use crate::{
    Normals, SpecularCut,
    clusters::{ClusterSize, ClustersUniform},
    gather::{Gather, Images},
};

/// Which clusters get a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Occupancy {
    /// All.
    Dense,
    /// Those that hold a sample.
    Sparse,
}

/// Clusters, each with a list of lights.
#[derive(Debug)]
pub struct Clustered {
    size: ClusterSize,
    bounds: Bounds,
    occupancy: Occupancy,
    normals: Normals,
    cut: SpecularCut,
    settings: CullSettings,
    clusters: wgpu::Buffer,
    gather: Option<Gather>,
    culler: Culler,
}

/// The WESL module of clusters bounded by their frusta: `group_of` and `group_bounds`.
pub const IMPLICIT_WESL: &str = concat!(
    include_str!("shaders/clusters.wesl"),
    include_str!("shaders/by_cluster.wesl"),
    include_str!("shaders/implicit.wesl"),
);

/// The WESL module of clusters bounded by the samples in them: `group_of` and `group_bounds`.
pub const EXPLICIT_WESL: &str = concat!(
    include_str!("shaders/clusters.wesl"),
    include_str!("shaders/by_cluster.wesl"),
    include_str!("shaders/explicit.wesl"),
    "const WORDS: u32 = 6u;\n",
);

/// The WESL module of clusters bounded by the samples in them and split by their normals:
/// `group_of`, `group_bounds`, `group_facing` and `group_reflection`.
pub const BINS_WESL: &str = concat!(
    include_str!("shaders/clusters.wesl"),
    include_str!("shaders/by_bin.wesl"),
    include_str!("shaders/explicit.wesl"),
    include_str!("shaders/reflection_of_bin.wesl"),
    "const WORDS: u32 = 12u;\n",
);

/// [`BINS_WESL`] of clusters that know how their samples reflect as well: `group_gloss`.
pub const GLOSSY_BINS_WESL: &str = concat!(
    include_str!("shaders/clusters.wesl"),
    include_str!("shaders/by_bin.wesl"),
    include_str!("shaders/explicit.wesl"),
    include_str!("shaders/gloss_of_bin.wesl"),
    "const WORDS: u32 = 15u;\n",
);

impl Clustered {
    /// Makes the strategy; `size` is checked.
    pub fn new(
        gpu: &Gpu,
        size: ClusterSize,
        bounds: Bounds,
        occupancy: Occupancy,
        settings: CullSettings,
    ) -> Result<Self, AssignError> {
        let (normals, cut) = (Normals::None, SpecularCut::None);
        Self::with_normals(gpu, size, bounds, occupancy, normals, cut, settings)
    }

    /// Makes the strategy with clusters split by normals, and with a cut of specular light. Only sparse
    /// clusters with explicit bounds can have either. All parameters are checked.
    pub fn with_normals(
        gpu: &Gpu,
        size: ClusterSize,
        bounds: Bounds,
        occupancy: Occupancy,
        normals: Normals,
        cut: SpecularCut,
        settings: CullSettings,
    ) -> Result<Self, AssignError> {
        size.check()?;
        normals.check()?;
        cut.check(normals)?;
        let glossy = cut.is_glossy();
        let is_plain = !normals.is_some() && cut == SpecularCut::None;
        if !is_plain && (bounds, occupancy) != (Bounds::Explicit, Occupancy::Sparse) {
            let asked = match normals.is_some() {
                true => format!("{} bins of normals", normals.bins()),
                false => format!("the specular cut {cut:?}"),
            };
            return Err(AssignError::Unsupported {
                strategy: family(bounds, occupancy).into(),
                asked,
                reason: "only sparse clusters with explicit bounds, SC-E, are split by normals \
                         or leave specular light out"
                    .into(),
            });
        }
        let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
        let clusters = uniform_entry(FIRST_STRATEGY_BINDING, stages);
        let boxes = storage_entry(FIRST_STRATEGY_BINDING + 1, stages, true);
        let (module, bindings) = match bounds {
            Bounds::Implicit => (IMPLICIT_WESL, vec![clusters]),
            Bounds::Explicit if glossy => (GLOSSY_BINS_WESL, vec![clusters, boxes]),
            Bounds::Explicit if normals.is_some() => (BINS_WESL, vec![clusters, boxes]),
            Bounds::Explicit => (EXPLICIT_WESL, vec![clusters, boxes]),
        };
        let sparse = occupancy == Occupancy::Sparse;
        let reads_samples = sparse || bounds == Bounds::Explicit;
        Ok(Self {
            size,
            bounds,
            occupancy,
            normals,
            cut,
            settings,
            clusters: gpu.uniform("clusters", size_of::<ClustersUniform>() as u64),
            gather: match reads_samples {
                true => Some(Gather::new(gpu, bounds, occupancy, normals, glossy)?),
                false => None,
            },
            culler: Culler::new(
                gpu,
                &CullerDescriptor {
                    label: family(bounds, occupancy),
                    shape: shape(bounds),
                    settings,
                    sparse,
                    facing: cut.facing(normals),
                    // SAFETY: it has no loop.
                    #[allow(unsafe_code, reason = "it has no loop")]
                    module: unsafe { StrategyModule::new(module) },
                    bindings: &bindings,
                },
            )?,
        })
    }
}

fn family(bounds: Bounds, occupancy: Occupancy) -> &'static str {
    match (occupancy, bounds) {
        (Occupancy::Dense, Bounds::Implicit) => "DC-I",
        (Occupancy::Dense, Bounds::Explicit) => "DC-E",
        (Occupancy::Sparse, Bounds::Implicit) => "SC-I",
        (Occupancy::Sparse, Bounds::Explicit) => "SC-E",
    }
}

fn shape(bounds: Bounds) -> GroupShape {
    match bounds {
        Bounds::Implicit => GroupShape::Frustum,
        Bounds::Explicit => GroupShape::Box,
    }
}

impl Assignment for Clustered {
    fn id(&self) -> String {
        let suffix = self.settings.suffix(shape(self.bounds));
        let normals = self.normals.segment();
        let cut = self.cut.segment();
        format!("{}/{}{normals}{cut}{suffix}", family(self.bounds, self.occupancy), self.size)
    }

    fn needs(&self) -> Needs {
        Needs {
            depth: self.gather.is_some(),
            normals: self.normals.is_some(),
            materials: self.cut.is_glossy(),
            ..Needs::default()
        }
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        frame.view.check()?;
        let mut clusters =
            ClustersUniform::new(self.size, self.normals, frame.view, frame.lights.bounds())?;
        let count = clusters.group_count();
        let mut groups = Groups::All(count);
        let mut resources = vec![entry(FIRST_STRATEGY_BINDING, &self.clusters)];
        let id = self.id();
        if let Some(gather) = &mut self.gather {
            if frame.samples == SampleDomain::AnyDepth {
                return Err(AssignError::Unsupported {
                    strategy: id,
                    asked: "look-ups at any depth".into(),
                    reason: "its lists are made for the opaque surfaces in the depth buffer".into(),
                });
            }
            let missing = |missing| AssignError::Missing { strategy: id.clone(), missing };
            let images = Images {
                depth: frame.depth.ok_or_else(|| missing("depth"))?,
                normals: match self.normals {
                    Normals::None => None,
                    Normals::Bins(_) => Some(frame.normals.ok_or_else(|| missing("normals"))?),
                },
                base_color: match self.cut.is_glossy() {
                    false => None,
                    true => Some(frame.base_color.ok_or_else(|| missing("base colours"))?),
                },
            };
            clusters.surfaces_only = 1;
            clusters.specular_limit = self.cut.limit();
            gather.prepare(gpu, frame, images, &self.clusters, count)?;
            if self.occupancy == Occupancy::Sparse {
                groups = Groups::Live { count, live: gather.live() };
            }
            if self.bounds == Bounds::Explicit {
                resources.push(entry(FIRST_STRATEGY_BINDING + 1, gather.marks()));
            }
        }
        gpu.queue.write_buffer(&self.clusters, 0, bytes_of(&clusters));
        self.culler.prepare(gpu, frame, groups, &resources)
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        if let Some(gather) = &self.gather {
            gather.record(frame.view, passes);
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
        let gather = self.gather.as_ref().map_or(0, Gather::bytes);
        self.clusters.size() + gather + self.culler.memory_bytes()
    }
}
