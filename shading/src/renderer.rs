//! Draws one scene into one set of targets: the passes that all strategies share.

use assign::{AssignError, Frame, FrameBindings, Gpu, ModelBox, Passes, SampleDomain, View};
use glam::Vec3;
use scenes::{Aabb, Model, Scene};

use crate::{
    LightingOptions, ShadingError,
    geometry::SceneGpu,
    layers::{LayerKinds, LayerOptions, LayerScene},
    lighting_inputs::LightingInputs,
    loop_rounds::LightTotals,
    raster::{Orientation, RasterPipelines},
    resolve::{Resolve, SAMPLES},
    shadows::Shadows,
    shared_passes::SharedPasses,
    targets::Targets,
};

/// A scene on the GPU, with the pipelines of depth, G-buffer and clay.
#[derive(Debug)]
pub struct Renderer {
    pub(crate) gpu: Gpu,
    pub(crate) frame: FrameBindings,
    pub(crate) scene: SceneGpu,
    /// Bind group 2 of the passes without lighting.
    pub(crate) scene_group: wgpu::BindGroup,
    pub(crate) targets: Targets,
    pub(crate) orientation: Orientation,
    /// The prepared lights.
    pub(crate) lights: LightTotals,
    /// [`Frame::seed`] of the next frame.
    seed: u32,
    models: Vec<ModelBox>,
    pub(crate) surface_bounds: (Vec3, Vec3),
    shared: SharedPasses,
    /// What is drawn over the opaque surfaces.
    pub(crate) layers: Option<LayerScene>,
    /// Maps of the lights' shadows, or what rays to the lights cross.
    pub(crate) shadows: Shadows,
    /// The pass that makes the image of several samples per pixel.
    pub(crate) resolve: Option<Resolve>,
}

impl Renderer {
    /// Uploads `scene` and creates targets and pipelines for views like `view`.
    pub fn new(gpu: &Gpu, scene: &Scene, view: &View) -> Result<Self, ShadingError> {
        view.check().map_err(AssignError::from)?;
        let frame = FrameBindings::new(gpu);
        let surface_bounds = (scene.bounds.min, scene.bounds.max);
        let model_box = |model: &Model| {
            let Aabb { min, max } = model.bounds_object;
            ModelBox::new(model.object_to_world, min, max)
        };
        let models = scene.models.iter().map(model_box).collect();
        let scene = SceneGpu::new(gpu, scene)?;
        let targets = Targets::new(gpu, view, &scene, 1)?;
        let inputs = LightingInputs::new(gpu, LightingOptions::default(), None)?;
        let orientation = Orientation::of_view(view, 1);
        Ok(Self {
            shared: SharedPasses::new(gpu, &frame, &scene, orientation)?,
            models,
            surface_bounds,
            gpu: gpu.clone(),
            orientation,
            lights: LightTotals::default(),
            seed: 0,
            frame,
            scene_group: scene.bind_group(gpu, &inputs),
            scene,
            targets,
            layers: None,
            shadows: Shadows::default(),
            resolve: None,
        })
    }

    /// A renderer of the same scene for a second view in the same frame, such as a light's. It has
    /// its own view, lights and targets, and shares the uploaded scene and pipelines. It has no layers, and draws
    /// transparent surfaces as opaque ones.
    pub fn beside(&self, view: &View) -> Result<Self, ShadingError> {
        view.check().map_err(AssignError::from)?;
        let frame = FrameBindings::new(&self.gpu);
        let targets = Targets::new(&self.gpu, view, &self.scene, 1)?;
        let orientation = Orientation::of_view(view, 1);
        let shared = if orientation == self.orientation {
            self.shared.clone()
        } else {
            SharedPasses::new(&self.gpu, &frame, &self.scene, orientation)?
        };
        Ok(Self {
            gpu: self.gpu.clone(),
            frame,
            scene: self.scene.clone(),
            scene_group: self.scene_group.clone(),
            targets,
            orientation,
            lights: LightTotals::default(),
            seed: 0,
            models: self.models.clone(),
            surface_bounds: self.surface_bounds,
            shared,
            layers: None,
            shadows: Shadows::default(),
            resolve: None,
        })
    }

