//! Small values read back without waiting: a ring of staging buffers.

use std::{
    marker::PhantomData,
    sync::mpsc::{Receiver, channel},
};

use bytemuck::Pod;

use crate::Gpu;

/// Frames that may be in flight before a read-back is skipped.
const DEPTH: usize = 4;

#[derive(Debug)]
enum State {
    Free,
    /// Copied to by an encoder that has been, or is about to be, submitted; its number.
    Recorded(u64),
    Mapping(u64, Receiver<bool>),
}

/// Reads a `T`, the first bytes of a buffer, back from the GPU without waiting, a frame or more late.
#[derive(Debug)]
pub struct Readback<T> {
    slots: Vec<(wgpu::Buffer, State)>,
    /// The newest value, and the number of its record.
    latest: Option<(u64, T)>,
    recorded: u64,
    value: PhantomData<T>,
}

impl<T: Pod> Readback<T> {
    /// Nothing read yet.
    pub fn new(gpu: &Gpu, label: &str) -> Self {
        let slot = || {
            let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: size_of::<T>() as u64,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            (buffer, State::Free)
        };
        Self {
            slots: (0..DEPTH).map(|_| slot()).collect(),
            latest: None,
            recorded: 0,
            value: PhantomData,
        }
    }

    /// Copies the value; skipped while all slots are in flight.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder, source: &wgpu::Buffer) {
        let free = self.slots.iter_mut().find(|(_, state)| matches!(state, State::Free));
        if let Some((buffer, state)) = free {
            encoder.copy_buffer_to_buffer(source, 0, buffer, 0, size_of::<T>() as u64);
            self.recorded += 1;
            *state = State::Recorded(self.recorded);
        }
    }

    /// Takes what has arrived. Call after the recorded encoder was submitted.
    pub fn poll(&mut self, gpu: &Gpu) {
        for (buffer, state) in &mut self.slots {
            if let State::Recorded(number) = *state {
                let (sender, receiver) = channel();
                buffer.map_async(wgpu::MapMode::Read, .., move |result| {
                    // The receiver is gone where the lists were dropped meanwhile.
                    let _ = sender.send(result.is_ok());
                });
                *state = State::Mapping(number, receiver);
            }
        }
        // A lost device shows at the next submission; here it only means no news.
        let _ = gpu.device.poll(wgpu::PollType::Poll);
        for (buffer, state) in &mut self.slots {
            let State::Mapping(number, receiver) = state else {
                continue;
            };
            let Ok(mapped) = receiver.try_recv() else {
                continue;
            };
            if mapped {
                let is_newer = self.latest.as_ref().is_none_or(|(newest, _)| *newest < *number);
                if is_newer && let Ok(view) = buffer.get_mapped_range(..) {
                    self.latest = Some((*number, bytemuck::pod_read_unaligned(&view)));
                }
                buffer.unmap();
            }
            *state = State::Free;
        }
    }

    /// Bytes of its buffers.
    pub fn bytes(&self) -> u64 {
        self.slots.iter().map(|(buffer, _)| buffer.size()).sum()
    }

    /// The newest value that has arrived.
    pub fn latest(&self) -> Option<T> {
        self.latest.map(|(_, value)| value)
    }
}
