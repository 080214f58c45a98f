//! Area lights with shadows: radiance of a flat emitter, reflected at a sample.
//!
//! By pairs of directions: one uniform in the solid angle of the emitter's rectangle (Ureña et al.
//! 2013), one drawn as the BRDF reflects, both weighted by the balance heuristic (Veach and Guibas 1995, equation 14): a direction counts
//! once over the sum of both densities, whichever drew it. So neither a mirror's small highlight nor
//! a small emitter over a rough surface makes a rare, large value.

use assign::{Emitter, Light};
use glam::{DVec3, Vec3};
use rand::RngExt;
use rand_pcg::Pcg64Mcg;

use super::{Estimate, SurfaceSample, TracedScene, brdf_sampler::BrdfSampler};
use crate::{
    ltc::SphericalRectangle,
    reference::{light_contribution, lobes_of, window},
};

/// Below this solid angle, steradians, an emitter casts the shadow of its middle: the difference of
/// angles that the area-preserving map starts from has too few digits left.
const SMALL: f64 = 1e-8;
/// How far outside its edges a point is of the emitter, as a share of the range: rounding.
const ROUNDING: f64 = 1e-9;

/// An emitter as a sample sees it.
pub(super) struct SeenEmitter<'a> {
    light: &'a Light,
    emitter: &'a Emitter,
    sample: &'a SurfaceSample,
    /// Vector from the sample to the emitter's middle, metres.
    center: DVec3,
    /// Of the vertices, of any length: half axes and [`Emitter::normal`] are rounded.
    normal: DVec3,
    /// Emitted radiance times the windows of diffuse and of specular light.
    diffuse: DVec3,
    specular: DVec3,
    range_m: f64,
}

impl<'a> SeenEmitter<'a> {
    /// `None` where its light does not reach the sample.
    pub(super) fn new(
        light: &'a Light,
        emitter: &'a Emitter,
        sample: &'a SurfaceSample,
    ) -> Option<Self> {
        let center = light.position.as_dvec3() - sample.position;
        if emitter.in_front(-center) <= 0.0 {
            return None;
        }
        let distance_2 = (emitter.closest(-center) + center).length_squared();
        let range_m = f64::from(light.range_m);
        let radiance = light.intensity.as_dvec3() / f64::from(emitter.area());
        let vertices = emitter.vertices().iter().map(|v| v.as_dvec3());
        let next = vertices.clone().cycle().skip(1);
        let seen = Self {
            light,
            emitter,
            sample,
            center,
            normal: vertices.zip(next).map(|(a, b)| a.cross(b)).sum(),
            diffuse: radiance * window(distance_2, f64::from(light.diffuse_range_m())),
            specular: radiance * window(distance_2, range_m),
            range_m,
        };
        (seen.specular != DVec3::ZERO).then_some(seen)
    }

    /// Vector from the sample to a vertex.
    fn vertex(&self, ix: usize) -> DVec3 {
        self.emitter.vertices()[ix].as_dvec3() + self.center
    }

    /// Reflected radiance that nothing of the scene blocks, from `pairs` of directions.
    pub(super) fn shadowed(
        &self,
        scene: &TracedScene<'_>,
        pairs: u32,
        rng: &mut Pcg64Mcg,
    ) -> Estimate {
        let [x, y] = self.emitter.half_axes().map(Vec3::as_dvec3);
        let rectangle = SphericalRectangle::new(self.center - x - y, 2.0 * x, 2.0 * y);
        let Some(rectangle) = rectangle.filter(|r| r.solid_angle() > SMALL) else {
            let middle = self.sample.position + self.center;
            let is_seen = scene.sees(self.sample, middle);
            let SurfaceSample { position, surface, to_eye, .. } = self.sample;
            let radiance = light_contribution(self.light, *position, surface, *to_eye);
            return Estimate::exact(if is_seen { radiance } else { DVec3::ZERO });
        };
        let brdf = BrdfSampler::new(&self.sample.surface, self.sample.to_eye);
        let uniform = 1.0 / rectangle.solid_angle();
        Estimate::of_samples(pairs, || {
            let directions = [rectangle.direction(rng.random(), rng.random()), brdf.sample(rng)];
            let value = |direction: DVec3| {
                // Its light comes from the rectangle, so that both could have drawn it.
                self.reflected(direction, scene) / (uniform + brdf.density(direction))
            };
            directions.map(value).iter().sum()
        })
    }

    /// Radiance reflected from a unit direction, per steradian.
    fn reflected(&self, direction: DVec3, scene: &TracedScene<'_>) -> DVec3 {
        let surface = &self.sample.surface;
        let cos = surface.normal.dot(direction);
        let Some(point) = self.point_along(direction).filter(|_| cos > 0.0) else {
            return DVec3::ZERO;
        };
        if !scene.sees(self.sample, point) {
            return DVec3::ZERO;
        }
        let lobes = lobes_of(surface, self.sample.to_eye, direction);
        (self.diffuse * lobes.diffuse + self.specular * lobes.specular) * cos
    }

    /// The point of the emitter that a ray from the sample meets, world space.
    fn point_along(&self, direction: DVec3) -> Option<DVec3> {
        let distance_m = self.normal.dot(self.vertex(0)) / self.normal.dot(direction);
        let offset = direction * distance_m - self.center;
        let is_inside = self.emitter.closest(offset).distance(offset) <= ROUNDING * self.range_m;
        (distance_m > 0.0 && is_inside).then(|| self.sample.position + direction * distance_m)
    }
}
