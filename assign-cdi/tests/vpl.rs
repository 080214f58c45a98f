//! VPLs chosen from maps that the tests fill: light is conserved, and the order is fixed.

#![allow(dead_code, reason = "the module of maps serves several tests")]
#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]
mod vpl_map;

use std::f32::consts::PI;

use assign::{Light, LightShape, Projection};
use assign_cdi::{VplBuffer, VplSettings, lambertian_albedo};
use bytemuck::pod_collect_to_vec;
use glam::{DVec3, Vec2, Vec3};
use vpl_map::{HALF_WALL_M, Hit, Map, WHITE, room, spot};

fn total(lights: &[Light]) -> DVec3 {
    lights.iter().map(|light| light.intensity.as_dvec3()).sum()
}

/// The room's surfaces: the axis of the plane, its coordinate on that axis, base colour and metallic.
const SURFACES: [(usize, f32, Vec3, f32); 5] = [
    (1, 0.0, Vec3::new(0.8, 0.7, 0.6), 0.0),
    (0, -HALF_WALL_M, Vec3::new(0.9, 0.1, 0.1), 0.0),
    (0, HALF_WALL_M, Vec3::new(0.1, 0.9, 0.1), 0.5),
    (2, -HALF_WALL_M, Vec3::new(0.5, 0.5, 0.9), 0.0),
    (2, HALF_WALL_M, Vec3::ZERO, 0.0),
];

/// Distance from the nearest of the room's surfaces, metres.
fn off_surface(p: Vec3) -> f32 {
    let off = |(axis, at, ..): (usize, f32, Vec3, f32)| (p[axis] - at).abs();
    SURFACES.map(off).into_iter().fold(f32::INFINITY, f32::min)
}

/// The integral of a surface's diffuse term times the cosine over the hemisphere, by the midpoint rule in f64. The term
/// is `base_color (1 - metallic) (1 - F) / pi` with Schlick's F at the half vector. This shares no code with the
/// shader's polynomial.
fn diffuse_sent_out(base_color: Vec3, metallic: f32, cos_incidence: f64) -> Vec3 {
    let to_light = DVec3::new((1.0 - cos_incidence * cos_incidence).sqrt(), 0.0, cos_incidence);
    let (rings, sectors) = (48, 48);
    let mut schlick = 0.0;
    for ring in 0..rings {
        // Rings of equal share of a cosine-weighted hemisphere.
        let cos = ((f64::from(ring) + 0.5) / f64::from(rings)).sqrt();
        let sin = (1.0 - cos * cos).sqrt();
        for sector in 0..sectors {
            let (s, c) = (2.0 * std::f64::consts::PI * (f64::from(sector) + 0.5)
                / f64::from(sectors))
            .sin_cos();
            let out = DVec3::new(sin * c, sin * s, cos);
            let half_way = (out + to_light).normalize();
            schlick += (1.0 - out.dot(half_way)).powi(5) / f64::from(rings * sectors);
        }
    }
    let f0 = Vec3::splat(0.04).lerp(base_color, metallic);
    base_color * (1.0 - metallic) * (Vec3::ONE - f0) * (1.0 - schlick as f32)
}

/// Diffuse albedo of the surface nearest to a point, for light from the position `light`.
fn albedo(p: Vec3, light: Vec3) -> Vec3 {
    let off = |(axis, at, ..): &(usize, f32, Vec3, f32)| (p[*axis] - at).abs();
    let &(axis, _, color, metallic) =
        SURFACES.iter().min_by(|a, b| off(a).total_cmp(&off(b))).unwrap();
    let to_light = (light - p).normalize();
    diffuse_sent_out(color, metallic, f64::from(to_light[axis].abs()))
}

/// Area of a texel on the plane of view depth 1, square metres.
fn texel_area(map: &Map, size: [u32; 2]) -> f32 {
    let Projection::Perspective { min, max } = map.view.projection else { panic!("perspective") };
    (max - min).element_product() / (size[0] * size[1]) as f32
}

