//! Prints how long each pass takes on this machine's GPU, for deep images of a landscape of boxes and
//! rays through them: `cargo run --release -p assign-cdi --example time_passes -- 280000`, with the
//! number of triangles. Medians of 15 frames after 3, milliseconds.

use std::collections::BTreeMap;

use assign::{AssignError, Gpu, Passes};
use assign_cdi::{
    Build, Coverage, DeepImageSettings, DeepImages, Directions, RandomRanges, RangeCaster,
    RangePoints, RangeRule, Raster, Spread, Storage, Threads, Triangles,
};
use bytemuck::{cast_slice, pod_collect_to_vec};
use glam::{Vec2, Vec3, Vec4};

/// Timestamps around each pass.
struct Clock<'a> {
    encoder: &'a mut wgpu::CommandEncoder,
    queries: &'a wgpu::QuerySet,
    names: Vec<String>,
}

/// The most passes of a frame.
const MOST_PASSES: u32 = 32;

impl Passes for Clock<'_> {
    fn compute(&mut self, name: &str, record: &mut dyn FnMut(&mut wgpu::ComputePass<'_>)) {
        let first = 2 * self.names.len() as u32;
        self.names.push(name.to_owned());
        record(&mut self.encoder.begin_compute_pass(&wgpu::ComputePassDescriptor {
            label: Some(name),
            timestamp_writes: Some(wgpu::ComputePassTimestampWrites {
                query_set: self.queries,
                beginning_of_pass_write_index: Some(first),
                end_of_pass_write_index: Some(first + 1),
            }),
        }));
    }

    fn render(
        &mut self,
        name: &str,
        descriptor: &wgpu::RenderPassDescriptor<'_>,
        record: &mut dyn FnMut(&mut wgpu::RenderPass<'_>),
    ) {
        let first = 2 * self.names.len() as u32;
        self.names.push(name.to_owned());
        let mut descriptor = descriptor.clone();
        descriptor.timestamp_writes = Some(wgpu::RenderPassTimestampWrites {
            query_set: self.queries,
            beginning_of_pass_write_index: Some(first),
            end_of_pass_write_index: Some(first + 1),
        });
        record(&mut self.encoder.begin_render_pass(&descriptor));
    }

    fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        self.encoder
    }
}

/// Boxes of many heights on a square, each side a grid of small triangles, and points above them.
struct Scene {
    positions: Vec<f32>,
    points: Vec<Vec4>,
    normals: Vec<Vec4>,
}

impl Scene {
    fn new(triangles: u32, points: u32) -> Self {
        let side = ((f64::from(triangles) / 2.0).sqrt() as u32).max(2);
        let at = |x: u32, y: u32| {
            let place = Vec2::new(x as f32, y as f32) / side as f32;
            let block = (place * 24.0).floor();
            let hash = (block.x * 12.9898 + block.y * 78.233).sin() * 43_758.547;
            let is_street = (place * 24.0 - block).min_element() < 0.3;
            let height = if is_street { 0.0 } else { 20.0 * (hash - hash.floor()) };
            Vec3::new(200.0 * place.x, height, 200.0 * place.y)
        };
        let mut positions = Vec::new();
        for (x, y) in (0..side).flat_map(|y| (0..side).map(move |x| (x, y))) {
            let [a, b, c, d] = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)];
            positions.extend([a, b, c, a, c, d].iter().flat_map(Vec3::to_array));
        }
        let wide = points.isqrt().max(1);
        let place = |ix: u32| at(ix % wide * side / wide, ix / wide % wide * side / wide);
        let normal = |ix: u32| {
            let tilt = Vec3::new((ix as f32).sin(), 3.0, (ix as f32 * 1.7).cos());
            tilt.normalize().extend(0.0)
        };
        Self {
            positions,
            points: (0..points).map(|ix| place(ix).extend(1.0)).collect(),
            normals: (0..points).map(normal).collect(),
        }
    }
}

struct Timer {
    gpu: Gpu,
    queries: wgpu::QuerySet,
    resolved: wgpu::Buffer,
}

impl Timer {
    /// Medians of each pass of `record`, in order of names.
    fn time(
        &self,
        mut record: impl FnMut(&mut dyn Passes) -> Result<(), AssignError>,
    ) -> Result<BTreeMap<String, f64>, AssignError> {
        let mut times: BTreeMap<String, Vec<f64>> = BTreeMap::new();
        for frame in 0..18 {
            let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
            let queries = &self.queries;
            let mut clock = Clock { encoder: &mut encoder, queries, names: Vec::new() };
            record(&mut clock)?;
            let names = clock.names;
            let bytes = names.len() as u64 * 16;
            encoder.resolve_query_set(queries, 0..2 * names.len() as u32, &self.resolved, 0);
            let staging = self.gpu.staging("times", bytes)?;
            encoder.copy_buffer_to_buffer(&self.resolved, 0, &staging, 0, bytes);
            self.gpu.queue.submit([encoder.finish()]);
            let ticks: Vec<u64> = pod_collect_to_vec(&self.gpu.map(&staging)?);
            let period_ms = f64::from(self.gpu.queue.get_timestamp_period()) * 1e-6;
            for (name, ends) in names.iter().zip(ticks.chunks(2)) {
                if let ([begin, end], true) = (ends, frame >= 3) {
                    let ms = end.saturating_sub(*begin) as f64 * period_ms;
                    times.entry(name.clone()).or_default().push(ms);
                }
            }
        }
        Ok(times
            .into_iter()
            .map(|(name, mut ms)| {
                ms.sort_unstable_by(f64::total_cmp);
                let median = ms.get(ms.len() / 2).copied().unwrap_or_default();
                (name, median)
            })
            .collect())
    }
}

