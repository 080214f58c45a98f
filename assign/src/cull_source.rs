//! The linked WGSL of the driver's kernels, for tests of layout and validity.

use crate::{
    AssignError, CullSettings, Culler, Facing, GroupShape, LightKinds, LightTraits, StrategyWesl,
    cull_kernel::Variant, touched_groups::touched_shader,
};

impl Culler {
    /// The kernel's linked WGSL for a scene with such lights.
    pub fn kernel_source<'a>(
        shape: GroupShape,
        settings: CullSettings,
        sparse: bool,
        wesl: impl Into<StrategyWesl<'a>>,
        lights: impl Into<LightTraits>,
    ) -> Result<String, AssignError> {
        let variant = Variant { shape, settings, sparse, facing: Facing::Unknown };
        variant.shader(wesl.into(), lights.into()).link("package::cull")
    }

    /// The linked WGSL of the kernels that find the groups touched by changed lights.
    pub fn touched_source<'a>(
        shape: GroupShape,
        settings: CullSettings,
        sparse: bool,
        wesl: impl Into<StrategyWesl<'a>>,
    ) -> Result<String, AssignError> {
        let variant = Variant { shape, settings, sparse, facing: Facing::Unknown };
        touched_shader(variant.shader(wesl.into(), LightKinds::default().into()))
            .link("package::touched")
    }

    /// The kernel's linked WGSL for live groups that are boxes and know how their surfaces face.
    pub fn facing_kernel_source<'a>(
        settings: CullSettings,
        facing: Facing,
        wesl: impl Into<StrategyWesl<'a>>,
        lights: impl Into<LightTraits>,
    ) -> Result<String, AssignError> {
        let variant = Variant { shape: GroupShape::Box, settings, sparse: true, facing };
        variant.shader(wesl.into(), lights.into()).link("package::cull")
    }
}
