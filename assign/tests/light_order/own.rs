//! Lights in buffers of the test's own, as a renderer's kernel would write them.

use assign::{
    Gpu, GpuLights, Light, LightBuffer, LightEmission, LightKinds, LightSphere, SlotCounts,
    conformance::upload,
};
use glam::Vec3;

use crate::{boxes::check_boxes, gpu, lights, record, small_device};

/// Lights in buffers of the test's own, as a renderer's kernel would write them.
pub(crate) struct Own {
    pub(crate) spheres: wgpu::Buffer,
    pub(crate) emissions: wgpu::Buffer,
    shapes: wgpu::Buffer,
    count: wgpu::Buffer,
    kinds: LightKinds,
}

impl Own {
    pub(crate) fn new(gpu: &Gpu, lights: &[Light]) -> Self {
        let spheres: Vec<LightSphere> = lights.iter().map(Light::sphere).collect();
        let mut shapes = vec![[0.0_f32; 4]];
        let emissions: Vec<LightEmission> =
            lights.iter().map(|light| light.emission(&mut shapes)).collect();
        Self {
            spheres: upload(gpu, "own spheres", &spheres).unwrap(),
            emissions: upload(gpu, "own emissions", &emissions).unwrap(),
            shapes: upload(gpu, "own shapes", &shapes).unwrap(),
            count: upload(gpu, "own count", &[0_u32, lights.len() as u32, 0, 0]).unwrap(),
            kinds: LightKinds::among(lights),
        }
    }

    pub(crate) fn lights(&self, capacity: u32) -> GpuLights<'_> {
        GpuLights {
            spheres: &self.spheres,
            emissions: &self.emissions,
            shapes: &self.shapes,
            count: &self.count,
            count_offset: 4,
            capacity,
            kinds: self.kinds,
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

/// A storage buffer of any size, without any other usage.
fn odd_storage(gpu: &Gpu, bytes: u64) -> wgpu::Buffer {
    gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("own"),
        size: bytes,
        usage: wgpu::BufferUsages::STORAGE,
        mapped_at_creation: false,
    })
}

#[test]
fn buffers_that_the_device_cannot_bind_are_refused() {
    let gpu = small_device(4096);
    let own = Own::new(&gpu, &lights(100, 1));
    let sound = own.lights(100);
    LightBuffer::from_gpu(&gpu, &sound, 1).unwrap();
    let large = odd_storage(&gpu, 4100);
    for (field, faulty) in [
        ("spheres", GpuLights { spheres: &large, ..sound }),
        ("emissions", GpuLights { emissions: &large, ..sound }),
        ("shapes", GpuLights { shapes: &large, ..sound }),
    ] {
        let error = LightBuffer::from_gpu(&gpu, &faulty, 1).unwrap_err().to_string();
        let expected =
            format!("lights from the GPU: {field} is 4100 bytes: it must be at most 4096");
        assert!(error.contains(&expected), "{error}");
    }
    // No binding may be empty.
    let empty = odd_storage(&gpu, 0);
    let none = GpuLights { spheres: &empty, capacity: 0, ..sound };
    let error = LightBuffer::from_gpu(&gpu, &none, 1).unwrap_err().to_string();
    assert!(error.contains("spheres is 0 bytes: it must be at least 16 bytes"), "{error}");
}

#[test]
fn shapes_are_read_back_only_with_the_usage_for_it() {
    let gpu = gpu();
    let own = Own::new(&gpu, &lights(10, 1));
    let shapes = odd_storage(&gpu, 1024);
    let points = GpuLights { shapes: &shapes, ..own.lights(10) };
    let buffer = LightBuffer::from_gpu(&gpu, &points, 1).unwrap();
    record(&gpu, &buffer);
    assert_eq!(buffer.read(&gpu).unwrap().len(), 10);
    let spots = GpuLights { kinds: LightKinds { spots: true, ..LightKinds::default() }, ..points };
    let buffer = LightBuffer::from_gpu(&gpu, &spots, 1).unwrap();
    record(&gpu, &buffer);
    let error = buffer.read(&gpu).unwrap_err().to_string();
    let expected = "it must be usage BufferUsages(COPY_SRC), to read the lights back";
    assert!(error.contains("lights from the GPU: shapes") && error.contains(expected), "{error}");
}

#[test]
fn faulty_descriptions_are_refused() {
    let gpu = gpu();
    let own = Own::new(&gpu, &lights(100, 1));
    let sound = own.lights(100);
    let plain = gpu.buffer("plain", 1 << 12, wgpu::BufferUsages::COPY_DST).unwrap();
    let odd = odd_storage(&gpu, 1602);
    let nan = Vec3::splat(f32::NAN);
    for (field, faulty) in [
        ("spheres", GpuLights { capacity: 101, ..sound }),
        ("emissions", GpuLights { emissions: &plain, ..sound }),
        ("spheres", GpuLights { spheres: &odd, ..sound }),
        ("emissions", GpuLights { emissions: &odd, ..sound }),
        ("shapes", GpuLights { shapes: &odd, ..sound }),
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
