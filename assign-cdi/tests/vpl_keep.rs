//! VPLs kept as lights: dropped VPLs are counted, and unusable maps are refused.

#![allow(dead_code, reason = "the module of maps serves several tests")]
#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]
mod vpl_map;

use assign::{EncoderPasses, Light, LightBuffer, LightShape, Projection};
use assign_cdi::{Large, Rsm, VplBuffer, VplCounts, VplSettings};
use bytemuck::pod_collect_to_vec;
use glam::{Vec2, Vec3};
use vpl_map::{Map, WHITE, room, spot};

#[test]
fn dropped_vpls_are_counted() {
    let light = spot(0.9);
    let map = Map::new([32, 32], light, |ray| Some((light.position.y / -ray.y, Vec3::Y, WHITE)));
    let all = map.lights(VplSettings::default());
    let count = all.len() as u32;
    // VPLs are in turn kept, too small, too large and unknown.
    let given = |ix: u32| [1.0, 0.1, 50.0, f32::MAX][(ix % 4) as usize];
    let settings = VplSettings {
        min_range_m: 0.5,
        max_range_m: 10.0,
        min_distance_m: 0.25,
        large: Large::Discard,
        ..VplSettings::default()
    };
    let expected =
        |which: &[u32]| -> Vec<u32> { (0..count).filter(|ix| which.contains(&(ix % 4))).collect() };
    for (large, which) in [(Large::Discard, &[0][..]), (Large::Clamp, &[0, 2, 3])] {
        let mut buffer = VplBuffer::new(&map.gpu, VplSettings { large, ..settings }).unwrap();
        map.run(&mut buffer, given);
        let kept = expected(which);
        let counts = buffer.read_counts(&map.gpu).unwrap();
        let (small, huge) = (expected(&[1]).len() as u32, expected(&[2, 3]).len() as u32);
        let wanted =
            VplCounts { chosen: count, kept: kept.len() as u32, too_small: small, too_large: huge };
        assert_eq!(counts, wanted, "{large:?}");
        let lights = buffer.read(&map.gpu).unwrap();
        assert_eq!(lights.len(), kept.len());
        for (light, ix) in lights.iter().zip(kept) {
            let range_m = if ix % 4 == 0 { 2.0 } else { 10.0 };
            let LightShape::Vpl { normal, .. } = all[ix as usize].shape else { panic!("a VPL") };
            let shape = LightShape::Vpl { normal, min_distance_m: 0.25 };
            assert_eq!(*light, Light { range_m, shape, ..all[ix as usize] }, "{ix}");
        }
        buffer.prepare(&map.gpu, &map.rsm()).unwrap();
        map.gpu.wait().unwrap();
        buffer.prepare(&map.gpu, &map.rsm()).unwrap();
        assert_eq!(buffer.latest_counts(), Some(wanted));
    }
}

/// The records of kept lights equal those that `LightBuffer` uploads.
#[test]
fn records_equal_those_of_uploaded_lights() {
    let light = spot(1.2);
    let map = Map::new([32, 32], light, room(&light));
    let settings = VplSettings { min_distance_m: 0.5, min_range_m: 20.0, ..VplSettings::default() };
    let mut buffer = VplBuffer::new(&map.gpu, settings).unwrap();
    map.run(&mut buffer, |ix| 0.1 + ix as f32);
    let lights = buffer.read(&map.gpu).unwrap();
    assert!(buffer.read_counts(&map.gpu).unwrap().too_small > 0);
    let uploaded = LightBuffer::new(&map.gpu, &lights).unwrap();
    let count = lights.len() as u64;
    let same = |a, b, bytes| map.gpu.read(a, bytes).unwrap() == map.gpu.read(b, bytes).unwrap();
    assert!(same(buffer.spheres(), uploaded.spheres(), count * 16));
    assert!(same(buffer.emissions(), uploaded.emissions(), count * 16));
    let floats =
        |buffer| -> Vec<f32> { pod_collect_to_vec(&map.gpu.read(buffer, count * 32).unwrap()) };
    // `LightBuffer` normalises the normal once more, which may round it.
    let (kept, given) = (floats(buffer.shapes()), floats(uploaded.shapes()));
    assert!(kept.iter().zip(&given).all(|(a, b)| (a - b).abs() < 1e-6));
}

