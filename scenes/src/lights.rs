//! Lights drawn from a seed.

use std::f64::consts::TAU;

use assign::{Light, LightShape};
use glam::{DVec3, Vec3};
use rand::{Rng, RngExt, SeedableRng};
use rand_distr::{Distribution, Gamma, LogNormal};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;

use crate::{
    Aabb, SceneError,
    emitters::{Outlines, random_emitter},
};

/// The most lights [`scatter_lights`] makes.
pub const MAX_LIGHTS: u32 = 1 << 24;

/// The smallest radius a scattered light gets, metres: smaller draws are raised to it.
pub const MIN_RADIUS_M: f32 = 1e-4;

/// The irradiance at which an unbounded light's range ends: `range = sqrt(I / THRESHOLD)`
/// (Watrous 2024, "Light volumes").
pub const THRESHOLD: f32 = 0.02;

/// Shape and scale of the radii's gamma distribution: mode 0.25, mean 1.0 (Enhuber 2019,
/// Eq. 4.3).
const GAMMA: (f64, f64) = (4.0 / 3.0, 0.75);

/// Half angles at which spots end, degrees.
const SPOT_OUTER_DEGREES: (f64, f64) = (15.0, 60.0);

/// Inner angle of spots as a share of the outer.
const SPOT_INNER_SHARE: (f64, f64) = (0.5, 0.95);

/// Standard deviation of the logarithm of [`Radii::LogNormal`].
const LOG_SPREAD: f64 = 1.0;

/// How the radii of scattered lights are distributed; their mean is one metre, scaled.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Radii {
    /// Gamma with mode 0.25 (Enhuber 2019, equation 4.3).
    #[default]
    Gamma,
    /// All alike.
    Equal,
    /// Log-normal with a standard deviation of the logarithm of 1: many small, a few very large.
    LogNormal,
}

impl Radii {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Gamma, Self::Equal, Self::LogNormal];

    /// `gamma`, `equal` or `log-normal`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gamma => "gamma",
            Self::Equal => "equal",
            Self::LogNormal => "log-normal",
        }
    }
}

/// How scattered lights fill their box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Places {
    /// Uniformly (Enhuber 2019, section 4.2).
    #[default]
    Box,
    /// In seven upright cylinders, one in the middle and six around it, as high as the box (after
    /// Watrous 2024, whose seven lie where its scene has room).
    Cylinders,
}

/// Cylinders of [`Places::Cylinders`].
const CYLINDERS: usize = 7;

/// Their radius, and the distance of the outer ones from the middle, as shares of the box's sides.
const CYLINDER_SHARES: (f64, f64) = (0.09, 0.36);

impl Places {
    /// A point in the box: each coordinate a share of its side.
    fn sample(self, rng: &mut impl Rng) -> [f64; 3] {
        let [x, y, z] = std::array::from_fn(|_| rng.random::<f64>());
        if self == Self::Box {
            return [x, y, z];
        }
        let cylinder = rng.random_range(0..CYLINDERS);
        let (radius, away) = CYLINDER_SHARES;
        let around = TAU * cylinder as f64 / (CYLINDERS - 1) as f64;
        let away = if cylinder == CYLINDERS - 1 { 0.0 } else { away };
        let (sin, cos) = (TAU * x).sin_cos();
        let out = radius * z.sqrt();
        [0.5 + away * around.cos() + out * cos, y, 0.5 + away * around.sin() + out * sin]
    }
}

/// A distribution, ready to draw from.
enum RadiusSource {
    Gamma(Gamma<f64>),
    Equal,
    LogNormal(LogNormal<f64>),
}

impl RadiusSource {
    fn new(radii: Radii) -> Result<Self, SceneError> {
        let fail = |value: String| SceneError::OutOfRange {
            field: "distribution of radii",
            value,
            accepted: "positive",
        };
        Ok(match radii {
            Radii::Gamma => {
                let gamma = Gamma::new(GAMMA.0, GAMMA.1);
                Self::Gamma(gamma.map_err(|_| fail(format!("{GAMMA:?}")))?)
            }
            Radii::Equal => Self::Equal,
            Radii::LogNormal => {
                let mean_of_log = -0.5 * LOG_SPREAD * LOG_SPREAD;
                let spread = LogNormal::new(mean_of_log, LOG_SPREAD);
                Self::LogNormal(spread.map_err(|_| fail(LOG_SPREAD.to_string()))?)
            }
        })
    }

    /// A radius, metres.
    fn sample(&self, rng: &mut impl Rng) -> f64 {
        match self {
            Self::Gamma(gamma) => gamma.sample(rng),
            Self::Equal => 1.0,
            Self::LogNormal(spread) => spread.sample(rng),
        }
    }
}

