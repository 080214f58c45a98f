//! Reads small values back without waiting, through a ring of staging buffers.

use std::{
    marker::PhantomData,
    sync::mpsc::{Receiver, channel},
};

use bytemuck::Pod;

use crate::Gpu;

/// Read-backs that may be in flight at once; further ones are skipped.
const DEPTH: usize = 4;

#[derive(Debug)]
enum State {
    Free,
    /// An encoder that has been or will be submitted copies to it. The value is the record's
    /// number.
    Recorded(u64),
    Mapping(u64, Receiver<bool>),
}

/// Reads a `T` from the start of a GPU buffer without waiting. The value arrives one or more frames
/// late.
#[derive(Debug)]
pub struct Readback<T> {
    slots: Vec<(wgpu::Buffer, State)>,
    /// The newest value, with the number of its record.
    latest: Option<(u64, T)>,
    recorded: u64,
    value: PhantomData<T>,
}

impl<T: Pod> Readback<T> {
    /// Makes the staging buffers.
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

    /// Copies the value. Does nothing while all staging buffers are in flight.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder, source: &wgpu::Buffer) {
        let free = self.slots.iter_mut().find(|(_, state)| matches!(state, State::Free));
        if let Some((buffer, state)) = free {
            encoder.copy_buffer_to_buffer(source, 0, buffer, 0, size_of::<T>() as u64);
            self.recorded += 1;
            *state = State::Recorded(self.recorded);
        }
    }

    /// Takes the values that have arrived. Call it after the recorded encoder was submitted.
    pub fn poll(&mut self, gpu: &Gpu) {
        for (buffer, state) in &mut self.slots {
            if let State::Recorded(number) = *state {
                let (sender, receiver) = channel();
                gpu.begin_map(buffer, move |result| {
                    // The receiver is gone if the lists were dropped meanwhile.
                    let _ = sender.send(result.is_ok());
                });
                *state = State::Mapping(number, receiver);
            }
        }
        // A lost device shows at the next submission. Here it only means that nothing arrives.
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
