//! The inputs that a renderer gives to a strategy each frame.

use bytemuck::bytes_of;

use glam::Vec3;

use crate::{
    AssignError, FrameLights, FrameWrites, Gpu, KeptBindGroup, Light, LightBuffer, LightChanges,
    LightOrder, ModelBox, Occluders, Projection, View, ViewUniform,
    entries::{entry, storage_entry, uniform_entry},
    plain_wgsl::FRAME_BINDINGS,
};

/// Where shading looks up lists.
///
/// Groups are found for the samples of the depth buffer. A shader that looks lists up at others, in any domain but
/// [`OpaqueSurfaces`](Self::OpaqueSurfaces), is linked with
/// [`Shader::looks_up_anywhere`](crate::Shader::looks_up_anywhere). A look-up that no list serves then reads all
/// lights: slow, but no light is lost. A strategy for which most look-ups would be such refuses the frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SampleDomain {
    /// Only at the opaque surfaces in the depth buffer, with its depth at the pixel's centre. With several samples per
    /// pixel, a look-up has the depth of one of them.
    #[default]
    OpaqueSurfaces,
    /// At these surfaces as fragments of a target with several samples per pixel see them. A fragment is shaded once,
    /// at the pixel's centre, also where its triangle covers only other samples. Its depth there is extrapolated,
    /// and may lie in front of or behind all depths of the buffer.
    NearSurfaces,
    /// At these surfaces, and at any depth between the near plane and the surface in the same pixel, as for
    /// transparent surfaces and particles. In a pixel without a surface, at any depth. With several samples per pixel,
    /// fragments may also lie beyond the near or the far plane; look-ups anywhere then read all lights.
    InFront,
    /// At any depth inside the view, also behind surfaces, as for fog whose froxels cover several pixels.
    AnyDepth,
}

impl SampleDomain {
    /// What a renderer asks for, in words that follow "cannot serve".
    fn words(self) -> &'static str {
        match self {
            Self::OpaqueSurfaces => "look-ups at opaque surfaces",
            Self::NearSurfaces => "look-ups at surfaces with several samples per pixel",
            Self::InFront => "look-ups in front of opaque surfaces",
            Self::AnyDepth => "look-ups at any depth",
        }
    }
}

/// What a strategy reads besides the view and the lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Needs {
    /// The depth buffer of the opaque surfaces.
    pub depth: bool,
    /// Shading normals and roughness.
    pub normals: bool,
    /// Base colour and metallic.
    pub materials: bool,
    /// The models' boxes, and `ViewSample.model_ix` of every sample.
    pub models: bool,
    /// The scene's triangles.
    pub triangles: bool,
    /// The boxes over the lights ([`LightBuffer::nodes`](crate::LightBuffer::nodes)). A comparison
    /// counts the time for ordering and boxing the lights as that of the strategies that need them.
    /// A renderer need not look at it: it calls [`LightBuffer::record`](crate::LightBuffer::record) in
    /// each frame with new lights whatever the strategy needs, because `record` also copies the lights
    /// to where every strategy and shading read them.
    pub hierarchy: bool,
    /// What hides lights from groups ([`Frame::occluders`]).
    pub occluders: bool,
}

/// One frame's inputs. The optional fields are there for the strategies that
/// [need](crate::Assignment::needs) them.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Frame<'a> {
    /// The camera.
    pub view: &'a View,
    /// The lights.
    pub lights: &'a LightBuffer,
    /// Where shading looks up lists.
    pub samples: SampleDomain,
    /// Depth of the opaque surfaces: a texture as large as the target, with one or several samples per pixel
    /// (`texture_depth_2d`, `texture_depth_multisampled_2d`). A view of depth and stencil serves too.
    pub depth: Option<&'a wgpu::TextureView>,
    /// Depth of layers in front of the opaque surfaces, such as transparent ones: textures like `depth`, cleared to the
    /// far end where a layer shows nothing. Clusters (`DC-E`, `SC-I` and `SC-E` without normals or reach), `HC` and
    /// `GridBox::Visible` then list lights for their samples too. All other strategies ignore them and stay exact. A
    /// look-up that no list serves reads all lights.
    pub layer_depths: &'a [&'a wgpu::TextureView],
    /// Unit shading normals in world space, with perceptual roughness in `w`: a `texture_2d<f32>`
    /// of half floats or better, as large as the target.
    pub normals: Option<&'a wgpu::TextureView>,
    /// Base colour, linear when sampled, with metallic in `w`: a `texture_2d<f32>` as large as the
    /// target.
    pub base_color: Option<&'a wgpu::TextureView>,
    /// The models' boxes. `ViewSample.model_ix` is an index into them.
    pub models: Option<&'a [ModelBox]>,
    /// A box that holds all surfaces: lowest and highest corner, world space, metres.
    pub surface_bounds: Option<(Vec3, Vec3)>,
    /// The lights that changed since the frame recorded before, if all else is as in that frame: the view,
    /// the surfaces and the models. Only a strategy that [updates groups](crate::Assignment::updates_groups)
    /// gets it, from [`Touched`](crate::Touched).
    pub changes: Option<&'a LightChanges>,
    /// What hides lights from groups, for lists that leave out hidden lights
    /// ([`CullSettings::occlusion`](crate::CullSettings::occlusion)).
    pub occluders: Option<Occluders<'a>>,
    /// A number that differs from frame to frame, for what is random ([`Stochastic`](crate::Stochastic)). Shading must
    /// get the same.
    pub seed: u32,
}

