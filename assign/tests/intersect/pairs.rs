//! Seeded pairs of a small group in view and a light, and the BRDF's integral for them in f64.

use assign::intersect::{Aabb, Gloss, NormalCone};
use assign::{Emitter, Light, LightShape, Outline, View};
use glam::{DVec3, Vec3};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

/// A small group in view, and a light.
pub(crate) struct Pair {
    pub(crate) view: View,
    pub(crate) bounds: Aabb,
    pub(crate) cone: NormalCone,
    pub(crate) gloss: Gloss,
    pub(crate) light: Light,
}

/// A sample of a group, and a point of its light's emitter.
pub(crate) struct Sample {
    pub(crate) position: DVec3,
    pub(crate) normal: DVec3,
    pub(crate) point: DVec3,
}

pub(crate) fn between(rng: &mut Pcg64Mcg, low: f32, high: f32) -> f32 {
    low + (high - low) * rng.random::<f32>()
}

pub(crate) fn direction(rng: &mut Pcg64Mcg) -> Vec3 {
    loop {
        let v = Vec3::from_array(rng.random::<[f32; 3]>()) * 2.0 - 1.0;
        if (0.01..1.0).contains(&v.length_squared()) {
            return v.normalize();
        }
    }
}

/// A view from 1 to 8 m away.
pub(crate) fn view(rng: &mut Pcg64Mcg) -> View {
    let eye = direction(rng) * between(rng, 1.0, 8.0);
    View::look_at(eye, Vec3::ZERO, 1.0, 0.1, [640, 480])
}

/// A box of up to half a metre, and a two-sided rectangle 0.5 to 8 m from its centre.
pub(crate) fn pair(rng: &mut Pcg64Mcg, view: View, half_angle: f32) -> Pair {
    let half = Vec3::from_array(rng.random::<[f32; 3]>()) * 0.5;
    let roughness = between(rng, 0.0, 1.0);
    let position = direction(rng) * between(rng, 0.5, 8.0);
    let half_x = direction(rng) * between(rng, 0.05, 1.0);
    let half_y = half_x.cross(direction(rng)).normalize() * between(rng, 0.05, 1.0);
    let emitter = Emitter::rectangle(half_x, half_y).two_sided();
    Pair {
        view,
        bounds: Aabb::new(&view, -half, half),
        cone: NormalCone {
            axis: direction(rng),
            cos_half: half_angle.cos(),
            sin_half: half_angle.sin(),
        },
        gloss: Gloss {
            roughness: [roughness, (roughness + between(rng, 0.0, 0.2)).min(1.0)],
            f0: between(rng, 0.02, 1.0),
        },
        light: Light::area(emitter, position, 10.0, Vec3::ONE),
    }
}

/// As [`pair`], with an emitter that is 2 to 20 m long and a hundred times as long as wide.
pub(crate) fn long_pair(rng: &mut Pcg64Mcg, view: View, half_angle: f32) -> Pair {
    let mut pair = pair(rng, view, half_angle);
    let half_x = direction(rng) * between(rng, 1.0, 10.0);
    let half_y = half_x.cross(direction(rng)).normalize() * (0.01 * half_x.length());
    let emitter = Emitter::rectangle(half_x, half_y).two_sided();
    pair.light = Light::area(emitter, pair.light.position, 10.0, Vec3::ONE);
    pair
}

/// As [`pair`], with a two-sided disc, a sphere or a line.
pub(crate) fn curved_pair(rng: &mut Pcg64Mcg, view: View, half_angle: f32) -> Pair {
    let mut pair = pair(rng, view, half_angle);
    let size = between(rng, 0.05, 1.0);
    let emitter = match rng.random_range(0..3) {
        0 => Emitter::disc(direction(rng), size).two_sided(),
        1 => Emitter::sphere(size),
        _ => Emitter::line(direction(rng) * size, size * between(rng, 0.02, 0.5)),
    };
    pair.light = Light::area(emitter, pair.light.position, 10.0, Vec3::ONE);
    pair
}

