//! The GPU's order of lights: it is a permutation, stable, the same on every run, and by code; its
//! boxes hold the lights below them; faulty lights light nothing.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use assign::{
    EncoderPasses, Gpu, GpuLights, Light, LightBuffer, LightEmission, LightKinds, LightNode,
    LightOrder, LightSphere, SlotCounts,
    conformance::{download, upload},
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

/// A capacity for which a lane of the digit sum has more than one block, and the code has 24 bits. The
/// first sort has all places, since none was sorted before.
#[test]
fn a_large_capacity_is_sorted_too() {
    let gpu = gpu();
    let capacity = 4_194_305;
    let given = lights(3000, 1);
    let mut own = Own::new(&gpu, &given);
    for (buffer, bytes) in [(&mut own.spheres, 16), (&mut own.emissions, 16)] {
        let larger = gpu.storage("own lights", bytes * u64::from(capacity)).unwrap();
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &larger, 0, buffer.size());
        gpu.queue.submit([encoder.finish()]);
        *buffer = larger;
    }
    let described = own.lights(capacity);
    let buffer = LightBuffer::from_gpu(&gpu, &described, 1).unwrap();
    record(&gpu, &buffer);
    let sorted = buffer.read(&gpu).unwrap();
    let axes = halvings(described.bounds.1 - described.bounds.0, 24);
    let mut expected = given;
    expected.sort_by_key(|light| key(light, described.bounds, &axes));
    assert_eq!(sorted.len(), expected.len());
    let names = |lights: &[Light]| -> Vec<_> { lights.iter().map(|l| l.intensity).collect() };
    assert_eq!(names(&sorted), names(&expected));
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
fn lights_are_sorted_as_soon_as_boxes_may_have_grown() {
    let gpu = gpu();
    let mut given = lights(1000, 1);
    let order = "gpu25%".parse().unwrap();
    let mut buffer = LightBuffer::ordered(&gpu, &given, order).unwrap();
    record(&gpu, &buffer);
    // A box of about 102 m has cubes of 41 m with 64 lights each: a quarter is 10 m, 5 m at each end.
    let mut sorts = Vec::new();
    for _ in 0..12 {
        let before = buffer.order_generation();
        for light in &mut given {
            light.position += Vec3::new(0.9, 0.0, 0.0);
        }
        buffer.update(&gpu, &given).unwrap();
        record(&gpu, &buffer);
        sorts.push(buffer.order_generation() - before);
    }
    assert_eq!(sorts, [0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 1]);
    given[3].intensity = Vec3::ZERO;
    buffer.update(&gpu, &given).unwrap();
    given[3].intensity = Vec3::ONE;
    let before = buffer.order_generation();
    buffer.update(&gpu, &given).unwrap();
    assert_eq!(buffer.order_generation() - before, 1, "a light that becomes bright");
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

/// Lights in buffers of the test's own, as a renderer's kernel would write them.
struct Own {
    spheres: wgpu::Buffer,
    emissions: wgpu::Buffer,
    shapes: wgpu::Buffer,
    count: wgpu::Buffer,
}

impl Own {
    fn new(gpu: &Gpu, lights: &[Light]) -> Self {
        let spheres: Vec<LightSphere> = lights.iter().map(Light::sphere).collect();
        let emissions: Vec<LightEmission> = lights
            .iter()
            .map(|light| LightEmission { intensity: light.intensity.to_array(), kind_and_shape: 0 })
            .collect();
        Self {
            spheres: upload(gpu, "own spheres", &spheres).unwrap(),
            emissions: upload(gpu, "own emissions", &emissions).unwrap(),
            shapes: upload(gpu, "own shapes", &[[0.0_f32; 4]]).unwrap(),
            count: upload(gpu, "own count", &[0_u32, lights.len() as u32, 0, 0]).unwrap(),
        }
    }

    fn lights(&self, capacity: u32) -> GpuLights<'_> {
        GpuLights {
            spheres: &self.spheres,
            emissions: &self.emissions,
            shapes: &self.shapes,
            count: &self.count,
            count_offset: 4,
            capacity,
            kinds: LightKinds::default(),
            bounds: (Vec3::ZERO, Vec3::splat(103.0)),
            radius_max_m: 4.0,
            step_max_m: None,
        }
    }
}

