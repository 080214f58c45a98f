//! Copies the lists that samples read from the GPU, whatever the strategy stores.

use assign::{Assignment, Counters, Frame, LightList, ListsSnapshot, entry, storage_entry};
use bytemuck::{cast_slice, pod_collect_to_vec};

use crate::{
    Renderer, Samples, ShadingError,
    gbuffer_inputs::GBufferInputs,
    pixel_pass::PixelPass,
    probe::{ask_captured, probe_at},
    shaders::{LISTS_GROUP, lighting_modules},
};

/// Bindings of `dump.wesl`.
const COUNTS_BINDING: u32 = 8;
const PLACES_BINDING: u32 = 9;
const DUMPED_BINDING: u32 = 10;

/// The most entries that are copied at once: 64 MiB, half of what any device can bind.
const MOST_AT_ONCE: usize = 16 << 20;

/// The most entries that are copied in all. Of samples with more, some are looked up.
const MOST_ENTRIES: usize = 4 * MOST_AT_ONCE;

/// Calls `visit` with samples and the lists that they read: once with those of all samples, or, if
/// [each sample reads its own lights](assign::Lookup::is_per_sample), with some samples at a time, each a group
/// of its own. Blocks.
///
/// If samples that read their own lights list more than 64 Mi of them together, `visit` gets every second sample, or every
/// third one, and so on, so that the time is bounded. Each column and each row of the image keeps some of its samples. Lists
/// of groups are visited at all samples.
///
/// A sample's own lists are what a compute shader with workgroups of 8 x 8 pixels reads, as in deferred shading.
/// With `is_forward`, each sample looks its lights up for itself, as in forward shading. A driver may choose another
/// size of subgroups for this shader than for shading.
///
/// `snapshot` are the strategy's lists. Depth, normals and model ids are those of the last recorded geometry
/// passes: see [`record_for_probe`](crate::record_for_probe).
///
/// # Errors
///
/// [`ShadingError::Unsteady`] if a sample's second look-up returned another number of lights than its first.
pub fn visit_lists(
    renderer: &Renderer,
    strategy: &dyn Assignment,
    frame: &Frame<'_>,
    snapshot: &ListsSnapshot,
    is_forward: bool,
    visit: &mut dyn FnMut(&Samples, &ListsSnapshot),
) -> Result<(), ShadingError> {
    let asked = Asked { captured: None, is_alone: is_forward };
    visit_lists_at(renderer, strategy, frame, snapshot, asked, visit)
}

/// Which samples are looked up, and how.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Asked<'a> {
    /// Captured samples, at most one per pixel; `None`: those of the pixels.
    pub(crate) captured: Option<&'a wgpu::Buffer>,
    /// Whether each sample looks its lights up for itself.
    pub(crate) is_alone: bool,
}

/// As [`visit_lists`], for any samples.
pub(crate) fn visit_lists_at(
    renderer: &Renderer,
    strategy: &dyn Assignment,
    frame: &Frame<'_>,
    snapshot: &ListsSnapshot,
    asked: Asked<'_>,
    visit: &mut dyn FnMut(&Samples, &ListsSnapshot),
) -> Result<(), ShadingError> {
    let samples = probe_at(renderer, strategy, frame, asked.captured)?;
    if !strategy.lookup().is_per_sample() {
        visit(&samples, snapshot);
        return Ok(());
    }
    let dump = Dump { renderer, strategy, frame, asked };
    let counts = dump.counts()?;
    let length = |pixel: u32| counts.get(pixel as usize).map_or(0, |&count| count as usize);
    let entries = samples.pixels.iter().map(|&pixel| length(pixel)).sum();
    let samples = thinned(samples, step_of(entries, MOST_ENTRIES, frame.view.viewport.width));
    let mut next = 0;
    while next < samples.pixels.len() {
        let mut lists = vec![LightList::default()];
        let mut end = 0;
        for &pixel in &samples.pixels[next..] {
            if end > 0 && end + length(pixel) > MOST_AT_ONCE {
                break;
            }
            lists.push(LightList { first: end as u32, count: length(pixel) as u32 });
            end += length(pixel);
        }
        let range = next..next + lists.len() - 1;
        let entries = dump.entries(&counts, &samples.pixels[range.clone()])?;
        let some = Samples {
            positions: samples.positions[range.clone()].to_vec(),
            normals: samples.normals[range.clone()].to_vec(),
            groups: (0..lists.len() as u32 - 1).collect(),
            pixels: samples.pixels[range.clone()].to_vec(),
        };
        visit(&some, &ListsSnapshot { lists, entries, counters: Counters::default() });
        next = range.end;
    }
    Ok(())
}

/// How many samples to go from one that is looked up to the next: enough that they list `most` entries at most of `entries`.
/// It has no divisor in common with the width of the image, so that it meets each column.
fn step_of(entries: usize, most: usize, width: u32) -> usize {
    let divisor = |a: u32, b: u32| {
        let (mut a, mut b) = (a, b);
        while b > 0 {
            (a, b) = (b, a % b);
        }
        a
    };
    let least = entries.div_ceil(most).max(1) as u32;
    (least..).find(|&step| divisor(width, step) == 1).unwrap_or(least) as usize
}

