//! Area lights with shadows: the radiance of an emitter, reflected at a sample.
//!
//! Directions are drawn in pairs. One is uniform in the solid angle of a rectangle that covers the emitter
//! (Ureña et al. 2013), and one is drawn as the BRDF reflects. The balance heuristic weights both
//! (Veach and Guibas 1995, equation 14): a direction counts once over the sum of both densities,
//! whichever drew it. Where the lobe is wide, both directions are drawn from the rectangle. So
//! neither a mirror's small highlight nor a small emitter over a rough surface gives rare, large
//! values.
//!
//! Quadrature already gives the emitter's light without shadows, so the pairs only estimate the
//! share of it that arrives (Heitz, Hill and McGuire 2018). The error of the share is far smaller:
//! it is zero where nothing blocks the emitter, and where all of it is blocked. A ratio of two
//! means has a bias of about one over the number of pairs. With few pairs, they therefore estimate
//! the radiance itself.

use assign::{Emitter, Light, range_window};
use glam::DVec3;

use super::{
    Estimate, Numbers, SurfaceSample, TracedScene,
    brdf_sampler::BrdfSampler,
    numbers::Point,
    silhouette::{Cover, Silhouette},
};
use crate::{
    ltc::SphericalRectangle,
    reference::{light_contribution, lobes_of},
};

/// Below this solid angle, steradians, an emitter casts the shadow of its middle. The
/// area-preserving map starts from a difference of angles that would have too few digits.
const SMALL: f64 = 1e-8;
/// If the lobe's peak is at most this many times as dense as the rectangle's directions, these
/// sample it well enough. Directions of the lobe would cross the emitter's edge, which adds noise.
const NARROW: f64 = 8.0;
/// From this number of pairs on they estimate a share, because its bias is then far below its
/// error.
const RATIO_PAIRS: u32 = 64;
/// The number of coordinates of a sample's point that a pair of directions uses.
pub(super) const PAIR_DIMENSIONS: u32 = 5;

/// An emitter seen from a sample.
pub(super) struct SeenEmitter<'a> {
    light: &'a Light,
    sample: &'a SurfaceSample,
    /// Vector from the sample to the emitter's middle, metres.
    center: DVec3,
    silhouette: Silhouette<'a>,
    /// Emitted radiance times the window of diffuse and of specular light.
    diffuse: DVec3,
    specular: DVec3,
}

