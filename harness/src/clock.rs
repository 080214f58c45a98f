//! Two clocks behind one recorder of passes.
//!
//! On a GPU a timestamp query is written before and after each pass, and all passes of a frame
//! are submitted together. On a software adapter timestamps say nothing of a pass's cost, so
//! each pass is submitted alone and waited for.

use std::time::Instant;

use assign::{AssignError, Gpu, Passes};

use crate::results::Clock;

/// Passes of a frame that can be timed.
const MAX_PASSES: u32 = 64;

/// A pass and its time, ms.
pub type PassTime = (String, f64);

/// A query set, and the index of a pass's first query in it.
type Query<'a> = (&'a wgpu::QuerySet, u32);

/// Times every pass of a frame.
pub struct PassClock {
    gpu: Gpu,
    encoder: wgpu::CommandEncoder,
    names: Vec<String>,
    kind: Kind,
}

enum Kind {
    Timestamps { queries: wgpu::QuerySet, resolved: wgpu::Buffer, staging: wgpu::Buffer },
    WallClock { times_ms: Vec<f64>, failed: Option<AssignError> },
}

impl PassClock {
    /// The clock that fits the device.
    pub fn new(gpu: &Gpu) -> Self {
        let kind = match clock_of(gpu) {
            Clock::GpuTimestamps => Kind::timestamps(gpu),
            Clock::WallClock => Kind::WallClock { times_ms: Vec::new(), failed: None },
        };
        Self {
            gpu: gpu.clone(),
            encoder: gpu.device.create_command_encoder(&Default::default()),
            names: Vec::new(),
            kind,
        }
    }

    /// Ends the frame: submits what is left, waits, and returns each pass's time, ms.
    pub fn finish(&mut self) -> Result<Vec<PassTime>, AssignError> {
        self.flush();
        self.gpu.wait()?;
        let names = std::mem::take(&mut self.names);
        let times = match &mut self.kind {
            Kind::WallClock { times_ms, failed } => {
                let times = std::mem::take(times_ms);
                failed.take().map_or(Ok(times), Err)?
            }
            Kind::Timestamps { queries, resolved, staging } => {
                read_timestamps(&self.gpu, queries, resolved, staging, &names)?
            }
        };
        // Passes of one name are one pass in several parts.
        let mut passes: Vec<PassTime> = Vec::new();
        for (name, time) in names.into_iter().zip(times) {
            match passes.iter_mut().find(|(known, _)| *known == name) {
                Some((_, sum)) => *sum += time,
                None => passes.push((name, time)),
            }
        }
        Ok(passes)
    }

    /// Submits what has been recorded.
    fn flush(&mut self) {
        let fresh = self.gpu.device.create_command_encoder(&Default::default());
        let encoder = std::mem::replace(&mut self.encoder, fresh);
        self.gpu.queue.submit([encoder.finish()]);
    }

    /// Records one pass between two timestamps, or submits it alone between two looks at a watch.
    fn timed(
        &mut self,
        name: &str,
        record: &mut dyn FnMut(&mut wgpu::CommandEncoder, Option<Query<'_>>),
    ) {
        let query = 2 * self.names.len() as u32;
        self.names.push(name.to_owned());
        if let Kind::Timestamps { queries, .. } = &self.kind {
            let query = (query < 2 * MAX_PASSES).then_some((queries, query));
            record(&mut self.encoder, query);
            return;
        }
        // What came before must not be on this pass's bill.
        self.flush();
        let mut outcome = self.gpu.wait();
        record(&mut self.encoder, None);
        let start = Instant::now();
        self.flush();
        outcome = outcome.and(self.gpu.wait());
        let elapsed_ms = start.elapsed().as_secs_f64() * 1e3;
        if let Kind::WallClock { times_ms, failed } = &mut self.kind {
            times_ms.push(elapsed_ms);
            if let Err(error) = outcome {
                failed.get_or_insert(error);
            }
        }
    }
}

impl Passes for PassClock {
    fn compute(&mut self, name: &str, record: &mut dyn FnMut(&mut wgpu::ComputePass<'_>)) {
        self.timed(name, &mut |encoder, query| {
            record(&mut encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
                label: Some(name),
                timestamp_writes: query.map(|(query_set, first)| {
                    wgpu::ComputePassTimestampWrites {
                        query_set,
                        beginning_of_pass_write_index: Some(first),
                        end_of_pass_write_index: Some(first + 1),
                    }
                }),
            }));
        });
    }

