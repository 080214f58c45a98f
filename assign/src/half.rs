//! Lists for lights in half precision, as renderers pack them: **a flaw that loses lights**, to show what it does.
//!
//! # Idea
//!
//! Some renderers save bandwidth: culling reads the positions and ranges of lights as floats of 16 bits, while shading
//! reads them as floats of 32 bits. A half float has 11 significant bits. So 10 m from the origin a position moves by
//! up to 4 mm, 1 km from it by up to 25 cm, and beyond 65,504 m there is no half float.
//!
//! # Where it fails
//!
//! A light that moves away from a group leaves the group's list, though it still reaches the group. Near the origin
//! only the rim of its ball is lost, where the light has almost ended. Far from the origin, groups lose light of any
//! brightness, and the edges of tiles show.

use crate::{
    AssignError, Assignment, Frame, Gpu, Light, LightBuffer, LightShape, MAX_RANGE_M, MIN_RANGE_M,
    Passes, leave_to_inner,
};

/// A strategy that makes its lists for positions and ranges in half precision. Shading reads those of the frame.
pub struct Half {
    inner: Box<dyn Assignment>,
    /// The lights in half precision, in the places of the frame's lights.
    copy: LightBuffer,
}

impl Half {
    /// Wraps a strategy.
    pub fn new(gpu: &Gpu, inner: Box<dyn Assignment>) -> Result<Self, AssignError> {
        Ok(Self { inner, copy: LightBuffer::new(gpu, &[])? })
    }
}

/// The nearest half float, ties to even; infinite from 65,520 on.
fn half(number: f32) -> f32 {
    /// The least half float with 11 significant bits, 2^-14, and the step of smaller ones, 2^-24.
    const LEAST_NORMAL: f32 = 6.103_515_6e-5;
    const STEP: f32 = 5.960_464_5e-8;
    /// Bits of a float that a half float lacks.
    const LOST_BITS: u32 = 13;
    let size = number.abs();
    if size < LEAST_NORMAL {
        return (number / STEP).round_ties_even() * STEP;
    }
    if !number.is_finite() || size >= 65_520.0 {
        return f32::INFINITY.copysign(number);
    }
    let bits = number.to_bits();
    let is_odd = (bits >> LOST_BITS) & 1;
    let rounded = bits + (1 << (LOST_BITS - 1)) - 1 + is_odd;
    f32::from_bits(rounded >> LOST_BITS << LOST_BITS)
}

/// The light as culling reads it. One whose position has no half float reaches nothing.
fn in_half_precision(light: &Light) -> Light {
    let position = glam::Vec3::from(light.position.to_array().map(half));
    if !position.is_finite() {
        return Light { range_m: MIN_RANGE_M, shape: LightShape::Point, ..*light };
    }
    let range_m = half(light.range_m).clamp(MIN_RANGE_M, MAX_RANGE_M);
    let rounded = Light { position, range_m, ..*light };
    // A faulty light would be set aside, and all others would change their places.
    if rounded.check().is_ok() { rounded } else { *light }
}

impl Assignment for Half {
    fn id(&self) -> String {
        format!("{}/half", self.inner.id())
    }

    leave_to_inner!(needs, is_view_bound, compile, lookup, bind_group, lists);

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Self::new(gpu, self.inner.for_view(gpu)?)?))
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        let lights = frame.lights_by_slot(self.id(), "rounds the lights of a frame")?;
        let rounded: Vec<Light> = lights.iter().map(in_half_precision).collect();
        self.copy.update(gpu, &rounded)?;
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
    use crate::{Emitter, Everything, LightOrder, View};

    #[test]
    fn numbers_round_to_the_nearest_half_float() {
        for (number, nearest) in [
            (0.0, 0.0),
            (1.0, 1.0),
            // Half floats at 1 are 2^-10 apart: ties go to the even one.
            (1.0 + 1.0 / 2_048.0, 1.0),
            (1.0 + 3.0 / 2_048.0, 1.0 + 2.0 / 1_024.0),
            (-1_000.3, -1_000.5),
            (2_049.0, 2_048.0),
            (2_051.0, 2_052.0),
            (65_519.9, 65_504.0),
            (65_520.0, f32::INFINITY),
            (-1e9, f32::NEG_INFINITY),
            // The least half float is 2^-24.
            (5.0e-8, 5.960_464_5e-8),
            (2.0e-8, 0.0),
        ] {
            assert_eq!(half(number), nearest, "{number}");
        }
        assert!(half(f32::NAN).is_infinite());
        // Relative error of 2^-11 at most where half floats have all bits.
        for exponent in -14..16 {
            for step in 0..100 {
                let number = 2_f32.powi(exponent) * (1.0 + step as f32 / 100.0);
                let error = (half(number) - number).abs() / number;
                assert!(error <= 1.0 / 2_048.0 || number > 65_504.0, "{number}: {error}");
            }
        }
    }

    #[test]
    fn lights_keep_their_places_and_what_has_no_half_float_reaches_nothing() {
        let gpu = Gpu::noop().expect("a device");
        let near = Light::point(Vec3::new(10.003, 0.0, -7.0), 2.000_4, Vec3::ONE);
        let far = Light { position: Vec3::new(1e5, 0.0, 0.0), ..near };
        let tiny = Light { range_m: 2e-6, ..near };
        let area = Light::area(Emitter::rectangle(Vec3::X, Vec3::Y), Vec3::ZERO, 9.001, Vec3::ONE);
        let lights = LightBuffer::new(&gpu, &[far, near, tiny, area]).expect("lights");
        let view = View::look_at(Vec3::ZERO, Vec3::X, 1.0, 0.1, [64, 48]);
        let everything = Box::new(Everything::new(&gpu).expect("a strategy"));
        let mut strategy = Half::new(&gpu, everything).expect("a strategy");
        assert_eq!(strategy.id(), "None/half");
        strategy.prepare(&gpu, &Frame::new(&view, &lights)).expect("prepares");
        let read = strategy.copy.lights();
        let ranges: Vec<f32> = read.iter().map(|light| light.range_m).collect();
        assert_eq!(ranges, [MIN_RANGE_M, 2.0, 2.026_558e-6, 9.0]);
        assert_eq!((read[0].position, read[1].position.x), (far.position, 10.0));
        let order = LightOrder::Gpu { every: 1 };
        let moving = LightBuffer::ordered(&gpu, lights.lights(), order).expect("lights");
        let error = strategy.prepare(&gpu, &Frame::new(&view, &moving)).expect_err("refuses");
        assert!(error.to_string().contains("lights that the GPU orders or widens"), "{error}");
    }
}