/// Every so many samples.
fn thinned(samples: Samples, step: usize) -> Samples {
    if step == 1 {
        return samples;
    }
    let Samples { positions, normals, groups, pixels } = samples;
    Samples {
        positions: positions.into_iter().step_by(step).collect(),
        normals: normals.into_iter().step_by(step).collect(),
        groups: groups.into_iter().step_by(step).collect(),
        pixels: pixels.into_iter().step_by(step).collect(),
    }
}

/// The entries that the look-up of one pixel returns, in its order, whatever the strategy stores; empty if the pixel
/// shows no surface. Blocks.
///
/// `pixel` is an index into the viewport, rows from the top; [`visit_lists`] says what else matters.
///
/// # Errors
///
/// As [`visit_lists`].
pub fn list_of_pixel(
    renderer: &Renderer,
    strategy: &dyn Assignment,
    frame: &Frame<'_>,
    pixel: u32,
    is_forward: bool,
) -> Result<Vec<u32>, ShadingError> {
    let asked = Asked { is_alone: is_forward, captured: None };
    let dump = Dump { renderer, strategy, frame, asked };
    let counts = dump.counts()?;
    dump.entries(&counts, &[pixel])
}

/// One frame's look-ups.
struct Dump<'a> {
    renderer: &'a Renderer,
    strategy: &'a dyn Assignment,
    frame: &'a Frame<'a>,
    asked: Asked<'a>,
}

impl Dump<'_> {
    /// The number of entries that each pixel's look-up returns.
    fn counts(&self) -> Result<Vec<u32>, ShadingError> {
        // No pixel has room for entries.
        let viewport = self.frame.view.viewport;
        let pixels = viewport.width as usize * viewport.height as usize;
        Ok(self.run(&vec![0; pixels + 1])?.0)
    }

    /// The entries of some pixels, one after the other.
    fn entries(&self, counts_before: &[u32], pixels: &[u32]) -> Result<Vec<u32>, ShadingError> {
        let mut places = Vec::with_capacity(counts_before.len() + 1);
        let mut wanted = pixels.iter().peekable();
        let mut end = 0u32;
        for (pixel, &count) in (0..).zip(counts_before) {
            places.push(end);
            if wanted.next_if_eq(&&pixel).is_some() {
                end += count;
            }
        }
        places.push(end);
        let (counts, entries) = self.run(&places)?;
        if counts != counts_before {
            return Err(ShadingError::Unsteady { strategy: self.strategy.id() });
        }
        Ok(entries)
    }

    /// Looks every pixel up: the number of entries of each, and the entries of those that have places for them.
    /// Each call runs the same shader, so that lanes work together in the same way.
    fn run(&self, places: &[u32]) -> Result<(Vec<u32>, Vec<u32>), ShadingError> {
        let Self { renderer, strategy, frame, asked } = *self;
        let gpu = &renderer.gpu;
        let place_buffer = gpu.storage("places", size_of_val(places) as u64)?;
        gpu.queue.write_buffer(&place_buffer, 0, cast_slice(places));
        let entry_bytes = u64::from(places.last().copied().unwrap_or(0)) * 4;
        let dumped = gpu.storage("dumped entries", entry_bytes)?;
        let count_bytes = (places.len() as u64 - 1) * 4;
        let counts = gpu.storage("entries per pixel", count_bytes)?;
        let stages = wgpu::ShaderStages::COMPUTE;
        let shader = lighting_modules(LISTS_GROUP).light_kinds(frame.lights.kinds());
        let mut pass = PixelPass {
            name: "dump",
            entry_point: "look_up",
            shader,
            images: GBufferInputs::of_sample(strategy.needs().models),
            layout: vec![
                storage_entry(COUNTS_BINDING, stages, false),
                storage_entry(PLACES_BINDING, stages, true),
                storage_entry(DUMPED_BINDING, stages, false),
            ],
            resources: vec![
                entry(COUNTS_BINDING, &counts),
                entry(PLACES_BINDING, &place_buffer),
                entry(DUMPED_BINDING, &dumped),
            ],
            strategy: Some(strategy),
            is_alone: asked.is_alone,
            bounds: None,
        };
        ask_captured(&mut pass, asked.captured);
        pass.submit(renderer, frame.view.viewport)?;
        Ok((
            pod_collect_to_vec(&gpu.read(&counts, count_bytes)?),
            pod_collect_to_vec(&gpu.read(&dumped, entry_bytes)?),
        ))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn few_entries_are_all_visited_and_of_more_each_column_keeps_some() {
        assert_eq!([0, 1, 99, 100].map(|entries| step_of(entries, 100, 1920)), [1; 4]);
        for (entries, width, step) in [(101, 1920, 7), (101, 7, 2), (1_000, 96, 11)] {
            assert_eq!(step_of(entries, 100, width), step, "{entries} {width}");
            let columns: std::collections::BTreeSet<usize> =
                (0..width as usize).map(|ix| ix * step % width as usize).collect();
            assert_eq!(columns.len(), width as usize);
        }
        let samples = Samples { pixels: (0..10).collect(), ..Samples::default() };
        assert_eq!(thinned(samples, 3).pixels, [0, 3, 6, 9]);
    }
}
