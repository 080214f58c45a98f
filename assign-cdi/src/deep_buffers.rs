//! The buffers of deep images: sized before a frame, grown to what earlier frames asked for.

use assign::{AssignError, Gpu};
use bytemuck::{Pod, Zeroable};
use glam::Vec4;

use crate::{Build, DeepImageSettings, LinkedNode, Storage};

/// Counters of a build: `deep_images.wesl`, `struct Header`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct DeepImageCounters {
    /// Samples asked for; none where each direction visits the geometry.
    pub sample_count: u32,
    /// Fragments asked for by all images; [`u32::MAX`] where they are more.
    pub fragment_count: u32,
    /// Triangles walked by a workgroup each.
    pub large_count: u32,
    /// Triangles left out: they reach out of the scene's box, or are not made of numbers.
    pub rejected_count: u32,
    /// 1 where something did not fit: every ray's length is unknown.
    pub is_overflowed: u32,
    /// Fragments of the longest list; 0 where lists are linked.
    pub longest: u32,
}

/// Byte of [`DeepImageCounters::longest`], and of what it is copied from.
pub(crate) const LONGEST_AT: u64 = 20;

/// The buffers.
#[derive(Debug)]
pub(crate) struct DeepBuffers {
    pub(crate) header: wgpu::Buffer,
    pub(crate) frames: wgpu::Buffer,
    pub(crate) samples: wgpu::Buffer,
    pub(crate) large: wgpu::Buffer,
    pub(crate) counts: wgpu::Buffer,
    pub(crate) offsets: wgpu::Buffer,
    pub(crate) fragments: wgpu::Buffer,
    pub(crate) sample_capacity: u32,
    pub(crate) fragment_capacity: u32,
}

impl DeepBuffers {
    /// Buffers of fixed size are as large as they will be, the others empty.
    pub(crate) fn new(gpu: &Gpu, settings: &DeepImageSettings) -> Result<Self, AssignError> {
        let directions = settings.directions;
        let axes: Vec<[Vec4; 3]> = (0..directions.count())
            .map(|ix| directions.frame(ix))
            .map(|f| [f.x_axis.extend(0.0), f.y_axis.extend(0.0), f.z_axis.extend(0.0)])
            .collect();
        let frames = gpu.storage("direction frames", axes.len() as u64 * 48)?;
        gpu.queue.write_buffer(&frames, 0, bytemuck::cast_slice(&axes));
        let pixels = u64::from(settings.pixel_count());
        // Heads of linked lists are kept in the counts.
        let offsets = if settings.storage == Storage::Arrays { pixels + 1 } else { 1 };
        Ok(Self {
            header: gpu.storage("deep image counters", size_of::<DeepImageCounters>() as u64)?,
            frames,
            samples: gpu.storage("deep image samples", 16)?,
            large: gpu.storage("large triangles", 4)?,
            counts: gpu.storage("fragments per pixel", pixels * 4)?,
            offsets: gpu.storage("fragment offsets", offsets * 4)?,
            fragments: gpu.storage("fragments", 8)?,
            sample_capacity: 0,
            fragment_capacity: 0,
        })
    }

    /// Makes room for a frame, and for what an earlier one asked for. Returns whether fragments moved.
    pub(crate) fn prepare(
        &mut self,
        gpu: &Gpu,
        settings: &DeepImageSettings,
        triangle_count: u32,
        asked: DeepImageCounters,
    ) -> Result<bool, AssignError> {
        let large = u64::from(triangle_count) * 4;
        if self.large.size() < large {
            self.large = gpu.storage("large triangles", large)?;
        }
        let node_bytes = match settings.storage {
            Storage::Arrays => 4,
            Storage::LinkedLists => size_of::<LinkedNode>() as u64,
        };
        let room = gpu.max_storage_bytes() / node_bytes;
        let most = room.min(u64::from(settings.most_fragments)) as u32;
        let directions = settings.directions.count();
        let cells = settings.side_cells().saturating_pow(2);
        let fragments = match settings.build {
            Build::SinglePass { .. } => {
                let guess = cells.saturating_mul(GUESS);
                let wanted = wanted(self.sample_capacity, asked.sample_count, guess);
                // All samples fit where their fragments do.
                let samples = wanted.min((most / directions).max(1));
                if samples > self.sample_capacity {
                    self.samples = gpu.storage("deep image samples", u64::from(samples) * 16)?;
                    self.sample_capacity = samples;
                }
                self.sample_capacity.saturating_mul(directions)
            }
            Build::PerDirection { .. } => {
                let guess = cells.saturating_mul(GUESS).saturating_mul(directions);
                wanted(self.fragment_capacity, asked.fragment_count, guess)
            }
        };
        let fragments = fragments.min(most);
        if fragments <= self.fragment_capacity {
            return Ok(false);
        }
        self.fragments = gpu.storage("fragments", u64::from(fragments) * node_bytes)?;
        self.fragment_capacity = fragments;
        Ok(true)
    }

    pub(crate) fn bytes(&self) -> u64 {
        let fixed = self.header.size() + self.frames.size() + self.counts.size();
        let grown = self.samples.size() + self.large.size() + self.fragments.size();
        fixed + grown + self.offsets.size()
    }
}

/// Samples a cell of the grid until a frame has counted: the paper's scenes have about 6.5 fragments
/// a pixel (4.5 million in 169 images of 64 x 64, from its 18 MB).
const GUESS: u32 = 8;

/// Room for a quarter more than was asked, so that a scene in motion does not grow it each frame.
fn wanted(has: u32, asked: u32, guess: u32) -> u32 {
    if asked > has { asked.saturating_add(asked / 4).max(guess) } else { has.max(guess) }
}
