//! What the CPU does before a frame: scenes, lights in order, camera paths, the truth's hierarchy; and in a frame: lights
//! that move, and a strategy's `prepare`.

use std::{
    hint::black_box,
    time::{Duration, Instant},
};

use assign::{EncoderPasses, Frame, Gpu, Light, LightBuffer, LightOrder, View};
use criterion::{Criterion, criterion_group, criterion_main};
use glam::Vec3;
use harness::{choice::Choice, strategy::Method};
use scenes::{LightSpec, atrium, scatter_lights};
use shading::LightBvh;

fn scene(criterion: &mut Criterion) {
    criterion.bench_function("scene/atrium", |bencher| bencher.iter(|| atrium(black_box(1))));
    let scene = atrium(1);
    criterion.bench_function("path/atrium/1200 frames", |bencher| {
        bencher.iter(|| (0..1200).map(|frame| scene.path.pose(frame, 1200).eye).sum::<Vec3>());
    });
}

fn lights(criterion: &mut Criterion) {
    let bounds = atrium(1).bounds;
    for count in [1_000, 10_000] {
        let lights: Vec<Light> = scatter_lights(&LightSpec::new(count, bounds)).unwrap_or_default();
        assert_eq!(lights.len(), count as usize);
        criterion.bench_function(&format!("lights/truth/{count}"), |bencher| {
            bencher.iter(|| {
                let mut found = 0;
                LightBvh::new(&lights).lights_at([0.0, 1.0, 0.0], |_, _| found += 1);
                found
            });
        });
        // The order and the hierarchy are made at upload.
        let gpu = Gpu::noop();
        for order in [LightOrder::Given, LightOrder::Morton, LightOrder::Bvh] {
            criterion.bench_function(&format!("lights/{order}/{count}"), |bencher| {
                bencher.iter(|| gpu.as_ref().map(|gpu| LightBuffer::ordered(gpu, &lights, order)));
            });
        }
    }
}

/// Lights of a frame, and the same a frame later.
fn moved(lights: &[Light]) -> [Vec<Light>; 2] {
    let shift = |light: &Light| Light { position: light.position + 0.01 * Vec3::X, ..*light };
    [lights.to_vec(), lights.iter().map(shift).collect()]
}

/// `LightBuffer::update` and `Assignment::prepare` at 10,000 lights that all move. The device runs nothing, so the
/// times are those of this workspace and of wgpu's checks. What the machine's own driver adds is in the last bench.
fn frames(criterion: &mut Criterion) {
    let gpu = Gpu::noop().expect("a device");
    let bounds = atrium(1).bounds;
    let lights = moved(&scatter_lights(&LightSpec::new(10_000, bounds)).expect("lights"));
    for order in [LightOrder::Given, LightOrder::Gpu { every: 1 }] {
        let mut buffer = LightBuffer::ordered(&gpu, &lights[0], order).expect("lights");
        criterion.bench_function(&format!("frame/update/{order}/10000"), |bencher| {
            bencher.iter_custom(|rounds| {
                let mut time = Duration::ZERO;
                for round in 0..rounds {
                    let began = Instant::now();
                    buffer.update(&gpu, &lights[(round % 2) as usize]).expect("updates");
                    time += began.elapsed();
                    submit(&gpu, |passes| buffer.record(passes));
                }
                time
            });
        });
    }
    for id in ["SC-E/48x48x40/bvh", "DC-E/64x64x40/mask", "T-E/28x28/bvh", "HG/48x48x40"] {
        prepare(criterion, &gpu, &lights[0], id, "");
    }
    match Gpu::open(None) {
        Ok(gpu) => prepare(criterion, &gpu, &lights[0], "SC-E/48x48x40/bvh", "/adapter"),
        Err(error) => eprintln!("frame/prepare/…/adapter is left out: {error}"),
    }
}

/// Times `Assignment::prepare` of a camera that moves. The device is idle when it begins.
fn prepare(criterion: &mut Criterion, gpu: &Gpu, lights: &[Light], id: &str, device: &str) {
    let buffer = LightBuffer::new(gpu, lights).expect("lights");
    let size = wgpu::Extent3d { width: 1920, height: 1080, depth_or_array_layers: 1 };
    let depth = gpu.device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Depth32Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let depth = depth.create_view(&wgpu::TextureViewDescriptor::default());
    let made = Choice::parse(id).expect("an id").make(gpu).expect("a method");
    let Method::Lists { mut strategy, .. } = made else { return };
    criterion.bench_function(&format!("frame/prepare/{id}/10000{device}"), |bencher| {
        bencher.iter_custom(|rounds| {
            let mut time = Duration::ZERO;
            for round in 0..rounds {
                let eye = Vec3::new(0.0, 1.0, 0.001 * (round % 100) as f32);
                let view = View::look_at(eye, Vec3::Y, 1.0, 0.1, [1920, 1080]);
                let frame = Frame::new(&view, &buffer).with_depth(&depth);
                let began = Instant::now();
                strategy.prepare(gpu, &frame).expect("prepares");
                time += began.elapsed();
                submit(gpu, |passes| strategy.record(&frame, passes));
                gpu.wait().expect("a frame");
            }
            time
        });
    });
}

/// Records a frame and submits it, which no time counts.
fn submit(gpu: &Gpu, record: impl FnOnce(&mut EncoderPasses<'_>)) {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    record(&mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
}

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = scene, lights, frames
}
criterion_main!(benches);
