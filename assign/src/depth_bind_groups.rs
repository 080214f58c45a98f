//! The bind groups of a pass that reads several depth images, one after the other.

use crate::{DepthImage, Gpu, KeptBindGroup};

/// One bind group per depth image. They differ in the image only, which has binding 0.
#[derive(Debug, Default)]
pub struct DepthBindGroups {
    /// Those beyond `count` stay for frames with more images.
    bound: Vec<KeptBindGroup>,
    count: usize,
}

impl DepthBindGroups {
    /// Binds each image together with `shared`. It makes a bind group only for resources that it did not bind before.
    pub fn bind(
        &mut self,
        gpu: &Gpu,
        label: &str,
        layout: &wgpu::BindGroupLayout,
        depths: &[DepthImage],
        shared: &[wgpu::BindGroupEntry<'_>],
    ) {
        self.count = depths.len();
        if self.bound.len() < self.count {
            self.bound.resize_with(self.count, KeptBindGroup::default);
        }
        for (bound, depth) in self.bound.iter_mut().zip(depths) {
            bound.bind(gpu, label, layout, &[&[depth.entry(0)], shared].concat());
        }
    }

    /// The bind groups in the order of the images; none before the first [`bind`](Self::bind).
    pub fn groups(&self) -> impl Iterator<Item = &wgpu::BindGroup> {
        self.bound.iter().take(self.count).filter_map(KeptBindGroup::get)
    }
}
