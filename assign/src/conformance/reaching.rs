//! Computes in f64 which lights reach which samples. Lists are checked against it.
//!
//! The result depends only on the lights and the samples' positions. A process runs the suite on
//! several strategies and each frame twice, so it computes the result once per stage and keeps it.

use std::{
    collections::HashMap,
    sync::{Arc, Mutex, PoisonError},
    thread,
};

use glam::DVec3;

use super::rig::Probe;
use crate::{Light, LightShape};

/// A pair does not count if it is closer to the support's edge than this share of the support.
const EDGE: f64 = 1e-6;

/// Stages kept per case. A case has at most three, with or without normals, and at any depth or
/// only on surfaces.
const KEPT: usize = 12;

/// Stages by the name of their case.
type Known = HashMap<&'static str, Vec<Arc<Reaching>>>;

/// One bit per light, 32 per word.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct LightBits {
    /// Lights whose specular term counts: all lights that reach.
    pub(super) specular: Vec<u32>,
    /// Lights whose diffuse term counts.
    pub(super) diffuse: Vec<u32>,
}

impl LightBits {
    pub(super) fn none(lights: usize) -> Self {
        let words = vec![0; lights.div_ceil(32)];
        Self { specular: words.clone(), diffuse: words }
    }

    pub(super) fn clear(&mut self) {
        self.specular.fill(0);
        self.diffuse.fill(0);
    }

    /// Sets or clears the bits of a light. Ignores a light that does not exist.
    pub(super) fn set(&mut self, light_ix: u32, specular: bool, diffuse: bool) {
        let (word, bit) = ((light_ix / 32) as usize, 1 << (light_ix % 32));
        for (words, value) in [(&mut self.specular, specular), (&mut self.diffuse, diffuse)] {
            if let Some(word) = words.get_mut(word) {
                *word = if value { *word | bit } else { *word & !bit };
            }
        }
    }

    pub(super) fn count(&self) -> u64 {
        self.specular.iter().map(|word| u64::from(word.count_ones())).sum()
    }
}

/// The lights that reach each sample of a stage.
#[derive(Debug)]
pub(super) struct Reaching {
    lights: Vec<Light>,
    /// Bits of position and normal of each sample.
    places: Vec<[u32; 6]>,
    knows_normals: bool,
    /// By sample.
    pub(super) by_sample: Vec<LightBits>,
}

impl Reaching {
    /// The lights that reach the samples of a stage of `case`: computed, or kept from an equal
    /// stage. With `knows_normals`, a light below a sample's horizon does not reach it.
    pub(super) fn find(
        case: &'static str,
        probes: &[Probe],
        lights: &[Light],
        knows_normals: bool,
    ) -> Arc<Self> {
        static KNOWN: Mutex<Option<Known>> = Mutex::new(None);
        let places: Vec<[u32; 6]> = probes.iter().map(place).collect();
        let same = |known: &&Arc<Self>| {
            known.knows_normals == knows_normals && known.lights == lights && known.places == places
        };
        // The store is whole even after another test has panicked.
        let lock = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) =
            lock().get_or_insert_default().get(case).and_then(|k| k.iter().find(same))
        {
            return known.clone();
        }
        let by_sample = compute(probes, lights, knows_normals);
        let made = Arc::new(Self { lights: lights.to_vec(), places, knows_normals, by_sample });
        let mut known = lock();
        let of_case = known.get_or_insert_default().entry(case).or_default();
        if of_case.len() == KEPT {
            of_case.remove(0);
        }
        of_case.push(made.clone());
        made
    }
}

fn place(probe: &Probe) -> [u32; 6] {
    let ([x, y, z], [i, j, k]) = (probe.position_world, probe.normal_world);
    [x, y, z, i, j, k].map(f32::to_bits)
}

