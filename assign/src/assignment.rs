//! The trait that every strategy implements.

use crate::{
    AssignError, Frame, Gpu, GroupShape, LightLists, LightTraits, Needs, Passes, StrategyModule,
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
/// that keeps lists over frames, such as [`Keep`](crate::Keep), keeps them for one view.
///
/// # No hitch
///
/// `prepare` and `record` never wait. They compile only for [kinds of lights](LightTraits) that have not come up yet
/// ([`compile`](Self::compile) does that ahead), and make buffers and bind groups only if something grew or other images
/// are bound. [`Gpu::hitches`] counts all of this.
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

/// What a renderer links into its own shading shader.
///
/// Mount `module` with [`Shader::strategy`](crate::Shader::strategy). Import `open_lights` and `next_light` from
/// `package::look_up`. Bind [`Assignment::bind_group`] at the group that the
/// shader was made for.
#[derive(Clone, Copy, Debug)]
pub struct Lookup<'a> {
    /// WESL that defines `fn group_of(sample: ViewSample) -> u32`.
    pub module: StrategyModule,
    /// Layout of the lists and of what the module reads.
    pub layout: &'a wgpu::BindGroupLayout,
    /// The shape of the bounds that the module's `group_bounds(group: u32) -> GroupBounds` returns. `None` if it
    /// has no such function, or if the bounds are not kept after culling. To call it, mount the shape with
    /// [`Shader::group_bounds`](crate::Shader::group_bounds).
    pub shape: Option<GroupShape>,
}

impl Lookup<'_> {
    /// Whether samples of one group may read different lights. The strategy's lists then do not say what a
    /// sample reads; only the look-up does.
    pub fn is_per_sample(&self) -> bool {
        self.module.wesl().reader.is_per_sample()
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
