//! Small data of a frame, which reach their buffers in the order of commands.
//!
//! A write through the queue takes effect at the start of the next submission, whatever was recorded before it. If a
//! strategy were prepared and recorded for two cameras in one submission, the first camera's passes would read the
//! second camera's data. So a strategy's parameters go through a buffer that no other frame uses, and commands of the
//! frame copy them to their places. Uniforms and bind groups stay the same objects, and any number of frames may be
//! prepared and recorded before a submission.
//!
//! Each frame takes a buffer that no unfinished encoder reads. There are as many as frames are in flight.

use std::sync::Arc;

use crate::{AssignError, Gpu};

/// The least bytes of a staging buffer. Most strategies write less than this in a frame.
const LEAST_BYTES: u64 = 2048;

/// A staging buffer. Each encoder that copies from it holds `users` until it has run or is dropped.
#[derive(Debug)]
struct Stage {
    buffer: wgpu::Buffer,
    users: Arc<()>,
}

impl Stage {
    fn is_free(&self) -> bool {
        Arc::strong_count(&self.users) == 1
    }
}

/// A write to a buffer.
#[derive(Debug)]
struct Write {
    buffer: wgpu::Buffer,
    offset: u64,
    /// Place and length of the bytes in the frame's data.
    from: u64,
    bytes: u64,
}

/// The writes of one strategy's frames.
///
/// `prepare` calls [`write`](Self::write) for everything that its passes and shading read, in every frame; `record`
/// begins with [`record`](Self::record).
#[derive(Debug)]
pub struct FrameWrites {
    gpu: Gpu,
    stages: Vec<Stage>,
    /// The stage of this frame.
    stage: usize,
    writes: Vec<Write>,
    data: Vec<u8>,
    is_uploaded: bool,
    is_recorded: bool,
    record_count: u64,
}

impl FrameWrites {
    /// Makes it without writes.
    pub fn new(gpu: &Gpu) -> Self {
        Self {
            gpu: gpu.clone(),
            stages: Vec::new(),
            stage: 0,
            writes: Vec::new(),
            data: Vec::new(),
            is_uploaded: false,
            is_recorded: false,
            record_count: 0,
        }
    }

    /// Writes `bytes` to a buffer when the frame runs. The first write after a record begins a new frame. `offset` and
    /// the length are multiples of 4, and the buffer has the usage `COPY_DST`.
    ///
    /// # Errors
    ///
    /// [`AssignError::TooLarge`] and [`AssignError::OutOfMemory`] if the frame's data do not fit on the device.
    pub fn write(
        &mut self,
        buffer: &wgpu::Buffer,
        offset: u64,
        bytes: &[u8],
    ) -> Result<(), AssignError> {
        if self.is_recorded {
            self.writes.clear();
            self.data.clear();
            self.is_recorded = false;
            self.stage = self.stages.iter().position(Stage::is_free).unwrap_or(self.stages.len());
        }
        self.is_uploaded = false;
        let length = bytes.len() as u64;
        let is_same = |write: &&Write| {
            write.buffer == *buffer && write.offset == offset && write.bytes == length
        };
        // A frame that is prepared again replaces what it wrote.
        if let Some(write) = self.writes.iter().find(is_same) {
            let from = write.from as usize;
            self.data[from..from + bytes.len()].copy_from_slice(bytes);
            return Ok(());
        }
        self.reserve(self.data.len() as u64 + length)?;
        let from = self.data.len() as u64;
        self.data.extend_from_slice(bytes);
        self.writes.push(Write { buffer: buffer.clone(), offset, from, bytes: length });
        Ok(())
    }

    /// Makes the frame's stage large enough.
    fn reserve(&mut self, bytes: u64) -> Result<(), AssignError> {
        if self.stages.get(self.stage).is_some_and(|stage| stage.buffer.size() >= bytes) {
            return Ok(());
        }
        let usage = wgpu::BufferUsages::COPY_SRC | wgpu::BufferUsages::COPY_DST;
        let bytes = bytes.max(LEAST_BYTES).next_power_of_two();
        let buffer = self.gpu.buffer("frame writes", bytes, usage)?;
        let stage = Stage { buffer, users: Arc::default() };
        match self.stages.get_mut(self.stage) {
            Some(smaller) => *smaller = stage,
            None => self.stages.push(stage),
        }
        Ok(())
    }

