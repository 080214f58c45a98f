//! One bind group for the lists and a strategy's own resources, in kernels that make lists and in
//! shading.

use crate::{
    Gpu, LightLists,
    entries::{entry, storage_entry, uniform_entry},
};

/// First binding of a strategy's own resources, both in the kernel and in the look-up.
pub const FIRST_STRATEGY_BINDING: u32 = 4;

/// A bind group of the lists and of a strategy's own resources.
///
/// | binding | WESL | kernel | look-up |
/// |---|---|---|---|
/// | 0 | `lists` | written | read |
/// | 1 | `entries` | written | read |
/// | 2 | `reserve::counters` | written | |
/// | 3 | `reserve::cull` | uniform | |
/// | from [`FIRST_STRATEGY_BINDING`] | the strategy's own | | |
#[derive(Debug)]
pub struct ListsBindings {
    entries: Vec<wgpu::BindGroupLayoutEntry>,
    layout: wgpu::BindGroupLayout,
    in_kernel: bool,
    bound: Vec<(u32, Resource)>,
    bind_group: Option<wgpu::BindGroup>,
}

/// What is bound.
#[derive(Debug)]
enum Resource {
    Buffer { buffer: wgpu::Buffer, offset: u64, size: Option<wgpu::BufferSize> },
    Texture(wgpu::TextureView),
    Sampler(wgpu::Sampler),
}

impl Resource {
    /// `None` for kinds of resources that no look-up reads: arrays of bindings, acceleration structures.
    fn of(resource: &wgpu::BindingResource<'_>) -> Option<Self> {
        match resource {
            wgpu::BindingResource::Buffer(at) => {
                Some(Self::Buffer { buffer: at.buffer.clone(), offset: at.offset, size: at.size })
            }
            wgpu::BindingResource::TextureView(view) => Some(Self::Texture((*view).clone())),
            wgpu::BindingResource::Sampler(sampler) => Some(Self::Sampler((*sampler).clone())),
            _ => None,
        }
    }

    fn binding(&self) -> wgpu::BindingResource<'_> {
        match self {
            Self::Buffer { buffer, offset, size } => {
                wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                    buffer,
                    offset: *offset,
                    size: *size,
                })
            }
            Self::Texture(view) => wgpu::BindingResource::TextureView(view),
            Self::Sampler(sampler) => wgpu::BindingResource::Sampler(sampler),
        }
    }
}

impl ListsBindings {
    /// For kernels that make lists. `bindings` are the strategy's own.
    pub fn of_kernel(gpu: &Gpu, label: &str, bindings: &[wgpu::BindGroupLayoutEntry]) -> Self {
        let stages = wgpu::ShaderStages::COMPUTE;
        let lists = [
            storage_entry(0, stages, false),
            storage_entry(1, stages, false),
            storage_entry(2, stages, false),
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
        Self { entries, layout, in_kernel, bound: Vec::new(), bind_group: None }
    }

    /// Binds the lists and the strategy's resources. Call it after each [`LightLists::prepare`],
    /// which may replace buffers.
    pub fn bind(&mut self, gpu: &Gpu, lists: &LightLists, resources: &[wgpu::BindGroupEntry<'_>]) {
        let mut entries = vec![entry(0, lists.lists()), entry(1, lists.entries())];
        if self.in_kernel {
            entries.extend([entry(2, lists.counters()), entry(3, lists.uniform())]);
        }
        entries.extend_from_slice(resources);
        let bound = entries.iter().filter_map(|e| Some((e.binding, Resource::of(&e.resource)?)));
        self.bound = bound.collect();
        self.bind_group = Some(gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("lists"),
            layout: &self.layout,
            entries: &entries,
        }));
    }

    /// The layout.
    pub fn layout(&self) -> &wgpu::BindGroupLayout {
        &self.layout
    }

    /// The bind group; `None` before the first [`bind`](Self::bind).
    pub fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.bind_group.as_ref()
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
        self.bound
            .iter()
            .map(|(binding, resource)| wgpu::BindGroupEntry {
                binding: first_binding.saturating_add(*binding),
                resource: resource.binding(),
            })
            .collect()
    }
}
