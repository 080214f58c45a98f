//! ZB, z-bins: bit masks of screen tiles and of depth slices, which shading joins.
//!
//! # Idea
//!
//! Clusters need a list per tile and slice. Z-bins need one per tile, from the near to the far plane, and one per
//! slice of the whole view: tiles plus slices instead of tiles times slices. A sample's lights are those of both
//! (Drobot 2017, "Improved Culling for Tiled and Clustered Rendering"). Unity's Universal Render Pipeline
//! (Forward+), Godot and Babylon.js ship variants.
//!
//! # Phases
//!
//! `cull` gives each tile and each slice one workgroup, which tests lights against its frustum and writes a bit
//! per light. Shading reads both masks word by word, and evaluates the lights whose bit is set in both.
//!
//! Drobot sorts lights by depth in each frame, so that a slice need only name its first and its last light. Here
//! a slice has a mask of its own, as in recent versions of the Universal Render Pipeline. So lights need no
//! order, and the image is the one of every other strategy, bit for bit. The summary of a mask does the work of
//! the range: it says which 64 lights have a bit at all.
//!
//! # Cost
//!
//! `cull` grows with tiles plus slices, times lights. Memory is one bit per light, tile and slice: 2,040 tiles of
//! 32 x 32 pixels and 64 slices at 1920x1080 take 2.7 MB for 10,000 lights.
//!
//! # Where it fails
//!
//! - A light is listed if it reaches the tile's column somewhere and the slice somewhere, even if it reaches both at
//!   no place. Such a light may reach the column only in front of the slice, and the slice only beside the column.
//!   Clusters test both together.
//! - A slice holds the lights at its depth across the whole view. So joining masks costs more with more lights in
//!   view, even where they are far from the sample.
//! - As for all masks, an entry has no flags, and memory grows with all lights.

use assign::{
    AssignError, Assignment, CullSettings, Culler, CullerDescriptor, Facing, Frame, Gpu,
    GroupShape, Groups, LightLists, LightReader, LightTraits, Lookup, Needs, Passes, Storage,
    StrategyModule, StrategyWesl, entry, uniform_entry,
};
use bytemuck::bytes_of;

use crate::{
    Slices,
    cluster_wesl::FROXELS,
    froxels::{FROXELS_BINDING, FroxelSize, FroxelsUniform},
};

/// The WESL of z-bins: `group_of` and `second_group_of`, the tile and the slice of a sample, and `group_bounds`.
pub const Z_BINS_WESL: StrategyWesl<'static> = StrategyWesl {
    main: include_str!("shaders/z_bins.wesl"),
    imports: &[FROXELS],
    flags: &[],
    reader: LightReader::BothMasks,
};

/// Tiles and depth slices that each have a bit per light. A sample's lights are those of both its tile and its
/// slice.
#[derive(Debug)]
pub struct ZBins {
    size: FroxelSize,
    slices: Slices,
    settings: CullSettings,
    froxels: wgpu::Buffer,
    culler: Culler,
}

impl ZBins {
    /// Makes the strategy. Checks `size`. Lights are always kept as bit masks, whatever `settings` say.
    pub fn new(gpu: &Gpu, size: FroxelSize, settings: CullSettings) -> Result<Self, AssignError> {
        size.check()?;
        let settings = CullSettings { storage: Storage::Masks, ..settings };
        Ok(Self {
            size,
            slices: Slices::default(),
            settings,
            froxels: gpu.uniform("froxels", size_of::<FroxelsUniform>() as u64),
            culler: Culler::new(
                gpu,
                &CullerDescriptor {
                    label: "ZB",
                    shape: GroupShape::Frustum,
                    settings,
                    sparse: false,
                    facing: Facing::Unknown,
                    // SAFETY: the modules have no loop.
                    #[allow(unsafe_code, reason = "they have no loop")]
                    module: unsafe { StrategyModule::new(Z_BINS_WESL) },
                    bindings: &bindings(),
                },
            )?,
        })
    }

    /// The same with depth cut into other slices. Checks them.
    pub fn with_slices(self, slices: Slices) -> Result<Self, AssignError> {
        if slices.is_cascaded() {
            return Err(AssignError::Unsupported {
                strategy: self.id(),
                asked: "cascades".into(),
                reason: "it has one mask per tile for all slices".into(),
            });
        }
        slices.check(self.size.slices)?;
        Ok(Self { slices, ..self })
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
        let mut view = Self { slices: self.slices, ..Self::new(gpu, self.size, self.settings)? };
        view.culler.share(&self.culler);
        Ok(view)
    }
}

/// The strategy's resources that culling and the look-up read.
fn bindings() -> [wgpu::BindGroupLayoutEntry; 1] {
    let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
    [uniform_entry(FROXELS_BINDING, stages)]
}

impl Assignment for ZBins {
    fn id(&self) -> String {
        let settings = CullSettings { storage: Storage::Lists, ..self.settings };
        let slices = self.slices.segment();
        format!("ZB/{}{slices}{}", self.size, settings.suffix(GroupShape::Frustum))
    }

    fn needs(&self) -> Needs {
        Needs {
            hierarchy: self.culler.reads_hierarchy(),
            occluders: self.culler.reads_occluders(),
            ..Needs::default()
        }
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
        let mut froxels =
            FroxelsUniform::new(self.size, self.slices, frame.view, frame.light_bounds())?;
        froxels.serve(frame, &self.id())?;
        self.culler.writes_mut().write(&self.froxels, 0, bytes_of(&froxels))?;
        let [tiles_x, tiles_y, slices] = froxels.counts;
        self.culler.prepare(
            gpu,
            frame,
            Groups::All(tiles_x * tiles_y + slices),
            &[entry(FROXELS_BINDING, &self.froxels)],
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
        self.froxels.size() + self.culler.memory_bytes()
    }
}
