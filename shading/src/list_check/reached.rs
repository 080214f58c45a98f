//! The lights that reach samples, whatever the strategy.

use assign::{ENTRY_DIFFUSE, ENTRY_SPECULAR};
use glam::DVec3;
use rayon::prelude::*;

use crate::{LightBvh, Samples, truth::EDGE};

/// Samples of a block.
pub(super) const BLOCK: usize = 64;

/// The number of lights that reach a sample whose position is not a number.
pub(super) const NO_POSITION: u32 = u32::MAX;

/// Samples, and the lights that reach them.
pub(super) struct Reached {
    pixels: Vec<u32>,
    positions: Vec<[f32; 3]>,
    /// The number of lights that reach each sample; [`NO_POSITION`] for a position that is not a number.
    pub(super) counts: Vec<u32>,
    /// For each block, the lights that reach any of its samples: entries with the terms that one of them needs.
    pub(super) unions: Vec<Vec<u32>>,
}

impl Reached {
    pub(super) fn find(bvh: &LightBvh<'_>, samples: &Samples) -> Self {
        let (counts, unions): (Vec<Vec<u32>>, Vec<Vec<u32>>) = samples
            .positions
            .par_chunks(BLOCK)
            .map_init(|| Marks::new(bvh.lights().len()), |seen, some| of_block(bvh, some, seen))
            .unzip();
        Self {
            pixels: samples.pixels.clone(),
            positions: samples.positions.clone(),
            counts: counts.concat(),
            unions,
        }
    }

    /// The number of samples.
    pub(super) fn len(&self) -> usize {
        self.pixels.len()
    }

    /// The place of each of `samples` among the samples of `self`; `None` if one is not there, or if they are not in
    /// the same order.
    pub(super) fn places(&self, samples: &Samples) -> Option<Vec<u32>> {
        let mut known = (0..).zip(self.pixels.iter().zip(&self.positions));
        let asked = samples.pixels.iter().zip(&samples.positions);
        asked
            .map(|(pixel, position)| {
                let (place, (_, at)) = known.find(|(_, (known, _))| *known == pixel)?;
                (at.map(f32::to_bits) == position.map(f32::to_bits)).then_some(place)
            })
            .collect()
    }
}

/// How many lights reach each sample of a block, and the union of these lights with the terms that are needed.
fn of_block(bvh: &LightBvh<'_>, positions: &[[f32; 3]], seen: &mut Marks) -> (Vec<u32>, Vec<u32>) {
    seen.clear();
    let mut lights = Vec::new();
    let count = |position: &[f32; 3]| {
        // No light reaches or lights a position that is not a number.
        if !position.iter().all(|x| x.is_finite()) {
            return NO_POSITION;
        }
        let point = DVec3::from(position.map(f64::from));
        let mut count = 0;
        bvh.lights_at(*position, |light, reach| {
            count += 1;
            let known = seen.terms(light);
            if reach <= EDGE || known == BOTH_TERMS {
                return;
            }
            let is_diffuse = bvh.lights()[light as usize].diffuse_reach(point) > EDGE;
            let terms = ENTRY_SPECULAR | if is_diffuse { ENTRY_DIFFUSE } else { 0 };
            if known == 0 {
                lights.push(light);
            }
            seen.mark(light, known | terms);
        });
        count
    };
    let counts = positions.iter().map(count).collect();
    let union = lights.into_iter().map(|light| light | seen.terms(light)).collect();
    (counts, union)
}

const BOTH_TERMS: u32 = ENTRY_DIFFUSE | ENTRY_SPECULAR;

/// Terms of lights, by light. It is cleared at once.
pub(super) struct Marks {
    /// For each light, the round in which it was marked, and its terms.
    marks: Vec<(u32, u32)>,
    round: u32,
}

impl Marks {
    pub(super) fn new(lights: usize) -> Self {
        Self { marks: vec![(0, 0); lights], round: 0 }
    }

    /// Removes all marks.
    pub(super) fn clear(&mut self) {
        self.round = self.round.checked_add(1).unwrap_or_else(|| {
            self.marks.fill((0, 0));
            1
        });
    }

    /// Sets the terms of a light, if there is such a light.
    pub(super) fn mark(&mut self, light: u32, terms: u32) {
        if let Some(mark) = self.marks.get_mut(light as usize) {
            *mark = (self.round, terms);
        }
    }

    /// The terms of a light, 0 without a mark.
    pub(super) fn terms(&self, light: u32) -> u32 {
        let (round, terms) = self.marks[light as usize];
        if round == self.round { terms } else { 0 }
    }
}
