//! Deep images copied to the CPU.

use assign::{AssignError, Gpu};
use bytemuck::pod_collect_to_vec;
use glam::UVec2;

use crate::{DeepImageCounters, DeepImageSettings, LinkedNode, Storage, deep_buffers::DeepBuffers};

/// The depths of every pixel after a frame.
#[derive(Clone, Debug, PartialEq)]
pub struct DeepImagesSnapshot {
    /// The counters of the frame.
    pub counters: DeepImageCounters,
    size_px: u32,
    offsets: Vec<u32>,
    depths_m: Vec<f32>,
}

impl DeepImagesSnapshot {
    pub(crate) fn read(
        gpu: &Gpu,
        settings: &DeepImageSettings,
        buffers: &DeepBuffers,
    ) -> Result<Self, AssignError> {
        let header = gpu.read(&buffers.header, size_of::<DeepImageCounters>() as u64)?;
        let counters: DeepImageCounters = bytemuck::pod_read_unaligned(&header);
        let used = u64::from(counters.fragment_count.min(buffers.fragment_capacity));
        let pixels = u64::from(settings.pixel_count());
        let (offsets, depths_m) = match settings.storage {
            Storage::Arrays => {
                let offsets = pod_collect_to_vec(&gpu.read(&buffers.offsets, (pixels + 1) * 4)?);
                (offsets, pod_collect_to_vec(&gpu.read(&buffers.fragments, used * 4)?))
            }
            Storage::LinkedLists => {
                let heads: Vec<u32> = pod_collect_to_vec(&gpu.read(&buffers.counts, pixels * 4)?);
                let bytes = used * size_of::<LinkedNode>() as u64;
                let nodes: Vec<LinkedNode> =
                    pod_collect_to_vec(&gpu.read(&buffers.fragments, bytes)?);
                follow(&heads, &nodes)
            }
        };
        Ok(Self { counters, size_px: settings.size_px, offsets, depths_m })
    }

    /// Depths of a pixel, metres from the near end of its image. With [`Storage::Arrays`] they ascend. `None` if
    /// there is no such pixel, or its list did not fit.
    pub fn list(&self, direction: u32, pixel: UVec2) -> Option<&[f32]> {
        if pixel.max_element() >= self.size_px {
            return None;
        }
        let row = direction.checked_mul(self.size_px)?.checked_add(pixel.y)?;
        let ix = row.checked_mul(self.size_px)?.checked_add(pixel.x)? as usize;
        let ends = self.offsets.get(ix..=ix.checked_add(1)?)?;
        self.depths_m.get(ends[0] as usize..ends[1] as usize)
    }

    /// Depths of all pixels together.
    pub fn fragment_count(&self) -> usize {
        self.depths_m.len()
    }
}

/// Offsets and depths of linked lists. A list that leaves the nodes or closes a circle ends there.
fn follow(heads: &[u32], nodes: &[LinkedNode]) -> (Vec<u32>, Vec<f32>) {
    let mut offsets = vec![0];
    let mut depths_m = Vec::with_capacity(nodes.len());
    for &head in heads {
        let mut next = head;
        while let Some(node) = nodes.get((next as usize).wrapping_sub(1)) {
            if depths_m.len() == nodes.len() {
                break;
            }
            depths_m.push(node.depth_m);
            next = node.next;
        }
        offsets.push(depths_m.len() as u32);
    }
    (offsets, depths_m)
}
