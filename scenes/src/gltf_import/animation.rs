//! Animated cameras: the tracks of the nodes from the root to the camera, evaluated exactly.

use std::collections::{BTreeSet, HashSet};

use glam::{DMat4, DVec3, Quat, Vec4, Vec4Swizzles};
use gltf::json::{
    animation::{Channel, Interpolation, Property, Sampler},
    validation::Checked,
};

use super::{
    Warnings, area_lights,
    cameras::pose,
    file::File,
    nodes::{Local, Walk},
};
use crate::{Pose, SceneError};

/// A camera whose node, or one above it, is animated.
#[derive(Clone, Debug)]
pub(crate) struct AnimatedNode {
    /// From the root to the camera.
    chain: Vec<Part>,
    /// Where world space begins, in the file's.
    origin: DVec3,
    start_s: f32,
    end_s: f32,
}

#[derive(Clone, Debug)]
struct Part {
    local: Local,
    translation: Option<Track>,
    rotation: Option<Track>,
    scale: Option<Track>,
}

#[derive(Clone, Debug)]
struct Track {
    /// Strictly increasing, seconds.
    times: Vec<f32>,
    /// One per key, three for cubic splines: in-tangent, value, out-tangent.
    values: Vec<Vec4>,
    interpolation: Interpolation,
    is_rotation: bool,
}

/// The nodes that any animation moves, turns or scales.
pub(super) fn targets(file: &File) -> HashSet<usize> {
    let channels = file.root.animations.iter().flat_map(|animation| &animation.channels);
    let moves = |channel: &&Channel| {
        use Property::{Rotation, Scale, Translation};
        matches!(channel.target.path, Checked::Valid(Translation | Rotation | Scale))
    };
    channels.filter(moves).map(|channel| channel.target.node.value()).collect()
}

/// The animation of the camera at the end of `chain`; `None` where nothing moves it. Only the
/// file's first animation that does is read.
pub(super) fn load(
    file: &File,
    chain: &[usize],
    origin: DVec3,
    warnings: &mut Warnings,
) -> Result<Option<AnimatedNode>, SceneError> {
    let moves = |channel: &&Channel| chain.contains(&channel.target.node.value());
    let mut moving = file
        .root
        .animations
        .iter()
        .filter(|animation| animation.channels.iter().any(|channel| moves(&channel)));
    let Some(animation) = moving.next() else {
        return Ok(None);
    };
    if moving.next().is_some() {
        warnings.add("the camera has several animations: the first is used".into());
    }
    let part = |ix: &usize| Part {
        local: Local::of(&file.root.nodes[*ix]),
        translation: None,
        rotation: None,
        scale: None,
    };
    let mut parts: Vec<_> = chain.iter().map(part).collect();
    for channel in animation.channels.iter().filter(moves) {
        let node = channel.target.node.value();
        let Some(part) = chain.iter().position(|ix| *ix == node) else {
            continue;
        };
        let (slot, is_rotation) = match channel.target.path {
            Checked::Valid(Property::Translation) => (&mut parts[part].translation, false),
            Checked::Valid(Property::Rotation) => (&mut parts[part].rotation, true),
            Checked::Valid(Property::Scale) => (&mut parts[part].scale, false),
            _ => continue,
        };
        let sampler = animation.samplers.get(channel.sampler.value()).ok_or_else(|| {
            let accepted = format!("below {}", animation.samplers.len());
            file.invalid("animations channel sampler", channel.sampler.value(), accepted)
        })?;
        *slot = Some(track(file, sampler, is_rotation)?);
    }
    let tracks = || {
        let all = parts.iter().flat_map(|p| [&p.translation, &p.rotation, &p.scale]);
        all.flatten()
    };
    if tracks().next().is_none() {
        return Ok(None);
    }
    let ends = |t: &Track| (t.times[0], t.times[t.times.len() - 1]);
    let start_s = tracks().map(|t| ends(t).0).fold(f32::INFINITY, f32::min);
    let end_s = tracks().map(|t| ends(t).1).fold(f32::NEG_INFINITY, f32::max);
    Ok(Some(AnimatedNode { chain: parts, origin, start_s, end_s }))
}