    /// Sets what is drawn over the opaque surfaces. It holds for frames that are prepared afterwards, with
    /// [`Lighting`](crate::Lighting) that is made afterwards. Transparent surfaces are then no longer drawn as opaque
    /// ones, and cast no shadows. Shadow maps that were drawn with other surfaces are removed: call
    /// [`cast_shadows`](Self::cast_shadows) afterwards.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] for faulty options, for transparent surfaces in a scene without any, and if the
    /// device cannot blend into single precision.
    pub fn show_layers(&mut self, options: &LayerOptions) -> Result<(), ShadingError> {
        let layers = LayerScene::new(&self.gpu, &self.scene, options)?;
        if layers.is_some() {
            self.check_one_sample("layers over the opaque surfaces")?;
        }
        let sheets = self.layer_kinds().sheets;
        self.layers = layers;
        if sheets != self.layer_kinds().sheets {
            self.shadows.clear();
        }
        Ok(())
    }

    /// Sets the samples per pixel: 1, or 4 for forward modes. The image is their mean. It holds for frames that are
    /// prepared afterwards, with [`Lighting`](crate::Lighting) that is made afterwards.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] for other numbers, and for several samples with layers.
    pub fn sample_pixels(&mut self, view: &View, samples: u32) -> Result<(), ShadingError> {
        self.resolve = Resolve::new(&self.gpu, samples, self.layers.is_some())?;
        self.orientation = Orientation::of_view(view, self.samples());
        let Self { gpu, frame, scene, orientation, .. } = &*self;
        let shared = SharedPasses::new(gpu, frame, scene, *orientation)?;
        let targets = Targets::new(gpu, view, scene, self.samples())?;
        (self.shared, self.targets) = (shared, targets);
        Ok(())
    }

    /// Refuses several samples per pixel for what reads or draws one.
    pub(crate) fn check_one_sample(&self, what: &str) -> Result<(), AssignError> {
        if self.resolve.is_none() {
            return Ok(());
        }
        Err(AssignError::Unsupported {
            strategy: what.into(),
            asked: format!("{SAMPLES} samples per pixel"),
            reason: "only forward modes draw them".into(),
        })
    }

    /// Samples per pixel.
    pub fn samples(&self) -> u32 {
        if self.resolve.is_some() { SAMPLES } else { 1 }
    }

    /// The kinds of layers that it draws.
    pub fn layer_kinds(&self) -> LayerKinds {
        self.layers.as_ref().map(LayerScene::kinds).unwrap_or_default()
    }

    /// The device it draws on.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// Its images.
    pub fn targets(&self) -> &Targets {
        &self.targets
    }

