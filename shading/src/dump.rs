//! Copies the lists that samples read from the GPU, whatever the strategy stores.

use assign::{Assignment, Counters, Frame, LightList, ListsSnapshot, entry, storage_entry};
use bytemuck::{cast_slice, pod_collect_to_vec};

use crate::{
    Renderer, Samples, ShadingError,
    gbuffer_inputs::GBufferInputs,
    pixel_pass::PixelPass,
    probe,
    shaders::{LISTS_GROUP, lighting_modules},
};

/// Bindings of `dump.wesl`.
const COUNTS_BINDING: u32 = 8;
const PLACES_BINDING: u32 = 9;
const DUMPED_BINDING: u32 = 10;

/// The most entries that are copied at once: 64 MiB, half of what any device can bind.
const MOST_AT_ONCE: usize = 16 << 20;

/// Calls `visit` with samples and the lists that they read: once with those of all samples, or, if
/// [each sample reads its own lights](assign::Lookup::is_per_sample), with some samples at a time, each a group
/// of its own. Blocks.
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
    visit: &mut dyn FnMut(&Samples, &ListsSnapshot),
) -> Result<(), ShadingError> {
    let samples = probe(renderer, strategy, frame)?;
    if !strategy.lookup().is_per_sample() {
        visit(&samples, snapshot);
        return Ok(());
    }
    let counts = counts(renderer, strategy, frame, None)?;
    let length = |pixel: u32| counts.get(pixel as usize).map_or(0, |&count| count as usize);
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
        let entries = entries(renderer, strategy, frame, &counts, &samples.pixels[range.clone()])?;
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

/// The buffers of places and entries.
type Room<'a> = (&'a wgpu::Buffer, &'a wgpu::Buffer);

/// The number of entries that each pixel's look-up returns. With `room`, it also writes entries there.
fn counts(
    renderer: &Renderer,
    strategy: &dyn Assignment,
    frame: &Frame<'_>,
    room: Option<Room<'_>>,
) -> Result<Vec<u32>, ShadingError> {
    let gpu = &renderer.gpu;
    let bytes = u64::from(frame.view.viewport.width) * u64::from(frame.view.viewport.height) * 4;
    let counts = gpu.storage("entries per pixel", bytes)?;
    let stages = wgpu::ShaderStages::COMPUTE;
    let mut layout = vec![storage_entry(COUNTS_BINDING, stages, false)];
    let mut resources = vec![entry(COUNTS_BINDING, &counts)];
    if let Some((places, dumped)) = room {
        layout.push(storage_entry(PLACES_BINDING, stages, true));
        layout.push(storage_entry(DUMPED_BINDING, stages, false));
        resources.extend([entry(PLACES_BINDING, places), entry(DUMPED_BINDING, dumped)]);
    }
    let pass = PixelPass {
        name: "dump",
        entry_point: "look_up",
        shader: lighting_modules(LISTS_GROUP)
            .flag("dump", room.is_some())
            .light_kinds(frame.lights.kinds()),
        images: GBufferInputs::of_sample(strategy.needs().models),
        layout,
        resources,
        strategy: Some(strategy),
    };
    pass.submit(renderer, frame.view.viewport)?;
    Ok(pod_collect_to_vec(&gpu.read(&counts, bytes)?))
}

/// The entries of some pixels, one after the other.
fn entries(
    renderer: &Renderer,
    strategy: &dyn Assignment,
    frame: &Frame<'_>,
    counts_before: &[u32],
    pixels: &[u32],
) -> Result<Vec<u32>, ShadingError> {
    let gpu = &renderer.gpu;
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
    let place_buffer = gpu.storage("places", size_of_val(&places[..]) as u64)?;
    gpu.queue.write_buffer(&place_buffer, 0, cast_slice(&places));
    let dumped = gpu.storage("dumped entries", u64::from(end) * 4)?;
    let counts = counts(renderer, strategy, frame, Some((&place_buffer, &dumped)))?;
    if counts != counts_before {
        return Err(ShadingError::Unsteady { strategy: strategy.id() });
    }
    Ok(pod_collect_to_vec(&gpu.read(&dumped, u64::from(end) * 4)?))
}
