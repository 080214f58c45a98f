//! The passes over the triangles. Each is a set of pipelines, one per kind of material.

use std::collections::HashMap;

use assign::{DepthMapping, Gpu, Shader, View};
use assign_cdi::DeepImageSettings;

use crate::{
    LightingOptions, ShadingError,
    bound_shadows::mount_rays,
    draws::DrawKey,
    geometry::SceneGpu,
    lighting_inputs::Bound,
    materials::TEXTURE_FLAGS,
    shaders::{LISTS_GROUP, lighting_modules},
    targets::{
        BASE_COLOR_FORMAT, DEPTH_FORMAT, DIELECTRIC_FORMAT, EMISSIVE_FORMAT, MODEL_FORMAT,
        NORMAL_FORMAT, RADIANCE_FORMAT, SAMPLES_FORMAT,
    },
};

/// A pass over the triangles.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant, reason = "it is made once per pipeline, and never stored")]
pub(crate) enum RasterPass<'a> {
    /// Depth only.
    Depth,
    /// Depth only, of both sides of all triangles, moved away from the light: a face of a shadow map.
    ShadowMap {
        /// How far depth is moved, in greatest differences of depth between neighbouring texels.
        slopes: f32,
        /// Whether it is a paraboloid.
        is_curved: bool,
    },
    /// The G-buffer, drawn where the depth is equal.
    GBuffer {
        /// Whether it holds the index of the model.
        ids: bool,
    },
    /// The index of the model, drawn where the depth is equal.
    ModelIds,
    /// Lit radiance.
    Forward {
        /// The strategy's look-up and the options of lighting.
        lists: Lists<'a>,
        /// Whether depth was drawn before. If so, only fragments of equal depth are lit; otherwise
        /// the pass tests and writes depth.
        has_depth: bool,
    },
    /// Transparent surfaces, blended where no opaque surface is nearer.
    Sheets(SheetPass<'a>),
    /// The control without lights, drawn where the depth is equal.
    Clay,
}

/// The shader and the bindings of a pass over transparent surfaces.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SheetPass<'a> {
    /// The strategy's look-up and the options of lighting. `None`: samples are captured, and the image stays.
    pub(crate) lists: Option<Lists<'a>>,
    /// Layout of bind group 2.
    pub(crate) layout: &'a wgpu::BindGroupLayout,
    /// Whether there is fog.
    pub(crate) fogged: bool,
}

impl RasterPass<'_> {
    /// Whether the pass tests for the nearest depth and writes it. Otherwise it draws where the
    /// depth is equal.
    fn writes_depth(self) -> bool {
        matches!(
            self,
            Self::Depth | Self::ShadowMap { .. } | Self::Forward { has_depth: false, .. }
        )
    }

    /// Samples per pixel of its targets. Only forward modes draw several, and they need no G-buffer.
    fn samples(self, orientation: Orientation) -> u32 {
        match self {
            Self::Depth | Self::Forward { .. } | Self::Clay => orientation.samples,
            Self::GBuffer { .. } | Self::ModelIds | Self::ShadowMap { .. } | Self::Sheets(_) => 1,
        }
    }

    /// The depth at which fragments are drawn.
    fn depth_compare(self, depth: DepthMapping) -> wgpu::CompareFunction {
        match depth {
            _ if !self.writes_depth() && !matches!(self, Self::Sheets(_)) => {
                wgpu::CompareFunction::Equal
            }
            DepthMapping::Standard => wgpu::CompareFunction::LessEqual,
            DepthMapping::Reversed => wgpu::CompareFunction::GreaterEqual,
        }
    }

    /// The sides of triangles that are left out. Both sides block light.
    fn cull_mode(self, key: DrawKey) -> Option<wgpu::Face> {
        let is_culled = !key.material.double_sided && !matches!(self, Self::ShadowMap { .. });
        is_culled.then_some(wgpu::Face::Back)
    }

    /// What is added to depth.
    fn depth_bias(self) -> wgpu::DepthBiasState {
        match self {
            // Reversed depth falls with distance.
            Self::ShadowMap { slopes, .. } => {
                wgpu::DepthBiasState { slope_scale: -slopes, ..Default::default() }
            }
            _ => wgpu::DepthBiasState::default(),
        }
    }

    /// How fragments change the image.
    fn color_target(self, format: wgpu::TextureFormat) -> wgpu::ColorTargetState {
        match self {
            Self::Sheets(SheetPass { lists, .. }) => blended(lists.is_some()),
            _ => format.into(),
        }
    }
}

