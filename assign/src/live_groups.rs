//! The groups to which a sparse strategy gives lists: group indices on the GPU, and the size of the
//! indirect dispatch over them.

use crate::{AssignError, Gpu};

/// The indices of the groups to cull, which a strategy's own pass writes: `struct LiveGroups` of
/// `live.wesl`.
///
/// A strategy clears it at the start of a frame (`clear_live`) and appends each group once
/// (`append_live`). [`Culler`](crate::Culler) then culls only those groups. The records of the others are the strategy's:
/// unless its look-up never returns such a group, it copies record 0 to them, so that they read all lights.
#[derive(Debug)]
pub struct LiveGroups {
    buffer: wgpu::Buffer,
    most: u32,
}

/// Bytes before the ids: three workgroup counts and the number of groups.
const HEADER: u64 = 16;

impl LiveGroups {
    /// Makes a list without room for groups.
    pub fn new(gpu: &Gpu) -> Result<Self, AssignError> {
        Ok(Self { buffer: allocate(gpu, 0)?, most: 0 })
    }

    /// Makes room for `most` groups. Returns whether it replaced the buffer; bind groups must then
    /// be made again.
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

    /// The WESL module that clears and appends. Mount it as `package::live`. It declares the
    /// buffer, writable, at binding 0 of bind group 2.
    pub const WESL: &str = include_str!("shaders/live.wesl");
}

fn allocate(gpu: &Gpu, most: u32) -> Result<wgpu::Buffer, AssignError> {
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT;
    // Shaders that read the workgroup counts as a vector of three see a struct of a multiple of 16
    // bytes.
    gpu.buffer("live groups", HEADER + u64::from(most.max(4)) * 4, usage)
}
