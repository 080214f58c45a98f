//! What the CPU does before a frame: scenes, lights in order, camera paths, the truth's hierarchy.

use std::hint::black_box;

use assign::{Gpu, Light, LightBuffer, LightOrder};
use criterion::{Criterion, criterion_group, criterion_main};
use scenes::{LightSpec, atrium, scatter_lights};
use shading::LightBvh;

fn scene(criterion: &mut Criterion) {
    criterion.bench_function("scene/atrium", |bencher| bencher.iter(|| atrium(black_box(1))));
    let scene = atrium(1);
    criterion.bench_function("path/atrium/1200 frames", |bencher| {
        bencher
            .iter(|| (0..1200).map(|frame| scene.path.pose(frame, 1200).eye).sum::<glam::Vec3>());
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

criterion_group! {
    name = benches;
    config = Criterion::default().sample_size(10);
    targets = scene, lights
}
criterion_main!(benches);
