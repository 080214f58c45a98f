//! The trait that every strategy implements.

use crate::{
    AssignError, Frame, Gpu, GroupShape, LightKinds, LightLists, LightTraits, ListsBindings, Needs,
    Passes, Shader, Slots, StrategyModule,
};

/// A strategy: groups of view samples, a function from a sample to its group, and a list of
/// lights for each group.
///
/// A frame runs `prepare`, then `record`; shading, recorded after that, reads the lists through [`Lookup`]. The renderer
/// may submit at once or after further frames: commands of the frame itself upload its parameters
/// ([`FrameWrites`](crate::FrameWrites)), so the passes and the shading of each frame see its own.
///
/// # Several views
///
/// One instance has the lists of one view. [`for_view`](Self::for_view) makes an instance for another view: a second
/// camera, the other half of a split screen, a reflection. Both share pipelines and layouts, so one shading pipeline
/// serves both, and both may be prepared and recorded in one submission. An instance that is prepared for another view
/// in each frame is right too, but its lists are overwritten: shade a view before the next one is recorded. A strategy
/// that keeps lists over frames, such as [`Keep`](crate::Keep), keeps them for one view. Wrappers that change lights
/// ([`Fewer`](crate::Fewer), [`Half`](crate::Half), [`Stochastic`](crate::Stochastic)) upload their copy through the
/// queue: give each view an instance.
///
/// # No hitch
///
/// `prepare` and `record` never wait. They compile only in these cases:
///
/// - [Kinds of lights](LightTraits), or more levels of the hierarchy, have not come up yet. [`compile`](Self::compile)
///   does that ahead. `kinds.into()` means one level. Where a hierarchy may grow past 16,384 lights, use
///   `LightTraits { kinds, levels: 3 }`.
/// - It is the first depth buffer with several samples per pixel. `prepare` compiles for it; `compile` does not.
///
/// If the GPU orders the lights, [`LightBuffer::compile`](crate::LightBuffer::compile) compiles ahead for the sort.
///
/// They make buffers and bind groups only if something grew or other images are bound. [`Gpu::hitches`] counts all of
/// this.
pub trait Assignment: Send + Sync {
    /// The strategy's id with its parameters, named as in the comparison paper: `DC-I/64x64x24`.
    fn id(&self) -> String;

    /// What the strategy reads besides the view and the lights.
    fn needs(&self) -> Needs;

    /// Whether groups move with the camera. If not, their lists outlive its moves.
    fn is_view_bound(&self) -> bool {
        true
    }

    /// Whether it serves [`Frame::changes`]: it keeps its groups, and makes only those lists again
    /// that a changed light touches.
    fn updates_groups(&self) -> bool {
        false
    }

    /// Out to how many of its ranges a light is listed for its specular term, wherever a surface is polished enough
    /// to show it ([`specular_reach`](fn@crate::specular_reach)). Shading may let specular terms reach as far, and no
    /// farther.
    fn specular_reach(&self) -> f32 {
        1.0
    }

    /// Makes the same strategy for another view. It shares this one's pipelines and layouts, takes the limits of its
    /// lists, and has buffers of its own.
    ///
    /// # Errors
    ///
    /// [`AssignError::OutOfMemory`] if the device has no memory left.
    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError>;

    /// Compiles ahead what frames with such lights need: a flickering lamp that is the last spot changes the kinds of
    /// lights in every frame. Call it while loading, once for each kind that may come up. With a hierarchy it compiles
    /// for up to `lights.levels` levels. Strategies without kernels for lights have nothing to compile.
    ///
    /// # Errors
    ///
    /// [`AssignError::Shader`] if a kernel does not link.
    fn compile(&mut self, _gpu: &Gpu, _lights: LightTraits) -> Result<(), AssignError> {
        Ok(())
    }

    /// Sizes buffers and uploads parameters. No clock counts it. After an error, do not draw the
    /// frame with this strategy.
    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError>;

    /// Records the passes that fill the lists. A clock times them.
    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes);

    /// How shading finds a sample's group. It never changes during the strategy's life.
    fn lookup(&self) -> Lookup<'_>;

    /// The bind group that matches [`Lookup::layout`]. `prepare` may replace it.
    fn bind_group(&self) -> Option<&wgpu::BindGroup>;

    /// The lists.
    fn lists(&self) -> &LightLists;

    /// The lists, so that a caller can limit their pool.
    fn lists_mut(&mut self) -> &mut LightLists;

    /// GPU memory that only this strategy needs, bytes: lists, the light hierarchy if it uses
    /// one, marks, bounds, pools and uniforms. It excludes the renderer's images and the lights.
    /// The value is valid right after [`prepare`](Self::prepare).
    fn memory_bytes(&self) -> u64;
}

