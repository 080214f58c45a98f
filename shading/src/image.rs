//! Images on the CPU: read back, compared, tone mapped, written.

use std::path::Path;

use assign::Gpu;
use image::{ImageFormat, RgbImage};

use crate::{ShadingError, Targets, mips::linear_to_srgb};

/// A linear HDR image, single precision.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct HdrImage {
    /// Pixels per row.
    pub width: u32,
    /// Number of rows.
    pub height: u32,
    /// Linear RGB, rows from the top.
    pub pixels: Vec<[f32; 3]>,
}

/// The difference between two images, over all channels of all pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ImageDifference {
    /// Greatest `|a - b|`, linear radiance. Infinite if either is NaN.
    pub max_abs: f64,
    /// Greatest `|a - b| / max(|b|, 1e-6)`.
    pub max_rel: f64,
    /// The pixel of a channel with [`max_rel`](Self::max_rel), the first of several: x from the left, y from the
    /// top. `None` if no channel differs.
    pub worst_pixel: Option<[u32; 2]>,
    /// The number of channels whose bits differ, or that are NaN in either image.
    pub differing_channels: u64,
}

impl HdrImage {
    /// Copies the radiance image from the GPU and crops it to the viewport. Blocks.
    pub fn read(
        gpu: &Gpu,
        targets: &Targets,
        viewport: assign::Viewport,
    ) -> Result<Self, ShadingError> {
        targets.check_holds(viewport)?;
        let row_bytes = (targets.size[0] * 16).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let bytes = u64::from(row_bytes) * u64::from(targets.size[1]);
        let staging = gpu.staging("radiance read-back", bytes)?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_texture_to_buffer(
            targets.radiance_texture.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &staging,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(row_bytes),
                    rows_per_image: None,
                },
            },
            targets.radiance_texture.size(),
        );
        gpu.queue.submit([encoder.finish()]);
        let bytes = gpu.map(&staging)?;
        let mut pixels = Vec::with_capacity(viewport.width as usize * viewport.height as usize);
        for y in viewport.y..viewport.y + viewport.height {
            let start = y as usize * row_bytes as usize + viewport.x as usize * 16;
            pixels.extend(texels_of(&bytes[start..], viewport.width));
        }
        Ok(Self { width: viewport.width, height: viewport.height, pixels })
    }

    /// Compares with `reference`, which must have the same size.
    pub fn difference(&self, reference: &Self) -> Result<ImageDifference, ShadingError> {
        if (self.width, self.height) != (reference.width, reference.height) {
            return Err(ShadingError::Mismatch {
                left: [self.width, self.height],
                right: [reference.width, reference.height],
            });
        }
        let mut difference = ImageDifference::default();
        let channels = self.pixels.iter().flatten().zip(reference.pixels.iter().flatten());
        for (ix, (&a, &b)) in channels.enumerate() {
            if a.to_bits() == b.to_bits() && a.is_finite() {
                continue;
            }
            difference.differing_channels += 1;
            let off = (f64::from(a) - f64::from(b)).abs();
            let off = if a.is_finite() && b.is_finite() { off } else { f64::INFINITY };
            difference.max_abs = difference.max_abs.max(off);
            let rel = off / f64::from(b).abs().max(1e-6);
            // What is not finite counts as infinitely far off.
            let rel = if rel.is_finite() { rel } else { f64::INFINITY };
            if difference.worst_pixel.is_none() || rel > difference.max_rel {
                let pixel = (ix / 3) as u32;
                difference.worst_pixel = Some([pixel % self.width, pixel / self.width]);
                difference.max_rel = rel;
            }
        }
        Ok(difference)
    }

    /// The exposure that maps the 90th percentile of luminance, over lit pixels, to 0.6. Most of
    /// the image then lies below 0.6, and a bright surface keeps its colour.
    pub fn auto_exposure(&self) -> f32 {
        let mut lit: Vec<f64> =
            self.pixels.iter().map(luminance).filter(|l| l.is_finite() && *l > 1e-6).collect();
        if lit.is_empty() {
            return 1.0;
        }
        let bright = lit.len() * 9 / 10;
        let (_, bright, _) = lit.select_nth_unstable_by(bright, f64::total_cmp);
        (0.6 / *bright).clamp(1e-6, 1e6) as f32
    }

    /// Exposed, tone mapped and encoded as sRGB: 3 bytes per pixel.
    pub fn tone_mapped(&self, exposure: f32) -> Vec<u8> {
        self.pixels.iter().flat_map(|pixel| tone_map(pixel.map(|v| v * exposure))).collect()
    }

    /// A PNG of the tone-mapped image.
    pub fn to_png(&self, exposure: f32) -> Result<Vec<u8>, ShadingError> {
        encode_png(self.width, self.height, self.tone_mapped(exposure))
    }

    /// A PNG of `|self - reference|` times `gain`, without tone mapping.
    pub fn difference_png(&self, reference: &Self, gain: f32) -> Result<Vec<u8>, ShadingError> {
        let bytes = self
            .pixels
            .iter()
            .flatten()
            .zip(reference.pixels.iter().flatten())
            .map(|(a, b)| encode((a - b).abs() * gain))
            .collect();
        encode_png(self.width, self.height, bytes)
    }

    /// Reads an EXR file that [`write_exr`](Self::write_exr) wrote, or any other with channels R, G
    /// and B.
    pub fn read_exr(path: &Path) -> Result<Self, ShadingError> {
        let read = exr::prelude::read_first_rgba_layer_from_file(
            path,
            |size, _| (size.width(), vec![[0.0_f32; 3]; size.width() * size.height()]),
            |(width, pixels), at, (r, g, b, _): (f32, f32, f32, f32)| {
                if let Some(pixel) = pixels.get_mut(at.y() * *width + at.x()) {
                    *pixel = [r, g, b];
                }
            },
        )
        .map_err(|e| ShadingError::Read { path: path.to_owned(), reason: e.to_string() })?;
        let size = read.layer_data.size;
        let (_, pixels) = read.layer_data.channel_data.pixels;
        Ok(Self { width: size.width() as u32, height: size.height() as u32, pixels })
    }

    /// Linear radiance as an OpenEXR file, single precision.
    pub fn to_exr(&self) -> Result<Vec<u8>, ShadingError> {
        use exr::prelude::{Image, SpecificChannels, Vec2, WritableImage};

        let (width, height) = (self.width as usize, self.height as usize);
        let channels = SpecificChannels::rgb(|Vec2(x, y)| {
            let [r, g, b] = self.pixels[y * width + x];
            (r, g, b)
        });
        let mut file = std::io::Cursor::new(Vec::new());
        Image::from_channels((width, height), channels)
            .write()
            .to_buffered(&mut file)
            .map_err(|e| ShadingError::Write { path: "image.exr".into(), reason: e.to_string() })?;
        Ok(file.into_inner())
    }

    /// Writes linear radiance as OpenEXR, single precision.
    pub fn write_exr(&self, path: &Path) -> Result<(), ShadingError> {
        let width = self.width as usize;
        exr::prelude::write_rgb_file(path, width, self.height as usize, |x, y| {
            let [r, g, b] = self.pixels[y * width + x];
            (r, g, b)
        })
        .map_err(|e| ShadingError::Write { path: path.to_owned(), reason: e.to_string() })
    }
}

