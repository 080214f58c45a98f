//! Checks lists on the CPU in f64: which lights reach which sample.

use assign::{ENTRY_DIFFUSE, ENTRY_LIGHT, ENTRY_SPECULAR, Light, ListsSnapshot, Sun, Suns};
use glam::{DVec3, Vec3A};
use obvhs::{aabb::Aabb, bvh2::Bvh2};
use rayon::prelude::*;
use scenes::{BuildEffort, build_hierarchy};

use crate::Samples;

/// A pair closer to the edge of the light's support than this share of it does not count as missed.
/// The window is below 2e-11 there.
pub const EDGE: f64 = 1e-6;

/// A hierarchy over the bounding boxes of lights. It shares no code with any strategy.
pub struct LightBvh<'a> {
    lights: &'a [Light],
    bvh: Bvh2,
    suns: Suns,
}

/// The check of one strategy's lists in one frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ListsTruth {
    /// Samples checked.
    pub samples: u64,
    /// (Light, sample) pairs in which the light reaches the sample.
    pub contributing: u64,
    /// (Light, sample) pairs that shading evaluates.
    pub listed: u64,
    /// Contributing pairs, away from the edge, that are not listed or whose entry has no flag of a
    /// contributing term; and samples without a position. For a strategy that knows normals, only
    /// lights above the sample's horizon count.
    pub missed: u64,
    /// The first of the missed pairs, by pixel and then by light.
    pub first_missed: Option<MissedPair>,
}

/// A light that reaches a sample and is missing from the list that the sample reads.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct MissedPair {
    /// The pixel of the sample: an index into the viewport, rows from the top.
    pub pixel: u32,
    /// The light's slot in its buffer; `None` for a sample whose position is not a number.
    pub light: Option<u32>,
}

/// Whether a list misses a light at a sample: the light reaches the sample, and the list lacks it or the flag of a
/// term that reaches. `listed` are the flags of the light's entry, 0 without an entry. A pair closer to the
/// [`EDGE`] than that share does not count. `normal` is the sample's, for strategies that know normals: their
/// lists need no light below the sample's horizon.
pub fn is_missed(light: &Light, listed: u32, point: DVec3, normal: Option<DVec3>) -> bool {
    let diffuse = light.diffuse_reach(point) > EDGE;
    let needed = ENTRY_SPECULAR | if diffuse { ENTRY_DIFFUSE } else { 0 };
    light.reach(point) > EDGE
        && needed & !listed != 0
        && normal.is_none_or(|normal| light.above_horizon(point, normal) > EDGE)
}

impl ListsTruth {
    /// Mean contributing lights per sample.
    pub fn contributing_per_sample(&self) -> f64 {
        self.contributing as f64 / self.samples.max(1) as f64
    }

    /// Mean listed lights per sample.
    pub fn listed_per_sample(&self) -> f64 {
        self.listed as f64 / self.samples.max(1) as f64
    }

    /// Counts a missed pair.
    fn miss(&mut self, pair: MissedPair) {
        self.missed += 1;
        self.first_missed = Some(self.first_missed.map_or(pair, |first| first.min(pair)));
    }

    /// The check of the samples of both.
    #[must_use]
    pub fn plus(self, other: Self) -> Self {
        Self {
            samples: self.samples + other.samples,
            contributing: self.contributing + other.contributing,
            listed: self.listed + other.listed,
            missed: self.missed + other.missed,
            first_missed: [self.first_missed, other.first_missed].into_iter().flatten().min(),
        }
    }
}

impl<'a> LightBvh<'a> {
    /// Builds the hierarchy.
    pub fn new(lights: &'a [Light]) -> Self {
        let boxes: Vec<Aabb> = lights
            .iter()
            .map(|light| {
                // The box is a little larger than the range, because traversal decides in f32.
                let reach = light.radius_m() * 1.000_01 + light.position.abs().max_element() * 1e-6;
                Aabb::new((light.position - reach).into(), (light.position + reach).into())
            })
            .collect();
        let bvh = build_hierarchy(&boxes, BuildEffort::Thorough);
        Self { lights, bvh, suns: Suns::default() }
    }

    /// The same with suns, which reach every sample and appear in no list.
    #[must_use]
    pub fn with_suns(self, suns: Suns) -> Self {
        Self { suns, ..self }
    }

    /// The suns.
    pub fn suns(&self) -> &[Sun] {
        self.suns.as_slice()
    }

