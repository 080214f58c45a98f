//! Reads the animations of nodes that carry points and spots of KHR_lights_punctual.
//!
//! All animations of the file play together. Where two channels move the same property of a node,
//! the first one counts. Only channels of nodes above a light are read.

use std::collections::HashMap;

use glam::DVec3;
use gltf::json::{animation::Property, validation::Checked};

use super::{Warnings, animation, file::File, walk::Walk, warnings::kept_name};
use crate::{
    SceneError,
    animated_node::{Local, Part, Placement},
    light_animation::{AnimatedLight, LightAnimation, Limb},
};

/// The most numbers, times and values, that all channels of lights may read together. Many channels
/// can share one long accessor.
const MAX_KEYS: u64 = 1 << 24;

/// A channel, by the index of its animation and its own.
type ChannelIx = (usize, usize);

/// The animation of the lights at these nodes; `None` where nothing moves them. `lights` holds, for
/// each light, its node and its index.
pub(super) fn load(
    file: &File,
    walk: &Walk,
    lights: &[(usize, usize)],
    origin: DVec3,
    warnings: &mut Warnings,
) -> Result<Option<LightAnimation>, SceneError> {
    let above = above_lights(file, walk, lights);
    let channels = channels(file, &above, warnings);
    if channels.is_empty() {
        return Ok(None);
    }
    let mut keys = Keys { file, count: 0 };
    let mut limbs: Vec<Limb> = Vec::new();
    // For each node above a light: the limb that it hangs on, and its placement from there.
    let mut hung: HashMap<usize, (Option<usize>, Placement)> = HashMap::new();
    let root = (None, Placement::from_origin(origin));
    for ix in walk.visits.iter().map(|visit| visit.ix).filter(|ix| above[*ix]) {
        let parent = walk.parents[ix].and_then(|parent| hung.get(&parent));
        let (limb, base) = *parent.unwrap_or(&root);
        let local = Local::from_node(&file.root.nodes[ix]);
        let Some(channels) = channels.get(&ix) else {
            hung.insert(ix, (limb, base.below(&local)));
            continue;
        };
        let mut track = |channel: Option<ChannelIx>, is_rotation| {
            channel.map(|channel| keys.track(channel, is_rotation)).transpose()
        };
        let [translation, rotation, scale] = *channels;
        let part = Part {
            local,
            translation: track(translation, false)?,
            rotation: track(rotation, true)?,
            scale: track(scale, false)?,
        };
        hung.insert(ix, (Some(limbs.len()), Placement::IDENTITY));
        limbs.push(Limb { parent: limb, base, part });
    }
    let animated = lights.iter().filter_map(|(node, light)| {
        let (limb, from_limb) = *hung.get(node)?;
        Some(AnimatedLight { light: *light, limb: limb?, from_limb, offset: glam::Vec3::ZERO })
    });
    let lights: Vec<_> = animated.collect();
    let ends = limbs.iter().filter_map(|limb| limb.part.ends());
    let whole = (f32::INFINITY, f32::NEG_INFINITY);
    let (start_s, end_s) = ends.fold(whole, |all, one| (all.0.min(one.0), all.1.max(one.1)));
    Ok(Some(LightAnimation { limbs, lights, start_s, end_s, scale: 1.0 }))
}

/// For each node, whether it carries one of the lights or is above one.
fn above_lights(file: &File, walk: &Walk, lights: &[(usize, usize)]) -> Vec<bool> {
    let mut above = vec![false; file.root.nodes.len()];
    for (node, _) in lights {
        let mut next = Some(*node);
        while let Some(ix) = next.filter(|ix| !above[*ix]) {
            above[ix] = true;
            next = walk.parents[ix];
        }
    }
    above
}

/// For each animated node above a light, the channels of its translation, rotation and scale.
fn channels(
    file: &File,
    above: &[bool],
    warnings: &mut Warnings,
) -> HashMap<usize, [Option<ChannelIx>; 3]> {
    let mut found: HashMap<usize, [Option<ChannelIx>; 3]> = HashMap::new();
    let mut repeated = 0_usize;
    for (animation_ix, animation) in file.root.animations.iter().enumerate() {
        for (channel_ix, channel) in animation.channels.iter().enumerate() {
            let node = channel.target.node.value();
            let property = match channel.target.path {
                Checked::Valid(Property::Translation) => 0,
                Checked::Valid(Property::Rotation) => 1,
                Checked::Valid(Property::Scale) => 2,
                _ => continue,
            };
            if above.get(node) != Some(&true) {
                continue;
            }
            let json = &file.root.nodes[node];
            if json.matrix.is_some() {
                let name = json.name.as_deref().map_or_else(|| format!("node {node}"), kept_name);
                warnings.add(format!(
                    "animations[{animation_ix}].channels[{channel_ix}] is not played: its node \
                     {name:?} has a matrix, which channels cannot move"
                ));
                continue;
            }
            let slot = &mut found.entry(node).or_default()[property];
            repeated += usize::from(slot.is_some());
            slot.get_or_insert((animation_ix, channel_ix));
        }
    }
    if repeated > 0 {
        warnings.add(format!(
            "animations of lights: {repeated} channels are not played, because earlier ones move \
             the same nodes"
        ));
    }
    found
}

/// Reads channels within [`MAX_KEYS`].
struct Keys<'a> {
    file: &'a File,
    count: u64,
}

impl Keys<'_> {
    fn track(
        &mut self,
        (animation_ix, channel_ix): ChannelIx,
        is_rotation: bool,
    ) -> Result<crate::animated_node::Track, SceneError> {
        let animation = &self.file.root.animations[animation_ix];
        let sampler = animation.samplers.get(animation.channels[channel_ix].sampler.value());
        for accessor in sampler.into_iter().flat_map(|sampler| [sampler.input, sampler.output]) {
            let count = self.file.root.get(accessor).map_or(0, |accessor| accessor.count.0);
            self.count = self.count.saturating_add(count);
        }
        if self.count > MAX_KEYS {
            let field =
                format!("animations[{animation_ix}].channels[{channel_ix}]: keys of lights so far");
            return Err(self.file.invalid(field, self.count, format!("at most {MAX_KEYS}")));
        }
        animation::track(self.file, animation_ix, channel_ix, is_rotation)
    }
}
