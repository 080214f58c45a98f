//! Reads small values back without waiting, through a ring of staging buffers.

use std::{
    marker::PhantomData,
    sync::{
        Arc,
        atomic::{AtomicU8, Ordering},
    },
};

use bytemuck::Pod;

use crate::{Gpu, hitches::Counted};

/// Read-backs that may be in flight at once; further ones are skipped.
const DEPTH: usize = 4;

/// What became of a copy. The number is that of the state.
const PENDING: u8 = 0;
const MAPPED: u8 = 1;
const FAILED: u8 = 2;

/// Tells how a copy ended, also if its encoder was dropped and nothing was submitted.
struct Ending(Arc<AtomicU8>);

impl Drop for Ending {
    fn drop(&mut self) {
        // If the copy has ended, the state is another one already.
        let _ = self.0.compare_exchange(PENDING, FAILED, Ordering::AcqRel, Ordering::Acquire);
    }
}

#[derive(Debug)]
struct Slot {
    buffer: wgpu::Buffer,
    /// The number of the record that copied to it, and what became of the copy; `None` if the slot is free.
    copy: Option<(u64, Arc<AtomicU8>)>,
}

/// Reads a `T` from the start of a GPU buffer without waiting. The value arrives one or more frames
/// late.
#[derive(Debug)]
pub struct Readback<T> {
    slots: Vec<Slot>,
    counted: Arc<Counted>,
    /// The newest value, with the number of its record.
    latest: Option<(u64, T)>,
    recorded: u64,
    value: PhantomData<T>,
}

impl<T: Pod> Readback<T> {
    /// Makes the staging buffers.
    pub fn new(gpu: &Gpu, label: &str) -> Self {
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let buffer = || gpu.make_buffer(label, size_of::<T>() as u64, usage);
        Self {
            slots: (0..DEPTH).map(|_| Slot { buffer: buffer(), copy: None }).collect(),
            counted: Arc::clone(&gpu.counted),
            latest: None,
            recorded: 0,
            value: PhantomData,
        }
    }

    /// Copies the value at a place of a buffer, bytes, and maps the copy as soon as the encoder is submitted. Does
    /// nothing while all staging buffers are in flight.
    pub fn record(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        source: &wgpu::Buffer,
        offset: u64,
    ) {
        self.poll();
        let Some(slot) = self.slots.iter_mut().find(|slot| slot.copy.is_none()) else { return };
        encoder.copy_buffer_to_buffer(source, offset, &slot.buffer, 0, slot.buffer.size());
        let state = Arc::new(AtomicU8::new(PENDING));
        let ending = Ending(Arc::clone(&state));
        self.counted.map(&slot.buffer, Some(encoder), move |result| {
            ending.0.store(if result.is_ok() { MAPPED } else { FAILED }, Ordering::Release);
        });
        self.recorded += 1;
        slot.copy = Some((self.recorded, state));
    }

    /// Takes the values that have arrived. It asks nothing of the device: values arrive whenever the renderer submits,
    /// polls or waits.
    pub fn poll(&mut self) {
        for Slot { buffer, copy } in &mut self.slots {
            let Some((number, state)) = copy else { continue };
            let state = state.load(Ordering::Acquire);
            if state == PENDING {
                continue;
            }
            if state == MAPPED {
                self.counted.add_map(buffer.size());
                // A lost device has destroyed the buffer, and refuses to unmap it.
                if let Ok(view) = buffer.get_mapped_range(..) {
                    let is_newer = self.latest.as_ref().is_none_or(|(newest, _)| *newest < *number);
                    if is_newer {
                        self.latest = Some((*number, bytemuck::pod_read_unaligned(&view)));
                    }
                    drop(view);
                    buffer.unmap();
                }
            }
            *copy = None;
        }
    }

    /// Bytes of its buffers.
    pub fn bytes(&self) -> u64 {
        self.slots.iter().map(|slot| slot.buffer.size()).sum()
    }

    /// The newest value that has arrived.
    pub fn latest(&self) -> Option<T> {
        self.latest.map(|(_, value)| value)
    }
}
