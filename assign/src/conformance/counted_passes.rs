//! A recorder that counts the passes of each name, for tests of what a frame records.

use std::collections::BTreeMap;

use crate::{EncoderPasses, Passes};

/// Records passes into an encoder, and counts those of each name.
pub struct CountedPasses<'a> {
    passes: EncoderPasses<'a>,
    counts: &'a mut BTreeMap<String, u32>,
}

impl<'a> CountedPasses<'a> {
    /// Adds to `counts`.
    pub fn new(
        encoder: &'a mut wgpu::CommandEncoder,
        counts: &'a mut BTreeMap<String, u32>,
    ) -> Self {
        Self { passes: EncoderPasses { encoder }, counts }
    }

    fn count(&mut self, name: &str) {
        *self.counts.entry(name.to_owned()).or_default() += 1;
    }
}

impl Passes for CountedPasses<'_> {
    fn compute(&mut self, name: &str, record: &mut dyn FnMut(&mut wgpu::ComputePass<'_>)) {
        self.count(name);
        self.passes.compute(name, record);
    }

    fn render(
        &mut self,
        name: &str,
        descriptor: &wgpu::RenderPassDescriptor<'_>,
        record: &mut dyn FnMut(&mut wgpu::RenderPass<'_>),
    ) {
        self.count(name);
        self.passes.render(name, descriptor, record);
    }

    fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        self.passes.encoder()
    }
}