impl<'a> SeenEmitter<'a> {
    /// `None` if its light does not reach the sample.
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
        let radiance = light.intensity.as_dvec3() / f64::from(emitter.area());
        let seen = Self {
            light,
            sample,
            center,
            silhouette: Silhouette::new(emitter, center),
            diffuse: radiance * range_window(distance_2, f64::from(light.diffuse_range_m())),
            specular: radiance * range_window(distance_2, f64::from(light.range_m)),
        };
        (seen.specular != DVec3::ZERO).then_some(seen)
    }

    /// The reflected radiance that nothing in the scene blocks, from `pairs` of directions.
    pub(super) fn shadowed(
        &self,
        scene: &TracedScene<'_>,
        pairs: u32,
        numbers: Numbers,
    ) -> Estimate {
        let Some(drawn) = Pairs::new(self) else {
            return Estimate::exact(self.by_middle(scene));
        };
        let both = |point: Point| drawn.radiance(scene, point.at(0));
        if pairs < RATIO_PAIRS {
            return Estimate::of_points(pairs, numbers, |point| both(point).shadowed);
        }
        let SurfaceSample { position, surface, to_eye, .. } = self.sample;
        let whole = light_contribution(self.light, *position, surface, *to_eye);
        Estimate::of_shares(pairs, numbers, whole, |point| {
            let Drawn { shadowed, whole } = both(point);
            (shadowed, whole)
        })
    }

    /// The same from one pair, drawn by coordinates in 0..1.
    pub(super) fn shadowed_once(
        &self,
        scene: &TracedScene<'_>,
        coordinates: [f64; PAIR_DIMENSIONS as usize],
    ) -> DVec3 {
        match Pairs::new(self) {
            Some(drawn) => drawn.radiance(scene, coordinates).shadowed,
            None => self.by_middle(scene),
        }
    }

    /// The whole reflected radiance times the share of the emitter's irradiance that arrives at the sample, from `points`
    /// of it. Parts below the sample's horizon do not count: this is what shadow maps approximate.
    pub(super) fn separated(
        &self,
        scene: &TracedScene<'_>,
        points: u32,
        numbers: Numbers,
    ) -> Estimate {
        let SurfaceSample { position, surface, to_eye, .. } = self.sample;
        let whole = light_contribution(self.light, *position, surface, *to_eye);
        if whole == DVec3::ZERO {
            return Estimate::default();
        }
        let Cover { center, x, y } = self.silhouette.cover();
        let normal = x.cross(y);
        Estimate::of_shares(points, numbers, whole, |point| {
            let [u, v] = point.at(0).map(|t: f64| 2.0 * t - 1.0);
            let place = center + x * u + y * v;
            let is_above = surface.normal.dot(place) > 0.0;
            let Some(offset) = self.silhouette.point_along(place).filter(|_| is_above) else {
                return (DVec3::ZERO, DVec3::ZERO);
            };
            // cos(sample) cos(emitter) / distance^2, in no unit: the solid angle of a patch of the cover.
            let cosines = surface.normal.dot(place) * normal.dot(place).abs();
            let irradiance = DVec3::splat(cosines / place.length_squared().powi(2));
            let is_seen = scene.sees(self.sample, *position + offset);
            (if is_seen { irradiance } else { DVec3::ZERO }, irradiance)
        })
    }

    /// The light of the whole emitter, if its middle is visible.
    fn by_middle(&self, scene: &TracedScene<'_>) -> DVec3 {
        let SurfaceSample { position, surface, to_eye, .. } = self.sample;
        if scene.sees(self.sample, *position + self.center) {
            light_contribution(self.light, *position, surface, *to_eye)
        } else {
            DVec3::ZERO
        }
    }

    /// Radiance reflected from a unit direction, per steradian.
    fn reflected(&self, direction: DVec3, scene: &TracedScene<'_>) -> Drawn {
        let surface = &self.sample.surface;
        let cos = surface.normal.dot(direction);
        let Some(offset) = self.silhouette.point_along(direction).filter(|_| cos > 0.0) else {
            return Drawn::default();
        };
        let point = self.sample.position + offset;
        let lobes = lobes_of(surface, self.sample.to_eye, direction);
        let whole = (self.diffuse * lobes.diffuse + self.specular * lobes.specular) * cos;
        let is_seen = scene.sees(self.sample, point);
        Drawn { shadowed: if is_seen { whole } else { DVec3::ZERO }, whole }
    }
}

/// The radiance of drawn directions, with and without shadows.
#[derive(Clone, Copy, Debug, Default)]
struct Drawn {
    shadowed: DVec3,
    whole: DVec3,
}

/// Draws pairs of directions to an emitter.
struct Pairs<'a> {
    seen: &'a SeenEmitter<'a>,
    rectangle: SphericalRectangle,
    /// `None` if the surface's lobe is so wide that both directions come from the rectangle.
    brdf: Option<BrdfSampler>,
}

impl<'a> Pairs<'a> {
    /// `None` if the emitter is too small to draw from.
    fn new(seen: &'a SeenEmitter<'a>) -> Option<Self> {
        let Cover { center, x, y } = seen.silhouette.cover();
        let rectangle = SphericalRectangle::new(center - x - y, 2.0 * x, 2.0 * y);
        let rectangle = rectangle.filter(|r| r.solid_angle() > SMALL)?;
        let brdf = BrdfSampler::new(&seen.sample.surface, seen.sample.to_eye);
        let is_narrow = rectangle.solid_angle() * brdf.peak_density() > NARROW;
        Some(Self { seen, rectangle, brdf: is_narrow.then_some(brdf) })
    }

    /// Radiance from one pair.
    fn radiance(&self, scene: &TracedScene<'_>, [u, v, s, t, choice]: [f64; 5]) -> Drawn {
        let uniform = 1.0 / self.rectangle.solid_angle();
        let second = match &self.brdf {
            Some(brdf) => brdf.sample([s, t, choice]),
            None => self.rectangle.direction(s, t),
        };
        let directions = [self.rectangle.direction(u, v), second];
        directions.into_iter().fold(Drawn::default(), |sum, direction| {
            // Use only directions that hit the rectangle, because both methods could have drawn
            // them.
            let other = self.brdf.as_ref().map_or(uniform, |brdf| brdf.density(direction));
            let density = uniform + other;
            let Drawn { shadowed, whole } = self.seen.reflected(direction, scene);
            Drawn {
                shadowed: sum.shadowed + shadowed / density,
                whole: sum.whole + whole / density,
            }
        })
    }
}
