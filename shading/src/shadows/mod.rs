//! Shadow maps: how far light comes from points of each light, drawn before the frames that read them.
//!
//! # The idea
//!
//! A light's radiance at a sample is that without shadows times a *visible share* (Dobetsberger 2025, equations 6.1 and
//! 6.2): the irradiance of the light's points that the sample sees, over that of all of its points. The share depends on
//! the light, the position and the normal only. So all strategies get the same share, and their images stay comparable bit
//! for bit.
//!
//! The paper counts all points alike. Here each point counts by the irradiance of the patch of the light that it stands
//! for: its area times `cos(sample) cos(light) / distance^2`. So a hidden part takes away as much diffuse light as it would
//! have given, and with ever more maps diffuse light becomes exact.
//!
//! 1. [`points`] chooses the points: one for lights that have a position, the corners of subdivided quads for
//!    rectangles.
//! 2. [`plan`] gives each point the faces of a cube, half a cube or a cone, and each face its place in one atlas. If
//!    the maps do not fit, all area lights get fewer.
//! 3. [`ShadowMaps::record`] draws the depth of triangles into every face, from both sides, because both sides of
//!    a triangle block light in the [truth](crate::traced). Alpha masks keep their holes. A face leaves out parts of the
//!    scene beside its frustum, and beyond the light's range where no sample lies ([`sight`]).
//! 4. `shadow.wesl` looks a sample up in all maps of a light. Points below the sample's horizon do not count: the
//!    light without shadows leaves them out already.
//!
//! # The two offsets
//!
//! A texel holds the depth at its centre, and a look-up reads the texel that the sample falls into. A lit surface would
//! be dark where the centre shows a part of it, or of a surface beside it, that is nearer. Let `r` be the distance from
//! a sample to the farthest texel centre that is read, as a tangent. Both offsets follow from it; nothing is tuned.
//!
//! *The sample's plane.* The sample is moved along its normal, by
//!
//! ```text
//! offset = depth * r * s / (1 - r * s * a)
//! ```
//!
//! with `a` and `s` the cosine and the sine between the normal and the axis of the face. The moved sample then lies in
//! front of the plane through the sample, seen along the ray of each texel. So no surface behind this plane hides it:
//! neither its own, nor that around a convex edge.
//!
//! *The caster's plane.* The rasteriser moves the depth of each triangle away from the light, by what its plane changes
//! over the distance `r` (`slopes` times the greatest difference of neighbouring texels). Each texel then holds a depth
//! behind the triangle's plane at the sample. So no plane with the sample in front of it hides the sample, such as the
//! wall beside it.
//!
//! Both move a plane sideways by about a texel, whatever its slope. Comparing leaves a slack of `depth / 1024` for what
//! rasterisers round ([`plan`]). So light cannot pass a wall that is thicker than two texels and this slack,
//! `4 depth / px + depth / 1024`, or as many more texels as the filter is wide. The offset of a sample follows the shading
//! normal: where a normal map turns it away from the surface, the offset is less than the surface needs.
//!
//! # Soft filters
//!
//! With [`ShadowModel::Pcss`], each map looks for what hides its part of the light, and filters as widely as that makes the
//! penumbra ([`patch`]). Each look-up has the offsets of a single texel.
//!
//! # Paraboloids
//!
//! With [`ShadowModel::Paraboloids`], half the space is one square: the direction at the angle `t` to the axis lies
//! `tan(t / 2)` from the middle. A look-up takes the offset of a flat face across the line from the light to the sample. The
//! rasteriser draws straight edges, so large triangles are wrong ([`ShadowModel::Paraboloids`]).
//!
//! # Layers
//!
//! Transparent surfaces are looked up as opaque ones. Fog and particles have no normal: no point stands below their horizon,
//! nothing is moved along a normal, and a patch counts by its solid angle (`shadow_open.wesl`). Surfaces that are drawn as
//! layers cast no shadow.
//!
//! # Suns
//!
//! Each sun has one orthographic map of the whole scene ([`sun_maps`]), in the same atlas.
//!
//! # Subdivision
//!
//! With [`ShadowModel::Adaptive`], [`quadtree`] divides each rectangle where frames show bands (Dobetsberger 2025,
//! algorithm 1). [`start_level`] chooses the first subdivision, [`banding`] tests the quads, and [`rectangle`] gives
//! points their places in an atlas that holds the most maps of all lights. A place keeps its faces, so a new point draws
//! its own map only.
//!
//! # Cost
//!
//! Maps hold while lights and scene stand still, so they are drawn once, before the frames. If lights move, each frame plans
//! and draws all maps again ([`moved`]), which must be lights that the CPU knows. Shading reads `maps * taps` texels per light
//! and sample, and twice as many with a soft filter. A map of an area light takes `3 px^2` texels of 4 bytes if it is
//! one-sided, and `6 px^2` otherwise.
//!
//! # Where it fails
//!
//! Few maps show as many hard shadows. Texels are `2 depth / px` wide, so distant shadows are coarse. A shadow caster
//! thinner than a texel casts no or too wide a shadow. The share multiplies diffuse and specular light alike, so a
//! highlight whose part of the emitter is hidden stays visible: the separation error. It is zero on matte surfaces.