    /// Copies the frame's writes to their buffers. Record it before all passes that read them. If a frame is recorded
    /// again, it copies them again.
    pub fn record(&mut self, encoder: &mut wgpu::CommandEncoder) {
        let Some(stage) = self.stages.get(self.stage).filter(|_| !self.writes.is_empty()) else {
            return;
        };
        if !self.is_uploaded {
            self.gpu.queue.write_buffer(&stage.buffer, 0, &self.data);
            self.is_uploaded = true;
        }
        for Write { buffer, offset, from, bytes } in &self.writes {
            encoder.copy_buffer_to_buffer(&stage.buffer, *from, buffer, *offset, *bytes);
        }
        let user = Arc::clone(&stage.users);
        encoder.on_submitted_work_done(move || drop(user));
        self.is_recorded = true;
        self.record_count += 1;
    }

    /// How often frames were recorded.
    pub(crate) fn record_count(&self) -> u64 {
        self.record_count
    }

    /// Bytes of its buffers.
    pub fn bytes(&self) -> u64 {
        self.stages.iter().map(|stage| stage.buffer.size()).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Copies the target elsewhere in the frame, as passes read it.
    fn frame(
        writes: &mut FrameWrites,
        [target, seen]: [&wgpu::Buffer; 2],
        (encoder, value): (&mut wgpu::CommandEncoder, u32),
    ) {
        writes.write(target, 4, &value.to_le_bytes()).expect("writes");
        writes.record(encoder);
        encoder.copy_buffer_to_buffer(target, 4, seen, 0, 4);
    }

    fn value(gpu: &Gpu, buffer: &wgpu::Buffer) -> u32 {
        let bytes = gpu.read(buffer, 4).expect("reads");
        u32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]])
    }

    #[test]
    fn frames_before_one_submission_keep_their_own_data() {
        let gpu = Gpu::open(None).expect("a device");
        let buffer = |label| gpu.storage(label, 16).expect("a buffer");
        let (target, seen) = (buffer("target"), [buffer("first"), buffer("second")]);
        let mut writes = FrameWrites::new(&gpu);
        for round in 0..100 {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            for (place, seen) in (0..).zip(&seen) {
                let number = 2 * round + place;
                frame(&mut writes, [&target, seen], (&mut encoder, number));
            }
            gpu.queue.submit([encoder.finish()]);
            assert_eq!(seen.each_ref().map(|b| value(&gpu, b)), [2 * round, 2 * round + 1]);
        }
        // An encoder that is dropped frees its stage.
        for number in 0..100 {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            frame(&mut writes, [&target, &seen[0]], (&mut encoder, number));
        }
        assert!(writes.stages.len() <= 3, "{} stages", writes.stages.len());
    }

    #[test]
    fn a_frame_that_is_prepared_twice_writes_its_last_data_and_may_be_recorded_twice() {
        let gpu = Gpu::open(None).expect("a device");
        let buffer = |label| gpu.storage(label, 16).expect("a buffer");
        let (target, seen) = (buffer("target"), buffer("seen"));
        let mut writes = FrameWrites::new(&gpu);
        writes.write(&target, 4, &1_u32.to_le_bytes()).expect("writes");
        for _ in 0..2 {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            encoder.clear_buffer(&target, 0, None);
            writes.write(&target, 4, &7_u32.to_le_bytes()).expect("writes");
            writes.record(&mut encoder);
            writes.record(&mut encoder);
            encoder.copy_buffer_to_buffer(&target, 4, &seen, 0, 4);
            gpu.queue.submit([encoder.finish()]);
            assert_eq!(value(&gpu, &seen), 7);
        }
        assert_eq!(writes.writes.len(), 1);
    }
}
