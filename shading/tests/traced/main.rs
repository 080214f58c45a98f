//! Tests the traced truth against geometry, quadrature, other samplers and the rasteriser.

#![allow(dead_code, reason = "the common module serves several tests")]
#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod bounces;
#[path = "../common/mod.rs"]
mod common;
mod emitters;
mod exact;
mod images;
mod noise;
mod raster;
mod shadows;

use assign::Emitter;
use glam::{DVec3, Vec3};
use shading::{
    reference::Surface,
    traced::{Numbers, Paths, SurfaceSample},
};

fn surface(normal: DVec3, albedo: f64, roughness: f64) -> Surface {
    let dielectric = Default::default();
    Surface { base_color: DVec3::splat(albedo), metallic: 0.0, normal, roughness, dielectric }
}

fn sample(position: DVec3, normal: DVec3, roughness: f64) -> SurfaceSample {
    SurfaceSample {
        position,
        surface: surface(normal, 0.5, roughness),
        emission: DVec3::ZERO,
        to_eye: (normal + 0.6 * normal.any_orthonormal_vector()).normalize(),
        geometric_normal: normal,
        offset_m: 1e-5,
    }
}

fn paths(bounces: u32, count: u32) -> Paths {
    Paths { count, bounces, is_matte: false }
}

fn numbers() -> Numbers {
    Numbers::new(7)
}

/// The walls of a cube of 2 m, facing its middle.
fn cube() -> Vec<[Vec3; 3]> {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z];
    let wall = |axis: usize, sign: f32| {
        let (normal, x) = (axes[axis] * -sign, axes[(axis + 1) % 3]);
        [-normal, x, normal.cross(x)]
    };
    (0..3).flat_map(|axis| [wall(axis, 1.0), wall(axis, -1.0)]).collect()
}

fn rectangle(half_width: f32, two_sided: bool) -> Emitter {
    let emitter = Emitter::rectangle(Vec3::X * half_width, Vec3::Z * 0.7).with_diffuse_share(0.6);
    if two_sided { emitter.two_sided() } else { emitter }
}