/// The intensity that a texel of the room reflects if its surface is at `position`.
fn reflected(map: &Map, size: [u32; 2], position: Vec3) -> Vec3 {
    let LightShape::Spot { outer_angle, .. } = map.light.shape else { panic!("a spot") };
    let to = position - map.light.position;
    let cos = -to.y / to.length();
    let ramp = (cos - outer_angle.cos()) / (1.0 - outer_angle.cos());
    let solid_angle = texel_area(map, size) * cos.powi(3);
    map.light.intensity * albedo(position, map.light.position) * (ramp * ramp * solid_angle / PI)
}

#[test]
fn a_vpl_emits_what_the_brdf_reflects_diffusely() {
    for cos in [0.05_f32, 0.3, 0.6, 1.0] {
        for (color, metallic) in
            [(Vec3::ONE, 0.0), (Vec3::new(0.8, 0.4, 0.1), 0.0), (Vec3::new(0.9, 0.5, 0.2), 0.4)]
        {
            let expected = diffuse_sent_out(color, metallic, f64::from(cos));
            let found = lambertian_albedo(color, metallic, cos);
            let off = (found - expected).abs().max_element();
            assert!(off < 1e-4, "{cos}, {color}, {metallic}: {found}, not {expected}");
            // Without Fresnel's term it would be at least 4 % brighter.
            assert!(found.x < 0.9601 * color.x * (1.0 - metallic), "{cos}: {found}");
        }
    }
}

#[test]
fn the_brightest_texel_stands_for_its_block() {
    let light = spot(0.9);
    let size = [13, 9];
    for brightest_texel in (0..size[0] * size[1]).step_by(11) {
        let texel = std::cell::Cell::new(0);
        let map = Map::new(size, light, |ray| {
            let bright = texel.replace(texel.get() + 1) == brightest_texel;
            let color = Vec3::splat(if bright { 1.0 } else { 1e-6 }).extend(0.0);
            // The plane is sloped, so depths differ.
            Some((light.position.y / (0.2 * ray.x - ray.y), Vec3::new(-0.2, 1.0, 0.0), color))
        });
        let all = map.lights(VplSettings::default());
        let brightest = all.iter().max_by(|a, b| a.intensity.x.total_cmp(&b.intensity.x)).unwrap();
        // A texel in the corners, outside the cone, is not lit.
        if brightest.intensity.x < 1e-3 * light.intensity.x / (size[0] * size[1]) as f32 {
            continue;
        }
        let one = map.lights(VplSettings { spacing_m: 1e3, ..VplSettings::default() });
        assert_eq!(one.len(), 1);
        assert_eq!(
            (one[0].position, one[0].shape),
            (brightest.position, brightest.shape),
            "texel {brightest_texel}"
        );
    }
}

#[test]
fn choice_conserves_light_and_stays_on_surfaces() {
    for size in [[64, 64], [50, 37]] {
        let light = spot(1.2);
        let map = Map::new(size, light, room(&light));
        let all = map.lights(VplSettings::default());
        for vpl in &all {
            let expected = reflected(&map, size, vpl.position);
            let off = (vpl.intensity - expected).abs().max_element();
            assert!(off < 2e-3 * expected.max_element() + 1e-9, "{vpl:?}, not {expected}");
        }
        let (mut last, texels) = (all.len(), (size[0] * size[1]) as usize);
        // The black wall and texels outside the cone reflect nothing.
        assert!(last > texels / 2 && last < texels * 4 / 5, "{last} of {texels}");
        for spacing_m in [0.5, 1.0, 2.0, 1e3] {
            let lights = map.lights(VplSettings { spacing_m, ..VplSettings::default() });
            let off = (total(&lights) / total(&all) - DVec3::ONE).abs().max_element();
            assert!(off < 1e-4, "{spacing_m}: {off}");
            assert!(lights.len() < last, "{spacing_m}: {} of {last}", lights.len());
            last = lights.len();
            for light in &lights {
                let LightShape::Vpl { normal, .. } = light.shape else { panic!("not a VPL") };
                let off = off_surface(light.position);
                assert!(off < 1e-3, "{spacing_m}: {off} m at {}", light.position);
                let faces = normal.dot(map.light.position - light.position);
                assert!(faces > 0.0 && (normal.length() - 1.0).abs() < 1e-5, "{normal}");
                assert_eq!(light.check(), Ok(()));
            }
        }
        assert_eq!(last, 1);
    }
}