/// A light buffer takes the kept lights without a read-back, and has their number.
#[test]
fn a_light_buffer_takes_the_lights_from_the_gpu() {
    let light = spot(1.2);
    let map = Map::new([32, 32], light, room(&light));
    let settings = VplSettings { min_range_m: 20.0, max_range_m: 900.0, ..VplSettings::default() };
    let mut buffer = VplBuffer::new(&map.gpu, settings).unwrap();
    map.run(&mut buffer, |ix| 0.1 + ix as f32);
    let by_bits = |mut lights: Vec<Light>| {
        lights.sort_by_key(|light| {
            [light.position.x, light.position.y, light.position.z, light.range_m].map(f32::to_bits)
        });
        lights
    };
    let kept = by_bits(buffer.read(&map.gpu).unwrap());
    let taken = |bounds| {
        let lights = LightBuffer::from_gpu(&map.gpu, &buffer.gpu_lights(bounds), 1).unwrap();
        let mut encoder = map.gpu.device.create_command_encoder(&Default::default());
        lights.record(&mut EncoderPasses { encoder: &mut encoder });
        map.gpu.queue.submit([encoder.finish()]);
        let counts = lights.read_counts(&map.gpu).unwrap().unwrap();
        (counts, by_bits(lights.read(&map.gpu).unwrap()))
    };
    let whole = (Vec3::splat(-4.0), Vec3::splat(4.0));
    let (counts, lights) = taken(whole);
    assert!(lights == kept && kept.len() > 100, "{} lights", kept.len());
    assert_eq!((counts.given, counts.faulty, counts.dark), (kept.len() as u32, 0, 0));
    assert!(lights.len() < buffer.capacity() as usize);
    // A box that leaves the floor out makes its lights faulty.
    let on_floor = kept.iter().filter(|light| light.position.y < 0.5).count() as u32;
    let (counts, _) = taken((Vec3::new(-4.0, 0.5, -4.0), whole.1));
    assert!(on_floor > 0 && counts.faulty == on_floor, "{counts:?}, {on_floor} on the floor");
}

#[test]
fn more_vpls_than_the_limit_are_an_error() {
    let light = spot(0.9);
    let map = Map::new([32, 32], light, |ray| Some((light.position.y / -ray.y, Vec3::Y, WHITE)));
    let all = map.lights(VplSettings::default());
    let limited = |limit| VplSettings { limit: Some(limit), ..VplSettings::default() };
    let mut buffer = VplBuffer::new(&map.gpu, limited(100)).unwrap();
    map.run(&mut buffer, |_| 0.5);
    let error = buffer.read(&map.gpu).unwrap_err().to_string();
    assert_eq!(
        error,
        format!(
            "limit of VPLs is 100: it must be at least {}, the number of VPLs chosen",
            all.len()
        )
    );
    buffer.set_settings(limited(all.len() as u32)).unwrap();
    map.run(&mut buffer, |_| 0.5);
    assert!(buffer.read(&map.gpu).unwrap() == all);
}

#[test]
fn unusable_maps_are_refused() {
    let light = spot(0.9);
    let map = Map::new([32, 32], light, |_| None);
    let mut buffer = VplBuffer::new(&map.gpu, VplSettings::default()).unwrap();
    map.run(&mut buffer, |_| 1.0);
    assert_eq!(buffer.read_counts(&map.gpu).unwrap(), VplCounts::default());
    assert_eq!(buffer.read(&map.gpu).unwrap(), []);
    let mut fail = |rsm: Rsm<'_>| buffer.prepare(&map.gpu, &rsm).unwrap_err().to_string();
    let lamp = Light::point(Vec3::ZERO, 1.0, Vec3::ONE);
    assert!(fail(Rsm { light: &lamp, ..map.rsm() }).contains("it must be a spot"));
    let mut view = map.view;
    view.viewport.width = 4096;
    assert!(fail(Rsm { view: &view, ..map.rsm() }).contains("at most 2048x2048 texels"));
    view.viewport.width = 38;
    assert!(fail(Rsm { view: &view, ..map.rsm() }).contains("at least 41x33"));
    let mut view = map.view;
    view.projection = Projection::Orthographic { min: Vec2::NEG_ONE, max: Vec2::ONE };
    view.far_m = Some(10.0);
    assert!(fail(Rsm { view: &view, ..map.rsm() }).contains("must be perspective"));
}
