//! Large capacities, steps that are larger than stated, and sorts when boxes may have grown.

use assign::{GpuLights, Light, LightBuffer};
use glam::Vec3;

use crate::{gpu, halvings, key, lights, own::Own, record};

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
