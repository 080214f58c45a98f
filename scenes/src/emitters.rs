//! Draws the emitters of scattered area lights from a seed.

use std::f64::consts::TAU;

use assign::{Emitter, MAX_VERTICES};
use glam::{DQuat, Vec3};
use rand::{Rng, RngExt};

use crate::random::random_direction;

/// Outlines of scattered area lights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Outlines {
    /// Half rectangles, half polygons.
    #[default]
    Both,
    /// Rectangles.
    Rectangles,
    /// Polygons of 3 to 10 vertices.
    Polygons,
    /// Discs.
    Discs,
    /// Spheres.
    Spheres,
    /// Lines: tubes that are 10 to 50 times as long as wide.
    Lines,
    /// A fifth each of rectangles, polygons, discs, spheres and lines.
    All,
}

impl Outlines {
    /// `both`, `rectangles`, `polygons`, `discs`, `spheres`, `lines` or `all`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Both => "both",
            Self::Rectangles => "rectangles",
            Self::Polygons => "polygons",
            Self::Discs => "discs",
            Self::Spheres => "spheres",
            Self::Lines => "lines",
            Self::All => "all",
        }
    }
}

/// Half the longer side of emitters, as a share of their range.
const HALF_SIZE_SHARE: (f64, f64) = (0.03, 0.15);

/// The shorter side of emitters as a share of the longer.
const ASPECT: (f64, f64) = (0.2, 1.0);

/// The radius of a line as a share of half its length, at an aspect of 1.
const LINE_RADIUS: f64 = 0.1;

/// Share of emitters that emit from both sides.
const TWO_SIDED_SHARE: f64 = 0.25;

/// An emitter of random direction whose size is proportional to its range. A polygon has its vertices on an ellipse.
pub(crate) fn random_emitter(rng: &mut impl Rng, outlines: Outlines, range_m: f32) -> Emitter {
    let normal = random_direction(rng);
    let x =
        DQuat::from_axis_angle(normal, TAU * rng.random::<f64>()) * normal.any_orthonormal_vector();
    let half = f64::from(range_m) * rng.random_range(HALF_SIZE_SHARE.0..HALF_SIZE_SHARE.1);
    // With the smallest range, this is just large enough for an emitter.
    let x = x * half.max(2e-4);
    let aspect = rng.random_range(ASPECT.0..ASPECT.1);
    let y = normal.cross(x) * aspect;
    let two_sided = rng.random::<f64>() < TWO_SIDED_SHARE;
    let outlines = match outlines {
        Outlines::All => [
            Outlines::Rectangles,
            Outlines::Polygons,
            Outlines::Discs,
            Outlines::Spheres,
            Outlines::Lines,
        ][rng.random_range(0..5)],
        one => one,
    };
    let radius = x.length() as f32;
    let is_polygon = match outlines {
        Outlines::Discs if two_sided => return Emitter::disc(normal.as_vec3(), radius).two_sided(),
        Outlines::Discs => return Emitter::disc(normal.as_vec3(), radius),
        Outlines::Spheres => return Emitter::sphere(radius),
        Outlines::Lines => {
            return Emitter::line(x.as_vec3(), radius * (aspect * LINE_RADIUS) as f32);
        }
        Outlines::Rectangles => false,
        Outlines::Polygons => true,
        Outlines::Both | Outlines::All => rng.random::<bool>(),
    };
    let count = if is_polygon { rng.random_range(3..=MAX_VERTICES) } else { 0 };
    let vertex = |ix: usize| {
        let (sin, cos) = (TAU * ix as f64 / count as f64).sin_cos();
        (x * cos + y * sin).as_vec3()
    };
    let vertices: Vec<Vec3> = (0..count).map(vertex).collect();
    let emitter = match Emitter::polygon(&vertices) {
        Ok((polygon, _)) => polygon,
        Err(_) => Emitter::rectangle(x.as_vec3(), y.as_vec3()),
    };
    if two_sided { emitter.two_sided() } else { emitter }
}
