//! Reads the animation of a camera: the tracks of the nodes from the root to the camera. Names the
//! animations that nothing plays.

use std::collections::{BTreeSet, HashSet};

use glam::{DVec3, Vec4};
use gltf::json::{
    animation::{Channel, Interpolation, Property, Sampler},
    validation::Checked,
};

use super::{Warnings, area_lights, file::File, punctual, walk::Walk};
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
    let moves = |channel: &Channel| chain.contains(&channel.target.node.value());
    let mut moving = file
        .root
        .animations
        .iter()
        .enumerate()
        .filter(|(_, animation)| animation.channels.iter().any(moves));
    let Some((animation_ix, animation)) = moving.next() else {
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
    for (channel_ix, channel) in animation.channels.iter().enumerate() {
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
        *slot = Some(track(file, animation_ix, channel_ix, is_rotation)?);
    }
    let ends = parts.iter().filter_map(Part::ends);
    let whole = ends.reduce(|all, one| (all.0.min(one.0), all.1.max(one.1)));
    Ok(whole.map(|(start_s, end_s)| AnimatedNode { chain: parts, origin, start_s, end_s }))
}

/// Warns about animations that are not played: those that move meshes, area lights, suns or joints.
pub(super) fn note_unplayed(file: &File, walk: &Walk, warnings: &mut Warnings) {
    let nodes = &file.root.nodes;
    let joints = file.root.skins.iter().flat_map(|skin| &skin.joints);
    let joints: HashSet<usize> = joints.map(gltf::json::Index::value).collect();
    // Whether something that stays at rest is attached to a node or to a node below it.
    let mut carries = vec![false; nodes.len()];
    for visit in walk.visits.iter().rev() {
        let node = &nodes[visit.ix];
        let extensions = node.extensions.as_ref();
        carries[visit.ix] |= node.mesh.is_some()
            || punctual::is_sun(file, node)
            || extensions.is_some_and(|e| e.others.contains_key(area_lights::EXTENSION))
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
        "animations of meshes, area lights and suns are not played: those of {} animated nodes \
         stay at rest; the first is {name:?}",
        moved.len()
    ));
}

/// The track of a channel. Errors name the animation and the channel.
pub(super) fn track(
    file: &File,
    animation_ix: usize,
    channel_ix: usize,
    is_rotation: bool,
) -> Result<Track, SceneError> {
    let animation = &file.root.animations[animation_ix];
    let channel = format!("animations[{animation_ix}].channels[{channel_ix}]");
    let sampler_ix = animation.channels[channel_ix].sampler.value();
    let sampler = animation.samplers.get(sampler_ix).ok_or_else(|| {
        let accepted = format!("below {}", animation.samplers.len());
        file.invalid(format!("{channel}.sampler"), sampler_ix, accepted)
    })?;
    keys(file, sampler, is_rotation).map_err(|error| match error {
        SceneError::Invalid { file, field, value, accepted } => {
            SceneError::Invalid { file, field: format!("{channel}: {field}"), value, accepted }
        }
        other => other,
    })
}

fn keys(file: &File, sampler: &Sampler, is_rotation: bool) -> Result<Track, SceneError> {
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
