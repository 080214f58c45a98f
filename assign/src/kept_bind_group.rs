//! Bind groups that stay while what they bind stays, so that render bundles may keep them.

use crate::Gpu;

/// The most groups that are kept. A renderer may alternate between images, such as the depth buffers of two frames.
const MOST: usize = 4;

/// A bind group that is made again only if the layout or a bound resource changes.
///
/// A resource is the same if it is the same wgpu object. A renderer that makes a new view of its depth buffer in each
/// frame therefore gets a new bind group in each frame: keep the view. Views of a whole texture of depth and stencil are
/// the same, because a layout admits only one of the two aspects.
#[derive(Debug, Default)]
pub struct KeptBindGroup {
    /// The newest use comes first.
    made: Vec<Made>,
}

#[derive(Debug)]
struct Made {
    layout: wgpu::BindGroupLayout,
    bound: Vec<(u32, Bound)>,
    group: wgpu::BindGroup,
}

/// A bound resource.
#[derive(Clone, Debug)]
enum Bound {
    Buffer {
        buffer: wgpu::Buffer,
        offset: u64,
        size: Option<wgpu::BufferSize>,
    },
    View(wgpu::TextureView),
    Sampler(wgpu::Sampler),
    /// A resource of another kind. It equals nothing, so its group is made each time.
    Other,
}

impl Bound {
    fn new(resource: &wgpu::BindingResource<'_>) -> Self {
        match resource {
            wgpu::BindingResource::Buffer(bound) => Self::Buffer {
                buffer: bound.buffer.clone(),
                offset: bound.offset,
                size: bound.size,
            },
            wgpu::BindingResource::TextureView(view) => Self::View((*view).clone()),
            wgpu::BindingResource::Sampler(sampler) => Self::Sampler((*sampler).clone()),
            _ => Self::Other,
        }
    }

    fn resource(&self) -> Option<wgpu::BindingResource<'_>> {
        match self {
            Self::Buffer { buffer, offset, size } => {
                let bound = wgpu::BufferBinding { buffer, offset: *offset, size: *size };
                Some(wgpu::BindingResource::Buffer(bound))
            }
            Self::View(view) => Some(wgpu::BindingResource::TextureView(view)),
            Self::Sampler(sampler) => Some(wgpu::BindingResource::Sampler(sampler)),
            Self::Other => None,
        }
    }

    fn is(&self, resource: &wgpu::BindingResource<'_>) -> bool {
        match (self, resource) {
            (Self::Buffer { buffer, offset, size }, wgpu::BindingResource::Buffer(bound)) => {
                buffer == bound.buffer && *offset == bound.offset && *size == bound.size
            }
            (Self::View(view), wgpu::BindingResource::TextureView(bound)) => {
                view == *bound
                    || (view.texture() == bound.texture() && is_whole_depth_stencil(view.texture()))
            }
            (Self::Sampler(sampler), wgpu::BindingResource::Sampler(bound)) => sampler == *bound,
            _ => false,
        }
    }
}

/// Whether all views of a texture that one layout admits show the same.
pub(crate) fn is_whole_depth_stencil(texture: &wgpu::Texture) -> bool {
    texture.mip_level_count() == 1
        && texture.depth_or_array_layers() == 1
        && texture.format().is_combined_depth_stencil_format()
}