/// The patches of a curved emitter: their places, outward normals (zero for a disc), and areas.
fn patches(emitter: &Emitter) -> Vec<(DVec3, DVec3, f64)> {
    const COUNT: u32 = 600;
    let radius = f64::from(emitter.radius_m());
    let axis = match emitter.outline() {
        Outline::Line => emitter.half_axes()[0].as_dvec3(),
        _ => DVec3::ZERO,
    };
    // A spiral of equal areas: over the disc, or over the sphere pulled apart to a line.
    let z = if axis == DVec3::ZERO { emitter.normal().as_dvec3() } else { axis.normalize() };
    let z = if z == DVec3::ZERO { DVec3::Z } else { z };
    let x = z.any_orthonormal_vector();
    let y = z.cross(x);
    let length = 2.0 * (axis.length() + radius);
    (0..COUNT)
        .map(|ix| {
            let share = (f64::from(ix) + 0.5) / f64::from(COUNT);
            let (sin, cos) = (f64::from(ix) * 2.399_963_229_728_653).sin_cos();
            let around = x * cos + y * sin;
            if emitter.outline() == Outline::Disc {
                let area = f64::from(emitter.area()) / f64::from(COUNT);
                return (around * (radius * share.sqrt()), DVec3::ZERO, area);
            }
            // Archimedes: equal heights of a sphere have equal areas, those of its cylinder.
            let height = (share - 0.5) * length;
            let on_core = height.clamp(-axis.length(), axis.length());
            let up = (height - on_core) / radius;
            let normal = around * (1.0 - up * up).max(0.0).sqrt() + z * up;
            let area = std::f64::consts::TAU * radius * length / f64::from(COUNT);
            (z * on_core + normal * radius, normal, area)
        })
        .collect()
}

impl Pair {
    fn emitter(&self) -> Emitter {
        match self.light.shape {
            LightShape::Area(emitter) => emitter,
            _ => panic!("pairs have area lights"),
        }
    }

    pub(crate) fn sample(&self, rng: &mut Pcg64Mcg) -> Sample {
        let share = Vec3::from_array(rng.random::<[f32; 3]>()).as_dvec3();
        // Bounds are tightest at corners and rims.
        let share = if rng.random::<bool>() { share.round() } else { share };
        let (low, high) = (self.bounds.min_world.as_dvec3(), self.bounds.max_world.as_dvec3());
        let axis = self.cone.axis.as_dvec3();
        let half_angle = f64::from(self.cone.sin_half).atan2(f64::from(self.cone.cos_half));
        let turn = half_angle * if rng.random::<bool>() { 1.0 } else { rng.random::<f64>() };
        let across = axis.cross(direction(rng).as_dvec3()).normalize();
        let normal = axis * turn.cos() + across * turn.sin();
        let [half_x, half_y] = self.emitter().half_axes().map(Vec3::as_dvec3);
        let along = Vec3::from_array(rng.random::<[f32; 3]>()).as_dvec3() * 2.0 - 1.0;
        let along = if rng.random::<bool>() { along.signum() } else { along };
        let mut point = self.light.position.as_dvec3() + half_x * along.x + half_y * along.y;
        if self.emitter().outline().is_curved() {
            // The highest point over the sample's surface, or any.
            let patches = patches(&self.emitter());
            let highest = patches.iter().max_by(|a, b| a.0.dot(normal).total_cmp(&b.0.dot(normal)));
            let any = patches.get(rng.random_range(0..patches.len()));
            let offset = if rng.random::<bool>() { highest } else { any };
            point = self.light.position.as_dvec3() + offset.map_or(DVec3::ZERO, |patch| patch.0);
        }
        Sample { position: low + (high - low) * share, normal, point }
    }