fn print(what: &str, times: &BTreeMap<String, f64>) {
    let passes: Vec<String> = times.iter().map(|(name, ms)| format!("{name} {ms:.3}")).collect();
    println!("{what}: {:.3} ms = {}", times.values().sum::<f64>(), passes.join(" + "));
}

fn main() -> Result<(), AssignError> {
    let triangles = std::env::args().nth(1).and_then(|text| text.parse().ok()).unwrap_or(280_000);
    let gpu = Gpu::open(None)?;
    let scene = Scene::new(triangles, 1 << 22);
    let upload = |bytes: &[u8]| -> Result<wgpu::Buffer, AssignError> {
        let buffer = gpu.storage("input", bytes.len() as u64)?;
        gpu.queue.write_buffer(&buffer, 0, bytes);
        Ok(buffer)
    };
    let positions = upload(cast_slice(&scene.positions))?;
    let input = Triangles {
        positions: &positions,
        count: scene.positions.len() as u32 / 9,
        bounds_world: (Vec3::ZERO, Vec3::new(200.0, 20.0, 200.0)),
    };
    let points = upload(cast_slice(&scene.points))?;
    let normals = upload(cast_slice(&scene.normals))?;
    let point_count = scene.points.len() as u32;
    let ranges_m = gpu.storage("ranges", u64::from(point_count) * 4)?;
    let timer = Timer {
        queries: gpu.device.create_query_set(&wgpu::QuerySetDescriptor {
            label: None,
            ty: wgpu::QueryType::Timestamp,
            count: 2 * MOST_PASSES,
        }),
        resolved: gpu.buffer(
            "times",
            u64::from(MOST_PASSES) * 16,
            wgpu::BufferUsages::QUERY_RESOLVE | wgpu::BufferUsages::COPY_SRC,
        )?,
        gpu: gpu.clone(),
    };
    println!("{}: {} triangles, {point_count} points", gpu.info.name, input.count);
    let compute = Raster::Compute;
    let single = |oversampling, raster| Build::SinglePass { oversampling, raster };
    let each = |coverage, at_once| Build::PerDirection { coverage, at_once };
    for (build, storage) in [
        (single(1, compute), Storage::Arrays),
        (single(1, Raster::Fragment), Storage::Arrays),
        (single(2, compute), Storage::Arrays),
        (single(1, compute), Storage::LinkedLists),
        (each(Coverage::Centres, 1), Storage::Arrays),
        (each(Coverage::Centres, 169), Storage::Arrays),
        (each(Coverage::Conservative, 169), Storage::Arrays),
    ] {
        let directions = Directions::new(Spread::Squares, 13, 13)?;
        let settings =
            DeepImageSettings { build, storage, directions, ..DeepImageSettings::default() };
        let mut images = DeepImages::new(&gpu, settings)?;
        let times = timer.time(|passes| {
            images.prepare(&gpu, &input)?;
            images.record(passes);
            Ok(())
        })?;
        print(&format!("{build:?} {storage:?}"), &times);
        let mib = images.bytes() as f64 / f64::from(1 << 20);
        println!("  {mib:.1} MiB, {:?}", images.stats().unwrap_or_default());
        for (rays, threads) in [(6, Threads::Points), (6, Threads::Rays), (1, Threads::Points)] {
            let rule = RangeRule { rays, threads, ..RangeRule::default() };
            let mut caster = RangeCaster::new(&gpu, &images, rule)?;
            caster.prepare(
                &gpu,
                &RangePoints {
                    light_world: None,
                    positions: &points,
                    normals: &normals,
                    primaries: None,
                    count: point_count,
                    ranges_m: &ranges_m,
                },
            )?;
            let times = timer.time(|passes| caster.record(&images, passes))?;
            print(&format!("  {rays} rays {threads:?}"), &times);
        }
    }
    let mut random = RandomRanges::new(&gpu)?;
    random.prepare(&gpu, &ranges_m, point_count, (1.0, 10.0), 1)?;
    print(
        "random",
        &timer.time(|passes| {
            random.record(passes);
            Ok(())
        })?,
    );
    Ok(())
}