/// Says which animations are not played: those that move meshes, lights or joints.
pub(super) fn note_unplayed(file: &File, walk: &Walk, warnings: &mut Warnings) {
    let nodes = &file.root.nodes;
    let joints = file.root.skins.iter().flat_map(|skin| &skin.joints);
    let joints: HashSet<usize> = joints.map(gltf::json::Index::value).collect();
    // Whether a node, or one below it, would take something drawn along.
    let mut carries = vec![false; nodes.len()];
    for visit in walk.visits.iter().rev() {
        let node = &nodes[visit.ix];
        let extensions = node.extensions.as_ref();
        let is_light = extensions.is_some_and(|e| {
            e.khr_lights_punctual.is_some() || e.others.contains_key("EXT_lights_area")
        });
        carries[visit.ix] |= node.mesh.is_some()
            || is_light
            || node.extras.as_ref().is_some_and(|e| e.get().contains(area_lights::KEY))
            || joints.contains(&visit.ix);
        if carries[visit.ix]
            && let Some(parent) = walk.parents[visit.ix]
        {
            carries[parent] = true;
        }
    }
    let channels = file.root.animations.iter().flat_map(|animation| &animation.channels);
    let moved: BTreeSet<usize> = channels
        .map(|channel| channel.target.node.value())
        .filter(|ix| carries.get(*ix) == Some(&true))
        .collect();
    let Some(first) = moved.first() else {
        return;
    };
    let name = nodes[*first].name.clone().unwrap_or_else(|| format!("node {first}"));
    warnings.add(format!(
        "animations of meshes and lights are not played: {} animated nodes stay at rest, \
         {name:?} the first",
        moved.len()
    ));
}

fn track(file: &File, sampler: &Sampler, is_rotation: bool) -> Result<Track, SceneError> {
    let interpolation = match sampler.interpolation {
        Checked::Valid(interpolation) => interpolation,
        Checked::Invalid => Interpolation::Linear,
    };
    let times: Vec<f32> = file.floats::<1>(sampler.input)?.into_iter().map(|[t]| t).collect();
    let values: Vec<Vec4> = if is_rotation {
        file.floats::<4>(sampler.output)?.into_iter().map(Vec4::from).collect()
    } else {
        let values = file.floats::<3>(sampler.output)?.into_iter();
        values.map(|[x, y, z]| Vec4::new(x, y, z, 0.0)).collect()
    };
    let increasing = times.windows(2).all(|w| w[0] < w[1]);
    if !increasing || times.iter().any(|t| !t.is_finite()) {
        let field = format!("accessors[{}] (key times)", sampler.input);
        return Err(file.invalid(field, "not increasing", "finite and strictly increasing"));
    }
    let per_key = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    if values.len() != times.len() * per_key {
        let field = format!("accessors[{}].count (keys)", sampler.output);
        let accepted = format!("{}, {per_key} per key", times.len() * per_key);
        return Err(file.invalid(field, values.len(), accepted));
    }
    if values.iter().any(|v| !v.is_finite()) {
        let field = format!("accessors[{}] (keys)", sampler.output);
        return Err(file.invalid(field, "not finite", "finite"));
    }
    Ok(Track { times, values, interpolation, is_rotation })
}

impl AnimatedNode {
    /// The pose at `t` (0..1) of the animation.
    pub(crate) fn pose(&self, t: f32) -> Pose {
        let time = self.start_s + (self.end_s - self.start_s) * t;
        let root = DMat4::from_translation(-self.origin);
        // As `nodes::walk` places what stands still: scales of 0 turn no camera.
        let (place, facing) = self.chain.iter().fold((root, root), |(place, facing), part| {
            let local = part.local(time);
            (place * local.matrix().as_dmat4(), facing * local.facing().as_dmat4())
        });
        pose(&DMat4 { w_axis: place.w_axis, ..facing })
    }
}

