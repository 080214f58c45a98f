//! Tests of the laws of motion.

use assign::{Emitter, Light, LightShape};
use glam::Vec3;

use super::*;
use crate::{LightSpec, scatter_lights};

const TIMES: [f32; 7] = [0.0, 1e-3, 1.0, 59.97, 1e3, 123_456.7, 1e6];

fn bounds() -> Aabb {
    Aabb::new(Vec3::new(-20.0, -1.0, 3.0), Vec3::new(25.0, 14.0, 33.0))
}

/// Points, spots, area lights and a few virtual point lights.
fn lights(count: u32) -> Vec<Light> {
    let spec = LightSpec { spot_share: 0.3, area_share: 0.3, ..LightSpec::new(count, bounds()) };
    let mut lights = scatter_lights(&spec).expect("valid");
    for light in lights.iter_mut().step_by(10) {
        *light = Light::vpl(light.position, Vec3::Y, light.range_m, light.intensity);
    }
    lights
}

fn motion(law: MotionLaw, speed_m_s: f32, seed: u64) -> Motion {
    Motion::new(law, speed_m_s, seed, bounds()).expect("valid")
}

fn at(motion: &Motion, lights: &[Light], time_s: f32) -> Vec<Light> {
    let mut out = vec![lights[0]; 3];
    motion.lights_at(lights, time_s, &mut out);
    out
}

#[test]
fn a_seed_gives_one_motion_on_any_number_of_threads() {
    let lights = lights(1_000);
    for law in MotionLaw::LIST {
        let law_of_7 = motion(law, 1.5, 7);
        let first = at(&law_of_7, &lights, 12.25);
        assert_eq!(first, at(&law_of_7, &lights, 12.25), "{law}");
        let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("one thread");
        assert_eq!(first, alone.install(|| at(&law_of_7, &lights, 12.25)), "{law}");
        let one = |(ix, light): (usize, &Light)| law_of_7.light_at(ix as u32, light, 12.25);
        assert_eq!(first, lights.iter().enumerate().filter_map(one).collect::<Vec<_>>(), "{law}");
        // Another seed, another time and another speed give other lights.
        assert_ne!(first, at(&motion(law, 1.5, 8), &lights, 12.25), "{law}");
        assert_ne!(first, at(&motion(law, 1.5, 7 + (1 << 32)), &lights, 12.25), "{law}");
        assert_ne!(first, at(&law_of_7, &lights, 13.25), "{law}");
        assert_ne!(first, at(&motion(law, 2.5, 7), &lights, 12.25), "{law}");
        assert_ne!(first, lights, "{law}");
    }
}

#[test]
fn lights_stay_sound_and_inside_the_box() {
    let mut lights = lights(1_000);
    let [large, small] = [1, 2].map(|ix| Light { range_m: 1.0, ..lights[ix] });
    lights[1] = Light { intensity: Vec3::splat(assign::MAX_INTENSITY), ..large };
    lights[2] = Light { intensity: Vec3::new(0.0, 1e-45, 0.0), ..small };
    for law in MotionLaw::LIST {
        for speed_m_s in [1e-6, 0.7, 30.0, 1e6] {
            let motion = motion(law, speed_m_s, 3);
            for time_s in TIMES {
                for light in at(&motion, &lights, time_s) {
                    light.check().unwrap_or_else(|e| panic!("{law} {speed_m_s} {time_s}: {e}"));
                    assert!(motion.reach().contains(light.position), "{law} {time_s}: {light:?}");
                }
            }
        }
    }
}

/// The largest speed found over the bound, over many lights and times.
fn worst(motion: &Motion, lights: &[Light], dt_s: f32) -> f32 {
    let mut worst = 0.0_f32;
    for (ix, light) in (0..).zip(lights) {
        let farthest_m = motion.farthest_m(ix, light, dt_s);
        for time_s in TIMES {
            let later_s = (time_s + dt_s).min(MAX_TIME_S);
            // At a million seconds the steps of f32 are longer than `dt_s`.
            if later_s - time_s > dt_s {
                continue;
            }
            let ends = [time_s, later_s].map(|time_s| motion.light_at(ix, light, time_s));
            let moved_m = match ends {
                [Some(a), Some(b)] => moved_m(&a, &b),
                [None, None] => 0.0,
                _ => f32::INFINITY,
            };
            if moved_m > 0.0 && farthest_m.is_finite() {
                worst = worst.max(moved_m / farthest_m);
            }
            assert!(moved_m <= farthest_m, "{ix} at {time_s}: {moved_m} m of {farthest_m} m");
        }
    }
    worst
}

