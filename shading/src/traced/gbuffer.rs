//! Primary surfaces as deferred lighting reads them: what the G-buffer's formats cost.
//!
//! Positions are rebuilt from depth by the shader code that deferred lighting runs, surfaces are the
//! G-buffer's. Lit in f64, they differ from the truth by the rounding of depth and G-buffer alone.

use assign::{EncoderPasses, Passes, Projection, View, entry, storage_entry};
use bytemuck::pod_collect_to_vec;
use glam::{DVec3, Vec4};

use super::{SurfaceSample, TracedScene};
use crate::{
    Renderer, ShadingError,
    lighting::{TEXELS, compute_pipeline, texture, texture_entry},
    raster::LISTS_GROUP,
    reference::{Reflectance, Surface},
    shaders,
};

/// What each pixel of a view shows.
#[derive(Clone, Debug, PartialEq)]
pub struct GBufferSamples {
    /// Pixels a row.
    pub width: u32,
    /// Rows.
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
    /// What dielectrics reflect at normal and at grazing incidence; empty where all are plain.
    dielectrics: Vec<Vec4>,
}

impl GBufferSamples {
    /// Reads depth and G-buffer of the last recorded passes `depth` and `gbuffer`, blocking. `view`
    /// is the one that the renderer was prepared for.
    pub fn read(renderer: &Renderer, view: &View) -> Result<Self, ShadingError> {
        let gpu = &renderer.gpu;
        let targets = &renderer.targets;
        let stages = wgpu::ShaderStages::COMPUTE;
        let mut entries = vec![
            texture_entry(0, wgpu::TextureSampleType::Depth),
            texture_entry(1, TEXELS),
            texture_entry(2, TEXELS),
        ];
        let mut resources = vec![
            texture(0, &targets.depth),
            texture(1, &targets.base_color),
            texture(2, &targets.normal),
        ];
        if let Some(emissive) = &targets.emissive {
            entries.push(texture_entry(3, TEXELS));
            resources.push(texture(3, emissive));
        }
        if let Some(dielectric) = &targets.dielectric {
            entries.push(texture_entry(8, TEXELS));
            resources.push(texture(8, dielectric));
        }
        let bytes = u64::from(view.viewport.width) * u64::from(view.viewport.height) * 16;
        let mut names = vec!["positions", "base colours", "normals"];
        names.extend(targets.emissive.as_ref().map(|_| "emissions"));
        names.extend(targets.dielectric.as_ref().map(|_| "dielectrics"));
        let buffers = names.into_iter().map(|name| gpu.storage(name, bytes));
        let buffers = buffers.collect::<Result<Vec<_>, _>>()?;
        let mut bindings = vec![4, 5, 6];
        bindings.extend(targets.emissive.as_ref().map(|_| 7));
        bindings.extend(targets.dielectric.as_ref().map(|_| 9));
        for (binding, buffer) in bindings.into_iter().zip(&buffers) {
            entries.push(storage_entry(binding, stages, false));
            resources.push(entry(binding, buffer));
        }
        let layout = gpu.bind_group_layout("surfaces", &entries);
        let images = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("surfaces"),
            layout: &layout,
            entries: &resources,
        });
        let module = shaders::lighting(LISTS_GROUP)
            .flag("emissive", targets.emissive.is_some())
            .flag("dielectrics", targets.dielectric.is_some())
            .create(gpu, "package::surfaces")?;
        let groups = [renderer.frame.layout(), &layout];
        let pipeline = compute_pipeline(gpu, &groups, &module, "surfaces");
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        EncoderPasses { encoder: &mut encoder }.compute("surfaces", &mut |pass| {
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, renderer.frame.bind_group(), &[]);
            pass.set_bind_group(1, &images, &[]);
            let viewport = view.viewport;
            pass.dispatch_workgroups(viewport.width.div_ceil(8), viewport.height.div_ceil(8), 1);
        });
        gpu.queue.submit([encoder.finish()]);
        let mut texels = Vec::new();
        for buffer in &buffers {
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
            emissions: if targets.emissive.is_some() { next() } else { Vec::new() },
            dielectrics: next(),
        })
    }

    /// The sample of a pixel, index into the viewport, rows from the top; `None` where nothing was
    /// drawn or the position is no number. `scene` tells its geometric normal.
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

    /// Unit vector to the eye: along the viewing axis in an orthographic view.
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
