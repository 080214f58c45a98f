//! Checks a strategy's lists against every sample, on the CPU in f64.
//!
//! Which lights reach a sample does not depend on the strategy. So that is found once for all strategies whose lists are
//! checked at the same samples:
//!
//! 1. Samples are cut into blocks of 64 neighbours. For each sample, the hierarchy finds the lights that reach
//!    it. A block keeps the union of these lights, each with the terms that any of its samples needs.
//! 2. For each strategy, the samples of a block that read the same list form a run. The union of the block is looked up
//!    in that list. A light that the list lacks, or lists without a term, is then tested against each sample of the run.
//!
//! Every light that reaches a sample is in the union of its block, so no pair goes untested. A list that holds the whole
//! union needs one look-up for each light, where testing pairs would need one for each light and sample.

mod hidden;
mod reached;
#[cfg(test)]
mod tests;

use std::ops::Range;

use assign::{ENTRY_LIGHT, ListsSnapshot};
use glam::DVec3;
use rayon::prelude::*;

use crate::{
    LightBvh, Samples,
    traced::{GBufferSamples, TracedScene},
    truth::is_missed,
};
pub use hidden::HiddenPairs;
use hidden::hidden_pairs;
use reached::{BLOCK, Marks, NO_POSITION, Reached};

/// Runs that a thread checks at a time.
const RUNS_AT_ONCE: usize = 512;

/// The most samples that are remembered, with the lights that reach them: 64 MiB of positions and counts, plus the unions.
const MOST_REMEMBERED: usize = 4 << 20;

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

impl LightBvh<'_> {
    /// Checks one frame's lists: see [`ListCheck::check`].
    pub fn check(
        &self,
        samples: &Samples,
        lists: &ListsSnapshot,
        knows_normals: bool,
    ) -> ListsTruth {
        ListCheck::new(self).check(samples, lists, knows_normals)
    }
}

/// Checks lists, and remembers which lights reach the samples that it was asked about.
pub struct ListCheck<'a> {
    bvh: &'a LightBvh<'a>,
    known: Vec<Reached>,
    scene: Option<&'a TracedScene<'a>>,
    /// Whether lists may lack lights that surfaces hide.
    ignores_hidden: bool,
}

impl<'a> ListCheck<'a> {
    /// A check of lists of the lights of `bvh`.
    pub fn new(bvh: &'a LightBvh<'a>) -> Self {
        Self { bvh, known: Vec::new(), scene: None, ignores_hidden: false }
    }

    /// Sets the scene in which [`hidden`](Self::hidden) traces rays.
    #[must_use]
    pub fn in_scene(self, scene: Option<&'a TracedScene<'a>>) -> Self {
        Self { scene, ..self }
    }

    /// Sets whether lists may lack lights that surfaces hide ([`Needs::occluders`](assign::Needs)). Lights that a list
    /// lacks are then no missed pairs, because only look-ups of shadow maps know which of them are hidden. Lights that it
    /// lists without a term that reaches still are.
    pub fn ignore_hidden(&mut self, is_ignored: bool) {
        self.ignores_hidden = is_ignored;
    }

    /// The pairs that lists leave out, and those of them that exact rays see. `surfaces` are those of the frame's pixels.
    /// `knows_normals` is that of [`check`](Self::check).
    /// `None` without a scene.
    pub fn hidden(
        &self,
        samples: &Samples,
        lists: &ListsSnapshot,
        surfaces: &GBufferSamples,
        knows_normals: bool,
    ) -> Option<HiddenPairs> {
        Some(hidden_pairs(self.bvh, samples, lists, surfaces, self.scene?, knows_normals))
    }

