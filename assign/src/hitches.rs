//! Counts what may make a frame late: pipelines, shader modules, bind groups and buffers that are made, and waits.

use std::sync::atomic::{AtomicU64, Ordering};

/// What a device has made and waited for so far, through its [`Gpu`](crate::Gpu) and the clones of it.
///
/// In a frame that resizes nothing and meets no new kind of light, `prepare` and `record` of every strategy leave all
/// of these numbers as they were.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hitches {
    /// Compute and render pipelines that were compiled.
    pub pipelines: u64,
    /// Shader modules that were linked and compiled.
    pub modules: u64,
    /// Bind groups that were made.
    pub bind_groups: u64,
    /// Buffers that were made.
    pub buffers: u64,
    /// Calls that blocked until the device had finished.
    pub waits: u64,
}

impl Hitches {
    /// The hitches since an earlier count.
    #[must_use]
    pub fn since(self, earlier: Self) -> Self {
        Self {
            pipelines: self.pipelines - earlier.pipelines,
            modules: self.modules - earlier.modules,
            bind_groups: self.bind_groups - earlier.bind_groups,
            buffers: self.buffers - earlier.buffers,
            waits: self.waits - earlier.waits,
        }
    }
}

/// How often the CPU mapped buffers to read them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mapped {
    /// Number of maps.
    pub maps: u64,
    /// Bytes of all of them.
    pub bytes: u64,
}

/// The counters of one device.
#[derive(Debug, Default)]
pub(crate) struct Counted {
    pub(crate) pipelines: AtomicU64,
    pub(crate) modules: AtomicU64,
    pub(crate) bind_groups: AtomicU64,
    pub(crate) buffers: AtomicU64,
    pub(crate) waits: AtomicU64,
    maps: AtomicU64,
    map_bytes: AtomicU64,
}

impl Counted {
    pub(crate) fn add(counter: &AtomicU64, number: u64) {
        counter.fetch_add(number, Ordering::Relaxed);
    }

    /// Maps a whole staging buffer for reading: at once, or as soon as an encoder is submitted. Every map goes through
    /// here. A map at once is counted at once, and other maps when their [value is taken](Self::add_map).
    pub(crate) fn map(
        &self,
        staging: &wgpu::Buffer,
        encoder: Option<&wgpu::CommandEncoder>,
        done: impl FnOnce(Result<(), wgpu::BufferAsyncError>) + Send + 'static,
    ) {
        match encoder {
            None => {
                self.add_map(staging.size());
                staging.map_async(wgpu::MapMode::Read, .., done);
            }
            Some(encoder) => {
                encoder.map_buffer_on_submit(staging, wgpu::MapMode::Read, .., done);
            }
        }
    }

    /// Counts a map of so many bytes.
    pub(crate) fn add_map(&self, bytes: u64) {
        Self::add(&self.maps, 1);
        Self::add(&self.map_bytes, bytes);
    }

    pub(crate) fn hitches(&self) -> Hitches {
        let read = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        Hitches {
            pipelines: read(&self.pipelines),
            modules: read(&self.modules),
            bind_groups: read(&self.bind_groups),
            buffers: read(&self.buffers),
            waits: read(&self.waits),
        }
    }

    pub(crate) fn mapped(&self) -> Mapped {
        let read = |counter: &AtomicU64| counter.load(Ordering::Relaxed);
        Mapped { maps: read(&self.maps), bytes: read(&self.map_bytes) }
    }
}
