//! The GPU's order of lights: it is a permutation, stable, the same on every run, and by Morton code; its
//! boxes hold the lights below them; faulty lights light nothing.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod faults;
mod own;
mod records;

use assign::{
    EncoderPasses, Gpu, Light, LightBuffer, LightNode, LightOrder, LightSphere,
    conformance::download,
};
use glam::Vec3;

fn gpu() -> Gpu {
    Gpu::open(None).unwrap()
}

/// Lights at pseudo-random places of a box of 102 m, a few of them at the same place.
fn lights(count: u32, seed: u32) -> Vec<Light> {
    let light = |ix: u32| {
        let place = if ix % 16 == 3 { 7 } else { ix };
        let x = (place ^ seed.wrapping_mul(0x9e37_79b9)).wrapping_mul(2_654_435_761);
        let at = [x >> 22, (x >> 11) & 1023, x & 1023].map(|v| v as f32 * 0.1);
        // The intensity names the light.
        Light::point(Vec3::from(at), 0.5 + (ix % 7) as f32 * 0.3, Vec3::splat(1.0 + ix as f32))
    };
    (0..count).map(light).collect()
}

fn record(gpu: &Gpu, buffer: &LightBuffer) {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    buffer.record(&mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
}

/// The CPU's twin of the key: 8 bits per axis.
fn key(light: &Light, low: Vec3, high: Vec3) -> u32 {
    let cells_per_m = 255.999 / (high - low).max_element();
    let cell = ((light.position - low) * cells_per_m).clamp(Vec3::ZERO, Vec3::splat(255.0));
    let spread = |v: f32| (0..8).fold(0, |bits, bit| bits | ((v as u32 >> bit) & 1) << (3 * bit));
    spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2
}

/// Bits of the code that decide the order of so many lights.
fn deciding(count: usize) -> u32 {
    match count {
        0..=1638 => 0x00ff_fff8,
        1639..=52_428 => 0x00ff_ff00,
        _ => 0x00ff_ffff,
    }
}

#[test]
fn lights_are_sorted_by_morton_code_and_equal_codes_stay_in_order() {
    let gpu = gpu();
    for count in [0, 1, 2, 63, 64, 65, 1000, 1638, 1700, 2049, 5000, 20_000, 70_000] {
        let given = lights(count, 1);
        let buffer = LightBuffer::ordered(&gpu, &given, LightOrder::Gpu { every: 1 }).unwrap();
        record(&gpu, &buffer);
        let sorted = buffer.read(&gpu).unwrap();
        let (low, high) = buffer.position_bounds().unwrap_or_default();
        let mut expected = given.clone();
        let mask = deciding(given.len());
        expected.sort_by_key(|light| key(light, low, high) & mask);
        assert_eq!(sorted.len(), expected.len());
        for (slot, (found, expected)) in sorted.iter().zip(&expected).enumerate() {
            assert_eq!(found, expected, "slot {slot} of {count}");
        }
        // The same input gives the same bits again.
        let again = LightBuffer::ordered(&gpu, &given, LightOrder::Gpu { every: 1 }).unwrap();
        record(&gpu, &again);
        let bits = |buffer: &LightBuffer| {
            download::<[u32; 4]>(&gpu, buffer.spheres(), given.len()).unwrap()
        };
        assert_eq!(bits(&buffer), bits(&again));
        record(&gpu, &buffer);
        assert_eq!(buffer.read(&gpu).unwrap(), sorted, "a second record changes nothing");
    }
}

/// Checks that each box of level 1 holds its lights, and each box of the levels above its children.
fn check_boxes(gpu: &Gpu, buffer: &LightBuffer) {
    let slots = buffer.read(gpu).unwrap();
    let spheres = download::<LightSphere>(gpu, buffer.spheres(), slots.len()).unwrap();
    let all = (buffer.nodes().size() / 32) as usize;
    let nodes = download::<LightNode>(gpu, buffer.nodes(), all).unwrap();
    let holds = |node: &LightNode, low: [f32; 3], high: [f32; 3]| {
        (0..3).all(|axis| node.min_world[axis] <= low[axis] && node.max_world[axis] >= high[axis])
    };
    for (slot, sphere) in spheres.iter().enumerate() {
        if slots[slot].intensity == Vec3::ZERO {
            continue;
        }
        let at = Vec3::from(sphere.position_world);
        let (low, high) = (at - sphere.radius_m, at + sphere.radius_m);
        let node = &nodes[slot / 64];
        assert!(holds(node, low.to_array(), high.to_array()), "slot {slot}: {node:?}");
        // Positions are up to 102 m and radii up to 2.3 m.
        let wide = Vec3::from(node.max_world) - Vec3::from(node.min_world);
        assert!(wide.max_element() < 110.0, "slot {slot}: {node:?}");
    }
}

#[test]
fn boxes_hold_the_lights_in_every_frame_of_a_stale_order() {
    let gpu = gpu();
    let order = LightOrder::Gpu { every: 3 };
    // Numbers of lights that grow and shrink, with and without a sort.
    for counts in [[700, 650, 800, 720, 640], [30_000, 29_000, 31_000, 30_500, 28_000]] {
        let mut buffer = LightBuffer::ordered(&gpu, &lights(counts[0], 0), order).unwrap();
        record(&gpu, &buffer);
        for (seed, &count) in (1..).zip(&counts) {
            let given = lights(count, seed);
            buffer.update(&gpu, &given).unwrap();
            record(&gpu, &buffer);
            check_boxes(&gpu, &buffer);
            // Every light has one slot.
            let mut names: Vec<u32> = buffer
                .read(&gpu)
                .unwrap()
                .iter()
                .filter(|light| light.intensity != Vec3::ZERO)
                .map(|light| light.intensity.x as u32)
                .collect();
            names.sort_unstable();
            assert_eq!(names, (1..=count).collect::<Vec<_>>(), "{count} lights, frame {seed}");
        }
    }
}

#[test]
fn a_sort_that_was_not_recorded_is_made_up_for() {
    let gpu = gpu();
    let order = LightOrder::Gpu { every: 8 };
    let mut buffer = LightBuffer::ordered(&gpu, &lights(300, 0), order).unwrap();
    let given = lights(300, 1);
    // No frame was recorded yet.
    buffer.update(&gpu, &given).unwrap();
    record(&gpu, &buffer);
    let mut sorted = buffer.read(&gpu).unwrap();
    sorted.sort_by_key(|light| light.intensity.x as u32);
    assert_eq!(sorted, given);
}

#[test]
fn only_changed_lights_are_uploaded() {
    let gpu = gpu();
    let mut given = lights(10_000, 1);
    let mut buffer = LightBuffer::ordered(&gpu, &given, LightOrder::Gpu { every: 1 }).unwrap();
    assert_eq!(buffer.uploaded_bytes(), 10_000 * 32);
    buffer.update(&gpu, &given).unwrap();
    assert_eq!(buffer.uploaded_bytes(), 0);
    given[5000].position.x += 0.01;
    buffer.update(&gpu, &given).unwrap();
    assert_eq!(buffer.uploaded_bytes(), 1024);
    record(&gpu, &buffer);
    assert!(buffer.read(&gpu).unwrap().contains(&given[5000]));
}
