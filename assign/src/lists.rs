//! The light lists on the GPU: their layout, what happens on overflow, and how they grow.
//!
//! `lists[g + 1] = (first, count)` points into `entries`. Record 0 lists all lights. The entries
//! begin with all lights in order; the pool from which groups reserve follows them. A group whose
//! list does not fit gets the record `(0, light_count)`, which is slow but correct, and the
//! overflow is counted. The counters stand behind the last record, in the same buffer: WebGPU promises a shader no more
//! than eight storage buffers.
//!
//! Other storages than plain lists have essays of their own: `masks.rs`, `scalar_masks.rs` and `trees.rs`.
//!
//! Worked example: 5 lights, capacity for 8, lists of 2, 0 and 3 entries:
//! `lists = [(0, 5), (8, 2), (0, 0), (10, 3)]`, `entries = [0 1 2 3 4 - - - | a b c d e]`.

mod sizes;

use bytemuck::{bytes_of, cast_slice, pod_collect_to_vec};

use crate::{
    AssignError, Counters, CullUniform, FrameWrites, Gpu, LightBuffer, LightList, ListsSnapshot,
    Storage, events, light_nodes::NodeLevels, masks::MaskLayout, readback::Readback,
};

/// The most entries of the pool, 4 GiB. `CAREFUL` in `reserve.wesl` relies on it.
const MAX_POOL: u64 = 1 << 30;

/// Bytes of one set of counters.
const COUNTERS_BYTES: u64 = size_of::<Counters>() as u64;

/// The lists of one strategy. Buffers grow between frames, which no clock times.
#[derive(Debug)]
pub struct LightLists {
    storage: Storage,
    /// The sizes of bit masks.
    masks: MaskLayout,
    lists: wgpu::Buffer,
    entries: wgpu::Buffer,
    uniform: wgpu::Buffer,
    light_capacity: u32,
    pool_capacity: u32,
    /// The user's upper limit. The device's limit applies as well.
    pool_limit: u32,
    /// The pool has room for so many times the entries of one frame.
    room: u32,
    list_cap: u32,
    generation: u32,
    counts: (u32, u32),
    readback: Readback<Counters>,
    /// What the strategy uploads for a frame.
    writes: FrameWrites,
    /// Whether the frame's writes were recorded before the pass that fills the lists.
    is_written: bool,
}

impl LightLists {
    /// Empty lists.
    pub fn new(gpu: &Gpu) -> Result<Self, AssignError> {
        Self::stored_as(gpu, Storage::Lists)
    }

    /// Empty lists in a storage.
    pub fn stored_as(gpu: &Gpu, storage: Storage) -> Result<Self, AssignError> {
        Ok(Self {
            storage,
            masks: MaskLayout::default(),
            lists: gpu.storage("light lists", 8 + COUNTERS_BYTES)?,
            entries: gpu.storage("light entries", 4)?,
            uniform: gpu.uniform("cull", size_of::<CullUniform>() as u64),
            light_capacity: 0,
            pool_capacity: 0,
            pool_limit: u32::MAX,
            room: 1,
            list_cap: u32::MAX,
            generation: 0,
            counts: (0, 0),
            readback: Readback::new(gpu, "list counters"),
            writes: FrameWrites::new(gpu),
            is_written: false,
        })
    }

    /// Caps the pool at `entries`, for tests of overflow and tight memory budgets.
    pub fn limit_pool(&mut self, entries: u32) {
        self.pool_limit = entries;
        self.pool_capacity = self.pool_capacity.min(entries);
        // Forces the next `prepare` to lay the buffers out again.
        self.light_capacity = 0;
        self.expire();
    }

    /// Keeps only the first `lights` of each list. **Lossy**: it drops the others, as renderers
    /// with fixed-length lists do. [`u32::MAX`] drops none. A list that overflows the pool still
    /// becomes all lights.
    pub fn cap_lists(&mut self, lights: u32) {
        self.list_cap = lights;
        self.expire();
    }

    /// Makes the pool so many times larger than one frame's entries, for new lists while others stay.
    pub(crate) fn leave_room(&mut self, room: u32) {
        self.room = room;
    }

    /// Whether the pool has room for new lists while others stay.
    pub(crate) fn leaves_room(&self) -> bool {
        self.room > 1
    }

    /// Takes the limits of other lists: those of the pool and of the lists' length. A strategy for another view has
    /// the same limits.
    pub fn limit_as(&mut self, other: &Self) {
        self.pool_limit = other.pool_limit;
        self.list_cap = other.list_cap;
        self.room = other.room;
    }

