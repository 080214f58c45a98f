//! Small tileable textures made from noise.

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use crate::{Encoding, Image};

/// Pixels along each side.
const SIZE: u32 = 256;

/// All images of the scene, in the order of [`Texture`].
pub(super) fn make(seed: u32) -> Vec<Image> {
    use Encoding::{Linear, Srgb};
    let stone = move |uv: Vec2| block_height(uv, seed);
    let jobs: Vec<(&str, Encoding, Paint)> = vec![
        ("marble white", Srgb, Box::new(move |uv| marble(uv, seed, WHITE))),
        ("marble dark", Srgb, Box::new(move |uv| marble(uv, seed + 1, DARK))),
        ("stone colour", Srgb, Box::new(move |uv| stone_color(uv, seed))),
        (
            "stone roughness",
            Linear,
            Box::new(move |uv| Vec3::new(1.0, 0.95 - 0.35 * stone(uv), 0.0)),
        ),
        ("stone normal", Linear, Box::new(move |uv| normal(uv, 0.6, stone))),
        ("cloth normal", Linear, Box::new(move |uv| normal(uv, 0.12, weave))),
    ];
    jobs.into_par_iter().map(|(name, encoding, paint)| render(name, encoding, &paint)).collect()
}

/// Indices into [`make`]'s images.
#[derive(Clone, Copy)]
pub(super) enum Texture {
    MarbleWhite,
    MarbleDark,
    StoneColor,
    StoneRoughness,
    StoneNormal,
    ClothNormal,
}

type Paint = Box<dyn Fn(Vec2) -> Vec3 + Send + Sync>;

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
fn mix(mut h: u32) -> u32 {
    h = (h ^ h >> 16).wrapping_mul(0x85eb_ca6b);
    h = (h ^ h >> 13).wrapping_mul(0xc2b2_ae35);
    h ^ h >> 16
}

fn lattice(x: u32, y: u32, seed: u32) -> f32 {
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
fn fractal(uv: Vec2, period: u32, octaves: u32, seed: u32) -> f32 {
    let (mut sum, mut weight, mut total) = (0.0, 1.0, 0.0);
    for octave in 0..octaves {
        sum += weight * noise(uv, period << octave, seed + octave);
        total += weight;
        weight *= 0.5;
    }
    sum / total
}

/// Ground and vein colours of a marble, sRGB.
type Marble = [Vec3; 2];
const WHITE: Marble = [Vec3::new(0.90, 0.88, 0.84), Vec3::new(0.56, 0.53, 0.52)];
const DARK: Marble = [Vec3::new(0.13, 0.20, 0.18), Vec3::new(0.62, 0.68, 0.60)];

fn marble(uv: Vec2, seed: u32, [ground, vein]: Marble) -> Vec3 {
    let warp = Vec2::new(fractal(uv, 3, 4, seed), fractal(uv, 3, 4, seed + 9)) - 0.5;
    let ridge = |period, offset| {
        let n = fractal(uv + 0.5 * warp, period, 3, seed + offset);
        (1.0 - (2.0 * n - 1.0).abs() * 9.0).max(0.0)
    };
    let cloud = fractal(uv + 0.3 * warp, 4, 4, seed + 30) - 0.5;
    let veins = (0.8 * ridge(2, 20) + 0.4 * ridge(5, 25)).min(1.0);
    ground.lerp(vein, 0.75 * veins) * (1.0 + 0.25 * cloud)
}

/// Courses of two rows of ashlar in a tile: 1 on the blocks, 0 in the joints, with pits.
fn block_height(uv: Vec2, seed: u32) -> f32 {
    let rows = 4.0;
    let row = (uv.y * rows).floor();
    let shift = 0.5 * (row % 2.0);
    let cell = Vec2::new((uv.x * 2.0 + shift).fract(), (uv.y * rows).fract());
    let edge = cell.min(1.0 - cell) * Vec2::new(0.5, 0.25);
    let face = (edge.min_element() / 0.012).clamp(0.0, 1.0);
    let pits = fractal(uv, 24, 3, seed + 40);
    face * (0.75 + 0.25 * pits)
}

fn stone_color(uv: Vec2, seed: u32) -> Vec3 {
    let row = (uv.y * 4.0).floor();
    let column = (uv.x * 2.0 + 0.5 * (row % 2.0)).floor() % 2.0;
    let block = lattice(column as u32, row as u32, seed + 50) - 0.5;
    let grain = fractal(uv, 10, 4, seed + 60) - 0.5;
    let joint = 0.75 + 0.25 * (block_height(uv, seed) * 1.3).min(1.0);
    Vec3::new(0.79, 0.71, 0.59) * (1.0 + 0.12 * block + 0.28 * grain) * joint
}

/// Threads over and under each other.
fn weave(uv: Vec2) -> f32 {
    let (a, b) = ((uv.x * 201.06).sin(), (uv.y * 201.06).sin());
    0.5 + 0.25 * (a * a - b * b)
}

/// The tangent-space normal of a height field whose heights are `scale` hundredths of a tile.
/// The image's v points down, the normal's y up.
fn normal(uv: Vec2, scale: f32, height: impl Fn(Vec2) -> f32) -> Vec3 {
    let h = 1.0 / SIZE as f32;
    let slope = |d: Vec2| (height(uv + d) - height(uv - d)) / (2.0 * h) * scale * 0.01;
    let n = Vec3::new(-slope(Vec2::X * h), slope(Vec2::Y * h), 1.0).normalize();
    0.5 * n + 0.5
}