/// Red, green and blue of a row's first pixels, from its bytes.
pub(crate) fn texels_of(row: &[u8], width: u32) -> impl Iterator<Item = [f32; 3]> {
    row.chunks_exact(16).take(width as usize).map(|texel| {
        let [red, green, blue, _]: [f32; 4] = bytemuck::pod_read_unaligned(texel);
        [red, green, blue]
    })
}

/// Rec. 709 luminance of linear RGB.
pub fn luminance(pixel: &[f32; 3]) -> f64 {
    let [r, g, b] = pixel.map(f64::from);
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

/// Narkowicz's fit of the ACES curve (2015) for each channel separately, then sRGB.
fn tone_map(pixel: [f32; 3]) -> [u8; 3] {
    pixel.map(|x| {
        let x = if x.is_nan() { 0.0 } else { x.clamp(0.0, 1e4) };
        encode((x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14))
    })
}

fn encode(linear: f32) -> u8 {
    (linear_to_srgb(linear.clamp(0.0, 1.0)) * 255.0 + 0.5) as u8
}

pub(crate) fn encode_png(width: u32, height: u32, bytes: Vec<u8>) -> Result<Vec<u8>, ShadingError> {
    let fail = |reason: String| ShadingError::Write { path: "image.png".into(), reason };
    let image = RgbImage::from_raw(width, height, bytes)
        .ok_or_else(|| fail("the image has the wrong size".into()))?;
    let mut png = std::io::Cursor::new(Vec::new());
    image.write_to(&mut png, ImageFormat::Png).map_err(|e| fail(e.to_string()))?;
    Ok(png.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(value: f32) -> HdrImage {
        HdrImage { width: 2, height: 2, pixels: vec![[value; 3]; 4] }
    }

    #[test]
    fn difference_detects_one_bit() {
        let mut image = grey(0.5);
        assert_eq!(image.difference(&grey(0.5)).unwrap(), ImageDifference::default());
        image.pixels[3][1] = f32::from_bits(0.5_f32.to_bits() + 1);
        let difference = image.difference(&grey(0.5)).unwrap();
        assert_eq!(difference.differing_channels, 1);
        assert!(difference.max_abs > 0.0 && difference.max_abs < 1e-6);
        assert_eq!(difference.worst_pixel, Some([1, 1]));
    }

    #[test]
    fn the_worst_pixel_is_the_first_of_those_that_are_farthest_off() {
        let mut image = grey(0.5);
        image.pixels[0] = [0.4, 0.5, 0.5];
        image.pixels[2] = [0.5, 0.5, f32::NAN];
        image.pixels[3] = [f32::INFINITY; 3];
        let difference = image.difference(&grey(0.5)).unwrap();
        assert_eq!((difference.worst_pixel, difference.max_rel), (Some([0, 1]), f64::INFINITY));
        image.pixels[2] = [0.5; 3];
        image.pixels[3] = [0.5, 0.5, 0.51];
        let difference = image.difference(&grey(0.5)).unwrap();
        assert_eq!(difference.worst_pixel, Some([0, 0]));
    }

    #[test]
    fn nan_counts_as_a_difference() {
        let difference = grey(f32::NAN).difference(&grey(f32::NAN)).unwrap();
        assert_eq!(difference.max_abs, f64::INFINITY);
    }

    #[test]
    fn exposure_brings_bright_surfaces_below_white() {
        let exposure = grey(4.0).auto_exposure();
        assert!((exposure * 4.0 - 0.6).abs() < 1e-4);
        assert_eq!(grey(0.0).auto_exposure(), 1.0);
    }

    #[test]
    fn exr_keeps_every_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.exr");
        grey(0.123_456_79).write_exr(&path).unwrap();
        assert_eq!(HdrImage::read_exr(&path).unwrap(), grey(0.123_456_79));
        let bytes = std::fs::read(&path).unwrap();
        assert_eq!(grey(0.123_456_79).to_exr().unwrap(), bytes);
        assert!(HdrImage::read_exr(Path::new("/nowhere/a.exr")).is_err());
        assert!(grey(1.0).write_exr(Path::new("/nowhere/a.exr")).is_err());
    }
}
