//! Stochastic light culling: each light gets a new random range in each frame. **Lossy**: the image is noisy, but
//! correct on average.
//!
//! # Idea
//!
//! A light far away adds little. A threshold that drops it makes the image too dark. Tokuyoshi and Harada (2016,
//! "Stochastic Light Culling", Journal of Computer Graphics Techniques 5(1)) drop it at random instead, by Russian
//! roulette. Where the light's irradiance `f(d)` at a distance `d` is above the threshold `t`, it stays. Below, it
//! stays with the probability `p = f(d) / t`, and then counts as `f(d) / p = t`. Its expected irradiance is `f(d)`
//! everywhere.
//!
//! All samples of a frame share one random number `x` per light, from 0 to 1. So "stays" means `f(d) > t x`, which
//! is a range: a light of intensity `I` ends at `min(range, sqrt(I / (t x)))`. Lists are made for these ranges, by any
//! strategy and any test. Shading tests `f(d) > t x` itself, and adds `max(f(d), t)`.
//!
//! # Example
//!
//! With an intensity of 1 and a threshold of 0.01, a light always reaches 10 m. With a probability of a quarter it
//! reaches 20 m or more, and wherever it reaches beyond 10 m it counts as if it were 10 m away.
//!
//! # Cost
//!
//! In every frame, `prepare` computes, checks and uploads the lights with their ranges on the CPU. No measured time
//! includes this. It takes about as long as uploading lights that the CPU moves. Lists are shorter: with
//! `r = sqrt(I / t)`, the mean of the cubed range falls from `R^3` to `3 r^2 R - 2 r^3`, for a light of range `R`.
//!
//! # Where it fails
//!
//! - Whole areas flicker together, because all samples share a light's random number. Averaging frames helps (it is made
//!   for renderers that do), and so do many lights.
//! - A light with a range not far beyond `sqrt(I / t)` gains nothing.
//! - Area lights keep their ranges.

use crate::{
    AssignError, Assignment, Frame, Gpu, Light, LightBuffer, LightShape, MIN_RANGE_M, Passes,
    leave_to_inner,
};

/// A strategy that makes its lists for random ranges. Shading must know the threshold, and [`Frame::seed`].
pub struct Stochastic {
    inner: Box<dyn Assignment>,
    threshold: f32,
    /// The lights with their ranges of this frame, in the places of the frame's lights.
    copy: LightBuffer,
}

impl Stochastic {
    /// Wraps a strategy. Lights stay wherever their irradiance is above the threshold.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] if the threshold is not above 0, up to 1e6.
    pub fn new(gpu: &Gpu, inner: Box<dyn Assignment>, threshold: f32) -> Result<Self, AssignError> {
        check_threshold(threshold)?;
        Ok(Self { inner, threshold, copy: LightBuffer::new(gpu, &[])? })
    }
}

/// Checks a threshold.
///
/// # Errors
///
/// [`AssignError::Parameter`] if it is not above 0, up to 1e6.
pub fn check_threshold(threshold: f32) -> Result<(), AssignError> {
    if threshold > 0.0 && threshold <= 1e6 {
        return Ok(());
    }
    Err(AssignError::Parameter {
        field: "threshold of stochastic culling".into(),
        value: threshold.to_string(),
        accepted: "an irradiance above 0, up to 1e6".into(),
    })
}

/// A number from 0 to 1, of a light in a frame: `random_of` of `stochastic.wesl`. It is the first output of a
/// generator of O'Neill 2014, "PCG", with its state from the light and the seed.
pub fn random_of(light: u32, seed: u32) -> f32 {
    let mix = |word: u32| {
        let state = word.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
        (word >> 22) ^ word
    };
    let bits = mix(light ^ mix(seed)) >> 8;
    (bits as f32 + 0.5) / 16_777_216.0
}

/// How much farther lists reach than shading: more than rounding moves a range.
const SLACK: f32 = 1.0001;

/// The light with its range of a frame.
fn with_random_range(light: &Light, threshold: f32, random: f32) -> Light {
    if matches!(light.shape, LightShape::Area(_)) {
        return *light;
    }
    let reach_m = (light.intensity.max_element() / threshold / random).sqrt() * SLACK;
    Light { range_m: light.range_m.min(reach_m.max(MIN_RANGE_M)), ..*light }
}

impl Assignment for Stochastic {
    fn id(&self) -> String {
        format!("{}/stochastic{}", self.inner.id(), self.threshold)
    }