/// Splits the samples among the processors.
fn compute(probes: &[Probe], lights: &[Light], knows_normals: bool) -> Vec<LightBits> {
    let radii: Vec<f64> = lights.iter().map(outer_radius).collect();
    let mut by_sample = vec![LightBits::none(lights.len()); probes.len()];
    let workers = thread::available_parallelism().map_or(1, usize::from);
    let share = probes.len().div_ceil(workers).max(1);
    thread::scope(|scope| {
        for (probes, found) in probes.chunks(share).zip(by_sample.chunks_mut(share)) {
            let radii = &radii;
            scope.spawn(move || {
                for (probe, bits) in probes.iter().zip(found) {
                    reach_sample(probe, lights, radii, knows_normals, bits);
                }
            });
        }
    });
    by_sample
}

fn reach_sample(
    probe: &Probe,
    lights: &[Light],
    radii: &[f64],
    knows_normals: bool,
    bits: &mut LightBits,
) {
    let point = DVec3::from_array(probe.position_world.map(f64::from));
    let normal = DVec3::from_array(probe.normal_world.map(f64::from)).normalize_or_zero();
    for (light_ix, (light, radius)) in (0..).zip(lights.iter().zip(radii)) {
        let far = point.distance_squared(light.position.as_dvec3()) > radius * radius;
        // A NaN position must not count as out of reach.
        if far && point.is_finite() {
            continue;
        }
        if light.reach(point) <= EDGE {
            continue;
        }
        if knows_normals && light.above_horizon(point, normal) <= EDGE {
            continue;
        }
        bits.set(light_ix, true, light.diffuse_reach(point) > EDGE);
    }
}

/// The distance from a light's position beyond which it reaches nothing, in f64. The range is
/// measured from the emitter's closest point, so an emitter adds the distance of its farthest
/// vertex.
fn outer_radius(light: &Light) -> f64 {
    let extent = match &light.shape {
        LightShape::Area(emitter) if emitter.outline().is_curved() => f64::from(emitter.radius()),
        LightShape::Area(emitter) => {
            let vertices = emitter.vertices().iter().map(|v| v.as_dvec3().length());
            vertices.fold(0.0, f64::max)
        }
        LightShape::Point | LightShape::Spot { .. } | LightShape::Vpl { .. } => 0.0,
    };
    f64::from(light.range_m) + extent
}

#[cfg(test)]
mod tests {
    use bytemuck::Zeroable;
    use glam::Vec3;

    use super::*;

    /// A result for other lights, positions or normals is never returned.
    #[test]
    fn an_equal_stage_is_reused_and_any_other_is_computed() {
        let probe = |point: Vec3, normal: Vec3| {
            let mut probe = Probe::zeroed();
            (probe.position_world, probe.normal_world) = (point.to_array(), normal.to_array());
            probe
        };
        let light = Light::point(Vec3::ZERO, 1.0, Vec3::ONE);
        let find = |probes: &[Probe], light: Light, knows_normals| {
            Reaching::find("an equal stage", probes, &[light], knows_normals)
        };
        let near = [probe(0.5 * Vec3::Z, Vec3::Z)];
        let first = find(&near, light, false);
        assert_eq!(first.by_sample[0].count(), 1);
        assert!(Arc::ptr_eq(&first, &find(&near, light, false)));
        // The light lies below the horizon of a sample that faces away.
        assert_eq!(find(&near, light, true).by_sample[0].count(), 0);
        assert_eq!(find(&[probe(0.5 * Vec3::Z, -Vec3::Z)], light, true).by_sample[0].count(), 1);
        assert_eq!(find(&[probe(2.0 * Vec3::Z, Vec3::Z)], light, false).by_sample[0].count(), 0);
        assert_eq!(find(&near, Light { range_m: 0.1, ..light }, false).by_sample[0].count(), 0);
        // Every light reaches a NaN position, so its list misses all of them.
        let nowhere = [probe(Vec3::NAN, Vec3::Z)];
        assert_eq!(find(&nowhere, light, false).by_sample[0].count(), 1);
        for _ in 0..2 * KEPT {
            assert_eq!(find(&nowhere, light, false).by_sample[0].count(), 1);
        }
    }
}