impl Part {
    /// The transform at a time.
    fn local(&self, time: f32) -> Local {
        let sample = |track: &Option<Track>| track.as_ref().map(|t| t.sample(time));
        match self.local {
            Local::Matrix(_) => self.local,
            Local::Parts { translation, rotation, scale } => Local::Parts {
                translation: sample(&self.translation).map_or(translation, Vec4::xyz),
                rotation: sample(&self.rotation).map_or(rotation, quaternion),
                scale: sample(&self.scale).map_or(scale, Vec4::xyz),
            },
        }
    }
}

fn quaternion(v: Vec4) -> Quat {
    let unit = v.try_normalize().unwrap_or(Vec4::W);
    Quat::from_vec4(unit)
}

impl Track {
    /// The value at `time`, clamped to the first and last key.
    fn sample(&self, time: f32) -> Vec4 {
        let next = self.times.partition_point(|t| *t <= time);
        let last = self.times.len() - 1;
        if next == 0 || next > last {
            return self.value(if next == 0 { 0 } else { last });
        }
        let span_s = self.times[next] - self.times[next - 1];
        let t = (time - self.times[next - 1]) / span_s;
        let (from, to) = (self.value(next - 1), self.value(next));
        match self.interpolation {
            Interpolation::Step => from,
            Interpolation::Linear if self.is_rotation => {
                Vec4::from(quaternion(from).slerp(quaternion(to), t))
            }
            Interpolation::Linear => from.lerp(to, t),
            Interpolation::CubicSpline => {
                let out_tangent = self.values[(next - 1) * 3 + 2] * span_s;
                let in_tangent = self.values[next * 3] * span_s;
                hermite(from, out_tangent, to, in_tangent, t)
            }
        }
    }

    fn value(&self, key: usize) -> Vec4 {
        match self.interpolation {
            Interpolation::CubicSpline => self.values[key * 3 + 1],
            _ => self.values[key],
        }
    }
}

/// Cubic Hermite spline (glTF 2.0, appendix C.5).
fn hermite(from: Vec4, out_tangent: Vec4, to: Vec4, in_tangent: Vec4, t: f32) -> Vec4 {
    let (t2, t3) = (t * t, t * t * t);
    from * (2.0 * t3 - 3.0 * t2 + 1.0)
        + out_tangent * (t3 - 2.0 * t2 + t)
        + to * (3.0 * t2 - 2.0 * t3)
        + in_tangent * (t3 - t2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(interpolation: Interpolation, values: &[f32], time: f32) -> f32 {
        let track = Track {
            times: vec![1.0, 3.0],
            values: values.iter().map(|v| Vec4::splat(*v)).collect(),
            interpolation,
            is_rotation: false,
        };
        track.sample(time).x
    }

    #[test]
    fn tracks_interpolate_and_clamp() {
        assert_eq!(sample(Interpolation::Linear, &[2.0, 6.0], 2.0), 4.0);
        assert_eq!(sample(Interpolation::Linear, &[2.0, 6.0], 0.0), 2.0);
        assert_eq!(sample(Interpolation::Linear, &[2.0, 6.0], 9.0), 6.0);
        assert_eq!(sample(Interpolation::Step, &[2.0, 6.0], 2.9), 2.0);
        let flat = [0.0, 2.0, 0.0, 0.0, 6.0, 0.0];
        assert_eq!(sample(Interpolation::CubicSpline, &flat, 2.0), 4.0);
        // Tangents of 2 per second over two seconds make the cubic a straight line.
        let line = [2.0, 2.0, 2.0, 2.0, 6.0, 2.0];
        assert_eq!(sample(Interpolation::CubicSpline, &line, 1.5), 3.0);
    }
}
