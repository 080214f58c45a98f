//! Chooses ranges for lights whose file gives none.
//!
//! In glTF such a light reaches everywhere (KHR_lights_punctual), but every light here needs an
//! end. An open light ends where its irradiance, intensity over squared distance, falls to a
//! threshold. The threshold is [`THRESHOLD`], or less if all open lights together are dim for the
//! size of the scene:
//!
//! ```text
//! threshold = min(0.02, 0.04 * sum of intensities / diagonal^2)
//! ```
//!
//! So `n` equal lights reach at least `5 / sqrt(n)` diagonals of the scene. A single lamp lights
//! all of it, however dim the lamp is, and thousands of lamps still end.
//!
//! # What is lost
//!
//! At `x` ranges from a light, the window removes the share `1 - (1 - x^4)^2` of its irradiance,
//! which is `threshold / x^2`. The loss is `threshold * (2 x^2 - x^6)`, at most [`LOST`]
//! thresholds.

use assign::{Light, MAX_RANGE_M, MIN_RANGE_M};

use crate::THRESHOLD;

/// The most irradiance that a surface loses to the end of one light's range, in thresholds.
pub const LOST: f64 = 1.089;

/// The threshold as a share of the irradiance of all open lights at a distance of one diagonal.
const SHARE: f64 = 0.04;

/// Chooses a range for every light of infinite range, in a scene of this diagonal, and returns
/// their indices. An open light of faulty intensity gets a range of 1 m, so that its own fault is
/// reported.
pub fn close_ranges(lights: &mut [Light], diagonal_m: f32) -> Vec<u32> {
    let is_open = |light: &Light| light.range_m == f32::INFINITY;
    let brightness = |light: &Light| {
        let [least, greatest] = [light.intensity.min_element(), light.intensity.max_element()];
        (least >= 0.0 && greatest > 0.0 && light.intensity.is_finite()).then_some(greatest)
    };
    let sum: f64 = lights.iter().filter(|l| is_open(l)).filter_map(brightness).map(f64::from).sum();
    let threshold = threshold_of(sum, f64::from(diagonal_m));
    let open = |(ix, light): (usize, &mut Light)| {
        is_open(light).then(|| {
            let end_m = |intensity| (f64::from(intensity) / threshold).sqrt() as f32;
            let range_m = brightness(light).map_or(1.0, end_m);
            light.range_m = range_m.clamp(MIN_RANGE_M, MAX_RANGE_M);
            ix as u32
        })
    };
    lights.iter_mut().enumerate().filter_map(open).collect()
}

/// The threshold for open lights with this sum of intensities.
fn threshold_of(sum: f64, diagonal_m: f64) -> f64 {
    let dim = SHARE * sum / (diagonal_m * diagonal_m);
    // A scene without extent has no dim lights, and one without lights needs no threshold of its
    // own.
    if dim > 0.0 { dim.min(f64::from(THRESHOLD)) } else { THRESHOLD.into() }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    fn lamps(intensities: &[f32]) -> Vec<Light> {
        let lamp = |&i: &f32| Light::point(Vec3::ZERO, f32::INFINITY, Vec3::new(0.0, i, 0.5 * i));
        intensities.iter().map(lamp).collect()
    }

    fn ranges(intensities: &[f32], diagonal_m: f32) -> Vec<f32> {
        let mut lights = lamps(intensities);
        assert_eq!(close_ranges(&mut lights, diagonal_m).len(), lights.len());
        lights.iter().map(|light| light.range_m).collect()
    }

    #[test]
    fn even_a_dim_lamp_lights_the_whole_scene() {
        for intensity in [1e-12_f32, 0.05, 1.0, 1e6] {
            for diagonal_m in [0.1, 10.0, 1e4] {
                let range_m = ranges(&[intensity], diagonal_m)[0];
                assert!(range_m >= 4.999 * diagonal_m, "{intensity}, {diagonal_m}: {range_m}");
            }
        }
        // A hundred equal lights reach half a diagonal each. Bright ones end at the usual
        // threshold.
        assert!((ranges(&[0.05; 100], 20.0)[99] / 20.0 - 0.5).abs() < 1e-6);
        assert_eq!(ranges(&[2.0; 1000], 1.0)[0], 10.0);
        assert_eq!(ranges(&[2.0], f32::NAN)[0], 10.0);
    }

    #[test]
    fn given_ranges_stay_and_faulty_lights_get_a_metre() {
        let mut lights = lamps(&[2.0, 1.0, f32::NAN, -1.0, 0.0]);
        lights[1].range_m = 3.0;
        assert_eq!(close_ranges(&mut lights, 1e-3), [0, 2, 3, 4]);
        assert_eq!(
            lights.iter().map(|l| l.range_m).collect::<Vec<_>>(),
            [10.0, 3.0, 1.0, 1.0, 1.0]
        );
    }

    #[test]
    fn the_window_removes_at_most_the_stated_light() {
        let lost = |x: f64| (1.0 - (1.0 - x.powi(4)).max(0.0).powi(2)) / (x * x);
        let most = (1..2000).map(|i| lost(f64::from(i) / 1000.0)).fold(0.0, f64::max);
        assert!(most <= LOST && most > LOST - 1e-3, "{most}");
    }
}
