//! Lights that are faulty or dark: left out, or kept in their places.

use assign::{Gpu, Light, LightBuffer, LightKinds, LightOrder, LightShape, MIN_RANGE_M};
use glam::Vec3;

/// A point, a dark spot, a faulty light, and a point.
fn given() -> [Light; 4] {
    let at = |x: f32| Light::point(Vec3::new(x, 0.0, 0.0), 2.0, Vec3::ONE);
    let spot = LightShape::Spot { direction: Vec3::X, inner_angle: 0.1, outer_angle: 0.5 };
    [
        at(5.0),
        Light { intensity: Vec3::ZERO, shape: spot, ..at(90.0) },
        Light { range_m: f32::NAN, ..at(70.0) },
        at(8.0),
    ]
}

#[test]
fn lights_that_light_nothing_are_left_out() {
    let gpu = Gpu::noop().unwrap();
    let lights = LightBuffer::new(&gpu, &given()).unwrap();
    assert_eq!(lights.count(), 2);
    assert_eq!([0, 1, 2].map(|light| lights.given_index(light)), [Some(0), Some(3), None]);
    let rejected: Vec<usize> = lights.rejected().iter().map(|light| light.index).collect();
    assert_eq!(rejected, [1, 2]);
}

#[test]
fn with_kept_indices_every_light_has_its_place_and_dark_ones_reach_nothing() {
    let gpu = Gpu::noop().unwrap();
    for order in [LightOrder::Given, LightOrder::Bvh, LightOrder::Gpu { every: 1 }] {
        let mut lights = LightBuffer::ordered(&gpu, &[], order).unwrap();
        lights.keep_indices(true);
        lights.update(&gpu, &given()).unwrap();
        assert_eq!(lights.count(), 4, "{order}");
        let rejected: Vec<usize> = lights.rejected().iter().map(|light| light.index).collect();
        assert_eq!(rejected, [2], "{order}");
        for (slot, light) in (0..).zip(lights.lights()) {
            let given_ix = lights.given_index(slot).unwrap() as usize;
            assert!(order != LightOrder::Given || given_ix == slot as usize);
            match given_ix {
                0 | 3 => assert_eq!(*light, given()[given_ix], "{order}"),
                _ => assert_eq!((light.range_m, light.intensity), (MIN_RANGE_M, Vec3::ZERO)),
            }
        }
        // They change neither what is compiled nor any box.
        assert_eq!(lights.kinds(), LightKinds::default(), "{order}");
        let (low, high) = lights.bounds().unwrap();
        assert_eq!((low.x, high.x), (3.0, 10.0), "{order}");
        // A dark light that becomes bright may be anywhere, so kept lists are made again.
        let before = lights.travel();
        let mut bright = given();
        bright[1].intensity = Vec3::ONE;
        lights.update(&gpu, &bright).unwrap();
        assert_ne!(lights.travel().jumps, before.jumps, "{order}");
        // Without kept indices, later updates leave them out again.
        lights.keep_indices(false);
        lights.update(&gpu, &given()).unwrap();
        assert_eq!(lights.count(), 2, "{order}");
    }
}