    /// Takes the counters that have arrived.
    fn take_counters(&mut self) {
        let before = self.readback.latest();
        self.readback.poll();
        if let Some(now) = self.readback.latest().filter(|now| before != Some(*now)) {
            events::counted(before, now);
        }
    }

    /// Words for which the pool needs room, as far as the counters that have arrived tell.
    fn asked(&self) -> u64 {
        let words = |counters: Counters| {
            self.storage.pool_words(counters.requested(), counters.occupied_groups.into())
        };
        self.readback.latest().map_or(0, words) * u64::from(self.room)
    }

    /// The most entries that the pool may have, behind those of all lights.
    fn most_entries(&self, gpu: &Gpu, light_capacity: u32) -> u64 {
        let room = (gpu.max_storage_bytes() / 4).saturating_sub(u64::from(light_capacity));
        room.min(MAX_POOL).min(u64::from(self.pool_limit))
    }

    /// Whether a frame that makes all lists would grow the pool, as far as the counters that have arrived
    /// tell. Until then, lists that did not fit stay all lights.
    pub(crate) fn wants_growth(&mut self, gpu: &Gpu) -> bool {
        self.take_counters();
        if self.storage.is_mask() {
            return false;
        }
        self.asked().min(self.most_entries(gpu, self.light_capacity))
            > u64::from(self.pool_capacity)
    }

    /// Rejects lists that serve only the frame that made them. `strategy` is the strategy's id, and `asked` is what
    /// needs lists in later frames.
    pub(crate) fn check_later_frames(
        &self,
        strategy: String,
        asked: &str,
    ) -> Result<(), AssignError> {
        if self.storage.serves_later_frames() {
            return Ok(());
        }
        let reason =
            "the depths of a tree hold for the view and the lights of the frame that made it";
        Err(AssignError::Unsupported { strategy, asked: asked.into(), reason: reason.into() })
    }

    /// Whether lists lose lights beyond a number.
    pub(crate) fn is_capped(&self) -> bool {
        self.list_cap != u32::MAX
    }

    /// Marks the lists as outdated. A strategy that keeps lists over frames
    /// ([`Reuse`](crate::Reuse)) then makes them again.
    pub fn expire(&mut self) {
        self.generation = self.generation.wrapping_add(1);
    }

    /// How often the lists have [expired](Self::expire).
    pub fn generation(&self) -> u32 {
        self.generation
    }

    /// Sizes the buffers for a frame and grows the pool to what earlier frames requested. Returns
    /// whether it replaced a buffer; bind groups must then be made again.
    pub fn prepare(
        &mut self,
        gpu: &Gpu,
        lights: &LightBuffer,
        group_count: u32,
    ) -> Result<bool, AssignError> {
        let (light_count, levels) = (lights.count(), lights.levels());
        self.take_counters();
        let asked = self.asked();
        let records = u64::from(group_count) + 1;
        let bytes = records * 8 + COUNTERS_BYTES;
        let larger =
            if self.lists.size() < bytes { Some(gpu.storage("light lists", bytes)?) } else { None };
        let mut changed = if self.storage.is_mask() {
            self.size_masks(gpu, light_count, records)?
        } else {
            self.size_entries(gpu, light_count, group_count, asked)?
        };
        if let Some(lists) = larger {
            self.lists = lists;
            changed = true;
        }
        self.counts = (light_count, group_count);
        self.upload(levels)?;
        Ok(changed)
    }

    /// Prepares a frame that makes only some lists, for as many lights and groups as the frame before.
    /// It replaces no buffer, because the others stay.
    pub(crate) fn prepare_update(&mut self, lights: &LightBuffer) -> Result<(), AssignError> {
        self.take_counters();
        self.upload(lights.levels())
    }

    /// Uploads the numbers of the prepared frame.
    fn upload(&mut self, levels: NodeLevels) -> Result<(), AssignError> {
        self.is_written = false;
        let (light_count, group_count) = self.counts;
        let records = u64::from(group_count) + 1;
        let all_pairs = u64::from(light_count) * records;
        let most_words =
            self.storage.pool_words(all_pairs, records) + u64::from(self.pool_capacity);
        // In every frame, because a number that the GPU wrote may have replaced it.
        let all = LightList { first: self.masks.summary, count: light_count };
        self.writes.write(&self.lists, 0, bytes_of(&all))?;
        if self.masks.stride > 0 {
            let all = vec![u32::MAX; self.masks.stride as usize];
            self.writes.write(&self.entries, 0, cast_slice(&all))?;
        }
        let cull = CullUniform {
            light_count,
            group_count,
            pool_first: self.light_capacity,
            pool_capacity: self.pool_capacity,
            // Frames that make only some lists begin anywhere in the pool.
            guard_cursor: u32::from(u32::try_from(most_words).is_err()),
            list_cap: self.list_cap,
            first_parent: levels.first_parent,
            first_grandparent: levels.first_grandparent,
            mask_stride: self.masks.stride,
            mask_summary: self.masks.summary,
        };
        self.writes.write(&self.uniform, 0, bytes_of(&cull))
    }

