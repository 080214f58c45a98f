//! The groups that a sparse strategy gives a list: a list of group indices on the GPU, and the
//! size of the indirect dispatch over it.

use crate::{AssignError, Gpu};

/// Ids of the groups to cull, made by a strategy's own pass: `struct LiveGroups` of `live.wesl`.
///
/// A strategy clears it at the start of a frame (`clear_live`), and appends each group once
/// (`append_live`); [`Culler`](crate::Culler) then culls those groups and no others. Groups that
/// are not appended must never be looked up: their records are those of an earlier frame.
#[derive(Debug)]
pub struct LiveGroups {
    buffer: wgpu::Buffer,
    most: u32,
}

/// Bytes before the ids: three workgroup counts and the number of groups.
const HEADER: u64 = 16;

impl LiveGroups {
    /// Room for no group.
    pub fn new(gpu: &Gpu) -> Result<Self, AssignError> {
        Ok(Self { buffer: allocate(gpu, 0)?, most: 0 })
    }

    /// Makes room for `most` groups. Returns whether the buffer was made anew, so that bind groups
    /// must be.
    pub fn prepare(&mut self, gpu: &Gpu, most: u32) -> Result<bool, AssignError> {
        if most <= self.most {
            return Ok(false);
        }
        self.buffer = allocate(gpu, most)?;
        self.most = most;
        Ok(true)
    }

    /// Bytes of its buffer.
    pub fn bytes(&self) -> u64 {
        self.buffer.size()
    }

    /// The buffer: `struct LiveGroups`.
    pub fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }

    /// The WESL module that clears and appends, to mount as `package::live`: it has the buffer,
    /// writable, at binding 0 of bind group 2.
    pub const WESL: &str = include_str!("shaders/live.wesl");
}

fn allocate(gpu: &Gpu, most: u32) -> Result<wgpu::Buffer, AssignError> {
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT;
    // Read with a vector of three for workgroup counts, the struct is a multiple of 16 bytes.
    gpu.buffer("live groups", HEADER + u64::from(most.max(4)) * 4, usage)
}
