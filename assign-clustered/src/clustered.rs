//! DC-I, DC-E, SC-I, SC-E, DA-I and DA-E: clusters by bounds, by occupancy and by normals.

use assign::{
    AssignError, Assignment, Bounds, CullSettings, Culler, CullerDescriptor, Frame, Gpu, Groups,
    LightLists, LightTraits, Lookup, Needs, Passes, SampleDomain, StrategyModule, entry,
    storage_entry, uniform_entry,
};
use bytemuck::bytes_of;

use crate::{
    Occupancy,
    cluster_options::ClusterOptions,
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
    options: ClusterOptions,
    froxels: wgpu::Buffer,
    bins: wgpu::Buffer,
    gather: Option<Gather>,
    culler: Culler,
}

impl Clustered {
    /// Makes the strategy with exponential slices, without normals and without a cut. Checks `size`.
    pub fn new(
        gpu: &Gpu,
        size: FroxelSize,
        bounds: Bounds,
        occupancy: Occupancy,
        settings: CullSettings,
    ) -> Result<Self, AssignError> {
        Self::with_options(gpu, ClusterOptions::new(size, bounds, occupancy, settings))
    }

    /// Makes the strategy.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] for an option out of its range, [`AssignError::Unsupported`] for options that
    /// exclude each other, and [`AssignError::Limit`] on a device with less than the
    /// [required limits](Self::required_limits).
    pub fn with_options(gpu: &Gpu, options: ClusterOptions) -> Result<Self, AssignError> {
        options.check()?;
        let ClusterOptions { bounds, settings, .. } = options;
        let bindings = bindings(&options);
        let sparse = options.occupancy.is_sparse();
        let reads_samples = sparse || bounds == Bounds::Explicit;
        Ok(Self {
            options,
            froxels: gpu.uniform("froxels", size_of::<FroxelsUniform>() as u64),
            bins: gpu.uniform("normal bins", size_of::<NormalBinsUniform>() as u64),
            culler: Culler::new(
                gpu,
                &CullerDescriptor {
                    label: options.family(),
                    shape: options.shape(),
                    settings,
                    sparse,
                    facing: options.facing(),
                    // SAFETY: the modules of clusters have loops over four cascades, and no others.
                    #[allow(unsafe_code, reason = "their loops end")]
                    module: unsafe { StrategyModule::new(cluster_wesl(&options)) },
                    bindings: &bindings,
                },
            )?,
            // After the check of limits.
            gather: match reads_samples {
                true => Some(Gather::new(gpu, &options)?),
                false => None,
            },
        })
    }

    /// What the strategy needs of a device for such options.
    pub fn required_limits(options: &ClusterOptions) -> wgpu::Limits {
        Culler::required_limits(&bindings(options), options.occupancy.is_sparse(), options.settings)
    }

    /// The same strategy for another view: [`Assignment::for_view`].
    ///
    /// # Errors
    ///
    /// [`AssignError::OutOfMemory`] if the device has no memory left.
    pub fn view(&self, gpu: &Gpu) -> Result<Self, AssignError> {
        let mut view = Self::with_options(gpu, self.options)?;
        view.culler.share(&self.culler);
        Ok(view)
    }
}

/// The strategy's resources that culling and the look-up read.
fn bindings(options: &ClusterOptions) -> Vec<wgpu::BindGroupLayoutEntry> {
    let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
    let mut bindings = vec![uniform_entry(FROXELS_BINDING, stages)];
    if options.bounds == Bounds::Explicit {
        bindings.push(storage_entry(MARKS_BINDING, stages, true));
    }
    if options.normals.is_some() {
        bindings.push(uniform_entry(BINS_BINDING, stages));
    }
    bindings
}

