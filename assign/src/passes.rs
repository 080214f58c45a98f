//! Named passes, which strategies record and a clock can time.

/// A recorder of passes. A renderer passes [`EncoderPasses`]; a benchmark passes a recorder that
/// times each name.
pub trait Passes {
    /// Records one compute pass.
    fn compute(&mut self, name: &str, record: &mut dyn FnMut(&mut wgpu::ComputePass<'_>));

    /// Records one render pass.
    fn render(
        &mut self,
        name: &str,
        descriptor: &wgpu::RenderPassDescriptor<'_>,
        record: &mut dyn FnMut(&mut wgpu::RenderPass<'_>),
    );

    /// The encoder between passes, for copies that no clock should time.
    fn encoder(&mut self) -> &mut wgpu::CommandEncoder;
}

/// Records passes into a renderer's own encoder, untimed.
pub struct EncoderPasses<'a> {
    /// The encoder.
    pub encoder: &'a mut wgpu::CommandEncoder,
}

impl Passes for EncoderPasses<'_> {
    fn compute(&mut self, name: &str, record: &mut dyn FnMut(&mut wgpu::ComputePass<'_>)) {
        record(&mut self.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(name),
            timestamp_writes: None,
        }));
    }

    fn render(
        &mut self,
        name: &str,
        descriptor: &wgpu::RenderPassDescriptor<'_>,
        record: &mut dyn FnMut(&mut wgpu::RenderPass<'_>),
    ) {
        let mut descriptor = descriptor.clone();
        descriptor.label = Some(name);
        record(&mut self.encoder.begin_render_pass(&descriptor));
    }

    fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        self.encoder
    }
}
