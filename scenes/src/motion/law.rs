//! The arithmetic of the laws of motion, in u32 and f32 only.
//!
//! The shader `motion_law.wesl` of crate `shading` repeats this file, with the constants that
//! `constants.rs` passes to it. Every function is pure. The laws use hashes instead
//! of tables, and add, multiply, divide, square root, floor, min and max of f32. [`sine`] is a
//! polynomial, because the accuracy of a built-in `sin` differs between platforms.
//!
//! # Time
//!
//! At a million seconds f32 has lost the phase of any fast wave. So [`Clock`] splits the time, which
//! is exact, and [`beat`] counts turns in fixed point: 2^32 steps per turn, which wrap around.

use std::f32::consts::TAU;

use glam::Vec3;

use super::MotionLaw;
use crate::noise::mix;

/// What all lights of a motion have in common, as a shader's uniform holds it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rules {
    /// The 32 bits of the seed that the laws use.
    pub seed: u32,
    /// The speed, metres per second. At 0 the laws must not be used: all lights stay.
    pub speed_m_s: f32,
    /// The lowest corner of the box of the lights' positions, metres.
    pub min: Vec3,
    /// The highest corner of that box, metres.
    pub max: Vec3,
    /// The diagonal of that box, metres.
    pub diagonal_m: f32,
}

/// What a law does to a light at a moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Change {
    pub(super) position: Vec3,
    /// Factor on the intensity, above 0 and at most 1.
    pub(super) brightness: f32,
    pub(super) turn: Turn,
    pub(super) is_alive: bool,
}

/// A rotation around a unit axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Turn {
    pub(super) axis: Vec3,
    pub(super) sin: f32,
    pub(super) cos: f32,
}

/// A time, split into whole seconds and the rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clock {
    /// Whole seconds.
    pub whole_s: u32,
    /// The rest, 0 to below 1 second.
    pub part_s: f32,
}

/// How often something has turned, and how far into the next turn it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Beat {
    /// Whole turns.
    pub(super) count: u32,
    /// 2^32 make a turn.
    pub(super) phase: u32,
}

/// The largest radius of drifting and orbiting, as a share of the box's diagonal.
pub(super) const WANDER_SHARE: f32 = 1.0 / 32.0;

/// The way of a drifting light per turn of its first wave, in amplitudes: `2 pi * sqrt(3) *
/// (WAVE[0] + WAVE[1] * WAVE_RATIO)` for the fastest moment of all three axes, rounded up.
pub(super) const DRIFT_WAY: f32 = 15.3;

/// Amplitudes of the two waves that drifting adds per axis. Their sum is 1.
pub(super) const WAVE: [f32; 2] = [0.75, 0.25];

/// Frequency of the second wave over that of the first: 1 plus the golden ratio, so that the sum
/// hardly repeats.
pub(super) const WAVE_RATIO: f32 = 2.618;

/// One in this many lights jumps under [`MotionLaw::Teleport`].
pub(super) const JUMPERS: u32 = 4;

/// The way per jump, and the shortest way per life, as a share of the box's diagonal.
pub(super) const JUMP_SHARE: f32 = 0.5;

/// A light is dead in the last quarter of each life's turn.
pub(super) const DEATH: u32 = 0xc000_0000;

/// The most turns per second.
pub(super) const MAX_HZ: f32 = 1_048_576.0;

/// Coefficients of [`sine`], lowest power first. Hastings 1955, "Approximations for digital
/// computers", sheet 16: `sin(pi/2 x)` for -1 to 1.
pub(super) const SINE: [f32; 5] =
    [1.570_796_4, -0.645_963_7, 0.079_689_68, -0.004_673_765_6, 0.000_151_484_19];

/// 2^32.
pub(super) const STEPS: f32 = 4_294_967_296.0;

// Streams of random values. Values of vectors take three streams.
pub(super) const AMPLITUDE: u32 = 1;
pub(super) const PACE: u32 = 2;
pub(super) const START: u32 = 5;
pub(super) const AXIS: u32 = 11;
pub(super) const JUMPS: u32 = 13;
pub(super) const PLACE: u32 = 14;
pub(super) const LEVEL: u32 = 17;
pub(super) const LAW: u32 = 18;

