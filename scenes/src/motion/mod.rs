//! Lights that move: laws that give every light at any time.
//!
//! Most lights of a game move, flicker, appear and vanish. A strategy that builds anything from the
//! lights has to build it again then, and must not count on where they were.
//!
//! A law is a pure function of seed, index, light and time. So any frame can be computed alone, in
//! any order and on any number of threads, with the same bits. Seven laws exist ([`MotionLaw`]):
//!
//! | law | position | intensity | direction | exists |
//! |---|---|---|---|---|
//! | `drift` | two waves per axis, up to `speed` | | | always |
//! | `orbit` | a circle, at `speed` | | | always |
//! | `teleport` | as drift; 1 in 4 also jumps, every 0.5 to 1 diagonals / `speed` | | | always |
//! | `flicker` | | up to `speed` swings and `2 speed` jumps a second | | always |
//! | `births` | another one in each life | | | 3/4 of a life of 0.5 to 1 diagonals / `speed` |
//! | `turn` | | | `speed` radians a second | always |
//! | `all` | by index, one of the six | | | |
//!
//! The radius of drifting and orbiting is 1/64 to 1/32 of the diagonal of the box. At a wall,
//! drifting and orbiting lights bounce off. Until its first jump or death, a light is where it was
//! given. `law.rs` holds the arithmetic, in a form that shaders can repeat: `shading::MovingLights`
//! moves lights on the GPU.
//!
//! Positions never leave the box: a light outside is moved to the closest point in it first. The
//! middle of an area light is its position, so its rim may stick out. At speed 0 all lights are
//! exactly those given. Faulty lights with a number that is not finite also stay as they are, so
//! that uploading reports them.

mod constants;
mod kind;
mod law;
#[cfg(test)]
mod tests;

use assign::{Light, LightShape};
use glam::{Mat3, Vec3};
use rayon::prelude::*;

use crate::{Aabb, SceneError, error::one_line};

pub use constants::motion_constants;
pub use kind::MotionLaw;
pub use law::{Clock as MotionClock, Rules as MotionRules};

/// The largest accepted speed, metres per second.
pub const MAX_SPEED_M_S: f32 = 1e6;

/// The latest time, seconds. Later times count as this one.
pub const MAX_TIME_S: f32 = 1e6;

/// The largest accepted coordinate of the box, metres.
const MAX_PLACE_M: f32 = 1e12;

/// A law of motion with its parameters.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    law: MotionLaw,
    rules: law::Rules,
}

impl Motion {
    /// A law for lights in `bounds`. One seed gives one motion.
    ///
    /// # Errors
    ///
    /// [`SceneError::OutOfRange`] unless the speed is 0 to [`MAX_SPEED_M_S`] and the box is not
    /// empty, with coordinates of at most 1e12 metres.
    pub fn new(
        law: MotionLaw,
        speed_m_s: f32,
        seed: u64,
        bounds: Aabb,
    ) -> Result<Self, SceneError> {
        if !(0.0..=MAX_SPEED_M_S).contains(&speed_m_s) {
            return Err(SceneError::OutOfRange {
                field: "speed of lights",
                value: speed_m_s.to_string(),
                accepted: "between 0 and 1000000 metres per second",
            });
        }
        let Aabb { min, max } = bounds;
        let largest = min.abs().max(max.abs());
        if bounds.is_empty() || !largest.cmple(Vec3::splat(MAX_PLACE_M)).all() {
            return Err(SceneError::OutOfRange {
                field: "bounds of moving lights",
                value: one_line(format_args!("{min} to {max}")),
                accepted: "within 1e12 metres, with min at most max",
            });
        }
        let diagonal_m = bounds.diagonal();
        let seed = law::seed_word(seed);
        Ok(Self { law, rules: law::Rules { seed, speed_m_s, min, max, diagonal_m } })
    }

    /// The law.
    pub fn law(&self) -> MotionLaw {
        self.law
    }

    /// The speed, metres per second.
    pub fn speed_m_s(&self) -> f32 {
        self.rules.speed_m_s
    }

    /// What a shader needs to repeat the laws, besides [`motion_constants`].
    pub fn rules(&self) -> MotionRules {
        self.rules
    }

    /// A time as the laws read it. It is limited to 0 to [`MAX_TIME_S`]; a NaN counts as 0.
    pub fn clock(time_s: f32) -> MotionClock {
        law::clock(if time_s > 0.0 { time_s.min(MAX_TIME_S) } else { 0.0 })
    }

    /// The box that holds the position of every light at any time, unless the speed is 0.
    pub fn reach(&self) -> Aabb {
        Aabb::new(self.rules.min, self.rules.max)
    }

