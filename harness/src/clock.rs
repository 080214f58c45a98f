//! Two clocks behind one recorder of passes.
//!
//! On a GPU, each pass stands between two timestamp queries, and all passes of a frame are submitted
//! together. On a software adapter, timestamps do not show the cost of a pass. So each pass is submitted
//! alone and waited for.

use std::time::Instant;

use assign::{AssignError, Gpu, Passes};

use crate::results::Clock;

/// Passes of a frame that can be timed.
const MAX_PASSES: u32 = 64;

/// A pass and its time, ms.
pub type PassTime = (String, f64);

/// The times of one frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameTimes {
    /// Passes and their times, in the order in which they ran. Passes of the same name are parts of one
    /// pass.
    pub passes: Vec<PassTime>,
    /// Start and end of each part of each pass, ms after the first start. `None` if each pass was submitted
    /// alone, because the host causes the gaps then.
    pub intervals: Option<Vec<(String, [f64; 2])>>,
}

impl FrameTimes {
    fn new(names: Vec<String>, times: Times) -> Self {
        let mut passes: Vec<PassTime> = Vec::new();
        let mut add = |name: String, time: f64| match passes.iter_mut().find(|(n, _)| *n == name) {
            Some((_, sum)) => *sum += time,
            None => passes.push((name, time)),
        };
        let intervals = match times {
            Times::Alone(times) => {
                names.into_iter().zip(times).for_each(|(name, time)| add(name, time));
                None
            }
            Times::Together(intervals) => {
                let named: Vec<(String, [f64; 2])> = names.into_iter().zip(intervals).collect();
                named.iter().for_each(|(name, [begin, end])| add(name.clone(), end - begin));
                Some(named)
            }
        };
        Self { passes, intervals }
    }

    /// Puts work of the CPU before the first pass, and before other work of the CPU that it was called for. It counts as a
    /// pass, and in spans.
    pub fn begin_with(&mut self, name: &str, ms: f64) {
        self.passes.insert(0, (name.to_owned(), ms));
        if let Some(intervals) = &mut self.intervals {
            let end = intervals.iter().map(|(_, [begin, _])| *begin).fold(0.0, f64::min);
            intervals.insert(0, (name.to_owned(), [end - ms, end]));
        }
    }

    /// The time from the start of the first of some passes to the end of the last, ms. It includes the gaps
    /// between two of them, but not other passes in between and the gaps beside these. `None` if only sums
    /// are known.
    pub fn span_ms(&self, is_counted: impl Fn(&str) -> bool) -> Option<f64> {
        let intervals = self.intervals.as_ref()?;
        let runs = intervals.chunk_by(|(a, _), (b, _)| is_counted(a) == is_counted(b));
        let counted = runs.filter(|run| run.first().is_some_and(|(name, _)| is_counted(name)));
        Some(counted.map(run_ms).sum())
    }
}

/// The time from the first start to the last end. Passes may overlap.
fn run_ms(run: &[(String, [f64; 2])]) -> f64 {
    let begin = run.iter().map(|(_, [begin, _])| *begin).fold(f64::INFINITY, f64::min);
    let end = run.iter().map(|(_, [_, end])| *end).fold(f64::NEG_INFINITY, f64::max);
    (end - begin).max(0.0)
}

/// Readings of the clock for passes, in the order in which they ran.
enum Times {
    /// The duration of each pass, ms; each was submitted alone.
    Alone(Vec<f64>),
    /// Start and end of each pass, ms after the first start.
    Together(Vec<[f64; 2]>),
}

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
    /// Chooses the clock for the device.
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

    /// Ends the frame: submits the remaining passes, waits, and returns the time of each pass, ms.
    pub fn finish(&mut self) -> Result<Vec<PassTime>, AssignError> {
        Ok(self.finish_frame()?.passes)
    }

    /// Ends the frame as [`finish`](Self::finish) does, and also returns start and end of its passes.
    pub fn finish_frame(&mut self) -> Result<FrameTimes, AssignError> {
        self.flush();
        self.gpu.wait()?;
        let names = std::mem::take(&mut self.names);
        let times = match &mut self.kind {
            Kind::WallClock { times_ms, failed } => {
                let times = std::mem::take(times_ms);
                failed.take().map_or(Ok(Times::Alone(times)), Err)?
            }
            Kind::Timestamps { queries, resolved, staging } => {
                Times::Together(read_timestamps(&self.gpu, queries, resolved, staging, &names)?)
            }
        };
        Ok(FrameTimes::new(names, times))
    }

    /// Submits the recorded passes.
    fn flush(&mut self) {
        let fresh = self.gpu.device.create_command_encoder(&Default::default());
        let encoder = std::mem::replace(&mut self.encoder, fresh);
        self.gpu.queue.submit([encoder.finish()]);
    }

    /// Records one pass between two timestamps, or submits it alone and times it by wall clock.
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
        // Earlier work must not count in the time of this pass.
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

