//! Runs a compute kernel once, for tests and examples: uploads buffers, dispatches, and reads values back.
//!
//! ```no_run
//! # use assign::{Gpu, Shader, conformance::{Bound, download, run_kernel, upload}, kernel::Slot};
//! # fn main() -> Result<(), assign::AssignError> {
//! let gpu = Gpu::open(None)?;
//! let double = "
//!     @group(0) @binding(0) var<storage, read_write> values: array<u32>;
//!     @compute @workgroup_size(64)
//!     fn double(@builtin(global_invocation_id) id: vec3u) {
//!       if id.x < arrayLength(&values) {
//!         values[id.x] *= 2u;
//!       }
//!     }";
//! let module = Shader::new(1).module("package::double", double).create(&gpu, "package::double")?;
//! let values = upload(&gpu, "values", &[1_u32, 2, 3, 4])?;
//! run_kernel(&gpu, &module, "double", &[Bound::Buffers(&[(0, Slot::Write, &values)])], 1);
//! assert_eq!(download::<u32>(&gpu, &values, 4)?, [2, 4, 6, 8]);
//! # Ok(())
//! # }
//! ```

use bytemuck::{NoUninit, Pod};

use crate::{
    AssignError, Gpu,
    entries::entry,
    kernel::{Slot, bind_entries},
};

/// What one bind group of a kernel holds.
#[derive(Clone, Copy, Debug)]
pub enum Bound<'a> {
    /// The kernel does not use this group.
    Nothing,
    /// A bind group that exists already, with its layout.
    Group(&'a wgpu::BindGroupLayout, &'a wgpu::BindGroup),
    /// Whole buffers: binding, kind and buffer.
    Buffers(&'a [(u32, Slot, &'a wgpu::Buffer)]),
}

/// Runs `entry_point` once over `workgroups` along x, with `groups` as bind groups 0, 1, 2 and so on.
pub fn run_kernel(
    gpu: &Gpu,
    module: &wgpu::ShaderModule,
    entry_point: &str,
    groups: &[Bound<'_>],
    workgroups: u32,
) {
    let groups: Vec<_> = groups.iter().map(|bound| bind(gpu, bound)).collect();
    let layouts: Vec<_> =
        groups.iter().map(|group| group.as_ref().map(|(layout, _)| layout)).collect();
    let pipeline = gpu.compute_pipeline(module, entry_point, &layouts, true);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut pass = encoder.begin_compute_pass(&Default::default());
    pass.set_pipeline(&pipeline);
    for (index, group) in (0..).zip(&groups) {
        if let Some((_, group)) = group {
            pass.set_bind_group(index, group, &[]);
        }
    }
    pass.dispatch_workgroups(workgroups, 1, 1);
    drop(pass);
    gpu.queue.submit([encoder.finish()]);
}

fn bind(gpu: &Gpu, bound: &Bound<'_>) -> Option<(wgpu::BindGroupLayout, wgpu::BindGroup)> {
    match *bound {
        Bound::Nothing => None,
        Bound::Group(layout, group) => Some((layout.clone(), group.clone())),
        Bound::Buffers(buffers) => {
            let stages = wgpu::ShaderStages::COMPUTE;
            let slots: Vec<_> =
                buffers.iter().map(|&(binding, slot, _)| slot.entry(binding, stages)).collect();
            let entries: Vec<_> =
                buffers.iter().map(|&(binding, _, buffer)| entry(binding, buffer)).collect();
            let layout = gpu.bind_group_layout("kernel", &slots);
            let group = bind_entries(gpu, &layout, &entries);
            Some((layout, group))
        }
    }
}

/// A storage or uniform buffer that holds `values`.
pub fn upload<T: NoUninit>(
    gpu: &Gpu,
    label: &str,
    values: &[T],
) -> Result<wgpu::Buffer, AssignError> {
    let bytes: &[u8] = bytemuck::cast_slice(values);
    let usage = wgpu::BufferUsages::STORAGE
        | wgpu::BufferUsages::UNIFORM
        | wgpu::BufferUsages::COPY_SRC
        | wgpu::BufferUsages::COPY_DST;
    let buffer = gpu.buffer(label, bytes.len() as u64, usage)?;
    gpu.queue.write_buffer(&buffer, 0, bytes);
    Ok(buffer)
}

/// The first `count` values of a buffer. Blocks until the device has written them.
pub fn download<T: Pod>(
    gpu: &Gpu,
    buffer: &wgpu::Buffer,
    count: usize,
) -> Result<Vec<T>, AssignError> {
    let bytes = gpu.read(buffer, (count * size_of::<T>()) as u64)?;
    Ok(bytemuck::pod_collect_to_vec(&bytes))
}
