//! One bind group for the lists and a strategy's own resources, in kernels that make lists and in
//! shading.

use crate::{
    Gpu, KeptBindGroup, LightLists,
    entries::{entry, storage_entry, uniform_entry},
};

/// First binding of a strategy's own resources, both in the kernel and in the look-up.
pub const FIRST_STRATEGY_BINDING: u32 = 4;

/// A bind group of the lists and of a strategy's own resources.
///
/// | binding | WESL | kernel | look-up |
/// |---|---|---|---|
/// | 0 | `lists`; in kernels `reserve::records`, with the counters | written | read |
/// | 1 | `entries` | written | read |
/// | 2 | free | | |
/// | 3 | `reserve::cull` | uniform | |
/// | from [`FIRST_STRATEGY_BINDING`] | the strategy's own | | |
#[derive(Debug)]
pub struct ListsBindings {
    entries: Vec<wgpu::BindGroupLayoutEntry>,
    layout: wgpu::BindGroupLayout,
    in_kernel: bool,
    bound: KeptBindGroup,
}

impl ListsBindings {
    /// For kernels that make lists. `bindings` are the strategy's own.
    pub fn of_kernel(gpu: &Gpu, label: &str, bindings: &[wgpu::BindGroupLayoutEntry]) -> Self {
        let stages = wgpu::ShaderStages::COMPUTE;
        let lists = [
            storage_entry(0, stages, false),
            storage_entry(1, stages, false),
            uniform_entry(3, stages),
        ];
        Self::new(gpu, label, true, [&lists, bindings].concat())
    }

    /// For the look-up: [`Lookup::bindings`](crate::Lookup::bindings).
    pub fn of_look_up(gpu: &Gpu, label: &str, bindings: &[wgpu::BindGroupLayoutEntry]) -> Self {
        let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
        let lists = [storage_entry(0, stages, true), storage_entry(1, stages, true)];
        Self::new(gpu, label, false, [&lists, bindings].concat())
    }

    fn new(
        gpu: &Gpu,
        label: &str,
        in_kernel: bool,
        entries: Vec<wgpu::BindGroupLayoutEntry>,
    ) -> Self {
        let layout = gpu.bind_group_layout(label, &entries);
        Self { entries, layout, in_kernel, bound: KeptBindGroup::default() }
    }

    /// Binds the lists and the strategy's resources. Call it after each [`LightLists::prepare`],
    /// which may replace buffers. The bind group stays the same while they do.
    pub fn bind(&mut self, gpu: &Gpu, lists: &LightLists, resources: &[wgpu::BindGroupEntry<'_>]) {
        let mut entries = vec![entry(0, lists.lists()), entry(1, lists.entries())];
        if self.in_kernel {
            entries.push(entry(3, lists.uniform()));
        }
        entries.extend_from_slice(resources);
        self.bound.bind(gpu, "lists", &self.layout, &entries);
    }

    /// The layout.
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// The bind group; `None` before the first [`bind`](Self::bind).
    pub fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.bound.get()
    }

    /// The entries of the layout for a renderer's own bind group, in which these bindings begin at `first_binding`.
    /// `stages` are the shader stages that read them.
    pub fn layout_entries(
        &self,
        first_binding: u32,
        stages: wgpu::ShaderStages,
    ) -> Vec<wgpu::BindGroupLayoutEntry> {
        let moved = |entry: &wgpu::BindGroupLayoutEntry| wgpu::BindGroupLayoutEntry {
            binding: first_binding.saturating_add(entry.binding),
            visibility: stages,
            ..*entry
        };
        self.entries.iter().map(moved).collect()
    }

    /// What [`bind`](Self::bind) bound last, for such a bind group; empty before the first call.
    pub fn bind_entries(&self, first_binding: u32) -> Vec<wgpu::BindGroupEntry<'_>> {
        self.bound.entries(first_binding)
    }
}