    /// Checks a frame's lists against every sample. `knows_normals` says whether the strategy may leave out lights
    /// below a sample's horizon. It is fastest if the same samples, or some of them in their order, were checked
    /// before.
    pub fn check(
        &mut self,
        samples: &Samples,
        lists: &ListsSnapshot,
        knows_normals: bool,
    ) -> ListsTruth {
        let (bvh, ignores_hidden) = (self.bvh, self.ignores_hidden);
        let (known, places) = self.reached(samples);
        let key = |sample: u32| {
            let ix = sample as usize;
            (samples.groups[ix], places[ix] as usize / BLOCK)
        };
        let mut order: Vec<u32> = (0..samples.groups.len() as u32).collect();
        order.par_chunks_mut(BLOCK).for_each(|some| some.sort_unstable_by_key(|&s| key(s)));
        let mut runs: Vec<Range<usize>> = order
            .par_chunks(BLOCK)
            .enumerate()
            .flat_map_iter(|(ix, some)| {
                let mut end = ix * BLOCK;
                some.chunk_by(|&a, &b| key(a) == key(b)).map(move |run| {
                    end += run.len();
                    end - run.len()..end
                })
            })
            .collect();
        runs.par_sort_unstable_by_key(|run| samples.groups[order[run.start] as usize]);
        let check =
            Check { bvh, known, places: &places, samples, lists, knows_normals, ignores_hidden };
        runs.par_chunks(RUNS_AT_ONCE)
            .map_init(
                || Marks::new(bvh.lights().len()),
                |listed, runs| check.runs(&order, runs, listed),
            )
            .reduce(ListsTruth::default, ListsTruth::plus)
    }

    /// The lights that reach the samples, and the place of each sample among those that they were found for.
    fn reached(&mut self, samples: &Samples) -> (&Reached, Vec<u32>) {
        let found =
            (0..).zip(&self.known).find_map(|(ix, known)| Some((ix, known.places(samples)?)));
        let (ix, places) = found.unwrap_or_else(|| {
            let remembered: usize = self.known.iter().map(Reached::len).sum();
            if remembered + samples.pixels.len() > MOST_REMEMBERED {
                self.known.clear();
            }
            self.known.push(Reached::find(self.bvh, samples));
            (self.known.len() - 1, (0..samples.pixels.len() as u32).collect())
        });
        (&self.known[ix], places)
    }
}

/// The check of one strategy's lists.
struct Check<'a> {
    bvh: &'a LightBvh<'a>,
    known: &'a Reached,
    places: &'a [u32],
    samples: &'a Samples,
    lists: &'a ListsSnapshot,
    knows_normals: bool,
    ignores_hidden: bool,
}

impl Check<'_> {
    /// Checks runs that are sorted by group.
    fn runs(&self, order: &[u32], runs: &[Range<usize>], listed: &mut Marks) -> ListsTruth {
        let group = |run: &Range<usize>| self.samples.groups[order[run.start] as usize];
        let mut truth = ListsTruth::default();
        for of_group in runs.chunk_by(|a, b| group(a) == group(b)) {
            let entries = self.lists.entries_of(group(&of_group[0])).unwrap_or_default();
            listed.clear();
            for &entry in entries {
                listed.mark(entry & ENTRY_LIGHT, entry & !ENTRY_LIGHT);
            }
            for run in of_group {
                let run = &order[run.clone()];
                truth.samples += run.len() as u64;
                truth.listed += run.len() as u64 * entries.len() as u64;
                self.run(run, listed, &mut truth);
            }
        }
        truth
    }

    /// Checks the samples of a block that read the same list.
    fn run(&self, run: &[u32], listed: &Marks, truth: &mut ListsTruth) {
        let place = |sample: u32| self.places[sample as usize] as usize;
        for &sample in run {
            match self.known.counts[place(sample)] {
                NO_POSITION => truth.miss(self.pair(sample, None)),
                count => truth.contributing += u64::from(count),
            }
        }
        for needed in &self.known.unions[place(run[0]) / BLOCK] {
            let light = needed & ENTRY_LIGHT;
            let terms = listed.terms(light);
            if needed & !ENTRY_LIGHT & !terms == 0 || (self.ignores_hidden && terms == 0) {
                continue;
            }
            for &sample in run {
                let [point, normal] = [&self.samples.positions, &self.samples.normals]
                    .map(|of| DVec3::from(of[sample as usize].map(f64::from)));
                let normal = self.knows_normals.then_some(normal);
                if is_missed(&self.bvh.lights()[light as usize], terms, point, normal) {
                    truth.miss(self.pair(sample, Some(light)));
                }
            }
        }
    }

    fn pair(&self, sample: u32, light: Option<u32>) -> MissedPair {
        MissedPair { pixel: self.samples.pixels[sample as usize], light }
    }
}
