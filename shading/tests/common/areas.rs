//! Area lights of all outlines, points around them, and the BRDF's own integral for both.

use assign::{Emitter, Light, LightBuffer};
use glam::{DVec3, Vec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use shading::reference::{Surface, light_contribution};

use super::evaluate::Query;

/// A random unit vector, uniform on the sphere.
pub(crate) fn direction(rng: &mut Pcg64Mcg) -> Vec3 {
    loop {
        let v = Vec3::from_array(rng.random()) * 2.0 - 1.0;
        if (0.01..1.0).contains(&v.length_squared()) {
            return v.normalize();
        }
    }
}

/// Rectangles and polygons of 3 to 10 vertices, one- and two-sided, from 4 cm to 4 m.
pub(crate) fn lights(count: usize) -> Vec<Light> {
    let mut rng = Pcg64Mcg::seed_from_u64(7);
    (0..count)
        .map(|ix| {
            let normal = direction(&mut rng);
            let x = normal.any_orthonormal_vector() * 10_f32.powf(rng.random_range(-1.4..0.3));
            let y = normal.cross(x) * rng.random_range(0.1..1.0);
            let position = 3.0 * direction(&mut rng);
            let (emitter, position) = if ix % 2 == 0 {
                (Emitter::rectangle(x, y), position)
            } else {
                let vertices = rng.random_range(3..=10);
                let corner = |i: usize| {
                    let (sin, cos) = (std::f32::consts::TAU * i as f32 / vertices as f32).sin_cos();
                    position + x * cos + y * sin
                };
                Emitter::polygon(&(0..vertices).map(corner).collect::<Vec<_>>()).unwrap()
            };
            let emitter = if ix % 3 == 0 { emitter.two_sided() } else { emitter };
            let emitter = emitter.with_diffuse_share(if ix % 5 == 0 { 0.7 } else { 1.0 });
            let light = Light::area(emitter, position, 6.0, Vec3::new(4.0, 2.0, 1.0));
            light.check().unwrap();
            light
        })
        .collect()
}

/// Discs, spheres and lines, from 4 cm to 4 m.
pub(crate) fn curved_lights(count: usize) -> Vec<Light> {
    let mut rng = Pcg64Mcg::seed_from_u64(17);
    (0..count)
        .map(|ix| {
            let axis = direction(&mut rng);
            let size = 10_f32.powf(rng.random_range(-1.4..0.3));
            let emitter = match ix % 3 {
                0 if ix % 2 == 0 => Emitter::disc(axis, size).two_sided(),
                0 => Emitter::disc(axis, size),
                1 => Emitter::sphere(size),
                _ => Emitter::line(axis * size, size * rng.random_range(0.02..0.3)),
            };
            let emitter = emitter.with_diffuse_share(if ix % 5 == 0 { 0.7 } else { 1.0 });
            let position = 3.0 * direction(&mut rng);
            let light = Light::area(emitter, position, 6.0, Vec3::new(4.0, 2.0, 1.0));
            light.check().unwrap();
            light
        })
        .collect()
}

/// Points all around each light, seen from their front, of every roughness.
pub(crate) fn queries(lights: &[Light], count: usize) -> Vec<Query> {
    let mut rng = Pcg64Mcg::seed_from_u64(8);
    (0..count)
        .map(|ix| {
            let light = ix % lights.len();
            let position = lights[light].position
                + direction(&mut rng) * 10_f32.powf(rng.random_range(-1.5..0.85));
            let normal = direction(&mut rng);
            let to_eye = direction(&mut rng);
            let to_eye = if to_eye.dot(normal) < 0.0 { -to_eye } else { to_eye };
            [
                position.extend(f32::from_bits(light as u32)).to_array(),
                to_eye.extend(rng.random()).to_array(),
                normal.extend(rng.random()).to_array(),
                [0.9, 0.5, 0.1, 0.0],
            ]
        })
        .collect()
}

pub(crate) fn asked(query: &Query) -> (DVec3, Surface, DVec3) {
    let xyz = |v: [f32; 4]| DVec3::new(f64::from(v[0]), f64::from(v[1]), f64::from(v[2]));
    let surface = Surface {
        base_color: xyz(query[3]),
        metallic: f64::from(query[2][3]),
        normal: xyz(query[2]).normalize(),
        roughness: f64::from(query[1][3]),
        dielectric: Default::default(),
    };
    (xyz(query[0]), surface, xyz(query[1]).normalize())
}

pub(crate) fn light_of(query: &Query) -> usize {
    query[0][3].to_bits() as usize
}

/// The BRDF's own integral for each query.
pub(crate) fn truth_of(buffer: &LightBuffer, queries: &[Query]) -> Vec<DVec3> {
    let one = |query| {
        let (position, surface, to_eye) = asked(query);
        light_contribution(&buffer.lights()[light_of(query)], position, &surface, to_eye)
    };
    queries.iter().map(one).collect()
}

/// The share of the light that a model gets wrong: the sum of differences over the sum of the
/// truth.
pub(crate) fn error_of(answers: &[[f32; 4]], truth: &[DVec3]) -> f64 {
    let off = |(answer, truth): (&[f32; 4], &DVec3)| (f64::from(answer[0]) - truth.x).abs();
    let sum: f64 = truth.iter().map(|truth| truth.x).sum();
    answers.iter().zip(truth).map(off).sum::<f64>() / sum
}
