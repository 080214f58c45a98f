//! The atrium's textures.

use crate::{
    Encoding, Image,
    noise::{Paint, fractal, lattice, normal, render_all},
};
use glam::{Vec2, Vec3};

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
    render_all(jobs)
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