    /// The frame that a strategy gets: this view and these lights, with this renderer's depth,
    /// normals and base colours, the boxes of its models, and the box around its surfaces. With layers, shading
    /// also looks lists up in front of opaque surfaces, and with fog at any depth.
    pub fn frame<'a>(&'a self, view: &'a View, lights: &'a assign::LightBuffer) -> Frame<'a> {
        let kinds = self.layer_kinds();
        let samples = match (kinds.fog, kinds.any(), self.samples()) {
            (true, ..) => SampleDomain::AnyDepth,
            (false, true, _) => SampleDomain::InFront,
            (false, false, 1) => SampleDomain::OpaqueSurfaces,
            (false, false, _) => SampleDomain::NearSurfaces,
        };
        let frame = Frame::new(view, lights);
        let occluders = self.shadows.occluders();
        let frame = occluders.map_or(frame, |occluders| frame.with_occluders(occluders));
        frame
            .sampled_at(samples)
            .with_seed(self.seed)
            .with_depth(&self.targets.depth)
            .with_normals(&self.targets.normal)
            .with_base_color(&self.targets.base_color)
            .with_models(&self.models)
            .with_surface_bounds(self.surface_bounds.0, self.surface_bounds.1)
    }

    /// Uploads the view and the lights. This is not part of the measured time. Targets are replaced
    /// if the view does not fit them, and pipelines if depth or winding are reversed.
    pub fn prepare(
        &mut self,
        view: &View,
        lights: &assign::LightBuffer,
    ) -> Result<(), ShadingError> {
        let viewport = view.viewport;
        let [width, height] = self.targets.size;
        let fits = viewport.x.saturating_add(viewport.width) <= width
            && viewport.y.saturating_add(viewport.height) <= height;
        if !fits {
            self.targets = Targets::new(&self.gpu, view, &self.scene, self.samples())?;
        }
        let orientation = Orientation::of_view(view, self.samples());
        if orientation != self.orientation {
            self.shared = SharedPasses::new(&self.gpu, &self.frame, &self.scene, orientation)?;
            self.orientation = orientation;
        }
        self.frame.update(&self.gpu, &Frame::new(view, lights).with_seed(self.seed))?;
        self.lights = LightTotals::of_buffer(lights).with_rays(self.shadows.ray_rounds());
        self.shadows.check_lights(lights)?;
        if let Some(layers) = &mut self.layers {
            layers.prepare(&self.gpu, view, self.surface_bounds)?;
        }
        Ok(())
    }

    /// Sets the seed of what is random, for the next frame of the prepared view and lights.
    pub fn reseed(
        &mut self,
        view: &View,
        lights: &assign::LightBuffer,
        seed: u32,
    ) -> Result<(), ShadingError> {
        self.seed = seed;
        Ok(self.frame.update(&self.gpu, &Frame::new(view, lights).with_seed(seed))?)
    }

    /// Records the pass `depth`: the depth pre-pass.
    pub fn record_depth(&self, view: &View, passes: &mut dyn Passes) {
        let descriptor = wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(self.depth_attachment(Some(view.depth_clear()))),
            ..Default::default()
        };
        let scene = &self.scene_group;
        self.record_raster("depth", view, &descriptor, &self.shared.depth, (None, scene), passes);
    }

    /// Records the pass `gbuffer`, after `depth`. With several samples per pixel there is no G-buffer, and it records
    /// nothing.
    pub fn record_gbuffer(&self, view: &View, passes: &mut dyn Passes) {
        self.record_gbuffer_as(view, false, passes);
    }

    /// Records the pass `gbuffer`, after `depth`, with the model of each pixel in it.
    pub fn record_gbuffer_with_ids(&self, view: &View, passes: &mut dyn Passes) {
        self.record_gbuffer_as(view, true, passes);
    }

    pub(crate) fn record_gbuffer_as(&self, view: &View, ids: bool, passes: &mut dyn Passes) {
        if self.resolve.is_some() {
            return;
        }
        let targets = &self.targets;
        let mut colors = vec![Some(cleared(&targets.base_color)), Some(cleared(&targets.normal))];
        colors.push(targets.emissive.as_ref().map(cleared));
        colors.push(ids.then(|| cleared(&targets.model_ids)));
        colors.extend(targets.dielectric.as_ref().map(|view| Some(cleared(view))));
        let pipelines = if ids { &self.shared.gbuffer_ids } else { &self.shared.gbuffer };
        let descriptor = wgpu::RenderPassDescriptor {
            color_attachments: &colors,
            depth_stencil_attachment: Some(self.depth_attachment(None)),
            ..Default::default()
        };
        let scene = &self.scene_group;
        self.record_raster("gbuffer", view, &descriptor, pipelines, (None, scene), passes);
    }

    /// Records the pass `model-ids`, after `depth`: the model of each pixel. With several samples per pixel it records
    /// nothing.
    pub fn record_model_ids(&self, view: &View, passes: &mut dyn Passes) {
        if self.resolve.is_some() {
            return;
        }
        let descriptor = wgpu::RenderPassDescriptor {
            color_attachments: &[Some(cleared(&self.targets.model_ids))],
            depth_stencil_attachment: Some(self.depth_attachment(None)),
            ..Default::default()
        };
        let scene = &self.scene_group;
        self.record_raster(
            "model-ids",
            view,
            &descriptor,
            &self.shared.model_ids,
            (None, scene),
            passes,
        );
    }

    /// Records the pass `clay`, after `depth`: the scene without any light, as a control.
    pub fn record_clay(&self, view: &View, passes: &mut dyn Passes) {
        let groups = (None, &self.scene_group);
        self.record_radiance(("clay", true), view, &self.shared.clay, groups, passes);
    }

    /// A pass over the triangles into the radiance image, with the bind groups of lists and scene.
    /// `name` is its name; `has_depth` says whether depth is drawn already or by this pass.
    pub(crate) fn record_radiance(
        &self,
        (name, has_depth): (&str, bool),
        view: &View,
        pipelines: &RasterPipelines,
        groups: (Option<&wgpu::BindGroup>, &wgpu::BindGroup),
        passes: &mut dyn Passes,
    ) {
        let targets = &self.targets;
        let mut color = cleared(targets.samples.as_ref().unwrap_or(&targets.radiance));
        color.ops.load = wgpu::LoadOp::Clear(wgpu::Color::BLACK);
        let clear = (!has_depth).then(|| view.depth_clear());
        let descriptor = wgpu::RenderPassDescriptor {
            color_attachments: &[Some(color)],
            depth_stencil_attachment: Some(self.depth_attachment(clear)),
            ..Default::default()
        };
        self.record_raster(name, view, &descriptor, pipelines, groups, passes);
        if let (Some(resolve), Some(samples)) = (&self.resolve, &targets.samples) {
            resolve.record(&self.gpu, samples, &targets.radiance, targets.size, passes);
        }
    }

    fn record_raster(
        &self,
        name: &str,
        view: &View,
        descriptor: &wgpu::RenderPassDescriptor<'_>,
        pipelines: &RasterPipelines,
        (lists, scene): (Option<&wgpu::BindGroup>, &wgpu::BindGroup),
        passes: &mut dyn Passes,
    ) {
        let viewport = view.viewport;
        let textures = name != "depth" || self.scene.has_mask();
        let only_opaque = self.layer_kinds().sheets;
        passes.render(name, descriptor, &mut |pass| {
            pass.set_viewport(
                viewport.x as f32,
                viewport.y as f32,
                viewport.width as f32,
                viewport.height as f32,
                0.0,
                1.0,
            );
            pass.set_bind_group(0, self.frame.bind_group(), &[]);
            if let Some(lists) = lists {
                pass.set_bind_group(1, lists, &[]);
            }
            pass.set_bind_group(2, scene, &[]);
            self.scene.draw(pass, textures, only_opaque, |key| pipelines.get(key));
        });
    }

    fn depth_attachment(&self, clear: Option<f32>) -> wgpu::RenderPassDepthStencilAttachment<'_> {
        wgpu::RenderPassDepthStencilAttachment {
            view: &self.targets.depth,
            depth_ops: Some(wgpu::Operations {
                load: clear.map_or(wgpu::LoadOp::Load, wgpu::LoadOp::Clear),
                store: wgpu::StoreOp::Store,
            }),
            stencil_ops: None,
        }
    }
}

fn cleared(view: &wgpu::TextureView) -> wgpu::RenderPassColorAttachment<'_> {
    wgpu::RenderPassColorAttachment {
        view,
        depth_slice: None,
        resolve_target: None,
        ops: wgpu::Operations {
            load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
            store: wgpu::StoreOp::Store,
        },
    }
}
