//! Keeps an image on the GPU, to tell whether later ones are the same.

use assign::{Gpu, Shader, Viewport, entry, storage_entry, uniform_entry};

use crate::{HdrImage, ShadingError, Targets, image::texels_of};

/// Bytes of a pixel of the radiance image.
const PIXEL_BYTES: u64 = 16;

/// Pixels along each side of a workgroup of `same_image.wesl`.
const SIDE: u32 = 8;

/// A radiance image on the GPU. Only a count crosses to the CPU for each image that is compared with it, until
/// one differs.
#[derive(Debug)]
pub struct KeptImage {
    gpu: Gpu,
    viewport: Viewport,
    row_bytes: u32,
    bands: Vec<Band>,
    /// A band of the image that is compared.
    shown: wgpu::Buffer,
    differing: wgpu::Buffer,
    pipeline: wgpu::ComputePipeline,
}

/// Some rows of the image, in a buffer that a shader can bind.
#[derive(Debug)]
struct Band {
    first_row: u32,
    rows: u32,
    kept: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl KeptImage {
    /// Keeps the radiance that the last frame left in the targets.
    ///
    /// # Errors
    ///
    /// [`ShadingError::Mismatch`] if the viewport is not inside the targets, and [`ShadingError::Assign`] if the device
    /// has no room for a second image.
    pub fn keep(gpu: &Gpu, targets: &Targets, viewport: Viewport) -> Result<Self, ShadingError> {
        let row_bytes = row_bytes(viewport);
        let most = gpu.max_storage_bytes() / u64::from(row_bytes);
        Self::in_bands(gpu, targets, viewport, most.clamp(1, u64::from(u32::MAX)) as u32)
    }

    /// As [`keep`](Self::keep), with at most so many rows in a buffer.
    fn in_bands(
        gpu: &Gpu,
        targets: &Targets,
        viewport: Viewport,
        most_rows: u32,
    ) -> Result<Self, ShadingError> {
        targets.check_holds(viewport)?;
        let row_bytes = row_bytes(viewport);
        let band_rows = most_rows.min(viewport.height);
        let bytes_of = |rows: u32| u64::from(rows) * u64::from(row_bytes);
        let shown = gpu.storage("compared image", bytes_of(band_rows))?;
        let differing = gpu.storage("differing channels", 4)?;
        let row = gpu.uniform("row of an image", 16);
        gpu.queue.write_buffer(&row, 0, bytemuck::bytes_of(&[viewport.width, row_bytes / 4, 0, 0]));
        let stages = wgpu::ShaderStages::COMPUTE;
        let layout = gpu.bind_group_layout(
            "same image",
            &[
                uniform_entry(0, stages),
                storage_entry(1, stages, true),
                storage_entry(2, stages, true),
                storage_entry(3, stages, false),
            ],
        );
        let module = shader().create(gpu, "package::same_image")?;
        let pipeline = gpu.compute_pipeline(&module, "count_differing", &[Some(&layout)], true);
        let mut bands = Vec::new();
        for first_row in (0..viewport.height).step_by(band_rows.max(1) as usize) {
            let rows = band_rows.min(viewport.height - first_row);
            let kept = gpu.storage("kept image", bytes_of(rows))?;
            let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
                label: Some("same image"),
                layout: &layout,
                entries: &[entry(0, &row), entry(1, &kept), entry(2, &shown), entry(3, &differing)],
            });
            bands.push(Band { first_row, rows, kept, group });
        }
        let mut kept =
            Self { gpu: gpu.clone(), viewport, row_bytes, bands, shown, differing, pipeline };
        kept.keep_again(targets)?;
        Ok(kept)
    }

    /// Keeps the radiance of another frame instead, of the same viewport.
    ///
    /// # Errors
    ///
    /// [`ShadingError::Mismatch`] if the viewport is not inside the targets.
    pub fn keep_again(&mut self, targets: &Targets) -> Result<(), ShadingError> {
        targets.check_holds(self.viewport)?;
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        for band in &self.bands {
            self.record_copy(targets, band, &band.kept, &mut encoder);
        }
        self.gpu.queue.submit([encoder.finish()]);
        Ok(())
    }

    /// The viewport whose image is kept.
    pub fn viewport(&self) -> Viewport {
        self.viewport
    }

    /// The number of channels in which the radiance that the last frame left in the targets differs from the kept
    /// image: those with other bits, and those that are no number in either. Blocks.
    ///
    /// # Errors
    ///
    /// [`ShadingError::Mismatch`] if the viewport is not inside the targets, and [`ShadingError::Assign`] if the device
    /// fails.
    pub fn differing_channels(&self, targets: &Targets) -> Result<u32, ShadingError> {
        targets.check_holds(self.viewport)?;
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        encoder.clear_buffer(&self.differing, 0, None);
        for band in &self.bands {
            self.record_copy(targets, band, &self.shown, &mut encoder);
            let mut pass = encoder.begin_compute_pass(&Default::default());
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &band.group, &[]);
            pass.dispatch_workgroups(
                self.viewport.width.div_ceil(SIDE),
                band.rows.div_ceil(SIDE),
                1,
            );
        }
        self.gpu.queue.submit([encoder.finish()]);
        Ok(bytemuck::pod_read_unaligned(&self.gpu.read(&self.differing, 4)?))
    }

    /// The kept image. Blocks.
    ///
    /// # Errors
    ///
    /// [`ShadingError::Assign`] if the device fails.
    pub fn read(&self) -> Result<HdrImage, ShadingError> {
        let Viewport { width, height, .. } = self.viewport;
        let mut pixels = Vec::with_capacity(width as usize * height as usize);
        for band in &self.bands {
            let bytes = self.gpu.read(&band.kept, band.kept.size())?;
            let rows = bytes.chunks(self.row_bytes as usize).take(band.rows as usize);
            rows.for_each(|row| pixels.extend(texels_of(row, width)));
        }
        Ok(HdrImage { width, height, pixels })
    }

    fn record_copy(
        &self,
        targets: &Targets,
        band: &Band,
        to: &wgpu::Buffer,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let Viewport { x, y, width, .. } = self.viewport;
        encoder.copy_texture_to_buffer(
            wgpu::TexelCopyTextureInfo {
                origin: wgpu::Origin3d { x, y: y + band.first_row, z: 0 },
                ..targets.radiance_texture.as_image_copy()
            },
            wgpu::TexelCopyBufferInfo {
                buffer: to,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(self.row_bytes),
                    rows_per_image: None,
                },
            },
            wgpu::Extent3d { width, height: band.rows, depth_or_array_layers: 1 },
        );
    }
}