/// How far a light moved, with its rim where it turned.
fn moved_m(a: &Light, b: &Light) -> f32 {
    let turned = match (&a.shape, &b.shape) {
        (LightShape::Spot { direction: a, .. }, LightShape::Spot { direction: b, .. }) => (*a, *b),
        (LightShape::Vpl { normal: a, .. }, LightShape::Vpl { normal: b, .. }) => (*a, *b),
        (LightShape::Area(a), LightShape::Area(b)) => (a.normal(), b.normal()),
        _ => (Vec3::X, Vec3::X),
    };
    a.position.distance(b.position) + turned.0.distance(turned.1) * a.range_m
}

#[test]
fn no_light_is_faster_than_its_bound() {
    let lights = lights(500);
    for law in MotionLaw::LIST {
        for speed_m_s in [0.01, 1.0, 40.0, 1e5] {
            for dt_s in [1e-4, 1.0 / 60.0, 0.5, 20.0] {
                let worst = worst(&motion(law, speed_m_s, 5), &lights, dt_s);
                // An orbit has exactly this speed, so a lower bound would not hold.
                if law == MotionLaw::Orbit && speed_m_s == 1.0 && dt_s == 1.0 / 60.0 {
                    assert!(worst > 0.98, "{worst}");
                }
            }
        }
    }
}

#[test]
fn drifting_reaches_much_of_its_speed() {
    let worst = worst(&motion(MotionLaw::Drift, 1.0, 5), &lights(2_000), 1.0 / 60.0);
    assert!(worst > 0.5, "{worst}");
}

#[test]
fn births_change_the_number_of_lights() {
    let lights = lights(1_000);
    let motion = motion(MotionLaw::Births, 5.0, 2);
    let counts: Vec<_> = (0..40).map(|ix| at(&motion, &lights, 0.25 * ix as f32).len()).collect();
    assert!(counts.windows(2).filter(|pair| pair[0] != pair[1]).count() > 20, "{counts:?}");
    // A share of 3/4 of 1,000 has a standard deviation of 14.
    assert!(counts.iter().all(|count| (680..=820).contains(count)), "{counts:?}");
    // Every light dies and comes back at another place.
    for (ix, light) in (0..).zip(&lights) {
        let life: Vec<_> = (0..400).map(|s| motion.light_at(ix, light, 0.1 * s as f32)).collect();
        assert!(life.contains(&None), "{ix}");
        let away = |l: &Option<Light>| l.is_some_and(|l| l.position != light.position);
        assert!(life.iter().any(away), "{ix}");
    }
}

#[test]
fn a_quarter_of_the_lights_jumps() {
    let lights = lights(1_000);
    let motion = motion(MotionLaw::Teleport, 5.0, 2);
    let jumpers = (0..).zip(&lights).filter(|(ix, light)| {
        let far = motion.farthest_m(*ix, light, 1e9).is_infinite();
        let place = |time_s| motion.light_at(*ix, light, time_s).expect("alive").position;
        // Drifting goes at most sqrt(3)/32 of the diagonal away.
        let limit_m = bounds().diagonal() * 0.0542;
        let jumped = (0..40).any(|s| place(s as f32).distance(light.position) > limit_m);
        assert!(far || !jumped, "{ix}");
        jumped
    });
    let jumpers = jumpers.count();
    // The standard deviation is 14. A few jumps are short.
    assert!((190..=300).contains(&jumpers), "{jumpers}");
}

#[test]
fn flicker_swings_and_jumps() {
    let light = Light::point(Vec3::new(0.0, 3.0, 9.0), 2.0, Vec3::new(1.0, 0.5, 0.0));
    let motion = motion(MotionLaw::Flicker, 1.0, 4);
    let levels: Vec<f32> = (0..20_000)
        .map(|ix| motion.light_at(9, &light, 0.001 * ix as f32).expect("alive").intensity)
        .inspect(|i| assert!(i.y == 0.5 * i.x && i.z == 0.0 && i.x >= 0.06 && i.x <= 1.0, "{i}"))
        .map(|intensity| intensity.x)
        .collect();
    let steps = || levels.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    assert!((10..60).contains(&steps().filter(|step| *step > 0.02).count()));
    assert!(steps().filter(|step| *step > 0.0 && *step < 0.002).count() > 15_000);
}