/// The change of a light with this index, whose own place is `place`.
pub(super) fn change(
    rules: &Rules,
    law: MotionLaw,
    index: u32,
    place: Vec3,
    clock: Clock,
) -> Change {
    let place = place.max(rules.min).min(rules.max);
    let mut change = Change { position: place, brightness: 1.0, turn: NO_TURN, is_alive: true };
    match law_of(rules, law, index) {
        MotionLaw::Drift => change.position = drift(rules, index, place, clock),
        MotionLaw::Orbit => change.position = orbit(rules, index, place, clock),
        MotionLaw::Teleport => {
            let home = if jumps(rules, index) {
                let jump = beat(clock, jump_hz(rules, index), draw(rules, index, START));
                place_of(rules, index, place, jump.count)
            } else {
                place
            };
            change.position = drift(rules, index, home, clock);
        }
        MotionLaw::Flicker => change.brightness = flicker(rules, index, clock),
        MotionLaw::Births => {
            let life = beat(clock, jump_hz(rules, index), draw(rules, index, START));
            change.position = place_of(rules, index, place, life.count);
            change.is_alive = life.phase < DEATH;
        }
        MotionLaw::Turn => change.turn = turn(rules, index, clock),
        MotionLaw::All => {}
    }
    change
}

/// The law that moves a light: under [`MotionLaw::All`], a random one of the other six.
pub(super) fn law_of(rules: &Rules, law: MotionLaw, index: u32) -> MotionLaw {
    if law != MotionLaw::All {
        return law;
    }
    match draw(rules, index, LAW) % 6 {
        0 => MotionLaw::Drift,
        1 => MotionLaw::Orbit,
        2 => MotionLaw::Teleport,
        3 => MotionLaw::Flicker,
        4 => MotionLaw::Births,
        _ => MotionLaw::Turn,
    }
}

/// Whether a light jumps under [`MotionLaw::Teleport`].
pub(super) fn jumps(rules: &Rules, index: u32) -> bool {
    draw(rules, index, JUMPS).is_multiple_of(JUMPERS)
}

/// Radius of drifting and orbiting: `diagonal / 32`, times 0.5 to 1.
pub(super) fn radius_m(rules: &Rules, index: u32) -> f32 {
    WANDER_SHARE * rules.diagonal_m * (0.5 + 0.5 * unit(draw(rules, index, AMPLITUDE)))
}

/// Two sine waves per axis: `r * (0.75 sin(2 pi f t + a) + 0.25 sin(2 pi 2.618 f t + b))`, with `f`
/// different for each axis. The fastest moment has the speed of the rules.
fn drift(rules: &Rules, index: u32, place: Vec3, clock: Clock) -> Vec3 {
    let radius = radius_m(rules, index);
    let hz = hz_of(rules.speed_m_s, DRIFT_WAY * radius);
    let wave = |axis: u32| {
        let own_hz = hz * (0.5 + 0.5 * unit(draw(rules, index, PACE + axis)));
        let slow = beat(clock, own_hz, draw(rules, index, START + axis));
        let fast = beat(clock, own_hz * WAVE_RATIO, draw(rules, index, START + 3 + axis));
        WAVE[0] * sine(slow.phase) + WAVE[1] * sine(fast.phase)
    };
    let offset = radius * Vec3::new(wave(0), wave(1), wave(2));
    reflected(rules, place, offset, radius)
}

/// A circle in a random plane: `r * (cos(a) x + sin(a) y)`, at the speed of the rules.
fn orbit(rules: &Rules, index: u32, place: Vec3, clock: Clock) -> Vec3 {
    let radius = radius_m(rules, index);
    let hz = hz_of(rules.speed_m_s, TAU * radius);
    let phase = beat(clock, hz, draw(rules, index, START)).phase;
    let normal = axis(rules, index);
    // Two vectors at right angles to the normal and to each other (Duff et al. 2017, "Building an
    // orthonormal basis, revisited").
    let sign = if normal.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (sign + normal.z);
    let b = normal.x * normal.y * a;
    let x = Vec3::new(1.0 + sign * normal.x * normal.x * a, sign * b, -sign * normal.x);
    let y = Vec3::new(b, sign + normal.y * normal.y * a, -normal.y);
    let offset = radius * (cosine(phase) * x + sine(phase) * y);
    reflected(rules, place, offset, radius)
}

/// `level * (0.75 + 0.25 sin(2 pi f t + a))`. The level is 0.125 to 1 and jumps twice in a turn of
/// the fastest wave. `f` is 0.5 to 1 turn per metre of speed.
fn flicker(rules: &Rules, index: u32, clock: Clock) -> f32 {
    let hz = hz_of(rules.speed_m_s, 1.0);
    let own_hz = hz * (0.5 + 0.5 * unit(draw(rules, index, PACE)));
    let wave = beat(clock, own_hz, draw(rules, index, START)).phase;
    let step = beat(clock, 2.0 * own_hz, draw(rules, index, START + 1)).count;
    let level = 0.125 + 0.875 * unit(mix(draw(rules, index, LEVEL) ^ mix(step)));
    level * (0.75 + 0.25 * sine(wave))
}

