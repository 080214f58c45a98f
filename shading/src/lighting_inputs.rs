//! The inputs of lighting besides surfaces, lights and lists: its numbers, the suns if there are
//! any, the table of linearly transformed cosines if the model of area lights uses it, and shadow
//! maps if lights cast shadows.

use assign::{AssignError, Gpu, MAX_SUNS, Sun, Suns, entry, storage_entry, uniform_entry};
use assign_cdi::DeepImageSettings;
use bytemuck::{Pod, Zeroable};

use crate::{
    LightingOptions, ShadingError,
    bound_maps::BoundMaps,
    bound_shadows::{BoundShadows, ShadowKind},
    ltc,
};

/// Binding of `LightingUniform` in group 2.
pub(crate) const LIGHTING_BINDING: u32 = 6;

/// Binding of the table in group 2.
pub(crate) const LTC_BINDING: u32 = 7;

/// `lighting_uniform.wesl`, `struct LightingUniform`. 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct LightingRecord {
    /// [`LightingOptions::exit_weight`].
    pub exit_weight: f32,
    /// Samples of each term of an area light; 0 if its model draws none.
    pub area_samples: u32,
    /// [`LightingOptions::compensation`]; 0 if it is off.
    pub applicable_lights: f32,
    /// [`LightingOptions::stochastic`]; 0 if it is off.
    pub random_threshold: f32,
    /// [`LightingOptions::specular_reach`]; 1 if it is off.
    pub specular_reach: f32,
    /// [`LightingOptions::area_lod`]; 0 if it is off.
    pub area_lod: f32,
    /// Pads to 32 bytes.
    pub padding: [u32; 2],
}

/// Binding of `Suns` in group 2.
pub(crate) const SUNS_BINDING: u32 = 10;

/// `suns.wesl`, `struct Sun`. 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SunRecord {
    /// Unit vector to the sun, world space, and padding.
    pub to_sun: [f32; 4],
    /// Irradiance of a surface that faces it, linear RGB, and padding.
    pub irradiance: [f32; 4],
}

/// `suns.wesl`, `struct Suns`. 272 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SunsRecord {
    /// The suns. Those beyond the count are unused.
    pub suns: [SunRecord; MAX_SUNS],
    /// The number of suns.
    pub count: u32,
    /// Pads to 16 bytes.
    pub padding: [u32; 3],
}

impl From<&Suns> for SunsRecord {
    fn from(suns: &Suns) -> Self {
        let mut record = Self { count: suns.as_slice().len() as u32, ..Self::default() };
        for (slot, Sun { direction, irradiance }) in record.suns.iter_mut().zip(suns.as_slice()) {
            slot.to_sun = (-direction.normalize()).extend(0.0).to_array();
            slot.irradiance = irradiance.extend(0.0).to_array();
        }
        record
    }
}

/// Which resources a set of options binds besides its numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Bound {
    pub(crate) table: bool,
    pub(crate) suns: bool,
    pub(crate) shadows: ShadowKind,
}

impl Bound {
    /// Every combination, each at its [`index`](Self::index).
    pub(crate) const ALL: [Self; 12] = {
        let mut all = [Self { table: false, suns: false, shadows: ShadowKind::None }; 12];
        let mut ix = 0;
        while ix < all.len() {
            let shadows = ShadowKind::ALL[ix / 4];
            all[ix] = Self { table: ix % 2 == 1, suns: ix % 4 > 1, shadows };
            ix += 1;
        }
        all
    };

    /// Its index in [`ALL`](Self::ALL).
    pub(crate) fn index(self) -> usize {
        usize::from(self.table) + 2 * usize::from(self.suns) + 4 * self.shadows as usize
    }
}

/// The resources of one set of options.
#[derive(Debug)]
pub(crate) struct LightingInputs {
    uniform: wgpu::Buffer,
    table: Option<wgpu::Buffer>,
    suns: Option<wgpu::Buffer>,
    shadows: Option<BoundShadows>,
}

