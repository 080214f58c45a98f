//! The layers of a renderer: what they show, in the order of the prepared view.

use assign::{AssignError, Gpu, View};
use bytemuck::{Pod, Zeroable, cast_slice};
use glam::Vec3;
use scenes::Particle;

use crate::{
    ShadingError,
    geometry::SceneGpu,
    layers::{
        fog::FogVolume,
        fog_passes::FogPasses,
        options::{LayerKinds, LayerOptions},
        order::{Item, back_to_front},
    },
};

/// `particles.wesl`, `struct Particle`. 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct ParticleRecord {
    /// World space, metres.
    pub center_world: [f32; 3],
    /// Metres.
    pub radius_m: f32,
    /// The share of light that it scatters, linear RGB.
    pub color: [f32; 3],
    /// Opacity in the middle.
    pub opacity: f32,
}

impl From<&Particle> for ParticleRecord {
    fn from(particle: &Particle) -> Self {
        Self {
            center_world: particle.position.to_array(),
            radius_m: particle.radius_m,
            color: particle.color.to_array(),
            opacity: particle.opacity,
        }
    }
}

/// The layers of a renderer.
#[derive(Debug)]
pub(crate) struct LayerScene {
    kinds: LayerKinds,
    /// Centres of the transparent surfaces.
    sheet_centers: Vec<Vec3>,
    particles: Vec<Particle>,
    /// The records of the particles, in the order of `items`.
    pub(super) particle_buffer: wgpu::Buffer,
    /// What is blended, from back to front.
    pub(super) items: Vec<Item>,
    pub(super) fog: Option<(FogVolume, FogPasses)>,
}

impl LayerScene {
    /// Uploads layers. `None` if there are none.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] for faulty options, for `sheets` without a transparent surface, and if the device
    /// cannot blend into single precision.
    pub(crate) fn new(
        gpu: &Gpu,
        scene: &SceneGpu,
        options: &LayerOptions,
    ) -> Result<Option<Self>, ShadingError> {
        options.check()?;
        let fail = |value: &str, accepted: String| {
            let (field, value) = ("transparent surfaces".into(), value.into());
            Err(AssignError::Parameter { field, value, accepted }.into())
        };
        if options.sheets && scene.sheets.is_empty() {
            let accepted = "off, because no material of the scene is transparent (alphaMode BLEND or \
                            KHR_materials_transmission)";
            return fail("on", accepted.into());
        }
        let kinds = LayerKinds {
            sheets: options.sheets,
            particles: !options.particles.is_empty(),
            fog: options.fog_per_m.is_some(),
        };
        if !kinds.any() {
            return Ok(None);
        }
        if !gpu.device.features().contains(wgpu::Features::FLOAT32_BLENDABLE) {
            let accepted = format!("off: {} does not blend 32-bit floats", gpu.info.name);
            return fail("on, or particles or fog", accepted);
        }
        let bytes = (options.particles.len() * size_of::<ParticleRecord>()) as u64;
        let fog = match options.fog_per_m {
            None => None,
            Some(density) => Some((FogVolume::new(gpu, density)?, FogPasses::new(gpu)?)),
        };
        Ok(Some(Self {
            kinds,
            sheet_centers: match kinds.sheets {
                true => scene.sheets.iter().map(|sheet| sheet.center_world).collect(),
                false => Vec::new(),
            },
            particles: options.particles.clone(),
            particle_buffer: gpu.storage("particles", bytes)?,
            items: Vec::new(),
            fog,
        }))
    }

    /// Sorts the layers for a view, and uploads what it decides.
    pub(crate) fn prepare(
        &mut self,
        gpu: &Gpu,
        view: &View,
        surface_bounds: (Vec3, Vec3),
    ) -> Result<(), ShadingError> {
        let order = back_to_front(view, &self.sheet_centers, &self.particles);
        let records: Vec<ParticleRecord> =
            order.particles.iter().map(|&ix| (&self.particles[ix]).into()).collect();
        gpu.queue.write_buffer(&self.particle_buffer, 0, cast_slice(&records));
        self.items = order.items;
        if let Some((fog, _)) = &mut self.fog {
            fog.prepare(gpu, view, surface_bounds)?;
        }
        Ok(())
    }

    /// The kinds of its layers.
    pub(crate) fn kinds(&self) -> LayerKinds {
        self.kinds
    }

    /// The fog's grid and images.
    pub(super) fn fog_volume(&self) -> Option<&FogVolume> {
        self.fog.as_ref().map(|(volume, _)| volume)
    }
}