    /// The lights over which it was built.
    pub fn lights(&self) -> &'a [Light] {
        self.lights
    }

    /// Calls `found` with the index and the [`Light::reach`] of every light that reaches `point`.
    pub fn lights_at(&self, point: [f32; 3], mut found: impl FnMut(u32, f64)) {
        let exact = DVec3::from(point.map(f64::from));
        self.bvh.point_traverse(Vec3A::from(point), |bvh, node| {
            let node = &bvh.nodes[node as usize];
            let leaves = node.first_index..node.first_index + node.prim_count;
            for leaf in leaves {
                let light = bvh.primitive_indices[leaf as usize];
                let reach = self.lights[light as usize].reach(exact);
                if reach > 0.0 {
                    found(light, reach);
                }
            }
            true
        });
    }

    /// Checks a frame's lists against every sample. `knows_normals` says whether the strategy may
    /// leave out lights below a sample's horizon.
    pub fn check(
        &self,
        samples: &Samples,
        lists: &ListsSnapshot,
        knows_normals: bool,
    ) -> ListsTruth {
        let mut order: Vec<u32> = (0..samples.groups.len() as u32).collect();
        order.sort_unstable_by_key(|&sample| samples.groups[sample as usize]);
        order
            .par_chunks(8192)
            .map(|chunk| self.check_chunk(samples, lists, knows_normals, chunk))
            .reduce(ListsTruth::default, ListsTruth::plus)
    }

    /// Checks samples that are sorted by group.
    fn check_chunk(
        &self,
        samples: &Samples,
        lists: &ListsSnapshot,
        knows_normals: bool,
        chunk: &[u32],
    ) -> ListsTruth {
        // For each light, the run of samples in which it was last seen listed, and its flags there.
        let mut listed_in = vec![(u32::MAX, 0); self.lights.len()];
        let mut truth = ListsTruth::default();
        let runs =
            chunk.chunk_by(|&a, &b| samples.groups[a as usize] == samples.groups[b as usize]);
        for (run_ix, run) in runs.enumerate() {
            let group = samples.groups[run[0] as usize];
            let entries = lists.entries_of(group).unwrap_or_default();
            for &entry in entries {
                if let Some(seen) = listed_in.get_mut((entry & ENTRY_LIGHT) as usize) {
                    *seen = (run_ix as u32, entry & !ENTRY_LIGHT);
                }
            }
            truth.samples += run.len() as u64;
            truth.listed += run.len() as u64 * entries.len() as u64;
            for &sample in run {
                let pixel = samples.pixels[sample as usize];
                // No light reaches or lights a position that is not a number.
                if !samples.positions[sample as usize].iter().all(|x| x.is_finite()) {
                    truth.miss(MissedPair { pixel, light: None });
                    continue;
                }
                let [point, normal] = [&samples.positions, &samples.normals]
                    .map(|of| DVec3::from(of[sample as usize].map(f64::from)));
                let normal = knows_normals.then_some(normal);
                self.lights_at(samples.positions[sample as usize], |light_ix, _| {
                    truth.contributing += 1;
                    let (run, terms) = listed_in[light_ix as usize];
                    let listed = if run == run_ix as u32 { terms } else { 0 };
                    if is_missed(&self.lights[light_ix as usize], listed, point, normal) {
                        truth.miss(MissedPair { pixel, light: Some(light_ix) });
                    }
                });
            }
        }
        truth
    }
}

#[cfg(test)]
mod tests {
    use assign::{Counters, Emitter, LightList, LightShape};
    use glam::Vec3;

    use super::*;

    fn lights(count: u32) -> Vec<Light> {
        (0..count).map(|i| Light::point(Vec3::new(i as f32, 0.0, 0.0), 1.5, Vec3::ONE)).collect()
    }

    fn samples() -> Samples {
        Samples {
            positions: vec![[0.0, 0.0, 0.0], [5.2, 0.0, 0.0], [50.0, 0.0, 0.0]],
            normals: vec![[0.0, 1.0, 0.0]; 3],
            groups: vec![1, 0, 0],
            pixels: vec![0, 1, 2],
        }
    }

    fn snapshot(lists: &[&[u32]]) -> ListsSnapshot {
        let mut snapshot = ListsSnapshot {
            lists: vec![LightList::default()],
            entries: Vec::new(),
            counters: Counters::default(),
        };
        for list in lists {
            snapshot
                .lists
                .push(LightList { first: snapshot.entries.len() as u32, count: list.len() as u32 });
            let both = ENTRY_DIFFUSE | ENTRY_SPECULAR;
            snapshot.entries.extend(list.iter().map(|light| light | both));
        }
        snapshot
    }

    #[test]
    fn counts_agree_with_a_hand_count() {
        let lights = lights(10);
        let bvh = LightBvh::new(&lights);
        // Lights 0 and 1 reach sample 0; lights 4, 5 and 6 reach sample 1; none reaches sample 2.
        let truth = bvh.check(&samples(), &snapshot(&[&[3, 4, 5, 6], &[0, 1]]), false);
        let listed = 4 + 4 + 2;
        let expected = ListsTruth { samples: 3, contributing: 5, listed, ..ListsTruth::default() };
        assert_eq!(truth, expected);
    }

