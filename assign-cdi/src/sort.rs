//! Sorts many lists of keys at once.
//!
//! 1. `sort_short` gives each list one thread. The thread sorts up to 32 keys in registers, by a network of exchanges
//!    (Archer et al. 2019, section 3.1). It appends a longer list to the work list, in parts of 2048 keys.
//! 2. `sort_parts` gives each part one workgroup, which sorts it by a bitonic network in workgroup memory.
//! 3. `merge_round` merges lists of several parts, two sorted runs at a time. Each workgroup writes 2048 keys of the
//!    merged run; a search along the merge path tells it which keys to read. Rounds alternate between the entries and
//!    a scratch buffer.
//!
//! Worked example: three lists of 5, 100 and 5000 keys. The thread of the first list sorts it. The second list is one
//! part. The third has parts of 2048, 2048 and 904 keys. Round 0 merges these to runs of 4096 and 904 in the scratch
//! buffer, and round 1 merges those to 5000 keys in the entries.

use assign::{AssignError, Gpu, Passes, Shader};
use bytemuck::{Pod, Zeroable, bytes_of};

use crate::{
    kernel::{self, Slot},
    sort_network,
};

/// The lists to sort.
#[derive(Clone, Copy, Debug)]
pub struct SortInput<'a> {
    /// `array<u32>`: list `i` is entries `offsets[i]` to `offsets[i + 1]`. It is empty if offsets decrease.
    pub offsets: &'a wgpu::Buffer,
    /// The keys: `array<u32>`.
    pub entries: &'a wgpu::Buffer,
    /// Number of lists.
    pub list_count: u32,
    /// Number of entries. Lists that reach beyond it are not sorted.
    pub entry_count: u32,
    /// The most keys per list. A longer list stays unsorted.
    pub longest: u32,
}

impl SortInput<'_> {
    /// Checks that the buffers are large enough for their counts.
    fn check(&self) -> Result<(), AssignError> {
        let lists = u64::from(self.list_count);
        if self.entry_count > MOST_ENTRIES || lists > u64::from(MOST_ENTRIES) {
            return Err(AssignError::TooLarge {
                what: format!("a sort of {} entries in {lists} lists", self.entry_count),
                bytes: u64::from(self.entry_count).max(lists) * 4,
                limit: u64::from(MOST_ENTRIES) * 4,
            });
        }
        let buffers = [
            ("offsets", self.offsets.size(), (lists + 1) * 4),
            ("entries", self.entries.size(), u64::from(self.entry_count) * 4),
        ];
        for (field, has, needed) in buffers {
            if has < needed {
                return Err(AssignError::Parameter {
                    field: format!("buffer of {field} of a sort"),
                    value: format!("{has} bytes"),
                    accepted: format!("at least {needed} bytes"),
                });
            }
        }
        Ok(())
    }
}

/// What the kernels read: `struct Sort` of `sort_keys.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct SortUniform {
    /// Number of lists.
    pub list_count: u32,
    /// Number of entries.
    pub entry_count: u32,
    /// The most parts that fit the work list.
    pub part_capacity: u32,
    /// The most blocks that fit the work list.
    pub block_capacity: u32,
}

/// One round of merges: `struct Round` of `sort_long.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct RoundUniform {
    /// Keys of a sorted run before the round, as a power of two.
    pub run_log2: u32,
    /// 1: runs are in the scratch buffer and merge into the entries. 0: the other way round.
    pub is_odd: u32,
}

/// The work for whole workgroups: `struct WorkHeader` of `sort_work.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct SortWork {
    /// Workgroups over parts.
    pub part_groups: [u32; 3],
    /// Number of parts.
    pub part_count: u32,
    /// Workgroups over blocks.
    pub block_groups: [u32; 3],
    /// Number of blocks.
    pub block_count: u32,
    /// Number of keys of the longest list in the last sort.
    pub longest: u32,
    /// Pads to a multiple of 16 bytes.
    pub padding: [u32; 3],
}

/// The most keys that a workgroup sorts in its memory: `PART` of `sort_keys.wesl`.
const PART: u32 = 2048;

