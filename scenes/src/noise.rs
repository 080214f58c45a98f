//! Makes small tileable textures from noise.

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use crate::{Encoding, Image};

/// Pixels along each side.
const SIZE: u32 = 256;

/// A colour for each uv of a tile, 0..1.
pub(crate) type Paint = Box<dyn Fn(Vec2) -> Vec3 + Send + Sync>;

/// Renders tiles, each given by its name, encoding, and picture.
pub(crate) fn render_all(jobs: Vec<(&str, Encoding, Paint)>) -> Vec<Image> {
    jobs.into_par_iter().map(|(name, encoding, paint)| render(name, encoding, &paint)).collect()
}

fn render(name: &str, encoding: Encoding, paint: &Paint) -> Image {
    let mut rgba = vec![255; (SIZE * SIZE * 4) as usize];
    let row_bytes = (SIZE * 4) as usize;
    rgba.par_chunks_mut(row_bytes).enumerate().for_each(|(y, row)| {
        for (x, pixel) in row.chunks_exact_mut(4).enumerate() {
            let uv = (Vec2::new(x as f32, y as f32) + 0.5) / SIZE as f32;
            let color = paint(uv).clamp(Vec3::ZERO, Vec3::ONE) * 255.0;
            for (channel, value) in pixel.iter_mut().zip(color.to_array()) {
                *channel = value.round() as u8;
            }
        }
    });
    Image { name: name.into(), width: SIZE, height: SIZE, rgba, encoding }
}

/// A well-mixed 32-bit value (the finaliser of MurmurHash3).
pub(crate) fn mix(mut h: u32) -> u32 {
    h = (h ^ h >> 16).wrapping_mul(0x85eb_ca6b);
    h = (h ^ h >> 13).wrapping_mul(0xc2b2_ae35);
    h ^ h >> 16
}

/// A random number in 0..1 for each cell of a lattice.
pub(crate) fn lattice(x: u32, y: u32, seed: u32) -> f32 {
    mix(x.wrapping_mul(0x9e37_79b9) ^ mix(y ^ mix(seed))) as f32 / u32::MAX as f32
}

/// Value noise in 0..1 that repeats after `period` cells; `uv` repeats after 1.
fn noise(uv: Vec2, period: u32, seed: u32) -> f32 {
    let p = (uv - uv.floor()) * period as f32;
    let (cell, f) = (p.floor(), p - p.floor());
    let s = f * f * (3.0 - 2.0 * f);
    let (x, y) = (cell.x as u32 % period, cell.y as u32 % period);
    let (x1, y1) = ((x + 1) % period, (y + 1) % period);
    let row = |y| {
        let (a, b) = (lattice(x, y, seed), lattice(x1, y, seed));
        a + (b - a) * s.x
    };
    row(y) + (row(y1) - row(y)) * s.y
}

/// Octaves of noise, in 0..1.
pub(crate) fn fractal(uv: Vec2, period: u32, octaves: u32, seed: u32) -> f32 {
    let (mut sum, mut weight, mut total) = (0.0, 1.0, 0.0);
    for octave in 0..octaves {
        sum += weight * noise(uv, period << octave, seed + octave);
        total += weight;
        weight *= 0.5;
    }
    sum / total
}

/// The tangent-space normal of a height field whose heights are `scale` hundredths of a tile. The
/// image's v axis points down; the normal's y axis points up.
pub(crate) fn normal(uv: Vec2, scale: f32, height: impl Fn(Vec2) -> f32) -> Vec3 {
    let h = 1.0 / SIZE as f32;
    let slope = |d: Vec2| (height(uv + d) - height(uv - d)) / (2.0 * h) * scale * 0.01;
    let n = Vec3::new(-slope(Vec2::X * h), slope(Vec2::Y * h), 1.0).normalize();
    0.5 * n + 0.5
}
