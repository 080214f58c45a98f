//! Lights that lists leave out because surfaces hide them, against exact rays.

use assign::{ENTRY_LIGHT, ListsSnapshot};
use glam::DVec3;
use rayon::prelude::*;

use crate::{
    LightBvh, Samples,
    traced::{GBufferSamples, Numbers, TracedScene, direct_light},
    truth::is_missed,
};

/// Pairs of directions towards an area light that are traced, each the start of a ray.
const AREA_RAYS: u32 = 32;

/// (Light, sample) pairs that lists leave out although the light's range reaches the sample.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct HiddenPairs {
    /// All of them.
    pub removed: u64,
    /// Of these, pairs of a light without an area to which an exact ray from the sample is free, where the light adds
    /// something. The maps have shadow there, and so has the image of no culling: a gap narrower than their texels.
    pub seen: u64,
    /// Of these, pairs of an area light of which any of 32 pairs of rays reaches a part, which adds something. The points
    /// of the maps lie beside this part, or the gap is narrower than a texel.
    pub seen_areas: u64,
}

impl HiddenPairs {
    fn plus(self, other: Self) -> Self {
        Self {
            removed: self.removed + other.removed,
            seen: self.seen + other.seen,
            seen_areas: self.seen_areas + other.seen_areas,
        }
    }
}

impl std::ops::AddAssign for HiddenPairs {
    fn add_assign(&mut self, other: Self) {
        *self = self.plus(other);
    }
}

/// Traces exact rays for the lights that lists leave out. `surfaces` are those of the frame's pixels. With `knows_normals`,
/// only lights above the sample's horizon count.
pub(super) fn hidden_pairs(
    bvh: &LightBvh<'_>,
    samples: &Samples,
    lists: &ListsSnapshot,
    surfaces: &GBufferSamples,
    scene: &TracedScene<'_>,
    knows_normals: bool,
) -> HiddenPairs {
    let of_sample = |ix: usize| {
        let mut listed: Vec<u32> = lists
            .entries_of(samples.groups[ix])
            .unwrap_or_default()
            .iter()
            .map(|entry| entry & ENTRY_LIGHT)
            .collect();
        // Lists ascend, unless a flaw shuffles them.
        if !listed.is_sorted() {
            listed.sort_unstable();
        }
        let [point, normal] =
            [&samples.positions, &samples.normals].map(|of| DVec3::from(of[ix].map(f64::from)));
        let normal = knows_normals.then_some(normal);
        let mut left_out = Vec::new();
        bvh.lights_at(samples.positions[ix], |slot, _| {
            let light = &bvh.lights()[slot as usize];
            if listed.binary_search(&slot).is_err() && is_missed(light, 0, point, normal) {
                left_out.push(slot);
            }
        });
        let mut found = HiddenPairs { removed: left_out.len() as u64, ..HiddenPairs::default() };
        let pixel = samples.pixels[ix];
        // Finding the surface takes a ray.
        if left_out.is_empty() {
            return found;
        }
        let Some(surface) = surfaces.sample(pixel as usize, scene) else { return found };
        for slot in left_out {
            let light = &bvh.lights()[slot as usize];
            let numbers = Numbers::new(u64::from(pixel)).part(u64::from(slot));
            let added = direct_light(light, &surface, Some(scene), AREA_RAYS, numbers).mean;
            let is_seen = u64::from(added != DVec3::ZERO);
            match light.shape {
                assign::LightShape::Area(_) => found.seen_areas += is_seen,
                _ => found.seen += is_seen,
            }
        }
        found
    };
    (0..samples.groups.len())
        .into_par_iter()
        .map(of_sample)
        .reduce(HiddenPairs::default, HiddenPairs::plus)
}