/// Radiance over what is there. Alpha is the share of it that a fragment hides. Without `is_lit`, the image stays.
pub(crate) fn blended(is_lit: bool) -> wgpu::ColorTargetState {
    wgpu::ColorTargetState {
        format: RADIANCE_FORMAT,
        blend: Some(wgpu::BlendState::PREMULTIPLIED_ALPHA_BLENDING),
        write_mask: if is_lit { wgpu::ColorWrites::COLOR } else { wgpu::ColorWrites::empty() },
    }
}

/// What the pipelines of a pass depend on in a view and its targets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Orientation {
    /// Direction of clip depth.
    pub(crate) depth: DepthMapping,
    /// Whether the view reverses the winding of triangles.
    pub(crate) is_mirrored: bool,
    /// Samples per pixel.
    pub(crate) samples: u32,
}

impl Orientation {
    pub(crate) fn of_view(view: &View, samples: u32) -> Self {
        Self { depth: view.depth, is_mirrored: view.is_mirrored(), samples }
    }
}

/// The strategy's part of a lighting shader.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lists<'a> {
    pub(crate) lookup: assign::Lookup<'a>,
    pub(crate) options: LightingOptions,
    /// The deep images that rays of shadows cross.
    pub(crate) images: Option<DeepImageSettings>,
}

impl Lists<'_> {
    /// Sets the flags of the options, and mounts what they import.
    pub(crate) fn set_flags<'a>(&self, shader: Shader<'a>) -> Shader<'a> {
        mount_rays(self.options.set_flags(shader), self.images)
    }
}

/// The pipelines of one pass. Clones share them.
#[derive(Clone, Debug)]
pub(crate) struct RasterPipelines {
    pipelines: HashMap<DrawKey, wgpu::RenderPipeline>,
}

impl RasterPipelines {
    /// Compiles the pipelines. `frame` is the layout of bind group 0.
    pub(crate) fn new(
        gpu: &Gpu,
        frame: &wgpu::BindGroupLayout,
        scene: &SceneGpu,
        orientation: Orientation,
        pass: RasterPass<'_>,
    ) -> Result<Self, ShadingError> {
        let mut pipelines = HashMap::new();
        let keys = match pass {
            RasterPass::Sheets(_) => scene.sheet_keys(),
            _ => scene.keys(),
        };
        for key in keys {
            pipelines.insert(key, pipeline(gpu, frame, scene, orientation, pass, key)?);
        }
        Ok(Self { pipelines })
    }

    pub(crate) fn get(&self, key: DrawKey) -> Option<&wgpu::RenderPipeline> {
        self.pipelines.get(&key)
    }
}

/// Which optional properties a scene's surfaces have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shown {
    emissive: bool,
    dielectrics: bool,
}

impl Shown {
    fn from_scene(scene: &SceneGpu) -> Self {
        Self { emissive: scene.has_emissive(), dielectrics: scene.has_dielectrics() }
    }
}