/// What a renderer adds to its own shading shader, in one of two ways:
///
/// - Plain WGSL: [`wgsl`](Self::wgsl) is text for any shader system, and [`layout_entries`](Self::layout_entries) and
///   [`bind_entries`](Self::bind_entries) are for one of the renderer's own bind groups.
/// - WESL: mount `module` with [`Shader::strategy`](crate::Shader::strategy), and import `open_lights` and `next_light`
///   from `package::look_up`. Bind [`Assignment::bind_group`] at the group that the shader was made for.
#[derive(Clone, Copy, Debug)]
pub struct Lookup<'a> {
    /// WESL that defines `fn group_of(sample: ViewSample) -> u32`.
    pub module: StrategyModule,
    /// The lists and what the module reads.
    pub bindings: &'a ListsBindings,
    /// The shape of the bounds that the module's `group_bounds(group: u32) -> GroupBounds` returns. `None` if it
    /// has no such function, or if the bounds are not kept after culling. To call it, mount the shape with
    /// [`Shader::group_bounds`](crate::Shader::group_bounds).
    pub shape: Option<GroupShape>,
}

impl<'a> Lookup<'a> {
    /// Whether samples of one group may read different lights. The strategy's lists then do not say what a
    /// sample reads; only the look-up does.
    pub fn is_per_sample(&self) -> bool {
        self.module.wesl().reader.is_per_sample()
    }

    /// The look-up as WGSL for any shader stage and all kinds of lights. It is self-contained, has no entry point, and
    /// every global name in it begins with the prefix. It never changes during the strategy's life.
    ///
    /// With the prefix `lb_`, a renderer uses:
    ///
    /// | WGSL | |
    /// |---|---|
    /// | `lb_sample_at(pixel: vec2f, depth_clip: f32, normal_world: vec3f, model_ix: u32) -> lb_ViewSample` | the sample at a pixel centre of the target |
    /// | `lb_open_lights(sample: lb_ViewSample) -> lb_LightCursor` | starts at the sample's first light |
    /// | `lb_next_light(cursor: ptr<function, lb_LightCursor>) -> bool` | finds the next light, in ascending index |
    /// | `cursor.entry & lb_ENTRY_LIGHT` | the light's index |
    /// | `lb_light_spheres[i]` | `position_world`, `radius_m` |
    /// | `lb_light_emissions[i]` | `intensity`, `kind_and_shape` |
    /// | `lb_fall_off(distance_2: f32, range_m: f32, least_2: f32) -> f32` | the fall-off that ends at the light's range; `least_2` is `lb_MIN_DISTANCE_2` |
    /// | `lb_view` | the view: [`ViewUniform`](crate::ViewUniform) |
    ///
    /// Samples may lie anywhere that the frame's [`SampleDomain`](crate::SampleDomain) allows: a look-up that no list
    /// serves reads all lights ([`Shader::looks_up_anywhere`](crate::Shader::looks_up_anywhere)). Shaders of opaque
    /// surfaces save that check with [`wgsl_at_surfaces`](Self::wgsl_at_surfaces). For fewer kinds of lights, or for the
    /// subgroup operations of compute shaders, call [`Shader::wgsl`](crate::Shader::wgsl). That text looks up anywhere
    /// only after [`Shader::looks_up_anywhere`](crate::Shader::looks_up_anywhere).
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] for a prefix that begins no name, and [`AssignError::Shader`] if two variables would have
    /// the same binding.
    pub fn wgsl(&self, slots: &Slots<'_>) -> Result<String, AssignError> {
        self.shader(slots).looks_up_anywhere().wgsl(slots)
    }

    /// As [`wgsl`](Self::wgsl), for samples of [`SampleDomain::OpaqueSurfaces`](crate::SampleDomain::OpaqueSurfaces)
    /// only. It is faster: no look-up asks whether the list serves it. At any other sample, light may be missing. A module
    /// that holds both texts needs two prefixes; the bindings may be the same.
    ///
    /// # Errors
    ///
    /// As [`wgsl`](Self::wgsl).
    pub fn wgsl_at_surfaces(&self, slots: &Slots<'_>) -> Result<String, AssignError> {
        self.shader(slots).wgsl(slots)
    }

    /// The look-up for any shader stage and all kinds of lights.
    fn shader(&self, slots: &Slots<'_>) -> Shader<'static> {
        Shader::new(slots.lists_group)
            .strategy(self.module)
            .light_kinds(LightKinds::EVERY)
            .without_subgroups()
    }

    /// The layout of [`Assignment::bind_group`].
    pub fn layout(&self) -> &'a wgpu::BindGroupLayout {
        self.bindings.layout()
    }

    /// Layout entries for one of the renderer's own bind groups. The look-up takes bindings from `first_binding` on, with
    /// gaps. `stages` are the shader stages that look lights up.
    pub fn layout_entries(
        &self,
        first_binding: u32,
        stages: wgpu::ShaderStages,
    ) -> Vec<wgpu::BindGroupLayoutEntry> {
        self.bindings.layout_entries(first_binding, stages)
    }

    /// The entries of that bind group. [`Assignment::prepare`] may replace them. They are empty before the first one.
    pub fn bind_entries(&self, first_binding: u32) -> Vec<wgpu::BindGroupEntry<'a>> {
        self.bindings.bind_entries(first_binding)
    }
}

#[cfg(test)]
mod tests {
    use crate::{Assignment, Gpu, LightBuffer};

    /// A renderer may prepare a frame on one thread and record it on another.
    const _: () = {
        const fn is_shared<T: Send + Sync + ?Sized>() {}
        is_shared::<dyn Assignment>();
        is_shared::<LightBuffer>();
        is_shared::<Gpu>();
    };
}