    /// Specular radiance of a sample: the integral over the emitter by the midpoint rule, with
    /// `cells` (a power of two) along the longer side and 2 along the shorter. Each cell lies in
    /// one of the pieces into which a bound may cut the emitter, so the sum cannot exceed the bound
    /// by its own error.
    pub(crate) fn specular(&self, sample: &Sample, roughness: f64, cells: u32) -> f64 {
        let emitter = self.emitter();
        if emitter.outline().is_curved() {
            return self.specular_of_patches(sample, roughness);
        }
        let [x, y] = emitter.half_axes().map(Vec3::as_dvec3);
        let [long, short] = if x.length() >= y.length() { [x, y] } else { [y, x] };
        let area = f64::from(emitter.area());
        let (mut sum, mut solid_angle) = (0.0, 0.0);
        for cell in 0..2 * cells {
            let middle = |ix: u32, of: u32| f64::from(2 * ix + 1) / f64::from(of) - 1.0;
            let along = long * middle(cell / 2, cells) + short * middle(cell % 2, 2);
            let across = self.light.position.as_dvec3() + along - sample.position;
            let to_light = across.normalize();
            let facing = emitter.normal().as_dvec3().dot(to_light).abs();
            let part = area / f64::from(2 * cells) * facing / across.length_squared();
            solid_angle += part;
            sum += part * self.reflected(sample, to_light, roughness);
        }
        self.windowed(sample, sum, solid_angle)
    }

    /// The same for a curved emitter, over its patches.
    fn specular_of_patches(&self, sample: &Sample, roughness: f64) -> f64 {
        let offset = sample.position - self.light.position.as_dvec3();
        let is_inside = self.emitter().in_front(offset) <= 0.0;
        if is_inside && self.emitter().is_solid() {
            return 0.0;
        }
        let (mut sum, mut solid_angle) = (0.0, 0.0);
        for (place, normal, area) in patches(&self.emitter()) {
            let across = place - offset;
            let to_light = across.normalize();
            let facing = match self.emitter().outline() {
                Outline::Disc => self.emitter().normal().as_dvec3().dot(to_light).abs(),
                _ => -normal.dot(to_light),
            };
            let part = area * facing.max(0.0) / across.length_squared();
            solid_angle += part;
            sum += part * self.reflected(sample, to_light, roughness);
        }
        self.windowed(sample, sum, solid_angle)
    }

    /// Radiance of a sum over cells, with its window.
    fn windowed(&self, sample: &Sample, sum: f64, solid_angle: f64) -> f64 {
        let emitter = self.emitter();
        let area = f64::from(emitter.area());
        // However coarse the cells, the solid angle is at most a hemisphere.
        let most = (std::f64::consts::TAU / solid_angle).min(1.0);
        let offset = sample.position - self.light.position.as_dvec3();
        let distance = offset.distance(emitter.closest(offset));
        let window = (1.0 - (distance / f64::from(self.light.range_m)).powi(4)).max(0.0).powi(2);
        f64::from(self.light.intensity.max_element()) / area * window * sum * most
    }

    /// The specular BRDF times the cosine.
    fn reflected(&self, sample: &Sample, to_light: DVec3, roughness: f64) -> f64 {
        let normal = sample.normal;
        let to_eye = (self.view.eye().as_dvec3() - sample.position).normalize();
        let half_way = (to_light + to_eye).normalize();
        let (n_l, n_v) = (normal.dot(to_light).max(0.0), normal.dot(to_eye).abs().max(1e-4));
        let n_h = normal.dot(half_way).clamp(0.0, 1.0);
        let alpha_2 = roughness.max(0.045).powi(4);
        let peak = n_h * n_h * (alpha_2 - 1.0) + 1.0;
        let distribution = alpha_2 / (std::f64::consts::PI * peak * peak);
        let root = |cos: f64| (cos * cos * (1.0 - alpha_2) + alpha_2).sqrt();
        let visibility = 0.5 / (n_l * root(n_v) + n_v * root(n_l));
        let f0 = f64::from(self.gloss.f0);
        let fresnel = f0 + (1.0 - f0) * (1.0 - to_eye.dot(half_way).clamp(0.0, 1.0)).powi(5);
        distribution * visibility * n_l * fresnel
    }
}
