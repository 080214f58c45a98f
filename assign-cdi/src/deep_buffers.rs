//! The buffers of deep images: sized before a frame, and grown to what earlier frames asked for.

use assign::{AssignError, Gpu};
use bytemuck::{Pod, Zeroable};
use glam::Vec4;

use crate::{Build, DeepImageSettings, LinkedNode, Storage};

/// Counters of a build: `struct Header` of `deep_images.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct DeepImageCounters {
    /// Samples asked for; 0 if each direction visits the geometry.
    pub sample_count: u32,
    /// Fragments asked for by all images, at most [`u32::MAX`].
    pub fragment_count: u32,
    /// Large triangles. Each takes a workgroup of its own.
    pub large_count: u32,
    /// Triangles left out because they reach out of the scene's box or have a NaN coordinate.
    pub rejected_count: u32,
    /// 1: something did not fit, and the length of every ray is unknown.
    pub is_overflowed: u32,
    /// Fragments of the longest list; 0 if lists are linked.
    pub longest: u32,
}

/// Offset of [`DeepImageCounters::longest`] in bytes.
pub(crate) const LONGEST_AT: u64 = 20;

/// The buffers of deep images.
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
    /// Makes the buffers of fixed size, and empty ones that grow.
    pub(crate) fn new(gpu: &Gpu, settings: &DeepImageSettings) -> Result<Self, AssignError> {
        let directions = settings.directions;
        let axes: Vec<[Vec4; 3]> = (0..directions.count())
            .map(|ix| directions.frame(ix))
            .map(|f| [f.x_axis.extend(0.0), f.y_axis.extend(0.0), f.z_axis.extend(0.0)])
            .collect();
        let frames = gpu.storage("direction frames", axes.len() as u64 * 48)?;
        gpu.queue.write_buffer(&frames, 0, bytemuck::cast_slice(&axes));
        let pixels = u64::from(settings.pixel_count());
        // Linked lists need no offsets: their heads are in the counts.
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

    /// Makes room for a frame, and for what an earlier frame asked for. Returns whether the buffer of fragments
    /// was replaced.
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
                // No more samples than those whose fragments fit.
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

/// Samples per cell of the grid that a first frame makes room for. The paper's scenes have about 6.5 fragments
/// per pixel (its 18 MB are 4.5 million fragments in 169 images of 64 x 64).
const GUESS: u32 = 8;

/// Room for a quarter more than an earlier frame asked for, so that a scene in motion does not grow the buffers
/// every frame.
fn wanted(has: u32, asked: u32, guess: u32) -> u32 {
    if asked > has { asked.saturating_add(asked / 4).max(guess) } else { has.max(guess) }
}