/// What [`scatter_lights`] is asked for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSpec {
    /// How many, at most [`MAX_LIGHTS`].
    pub count: u32,
    /// With a light's index, all that decides it.
    pub seed: u64,
    /// Factor on the radii, `> 0`; at 1 their mean is one metre.
    pub radius_scale: f32,
    /// How the radii are distributed.
    pub radii: Radii,
    /// Where the lights are.
    pub bounds: Aabb,
    /// How they fill the box.
    pub places: Places,
    /// Share of spots among them, 0..=1.
    pub spot_share: f32,
    /// Share of area lights, 0..=1; the rest are points.
    pub area_share: f32,
    /// Outlines of the area lights.
    pub outlines: Outlines,
    /// Where the diffuse light of area lights ends, as a share of their range.
    pub diffuse_share: f32,
}

impl LightSpec {
    /// `count` point lights in `bounds`, seed 1, radii of mean one metre.
    pub fn new(count: u32, bounds: Aabb) -> Self {
        Self {
            count,
            seed: 1,
            radius_scale: 1.0,
            radii: Radii::Gamma,
            bounds,
            places: Places::Box,
            spot_share: 0.0,
            area_share: 0.0,
            outlines: Outlines::Both,
            diffuse_share: 1.0,
        }
    }

    fn check(&self) -> Result<(), SceneError> {
        let fail =
            |field, value: String, accepted| Err(SceneError::OutOfRange { field, value, accepted });
        if self.count > MAX_LIGHTS {
            return fail("light count", self.count.to_string(), "at most 16777216");
        }
        if !(self.radius_scale > 0.0 && self.radius_scale <= 1e6) {
            let value = self.radius_scale.to_string();
            return fail("radius scale", value, "above 0 and at most 1000000");
        }
        if !(0.0..=1.0).contains(&self.spot_share) {
            return fail("spot share", self.spot_share.to_string(), "between 0 and 1");
        }
        if !(0.0..=1.0).contains(&self.area_share) || self.spot_share + self.area_share > 1.0 {
            let accepted = "between 0 and 1, and no more than 1 with the share of spots";
            return fail("area light share", self.area_share.to_string(), accepted);
        }
        if !(self.diffuse_share > 0.0 && self.diffuse_share <= 1.0) {
            let value = self.diffuse_share.to_string();
            return fail("diffuse share", value, "above 0 and at most 1");
        }
        let Aabb { min, max } = self.bounds;
        if !(min.is_finite() && max.is_finite()) || self.bounds.is_empty() {
            return fail("light bounds", format!("{min} to {max}"), "finite, with min at most max");
        }
        Ok(())
    }
}

/// Draws lights: radii from a gamma distribution of mode 0.25 and mean 1.0 times
/// `radius_scale`, positions uniform in `bounds`, colours of random hue and saturation. The
/// intensity's largest channel is `THRESHOLD * range^2`, so that the range is where an unbounded
/// light would have faded to [`THRESHOLD`].
///
/// Every light depends on the seed and its own index only: 1,000 lights are the first of 10,000,
/// and the `i`-th light's position does not depend on `radius_scale` or `spot_share`.
///
/// # Errors
///
/// [`SceneError::OutOfRange`] for a field outside its range.
pub fn scatter_lights(spec: &LightSpec) -> Result<Vec<Light>, SceneError> {
    spec.check()?;
    let radii = RadiusSource::new(spec.radii)?;
    let lights = (0..spec.count).into_par_iter();
    Ok(lights.map(|ix| scatter_one(spec, &radii, ix)).collect())
}

fn scatter_one(spec: &LightSpec, radii: &RadiusSource, ix: u32) -> Light {
    // The gamma draw takes a varying number of values and so comes last.
    let mut rng = Pcg64Mcg::seed_from_u64(stream(spec.seed, ix));
    let shares = spec.places.sample(&mut rng);
    let position = Vec3::from_array(std::array::from_fn(|axis| {
        let (min, max) = (spec.bounds.min[axis], spec.bounds.max[axis]);
        let at = f64::from(min) + shares[axis] * (f64::from(max) - f64::from(min));
        (at as f32).clamp(min, max)
    }));
    let color = random_color(&mut rng);
    let shape = random_spot(&mut rng);
    let kind = rng.random::<f64>();
    let is_spot = kind < f64::from(spec.spot_share);
    let is_area = !is_spot && kind < f64::from(spec.spot_share) + f64::from(spec.area_share);
    // Drawn in f64 and rounded, so that a platform's ln and pow can hardly show.
    let range_m = (radii.sample(&mut rng) as f32 * spec.radius_scale).max(MIN_RADIUS_M);
    let intensity = color * (THRESHOLD * range_m * range_m);
    if is_area {
        let mut rng = Pcg64Mcg::seed_from_u64(!stream(spec.seed, ix));
        let emitter = random_emitter(&mut rng, spec.outlines, range_m);
        let emitter = emitter.with_diffuse_share(spec.diffuse_share);
        return Light::area(emitter, position, range_m, intensity);
    }
    let shape = if is_spot { shape } else { LightShape::Point };
    Light { position, range_m, intensity, shape }
}