/// Positions of the chosen VPLs, and in `w` the sides of the squares that they stand for.
fn widths(map: &Map, spacing_m: f32) -> Vec<[f32; 4]> {
    let settings = VplSettings { spacing_m, ..VplSettings::default() };
    let mut buffer = VplBuffer::new(&map.gpu, settings).unwrap();
    map.run(&mut buffer, |_| 1.0);
    let count = u64::from(buffer.read_counts(&map.gpu).unwrap().chosen);
    pod_collect_to_vec(&map.gpu.read(buffer.positions(), count * 16).unwrap())
}

/// On a plane, the rays through a texel's four corners meet the corners of the texel's patch.
#[test]
fn a_width_is_the_side_of_the_texels_patch() {
    let light = spot(0.9);
    for slope in [0.0, 0.3] {
        let normal = Vec3::new(-slope, 1.0, 0.0);
        // The plane passes through the point 3 m below the light.
        let depth = |ray: Vec3| -light.position.y / ray.dot(normal);
        let map = Map::new([128, 128], light, |ray| Some((depth(ray), normal, WHITE)));
        let Projection::Perspective { max: reach, .. } = map.view.projection else { panic!() };
        let texel = 2.0 * reach / 128.0;
        let to_world = map.view.world_to_view.inverse();
        let all = widths(&map, 0.0);
        assert!(all.len() > 128 * 128 / 2, "{}", all.len());
        for [x, y, z, width] in all {
            let at = map.view.world_to_view.transform_point3(Vec3::new(x, y, z));
            let low = ((at.truncate() / -at.z + reach) / texel).floor() * texel - reach;
            let meets = |corner: Vec2| {
                let ray = to_world.transform_vector3((low + corner * texel).extend(-1.0));
                ray * depth(ray)
            };
            let corners = [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y].map(meets);
            let diagonals = (corners[2] - corners[0]).cross(corners[3] - corners[1]);
            let area = 0.5 * diagonals.length();
            let off = width * width / area - 1.0;
            assert!(off.abs() < 2e-3, "{slope}: {width} at {x} {z}, not {}", area.sqrt());
        }
    }
}

/// A texel whose shading normal faces away from the light reflects nothing, and its normal is not flipped.
#[test]
fn texels_that_face_away_give_no_vpl() {
    let light = spot(0.9);
    let floor = |ray: Vec3, normal| Some((light.position.y / -ray.y, normal, WHITE));
    // Normals from which the light is just below the horizon.
    let away = |ray: Vec3| {
        let to_light = -ray.normalize();
        let across = to_light.any_orthonormal_vector();
        (across - 0.02 * to_light).normalize()
    };
    let is_turned = |ray: Vec3| ray.x > 0.3 * ray.z;
    let turned = Map::new([50, 37], light, |ray| {
        floor(ray, if is_turned(ray) { away(ray) } else { Vec3::Y })
    });
    let without =
        Map::new([50, 37], light, |ray| if is_turned(ray) { None } else { floor(ray, Vec3::Y) });
    let whole = Map::new([50, 37], light, |ray| floor(ray, Vec3::Y));
    for spacing_m in [0.0, 0.5, 1e3] {
        let settings = VplSettings { spacing_m, ..VplSettings::default() };
        let lights = turned.lights(settings);
        assert!(!lights.is_empty() && lights == without.lights(settings), "{spacing_m}");
        let share = (total(&lights) / total(&whole.lights(settings))).x;
        assert!((0.4..0.6).contains(&share), "{spacing_m}: {share}");
    }
}

/// Blocks are no wider than the spacing, and nearly as wide.
#[test]
fn blocks_are_as_wide_as_the_spacing_allows() {
    let light = spot(0.9);
    let map = Map::new([128, 128], light, |ray| Some((light.position.y / -ray.y, Vec3::Y, WHITE)));
    let spacing_m = 0.3;
    let widths = widths(&map, spacing_m);
    let widths: Vec<f32> = widths.iter().map(|position| position[3]).collect();
    let count = widths.len();
    assert!(widths.iter().all(|w| *w > 0.0 && *w <= spacing_m), "{widths:?}");
    // A block twice as wide would exceed the spacing for most blocks.
    let wide = widths.iter().filter(|w| **w > 0.4 * spacing_m).count();
    assert!(wide * 10 > count * 9, "{wide} of {count}");
    assert!((300..1500).contains(&count), "{count}");
}

