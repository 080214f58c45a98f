//! Truth images: every pixel's radiance and its standard error.

use std::sync::atomic::{AtomicU32, Ordering};

use assign::{Light, Suns};
use glam::DVec3;
use rayon::prelude::*;

use super::{
    AREA_SAMPLES, Estimate, Numbers, Paths, SurfaceSample, TracedScene, bounced_light,
    direct::separated_radiance, direct_radiance,
};
use crate::{HdrImage, LightBvh, ShadingError};

/// The number of rows that one thread renders before it reports progress.
const BLOCK_ROWS: usize = 8;

/// Which light an image shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transport {
    /// Direct light without shadows, and emission: what the shading pipeline shows.
    Unshadowed,
    /// The same with shadows.
    Direct,
    /// The same with separated shadows: each light without shadows times the share of it that the sample sees, as
    /// [`separated_light`](super::separated_light).
    Separated,
    /// Only indirect light with shadows: light of lights by way of at least one other surface, and
    /// light of emitting surfaces on others.
    Bounce,
}

/// How a truth image is sampled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TruthSettings {
    /// Which light it shows.
    pub transport: Transport,
    /// Paths per pixel for indirect light.
    pub paths: Paths,
    /// Pairs of directions to each area light with shadows.
    pub area_samples: u32,
    /// Images of different seeds are independent.
    pub seed: u64,
    /// Suns, in addition to the lights.
    pub suns: Suns,
}

impl TruthSettings {
    /// One bounce, 64 samples of each kind, seed 1.
    pub fn new(transport: Transport) -> Self {
        let paths = Paths { count: 64, bounces: 1, is_matte: false };
        let suns = Suns::default();
        Self { transport, paths, area_samples: AREA_SAMPLES, seed: 1, suns }
    }
}

/// A truth image and its standard error.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TruthImage {
    /// Linear RGB radiance.
    pub radiance: HdrImage,
    /// Standard error of each channel; 0 where the value is exact.
    pub standard_error: HdrImage,
}

impl TruthImage {
    /// The sum with the independent image of another kind of light.
    pub fn plus(&self, other: &Self) -> Result<Self, ShadingError> {
        let sum = |a: f32, b: f32| a + b;
        Ok(Self {
            radiance: combine(&self.radiance, &other.radiance, sum)?,
            standard_error: combine(&self.standard_error, &other.standard_error, f32::hypot)?,
        })
    }
}

fn combine(
    a: &HdrImage,
    b: &HdrImage,
    channel: impl Fn(f32, f32) -> f32,
) -> Result<HdrImage, ShadingError> {
    if (a.width, a.height) != (b.width, b.height) {
        let (left, right) = ([a.width, a.height], [b.width, b.height]);
        return Err(ShadingError::Mismatch { left, right });
    }
    let pixels = a.pixels.iter().zip(&b.pixels);
    let pixels = pixels.map(|(a, b)| std::array::from_fn(|i| channel(a[i], b[i]))).collect();
    Ok(HdrImage { width: a.width, height: a.height, pixels })
}

/// Renders the truth of an image of `size` pixels on all threads.
///
/// `sample_of` returns a pixel's sample; the argument is an index into the image, rows from the
/// top. Use [`TracedScene::primary`], or [`GBufferSamples::sample`](super::GBufferSamples::sample).
/// Pixels without a sample are black. Faulty lights are left out, as when lights are uploaded.
/// `progress` gets the number of finished rows and of all rows, from any thread.
pub fn truth_image(
    scene: &TracedScene<'_>,
    lights: &[Light],
    size: [u32; 2],
    sample_of: impl Fn(usize) -> Option<SurfaceSample> + Sync,
    settings: TruthSettings,
    progress: &(dyn Fn(u32, u32) + Sync),
) -> TruthImage {
    let sound: Vec<Light> = lights.iter().filter(|light| light.check().is_ok()).copied().collect();
    let lights = LightBvh::new(&sound).with_suns(settings.suns);
    let [width, height] = size;
    let mut estimates = vec![Estimate::default(); width as usize * height as usize];
    let rows_done = AtomicU32::new(0);
    let block = BLOCK_ROWS * width.max(1) as usize;
    estimates.par_chunks_mut(block).enumerate().for_each(|(block_ix, block_pixels)| {
        for (ix, estimate) in block_pixels.iter_mut().enumerate() {
            let pixel = block_ix * block + ix;
            if let Some(sample) = sample_of(pixel) {
                *estimate = pixel_of(scene, &lights, &sample, settings, pixel);
            }
        }
        let rows = (block_pixels.len() / width.max(1) as usize) as u32;
        progress(rows_done.fetch_add(rows, Ordering::Relaxed) + rows, height);
    });
    let image = |of: fn(&Estimate) -> DVec3| HdrImage {
        width,
        height,
        pixels: estimates.iter().map(|e| of(e).as_vec3().to_array()).collect(),
    };
    TruthImage { radiance: image(|e| e.mean), standard_error: image(Estimate::standard_error) }
}

fn pixel_of(
    scene: &TracedScene<'_>,
    lights: &LightBvh<'_>,
    sample: &SurfaceSample,
    settings: TruthSettings,
    pixel: usize,
) -> Estimate {
    // Each pixel has its own numbers, so threads may take pixels in any order.
    let numbers = Numbers::new(settings.seed).part(pixel as u64);
    let emitted = Estimate::exact(sample.emission);
    let shadows = match settings.transport {
        Transport::Unshadowed => None,
        Transport::Direct => Some(scene),
        Transport::Separated => {
            let samples = settings.area_samples;
            return emitted + separated_radiance(lights, sample, scene, samples, numbers);
        }
        Transport::Bounce => {
            return bounced_light(lights, sample, scene, settings.paths, numbers);
        }
    };
    emitted + direct_radiance(lights, sample, shadows, settings.area_samples, numbers)
}