    #[test]
    fn a_light_left_out_is_missed() {
        let lights = lights(10);
        let bvh = LightBvh::new(&lights);
        let truth = bvh.check(&samples(), &snapshot(&[&[4, 6], &[0, 1]]), false);
        assert_eq!(truth.missed, 1);
        assert_eq!(truth.first_missed, Some(MissedPair { pixel: 1, light: Some(5) }));
        // Of several pairs, the first by pixel and then by light.
        let truth = bvh.check(&samples(), &snapshot(&[&[4, 6], &[]]), false);
        assert_eq!(truth.missed, 3);
        assert_eq!(truth.first_missed, Some(MissedPair { pixel: 0, light: Some(0) }));
    }

    #[test]
    fn a_light_without_the_flag_of_a_term_is_missed() {
        let lights = lights(10);
        let bvh = LightBvh::new(&lights);
        let mut lists = snapshot(&[&[4, 5, 6], &[0, 1]]);
        lists.entries[1] = 5 | ENTRY_SPECULAR;
        assert_eq!(bvh.check(&samples(), &lists, false).missed, 1);
    }

    #[test]
    fn strategies_that_know_normals_miss_nothing_below_the_horizon() {
        let lights = lights(10);
        let bvh = LightBvh::new(&lights);
        let none = snapshot(&[&[], &[]]);
        // Seen from 5.2 along x, lights 4 and 5 lie behind and light 6 in front.
        let mut samples = samples();
        samples.normals[1] = [1.0, 0.0, 0.0];
        assert_eq!(bvh.check(&samples, &none, false).missed, 5);
        assert_eq!(bvh.check(&samples, &none, true).missed, 1);
    }

    #[test]
    fn a_sample_without_a_position_is_missed() {
        let lights = lights(10);
        let mut samples = samples();
        samples.positions[2] = [f32::NAN, 0.0, 0.0];
        let truth =
            LightBvh::new(&lights).check(&samples, &snapshot(&[&[3, 4, 5, 6], &[0, 1]]), false);
        assert_eq!(truth.missed, 1);
        assert_eq!(truth.first_missed, Some(MissedPair { pixel: 2, light: None }));
    }

    #[test]
    fn lights_at_one_place_or_in_a_row_take_seconds() {
        let start = std::time::Instant::now();
        for apart_m in [0.0, 2.0] {
            let at = |ix: u32| Vec3::new(ix as f32 * apart_m, 0.0, 0.0);
            let lights: Vec<Light> =
                (0..100_000).map(|ix| Light::point(at(ix), 1.5, Vec3::ONE)).collect();
            let mut found = 0;
            LightBvh::new(&lights).lights_at([0.1, 0.0, 0.0], |_, _| found += 1);
            assert_eq!(found, if apart_m > 0.0 { 1 } else { 100_000 });
        }
        let seconds = start.elapsed().as_secs_f64();
        println!("{seconds:.2} s");
        assert!(seconds < 30.0, "{seconds} s");
    }

    /// Lights of every kind along a line, with some emitters much larger than their range.
    fn mixed(count: u32) -> Vec<Light> {
        let mut lights = lights(count);
        for (ix, light) in lights.iter_mut().enumerate() {
            let shape = match ix % 4 {
                0 => continue,
                1 => LightShape::Spot { direction: Vec3::Y, inner_angle: 0.2, outer_angle: 1.2 },
                2 => LightShape::Vpl { normal: Vec3::NEG_Z, min_distance_m: 0.0 },
                _ => {
                    let emitter = Emitter::rectangle(5.0 * Vec3::X, 0.5 * Vec3::Y);
                    LightShape::Area(if ix % 8 == 3 { emitter.two_sided() } else { emitter })
                }
            };
            (light.shape, light.range_m) = (shape, 0.4 + 0.2 * (ix % 5) as f32);
        }
        lights
    }

    #[test]
    fn the_hierarchy_finds_what_a_loop_finds() {
        let lights = mixed(200);
        let bvh = LightBvh::new(&lights);
        let mut beyond_the_middles_range = 0;
        for step in 0..400 {
            let point = [step as f32 * 0.5 + 0.01, 0.3, -0.2];
            let mut found = Vec::new();
            bvh.lights_at(point, |light, _| found.push(light));
            found.sort_unstable();
            let exact = DVec3::from(point.map(f64::from));
            let looped: Vec<u32> =
                (0..200).filter(|&i| lights[i as usize].reach(exact) > 0.0).collect();
            assert_eq!(found, looped, "at {point:?}");
            let is_beyond = |light: &Light| {
                exact.distance(light.position.as_dvec3()) > f64::from(light.range_m)
            };
            let beyond = looped.iter().filter(|&&ix| is_beyond(&lights[ix as usize]));
            beyond_the_middles_range += beyond.count();
        }
        assert!(beyond_the_middles_range > 400, "{beyond_the_middles_range}");
    }
}
