//! Views of a scene's path with the least and the most depth discontinuity.

use assign::{Assignment, EncoderPasses, Everything};
use shading::{Samples, probe, record_for_probe};

use crate::{error::HarnessError, stage::Stage};

/// Poses along the path that are looked at.
const POSES: u32 = 60;

/// Neighbouring pixels are apart where one is this many times as deep as the other.
const APART: f32 = 1.1;

/// Frames of the path, of [`count`](Self::count), with their discontinuity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Views {
    /// The frame with the least.
    pub(crate) low: u32,
    /// The frame with the most.
    pub(crate) high: u32,
    /// Frames of the path.
    pub(crate) count: u32,
}

impl Views {
    /// Looks along the path of a stage, whose view should be small.
    pub(crate) fn find(gpu: &assign::Gpu, stage: &mut Stage) -> Result<Self, HarnessError> {
        let mut strategy = Everything::new(gpu)?;
        let mut views = Self { low: 0, high: 0, count: POSES };
        let mut bounds = (f64::INFINITY, 0.0);
        for pose in 0..POSES {
            stage.go_to(pose, POSES)?;
            let share = discontinuity(gpu, stage, &mut strategy)?;
            if share < bounds.0 {
                (views.low, bounds.0) = (pose, share);
            }
            if share > bounds.1 {
                (views.high, bounds.1) = (pose, share);
            }
        }
        Ok(views)
    }
}

/// Share of neighbouring pixels that are apart in depth.
fn discontinuity(
    gpu: &assign::Gpu,
    stage: &Stage,
    strategy: &mut Everything,
) -> Result<f64, HarnessError> {
    let Stage { renderer, view, lights, .. } = stage;
    let frame = renderer.frame(view, lights);
    strategy.prepare(gpu, &frame)?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    renderer.record_depth(view, &mut passes);
    record_for_probe(renderer, view, strategy, &mut passes);
    gpu.queue.submit([encoder.finish()]);
    let samples = probe(renderer, strategy, &frame)?;
    let depth =
        |position: &[f32; 3]| -view.world_to_view.transform_point3(glam::Vec3::from(*position)).z;
    let width = view.viewport.width as usize;
    Ok(share_apart(&depths(&samples, width * view.viewport.height as usize, depth), width))
}

/// The depth of each pixel; 0 without a surface.
fn depths(samples: &Samples, pixels: usize, depth: impl Fn(&[f32; 3]) -> f32) -> Vec<f32> {
    let mut depths = vec![0.0; pixels];
    for (&pixel, position) in samples.pixels.iter().zip(&samples.positions) {
        if let Some(place) = depths.get_mut(pixel as usize) {
            *place = depth(position);
        }
    }
    depths
}

/// Share of horizontal and vertical neighbours, both with a surface, that are apart.
fn share_apart(depths: &[f32], width: usize) -> f64 {
    let (mut pairs, mut apart) = (0_u64, 0_u64);
    let mut look = |a: f32, b: f32| {
        if a > 0.0 && b > 0.0 {
            pairs += 1;
            apart += u64::from(a.max(b) > APART * a.min(b));
        }
    };
    for (ix, &depth) in depths.iter().enumerate() {
        if (ix + 1) % width.max(1) != 0 {
            depths.get(ix + 1).into_iter().for_each(|&next| look(depth, next));
        }
        depths.get(ix + width).into_iter().for_each(|&below| look(depth, below));
    }
    if pairs == 0 { 0.0 } else { apart as f64 / pairs as f64 }
}

#[cfg(test)]
mod tests {
    use super::share_apart;

    #[test]
    fn edges_in_depth_are_counted_and_slopes_are_not() {
        assert_eq!(share_apart(&[1.0, 1.05, 1.1, 1.15], 4), 0.0);
        // Two rows: one step in each, none between the rows.
        assert_eq!(share_apart(&[1.0, 2.0, 1.0, 2.0], 2), 0.5);
        // Background is no neighbour.
        assert_eq!(share_apart(&[1.0, 0.0, 0.0, 2.0], 2), 0.0);
        assert_eq!(share_apart(&[], 0), 0.0);
    }
}
