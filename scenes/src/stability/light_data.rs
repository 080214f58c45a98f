//! Odd lights, and odd numbers of them: scenarios 11 to 16.

use assign::{Emitter, Light, Sun};
use glam::Vec3;

use super::{Figure, Group, Scenario, kit::Kit};

/// The scenarios, by number.
pub(super) const ROWS: &[Scenario] = &[
    Group::LightData.row(
        11,
        "degenerate-lights",
        "Lights of range 0, of a negative range, without intensity or without area divide by 0.",
        degenerate_lights,
    ),
    Group::LightData.row(
        12,
        "non-finite-lights",
        "A position that is not a number poisons every box, sort and sum that it enters.",
        non_finite_lights,
    ),
    Group::LightData.row(
        13,
        "count-0",
        "Without any light, buffers of length 0 cannot be bound and averages divide by 0.",
        no_light,
    ),
    Group::LightData.row(13, "count-1", "A hierarchy over one light has no inner node.", |kit| {
        kit.hall();
        let light = kit.point_light(Vec3::new(0.0, 2.2, -4.0), 7.0);
        kit.lights.push(light);
    }),
    Group::LightData.row(13, "count-31", "One light less than a word of bits.", |kit| {
        count(kit, 31, (2.0, 5.0));
    }),
    Group::LightData.row(13, "count-33", "One light more than a word of bits.", |kit| {
        count(kit, 33, (2.0, 5.0));
    }),
    Scenario {
        heavy: true,
        ..Group::LightData.row(
            13,
            "count-65537",
            "Light 65,536 is lost where indices have 16 bits.",
            |kit| {
                count(kit, 65_536, (0.04, 0.25));
                // The last light shows.
                let light = kit.point_light(Vec3::new(0.0, 1.0, -2.0), 3.0);
                kit.lights.push(light);
            },
        )
    },
    Scenario {
        heavy: true,
        ..Group::LightData.row(
            13,
            "count-1048577",
            "Light 2^20 is lost where indices have 20 bits.",
            |kit| {
                count(kit, 1 << 20, (0.01, 0.1));
                let light = kit.point_light(Vec3::new(0.0, 1.0, -2.0), 3.0);
                kit.lights.push(light);
            },
        )
    },
    Scenario {
        figure: Figure::ListedOverContributing,
        ..Group::LightData.row(
            14,
            "crowded-group",
            "2,000 lights in one group exceed every fixed list, and the pool of entries.",
            crowded_group,
        )
    },
    Group::LightData.row(
        15,
        "coincident-centres",
        "Lights at one point have equal codes, which a hierarchy cannot split.",
        coincident_centres,
    ),
    Group::LightData.row(
        16,
        "extreme-intensities",
        "Bright lights become infinite in half floats, and dim ones 0.",
        extreme_intensities,
    ),
];

fn count(kit: &mut Kit, count: usize, ranges_m: (f32, f32)) {
    kit.hall();
    kit.scatter(count, Kit::hall_box(), ranges_m);
}

/// Puts faulty lights between good ones, at every third place.
fn hide_among_good(kit: &mut Kit, faulty: Vec<Light>) {
    kit.hall();
    kit.scatter(90, Kit::hall_box(), (1.0, 4.0));
    for (ix, light) in faulty.into_iter().enumerate() {
        kit.lights.insert(3 * ix, light);
    }
}

/// A sound light in the middle of the hall.
fn sound() -> Light {
    Light::point(Vec3::new(0.0, 1.5, -4.0), 6.0, Vec3::splat(2.0))
}

fn degenerate_lights(kit: &mut Kit) {
    let sound = sound();
    let area = |half_x, half_y| {
        Light::area(Emitter::rectangle(half_x, half_y), sound.position, 6.0, Vec3::splat(2.0))
    };
    hide_among_good(
        kit,
        vec![
            Light { range_m: 0.0, ..sound },
            Light { range_m: -3.0, ..sound },
            Light { range_m: f32::MIN_POSITIVE, ..sound },
            Light { intensity: Vec3::ZERO, ..sound },
            Light { intensity: Vec3::new(1.0, -2.0, 1.0), ..sound },
            area(Vec3::ZERO, Vec3::Y),
            area(Vec3::ZERO, Vec3::ZERO),
            area(Vec3::X, 1e-6 * Vec3::Y),
        ],
    );
}

fn non_finite_lights(kit: &mut Kit) {
    let sound = sound();
    let mut faulty = Vec::new();
    for value in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY] {
        faulty.push(Light { position: sound.position.with_x(value), ..sound });
        faulty.push(Light { position: sound.position.with_z(value), ..sound });
        faulty.push(Light { intensity: sound.intensity.with_y(value), ..sound });
        faulty.push(Light { range_m: value, ..sound });
    }
    hide_among_good(kit, faulty);
}

/// A sun shows the hall. It stands in no list.
fn no_light(kit: &mut Kit) {
    kit.hall();
    let direction = Vec3::new(-0.3, -1.0, -0.6).normalize();
    kit.suns.push(Sun { direction, irradiance: Vec3::splat(2.0) });
}

/// All 2,000 lights lie in a ball of 4 cm beside a column, and some others elsewhere.
fn crowded_group(kit: &mut Kit) {
    kit.hall();
    for _ in 0..2_000 {
        let away = kit.direction() * kit.range(0.0, 0.04);
        let range_m = kit.range(0.5, 0.9);
        let mut light = kit.point_light(Vec3::new(-2.8, 1.2, -1.3) + away, range_m);
        light.intensity *= 0.05;
        kit.lights.push(light);
    }
    kit.scatter(40, Kit::hall_box(), (1.5, 4.0));
}

/// 500 lights of all ranges at one point, and 20 more points with 30 lights each.
fn coincident_centres(kit: &mut Kit) {
    kit.hall();
    let at = |kit: &mut Kit, place: Vec3, count: usize, ranges_m: (f32, f32)| {
        for _ in 0..count {
            let range_m = kit.log_range(ranges_m.0, ranges_m.1);
            let mut light = kit.point_light(place, range_m);
            light.intensity /= count as f32 / 10.0;
            kit.lights.push(light);
        }
    };
    at(kit, Vec3::new(0.2, 1.6, -4.5), 500, (0.3, 6.0));
    for _ in 0..20 {
        let place = kit.point_in(Kit::hall_box());
        at(kit, place, 30, (0.5, 2.5));
    }
}

/// Intensities from 1e-9 to 1e7: the left half of the hall is dim, the right half bright.
fn extreme_intensities(kit: &mut Kit) {
    kit.hall();
    kit.scatter(160, Kit::hall_box(), (1.0, 4.0));
    for ix in 0..kit.lights.len() {
        let factor = match kit.lights[ix].position.x < 0.0 {
            true => kit.log_range(1e-9, 1e-3),
            false => kit.log_range(1.0, 1e7),
        };
        kit.lights[ix].intensity *= factor;
    }
}
