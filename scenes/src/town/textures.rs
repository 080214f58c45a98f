//! The town's textures.

use glam::{Vec2, Vec3};

use crate::{
    Encoding, Image,
    noise::{Paint, fractal, lattice, normal, render_all},
};

/// Indices into [`make`]'s images.
#[derive(Clone, Copy)]
pub(super) enum Texture {
    /// Grey stains and grain, to be tinted.
    Grain,
    BrickColor,
    BrickNormal,
}

/// All images of the scene, in the order of [`Texture`].
pub(super) fn make(seed: u32) -> Vec<Image> {
    let jobs: Vec<(&str, Encoding, Paint)> = vec![
        ("grain", Encoding::Srgb, Box::new(move |uv| grain(uv, seed))),
        ("brick colour", Encoding::Srgb, Box::new(move |uv| brick_color(uv, seed))),
        ("brick normal", Encoding::Linear, Box::new(move |uv| normal(uv, 0.7, brick_height))),
    ];
    render_all(jobs)
}

fn grain(uv: Vec2, seed: u32) -> Vec3 {
    let stain = fractal(uv, 3, 4, seed) - 0.5;
    let grain = fractal(uv, 32, 3, seed + 10) - 0.5;
    Vec3::splat(0.93) * (1.0 + 0.16 * stain + 0.12 * grain).min(1.07)
}

/// Courses in a tile of brick, and bricks in a course.
const COURSES: f32 = 16.0;
const BRICKS: f32 = 5.0;

/// Course and brick of a point, and where it lies in the brick, 0..1.
fn brick(uv: Vec2) -> (u32, u32, Vec2) {
    let row = (uv.y * COURSES).floor();
    let along = uv.x * BRICKS + 0.5 * (row % 2.0);
    let cell = Vec2::new(along.fract(), (uv.y * COURSES).fract());
    (row as u32, (along.floor() % BRICKS) as u32, cell)
}

/// 1 on the bricks, 0 in the joints.
fn brick_height(uv: Vec2) -> f32 {
    let uv = uv - uv.floor();
    let (_, _, cell) = brick(uv);
    let edge = cell.min(1.0 - cell) * Vec2::new(1.0 / BRICKS, 1.0 / COURSES);
    ((edge.min_element() - 0.002) / 0.004).clamp(0.0, 1.0)
}

fn brick_color(uv: Vec2, seed: u32) -> Vec3 {
    let (row, column, _) = brick(uv);
    let tone = lattice(column, row, seed + 50) - 0.5;
    let grain = fractal(uv, 20, 3, seed + 60) - 0.5;
    let clay = Vec3::new(0.66, 0.36, 0.27) * (1.0 + 0.35 * tone + 0.25 * grain);
    Vec3::new(0.72, 0.68, 0.60).lerp(clay, brick_height(uv))
}