    /// What the strategy uploads for a frame. Besides what the strategy adds, it holds the lists' own numbers.
    pub fn writes_mut(&mut self) -> &mut FrameWrites {
        &mut self.writes
    }

    /// Records the frame's [writes](Self::writes_mut). A strategy with passes before those that make lists calls it
    /// before them; for all others [`record_reset`](Self::record_reset) does it.
    pub fn record_writes(&mut self, encoder: &mut wgpu::CommandEncoder) {
        self.writes.record(encoder);
        self.is_written = true;
    }

    /// Records the frame's [writes](Self::writes_mut), if that is still to do, and resets the counters. Call it in
    /// the encoder of the pass that fills the lists, before that pass. So counters count one frame only, whatever
    /// happened to earlier frames. `live_count` is [`LightBuffer::live_count`]: if only the GPU knows the number of
    /// lights, it is copied to where kernels and shading read it.
    pub fn record_reset(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        live_count: Option<&wgpu::Buffer>,
    ) {
        self.record_light_count(encoder, live_count);
        encoder.clear_buffer(&self.lists, self.counters_at(), Some(COUNTERS_BYTES));
    }

    /// Records the writes that are still to do, and copies the number of lights to where kernels and shading read it,
    /// if only the GPU knows it.
    pub(crate) fn record_light_count(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        live_count: Option<&wgpu::Buffer>,
    ) {
        if !self.is_written {
            self.writes.record(encoder);
        }
        if let Some(count) = live_count {
            // `CullUniform::light_count`, and the count of record 0.
            encoder.copy_buffer_to_buffer(count, 0, &self.uniform, 0, 4);
            encoder.copy_buffer_to_buffer(count, 0, &self.lists, 4, 4);
        }
    }

    /// Copies the counters for [`stats`](Self::stats). Call it after the last pass that counts.
    pub fn record_readback(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let at = self.counters_at();
        self.readback.record(encoder, &self.lists, at);
    }

    /// Where the counters are in the buffer of records, bytes: behind the last record.
    pub(crate) fn counters_at(&self) -> u64 {
        (u64::from(self.counts.1) + 1) * 8
    }

    /// The newest counters that have arrived. They may be a few frames old.
    pub fn stats(&self) -> Option<Counters> {
        self.readback.latest()
    }

    /// Reads everything back. Blocks until the device has finished.
    pub fn snapshot(&self, gpu: &Gpu) -> Result<ListsSnapshot, AssignError> {
        let records = gpu.read(&self.lists, self.counters_at() + COUNTERS_BYTES)?;
        let (lists, counters) = records.split_at(self.counters_at() as usize);
        let counters: Counters = bytemuck::pod_read_unaligned(counters);
        let lists: Vec<LightList> = pod_collect_to_vec(lists);
        let used = if self.storage.is_mask() {
            (self.counts.1 + 1) * self.masks.stride
        } else {
            self.light_capacity + counters.cursor.min(self.pool_capacity)
        };
        let entries: Vec<u32> = pod_collect_to_vec(&gpu.read(&self.entries, u64::from(used) * 4)?);
        let (lists, entries) = if self.storage.is_mask() {
            self.masks.decode(&lists, &entries)
        } else {
            (lists, entries)
        };
        Ok(ListsSnapshot { lists, entries, counters })
    }

    /// Where the lights of a group are kept.
    pub fn storage(&self) -> Storage {
        self.storage
    }

    /// Number of groups of the last prepared frame.
    pub fn group_count(&self) -> u32 {
        self.counts.1
    }

    /// Bytes of groups, entries and counters on the GPU.
    pub fn bytes(&self) -> u64 {
        self.lists.size() + self.entries.size() + self.uniform.size()
    }

    /// As [`bytes`](Self::bytes), plus the buffers through which data go to and from the GPU.
    pub fn memory_bytes(&self) -> u64 {
        self.bytes() + self.readback.bytes() + self.writes.bytes()
    }

    /// The records: `array<LightList>`, and behind those of the frame's groups the counters.
    pub fn lists(&self) -> &wgpu::Buffer {
        &self.lists
    }

    /// The entries: `array<u32>`.
    pub fn entries(&self) -> &wgpu::Buffer {
        &self.entries
    }

    /// The culling kernel's parameters: `struct Cull`.
    pub fn uniform(&self) -> &wgpu::Buffer {
        &self.uniform
    }
}