mod adaptive;
mod atlas;
mod banding;
mod cast;
mod clear_face;
mod draw;
mod face;
mod figures;
mod held;
mod moved;
mod occluders;
mod patch;
mod plan;
mod points;
mod quadtree;
mod rays;
mod reach;
mod rectangle;
mod refine;
mod sight;
mod start_level;
mod sun_maps;
mod views;

use assign::{FrameBindings, Gpu, Light, LightBuffer, Passes, View};
use bytemuck::cast_slice;

use crate::{
    ShadingError, ShadowModel,
    bound_maps::BoundMaps,
    geometry::SceneGpu,
    raster::{Orientation, RasterPass, RasterPipelines},
};

use adaptive::Adaptive;
pub use adaptive::ShadowRefinement;
use atlas::{STORAGE_BUFFERS, atlas, check_device};
use banding::Drawn;
use face::Face;
pub use figures::ShadowFigures;
pub(crate) use held::Shadows;
use moved::check_known;
use occluders::Pyramid;
pub use occluders::{OCCLUSION_TEST, OccluderDepth};
use plan::Plan;
pub use rays::shadow_images;
pub(crate) use sun_maps::SunnyScene;
pub use sun_maps::{SunMapRecord, SunMapsRecord};
use views::Views;

/// The longest side of an atlas, texels, if the device allows more: its places are stored in 16 bits.
const MOST_ATLAS_PX: u32 = 1 << 15;

/// What maps are made for.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Asked {
    pub(crate) model: ShadowModel,
    /// How far samples may lie that lights reach, in ranges of the lights.
    pub(crate) ranges: f32,
    /// Whether transparent surfaces cast no shadows.
    pub(crate) only_opaque: bool,
    /// What suns light.
    pub(crate) sunny: SunnyScene,
}

/// The shadow maps of a scene's lights.
#[derive(Debug)]
pub(crate) struct ShadowMaps {
    figures: ShadowFigures,
    /// The lights that the maps are for, by slot.
    lights: Vec<Light>,
    /// All places of faces, some of which may be free.
    faces: Vec<Face>,
    /// How many faces there is room for.
    capacity: usize,
    /// The faces of all maps, ascending.
    drawn: Vec<u32>,
    /// Those of flat faces, and of paraboloids if there are any.
    pipelines: RasterPipelines,
    curved: Option<RasterPipelines>,
    views: Views,
    bound: BoundMaps,
    /// The trees of rectangles, if frames subdivide them.
    adaptive: Option<Adaptive>,
    /// Maps of lights that have no tree.
    fixed_maps: u32,
    asked: Asked,
    /// What hides lights from groups, if asked for.
    pyramid: Option<Pyramid>,
    /// Whether the maps of these lights were drawn, and what hides them from groups was found.
    is_drawn: bool,
    has_occluders: bool,
}

