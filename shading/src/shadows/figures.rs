//! What was made for a shadow model, in numbers.

use crate::ShadowModel;

/// What was made for a shadow model.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ShadowFigures {
    /// The model that was asked for.
    pub model: ShadowModel,
    /// Maps for each area light, or the most of them if frames subdivide. Fewer than asked for if more did not fit
    /// the atlas. With rays, points of each area light.
    pub maps_per_area_light: u32,
    /// Maps of all lights at present. With rays, points of all lights.
    pub maps: u32,
    /// Faces of all maps at present.
    pub faces: u32,
    /// Width and height of the atlas, texels; zeros with rays.
    pub atlas_px: [u32; 2],
    /// Bytes of what hides lights from groups ([`Renderer::find_occluders`](crate::Renderer::find_occluders)); 0 without it.
    pub occluder_bytes: u64,
    /// Bytes of the deep images that rays cross; 0 with maps.
    pub image_bytes: u64,
}

impl ShadowFigures {
    /// Bytes of the atlas on the GPU.
    pub fn atlas_bytes(&self) -> u64 {
        self.atlas_px.map(u64::from).iter().product::<u64>() * 4
    }

    /// Whether area lights got fewer maps than asked for.
    pub fn fell_back(&self) -> bool {
        self.maps_per_area_light < self.model.maps()
    }
}
