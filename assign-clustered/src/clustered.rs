//! DC-I, DC-E, SC-I and SC-E: clusters by bounds, by occupancy and by normals.

use assign::{
    AssignError, Assignment, Bounds, CullSettings, Culler, CullerDescriptor, Frame, Gpu,
    GroupShape, Groups, LightLists, Lookup, Needs, Passes, SampleDomain, StrategyModule, entry,
    storage_entry, uniform_entry,
};
use bytemuck::bytes_of;

use crate::{
    Normals, Occupancy, Slices, SpecularCut,
    cluster_wesl::cluster_wesl,
    froxels::{FROXELS_BINDING, FroxelSize, FroxelsUniform},
    gather::{Gather, Images},
    normal_bins::{BINS_BINDING, NormalBinsUniform, group_count},
};

/// Binding of the marks: `clusters.wesl`.
const MARKS_BINDING: u32 = FROXELS_BINDING + 1;

/// Clusters that each have a list of lights.
#[derive(Debug)]
pub struct Clustered {
    size: FroxelSize,
    slices: Slices,
    bounds: Bounds,
    occupancy: Occupancy,
    normals: Normals,
    cut: SpecularCut,
    settings: CullSettings,
    froxels: wgpu::Buffer,
    bins: wgpu::Buffer,
    gather: Option<Gather>,
    culler: Culler,
}

impl Clustered {
    /// Makes the strategy without normals and without a cut. Checks `size`.
    pub fn new(
        gpu: &Gpu,
        size: FroxelSize,
        bounds: Bounds,
        occupancy: Occupancy,
        settings: CullSettings,
    ) -> Result<Self, AssignError> {
        let (normals, cut) = (Normals::None, SpecularCut::None);
        Self::with_normals(gpu, size, bounds, occupancy, normals, cut, settings)
    }

    /// Makes the strategy with clusters split by normals and with a cut of specular light. Only sparse clusters
    /// with explicit bounds can have either. Checks all parameters.
    pub fn with_normals(
        gpu: &Gpu,
        size: FroxelSize,
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
                reason:
                    "only sparse clusters with explicit bounds, SC-E, can be split by normals or \
                         leave out specular light"
                        .into(),
            });
        }
        let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
        let mut bindings = vec![uniform_entry(FROXELS_BINDING, stages)];
        if bounds == Bounds::Explicit {
            bindings.push(storage_entry(MARKS_BINDING, stages, true));
        }
        if normals.is_some() {
            bindings.push(uniform_entry(BINS_BINDING, stages));
        }
        let sparse = occupancy == Occupancy::Sparse;
        let reads_samples = sparse || bounds == Bounds::Explicit;
        Ok(Self {
            size,
            slices: Slices::default(),
            bounds,
            occupancy,
            normals,
            cut,
            settings,
            froxels: gpu.uniform("froxels", size_of::<FroxelsUniform>() as u64),
            bins: gpu.uniform("normal bins", size_of::<NormalBinsUniform>() as u64),
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
                    // SAFETY: the modules of clusters have no loop.
                    #[allow(unsafe_code, reason = "they have no loop")]
                    module: unsafe { StrategyModule::new(cluster_wesl(bounds, normals, glossy)) },
                    bindings: &bindings,
                },
            )?,
        })
    }

    /// The same with depth cut into other slices. Checks them.
    pub fn with_slices(self, slices: Slices) -> Result<Self, AssignError> {
        slices.check()?;
        Ok(Self { slices, ..self })
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
        let slices = self.slices.segment();
        format!(
            "{}/{}{slices}{normals}{cut}{suffix}",
            family(self.bounds, self.occupancy),
            self.size
        )
    }

    fn needs(&self) -> Needs {
        Needs {
            depth: self.gather.is_some(),
            normals: self.normals.is_some(),
            hierarchy: self.culler.reads_hierarchy(),
            materials: self.cut.is_glossy(),
            ..Needs::default()
        }
    }

    fn updates_groups(&self) -> bool {
        true
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        frame.view.check()?;
        let mut froxels =
            FroxelsUniform::new(self.size, self.slices, frame.view, frame.light_bounds())?;
        let count = group_count(self.size, &froxels, self.normals, frame.view.viewport)?;
        let mut groups = Groups::All(count);
        let mut resources = vec![entry(FROXELS_BINDING, &self.froxels)];
        let id = self.id();
        if let Some(gather) = &mut self.gather {
            if frame.samples == SampleDomain::AnyDepth {
                return Err(AssignError::Unsupported {
                    strategy: id,
                    asked: "look-ups at any depth".into(),
                    reason: "its lists serve only the opaque surfaces in the depth buffer".into(),
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
            froxels.surfaces_only = 1;
            gather.prepare(gpu, frame, images, [&self.froxels, &self.bins], count)?;
            if self.occupancy == Occupancy::Sparse {
                groups = Groups::Live { count, live: gather.live() };
            }
            if self.bounds == Bounds::Explicit {
                resources.push(entry(MARKS_BINDING, gather.marks()));
            }
        }
        gpu.queue.write_buffer(&self.froxels, 0, bytes_of(&froxels));
        if self.normals.is_some() {
            let bins = NormalBinsUniform::new(self.normals, self.cut);
            gpu.queue.write_buffer(&self.bins, 0, bytes_of(&bins));
            resources.push(entry(BINS_BINDING, &self.bins));
        }
        self.culler.prepare(gpu, frame, groups, &resources)
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        if let Some(gather) = &self.gather
            && frame.changes.is_none()
        {
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
        let bins = if self.normals.is_some() { self.bins.size() } else { 0 };
        self.froxels.size() + bins + gather + self.culler.memory_bytes()
    }
}
