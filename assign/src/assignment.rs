//! The trait that every strategy implements.

use crate::{AssignError, Frame, Gpu, GroupShape, LightLists, Needs, Passes, StrategyModule};

/// A strategy: groups of view samples, a function from a sample to its group, and a list of
/// lights for each group.
///
/// A frame runs `prepare`, then `record`; the renderer submits, and shading reads the lists through
/// [`Lookup`]. Call the next `prepare` after that submission.
pub trait Assignment {
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