/// Bytes from one row of a buffer to the next.
fn row_bytes(viewport: Viewport) -> u32 {
    (viewport.width * PIXEL_BYTES as u32).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
}

fn shader() -> Shader<'static> {
    Shader::new(1).module("package::same_image", include_str!("shaders/same_image.wesl"))
}

#[cfg(test)]
mod tests {
    use assign::{View, conformance::LinkedModule};
    use glam::Vec3;
    use scenes::atrium;

    use super::*;
    use crate::{SceneGpu, targets::RADIANCE_FORMAT};

    #[test]
    fn the_shader_links_and_has_its_bindings() {
        let source = shader().link("package::same_image").expect("links");
        let module = LinkedModule::new("same image", &source);
        assert_eq!(module.used_bindings(), (0..4).map(|binding| (0, binding)).collect());
        assert_eq!(module.constant("WORDS_PER_PIXEL") as u64 * 4, PIXEL_BYTES);
    }

    /// Writes texels into the radiance image.
    fn show(gpu: &Gpu, targets: &Targets, texels: &[[f32; 4]]) {
        let [width, height] = targets.size;
        gpu.queue.write_texture(
            targets.radiance_texture.as_image_copy(),
            bytemuck::cast_slice(texels),
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(width * PIXEL_BYTES as u32),
                rows_per_image: None,
            },
            wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
        );
        gpu.queue.submit([]);
    }

    #[test]
    fn one_bit_and_each_channel_that_is_no_number_count() {
        let gpu = Gpu::open(None).expect("an adapter: scripts/test installs the software one");
        let viewport = Viewport { x: 2, y: 1, width: 13, height: 11 };
        let view = View { viewport, ..View::look_at(Vec3::ZERO, Vec3::X, 1.0, 0.1, [1, 1]) };
        let scene = SceneGpu::new(&gpu, &atrium(1)).expect("fits");
        let mut targets = Targets::new(&gpu, &view, &scene, 1).expect("fit");
        let [width, height] = targets.size;
        // One that the CPU can write.
        targets.radiance_texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: RADIANCE_FORMAT,
            usage: wgpu::TextureUsages::COPY_SRC | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let targets = &targets;
        let count = (width * height) as usize;
        let first: Vec<[f32; 4]> = (0..count).map(|ix| [0.1, ix as f32, -0.0, 1.0]).collect();
        let at = |x: u32, y: u32| ((y + 1) * width + x + 2) as usize;
        for rows in [1, 4, 100] {
            show(&gpu, targets, &first);
            let mut kept = KeptImage::in_bands(&gpu, targets, viewport, rows).expect("fits");
            let differing = |kept: &KeptImage, change: &dyn Fn(&mut [[f32; 4]])| {
                let mut texels = first.clone();
                change(&mut texels);
                show(&gpu, targets, &texels);
                kept.differing_channels(targets).expect("readable")
            };
            assert_eq!(differing(&kept, &|_| {}), 0);
            // Outside the viewport, and alpha.
            assert_eq!(differing(&kept, &|texels| texels[0] = [7.0; 4]), 0);
            assert_eq!(differing(&kept, &|texels| texels[at(3, 3)][3] = 0.5), 0);
            let bit = |texels: &mut [[f32; 4]]| {
                texels[at(12, 10)][0] = f32::from_bits(0.1_f32.to_bits() + 1);
            };
            assert_eq!(differing(&kept, &bit), 1);
            assert_eq!(differing(&kept, &|texels| texels[at(0, 0)][2] = 0.0), 1, "+0 is not -0");
            let tiny = |texels: &mut [[f32; 4]]| texels[at(0, 0)][2] = f32::from_bits(0x8000_0001);
            assert_eq!(differing(&kept, &tiny), 1, "the smallest number is not 0");
            let all = |texels: &mut [[f32; 4]]| texels.iter_mut().for_each(|texel| texel[0] = 9.0);
            assert_eq!(differing(&kept, &all), 13 * 11);
            assert_eq!(kept.read().expect("readable").pixels[12 + 13 * 10][1], at(12, 10) as f32);
            let read = HdrImage::read(&gpu, targets, viewport).expect("readable");
            kept.keep_again(targets).expect("fits");
            assert_eq!(kept.read().expect("readable"), read);
            // The same bits that are not finite in both.
            let mut texels = first.clone();
            texels[at(5, 5)][1] = f32::NAN;
            texels[at(6, 5)][2] = f32::INFINITY;
            show(&gpu, targets, &texels);
            kept.keep_again(targets).expect("fits");
            assert_eq!(kept.differing_channels(targets).expect("readable"), 2);
            let both = kept.read().expect("readable");
            assert_eq!(both.difference(&both).expect("as large").differing_channels, 2);
        }
    }
}
