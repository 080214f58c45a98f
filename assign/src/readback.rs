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
    /// Copied to by an encoder that has been, or is about to be, submitted.
    Recorded,
    Mapping(Receiver<bool>),
}

/// Reads a `T` back from the GPU, a frame or more late.
#[derive(Debug)]
pub(crate) struct Readback<T> {
    slots: Vec<(wgpu::Buffer, State)>,
    latest: Option<T>,
    value: PhantomData<T>,
}

impl<T: Pod> Readback<T> {
    pub(crate) fn new(gpu: &Gpu, label: &str) -> Self {
        let slot = || {
            let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: size_of::<T>() as u64,
                usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            });
            (buffer, State::Free)
        };
        Self { slots: (0..DEPTH).map(|_| slot()).collect(), latest: None, value: PhantomData }
    }

    /// Copies the value; skipped while all slots are in flight.
    pub(crate) fn record(&mut self, encoder: &mut wgpu::CommandEncoder, source: &wgpu::Buffer) {
        let free = self.slots.iter_mut().find(|(_, state)| matches!(state, State::Free));
        if let Some((buffer, state)) = free {
            encoder.copy_buffer_to_buffer(source, 0, buffer, 0, size_of::<T>() as u64);
            *state = State::Recorded;
        }
    }

    /// Takes what has arrived. Call after the recorded encoder was submitted.
    pub(crate) fn poll(&mut self, gpu: &Gpu) {
        for (buffer, state) in &mut self.slots {
            if matches!(state, State::Recorded) {
                let (sender, receiver) = channel();
                buffer.map_async(wgpu::MapMode::Read, .., move |result| {
                    // The receiver is gone where the lists were dropped meanwhile.
                    let _ = sender.send(result.is_ok());
                });
                *state = State::Mapping(receiver);
            }
        }
        // A lost device shows at the next submission; here it only means no news.
        let _ = gpu.device.poll(wgpu::PollType::Poll);
        for (buffer, state) in &mut self.slots {
            let State::Mapping(receiver) = state else {
                continue;
            };
            let Ok(mapped) = receiver.try_recv() else {
                continue;
            };
            if mapped {
                if let Ok(view) = buffer.get_mapped_range(..) {
                    self.latest = Some(bytemuck::pod_read_unaligned(&view));
                }
                buffer.unmap();
            }
            *state = State::Free;
        }
    }

    pub(crate) fn latest(&self) -> Option<T> {
        self.latest
    }
}