impl LightingInputs {
    /// Uploads the resources that the options need. With shadows, `made` are those of the renderer.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] if the options ask for other shadows than those, or for other suns.
    pub(crate) fn new(
        gpu: &Gpu,
        options: LightingOptions,
        made: Option<BoundShadows>,
    ) -> Result<Self, ShadingError> {
        let shadows = bound_shadows(options, made)?;
        let uniform = gpu.uniform("lighting", size_of::<LightingRecord>() as u64);
        options.area.check()?;
        options.check_area_lod()?;
        let area_samples = options.area.samples();
        let record = LightingRecord {
            exit_weight: options.exit_weight,
            area_samples,
            applicable_lights: options.compensation.unwrap_or(0.0),
            random_threshold: options.stochastic.unwrap_or(0.0),
            specular_reach: options.specular_reach.unwrap_or(1.0),
            area_lod: options.area_lod.unwrap_or(0.0),
            padding: [0; 2],
        };
        gpu.queue.write_buffer(&uniform, 0, bytemuck::bytes_of(&record));
        let table = match options.area.table().filter(|_| options.kinds.areas) {
            None => None,
            Some(masking) => {
                let table = ltc::Table::load(masking)?;
                let bytes = table.as_bytes();
                let buffer = gpu.storage("LTC table", bytes.len() as u64)?;
                gpu.queue.write_buffer(&buffer, 0, bytes);
                Some(buffer)
            }
        };
        let suns = (!options.suns.is_empty()).then(|| {
            let record = SunsRecord::from(&options.suns);
            let buffer = gpu.uniform("suns", size_of::<SunsRecord>() as u64);
            gpu.queue.write_buffer(&buffer, 0, bytemuck::bytes_of(&record));
            buffer
        });
        Ok(Self { uniform, table, suns, shadows })
    }

    /// Layout entries of group 2, for the stages that light.
    pub(crate) fn layout(
        bound: Bound,
        stages: wgpu::ShaderStages,
    ) -> impl Iterator<Item = wgpu::BindGroupLayoutEntry> {
        let table = bound.table.then(|| storage_entry(LTC_BINDING, stages, true));
        let suns = bound.suns.then(|| uniform_entry(SUNS_BINDING, stages));
        let sun_maps = bound.shadows == ShadowKind::Maps && bound.suns;
        let sun_maps = sun_maps.then(|| BoundMaps::sun_layout(stages));
        let shadows = bound.shadows.layout(stages).into_iter().chain(sun_maps);
        [uniform_entry(LIGHTING_BINDING, stages)]
            .into_iter()
            .chain(table)
            .chain(suns)
            .chain(shadows)
    }

    /// Bind group entries of group 2.
    pub(crate) fn entries(&self) -> impl Iterator<Item = wgpu::BindGroupEntry<'_>> {
        let table = self.table.as_ref().map(|table| entry(LTC_BINDING, table));
        let suns = self.suns.as_ref().map(|suns| entry(SUNS_BINDING, suns));
        let sun_maps = self.shadows.as_ref().filter(|_| self.suns.is_some());
        let sun_maps = sun_maps.and_then(BoundShadows::sun_entry);
        let shadows = self.shadows.iter().flat_map(BoundShadows::entries).chain(sun_maps);
        [entry(LIGHTING_BINDING, &self.uniform)].into_iter().chain(table).chain(suns).chain(shadows)
    }

    /// The shadows that it binds.
    pub(crate) fn shadows(&self) -> Option<&BoundShadows> {
        self.shadows.as_ref()
    }

    /// Which resources it holds.
    pub(crate) fn bound(&self) -> Bound {
        Bound {
            table: self.table.is_some(),
            suns: self.suns.is_some(),
            shadows: self
                .shadows
                .as_ref()
                .map_or(ShadowKind::None, |shadows| ShadowKind::of(shadows.model())),
        }
    }

    /// The settings of the deep images that rays of shadows cross, if there are any.
    pub(crate) fn images(&self) -> Option<DeepImageSettings> {
        self.shadows.as_ref()?.images()
    }
}

impl LightingOptions {
    /// Which resources their shader binds.
    pub(crate) fn bound(&self) -> Bound {
        let table = self.kinds.areas && self.area.table().is_some();
        Bound { table, suns: !self.suns.is_empty(), shadows: ShadowKind::of(self.shadows) }
    }
}

/// The shadows that the options ask for.
fn bound_shadows(
    options: LightingOptions,
    made: Option<BoundShadows>,
) -> Result<Option<BoundShadows>, AssignError> {
    if !options.shadows.is_on() {
        return Ok(None);
    }
    options.shadows.check()?;
    let refuse = |accepted: String| {
        let (field, value) = ("shadow model".into(), options.shadows.to_string());
        Err(AssignError::Parameter { field, value, accepted })
    };
    match made {
        None => refuse("none before Renderer::cast_shadows".into()),
        Some(maps) if maps.model() != options.shadows => {
            refuse(format!("{}, the model of the renderer's shadows, or none", maps.model()))
        }
        Some(BoundShadows::Rays(_)) if !options.suns.is_empty() => {
            refuse("none with suns, or one with maps: no rays are cast to suns".into())
        }
        Some(maps) if maps.suns() != options.suns => refuse(
            "none with other suns than those of Renderer::cast_shadows_of_suns before Renderer::cast_shadows".into(),
        ),
        Some(maps) if maps.ranges() < options.ranges_lit() => refuse(format!(
            "none where lights reach {} of their ranges: the maps hold what hides samples within {}. Call \
             Renderer::cast_shadows_within with as many before Renderer::cast_shadows",
            options.ranges_lit(),
            maps.ranges()
        )),
        Some(maps) => Ok(Some(maps)),
    }
}