/// Turns around a random axis by `speed` radians per second: a point one metre from the axis has
/// the speed of the rules.
fn turn(rules: &Rules, index: u32, clock: Clock) -> Turn {
    let phase = beat(clock, hz_of(rules.speed_m_s, TAU), draw(rules, index, START)).phase;
    Turn { axis: axis(rules, index), sin: sine(phase), cos: cosine(phase) }
}

/// Jumps or lives per second: one per 0.5 to 1 diagonal of the box at the speed of the rules.
fn jump_hz(rules: &Rules, index: u32) -> f32 {
    let way_m = JUMP_SHARE * rules.diagonal_m * (1.0 + unit(draw(rules, index, PACE)));
    hz_of(rules.speed_m_s, way_m)
}

/// The place after a number of jumps: its own before the first one, then random ones in the box.
fn place_of(rules: &Rules, index: u32, place: Vec3, count: u32) -> Vec3 {
    if count == 0 {
        return place;
    }
    let share = |axis: u32| unit(mix(draw(rules, index, PLACE + axis) ^ mix(count)));
    let shares = Vec3::new(share(0), share(1), share(2));
    (rules.min + shares * (rules.max - rules.min)).max(rules.min).min(rules.max)
}

/// `place + offset`, which bounces off the walls of the box. The offset is at most `radius` per axis;
/// it shrinks along axes where the box is thinner than twice that, so that one bounce is enough.
fn reflected(rules: &Rules, place: Vec3, offset: Vec3, radius: f32) -> Vec3 {
    let half = 0.5 * (rules.max - rules.min);
    let fit = (half / radius.max(1e-30)).min(Vec3::ONE);
    let at = place + offset * fit;
    let below = (rules.min - at).max(Vec3::ZERO);
    let above = (at - rules.max).max(Vec3::ZERO);
    (at + 2.0 * below - 2.0 * above).max(rules.min).min(rules.max)
}

/// The intensity times a brightness. No channel falls from above 0 to 0.
pub(super) fn dimmed(intensity: Vec3, brightness: f32) -> Vec3 {
    (intensity * brightness).max(intensity.min(Vec3::splat(1e-30)))
}

/// Rodrigues' rotation: `v cos + (axis x v) sin + axis (axis . v) (1 - cos)`.
pub(super) fn turned(v: Vec3, turn: &Turn) -> Vec3 {
    let Turn { axis, sin, cos } = *turn;
    v * cos + axis.cross(v) * sin + axis * (axis.dot(v) * (1.0 - cos))
}

/// The rotation that leaves everything where it is.
pub(super) const NO_TURN: Turn = Turn { axis: Vec3::Z, sin: 0.0, cos: 1.0 };

/// A random unit vector, uniform on the sphere.
fn axis(rules: &Rules, index: u32) -> Vec3 {
    let z = 1.0 - 2.0 * unit(draw(rules, index, AXIS));
    let around = draw(rules, index, AXIS + 1);
    let out = (1.0 - z * z).max(0.0).sqrt();
    Vec3::new(out * cosine(around), out * sine(around), z)
}

/// Turns per second of something that goes `way_m` per turn.
fn hz_of(speed_m_s: f32, way_m: f32) -> f32 {
    (speed_m_s / way_m.max(1e-30)).min(MAX_HZ)
}

/// Splits a time of 0 to 2^24 seconds.
pub(super) fn clock(time_s: f32) -> Clock {
    let whole = time_s.floor();
    Clock { whole_s: whole as u32, part_s: time_s - whole }
}

/// Turns after a time, at `hz` turns per second from the phase `start`.
///
/// `hz = whole_hz + part_hz`, so `hz * time` is the sum of `whole_hz * whole_s`, which is a whole
/// number, `part_hz * whole_s` in fixed point, and `hz * part_s`. Only the last one is rounded.
pub(super) fn beat(clock: Clock, hz: f32, start: u32) -> Beat {
    let whole_hz = hz.floor();
    let step = ((hz - whole_hz) * STEPS) as u32;
    let within = hz * clock.part_s;
    let whole_within = within.floor();
    let long = clock.whole_s.wrapping_mul(step);
    let short = ((within - whole_within) * STEPS) as u32;
    let sum = long.wrapping_add(short);
    let phase = sum.wrapping_add(start);
    let carries = u32::from(sum < long) + u32::from(phase < sum);
    let count = (whole_hz as u32)
        .wrapping_mul(clock.whole_s)
        .wrapping_add(mul_high(clock.whole_s, step))
        .wrapping_add(whole_within as u32)
        .wrapping_add(carries);
    Beat { count, phase }
}