/// A spot of intensity I and half angle a lights a white plane. The plane reflects I times the integral of the cone's
/// ramp over solid angle. With the ramp ((cos t - cos a) / (1 - cos a))^2 the integral is 2 pi (1 - cos a) / 3. Fresnel's
/// term leaves 0.96 of it to diffuse reflection, and less than half a per cent less at these angles.
#[test]
fn the_reflected_flux_is_that_of_the_spot() {
    for outer_angle in [0.3, 1.0] {
        let light = spot(outer_angle);
        let plane = |ray: Vec3| Some((light.position.y / -ray.y, Vec3::Y, WHITE));
        // On a sphere around the light, all texels have the same distance and slope.
        let sphere = |ray: Vec3| Some((1.5 / ray.length(), -ray.normalize(), WHITE));
        let hits: [&dyn Fn(Vec3) -> Option<Hit>; 2] = [&plane, &sphere];
        for hit in hits {
            let map = Map::new([128, 128], light, hit);
            // A Lambertian emitter of intensity I along its normal emits pi I.
            let flux = f64::from(PI) * total(&map.lights(VplSettings::default()));
            let share = 2.0 * std::f64::consts::PI * (1.0 - f64::from(outer_angle).cos()) / 3.0;
            let off = flux / (0.96 * light.intensity.as_dvec3() * share) - DVec3::ONE;
            assert!(off.abs().max_element() < 0.01, "{outer_angle}: {off}");
        }
    }
}

#[test]
fn order_is_fixed_and_neighbours_are_near() {
    let light = spot(1.2);
    let map = Map::new([64, 64], light, room(&light));
    let settings = VplSettings { spacing_m: 0.2, ..VplSettings::default() };
    let mut buffer = VplBuffer::new(&map.gpu, settings).unwrap();
    map.run(&mut buffer, |_| 1.0);
    let first = buffer.read(&map.gpu).unwrap();
    map.run(&mut buffer, |_| 1.0);
    assert!(first == buffer.read(&map.gpu).unwrap());
    // Sixteen texels of a row would be about 2.5 m long.
    let spread = |run: &[Light]| {
        let ends = run.iter().fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), light| {
            (low.min(light.position), high.max(light.position))
        });
        ends.0.distance(ends.1)
    };
    let runs: Vec<f32> = first.chunks(16).map(spread).collect();
    let mean = runs.iter().sum::<f32>() / runs.len() as f32;
    assert!(mean < 1.6, "16 neighbours in the buffer are {mean} m apart on average");
    let reversed: Vec<Light> = first.iter().rev().copied().collect();
    assert!(first != reversed);
}

#[test]
fn normals_after_the_last_vpl_are_zero() {
    let light = spot(0.9);
    let map = Map::new([32, 32], light, |ray| Some((light.position.y / -ray.y, Vec3::Y, WHITE)));
    let mut buffer = VplBuffer::new(&map.gpu, VplSettings::default()).unwrap();
    for spacing_m in [0.0, 0.8] {
        buffer.set_settings(VplSettings { spacing_m, ..VplSettings::default() }).unwrap();
        map.run(&mut buffer, |_| 1.0);
        let count = buffer.read_counts(&map.gpu).unwrap().chosen as usize;
        let bytes = map.gpu.read(buffer.normals(), u64::from(buffer.capacity()) * 16).unwrap();
        let normals: Vec<[f32; 4]> = pod_collect_to_vec(&bytes);
        let used = normals.iter().take_while(|normal| **normal == [0.0, 1.0, 0.0, 0.0]).count();
        assert_eq!(used, count, "{spacing_m}");
        assert!(count < normals.len() && normals[count..].iter().all(|normal| *normal == [0.0; 4]));
    }
}
