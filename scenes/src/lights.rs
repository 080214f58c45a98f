//! Draws scattered lights from a seed.

use assign::{Light, LightShape};
use glam::Vec3;
use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use rayon::prelude::*;

use crate::{
    Aabb, Outlines, Places, Radii, SceneError,
    emitters::random_emitter,
    radii::RadiusSource,
    random::{random_color, random_direction, seed_of},
};

/// The most lights that [`scatter_lights`] makes.
pub const MAX_LIGHTS: u32 = 1 << 24;

/// The smallest radius of a scattered light, metres. Smaller draws are raised to it.
pub const MIN_RADIUS_M: f32 = 1e-4;

/// The irradiance at which an unbounded light's range ends: `range = sqrt(I / THRESHOLD)`
/// (Watrous 2024, "Light volumes").
pub const THRESHOLD: f32 = 0.02;

/// Range of the half angles at which spots end, degrees.
const SPOT_OUTER_DEGREES: (f64, f64) = (15.0, 60.0);

/// Range of the inner angle of spots, as a share of the outer.
const SPOT_INNER_SHARE: (f64, f64) = (0.5, 0.95);

/// The parameters of [`scatter_lights`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LightSpec {
    /// The number of lights, at most [`MAX_LIGHTS`].
    pub count: u32,
    /// The seed. It and the light's index decide everything random about a light.
    pub seed: u64,
    /// Factor on the radii, `> 0`. At 1 their mean is one metre.
    pub radius_scale: f32,
    /// How the radii are distributed.
    pub radii: Radii,
    /// The box of the lights' positions.
    pub bounds: Aabb,
    /// Where they lie in the box.
    pub places: Places,
    /// The share of spots, 0..=1.
    pub spot_share: f32,
    /// The share of area lights, 0..=1. The rest are points.
    pub area_share: f32,
    /// Outlines of the area lights.
    pub outlines: Outlines,
    /// Where diffuse light of area lights ends, as a share of their range.
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

/// Draws lights. Radii follow a gamma distribution of mode 0.25 and mean 1.0, times `radius_scale`.
/// Positions are uniform in `bounds`. Colours have random hue and saturation. The intensity's
/// largest channel is `THRESHOLD * range^2`, so an unbounded light would have faded to
/// [`THRESHOLD`] at the range.
///
/// Every light depends only on the seed and its own index. So 1,000 lights are the first of 10,000,
/// and the position of the `i`-th light does not depend on `radius_scale` or `spot_share`.
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
    // The radius comes last, because the gamma distribution draws a varying number of values.
    let mut rng = Pcg64Mcg::seed_from_u64(seed_of(spec.seed, ix));
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
    // The radius is drawn in f64 and rounded, so that differences in a platform's ln and pow hardly
    // show.
    let range_m = (radii.sample(&mut rng) as f32 * spec.radius_scale).max(MIN_RADIUS_M);
    let intensity = color * (THRESHOLD * range_m * range_m);
    if is_area {
        let mut rng = Pcg64Mcg::seed_from_u64(!seed_of(spec.seed, ix));
        let emitter = random_emitter(&mut rng, spec.outlines, range_m);
        let emitter = emitter.with_diffuse_share(spec.diffuse_share);
        return Light::area(emitter, position, range_m, intensity);
    }
    let shape = if is_spot { shape } else { LightShape::Point };
    Light { position, range_m, intensity, shape }
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
    use glam::DVec3;

    use super::*;

    fn spec(count: u32) -> LightSpec {
        LightSpec {
            spot_share: 0.25,
            ..LightSpec::new(count, Aabb::new(Vec3::splat(-2.0), Vec3::new(3.0, 4.0, 5.0)))
        }
    }

    #[test]
    fn fewer_lights_are_the_first_of_more() {
        let few = scatter_lights(&spec(1_000)).expect("valid");
        let many = scatter_lights(&spec(10_000)).expect("valid");
        assert_eq!(few[..], many[..1_000]);
        let other = scatter_lights(&LightSpec { seed: 2, ..spec(1_000) }).expect("valid");
        assert!(few.iter().zip(&other).all(|(a, b)| a.position != b.position));
    }

    #[test]
    fn every_light_is_valid_and_inside_the_box() {
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

    /// Over 100,000 draws the standard error of the mean is 0.0027 (the variance is 0.75), and that
    /// of the share below the mode is 0.0011. Tolerances are five standard errors.
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

    #[test]
    fn curved_emitters_are_sound_and_of_the_stated_kind() {
        let spec = LightSpec { area_share: 1.0, spot_share: 0.0, ..spec(5_000) };
        let kinds = |outlines| {
            let lights = scatter_lights(&LightSpec { outlines, ..spec }).expect("valid");
            lights.iter().for_each(|light| light.check().expect("usable"));
            let count = |kind| lights.iter().filter(|l| l.kind() == kind).count();
            [LightKind::Rectangle, LightKind::Polygon, LightKind::Disc, LightKind::Sphere]
                .map(count)
        };
        assert_eq!(kinds(Outlines::Discs), [0, 0, 5_000, 0]);
        assert_eq!(kinds(Outlines::Spheres), [0, 0, 0, 5_000]);
        assert_eq!(kinds(Outlines::Lines), [0; 4]);
        // Five standard deviations of a fifth.
        assert!(kinds(Outlines::All).iter().all(|count| (858..1_142).contains(count)));
    }

    /// The values drawn are fixed: with another generator, results could not be compared.
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
    fn errors_name_the_faulty_field() {
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