/// The WESL of one pass for one material.
pub(crate) fn shader<'a>(pass: RasterPass<'a>, key: DrawKey, shown: Shown) -> Shader<'a> {
    let material = key.material;
    let is = |wanted: &str| match pass {
        RasterPass::Depth | RasterPass::ShadowMap { .. } => wanted == "depth",
        RasterPass::GBuffer { .. } => wanted == "gbuffer",
        RasterPass::Forward { .. } => wanted == "forward",
        RasterPass::Clay => wanted == "clay",
        RasterPass::ModelIds => wanted == "write_model_ids",
        RasterPass::Sheets(_) => wanted == "sheets",
    };
    let shades = is("gbuffer") || is("forward") || is("sheets");
    let mut shader = lighting_modules(LISTS_GROUP)
        .flag("gbuffer", is("gbuffer"))
        .flag("forward", is("forward"))
        .flag("clay", is("clay"))
        .flag("write_model_ids", is("write_model_ids"))
        .flag("sheets", is("sheets"))
        .flag("mask", is("depth") && material.mask)
        .flag("to_paraboloid", matches!(pass, RasterPass::ShadowMap { is_curved: true, .. }))
        .flag("forward_mask", pass.writes_depth() && is("forward") && material.mask)
        .flag("gbuffer_ids", matches!(pass, RasterPass::GBuffer { ids: true }))
        .flag("emissive", shown.emissive && shades)
        .flag("dielectrics", shown.dielectrics && shades)
        .flag("unlit", material.unlit)
        .flag("vertex_colors", material.vertex_colors)
        .flag("uv_transforms", material.uv_transforms);
    for (slot, flag) in TEXTURE_FLAGS.into_iter().enumerate() {
        shader = shader.flag(flag, material.textures[slot]);
    }
    let lists = match pass {
        RasterPass::Forward { lists, .. } => Some(lists),
        RasterPass::Sheets(SheetPass { lists, fogged, .. }) => {
            let captures = lists.is_none();
            shader = shader.flag("captures", captures).flag("fogged", fogged && !captures);
            lists
        }
        _ => None,
    };
    if let Some(lists) = lists {
        shader = lists.set_flags(shader).strategy(lists.lookup.module).without_subgroups();
        if is("sheets") {
            shader = shader.looks_up_anywhere();
        }
    }
    shader
}

fn pipeline(
    gpu: &Gpu,
    frame: &wgpu::BindGroupLayout,
    scene: &SceneGpu,
    orientation: Orientation,
    pass: RasterPass<'_>,
    key: DrawKey,
) -> Result<wgpu::RenderPipeline, ShadingError> {
    let shown = Shown::from_scene(scene);
    let samples = pass.samples(orientation);
    let mut shader = shader(pass, key, shown);
    if samples > 1 {
        // A fragment shades the pixel's centre, which may lie off its triangle.
        shader = shader.looks_up_anywhere();
    }
    // SAFETY: the loops of forward lighting and of transparent surfaces count up to the number of suns, maps or pixels, halve a
    // list, or end with the strategy's look-up, which returns at most as many lights as a `u32` counts. Loops in look-ups end: those of
    // `assign` do, and the strategy's author guarantees it of its own. The other passes have no loop.
    #[allow(unsafe_code, reason = "its loops end")]
    let module = unsafe { shader.create_uncounted(gpu, "package::geometry") }?;
    let (vertex, fragment, formats) = entry_points(pass, key, shown);
    let (lists, scene_layout) = match pass {
        RasterPass::Forward { lists, .. } => {
            (Some(lists.lookup.layout()), scene.layout(lists.options.bound()))
        }
        RasterPass::Sheets(SheetPass { lists, layout, .. }) => {
            (lists.map(|lists| lists.lookup.layout()), layout)
        }
        _ => (None, scene.layout(Bound::default())),
    };
    let textures = fragment.and_then(|_| scene.materials.layout(key.material));
    let layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some(vertex),
        bind_group_layouts: &[Some(frame), lists, Some(scene_layout), textures],
        immediate_size: 0,
    });
    let without_colors = [Some(vertex_layout())];
    let with_colors = [Some(vertex_layout()), Some(color_layout())];
    let targets: Vec<Option<wgpu::ColorTargetState>> = formats
        .into_iter()
        .map(|format| Some(pass.color_target(stored_as(format?, samples))))
        .collect();
    Ok(gpu.device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(vertex),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module: &module,
            entry_point: Some(vertex),
            compilation_options: Default::default(),
            buffers: if key.material.vertex_colors { &with_colors } else { &without_colors },
        },
        primitive: wgpu::PrimitiveState {
            front_face: if key.mirrored == orientation.is_mirrored {
                wgpu::FrontFace::Ccw
            } else {
                wgpu::FrontFace::Cw
            },
            cull_mode: pass.cull_mode(key),
            ..Default::default()
        },
        depth_stencil: Some(wgpu::DepthStencilState {
            format: DEPTH_FORMAT,
            depth_write_enabled: Some(pass.writes_depth()),
            depth_compare: Some(pass.depth_compare(orientation.depth)),
            stencil: Default::default(),
            bias: pass.depth_bias(),
        }),
        multisample: wgpu::MultisampleState { count: samples, ..Default::default() },
        fragment: fragment.map(|entry_point| wgpu::FragmentState {
            module: &module,
            entry_point: Some(entry_point),
            compilation_options: Default::default(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    }))
}