impl<'a> Frame<'a> {
    /// A frame of opaque surfaces.
    pub fn new(view: &'a View, lights: &'a LightBuffer) -> Self {
        Self {
            view,
            lights,
            samples: SampleDomain::default(),
            depth: None,
            layer_depths: &[],
            normals: None,
            base_color: None,
            models: None,
            surface_bounds: None,
            changes: None,
            occluders: None,
            seed: 0,
        }
    }

    /// The box around all lights' supports that groups are laid out for: lowest and highest corner, world
    /// space, metres; `None` without lights. If groups stay as they are, it is the one they were laid out for.
    pub fn light_bounds(&self) -> Option<(Vec3, Vec3)> {
        self.changes.map_or_else(|| self.lights.bounds(), LightChanges::bounds)
    }

    /// As [`light_bounds`](Self::light_bounds), around the lights' positions.
    pub fn light_position_bounds(&self) -> Option<(Vec3, Vec3)> {
        self.changes.map_or_else(|| self.lights.position_bounds(), LightChanges::position_bounds)
    }

    /// Sets the seed of what is random.
    #[must_use]
    pub fn with_seed(mut self, seed: u32) -> Self {
        self.seed = seed;
        self
    }

    /// Adds the depth buffer.
    #[must_use]
    pub fn with_depth(mut self, depth: &'a wgpu::TextureView) -> Self {
        self.depth = Some(depth);
        self
    }

    /// Adds the depths of layers in front of the opaque surfaces. [`layer_depths`](Self::layer_depths) says which
    /// strategies read them.
    #[must_use]
    pub fn with_layer_depths(mut self, layers: &'a [&'a wgpu::TextureView]) -> Self {
        self.layer_depths = layers;
        self
    }

    /// Adds the shading normals.
    #[must_use]
    pub fn with_normals(mut self, normals: &'a wgpu::TextureView) -> Self {
        self.normals = Some(normals);
        self
    }

    /// Adds base colour and metallic.
    #[must_use]
    pub fn with_base_color(mut self, base_color: &'a wgpu::TextureView) -> Self {
        self.base_color = Some(base_color);
        self
    }

    /// Adds what hides lights.
    #[must_use]
    pub fn with_occluders(mut self, occluders: Occluders<'a>) -> Self {
        self.occluders = Some(occluders);
        self
    }

    /// Adds the models' boxes.
    #[must_use]
    pub fn with_models(mut self, models: &'a [ModelBox]) -> Self {
        self.models = Some(models);
        self
    }

    /// Adds a box that holds all surfaces: lowest and highest corner, world space, metres.
    #[must_use]
    pub fn with_surface_bounds(mut self, min_world: Vec3, max_world: Vec3) -> Self {
        self.surface_bounds = Some((min_world, max_world));
        self
    }

    /// Refuses look-ups at any depths but those of some domains. `strategy` is the id of what serves these, and
    /// `reason` says why it serves no others.
    ///
    /// # Errors
    ///
    /// [`AssignError::Unsupported`] if shading looks lists up elsewhere.
    pub fn check_domain(
        &self,
        strategy: &str,
        served: &[SampleDomain],
        reason: &str,
    ) -> Result<(), AssignError> {
        if served.contains(&self.samples) {
            return Ok(());
        }
        Err(AssignError::Unsupported {
            strategy: strategy.into(),
            asked: self.samples.words().into(),
            reason: reason.into(),
        })
    }

    /// Whether samples may lie beyond the ends of the view: fragments of several samples per pixel may lie in front of the
    /// near plane, but not behind the eye. `strategy` is the id that the error names.
    ///
    /// # Errors
    ///
    /// [`AssignError::Unsupported`] for such fragments in an orthographic view, which may lie at any depth.
    pub fn extends_past_planes(&self, strategy: &str) -> Result<bool, AssignError> {
        if self.samples != SampleDomain::NearSurfaces {
            return Ok(false);
        }
        if matches!(self.view.projection, Projection::Orthographic { .. }) {
            return Err(AssignError::Unsupported {
                strategy: strategy.into(),
                asked: "fragments of several samples per pixel in an orthographic view".into(),
                reason: "they may lie behind the eye, where its groups end".into(),
            });
        }
        Ok(true)
    }

    /// The lights, if the CPU knows them all and their order is that of the slots. `strategy` is the id of what asks, and
    /// `task` is what the CPU does with them.
    pub(crate) fn lights_by_slot(
        &self,
        strategy: String,
        task: &str,
    ) -> Result<&'a [Light], AssignError> {
        let lights = self.lights.lights();
        let is_known = lights.len() == self.lights.count() as usize;
        if is_known && !matches!(self.lights.order(), LightOrder::Gpu { .. }) {
            return Ok(lights);
        }
        Err(AssignError::Unsupported {
            strategy,
            asked: "lights that the GPU orders or widens".into(),
            reason: format!("the CPU {task}, and must know the lights and their places"),
        })
    }

    /// Sets where shading looks up lists.
    #[must_use]
    pub fn sampled_at(mut self, samples: SampleDomain) -> Self {
        self.samples = samples;
        self
    }
}

