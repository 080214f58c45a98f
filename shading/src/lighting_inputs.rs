//! What lighting reads beside surfaces, lights and lists: its numbers, and the table of linearly
//! transformed cosines where a model of area lights looks it up.

use assign::{Gpu, entry, storage_entry, uniform_entry};
use bytemuck::{Pod, Zeroable};

use crate::{LightingOptions, ShadingError, ltc};

/// Where `LightingUniform` is bound in group 2.
pub(crate) const LIGHTING_BINDING: u32 = 6;

/// Where the table is bound in group 2.
pub(crate) const LTC_BINDING: u32 = 7;

/// `lighting_uniform.wesl`, `struct LightingUniform`. 12 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct LightingRecord {
    /// [`LightingOptions::exit_weight`].
    pub exit_weight: f32,
    /// Samples of each term of an area light; 0 where its model draws none.
    pub area_samples: u32,
    /// [`LightingOptions::compensation`]; 0 where it is off.
    pub applicable_lights: f32,
}

/// The resources of one set of options.
#[derive(Debug)]
pub(crate) struct LightingInputs {
    uniform: wgpu::Buffer,
    table: Option<wgpu::Buffer>,
}

impl LightingInputs {
    /// Uploads what the options ask for.
    pub(crate) fn new(gpu: &Gpu, options: LightingOptions) -> Result<Self, ShadingError> {
        let uniform = gpu.uniform("lighting", 16);
        options.area.check()?;
        let area_samples = options.area.samples();
        let record = LightingRecord {
            exit_weight: options.exit_weight,
            area_samples,
            applicable_lights: options.compensation.unwrap_or(0.0),
        };
        gpu.queue.write_buffer(&uniform, 0, bytemuck::bytes_of(&record));
        let table = match options.area.table().filter(|_| options.kinds.areas) {
            None => None,
            Some(masking) => {
                let table = ltc::Table::of(masking)?;
                let bytes = table.as_bytes();
                let buffer = gpu.storage("LTC table", bytes.len() as u64)?;
                gpu.queue.write_buffer(&buffer, 0, bytes);
                Some(buffer)
            }
        };
        Ok(Self { uniform, table })
    }

    /// Layout entries of group 2, for the stages that light.
    pub(crate) fn layout(
        reads_table: bool,
        stages: wgpu::ShaderStages,
    ) -> impl Iterator<Item = wgpu::BindGroupLayoutEntry> {
        let table = reads_table.then(|| storage_entry(LTC_BINDING, stages, true));
        [uniform_entry(LIGHTING_BINDING, stages)].into_iter().chain(table)
    }

    /// Bind group entries of group 2.
    pub(crate) fn entries(&self) -> impl Iterator<Item = wgpu::BindGroupEntry<'_>> {
        let table = self.table.as_ref().map(|table| entry(LTC_BINDING, table));
        [entry(LIGHTING_BINDING, &self.uniform)].into_iter().chain(table)
    }

    /// Whether the table is among them.
    pub(crate) fn has_table(&self) -> bool {
        self.table.is_some()
    }
}

impl LightingOptions {
    /// Whether shading looks the table up.
    pub(crate) fn reads_table(&self) -> bool {
        self.kinds.areas && self.area.table().is_some()
    }
}