    /// The light with this index at a time of 0 to [`MAX_TIME_S`]; `None` while it is dead.
    pub fn light_at(&self, index: u32, light: &Light, time_s: f32) -> Option<Light> {
        if !self.moves(light) {
            return Some(*light);
        }
        let clock = Self::clock(time_s);
        let change = law::change(&self.rules, self.law, index, light.position, clock);
        if !change.is_alive {
            return None;
        }
        let intensity = law::dimmed(light.intensity, change.brightness);
        let shape = if change.turn == law::NO_TURN {
            light.shape
        } else {
            turned(light.shape, &change.turn)
        };
        Some(Light { position: change.position, intensity, shape, ..*light })
    }

    /// Fills `out` with the lights that are alive at a time, in ascending index.
    pub fn lights_at(&self, lights: &[Light], time_s: f32, out: &mut Vec<Light>) {
        out.clear();
        let at = |(ix, light): (usize, &Light)| self.light_at(ix as u32, light, time_s);
        out.par_extend(lights.par_iter().enumerate().filter_map(at));
    }

    /// A bound on how far a light's support moves within `dt_s` seconds, metres. Its support then
    /// lies inside its support before, grown by this bound. It is infinite for lights that jump, or
    /// that die and are born.
    pub fn farthest_m(&self, index: u32, light: &Light, dt_s: f32) -> f32 {
        if !self.moves(light) {
            return 0.0;
        }
        let way_m = self.way_m(dt_s);
        let radius_m = law::radius_m(&self.rules, index);
        // Positions are rounded to f32 a few times; amplitudes are rounded with their waves.
        let rounding_m = 2e-6 * (self.reach_m() + radius_m);
        match law::law_of(&self.rules, self.law, index) {
            // The corners of a cube of half side `radius`, and the ends of a diameter.
            MotionLaw::Drift => way_m.min(2.0 * 3.0_f32.sqrt() * radius_m) + rounding_m,
            MotionLaw::Orbit => way_m.min(2.0 * radius_m) + rounding_m,
            MotionLaw::Teleport if law::jumps(&self.rules, index) => f32::INFINITY,
            MotionLaw::Teleport => way_m.min(2.0 * 3.0_f32.sqrt() * radius_m) + rounding_m,
            MotionLaw::Flicker | MotionLaw::All => 0.0,
            MotionLaw::Births => f32::INFINITY,
            MotionLaw::Turn if light.shape == LightShape::Point => 0.0,
            // A point at the end of a lever goes at most the angle times the lever's length.
            MotionLaw::Turn => (way_m.min(2.0) + 2e-6) * light.radius_m(),
        }
    }

    /// A bound on how far the ball around any light's support moves between two times, metres; `None` if
    /// lights jump, or die and are born. It allows for shaders that repeat the laws less accurately.
    pub fn farthest_ball_m(&self, from_s: f32, to_s: f32) -> Option<f32> {
        let most_s = from_s.abs().max(to_s.abs()).min(MAX_TIME_S);
        // Positions are rounded to f32 a few times, and a shader's time is off by 1e-7 of it.
        let rounding_m = 4e-6 * self.reach_m() + 2.5e-7 * self.rules.speed_m_s * most_s;
        match self.law {
            _ if self.rules.speed_m_s == 0.0 || from_s == to_s => Some(0.0),
            MotionLaw::Drift | MotionLaw::Orbit => Some(self.way_m(to_s - from_s) + rounding_m),
            // The ball of an area light that turns is rounded.
            MotionLaw::Flicker | MotionLaw::Turn => Some(rounding_m),
            MotionLaw::Teleport | MotionLaw::Births | MotionLaw::All => None,
        }
    }

    /// The way at the speed of the law, metres, rounded up. Within a second, time is accurate to
    /// 2^-24 of it.
    fn way_m(&self, dt_s: f32) -> f32 {
        self.rules.speed_m_s * (dt_s.abs() * 1.0001 + 2.5e-7)
    }

    /// The largest coordinate of the box, metres.
    fn reach_m(&self) -> f32 {
        self.rules.min.abs().max(self.rules.max.abs()).max_element()
    }

    fn moves(&self, light: &Light) -> bool {
        let is_finite =
            light.position.is_finite() && light.range_m.is_finite() && light.intensity.is_finite();
        self.rules.speed_m_s > 0.0 && is_finite
    }
}

/// A shape, rotated about its light's position.
fn turned(shape: LightShape, turn: &law::Turn) -> LightShape {
    let turned = |v| law::turned(v, turn);
    match shape {
        LightShape::Point => LightShape::Point,
        LightShape::Spot { direction, inner_angle, outer_angle } => {
            LightShape::Spot { direction: turned(direction), inner_angle, outer_angle }
        }
        LightShape::Vpl { normal, min_distance_m } => {
            LightShape::Vpl { normal: turned(normal), min_distance_m }
        }
        LightShape::Area(emitter) => {
            let [x, y, z] = Vec3::AXES.map(turned);
            LightShape::Area(emitter.turned(&Mat3::from_cols(x, y, z)))
        }
    }
}