/// The view and the lights: bind group 0 of every pass, or part of a renderer's own bind group.
///
/// | binding | WESL | |
/// |---|---|---|
/// | 0 | `view::view` | uniform |
/// | 1 | `lights::light_spheres` | storage |
/// | 2 | `lights::light_emissions` | storage |
/// | 3 | `lights::light_shapes` | storage |
#[derive(Debug)]
pub struct FrameBindings {
    uniform: wgpu::Buffer,
    layout: wgpu::BindGroupLayout,
    bound: KeptBindGroup,
    /// The lights of the last frame, if the GPU orders them, and how often frames had been recorded before.
    lights: Option<(FrameLights, u64)>,
}

impl FrameBindings {
    /// Makes the layout.
    pub fn new(gpu: &Gpu) -> Self {
        let stages = wgpu::ShaderStages::VERTEX_FRAGMENT | wgpu::ShaderStages::COMPUTE;
        let of_lights = wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE;
        let mut entries = Self::layout_entries(0, stages);
        entries[2].visibility = of_lights;
        entries[3].visibility = of_lights;
        Self {
            uniform: gpu.uniform("view", size_of::<ViewUniform>() as u64),
            layout: gpu.bind_group_layout("frame", &entries),
            bound: KeptBindGroup::default(),
            lights: None,
        }
    }

    /// Checks and uploads the view, and binds the lights. The view takes effect with the next submission, for all that
    /// it holds: a renderer that draws several views in one submission has one `FrameBindings` per view. The bind group
    /// stays the same while the lights' buffers do.
    pub fn update(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        let uniform = view_uniform(frame)?;
        gpu.queue.write_buffer(&self.uniform, 0, bytes_of(&uniform));
        self.bind(gpu, frame.lights);
        Ok(())
    }

    /// As [`update`](Self::update), but the view takes effect where `writes` are recorded. Strategies use it.
    ///
    /// # Errors
    ///
    /// [`AssignError::LightsNotRecorded`] if the frame before was recorded with lights that the GPU should have ordered,
    /// and never did. Its image lacks light.
    pub fn update_in(
        &mut self,
        gpu: &Gpu,
        frame: &Frame<'_>,
        writes: &mut FrameWrites,
    ) -> Result<(), AssignError> {
        let records = writes.record_count();
        if let Some((lights, records_before)) = &self.lights
            && records > *records_before
        {
            lights.check()?;
        }
        self.lights = frame.lights.frame_lights().map(|lights| (lights, records));
        let uniform = view_uniform(frame)?;
        writes.write(&self.uniform, 0, bytes_of(&uniform))?;
        self.bind(gpu, frame.lights);
        Ok(())
    }

    fn bind(&mut self, gpu: &Gpu, lights: &LightBuffer) {
        let entries = [
            entry(0, &self.uniform),
            entry(1, lights.spheres()),
            entry(2, lights.emissions()),
            entry(3, lights.shapes()),
        ];
        self.bound.bind(gpu, "frame", &self.layout, &entries);
    }

    /// Bytes of the view's buffer, without the lights.
    pub fn bytes(&self) -> u64 {
        self.uniform.size()
    }

    /// The layout.
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// The bind group; `None` before the first [`update`](Self::update).
    pub fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.bound.get()
    }

    /// Layout entries for one of a renderer's own bind groups, in which these four bindings begin at `first_binding`.
    /// `stages` are the shader stages that read them.
    pub fn layout_entries(
        first_binding: u32,
        stages: wgpu::ShaderStages,
    ) -> Vec<wgpu::BindGroupLayoutEntry> {
        let mut entries = vec![uniform_entry(first_binding, stages)];
        let lights = 1..FRAME_BINDINGS;
        entries
            .extend(lights.map(|ix| storage_entry(first_binding.saturating_add(ix), stages, true)));
        entries
    }

    /// The entries of such a bind group. [`update`](Self::update) replaces them if lights move to other buffers. They are
    /// empty before the first one.
    pub fn bind_entries(&self, first_binding: u32) -> Vec<wgpu::BindGroupEntry<'_>> {
        self.bound.entries(first_binding)
    }
}

fn view_uniform(frame: &Frame<'_>) -> Result<ViewUniform, AssignError> {
    frame.view.check()?;
    Ok(ViewUniform { seed: frame.seed, ..frame.view.uniform() })
}
