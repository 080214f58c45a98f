//! DC-I, DC-E, SC-I and SC-E: clusters on the axes of bounds, occupancy and normals.

use assign::{
    AssignError, Assignment, Bounds, CullSettings, Culler, CullerDescriptor,
    FIRST_STRATEGY_BINDING, Facing, Frame, Gpu, GroupShape, Groups, LightLists, Lookup, Needs,
    Passes, SampleDomain, StrategyModule, entry, storage_entry, uniform_entry,
};
use bytemuck::bytes_of;

use crate::{
    Normals,
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
    /// 0 where no specular light is left out.
    specular_threshold: f32,
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
/// `group_of`, `group_bounds` and `group_facing`.
pub const BINS_WESL: &str = concat!(
    include_str!("shaders/clusters.wesl"),
    include_str!("shaders/by_bin.wesl"),
    include_str!("shaders/explicit.wesl"),
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

/// How far the specular cut goes.
const THRESHOLDS: std::ops::RangeInclusive<f32> = 0.0..=1e18;

impl Clustered {
    /// Makes the strategy; `size` is checked.
    pub fn new(
        gpu: &Gpu,
        size: ClusterSize,
        bounds: Bounds,
        occupancy: Occupancy,
        settings: CullSettings,
    ) -> Result<Self, AssignError> {
        Self::with_normals(gpu, size, bounds, occupancy, Normals::None, 0.0, settings)
    }

    /// Makes the strategy with clusters split by normals. Only sparse clusters with explicit bounds
    /// can be split.
    ///
    /// A `specular_threshold` above 0, a radiance, is **lossy**: area lights lose their specular
    /// term where less than that of it reaches the eye from any sample of a group. It takes normals.
    /// All parameters are checked.
    pub fn with_normals(
        gpu: &Gpu,
        size: ClusterSize,
        bounds: Bounds,
        occupancy: Occupancy,
        normals: Normals,
        specular_threshold: f32,
        settings: CullSettings,
    ) -> Result<Self, AssignError> {
        size.check()?;
        normals.check()?;
        check_threshold(specular_threshold, normals)?;
        let glossy = specular_threshold > 0.0;
        if normals.is_some() && (bounds, occupancy) != (Bounds::Explicit, Occupancy::Sparse) {
            return Err(AssignError::Unsupported {
                strategy: family(bounds, occupancy).into(),
                asked: format!("{} bins of normals", normals.bins()),
                reason: "only sparse clusters with explicit bounds, SC-E, are split by normals"
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
            specular_threshold,
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
                    facing: match normals.is_some() {
                        true if glossy => Facing::HorizonAndGloss,
                        true => Facing::Horizon,
                        false => Facing::Unknown,
                    },
                    // SAFETY: it has no loop.
                    #[allow(unsafe_code, reason = "it has no loop")]
                    module: unsafe { StrategyModule::new(module) },
                    bindings: &bindings,
                },
            )?,
        })
    }
}

fn check_threshold(threshold: f32, normals: Normals) -> Result<(), AssignError> {
    let accepted = match normals {
        Normals::None => 0.0..=0.0,
        Normals::Bins(_) => THRESHOLDS,
    };
    if accepted.contains(&threshold) {
        return Ok(());
    }
    Err(AssignError::Parameter {
        field: "specular threshold".into(),
        value: threshold.to_string(),
        accepted: match normals {
            Normals::None => "0 without bins of normals".into(),
            Normals::Bins(_) => "a radiance from 0 to 1e18".into(),
        },
    })
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
        let cut = match self.specular_threshold > 0.0 {
            true => format!("/s{}", self.specular_threshold),
            false => String::new(),
        };
        format!("{}/{}{normals}{cut}{suffix}", family(self.bounds, self.occupancy), self.size)
    }

    fn needs(&self) -> Needs {
        Needs {
            depth: self.gather.is_some(),
            normals: self.normals.is_some(),
            materials: self.specular_threshold > 0.0,
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
                base_color: match self.specular_threshold > 0.0 {
                    false => None,
                    true => Some(frame.base_color.ok_or_else(|| missing("base colours"))?),
                },
            };
            clusters.surfaces_only = 1;
            clusters.specular_threshold = self.specular_threshold;
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
