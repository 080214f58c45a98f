//! Primary surfaces from the G-buffer, to measure the error of its formats.
//!
//! Positions are rebuilt from depth by the shader code of deferred lighting; surfaces are those of
//! the G-buffer. Lit in f64, they differ from the truth only by the rounding of depth and G-buffer.

use assign::{Projection, View, entry, storage_entry};
use bytemuck::pod_collect_to_vec;
use glam::{DVec3, Vec4};

use super::{SurfaceSample, TracedScene};
use crate::{
    Renderer, ShadingError,
    gbuffer_inputs::GBufferInputs,
    pixel_pass::PixelPass,
    reference::{Reflectance, Surface},
    shaders::{LISTS_GROUP, lighting_modules},
};

/// The surface of each pixel of a view.
#[derive(Clone, Debug, PartialEq)]
pub struct GBufferSamples {
    /// Pixels per row.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    view: View,
    /// World-space position, metres, and 1; zeros where nothing was drawn.
    positions: Vec<Vec4>,
    /// Base colour, linear, and metallic.
    base_colors: Vec<Vec4>,
    /// World-space shading normal and perceptual roughness.
    normals: Vec<Vec4>,
    /// Emitted radiance; empty where the scene emits none.
    emissions: Vec<Vec4>,
    /// Reflectance of dielectrics at normal and at grazing incidence; empty if all have glTF's
    /// default.
    dielectrics: Vec<Vec4>,
}

impl GBufferSamples {
    /// Reads depth and G-buffer of the last recorded passes `depth` and `gbuffer`. Blocks. `view`
    /// is the one for which the renderer was prepared.
    pub fn read(renderer: &Renderer, view: &View) -> Result<Self, ShadingError> {
        let gpu = &renderer.gpu;
        let images = GBufferInputs::of_scene(&renderer.scene);
        // Names and bindings of `surfaces.wesl`.
        let outputs = [
            ("positions", 12, true),
            ("base colours", 13, true),
            ("normals", 14, true),
            ("emissions", 15, images.emissive),
            ("dielectrics", 16, images.dielectrics),
        ];
        let bytes = u64::from(view.viewport.width) * u64::from(view.viewport.height) * 16;
        let mut layout = Vec::new();
        let mut buffers = Vec::new();
        for (name, binding, _) in outputs.into_iter().filter(|&(.., is_written)| is_written) {
            layout.push(storage_entry(binding, wgpu::ShaderStages::COMPUTE, false));
            buffers.push((binding, gpu.storage(name, bytes)?));
        }
        let pass = PixelPass {
            name: "surfaces",
            entry_point: "surfaces",
            shader: lighting_modules(LISTS_GROUP),
            images,
            layout,
            resources: buffers.iter().map(|(binding, buffer)| entry(*binding, buffer)).collect(),
            strategy: None,
            is_alone: false,
            bounds: None,
        };
        pass.submit(renderer, view.viewport)?;
        let mut texels = Vec::new();
        for (_, buffer) in &buffers {
            texels.push(pod_collect_to_vec::<u8, Vec4>(&gpu.read(buffer, bytes)?));
        }
        let mut texels = texels.into_iter();
        let mut next = || texels.next().unwrap_or_default();
        Ok(Self {
            width: view.viewport.width,
            height: view.viewport.height,
            view: *view,
            positions: next(),
            base_colors: next(),
            normals: next(),
            emissions: if images.emissive { next() } else { Vec::new() },
            dielectrics: next(),
        })
    }

    /// The sample of a pixel, an index into the viewport, rows from the top. `None` if nothing was
    /// drawn or the position is not a number. `scene` gives the geometric normal.
    pub fn sample(&self, pixel: usize, scene: &TracedScene<'_>) -> Option<SurfaceSample> {
        let position = *self.positions.get(pixel)?;
        if position.w == 0.0 || !position.is_finite() {
            return None;
        }
        let position = position.truncate().as_dvec3();
        let (base_color, normal) = (self.base_colors[pixel], self.normals[pixel]);
        let surface = Surface {
            base_color: base_color.truncate().as_dvec3(),
            metallic: f64::from(base_color.w),
            normal: normal.truncate().as_dvec3().normalize(),
            roughness: f64::from(normal.w),
            dielectric: self.dielectrics.get(pixel).map_or_else(Reflectance::default, |d| {
                Reflectance { f0: d.truncate().as_dvec3(), f90: f64::from(d.w) }
            }),
        };
        let emission = self.emissions.get(pixel).map(|e| e.truncate().as_dvec3());
        Some(SurfaceSample {
            emission: emission.unwrap_or(DVec3::ZERO),
            ..scene.seen_sample(
                position,
                surface,
                self.view.eye().as_dvec3(),
                self.to_eye(position),
            )
        })
    }

    /// Unit vector to the eye. In an orthographic view it lies along the viewing axis.
    fn to_eye(&self, position: DVec3) -> DVec3 {
        match self.view.projection {
            Projection::Perspective { .. } => {
                (self.view.eye().as_dvec3() - position).normalize_or(DVec3::Z)
            }
            Projection::Orthographic { .. } => {
                self.view.world_to_view.row(2).truncate().as_dvec3().normalize()
            }
        }
    }
}