    fn render(
        &mut self,
        name: &str,
        descriptor: &wgpu::RenderPassDescriptor<'_>,
        record: &mut dyn FnMut(&mut wgpu::RenderPass<'_>),
    ) {
        self.timed(name, &mut |encoder, query| {
            let descriptor = wgpu::RenderPassDescriptor {
                label: Some(name),
                color_attachments: descriptor.color_attachments,
                depth_stencil_attachment: descriptor.depth_stencil_attachment.clone(),
                timestamp_writes: query.map(|(query_set, first)| wgpu::RenderPassTimestampWrites {
                    query_set,
                    beginning_of_pass_write_index: Some(first),
                    end_of_pass_write_index: Some(first + 1),
                }),
                occlusion_query_set: None,
                multiview_mask: None,
            };
            record(&mut encoder.begin_render_pass(&descriptor));
        });
    }

    fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        &mut self.encoder
    }
}

/// Which clock a device's figures come from.
pub fn clock_of(gpu: &Gpu) -> Clock {
    let has_queries = gpu.device.features().contains(wgpu::Features::TIMESTAMP_QUERY);
    if has_queries && !gpu.is_software() { Clock::GpuTimestamps } else { Clock::WallClock }
}

impl Kind {
    fn timestamps(gpu: &Gpu) -> Self {
        let bytes = u64::from(2 * MAX_PASSES) * 8;
        let buffer = |label, usage| {
            gpu.device.create_buffer(&wgpu::BufferDescriptor {
                label: Some(label),
                size: bytes,
                usage,
                mapped_at_creation: false,
            })
        };
        Self::Timestamps {
            queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
                label: Some("pass times"),
                ty: wgpu::QueryType::Timestamp,
                count: 2 * MAX_PASSES,
            }),
            resolved: buffer(
                "pass times",
                wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
            ),
            staging: buffer(
                "pass times",
                wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            ),
        }
    }
}

/// Reads the two timestamps of each pass, ms between them.
///
/// Queries are resolved and copied in submissions of their own: resolved and copied by one
/// encoder they can read 0 (wgpu issue 6406).
fn read_timestamps(
    gpu: &Gpu,
    queries: &wgpu::QuerySet,
    resolved: &wgpu::Buffer,
    staging: &wgpu::Buffer,
    names: &[String],
) -> Result<Vec<f64>, AssignError> {
    if names.len() as u32 > MAX_PASSES {
        return Err(AssignError::Device(format!(
            "{} passes in a frame: at most {MAX_PASSES} can be timed",
            names.len()
        )));
    }
    if names.is_empty() {
        return Ok(Vec::new());
    }
    let submit = |record: &dyn Fn(&mut wgpu::CommandEncoder)| {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        record(&mut encoder);
        gpu.queue.submit([encoder.finish()]);
    };
    submit(&|encoder| {
        encoder.resolve_query_set(queries, 0..2 * names.len() as u32, resolved, 0);
    });
    submit(&|encoder| {
        encoder.copy_buffer_to_buffer(resolved, 0, staging, 0, resolved.size());
    });
    let bytes = gpu.map(staging)?;
    staging.unmap();
    let ms_per_tick = f64::from(gpu.queue.get_timestamp_period()) * 1e-6;
    names
        .iter()
        .zip(bytes.chunks_exact(16))
        .map(|(name, pair)| {
            let [start, end] =
                [0, 8].map(|at| u64::from_le_bytes(std::array::from_fn(|i| pair[at + i])));
            if start == 0 || end < start {
                return Err(AssignError::Device(format!(
                    "pass {name}: timestamps {start} and {end} are no span of time"
                )));
            }
            Ok((end - start) as f64 * ms_per_tick)
        })
        .collect()
}