/// A well-mixed 64-bit value for one light (splitmix64's finaliser).
fn stream(seed: u64, ix: u32) -> u64 {
    let mut z = seed
        .wrapping_mul(0x9e37_79b9_7f4a_7c15)
        .wrapping_add(u64::from(ix).wrapping_mul(0xd1b5_4a32_d192_ed03));
    z = (z ^ z >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ z >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ z >> 31
}

/// A colour whose largest channel is 1: hue uniform, saturation up to 0.85.
fn random_color(rng: &mut impl Rng) -> Vec3 {
    let hue = rng.random::<f32>() * 6.0;
    let saturation = rng.random::<f32>() * 0.85;
    let channel = |offset: f32| {
        let k = (offset + hue) % 6.0;
        1.0 - saturation * k.min(4.0 - k).clamp(0.0, 1.0)
    };
    Vec3::new(channel(5.0), channel(3.0), channel(1.0))
}

/// A unit vector, uniform on the sphere.
pub(crate) fn random_direction(rng: &mut impl Rng) -> DVec3 {
    let cos_theta: f64 = 1.0 - 2.0 * rng.random::<f64>();
    let phi = TAU * rng.random::<f64>();
    let sin_theta = (1.0 - cos_theta * cos_theta).max(0.0).sqrt();
    DVec3::new(sin_theta * phi.cos(), cos_theta, sin_theta * phi.sin()).normalize()
}

/// A spot of random direction and angles.
fn random_spot(rng: &mut impl Rng) -> LightShape {
    let lerp = |(a, b): (f64, f64), t: f64| a + (b - a) * t;
    let direction = random_direction(rng);
    let outer = lerp(SPOT_OUTER_DEGREES, rng.random()).to_radians();
    let inner = outer * lerp(SPOT_INNER_SHARE, rng.random());
    LightShape::Spot {
        direction: direction.as_vec3().normalize(),
        inner_angle: inner as f32,
        outer_angle: outer as f32,
    }
}

#[cfg(test)]
mod tests {
    use assign::LightKind;

    use super::*;

    fn spec(count: u32) -> LightSpec {
        LightSpec {
            spot_share: 0.25,
            ..LightSpec::new(count, Aabb::new(Vec3::splat(-2.0), Vec3::new(3.0, 4.0, 5.0)))
        }
    }

    #[test]
    fn a_thousand_are_the_first_of_ten_thousand() {
        let few = scatter_lights(&spec(1_000)).expect("valid");
        let many = scatter_lights(&spec(10_000)).expect("valid");
        assert_eq!(few[..], many[..1_000]);
        let other = scatter_lights(&LightSpec { seed: 2, ..spec(1_000) }).expect("valid");
        assert!(few.iter().zip(&other).all(|(a, b)| a.position != b.position));
    }

    #[test]
    fn every_light_is_usable_and_inside() {
        let spec = LightSpec { radius_scale: 1e-6, area_share: 0.5, ..spec(5_000) };
        for light in scatter_lights(&spec).expect("valid") {
            light.check().expect("usable");
            assert!(spec.bounds.contains(light.position));
            assert!(light.range_m >= MIN_RADIUS_M);
        }
        let flat = Aabb::new(Vec3::ZERO, Vec3::ZERO);
        let lights = scatter_lights(&LightSpec::new(10, flat)).expect("valid");
        assert!(lights.iter().all(|l| l.position == Vec3::ZERO && l.check().is_ok()));
    }

    /// Over 100,000 draws the standard error of the mean is 0.0027 (the variance is 0.75), and
    /// the share below the mode is known to 0.0011; tolerances are five of them.
    #[test]
    fn radii_follow_the_gamma_distribution() {
        let lights = scatter_lights(&spec(100_000)).expect("valid");
        let n = lights.len() as f64;
        let mean = lights.iter().map(|l| f64::from(l.range_m)).sum::<f64>() / n;
        assert!((mean - 1.0).abs() < 0.0137, "mean {mean}");
        // Regularised lower incomplete gamma P(4/3, 1/3).
        let below = lights.iter().filter(|l| l.range_m < 0.25).count() as f64 / n;
        assert!((below - 0.1616).abs() < 0.006, "below the mode {below}");
        let spots = lights.iter().filter(|l| l.shape != LightShape::Point).count() as f64 / n;
        assert!((spots - 0.25).abs() < 0.007, "spots {spots}");
        // The standard error of a uniform mean is its extent over sqrt(12 n): 0.0064 along z.
        let center = lights.iter().map(|l| l.position.as_dvec3()).sum::<DVec3>() / n;
        let off = center - spec(0).bounds.center().as_dvec3();
        assert!(off.abs().max_element() < 0.032, "middle {center}");
    }

    #[test]
    fn other_distributions_keep_the_mean_and_the_places() {
        let gamma = scatter_lights(&spec(100_000)).expect("valid");
        for radii in [Radii::Equal, Radii::LogNormal] {
            let lights = scatter_lights(&LightSpec { radii, ..spec(100_000) }).expect("valid");
            let mean = lights.iter().map(|l| f64::from(l.range_m)).sum::<f64>() / 1e5;
            // Four standard errors of a log-normal of variance e - 1.
            assert!((mean - 1.0).abs() < 0.0166, "{}: mean {mean}", radii.name());
            assert!(lights.iter().zip(&gamma).all(|(a, b)| a.position == b.position));
            let largest = lights.iter().map(|l| l.range_m).fold(0.0, f32::max);
            assert_eq!(largest > 10.0, radii == Radii::LogNormal, "{largest}");
        }
    }

    #[test]
    fn cylinders_hold_all_lights_and_leave_room_between() {
        let bounds = Aabb::new(Vec3::ZERO, Vec3::new(10.0, 4.0, 10.0));
        let places = Places::Cylinders;
        let lights = scatter_lights(&LightSpec { places, ..LightSpec::new(7_000, bounds) });
        let lights = lights.expect("valid");
        let from_middle = |l: &Light| (l.position.with_y(0.0) - Vec3::new(5.0, 0.0, 5.0)).length();
        let inner = lights.iter().filter(|l| from_middle(l) <= 0.9001).count();
        assert!((900..1_100).contains(&inner), "{inner} in the middle");
        assert!(lights.iter().all(|l| !(0.91..2.69).contains(&from_middle(l))));
        assert!(lights.iter().all(|l| bounds.contains(l.position)));
    }

    #[test]
    fn range_is_where_intensity_reaches_the_threshold() {
        for light in scatter_lights(&spec(1_000)).expect("valid") {
            let range = Light::range_from_threshold(light.intensity, THRESHOLD);
            assert!((range / light.range_m - 1.0).abs() < 1e-5);
        }
    }

    #[test]
    fn area_lights_are_drawn_beside_the_others() {
        let spec = LightSpec { area_share: 0.5, diffuse_share: 0.6, ..spec(10_000) };
        let lights = scatter_lights(&spec).expect("valid");
        let plain = LightSpec { area_share: 0.0, ..spec };
        for (light, plain) in lights.iter().zip(scatter_lights(&plain).expect("valid")) {
            light.check().expect("usable");
            assert_eq!((light.position, light.range_m), (plain.position, plain.range_m));
        }
        let count = |kind| lights.iter().filter(|l| l.kind() == kind).count();
        // Five standard deviations of a share of a quarter.
        for kind in [LightKind::Spot, LightKind::Rectangle, LightKind::Polygon, LightKind::Point] {
            assert!((2_283..2_717).contains(&count(kind)), "{kind:?}: {}", count(kind));
        }
        let lit = lights.iter().filter(|l| l.kind() == LightKind::Polygon);
        assert!(lit.clone().all(|l| (l.diffuse_range_m() / l.range_m - 0.6).abs() < 1e-6));
    }

    /// The stream of values is pinned: a change of generator would make results incomparable.
    #[test]
    fn draws_are_pinned() {
        let light =
            scatter_lights(&LightSpec::new(1, Aabb::new(Vec3::ZERO, Vec3::ONE))).expect("valid")[0];
        assert_eq!(
            format!("{:.5} {:.5}", light.position, light.range_m),
            "[0.00122, 0.28407, 0.09191] 0.27506"
        );
    }

    #[test]
    fn bad_specs_name_the_field() {
        let bad = |spec: LightSpec| scatter_lights(&spec).expect_err("bad").to_string();
        let base = spec(1);
        let error = bad(LightSpec { count: MAX_LIGHTS + 1, ..base });
        assert_eq!(error, "light count is 16777217: it must be at most 16777216");
        assert!(bad(LightSpec { radius_scale: f32::NAN, ..base }).contains("radius scale is NaN"));
        assert!(bad(LightSpec { spot_share: 1.5, ..base }).contains("spot share is 1.5"));
        let bounds = Aabb::EMPTY;
        assert!(bad(LightSpec { bounds, ..base }).contains("light bounds"));
    }
}
