//! Cases of lights that change in every frame, which the GPU sorts.

use glam::Vec3;

use super::{
    lights::{Kinds, bad_lights, mix},
    plan::{Lit, Living, Plan, default_view, in_room},
    stage::Rng,
    views,
};
use crate::{Light, LightShape};

/// Frames in which all lights move, some teleport, and their number changes.
pub(super) fn few(rng: &mut Rng, every: u32, from_gpu: bool) -> Plan {
    let stage = in_room(rng, &default_view()).thinned(600);
    let bad: Vec<Light> = bad_lights(&mix(rng, &stage, 1, (0.2, 5.0), Kinds::Points))
        .into_iter()
        .filter(is_bad_record)
        .collect();
    let lights = mix(rng, &stage, 900, (0.2, 5.0), Kinds::Mixed);
    let frames = [700, 640, 900, 0, 820, 33].map(|count| {
        let mut lights = lights[..count].to_vec();
        for (ix, light) in lights.iter_mut().enumerate() {
            let far = if ix % 5 == 0 { 3.0 } else { 0.3 };
            light.position += rng.direction().as_vec3() * far;
        }
        if from_gpu {
            for (ix, light) in bad.iter().enumerate() {
                lights.insert((ix * 13).min(lights.len()), *light);
            }
        }
        Lit { lights, stage: stage.clone(), opaque_only: false }
    });
    let bad = if from_gpu { bad.len() } else { 0 };
    Plan::Living(Living { frames: frames.into(), bad, every, from_gpu })
}

/// Frames in each of which a few lights move, by a metre, and all stay in their slots. A large light stands
/// still: all others stay inside its box, so that groups may stay as they are.
pub(super) fn some(rng: &mut Rng) -> Plan {
    let stage = in_room(rng, &default_view()).thinned(600);
    let mut lights = mix(rng, &stage, 600, (0.2, 3.0), Kinds::Mixed);
    lights[0] = Light::point(lights[0].position, 500.0, Vec3::ONE);
    let frames = (0..7).map(|frame| {
        for light in lights.iter_mut().skip(frame).step_by(200).filter(|_| frame > 0) {
            light.position += rng.direction().as_vec3();
        }
        Lit { lights: lights.clone(), stage: stage.clone(), opaque_only: false }
    });
    Plan::Living(Living { frames: frames.collect(), bad: 0, every: 100, from_gpu: false })
}

/// Few lights that the GPU writes into a buffer with room for so many that their hierarchy has three
/// levels. The other records are faulty. They lie in the middle, so that the lights' slots lie before
/// and behind theirs.
pub(super) fn sparse(rng: &mut Rng) -> Plan {
    let stage = in_room(rng, &views::sized([32, 24])).thinned(60);
    let lights = mix(rng, &stage, 1_500, (0.1, 2.0), Kinds::Points);
    let middle = lights.iter().map(|light| light.position).sum::<Vec3>() / lights.len() as f32;
    let mut all = vec![Light::point(middle, 0.0, Vec3::ONE); THREE_LEVELS];
    let bad = all.len() - lights.len();
    for (place, light) in all.iter_mut().step_by(100).zip(lights) {
        *place = light;
    }
    let frames = vec![Lit { lights: all, stage, opaque_only: false }];
    Plan::Living(Living { frames, bad, every: 1, from_gpu: true })
}

/// Lights whose hierarchy has three levels.
const THREE_LEVELS: usize = 262_145;

/// Whether a light's record shows its fault. The record has the square of a distance, which hides
/// its sign.
fn is_bad_record(light: &Light) -> bool {
    !matches!(light.shape, LightShape::Vpl { min_distance_m, .. } if min_distance_m < 0.0)
}

/// Frames of so many lights that their hierarchy has two levels. The buffer has room for a quarter
/// more.
pub(super) fn many(rng: &mut Rng) -> Plan {
    let stage = in_room(rng, &views::sized([32, 24])).thinned(100);
    let lights = mix(rng, &stage, 14_000, (0.05, 0.8), Kinds::Points);
    let frames = [14_000, 13_500].map(|count| {
        let mut lights = lights[..count].to_vec();
        for light in &mut lights {
            light.position += rng.direction().as_vec3() * 0.1;
        }
        Lit { lights, stage: stage.clone(), opaque_only: false }
    });
    Plan::Living(Living { frames: frames.into(), bad: 0, every: 2, from_gpu: false })
}