/// The clock that times a device.
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

/// Reads the two timestamps of each pass, ms after the first of all.
///
/// Queries are resolved and copied in separate submissions, because they can read 0 if one encoder resolves
/// and copies them (wgpu issue 6406).
fn read_timestamps(
    gpu: &Gpu,
    queries: &wgpu::QuerySet,
    resolved: &wgpu::Buffer,
    staging: &wgpu::Buffer,
    names: &[String],
) -> Result<Vec<[f64; 2]>, AssignError> {
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
    let mut ticks = Vec::new();
    for (name, pair) in names.iter().zip(bytes.chunks_exact(16)) {
        let [start, end] =
            [0, 8].map(|at| u64::from_le_bytes(std::array::from_fn(|i| pair[at + i])));
        if start == 0 || end < start {
            return Err(AssignError::Device(format!(
                "pass {name}: timestamps {start} and {end} are no span of time"
            )));
        }
        ticks.push([start, end]);
    }
    let first = ticks.iter().map(|[start, _]| *start).min().unwrap_or(0);
    Ok(ticks.into_iter().map(|pair| pair.map(|tick| (tick - first) as f64 * ms_per_tick)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn together(passes: &[(&str, f64, f64)]) -> FrameTimes {
        let names = passes.iter().map(|(name, ..)| (*name).to_owned()).collect();
        let times = passes.iter().map(|(_, begin, end)| [*begin, *end]).collect();
        FrameTimes::new(names, Times::Together(times))
    }

    #[test]
    fn a_span_includes_only_gaps_between_its_own_passes() {
        let frame = together(&[
            ("depth", 0.0, 1.0),
            ("bounds", 1.5, 2.0),
            ("cull", 2.25, 3.0),
            ("shade", 3.5, 5.0),
        ]);
        let is_billed = |name: &str| name != "depth";
        // 2.75 ms of passes, and gaps of 0.25 and 0.5.
        assert_eq!(frame.span_ms(is_billed), Some(3.5));
        assert_eq!(frame.span_ms(|_| true), Some(5.0));
        assert_eq!(frame.span_ms(|name| name == "clay"), Some(0.0));
        let sums: Vec<f64> = frame.passes.iter().map(|(_, ms)| *ms).collect();
        assert_eq!(sums, [1.0, 0.5, 0.75, 1.5]);
    }

    #[test]
    fn a_span_excludes_other_passes_and_counts_overlap_once() {
        let frame = together(&[
            ("cull", 0.0, 1.0),
            ("gbuffer", 1.5, 4.0),
            ("cull", 5.0, 6.0),
            ("shade", 5.5, 8.0),
        ]);
        assert_eq!(frame.span_ms(|name| name != "gbuffer"), Some(1.0 + 3.0));
        assert_eq!(frame.passes[0], ("cull".to_owned(), 2.0));
    }

    #[test]
    fn work_of_the_cpu_counts_in_both_totals() {
        let mut frame = together(&[("order", 0.0, 1.0), ("depth", 1.0, 2.0), ("shade", 2.0, 5.0)]);
        frame.begin_with("upload", 7.0);
        let is_billed = |name: &str| name != "depth";
        assert_eq!(frame.passes[0], ("upload".to_owned(), 7.0));
        assert_eq!((frame.span_ms(is_billed), frame.span_ms(|_| true)), (Some(11.0), Some(12.0)));
    }

    #[test]
    fn passes_that_were_submitted_alone_have_no_span() {
        let names = ["cull", "shade"].map(str::to_owned).to_vec();
        let frame = FrameTimes::new(names, Times::Alone(vec![1.0, 2.0]));
        assert_eq!(frame.span_ms(|_| true), None);
        assert_eq!(frame.passes.len(), 2);
    }
}
