//! What lighting reads of shadow maps: the atlas, and the records of lights and maps.

use std::sync::Arc;

use assign::{Suns, entry, storage_entry, texture, texture_entry, uniform_entry};

use crate::ShadowModel;

/// Bindings of `shadow.wesl` in group 2.
const ATLAS_BINDING: u32 = 26;
pub(crate) const RECORDS_BINDING: u32 = 27;

/// Binding of `sun_shadow.wesl` in group 2.
const SUN_MAPS_BINDING: u32 = 30;

/// Shadow maps as shaders read them. Clones share them.
#[derive(Clone, Debug)]
pub(crate) struct BoundMaps {
    model: ShadowModel,
    ranges: f32,
    atlas: wgpu::TextureView,
    records: wgpu::Buffer,
    /// The suns that have maps, and these.
    suns: Arc<(Suns, wgpu::Buffer)>,
}

impl BoundMaps {
    pub(crate) fn new(
        model: ShadowModel,
        ranges: f32,
        atlas: wgpu::TextureView,
        records: wgpu::Buffer,
        suns: (Suns, wgpu::Buffer),
    ) -> Self {
        Self { model, ranges, atlas, records, suns: Arc::new(suns) }
    }

    /// The suns that have maps.
    pub(crate) fn suns(&self) -> Suns {
        self.suns.0
    }

    /// How far from their lights samples may lie that the maps serve, in ranges of the lights.
    pub(crate) fn ranges(&self) -> f32 {
        self.ranges
    }

    /// The model of the maps.
    pub(crate) fn model(&self) -> ShadowModel {
        self.model
    }

    /// The depths of all maps.
    pub(crate) fn atlas(&self) -> &wgpu::TextureView {
        &self.atlas
    }

    /// The records of lights and maps.
    pub(crate) fn records(&self) -> &wgpu::Buffer {
        &self.records
    }

    /// Whether shaders that bind these read the present depths of `other`.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        self.model == other.model && self.atlas == other.atlas && self.records == other.records
    }

    /// Layout entry of group 2 of the maps of suns, for the stages that light.
    pub(crate) fn sun_layout(stages: wgpu::ShaderStages) -> wgpu::BindGroupLayoutEntry {
        uniform_entry(SUN_MAPS_BINDING, stages)
    }

    /// Bind group entry of group 2 of the maps of suns.
    pub(crate) fn sun_entry(&self) -> wgpu::BindGroupEntry<'_> {
        entry(SUN_MAPS_BINDING, &self.suns.1)
    }

    /// Layout entries of group 2, for the stages that light.
    pub(crate) fn layout(stages: wgpu::ShaderStages) -> [wgpu::BindGroupLayoutEntry; 2] {
        [
            texture_entry(ATLAS_BINDING, stages, wgpu::TextureSampleType::Depth),
            storage_entry(RECORDS_BINDING, stages, true),
        ]
    }

    /// Bind group entries of group 2.
    pub(crate) fn entries(&self) -> [wgpu::BindGroupEntry<'_>; 2] {
        [texture(ATLAS_BINDING, &self.atlas), entry(RECORDS_BINDING, &self.records)]
    }
}