#[test]
fn turning_keeps_places_and_shapes() {
    let hexagon: Vec<Vec3> =
        (0..6).map(|ix| Vec3::new(5.0 + (ix as f32).cos(), 1.0, 7.0 - (ix as f32).sin())).collect();
    let (polygon, middle) = Emitter::polygon(&hexagon).expect("valid");
    let rectangle = Emitter::rectangle(Vec3::X, 2.0 * Vec3::Y).two_sided().with_diffuse_share(0.5);
    let motion = motion(MotionLaw::Turn, 1.0, 4);
    for (emitter, place) in [(polygon, middle), (rectangle, Vec3::new(1.0, 2.0, 8.0))] {
        let light = Light::area(emitter, place, 3.0, Vec3::ONE);
        let turned = motion.light_at(3, &light, 2.0).expect("alive");
        let LightShape::Area(after) = turned.shape else { panic!("{turned:?}") };
        assert_eq!((turned.position, turned.intensity), (place, light.intensity));
        assert!((after.area() / emitter.area() - 1.0).abs() < 1e-5);
        assert!(after.normal().distance(emitter.normal()) > 0.1);
        assert_eq!((after.outline(), after.two_sided), (emitter.outline(), emitter.two_sided));
        assert_eq!(after.diffuse_share, emitter.diffuse_share);
        let [x, y] = after.half_axes();
        for v in after.vertices() {
            assert!(v.dot(x).abs() <= 1.000_001 * x.length_squared(), "{v}");
            assert!(v.dot(y).abs() <= 1.000_001 * y.length_squared(), "{v}");
        }
    }
    let point = Light::point(Vec3::new(0.0, 3.0, 9.0), 2.0, Vec3::ONE);
    assert_eq!(motion.light_at(3, &point, 2.0), Some(point));
}

#[test]
fn at_speed_zero_and_for_faulty_lights_nothing_changes() {
    let mut lights = lights(100);
    lights[7].position.y = f32::NAN;
    lights[8].intensity.x = f32::INFINITY;
    lights[9].position = Vec3::splat(1e30);
    let text = |lights: &[Light]| format!("{lights:?}");
    for law in MotionLaw::LIST {
        let still = motion(law, 0.0, 1);
        assert_eq!(text(&at(&still, &lights, 77.7)), text(&lights), "{law}");
        assert_eq!(still.farthest_m(4, &lights[4], 1.0), 0.0);
        let moving = motion(law, 1.0, 1);
        for ix in [7, 8] {
            let light = moving.light_at(ix, &lights[ix as usize], 3.0).expect("kept");
            assert_eq!(text(&[light]), text(&lights[ix as usize..][..1]), "{law}");
        }
        for time_s in [f32::NAN, -1.0, f32::INFINITY, 1e30] {
            for light in at(&moving, &lights[..6], time_s) {
                light.check().expect("sound");
                assert!(bounds().contains(light.position));
            }
        }
    }
}

#[test]
fn flat_tiny_and_huge_boxes_hold_their_lights() {
    let place = Vec3::new(3.0, 4.0, 5.0);
    let flat = Aabb::new(place - Vec3::X, place + Vec3::X);
    let huge = Aabb::new(Vec3::splat(-1e12), Vec3::splat(1e12));
    let boxes = [Aabb::new(place, place), flat, huge, Aabb::new(place, place + 1e-6)];
    for bounds in boxes {
        for law in MotionLaw::LIST {
            for speed_m_s in [1e-30, 1.0, 1e6] {
                let motion = Motion::new(law, speed_m_s, 1, bounds).expect("valid");
                for (ix, time_s) in (0..50).flat_map(|ix| TIMES.map(|time_s| (ix, time_s))) {
                    let light = Light::point(place, 1.0, Vec3::ONE);
                    let Some(light) = motion.light_at(ix, &light, time_s) else { continue };
                    light.check().expect("sound");
                    assert!(bounds.contains(light.position), "{law} {bounds:?}: {light:?}");
                }
            }
        }
    }
}

#[test]
fn errors_name_field_value_and_what_is_accepted() {
    let error = |speed_m_s, bounds| {
        Motion::new(MotionLaw::Drift, speed_m_s, 1, bounds).expect_err("faulty").to_string()
    };
    for speed_m_s in [-1.0, f32::NAN, f32::INFINITY, 1.1e6] {
        let text = error(speed_m_s, bounds());
        assert!(text.starts_with(&format!("speed of lights is {speed_m_s}: it must")), "{text}");
    }
    for max in [Vec3::NAN, Vec3::INFINITY, Vec3::splat(2e12), Vec3::splat(-2.0)] {
        let text = error(1.0, Aabb::new(Vec3::ZERO, max));
        assert!(text.starts_with("bounds of moving lights is "), "{text}");
    }
}
