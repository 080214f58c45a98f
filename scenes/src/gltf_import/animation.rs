//! Reads the animation of a camera: the tracks of the nodes from the root to the camera.

use std::collections::{BTreeSet, HashSet};

use glam::{DVec3, Vec4};
use gltf::json::{
    animation::{Channel, Interpolation, Property, Sampler},
    validation::Checked,
};

use super::{Warnings, area_lights, file::File, walk::Walk};
use crate::{
    SceneError,
    animated_node::{AnimatedNode, Local, Part, Track},
};

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
/// file's first animation that moves it is read.
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
        warnings.add("the camera has several animations: only the first is used".into());
    }
    let part = |ix: &usize| Part {
        local: Local::from_node(&file.root.nodes[*ix]),
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

/// Warns about animations that are not played: those that move meshes, lights or joints.
pub(super) fn note_unplayed(file: &File, walk: &Walk, warnings: &mut Warnings) {
    let nodes = &file.root.nodes;
    let joints = file.root.skins.iter().flat_map(|skin| &skin.joints);
    let joints: HashSet<usize> = joints.map(gltf::json::Index::value).collect();
    // Whether something drawn is attached to a node or to a node below it.
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
        "animations of meshes and lights are not played: {} animated nodes stay at rest; \
         the first is {name:?}",
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
