//! What lighting reads of the lights' shadows: maps, or the points of lights and the deep images that rays cross.

use assign::{Shader, Suns, entry, storage_entry};
use assign_cdi::{DeepImageSettings, DeepImages, RayBuffers};

use crate::{
    ShadowModel,
    bound_maps::{BoundMaps, RECORDS_BINDING},
};

/// The bind group of shadows.
const GROUP: u32 = 2;

/// The first binding of `ray_cast.wesl` in it.
const RAYS_BINDING: u32 = 30;

/// Which kind of shadows a layout binds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum ShadowKind {
    #[default]
    None,
    Maps,
    Rays,
}

impl ShadowKind {
    pub(crate) const ALL: [Self; 3] = [Self::None, Self::Maps, Self::Rays];

    /// The kind of a model.
    pub(crate) fn of(model: ShadowModel) -> Self {
        match model {
            ShadowModel::None => Self::None,
            ShadowModel::Maps { .. }
            | ShadowModel::Pcss { .. }
            | ShadowModel::Paraboloids { .. }
            | ShadowModel::Adaptive { .. } => Self::Maps,
            ShadowModel::Cdi { .. } => Self::Rays,
        }
    }

    /// Layout entries of group 2, for the stages that light.
    pub(crate) fn layout(self, stages: wgpu::ShaderStages) -> Vec<wgpu::BindGroupLayoutEntry> {
        match self {
            Self::None => Vec::new(),
            Self::Maps => BoundMaps::layout(stages).into(),
            Self::Rays => {
                let records = [storage_entry(RECORDS_BINDING, stages, true)];
                records.into_iter().chain(RayBuffers::layout(RAYS_BINDING, stages)).collect()
            }
        }
    }
}

/// The points of lights, and what rays to them cross. Clones share the buffers.
#[derive(Clone, Debug)]
pub(crate) struct BoundRays {
    pub(crate) model: ShadowModel,
    /// How far from their lights samples may lie whose rays the loop guard counts, in ranges of the lights.
    pub(crate) ranges: f32,
    pub(crate) records: wgpu::Buffer,
    pub(crate) images: RayBuffers,
}

impl BoundRays {
    /// Whether shaders that bind these read the points and the images of `other`. Each cast makes its own.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        self.model == other.model && self.records == other.records
    }
}

/// Shadows as shaders read them.
#[derive(Clone, Debug)]
pub(crate) enum BoundShadows {
    Maps(BoundMaps),
    Rays(BoundRays),
}

impl BoundShadows {
    /// Their model.
    pub(crate) fn model(&self) -> ShadowModel {
        match self {
            Self::Maps(maps) => maps.model(),
            Self::Rays(rays) => rays.model,
        }
    }

    /// How far from their lights samples may lie that they serve, in ranges of the lights.
    pub(crate) fn ranges(&self) -> f32 {
        match self {
            Self::Maps(maps) => maps.ranges(),
            Self::Rays(rays) => rays.ranges,
        }
    }

    /// The settings of the deep images that rays cross.
    pub(crate) fn images(&self) -> Option<DeepImageSettings> {
        match self {
            Self::Maps(_) => None,
            Self::Rays(rays) => Some(*rays.images.settings()),
        }
    }

    /// The suns that have maps.
    pub(crate) fn suns(&self) -> Suns {
        match self {
            Self::Maps(maps) => maps.suns(),
            Self::Rays(_) => Suns::default(),
        }
    }

    /// Bind group entry of group 2 of the maps of suns; `None` with rays.
    pub(crate) fn sun_entry(&self) -> Option<wgpu::BindGroupEntry<'_>> {
        match self {
            Self::Maps(maps) => Some(maps.sun_entry()),
            Self::Rays(_) => None,
        }
    }

    /// Bind group entries of group 2.
    pub(crate) fn entries(&self) -> Vec<wgpu::BindGroupEntry<'_>> {
        match self {
            Self::Maps(maps) => maps.entries().into(),
            Self::Rays(rays) => {
                let records = [entry(RECORDS_BINDING, &rays.records)];
                records.into_iter().chain(rays.images.entries(RAYS_BINDING)).collect()
            }
        }
    }
}

/// Mounts what shaders with the flag `shadow_rays` import.
pub(crate) fn mount_rays<'a>(shader: Shader<'a>, images: Option<DeepImageSettings>) -> Shader<'a> {
    match images {
        None => shader,
        Some(images) => DeepImages::mount_at(&images, shader, (GROUP, RAYS_BINDING)),
    }
}
