//! The animation of a scene's lights, as its file gives it.
//!
//! An animated node moves everything below it. So the animated nodes form a tree of *limbs*, and
//! each light hangs on one of them. Still nodes between two limbs, or between a limb and its light,
//! are multiplied together on import.

use assign::{Light, LightShape};
use glam::Vec3;

use crate::animated_node::{Part, Placement, Track};

/// The animation of a scene's lights: points and spots that a glTF file moves by keys.
#[derive(Clone, Debug)]
pub struct LightAnimation {
    /// Parents come before their children.
    pub(crate) limbs: Vec<Limb>,
    pub(crate) lights: Vec<AnimatedLight>,
    /// Times of the first and the last key, in the file's clock.
    pub(crate) start_s: f32,
    pub(crate) end_s: f32,
    pub(crate) scale: f32,
}

/// An animated node.
#[derive(Clone, Debug)]
pub(crate) struct Limb {
    /// The limb above it, or none.
    pub(crate) parent: Option<usize>,
    /// The still nodes between that limb, or world space, and this one.
    pub(crate) base: Placement,
    pub(crate) part: Part,
}

/// A light on an animated node, or below one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct AnimatedLight {
    /// Its index in the scene's lights.
    pub(crate) light: usize,
    /// The limb that it hangs on.
    pub(crate) limb: usize,
    /// The still nodes between the limb and the light.
    pub(crate) from_limb: Placement,
    /// Where its copy of the scene stands, metres.
    pub(crate) offset: Vec3,
}

impl LightAnimation {
    /// The number of lights that it moves.
    pub fn count(&self) -> usize {
        self.lights.len()
    }

    /// Seconds from the first key of any light to the last one; 0 if there is one key only.
    pub fn duration_s(&self) -> f32 {
        self.end_s - self.start_s
    }

    /// Moves the scene's lights to their places at a time. `lights` is a copy of
    /// [`Scene::lights`](crate::Scene::lights), and the other lights in it stay.
    ///
    /// Time 0 is the first key of any light. After the last key of all, the animation starts again.
    /// A light whose own keys begin later or end earlier waits at its first or last one. To play
    /// the animation faster, multiply the time.
    ///
    /// A light whose place is not finite at this time stays.
    pub fn pose_lights(&self, time_s: f32, lights: &mut [Light]) {
        let span_s = self.duration_s();
        let into_s = if span_s > 0.0 { time_s.rem_euclid(span_s) } else { 0.0 };
        let time_s = self.start_s + into_s;
        let mut worlds: Vec<Placement> = Vec::with_capacity(self.limbs.len());
        for limb in &self.limbs {
            let base = match limb.parent {
                Some(parent) => worlds[parent].then(&limb.base),
                None => limb.base,
            };
            worlds.push(base.below(&limb.part.local(time_s)));
        }
        for animated in &self.lights {
            let Some(light) = lights.get_mut(animated.light) else {
                continue;
            };
            let pose = worlds[animated.limb].then(&animated.from_limb).pose();
            let position = pose.eye * self.scale + animated.offset;
            if !(position.is_finite() && pose.forward().is_finite()) {
                continue;
            }
            light.position = position;
            if let LightShape::Spot { direction, .. } = &mut light.shape {
                *direction = pose.forward();
            }
        }
    }

    /// Scaled about the origin, as [`Scene::scaled`](crate::Scene::scaled) does.
    pub(crate) fn scale_by(&mut self, factor: f32) {
        self.scale *= factor;
        for light in &mut self.lights {
            light.offset *= factor;
        }
    }

    /// The same lights again, for a copy of the scene at `offset` whose lights begin at
    /// `first_light`.
    pub(crate) fn copied(
        lights: &[AnimatedLight],
        first_light: usize,
        offset: Vec3,
    ) -> impl Iterator<Item = AnimatedLight> {
        lights.iter().map(move |light| AnimatedLight {
            light: first_light + light.light,
            offset: light.offset + offset,
            ..*light
        })
    }

    /// Feeds everything that it consists of to a hash.
    pub(crate) fn feed(&self, mut floats: impl FnMut(&[f32])) {
        floats(&[self.limbs.len() as f32, self.start_s, self.end_s, self.scale]);
        for limb in &self.limbs {
            floats(&[limb.parent.map_or(-1.0, |parent| parent as f32)]);
            feed_placement(&limb.base, &mut floats);
            floats(&limb.part.still().to_cols_array());
            for track in limb.part.tracks() {
                feed_track(track, &mut floats);
            }
        }
        floats(&[self.lights.len() as f32]);
        for light in &self.lights {
            floats(&[light.light as f32, light.limb as f32]);
            feed_placement(&light.from_limb, &mut floats);
            floats(&light.offset.to_array());
        }
    }
}

fn feed_placement(placement: &Placement, floats: &mut impl FnMut(&[f32])) {
    for matrix in [placement.place, placement.facing] {
        floats(&matrix.as_mat4().to_cols_array());
    }
}

fn feed_track(track: Option<&Track>, floats: &mut impl FnMut(&[f32])) {
    let Some(track) = track else {
        return floats(&[-1.0]);
    };
    floats(&[track.interpolation as u8 as f32, track.times.len() as f32]);
    floats(&track.times);
    for value in &track.values {
        floats(&value.to_array());
    }
}