impl Made {
    fn binds(&self, layout: &wgpu::BindGroupLayout, entries: &[wgpu::BindGroupEntry<'_>]) -> bool {
        let same = |((binding, bound), entry): (&(u32, Bound), &wgpu::BindGroupEntry<'_>)| {
            *binding == entry.binding && bound.is(&entry.resource)
        };
        self.layout == *layout
            && self.bound.len() == entries.len()
            && self.bound.iter().zip(entries).all(same)
    }

    /// Whether its buffers are in use still. Otherwise it would keep the memory of a buffer that was replaced.
    fn has_buffers_of(&self, entries: &[wgpu::BindGroupEntry<'_>]) -> bool {
        self.bound.iter().all(|(_, bound)| match bound {
            Bound::Buffer { .. } => entries.iter().any(|entry| bound.is(&entry.resource)),
            _ => true,
        })
    }
}

impl KeptBindGroup {
    /// Binds resources. It makes a bind group only if none of the kept ones binds the same.
    pub fn bind(
        &mut self,
        gpu: &Gpu,
        label: &str,
        layout: &wgpu::BindGroupLayout,
        entries: &[wgpu::BindGroupEntry<'_>],
    ) {
        if let Some(place) = self.made.iter().position(|made| made.binds(layout, entries)) {
            self.made[..=place].rotate_right(1);
            return;
        }
        self.made.retain(|made| made.has_buffers_of(entries));
        self.made.truncate(MOST - 1);
        let bound = entries.iter().map(|entry| (entry.binding, Bound::new(&entry.resource)));
        let made = Made {
            layout: layout.clone(),
            bound: bound.collect(),
            group: gpu.bind_group(label, layout, entries),
        };
        self.made.insert(0, made);
    }

    /// The bind group; `None` before the first [`bind`](Self::bind).
    pub fn get(&self) -> Option<&wgpu::BindGroup> {
        self.made.first().map(|made| &made.group)
    }

    /// What that group binds, for another bind group, in which these bindings begin at `first_binding`; empty before
    /// the first [`bind`](Self::bind). Only buffers, texture views and samplers are kept.
    pub fn entries(&self, first_binding: u32) -> Vec<wgpu::BindGroupEntry<'_>> {
        let bound = self.made.first().map_or(&[][..], |made| &made.bound);
        bound
            .iter()
            .filter_map(|(binding, bound)| {
                let binding = first_binding.saturating_add(*binding);
                Some(wgpu::BindGroupEntry { binding, resource: bound.resource()? })
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{entry, storage_entry};

    #[test]
    fn a_group_is_made_again_only_for_other_resources() {
        let gpu = Gpu::noop().expect("a device");
        let stages = wgpu::ShaderStages::COMPUTE;
        let layout = gpu.bind_group_layout("one", &[storage_entry(0, stages, true)]);
        let wider = [storage_entry(0, stages, true), storage_entry(1, stages, true)];
        let wider = gpu.bind_group_layout("two", &wider);
        let [a, b] = ["a", "b"].map(|label| gpu.storage(label, 16).expect("a buffer"));
        let mut kept = KeptBindGroup::default();
        assert!(kept.get().is_none());
        let mut made = |layout: &_, entries: &[wgpu::BindGroupEntry<'_>]| {
            let before = gpu.hitches();
            kept.bind(&gpu, "test", layout, entries);
            (gpu.hitches().since(before).bind_groups, kept.get().cloned().expect("a group"))
        };
        let (count, first) = made(&layout, &[entry(0, &a)]);
        assert_eq!(count, 1);
        assert_eq!(made(&layout, &[entry(0, &a)]), (0, first.clone()));
        // With the first buffer still bound, its group stays.
        assert_eq!(made(&wider, &[entry(0, &a), entry(1, &b)]).0, 1);
        assert_eq!(made(&layout, &[entry(0, &a)]), (0, first.clone()));
        // Another buffer takes its place, so its group goes.
        assert_eq!(made(&layout, &[entry(0, &b)]).0, 1);
        assert_eq!(made(&layout, &[entry(0, &a)]).0, 1);
    }

    #[test]
    fn images_may_alternate() {
        let gpu = Gpu::noop().expect("a device");
        let stages = wgpu::ShaderStages::COMPUTE;
        let sample_type = crate::UNFILTERED;
        let layout =
            gpu.bind_group_layout("image", &[crate::texture_entry(0, stages, sample_type)]);
        let view = || {
            let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d::default(),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: wgpu::TextureFormat::Rgba8Unorm,
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        let views: Vec<_> = (0..MOST).map(|_| view()).collect();
        let mut kept = KeptBindGroup::default();
        let before = gpu.hitches();
        for view in views.iter().cycle().take(3 * MOST) {
            kept.bind(&gpu, "image", &layout, &[crate::texture(0, view)]);
        }
        assert_eq!(gpu.hitches().since(before).bind_groups, MOST as u64);
    }
}