/// The format of an image with several samples per pixel.
fn stored_as(format: wgpu::TextureFormat, samples: u32) -> wgpu::TextureFormat {
    match format {
        RADIANCE_FORMAT if samples > 1 => SAMPLES_FORMAT,
        other => other,
    }
}

/// Vertex and fragment entry point of a pass, and the formats that it writes.
fn entry_points(
    pass: RasterPass<'_>,
    key: DrawKey,
    shown: Shown,
) -> (&'static str, Option<&'static str>, Vec<Option<wgpu::TextureFormat>>) {
    match pass {
        RasterPass::ShadowMap { is_curved: true, .. } => {
            ("vertex_surface", Some("fragment_paraboloid"), vec![])
        }
        RasterPass::Depth | RasterPass::ShadowMap { .. } if key.material.mask => {
            ("vertex_surface", Some("fragment_mask"), vec![])
        }
        RasterPass::Depth | RasterPass::ShadowMap { .. } => ("vertex_depth", None, vec![]),
        RasterPass::GBuffer { ids } => {
            let emissive = shown.emissive.then_some(EMISSIVE_FORMAT);
            let ids = ids.then_some(MODEL_FORMAT);
            let mut formats = vec![Some(BASE_COLOR_FORMAT), Some(NORMAL_FORMAT), emissive, ids];
            formats.extend(shown.dielectrics.then_some(Some(DIELECTRIC_FORMAT)));
            ("vertex_surface", Some("fragment_gbuffer"), formats)
        }
        RasterPass::Forward { .. } => {
            ("vertex_surface", Some("fragment_forward"), vec![Some(RADIANCE_FORMAT)])
        }
        RasterPass::Sheets(_) => {
            ("vertex_surface", Some("fragment_sheet"), vec![Some(RADIANCE_FORMAT)])
        }
        RasterPass::ModelIds => {
            ("vertex_surface", Some("fragment_model_ids"), vec![Some(MODEL_FORMAT)])
        }
        RasterPass::Clay => ("vertex_surface", Some("fragment_clay"), vec![Some(RADIANCE_FORMAT)]),
    }
}

fn color_layout() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 1] = wgpu::vertex_attr_array![4 => Float32x4];
    wgpu::VertexBufferLayout {
        array_stride: 16,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &ATTRIBUTES,
    }
}

fn vertex_layout() -> wgpu::VertexBufferLayout<'static> {
    const ATTRIBUTES: [wgpu::VertexAttribute; 4] = wgpu::vertex_attr_array![
        0 => Float32x3, 1 => Float32x3, 2 => Float32x4, 3 => Float32x2
    ];
    wgpu::VertexBufferLayout {
        array_stride: size_of::<scenes::Vertex>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &ATTRIBUTES,
    }
}