impl ShadowMaps {
    /// Plans the maps of `lights` and allocates them.
    ///
    /// # Errors
    ///
    /// [`AssignError::Unsupported`] for lights whose slots the CPU does not know, and [`AssignError::Parameter`] if
    /// not even one map per light fits an atlas.
    pub(crate) fn new(
        gpu: &Gpu,
        scene: &SceneGpu,
        frame: &FrameBindings,
        lights: &LightBuffer,
        asked: Asked,
    ) -> Result<Self, ShadingError> {
        check_device(gpu, "shading with shadow maps", STORAGE_BUFFERS)?;
        let Asked { model, ranges, .. } = asked;
        check_known(model, lights)?;
        let most_px = gpu.device.limits().max_texture_dimension_2d.min(MOST_ATLAS_PX);
        let mut plan = Plan::new(lights.lights(), asked.sunny, model, most_px)?;
        let adaptive = Adaptive::new(gpu, frame.layout(), &mut plan, lights.lights(), model)?;
        let figures = ShadowFigures {
            model,
            maps_per_area_light: plan.maps,
            maps: plan.map_count + asked.sunny.squares(),
            faces: plan.faces.len() as u32,
            atlas_px: plan.size,
            occluder_bytes: 0,
            image_bytes: 0,
        };
        let records_bytes: &[u8] = cast_slice(&plan.records);
        let records = gpu.storage("shadow records", records_bytes.len() as u64)?;
        gpu.queue.write_buffer(&records, 0, records_bytes);
        let atlas = gpu.allocate("the atlas of shadow maps", figures.atlas_bytes(), || {
            atlas(gpu, plan.size)
        })?;
        let sun_maps = gpu.uniform("maps of suns", size_of::<SunMapsRecord>() as u64);
        gpu.queue.write_buffer(&sun_maps, 0, bytemuck::bytes_of(&plan.suns));
        let (views, layout) = Views::new(gpu, &plan.faces)?;
        let orientation =
            Orientation { depth: assign::DepthMapping::Reversed, is_mirrored: false, samples: 1 };
        let pipelines_of = |is_curved| {
            let pass = RasterPass::ShadowMap { slopes: plan.slopes, is_curved };
            RasterPipelines::new(gpu, &layout, scene, orientation, pass)
        };
        let pipelines = pipelines_of(false)?;
        let curved = model.is_curved().then(|| pipelines_of(true)).transpose()?;
        let subdivided = plan.sites.len() as u32 * plan.maps;
        let mut maps = Self {
            fixed_maps: figures.maps - subdivided,
            figures,
            lights: lights.lights().to_vec(),
            drawn: (0..figures.faces).collect(),
            capacity: plan.faces.len(),
            faces: plan.faces,
            pipelines,
            curved,
            views,
            bound: BoundMaps::new(model, ranges, atlas, records, (asked.sunny.suns, sun_maps)),
            adaptive,
            asked,
            pyramid: None,
            is_drawn: false,
            has_occluders: false,
        };
        maps.count_maps();
        Ok(maps)
    }

    /// Finds the faces of all maps, and counts them, where frames change them.
    fn count_maps(&mut self) {
        let Some(adaptive) = &self.adaptive else { return };
        self.drawn = adaptive.drawn_faces(self.faces.len());
        self.figures.faces = self.drawn.len() as u32;
        self.figures.maps = self.fixed_maps + adaptive.maps_of_rectangles().sum::<u32>();
    }

    pub(crate) fn figures(&self) -> ShadowFigures {
        self.figures
    }

    /// What lighting reads.
    pub(crate) fn bound(&self) -> &BoundMaps {
        &self.bound
    }

    /// Whether the maps of these lights were drawn.
    pub(crate) fn is_drawn(&self) -> bool {
        self.is_drawn
    }

    /// Whether what hides these lights from groups was found.
    pub(crate) fn has_occluders(&self) -> bool {
        self.is_drawn && self.has_occluders
    }

    /// Whether frames subdivide rectangles.
    pub(crate) fn is_adaptive(&self) -> bool {
        self.adaptive.is_some()
    }

    /// Whether frames could change a rectangle.
    pub(crate) fn has_tests(&self) -> bool {
        self.adaptive.as_ref().is_some_and(Adaptive::has_tests)
    }

    /// The number of maps of each rectangle, and how many rectangles have no places left; `None` if frames do not
    /// subdivide them.
    pub(crate) fn subdivision(&self) -> Option<(Vec<u32>, u32)> {
        let adaptive = self.adaptive.as_ref()?;
        Some((adaptive.maps_of_rectangles().collect(), adaptive.full_rectangles()))
    }

    /// Takes the bands that frames have shown, and records the pass `shadow-maps` for new points.
    pub(crate) fn refine(
        &mut self,
        view: &View,
        scene: &SceneGpu,
        scene_group: &wgpu::BindGroup,
        passes: &mut dyn Passes,
    ) -> Result<ShadowRefinement, ShadingError> {
        let Some(adaptive) = &mut self.adaptive else { return Ok(ShadowRefinement::default()) };
        let Some(patch) = adaptive.advance(view) else { return Ok(ShadowRefinement::default()) };
        let found = adaptive.last();
        let views = (&self.views.buffer, self.views.stride);
        adaptive.write(&patch, self.bound.records(), views, passes)?;
        patch.move_faces(&mut self.faces);
        self.count_maps();
        let mut fresh: Vec<u32> = patch.faces.iter().map(|moved| moved.face as u32).collect();
        fresh.sort_unstable();
        if !fresh.is_empty() {
            self.draw(scene, scene_group, &fresh, wgpu::LoadOp::Load, passes);
            self.record_occluders(passes);
        }
        Ok(found)
    }

    /// Records a test for bands of the frame that was drawn. Returns whether it did.
    pub(crate) fn record_banding(
        &mut self,
        drawn: Drawn<'_>,
        passes: &mut dyn Passes,
    ) -> Result<bool, ShadingError> {
        match &mut self.adaptive {
            Some(adaptive) => adaptive.record_round(drawn, &self.bound, passes),
            None => Ok(false),
        }
    }
}