/// Sorts lists of keys in ascending order, in place.
#[derive(Debug)]
pub struct ListSort {
    short: wgpu::ComputePipeline,
    parts: wgpu::ComputePipeline,
    merge: wgpu::ComputePipeline,
    layouts: [wgpu::BindGroupLayout; 4],
    uniform: wgpu::Buffer,
    /// The header of an empty work list.
    empty_work: wgpu::Buffer,
    work: wgpu::Buffer,
    /// A `struct Round` every 256 bytes.
    rounds: wgpu::Buffer,
    scratch: wgpu::Buffer,
    items: [wgpu::Buffer; 2],
    groups: Option<[wgpu::BindGroup; 4]>,
    list_count: u32,
    round_count: u32,
}

/// The most entries of a buffer, 4 GiB, and the rounds that merge a list of that length.
const MOST_ENTRIES: u32 = 1 << 30;
const MOST_ROUNDS: u32 = MOST_ENTRIES.ilog2() - PART.ilog2() + 1;

impl ListSort {
    /// Makes the kernels.
    pub fn new(gpu: &Gpu) -> Result<Self, AssignError> {
        let shader = Self::shader();
        let short = kernel::uncounted(gpu, &shader, "package::sort_short")?;
        let long = kernel::uncounted(gpu, &shader, "package::sort_long")?;
        let stages = wgpu::ShaderStages::COMPUTE;
        let layout = |slots: &[Slot]| kernel::layout(gpu, "sort", stages, slots);
        let layouts = [
            layout(&[Slot::Uniform, Slot::Read, Slot::Write, Slot::Write]),
            layout(&[Slot::Write; 3]),
            layout(&[Slot::Read; 3]),
            layout(&[Slot::UniformAt]),
        ];
        let [keys, append, read, round] = &layouts;
        let sort = Self {
            short: kernel::pipeline(gpu, &short, "sort_short", &[keys, append]),
            parts: kernel::pipeline(gpu, &long, "sort_parts", &[keys, read]),
            merge: kernel::pipeline(gpu, &long, "merge_round", &[keys, read, round]),
            uniform: gpu.uniform("sort", size_of::<SortUniform>() as u64),
            empty_work: gpu.storage("empty sort work", size_of::<SortWork>() as u64)?,
            work: work_buffer(gpu)?,
            rounds: gpu.uniform("sort rounds", u64::from(MOST_ROUNDS) * 256),
            scratch: gpu.storage("sort scratch", 4)?,
            items: [gpu.storage("sort parts", 8)?, gpu.storage("sort blocks", 8)?],
            groups: None,
            list_count: 0,
            round_count: 0,
            layouts,
        };
        let empty =
            SortWork { part_groups: [0, 1, 1], block_groups: [0, 1, 1], ..SortWork::default() };
        gpu.queue.write_buffer(&sort.empty_work, 0, bytes_of(&empty));
        for round in 0..MOST_ROUNDS {
            let uniform = RoundUniform { run_log2: PART.ilog2() + round, is_odd: round % 2 };
            gpu.queue.write_buffer(&sort.rounds, u64::from(round) * 256, bytes_of(&uniform));
        }
        Ok(sort)
    }