    leave_to_inner!(needs, is_view_bound, compile, lookup, bind_group, lists);

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Self::new(gpu, self.inner.for_view(gpu)?, self.threshold)?))
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        let lights = frame.lights_by_slot(self.id(), "computes the ranges of a frame")?;
        let lights = lights.iter().zip(0..);
        let ranged = lights.map(|(light, place)| {
            with_random_range(light, self.threshold, random_of(place, frame.seed))
        });
        self.copy.update(gpu, &ranged.collect::<Vec<_>>())?;
        self.inner.prepare(gpu, &Frame { lights: &self.copy, ..*frame })
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        self.inner.record(&Frame { lights: &self.copy, ..*frame }, passes);
    }

    fn memory_bytes(&self) -> u64 {
        self.inner.memory_bytes() + self.copy.memory_bytes()
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;
    use crate::{Everything, LightOrder, View};

    #[test]
    fn random_numbers_are_even_and_differ_between_lights_and_frames() {
        let numbers: Vec<f64> = (0..64)
            .flat_map(|seed| (0..256).map(move |light| random_of(light, seed).into()))
            .collect();
        assert!(numbers.iter().all(|x| (0.0..=1.0).contains(x) && *x > 0.0));
        // 16,384 numbers: the mean has a standard error of 0.0023, a share of a tenth one of 0.0023 too.
        let mean = numbers.iter().sum::<f64>() / numbers.len() as f64;
        assert!((mean - 0.5).abs() < 0.01, "{mean}");
        for tenth in 0..10 {
            let inside = |x: &&f64| (**x * 10.0) as u32 == tenth;
            let share = numbers.iter().filter(inside).count() as f64 / numbers.len() as f64;
            assert!((share - 0.1).abs() < 0.01, "{tenth}: {share}");
        }
        assert_ne!(random_of(1, 2), random_of(2, 1));
    }

    #[test]
    fn a_light_reaches_as_far_as_its_number_says() {
        let light = Light::point(Vec3::ZERO, 100.0, Vec3::new(0.5, 1.0, 0.2));
        for (random, reach_m) in [(1.0, 10.0), (0.25, 20.0), (1e-9, 100.0)] {
            let range_m = with_random_range(&light, 0.01, random).range_m;
            assert!((reach_m..=reach_m * 1.001).contains(&range_m), "{random}: {range_m}");
        }
        let area =
            Light::area(crate::Emitter::rectangle(Vec3::X, Vec3::Y), Vec3::ZERO, 9.0, Vec3::ONE);
        assert_eq!(with_random_range(&area, 1.0, 1.0), area);
        let dark = Light { intensity: Vec3::splat(1e-30), ..light };
        assert_eq!(with_random_range(&dark, 0.01, 1.0).range_m, MIN_RANGE_M);
    }

    #[test]
    fn seeds_change_the_ranges_and_bad_thresholds_are_refused() {
        let gpu = Gpu::noop().expect("a device");
        let everything = || Box::new(Everything::new(&gpu).expect("a strategy"));
        for bad in [0.0, -1.0, f32::NAN, f32::INFINITY] {
            assert!(Stochastic::new(&gpu, everything(), bad).is_err(), "{bad}");
        }
        let lights = [Light::point(Vec3::ZERO, 100.0, Vec3::ONE); 9];
        let lights = LightBuffer::new(&gpu, &lights).expect("lights");
        let view = View::look_at(Vec3::ZERO, Vec3::X, 1.0, 0.1, [64, 48]);
        let mut strategy = Stochastic::new(&gpu, everything(), 0.01).expect("a threshold");
        assert_eq!(strategy.id(), "None/stochastic0.01");
        let mut ranges = |seed| {
            strategy.prepare(&gpu, &Frame::new(&view, &lights).with_seed(seed)).expect("prepares");
            strategy.copy.lights().iter().map(|light| light.range_m).collect::<Vec<_>>()
        };
        let (first, second) = (ranges(1), ranges(2));
        assert!(first != second && ranges(1) == first);
        assert!(first.iter().all(|range_m| (10.0..=100.0).contains(range_m)), "{first:?}");
        let order = LightOrder::Gpu { every: 1 };
        let moving = LightBuffer::ordered(&gpu, lights.lights(), order).expect("lights");
        let error = strategy.prepare(&gpu, &Frame::new(&view, &moving)).expect_err("refuses");
        assert!(error.to_string().contains("lights that the GPU orders or widens"), "{error}");
    }
}
