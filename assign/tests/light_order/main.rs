//! The GPU's order of lights: it is a permutation, stable, the same on every run, and by code; its
//! boxes hold the lights below them; faulty lights light nothing.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod boxes;
mod faults;
mod indices;
mod motion;
mod own;
mod records;

use assign::{
    AssignError, Emitter, EncoderPasses, Gpu, Light, LightBuffer, LightOrder, LightShape,
    conformance::download,
};
use glam::{EulerRot, Mat3, Vec3};

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

/// As [`lights`], of every kind.
fn mixed(count: u32, seed: u32) -> Vec<Light> {
    let of_kind = |(ix, light): (usize, Light)| {
        let angles = Vec3::new(1.0, 2.0, 3.0) * ix as f32;
        let rotation = Mat3::from_euler(EulerRot::XYZ, angles.x, angles.y, angles.z);
        let direction = rotation * Vec3::Z;
        let size = 0.1 + 0.1 * (ix % 9) as f32;
        let outer_angle = 0.05 + 0.1 * (ix % 31) as f32;
        let area = |emitter: Emitter| {
            LightShape::Area(if ix % 3 == 0 { emitter.two_sided() } else { emitter })
        };
        let shape = match ix % 8 {
            0 => LightShape::Point,
            1 => LightShape::Spot { direction, inner_angle: 0.5 * outer_angle, outer_angle },
            2 => LightShape::Vpl { normal: direction, min_distance_m: 0.1 },
            3 => area(Emitter::rectangle(rotation * Vec3::X * size, rotation * Vec3::Y * 0.3)),
            4 => area(Emitter::disc(direction, size)),
            5 => area(Emitter::sphere(size)),
            6 => area(Emitter::line(direction * size, 0.05)),
            _ => {
                let count = 3 + ix % 8;
                let vertex = |vertex: usize| {
                    let (sin, cos) =
                        (std::f32::consts::TAU * vertex as f32 / count as f32).sin_cos();
                    rotation * Vec3::new(size * cos, 0.4 * sin, 0.0)
                };
                let vertices: Vec<Vec3> = (0..count).map(vertex).collect();
                area(Emitter::polygon(&vertices).unwrap().0)
            }
        };
        Light { shape, ..light }
    };
    lights(count, seed).into_iter().enumerate().map(of_kind).collect()
}

fn record(gpu: &Gpu, buffer: &LightBuffer) {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    buffer.record(&mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
}

/// The axes along which a box is halved: each time the longest, 8 times at most.
fn halvings(size: Vec3, bits: u32) -> Vec<usize> {
    let (mut side, mut times) = (size, [0; 3]);
    let mut axes = Vec::new();
    for _ in 0..bits {
        let longest = |a: &usize, b: &usize| side[*a].total_cmp(&side[*b]);
        let axis = (0..3).filter(|&axis| times[axis] < 8).max_by(longest).unwrap();
        side[axis] /= 2.0;
        times[axis] += 1;
        axes.push(axis);
    }
    axes
}

/// The CPU's twin of the code: which half of each halving the position lies in.
fn key(light: &Light, (low, high): (Vec3, Vec3), axes: &[usize]) -> u32 {
    let mut cells = [0, 1, 2].map(|axis| {
        let bits = axes.iter().filter(|&&a| a == axis).count();
        let cells = ((1 << bits) as f32).next_down();
        let per_m = cells / (high - low)[axis];
        // The highest bit of the cell is the first halving.
        ((light.position - low)[axis] * per_m) as u32 * (1 << (31 - bits))
    });
    axes.iter().fold(0, |key, &axis| {
        let upper = cells[axis] >> 30 & 1;
        cells[axis] <<= 1;
        key << 1 | upper
    })
}

/// Bits of the code of so many lights; there is room for a quarter more.
fn bits(count: u32) -> u32 {
    if count * 5 / 4 <= 16_384 { 8 } else { 16 }
}

/// A device that checks every call and runs none, and binds few bytes.
fn small_device(binding_bytes: u64) -> Gpu {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = wgpu::Backends::NOOP;
    descriptor.backend_options.noop.enable = true;
    let instance = wgpu::Instance::new(descriptor);
    let adapter = pollster::block_on(instance.request_adapter(&Default::default())).unwrap();
    let limits =
        wgpu::Limits { max_storage_buffer_binding_size: binding_bytes, ..wgpu::Limits::default() };
    let (device, queue) =
        pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor {
            required_limits: limits,
            ..Default::default()
        }))
        .unwrap();
    Gpu::new(device, queue, adapter.get_info())
}

#[test]
fn lights_are_sorted_by_their_codes_and_equal_codes_stay_in_order() {
    let gpu = gpu();
    for count in [0, 1, 2, 63, 64, 65, 1000, 1638, 1700, 13_107, 13_108, 20_000, 70_000] {
        let given = lights(count, 1);
        let buffer = LightBuffer::ordered(&gpu, &given, LightOrder::Gpu { every: 1 }).unwrap();
        record(&gpu, &buffer);
        let sorted = buffer.read(&gpu).unwrap();
        let (low, high) = buffer.position_bounds().unwrap_or_default();
        let mut expected = given.clone();
        let axes = halvings(high - low, bits(count));
        expected.sort_by_key(|light| key(light, (low, high), &axes));
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

#[test]
fn lights_that_leave_no_room_to_spare_fit() {
    let order = LightOrder::Gpu { every: 1 };
    let gpu = small_device(1200 * 16);
    let mut buffer = LightBuffer::ordered(&gpu, &lights(800, 1), order).unwrap();
    // Room for a quarter more fits, then only what is needed.
    assert_eq!(buffer.spheres().size(), 1000 * 16);
    for count in [1001, 1200] {
        buffer.update(&gpu, &lights(count, 1)).unwrap();
        assert_eq!(buffer.spheres().size(), u64::from(count) * 16);
    }
    let error = buffer.update(&gpu, &lights(1201, 1)).unwrap_err();
    assert!(matches!(error, AssignError::TooLarge { .. }), "{error}");
    assert_eq!(buffer.lights().len(), 1200);
}
