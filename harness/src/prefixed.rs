//! Passes under longer names.

use assign::Passes;

/// Records passes with a prefix to their names.
pub(crate) struct Prefixed<'a> {
    prefix: &'static str,
    passes: &'a mut dyn Passes,
}

impl<'a> Prefixed<'a> {
    pub(crate) fn new(prefix: &'static str, passes: &'a mut dyn Passes) -> Self {
        Self { prefix, passes }
    }
}

impl Passes for Prefixed<'_> {
    fn compute(&mut self, name: &str, record: &mut dyn FnMut(&mut wgpu::ComputePass<'_>)) {
        self.passes.compute(&format!("{}{name}", self.prefix), record);
    }

    fn render(
        &mut self,
        name: &str,
        descriptor: &wgpu::RenderPassDescriptor<'_>,
        record: &mut dyn FnMut(&mut wgpu::RenderPass<'_>),
    ) {
        self.passes.render(&format!("{}{name}", self.prefix), descriptor, record);
    }

    fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        self.passes.encoder()
    }
}
