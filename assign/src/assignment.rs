//! The one trait behind which every strategy stands.

use crate::{AssignError, Frame, Gpu, LightLists, Needs, Passes, StrategyModule};

/// A strategy: groups of view samples, a function from a sample to its group, and a list of
/// lights for each group.
///
/// A frame runs `prepare`, then `record`; the renderer submits, and shading reads the lists
/// through [`Lookup`]. The next `prepare` comes after that submission.
pub trait Assignment {
    /// Its id with parameters, as in the comparison paper: `DC-I/64x64x24`.
    fn id(&self) -> String;

    /// What it reads beside the view and the lights.
    fn needs(&self) -> Needs;

    /// Sizes buffers and uploads parameters: outside the clock. An error means that the frame
    /// must not be drawn with this strategy.
    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError>;

    /// Records the passes that fill the lists: inside the clock.
    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes);

    /// How shading finds a sample's group. Constant over the strategy's life.
    fn lookup(&self) -> Lookup<'_>;

    /// The bind group of [`Lookup::layout`]. `prepare` may replace it.
    fn bind_group(&self) -> Option<&wgpu::BindGroup>;

    /// The lists.
    fn lists(&self) -> &LightLists;

    /// The lists, to limit their pool.
    fn lists_mut(&mut self) -> &mut LightLists;

    /// GPU memory of everything that it allocated and that it binds for itself alone, bytes: lists,
    /// the hierarchy of lights where it uses one, marks, bounds, pools and uniforms. The renderer's
    /// images and the lights are not in it. Right after a [`prepare`](Self::prepare).
    fn memory_bytes(&self) -> u64;
}

/// What a renderer splices into its own shading shader.
///
/// Mount `module` with [`Shader::strategy`](crate::Shader::strategy), import
/// `package::strategy::group_of` and call `list_of(group_of(sample))`; bind [`Assignment::bind_group`] at the group that the shader was
/// made for.
#[derive(Clone, Copy, Debug)]
pub struct Lookup<'a> {
    /// WESL that defines `fn group_of(sample: ViewSample) -> u32`.
    pub module: StrategyModule,
    /// Layout of the lists and of what the module reads.
    pub layout: &'a wgpu::BindGroupLayout,
}
