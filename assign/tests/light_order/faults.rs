//! The GPU judges the record of a light as the CPU judges the light: at the limits and beyond them, and for
//! random area lights.

use std::f32::consts::TAU;

use assign::{
    Emitter, EncoderPasses, Gpu, GpuLights, Light, LightBuffer, LightEmission, LightKind,
    LightKinds, LightSphere, MAX_RANGE_M,
    conformance::{download, upload},
};
use glam::{Mat3, Quat, Vec3};

use crate::records::{
    Record, area, contradictions, corner, disc, faulty, hidden, regular, ring, sound, spot, square,
    vpl,
};

/// The stated largest radius, metres.
const RADIUS_MAX_M: f32 = 2.0 * MAX_RANGE_M;

/// Whether the GPU accepts each of some records. Records at the origin are moved apart.
fn accepted(gpu: &Gpu, records: &[Record]) -> Vec<bool> {
    let mut spheres: Vec<LightSphere> = records.iter().map(|r| r.sphere).collect();
    let mut emissions: Vec<LightEmission> = records.iter().map(|r| r.emission).collect();
    let mut shapes: Vec<[f32; 4]> = Vec::new();
    for (ix, record) in records.iter().enumerate() {
        if spheres[ix].position_world == [0.0; 3] {
            spheres[ix].position_world[0] = ix as f32;
        }
        emissions[ix].kind_and_shape += shapes.len() as u32;
        shapes.extend(&record.shapes);
    }
    let count = records.len() as u32;
    let own = [
        upload(gpu, "own spheres", &spheres).unwrap(),
        upload(gpu, "own emissions", &emissions).unwrap(),
        upload(gpu, "own shapes", &shapes).unwrap(),
        upload(gpu, "own count", &[count; 4]).unwrap(),
    ];
    let lights = GpuLights {
        spheres: &own[0],
        emissions: &own[1],
        shapes: &own[2],
        count: &own[3],
        count_offset: 0,
        capacity: count,
        kinds: LightKinds::EVERY,
        bounds: (Vec3::new(0.0, -1.0, -1.0), Vec3::new(count as f32, 1.0, 1.0)),
        radius_max_m: RADIUS_MAX_M,
        step_max_m: None,
    };
    let buffer = LightBuffer::from_gpu(gpu, &lights, 1).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    buffer.record(&mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    let slots = download::<LightSphere>(gpu, buffer.spheres(), records.len()).unwrap();
    let lit = download::<LightEmission>(gpu, buffer.emissions(), records.len()).unwrap();
    let mut accepted = vec![false; records.len()];
    for (sphere, _) in slots.iter().zip(&lit).filter(|(_, lit)| lit.intensity != [0.0; 3]) {
        accepted[sphere.position_world[0] as usize] = true;
    }
    let counts = buffer.read_counts(gpu).unwrap().unwrap();
    let refused = accepted.iter().filter(|sound| !**sound).count() as u32;
    assert_eq!(counts.faulty + counts.dark, refused, "{counts:?}");
    accepted
}

/// Fails with the rows whose verdict is not `sound`.
fn expect(gpu: &Gpu, rows: &[(String, Record)], sound: bool) {
    let records: Vec<Record> = rows.iter().map(|(_, record)| record.clone()).collect();
    let wrong: Vec<&(String, Record)> = rows
        .iter()
        .zip(accepted(gpu, &records))
        .filter(|(_, accepted)| *accepted != sound)
        .map(|(row, _)| row)
        .collect();
    let count = wrong.len();
    let shown = &wrong[..count.min(10)];
    assert!(wrong.is_empty(), "{count} records, which must be sound: {sound}: {shown:#?}");
}

fn rows(lights: &[Light]) -> Vec<(String, Record)> {
    lights.iter().map(|light| (format!("{light:?}"), Record::new(light))).collect()
}

#[test]
fn cpu_and_gpu_agree_which_lights_are_faulty() {
    let gpu = Gpu::open(None).unwrap();
    let (sound, faulty, hidden) = (sound(), faulty(), hidden());
    for light in &sound {
        assert_eq!(light.check(), Ok(()), "{light:?}");
    }
    for light in faulty.iter().chain(&hidden) {
        assert!(light.check().is_err(), "{light:?}");
    }
    expect(&gpu, &rows(&sound), true);
    expect(&gpu, &rows(&faulty), false);
    expect(&gpu, &rows(&hidden), true);
}

#[test]
fn records_that_contradict_themselves_are_faulty() {
    let gpu = Gpu::open(None).unwrap();
    let contradictions = contradictions();
    let named = contradictions.iter().map(|(name, record)| ((*name).to_owned(), record.clone()));
    expect(&gpu, &named.collect::<Vec<_>>(), false);
    // A ball that is larger than it needs to be is sound.
    let loose = Record::new(&square()).with(|r| r.sphere.radius_m = 10.0);
    expect(&gpu, &[("a large ball".to_owned(), loose)], true);
    for count in [3, 10] {
        expect(&gpu, &[("a loose polygon".to_owned(), ring(count))], true);
    }
    // Records whose last shape vector is missing: nothing may follow them.
    let lights = [spot(Vec3::X, 0.3, 0.5), vpl(Vec3::X, 0.3), square(), regular(6), disc(0.3)];
    let whole = lights.iter().map(Record::new).chain([corner()]);
    for whole in whole {
        expect(&gpu, &[("whole".to_owned(), whole.clone())], true);
        let cut = whole.with(|r| r.shapes.truncate(r.shapes.len() - 1));
        expect(&gpu, &[("cut".to_owned(), cut)], false);
    }
}

/// Area lights of every size and shape, turned at random, up to the limits of what is accepted.
#[test]
fn random_area_lights_are_sound() {
    let gpu = Gpu::open(None).unwrap();
    let mut state = 1_u32;
    let mut random = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (state >> 8) as f32 / (1 << 24) as f32
    };
    let mut lights = Vec::new();
    while lights.len() < 600 {
        let size = 10_f32.powf(-3.9 + 8.5 * random());
        let narrow = 10_f32.powf(-4.0 * random());
        let axis = Vec3::new(random() - 0.5, random() - 0.5, random() - 0.5).normalize_or(Vec3::Z);
        let rotation = Quat::from_axis_angle(axis, TAU * random());
        let [x, y] = [rotation * Vec3::X * size, rotation * Vec3::Y * size * narrow];
        let middle = Vec3::new(random(), random(), random()) * size * 10_f32.powf(2.0 * random());
        let count = 3 + (8.0 * random()) as u32;
        let vertex = |ix: u32| {
            let (sin, cos) = (TAU * (ix as f32 + 0.3) / count as f32).sin_cos();
            middle + x * cos + y * sin
        };
        let made = match lights.len() % 5 {
            0 => Ok(Emitter::rectangle(x, y)),
            1 => Ok(Emitter::disc(x, size)),
            2 => Ok(Emitter::line(x, narrow * size)),
            _ => Emitter::polygon(&(0..count).map(vertex).collect::<Vec<_>>()).map(|(p, _)| p),
        };
        let Ok(mut emitter) = made else { continue };
        if random() < 0.5 {
            emitter = emitter
                .turned(&Mat3::from_axis_angle(axis.any_orthonormal_vector(), TAU * random()));
        }
        if random() < 0.5 {
            emitter = emitter.two_sided().with_diffuse_share(0.2 + 0.8 * random());
        }
        let range_m = 10_f32.powf(-5.0 + 13.0 * random());
        let light = Light { range_m, ..area(emitter) };
        // Rounding bends thin polygons.
        if light.check().is_ok() {
            lights.push(light);
        }
    }
    let polygons = lights.iter().filter(|light| light.kind() == LightKind::Polygon).count();
    assert!((100..500).contains(&polygons), "{polygons} polygons");
    expect(&gpu, &rows(&lights), true);
}