/// The upper 32 bits of a product, by halves: shaders have no wider integers.
fn mul_high(a: u32, b: u32) -> u32 {
    let (a0, a1, b0, b1) = (a & 0xffff, a >> 16, b & 0xffff, b >> 16);
    let upper = a1 * b0 + ((a0 * b0) >> 16);
    let lower = a0 * b1 + (upper & 0xffff);
    a1 * b1 + (upper >> 16) + (lower >> 16)
}

/// The sine of a phase, to 1e-7.
pub(super) fn sine(phase: u32) -> f32 {
    // Quarter turns from -2 to below 2, exact.
    let quarters = (phase.cast_signed() >> 8) as f32 / 4_194_304.0;
    let x = if quarters > 1.0 {
        2.0 - quarters
    } else if quarters < -1.0 {
        -2.0 - quarters
    } else {
        quarters
    };
    let x2 = x * x;
    let tail = SINE[2] + x2 * (SINE[3] + x2 * SINE[4]);
    let sine = x * (SINE[0] + x2 * (SINE[1] + x2 * tail));
    sine.clamp(-1.0, 1.0)
}

/// The cosine of a phase: the sine a quarter turn later.
pub(super) fn cosine(phase: u32) -> f32 {
    sine(phase.wrapping_add(0x4000_0000))
}

/// A random value of a light. Every stream is independent of the others.
fn draw(rules: &Rules, index: u32, stream: u32) -> u32 {
    let light = mix(index.wrapping_mul(0x9e37_79b9).wrapping_add(rules.seed));
    mix(light ^ stream.wrapping_mul(0x85eb_ca77))
}

/// A random value as a number from 0 to below 1, exact.
fn unit(value: u32) -> f32 {
    (value >> 8) as f32 / 16_777_216.0
}

/// The 32 bits of a seed that the laws use.
pub(super) fn seed_word(seed: u64) -> u32 {
    mix((seed as u32) ^ mix((seed >> 32) as u32 ^ 0x9e37_79b9))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beats_are_those_of_exact_arithmetic() {
        for hz in [1e-6_f32, 0.3, 1.0, 7.77, 1234.567, 1e6] {
            for time_s in [0.0_f32, 1e-3, 0.999, 1.0, 77.3, 12_345.678, 1e6] {
                for start in [0, 0x4000_0000, u32::MAX] {
                    let beat = beat(clock(time_s), hz, start);
                    let exact =
                        f64::from(hz) * f64::from(time_s) + f64::from(start) / 2f64.powi(32);
                    let turns = f64::from(beat.count) + f64::from(beat.phase) / 2f64.powi(32);
                    // The count wraps around, as the exact number of turns does here.
                    let off = (turns - exact).rem_euclid(2f64.powi(32));
                    let off = off.min(2f64.powi(32) - off);
                    // A step of 2^-32 turns per second, and the rounding of `hz * part_s`.
                    let most = f64::from(time_s) * 2f64.powi(-32) + f64::from(hz) * 2f64.powi(-24);
                    assert!(off <= most + 1e-9, "{hz} Hz, {time_s} s, {start}: {off} of {most}");
                }
            }
        }
    }

    #[test]
    fn the_polynomial_is_the_sine() {
        for ix in 0..100_000_u32 {
            let phase = ix.wrapping_mul(2_654_435_761);
            let angle = f64::from(phase) / 2f64.powi(32) * std::f64::consts::TAU;
            // A phase has 24 bits left, and 2^-24 turns are 4e-7 radians.
            assert!((f64::from(sine(phase)) - angle.sin()).abs() < 6e-7, "{phase}");
            assert!((f64::from(cosine(phase)) - angle.cos()).abs() < 6e-7, "{phase}");
        }
        assert_eq!((sine(0), sine(0x4000_0000), cosine(0)), (0.0, 1.0, 1.0));
        for (a, b) in [(u32::MAX, u32::MAX), (0x1234_5678, 0x9abc_def0), (7, 9)] {
            assert_eq!(u64::from(mul_high(a, b)), (u64::from(a) * u64::from(b)) >> 32);
        }
    }
}
