//! The one shading pipeline. Every strategy gets the same triangles, materials, BRDF and order of
//! summation.
//!
//! # A frame
//!
//! | pass | mode | reads | writes |
//! |---|---|---|---|
//! | `shadow-maps` | once, with a [`ShadowModel`]; where frames subdivide lights, again for new points | triangles | depth from the lights |
//! | `occluders` | once, where a strategy leaves out hidden lights | depth from the lights | their farthest depths, by blocks of texels |
//! | `depth` | all; in forward without a pre-pass only where a strategy reads surfaces | triangles | depth |
//! | `gbuffer` | deferred, and where a strategy needs normals | triangles, textures | base colour, normal, roughness, emissive; in `deferred-ids` the index of each pixel's model |
//! | `model-ids` | deferred, where a strategy needs models | triangles | index of each pixel's model |
//! | `cdi-count`, `cdi-scan`, `cdi-fill`, `cdi-sort` | once, with [`ShadowModel::Cdi`], in place of `shadow-maps` | triangles | deep images, which rays of shadows cross |
//! | `shadow-banding` | with [`ShadowModel::Adaptive`], by [`Renderer::record_banding`] | G-buffer, shadow maps | quads of lights that show bands |
//! | the strategy's passes | all | depth, lights | lists |
//! | `shade` | deferred | G-buffer, lists, lights | radiance, by compute |
//! | `shade` | forward | triangles, textures, lists, lights | radiance, by fragments |
//! | `fog-light`, `fog-sum`, `fog-apply`, `blend` | all, with [`LayerOptions`] | depth, lists, lights | fog, transparent surfaces and particles over radiance |
//!
//! All modes call the one lighting function in `lighting.wesl`. All modes find a sample from pixel
//! and depth by `sample_at`, so a strategy assigns it to the same group. Only features that a scene
//! contains are compiled and bound: each texture, alpha masks, emission, spots, area lights.
//!
//! [`ListCheck`] checks a strategy's lists on the CPU in f64. [`HdrImage`] compares images bit for
//! bit. [`traced`] renders the true image, including shadows and bounces.

mod area_model;
mod before_lighting;
mod bound_maps;
mod bound_shadows;
mod contributions;
mod draws;
mod dump;
mod error;
mod gbuffer_inputs;
mod geometry;
mod heat_map;
mod image;
mod kept_image;
mod layers;
mod lighting;
mod lighting_inputs;
mod lighting_options;
mod list_check;
mod loop_rounds;
pub mod ltc;
mod materials;
mod mesh_buffers;
mod mips;
mod mode;
mod moving_lights;
mod operations;
mod pieces;
mod pixel_group;
mod pixel_pass;
mod probe;
mod raster;
mod raster_spheres;
pub mod reference;
mod renderer;
mod resolve;
mod rsm;
mod shaders;
mod shadow_model;
mod shadows;
mod shared_passes;
mod targets;
pub mod traced;
mod truth;
mod world_triangles;

pub use area_model::{ACCEPTED_AREA_MODELS, AreaModel, MAX_AREA_SAMPLES};
pub use before_lighting::record_before_lighting;
pub use contributions::{PixelLight, PixelSurface, light_pixel};
pub use dump::{list_of_pixel, visit_lists};
pub use error::ShadingError;
pub use geometry::{InstanceRecord, SceneGpu};
pub use heat_map::{HEAT_MAP_RED, heat_color, heat_map_png};
pub use image::{HdrImage, ImageDifference, luminance};
pub use kept_image::KeptImage;
pub use layers::{
    FogRecord, LayerKinds, LayerOptions, LayerSamples, MAX_FOG_PER_M, MIN_FOG_PER_M,
    ParticleRecord, visit_layer_lists,
};
pub use lighting::Lighting;
pub use lighting_inputs::{LightingRecord, SunRecord, SunsRecord};
pub use lighting_options::{Cut, LightingOptions};
pub use list_check::{HiddenPairs, ListCheck, ListsTruth, MissedPair};
pub use materials::MaterialRecord;
pub use mode::Mode;
pub use moving_lights::MovingLights;
pub use operations::{Operations, Terms, count_operations};
pub use pixel_group::{GroupVolume, PixelGroup, PixelGroupsRecord, groups_of_pixel};
pub use probe::{Samples, probe, record_for_probe};
pub use raster_spheres::{RASTER_SPHERE_TOLERANCE, RasterSpheres};
pub use renderer::Renderer;
pub use rsm::{MAX_RSM_ANGLE, rsm_view};
pub use shaders::lighting_shader;
pub use shadow_model::{
    ACCEPTED_SHADOW_MODELS, BAND_DIVISORS, FEWEST_ADAPTIVE, MAP_COUNTS, MAX_MAP_PX, MIN_MAP_PX,
    MOST_ADAPTIVE, RAY_COUNTS, SOFT_TAP_COUNTS, ShadowModel, TAP_COUNTS,
};
pub use shadows::{
    OCCLUSION_TEST, OccluderDepth, ShadowFigures, ShadowRefinement, SunMapRecord, SunMapsRecord,
    shadow_images,
};
pub use targets::Targets;
pub use truth::{EDGE, LightBvh, is_missed};
pub use world_triangles::WorldTriangles;
