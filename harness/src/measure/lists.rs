//! What is counted of a method's lists, and their check.

use assign::{Assignment, Counters, EncoderPasses, Gpu};
use shading::{
    HiddenPairs, LayerSamples, LightingOptions, ListCheck, ListsTruth, Mode, Operations,
    count_operations, record_for_probe, traced::GBufferSamples, visit_layer_lists, visit_lists,
};

use crate::{
    error::HarnessError, list_lengths::ListLengths, moving::order_bytes, results::MissedPair,
    stage::Stage,
};

/// What was counted of the lists.
#[derive(Clone, Debug, Default)]
pub struct ListsFigures {
    /// Groups.
    pub groups: u64,
    /// The culling kernel's counters.
    pub counters: Counters,
    /// Bytes of the lists on the GPU.
    pub bytes: u64,
    /// Bytes of everything that the strategy needs on the GPU, images that are drawn only for it
    /// included.
    pub memory_bytes: u64,
    /// The truth on the CPU, where asked for.
    pub truth: Option<ListsTruth>,
    /// Pairs that lists leave out because surfaces hide the light; `None` for strategies that leave out none.
    pub hidden: Option<HiddenPairs>,
    /// The first missed pair of the truth.
    pub first_missed: Option<MissedPair>,
    /// Of the samples of the truth, those of layers.
    pub layer_samples: u64,
    /// How long the lists are that samples read; empty where the truth was not asked for.
    pub lengths: ListLengths,
    /// Light operations, where they were asked for.
    pub operations: Option<Operations>,
}

/// Bytes of everything that a strategy needs on the GPU in a mode: its own, images that are drawn only for it,
/// and what orders the lights in every frame if it reads the hierarchy.
pub fn memory_bytes(stage: &Stage, strategy: &dyn Assignment, mode: Mode) -> u64 {
    let needs = strategy.needs();
    let order = if needs.hierarchy { order_bytes(&stage.lights) } else { 0 };
    strategy.memory_bytes() + order + stage.renderer.targets().bytes_for(mode, needs)
}

/// The place of a missed pair as results name it.
fn place(stage: &Stage, pair: shading::MissedPair) -> MissedPair {
    let width = stage.view.viewport.width;
    // The GPU's order is known to the GPU only.
    let given = |slot| stage.lights.given_index(slot).filter(|_| !stage.lights.order().is_on_gpu());
    MissedPair {
        pixel: [pair.pixel % width, pair.pixel / width],
        light: pair.light,
        given: pair.light.and_then(given),
    }
}

/// Reads the lists of the last frame back and checks them; `seen` asks for light operations.
pub(super) fn count(
    gpu: &Gpu,
    stage: &Stage,
    strategy: &dyn Assignment,
    mode: Mode,
    truth: Option<&mut ListCheck<'_>>,
    seen: Option<(LightingOptions, f32)>,
) -> Result<ListsFigures, HarnessError> {
    let snapshot = strategy.lists().snapshot(gpu)?;
    let mut lengths = ListLengths::default();
    let Stage { renderer, view, lights, .. } = stage;
    if mode.is_forward() && (truth.is_some() || seen.is_some()) {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = EncoderPasses { encoder: &mut encoder };
        record_for_probe(renderer, view, strategy, &mut passes);
        gpu.queue.submit([encoder.finish()]);
    }
    let frame = renderer.frame(view, lights);
    let operations = match seen {
        None => None,
        Some((options, exposure)) => {
            Some(count_operations(renderer, strategy, &frame, options, exposure)?)
        }
    };
    let mut layer_samples = 0;
    let mut hidden = None;
    let truth = match truth {
        None => None,
        Some(check) => {
            let pixels = view.viewport.width as usize * view.viewport.height as usize;
            let mut found = ListsTruth::default();
            let is_forward = mode.is_forward();
            let leaves_out_hidden = strategy.needs().occluders;
            check.ignore_hidden(leaves_out_hidden);
            let surfaces =
                leaves_out_hidden.then(|| GBufferSamples::read(renderer, view)).transpose()?;
            visit_lists(
                renderer,
                strategy,
                &frame,
                &snapshot,
                is_forward,
                &mut |samples, lists| {
                    lengths.add(samples, lists, pixels);
                    let pairs = surfaces
                        .as_ref()
                        .and_then(|at| check.hidden(samples, lists, at, strategy.needs().normals));
                    if let Some(pairs) = pairs {
                        *hidden.get_or_insert_default() += pairs;
                    }
                    found = found.plus(check.check(samples, lists, strategy.needs().normals));
                },
            )?;
            let layers = LayerSamples::capture(renderer, &frame)?;
            visit_layer_lists(
                renderer,
                strategy,
                &frame,
                &snapshot,
                &layers,
                &mut |samples, lists| {
                    let checked = check.check(samples, lists, false);
                    layer_samples += checked.samples;
                    // The sample of a layer is no pixel's, so no pixel is named.
                    found = found.plus(ListsTruth { first_missed: None, ..checked });
                },
            )?;
            Some(found)
        }
    };
    let mut counters = snapshot.counters;
    if truth.is_some() && strategy.lookup().is_per_sample() {
        // Each sample has a list of its own, which is no group's.
        counters.longest = lengths.longest();
        lengths.all_groups.clear();
    }
    Ok(ListsFigures {
        groups: u64::from(strategy.lists().group_count()),
        counters,
        bytes: strategy.lists().bytes(),
        memory_bytes: memory_bytes(stage, strategy, mode),
        first_missed: truth.and_then(|truth| truth.first_missed).map(|pair| place(stage, pair)),
        truth,
        hidden,
        layer_samples,
        lengths,
        operations,
    })
}