    /// The kernels' modules. The roots are `package::sort_short` and `package::sort_long`.
    pub fn shader() -> Shader<'static> {
        Shader::new(3)
            .module("package::sort_network", sort_network::module(&[8, 16, 32]))
            .module("package::sort_keys", include_str!("shaders/sort_keys.wesl"))
            .module("package::sort_work", include_str!("shaders/sort_work.wesl"))
            .module("package::sort_short", include_str!("shaders/sort_short.wesl"))
            .module("package::sort_long", include_str!("shaders/sort_long.wesl"))
    }

    /// Sizes the scratch buffers and binds the buffers of the input. Call it again whenever one is replaced.
    pub fn prepare(&mut self, gpu: &Gpu, input: &SortInput<'_>) -> Result<(), AssignError> {
        input.check()?;
        let longest = input.longest.min(input.entry_count);
        let is_merged = longest > PART;
        // A part holds more than 32 keys, and a list of several parts more than 2048. Only a list's last part may
        // be shorter.
        let part_capacity = input.entry_count / 32 + 1;
        let block_capacity = if is_merged { input.entry_count / (PART / 2) + 2 } else { 0 };
        let scratch_bytes = if is_merged { u64::from(input.entry_count) * 4 } else { 0 };
        let [parts, blocks] = &mut self.items;
        grow(gpu, parts, "sort parts", u64::from(part_capacity) * 8)?;
        grow(gpu, blocks, "sort blocks", u64::from(block_capacity) * 8)?;
        grow(gpu, &mut self.scratch, "sort scratch", scratch_bytes)?;
        let uniform = SortUniform {
            list_count: input.list_count,
            entry_count: input.entry_count,
            part_capacity,
            block_capacity,
        };
        gpu.queue.write_buffer(&self.uniform, 0, bytes_of(&uniform));
        self.list_count = input.list_count;
        let merges = longest.div_ceil(PART).max(1).next_power_of_two().ilog2();
        // One more round copies back lists that end in the scratch buffer.
        self.round_count = if is_merged { merges + 1 } else { 0 };
        let [keys, append, read, round] = &self.layouts;
        let key_buffers = [&self.uniform, input.offsets, input.entries, &self.scratch];
        let item_buffers = [&self.work, &self.items[0], &self.items[1]];
        let round_entry = wgpu::BindGroupEntry {
            binding: 0,
            resource: wgpu::BindingResource::Buffer(wgpu::BufferBinding {
                buffer: &self.rounds,
                offset: 0,
                size: wgpu::BufferSize::new(size_of::<RoundUniform>() as u64),
            }),
        };
        self.groups = Some([
            kernel::bind_buffers(gpu, keys, &key_buffers),
            kernel::bind_buffers(gpu, append, &item_buffers),
            kernel::bind_buffers(gpu, read, &item_buffers),
            kernel::bind_entries(gpu, round, &[round_entry]),
        ]);
        Ok(())
    }

    /// Records the whole sort as one pass.
    pub fn record(&self, passes: &mut dyn Passes, name: &str) {
        self.record_reset(passes.encoder());
        passes.compute(name, &mut |pass| self.dispatch(pass));
    }

    /// Empties the work list. Call it before each [`dispatch`](Self::dispatch), in the same encoder.
    pub fn record_reset(&self, encoder: &mut wgpu::CommandEncoder) {
        let bytes = size_of::<SortWork>() as u64;
        encoder.copy_buffer_to_buffer(&self.empty_work, 0, &self.work, 0, bytes);
    }

    /// Records the sort into an open pass. Before [`prepare`](Self::prepare) it records nothing.
    pub fn dispatch(&self, pass: &mut wgpu::ComputePass<'_>) {
        let Some([keys, append, read, round]) = &self.groups else { return };
        if self.list_count == 0 {
            return;
        }
        pass.set_pipeline(&self.short);
        pass.set_bind_group(0, keys, &[]);
        pass.set_bind_group(1, append, &[]);
        pass.dispatch_workgroups(kernel::workgroups(u64::from(self.list_count), 256), 1, 1);
        pass.set_pipeline(&self.parts);
        pass.set_bind_group(1, read, &[]);
        pass.dispatch_workgroups_indirect(&self.work, 0);
        pass.set_pipeline(&self.merge);
        for ix in 0..self.round_count {
            pass.set_bind_group(2, round, &[ix * 256]);
            pass.dispatch_workgroups_indirect(&self.work, 16);
        }
    }

    /// Offset of [`SortWork::longest`] in [`work`](Self::work), bytes.
    pub const LONGEST_AT: u64 = 32;

    /// The header of the work list: [`SortWork`].
    pub fn work(&self) -> &wgpu::Buffer {
        &self.work
    }

    /// Bytes of its buffers on the GPU.
    pub fn bytes(&self) -> u64 {
        let items = self.items[0].size() + self.items[1].size();
        let small = self.uniform.size() + self.empty_work.size() + self.rounds.size();
        self.scratch.size() + items + self.work.size() + small
    }
}

fn work_buffer(gpu: &Gpu) -> Result<wgpu::Buffer, AssignError> {
    let copies = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
    let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::INDIRECT | copies;
    gpu.buffer("sort work", size_of::<SortWork>() as u64, usage)
}

/// Replaces a storage buffer that is smaller than `bytes`.
fn grow(gpu: &Gpu, buffer: &mut wgpu::Buffer, label: &str, bytes: u64) -> Result<(), AssignError> {
    if buffer.size() < bytes {
        *buffer = gpu.storage(label, bytes)?;
    }
    Ok(())
}