#[test]
fn faulty_lights_from_the_gpu_light_nothing_and_are_counted() {
    let gpu = gpu();
    let mut given = lights(3000, 1);
    given[3].position.x = f32::NAN;
    given[500].position.y = f32::INFINITY;
    given[501].position.z = 1e4;
    given[502].range_m = -1.0;
    given[503].range_m = f32::NAN;
    given[504].range_m = 5.0;
    given[505].intensity.x = f32::NAN;
    given[506].intensity.y = -1.0;
    given[507].intensity.z = 2e18;
    given[2999].range_m = 0.0;
    given[1000].intensity = Vec3::ZERO;
    let own = Own::new(&gpu, &given);
    let mut buffer = LightBuffer::from_gpu(&gpu, &own.lights(3000), 1).unwrap();
    record(&gpu, &buffer);
    let counts = SlotCounts { given: 3000, slots: 3000, faulty: 10, dark: 1 };
    assert_eq!(buffer.read_counts(&gpu).unwrap(), Some(counts));
    let names = |buffer: &LightBuffer| {
        let lights = buffer.read(&gpu).unwrap();
        let mut names: Vec<u32> = lights.iter().map(|light| light.intensity.x as u32).collect();
        names.retain(|&name| name != 0);
        names.sort_unstable();
        names
    };
    let bad = [3, 500, 501, 502, 503, 504, 505, 506, 507, 1000, 2999].map(|ix| ix + 1);
    let sound: Vec<u32> = (1..=3000).filter(|name| !bad.contains(name)).collect();
    assert_eq!(names(&buffer), sound);
    check_boxes(&gpu, &buffer);
    // A kind that was not named is faulty, too.
    gpu.queue.write_buffer(&own.emissions, 12, bytemuck::bytes_of(&(1_u32 << 28)));
    // The GPU's own count changes, up to the capacity.
    for (count, faulty, found) in [(100_u32, 2, 98), (0, 0, 0), (5000, 11, 2988)] {
        gpu.queue.write_buffer(&own.count, 4, bytemuck::bytes_of(&count));
        buffer.update_from_gpu(&gpu, &own.lights(3000)).unwrap();
        record(&gpu, &buffer);
        let counts = buffer.read_counts(&gpu).unwrap().unwrap();
        assert_eq!((counts.given, counts.slots), (count, count.min(3000)));
        assert_eq!((counts.faulty, names(&buffer).len()), (faulty, found), "{count} lights");
    }
}

#[test]
fn lights_that_go_further_than_stated_are_faulty_until_the_next_sort() {
    let gpu = gpu();
    let mut given = lights(300, 1);
    given.iter_mut().for_each(|light| light.position.z *= 0.9);
    given[7].intensity = Vec3::ZERO;
    let own = Own::new(&gpu, &given);
    let described = GpuLights { step_max_m: Some(0.2), ..own.lights(300) };
    let mut buffer = LightBuffer::from_gpu(&gpu, &described, 4).unwrap();
    record(&gpu, &buffer);
    let mut faulty = Vec::new();
    for _ in 1..6 {
        // All move by 0.15 m, light 3 by 0.3 m.
        for (ix, light) in given.iter_mut().enumerate() {
            light.position.z += if ix == 3 { 0.3 } else { 0.15 };
        }
        // It becomes bright, as a new light does.
        given[7].intensity = Vec3::ONE;
        let next = Own::new(&gpu, &given);
        gpu.queue.write_buffer(&own.emissions, 0, &gpu.read(&next.emissions, 300 * 16).unwrap());
        gpu.queue.write_buffer(&own.spheres, 0, &gpu.read(&next.spheres, 300 * 16).unwrap());
        buffer.update_from_gpu(&gpu, &described).unwrap();
        record(&gpu, &buffer);
        faulty.push(buffer.read_counts(&gpu).unwrap().unwrap().faulty);
    }
    // The fourth of these frames sorts.
    assert_eq!(faulty, [2, 2, 2, 0, 1]);
    // Lights that were not drawn in a frame may have moved twice as far.
    for light in &mut given {
        light.position.z += 0.35;
    }
    given[3].position.z -= 0.35;
    let next = Own::new(&gpu, &given);
    gpu.queue.write_buffer(&own.spheres, 0, &gpu.read(&next.spheres, 300 * 16).unwrap());
    buffer.update_from_gpu(&gpu, &described).unwrap();
    buffer.update_from_gpu(&gpu, &described).unwrap();
    record(&gpu, &buffer);
    assert_eq!(buffer.read_counts(&gpu).unwrap().unwrap().faulty, 1, "light 3 stays faulty");
}

#[test]
fn faulty_descriptions_are_refused() {
    let gpu = gpu();
    let own = Own::new(&gpu, &lights(100, 1));
    let sound = own.lights(100);
    let plain = gpu.buffer("plain", 1 << 12, wgpu::BufferUsages::COPY_DST).unwrap();
    let nan = Vec3::splat(f32::NAN);
    for (field, faulty) in [
        ("spheres", GpuLights { capacity: 101, ..sound }),
        ("emissions", GpuLights { emissions: &plain, ..sound }),
        ("count", GpuLights { count: &plain, ..sound }),
        ("count", GpuLights { count_offset: 1 << 40, ..sound }),
        ("count_offset", GpuLights { count_offset: 2, ..sound }),
        ("bounds", GpuLights { bounds: (nan, Vec3::ONE), ..sound }),
        ("bounds", GpuLights { bounds: (Vec3::ONE, Vec3::ZERO), ..sound }),
        ("radius_max_m", GpuLights { radius_max_m: 0.0, ..sound }),
        ("radius_max_m", GpuLights { radius_max_m: f32::NAN, ..sound }),
        ("step_max_m", GpuLights { step_max_m: Some(-1.0), ..sound }),
        ("step_max_m", GpuLights { step_max_m: Some(f32::NAN), ..sound }),
    ] {
        let error = LightBuffer::from_gpu(&gpu, &faulty, 1).unwrap_err().to_string();
        assert!(error.contains(&format!("lights from the GPU: {field}")), "{error}");
    }
    assert!(LightBuffer::from_gpu(&gpu, &sound, 0).is_err());
    let mut still = LightBuffer::new(&gpu, &[]).unwrap();
    assert!(still.update_from_gpu(&gpu, &sound).is_err());
}