/// What the pass `bounds` reads.
fn read_images<'a>(
    options: &ClusterOptions,
    id: &str,
    frame: &Frame<'a>,
) -> Result<Images<'a>, AssignError> {
    if !options.reads_normals() {
        let mut depths = frame.surface_and_layer_depths(id)?;
        if options.occupancy == Occupancy::DepthAware {
            // One workgroup reads one tile of one image. Samples of layers read all lights.
            depths.truncate(1);
        }
        return Ok(Images { depths, normals: None, base_color: None });
    }
    let reason = "its lists depend on the normals in the G-buffer, and these samples have others";
    frame.check_domain(id, &[SampleDomain::OpaqueSurfaces], reason)?;
    let reason = "the G-buffer has one normal per pixel";
    Ok(Images {
        depths: vec![frame.surface_depth(id)?.with_one_sample(reason)?],
        normals: Some(frame.normal_image(id)?),
        base_color: match options.reads_materials() {
            false => None,
            true => Some(frame.base_color_image(id)?),
        },
    })
}

impl Assignment for Clustered {
    fn id(&self) -> String {
        let ClusterOptions { size, slices, normals, cut, reach, settings, .. } = self.options;
        format!(
            "{}/{size}{}{}{}{}{}",
            self.options.family(),
            slices.segment(),
            normals.segment(),
            cut.segment(),
            reach.map(|most| format!("/reach{most}")).unwrap_or_default(),
            settings.suffix(self.options.shape()),
        )
    }

    fn needs(&self) -> Needs {
        Needs {
            depth: self.gather.is_some(),
            normals: self.options.reads_normals(),
            hierarchy: self.culler.reads_hierarchy(),
            occluders: self.culler.reads_occluders(),
            materials: self.options.reads_materials(),
            ..Needs::default()
        }
    }

    fn updates_groups(&self) -> bool {
        // Changed lights are looked for within their range.
        self.options.reach.is_none()
    }

    fn specular_reach(&self) -> f32 {
        self.options.reach.unwrap_or(1.0)
    }

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(self.view(gpu)?))
    }

    fn compile(&mut self, gpu: &Gpu, lights: LightTraits) -> Result<(), AssignError> {
        self.culler.compile(gpu, lights)
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        frame.view.check()?;
        let mut froxels = FroxelsUniform::new(
            self.options.size,
            self.options.slices,
            frame.view,
            frame.light_bounds(),
        )?;
        froxels.serve(frame, &self.id())?;
        let count =
            group_count(self.options.size, &froxels, self.options.normals, frame.view.viewport)?;
        let mut groups = Groups::All(count);
        let mut resources = vec![entry(FROXELS_BINDING, &self.froxels)];
        let id = self.id();
        let mut images = None;
        if let Some(gather) = &mut self.gather {
            let read = images.insert(read_images(&self.options, &id, frame)?);
            froxels.surfaces_only = 1;
            froxels.specular_reach = self.options.reach.unwrap_or(1.0);
            let writes = self.culler.writes_mut();
            gather.prepare(gpu, frame, &read.depths[0], &froxels, count, writes)?;
            if self.options.occupancy.is_sparse() {
                groups = Groups::Live { count, live: gather.live() };
            }
            if self.options.bounds == Bounds::Explicit {
                resources.push(entry(MARKS_BINDING, gather.marks()));
            }
        }
        self.culler.writes_mut().write(&self.froxels, 0, bytes_of(&froxels))?;
        if self.options.normals.is_some() {
            let bins = NormalBinsUniform::new(self.options.normals, self.options.cut);
            self.culler.writes_mut().write(&self.bins, 0, bytes_of(&bins))?;
            resources.push(entry(BINS_BINDING, &self.bins));
        }
        self.culler.prepare(gpu, frame, groups, &resources)?;
        if let (Some(gather), Some(images)) = (&mut self.gather, &images) {
            let lists = self.culler.lists().lists();
            let bins = self.options.normals.is_some().then_some(&self.bins);
            gather.bind(gpu, images, (&self.froxels, bins), lists);
        }
        Ok(())
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        if let Some(gather) = &self.gather
            && frame.changes.is_none()
        {
            self.culler.record_writes(passes);
            gather.record(passes);
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
        let bins = if self.options.normals.is_some() { self.bins.size() } else { 0 };
        self.froxels.size() + bins + gather + self.culler.memory_bytes()
    }
}
