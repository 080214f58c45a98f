//! The passes before lighting, by mode and strategy.

use assign::{Assignment, Frame, Passes};

use crate::{Mode, Renderer};

/// Records the passes that a mode draws before lighting, then the strategy's own passes.
pub fn record_before_lighting(
    renderer: &Renderer,
    mode: Mode,
    strategy: &mut dyn Assignment,
    frame: &Frame<'_>,
    passes: &mut dyn Passes,
) {
    let needs = strategy.needs();
    if mode.has_prepass(needs) {
        renderer.record_depth(frame.view, passes);
    }
    if mode.has_gbuffer(needs) {
        renderer.record_gbuffer_as(frame.view, mode == Mode::DeferredIds, passes);
    }
    if mode.has_model_pass(needs) {
        renderer.record_model_ids(frame.view, passes);
    }
    strategy.record(frame, passes);
}
