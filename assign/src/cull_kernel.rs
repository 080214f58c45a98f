//! The culling kernel: what it is compiled for, and the store of a strategy's compiled kernels.

use crate::{
    AreaBounds, AssignError, CullSettings, Facing, Gpu, GroupShape, LightKinds, LightSource,
    LightTraits, OcclusionTest, Shader, Storage, StrategyWesl,
};

/// Bind group of the lists inside the driver's own kernels.
pub(crate) const LISTS_GROUP: u32 = 1;

/// What the kernel is compiled for, besides the kinds of lights.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Variant {
    pub(crate) shape: GroupShape,
    pub(crate) settings: CullSettings,
    pub(crate) sparse: bool,
    pub(crate) facing: Facing,
}

/// What tells the kernels of a strategy apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct KernelKey {
    pub(crate) kinds: LightKinds,
    /// Levels of the light hierarchy; 0 without one.
    pub(crate) levels: u32,
    pub(crate) sparse: bool,
}

/// The compiled kernels of a strategy: one for each kind of lights that came up. Lights that flicker change their
/// kinds in every frame, so all kernels stay.
#[derive(Clone, Debug, Default)]
pub(crate) struct Kernels(Vec<(KernelKey, wgpu::ComputePipeline)>);

impl Kernels {
    pub(crate) fn find(&self, key: KernelKey) -> Option<wgpu::ComputePipeline> {
        self.0.iter().find(|(known, _)| *known == key).map(|(_, kernel)| kernel.clone())
    }

    pub(crate) fn insert(&mut self, key: KernelKey, kernel: wgpu::ComputePipeline) {
        self.0.push((key, kernel));
    }
}

impl Variant {
    pub(crate) fn check(self, strategy: &str) -> Result<(), AssignError> {
        if self.facing != Facing::Unknown && self.shape != GroupShape::Box {
            return Err(AssignError::Unsupported {
                strategy: strategy.into(),
                asked: format!("facing {:?} with groups of shape {:?}", self.facing, self.shape),
                reason: "only groups of shape Box can know normals".into(),
            });
        }
        if self.facing == Facing::SpecularReach && self.settings.storage != Storage::Lists {
            return Err(AssignError::Unsupported {
                strategy: strategy.into(),
                asked: format!("storage {:?} with a specular reach", self.settings.storage),
                reason: "only plain lists hold lights beyond their range".into(),
            });
        }
        // What the others leave out of lists, they mark in an entry's flags.
        if !matches!(self.facing, Facing::Unknown | Facing::Horizon)
            && self.settings.storage.is_mask()
        {
            return Err(AssignError::Unsupported {
                strategy: strategy.into(),
                asked: "bit masks with a specular cut".into(),
                reason: "a bit cannot say which terms of a light to leave out".into(),
            });
        }
        Ok(())
    }

    /// Compiles the kernel over bind groups of these layouts.
    pub(crate) fn compile(
        self,
        gpu: &Gpu,
        wesl: StrategyWesl<'_>,
        traits: LightTraits,
        layouts: &[Option<&wgpu::BindGroupLayout>],
    ) -> Result<wgpu::ComputePipeline, AssignError> {
        let shader = self.shader(wesl, traits);
        // SAFETY: every loop of the driver ends. A loop counts up without wrapping to a fixed
        // number, at most a buffer's length; or tests the next of finitely many nodes; or clears
        // one bit of a word per round; or tries to take entries from a pool that only fills up.
        // Such a try fails only because another lane succeeded, or spuriously a few times at most.
        // The strategy's author guarantees the same for its module.
        #[allow(unsafe_code, reason = "its loops end")]
        let module = unsafe { shader.create_uncounted(gpu, "package::cull") }?;
        // The kernel writes workgroup memory before it reads it.
        Ok(gpu.compute_pipeline(&module, "cull_groups", layouts, false))
    }

    /// The kernel's shader.
    pub(crate) fn shader<'a>(self, wesl: StrategyWesl<'a>, lights: LightTraits) -> Shader<'a> {
        let tests = self.settings.tests;
        let is_hierarchy = self.settings.source == LightSource::Hierarchy;
        let levels = if is_hierarchy { lights.levels } else { 0 };
        let occlusion = self.settings.occlusion;
        let mounted = occlusion.into_iter().flat_map(OcclusionTest::modules);
        let shader = mounted
            .fold(Shader::new(LISTS_GROUP), |shader, (path, source)| shader.module(path, source));
        shader
            .module("package::cull", include_str!("shaders/cull.wesl"))
            .module("package::walk", include_str!("shaders/walk.wesl"))
            .module("package::tree", include_str!("shaders/tree.wesl"))
            .module("package::terms", include_str!("shaders/terms.wesl"))
            .module("package::facing", include_str!("shaders/facing.wesl"))
            .strategy(wesl)
            .group_bounds(self.shape)
            .module("package::gloss", include_str!("shaders/gloss.wesl"))
            .module("package::reflected", include_str!("shaders/reflected.wesl"))
            .module("package::group_reach", include_str!("shaders/group_reach.wesl"))
            .flag("occlusion", occlusion.is_some())
            .flag("specular_reach", self.facing == Facing::SpecularReach)
            .flag("bounds_by_lanes", wesl.finds_bounds_by_lanes())
            .flag("facing", matches!(self.facing, Facing::Horizon | Facing::HorizonAndGloss))
            .flag("reflected", self.facing == Facing::ReflectedCone)
            .flag("where_diffuse", self.facing == Facing::WhereDiffuse)
            .flag("gloss", self.facing == Facing::HorizonAndGloss)
            .flag("hs", tests.hs)
            .flag("sat_e", tests.sat_e)
            .flag("sat_n", tests.sat_n)
            .flag("sat_p", tests.sat_p)
            .flag("sat_v", tests.sat_v)
            .flag("rect", self.settings.screen_rectangle)
            .flag("hierarchy", is_hierarchy)
            .flag("parents", levels > 1)
            .flag("grandparents", levels > 2)
            .flag("area_balls", self.settings.area_bounds == AreaBounds::Ball)
            .flag("sparse", self.sparse)
            .flag("masks", self.settings.storage.is_mask())
            .flag("trees", self.settings.storage == Storage::Trees)
            .light_kinds(lights.kinds)
    }
}
