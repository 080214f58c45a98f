use assign::Emitter;
use glam::{Vec3, Vec4Swizzles};

use super::*;

fn model(maps: u32, px: u32, taps: u32) -> ShadowModel {
    ShadowModel::Maps { maps, px, taps }
}

fn square(position: Vec3) -> Light {
    Light::area(Emitter::rectangle(Vec3::X, Vec3::Z), position, 10.0, Vec3::ONE)
}

fn spot(outer_angle: f32) -> Light {
    let shape = LightShape::Spot { direction: Vec3::NEG_Y, inner_angle: 0.1, outer_angle };
    Light { shape, ..Light::point(Vec3::Y, 5.0, Vec3::ONE) }
}

/// One of each number of faces.
fn lights() -> Vec<Light> {
    let both = Light::area(
        Emitter::rectangle(Vec3::X, Vec3::Y).two_sided(),
        Vec3::new(1.0, 2.0, 3.0),
        4.0,
        Vec3::ONE,
    );
    let vpl = Light::vpl(Vec3::Z, Vec3::X, 3.0, Vec3::ONE);
    vec![square(Vec3::ZERO), both, spot(0.5), spot(1.3), spot(3.0), vpl]
}

#[test]
fn faces_lie_in_the_atlas_and_share_no_texel() {
    for (maps, px, taps) in [(1, 32, 25), (4, 64, 1), (25, 32, 9)] {
        let plan =
            Plan::new(&lights(), SunnyScene::default(), model(maps, px, taps), 4096).unwrap();
        assert_eq!(plan.maps, maps);
        assert_eq!(plan.map_count, 2 * maps + 4);
        // 5 and 6 faces of the area lights, 1, 5 and 6 of the spots, 5 of the virtual point light.
        assert_eq!(plan.faces.len() as u32, 11 * maps + 17);
        let mut taken = vec![false; (plan.size[0] * plan.size[1]) as usize];
        for face in &plan.faces {
            for y in face.origin[1]..face.origin[1] + face.size[1] {
                for x in face.origin[0]..face.origin[0] + face.size[0] {
                    assert!(x < plan.size[0] && y < plan.size[1], "{face:?}");
                    let texel = &mut taken[(y * plan.size[0] + x) as usize];
                    assert!(!*texel, "two faces at {x}, {y}");
                    *texel = true;
                }
            }
        }
        // A square per face, or per two halves.
        let squares = maps * (3 + 6) + 1 + 3 + 6 + 3;
        let used = taken.iter().filter(|used| **used).count() as u32;
        assert_eq!(used, squares * px * px);
    }
}

/// The texel of a face at which a point appears, and its clip depth.
fn seen(face: &Face, point: Vec3) -> Option<(f32, f32, f32)> {
    let clip = face.view_to_clip * (face.world_to_view * point.extend(1.0));
    let ndc = clip.xyz() / clip.w;
    let is_inside = clip.w > 0.0 && ndc.x.abs() <= 1.0 && ndc.y.abs() <= 1.0;
    is_inside.then(|| {
        let [width, height] = face.size.map(|px| px as f32);
        ((0.5 + 0.5 * ndc.x) * width, (0.5 - 0.5 * ndc.y) * height, ndc.z)
    })
}

#[test]
fn the_faces_of_a_map_see_every_point_that_the_light_reaches() {
    let plan =
        Plan::new(&[square(Vec3::Y * 3.0)], SunnyScene::default(), model(1, 64, 1), 4096).unwrap();
    let point = Plan::new(
        &[Light::point(Vec3::ONE, 8.0, Vec3::ONE)],
        SunnyScene::default(),
        model(1, 64, 1),
        4096,
    );
    let point = point.unwrap();
    for ix in 0..2000 {
        let f = ix as f32;
        let direction = Vec3::new((f * 1.7).sin(), (f * 0.61).cos(), (f * 2.3).sin()).normalize();
        assert!(point.faces.iter().any(|face| seen(face, Vec3::ONE + direction).is_some()));
        // The emitter faces down: half axes x and z turn to -y.
        let is_seen = |face| seen(face, Vec3::Y * 3.0 + direction).is_some();
        assert!(direction.y > -1e-3 || plan.faces.iter().any(is_seen), "{direction}");
    }
}

#[test]
fn depth_is_near_over_distance_and_faces_have_a_guard() {
    let light = Light::point(Vec3::new(1.0, 2.0, 3.0), 8.0, Vec3::ONE);
    let plan = Plan::new(&[light], SunnyScene::default(), model(1, 64, 9), 4096).unwrap();
    let forward = plan.faces[0];
    let (x, y, depth) = seen(&forward, light.position + Vec3::new(0.0, 0.0, 2.0)).unwrap();
    assert!((x - 32.0).abs() < 1e-4 && (y - 32.0).abs() < 1e-4, "{x} {y}");
    let near = 8.0 / (1 << 20) as f32;
    assert!((depth * 2.0 / near - 1.0).abs() < 1e-6, "{depth}");
    // An eighth turn lies 6 texels inside: two per texel of the filter's side.
    let (x, y, _) = seen(&forward, light.position + Vec3::new(2.0, -2.0, 2.0)).unwrap();
    assert!((x - 58.0).abs() < 1e-3 && (y - 6.0).abs() < 1e-3, "{x} {y}");
}

#[test]
fn an_atlas_that_is_too_small_gets_fewer_maps_or_is_refused() {
    let lights = vec![square(Vec3::ZERO); 4];
    // 16 x 16 squares. Four lights take 12 of them per map.
    let plan = Plan::new(&lights, SunnyScene::default(), model(81, 64, 1), 1024).unwrap();
    assert_eq!((plan.maps, plan.map_count), (9, 36));
    assert!(plan.size[0] <= 1024 && plan.size[1] <= 1024);
    let whole = Plan::new(&lights, SunnyScene::default(), model(81, 64, 1), 2048).unwrap();
    assert_eq!(whole.maps, 81);
    // 12 squares do not fit 3 x 3.
    let error =
        Plan::new(&lights, SunnyScene::default(), model(4, 64, 1), 192).unwrap_err().to_string();
    assert!(
        error.starts_with("shadow model is maps:4,64 for 4 lights: it must be one whose maps fit"),
        "{error}"
    );
    assert!(Plan::new(&lights, SunnyScene::default(), model(4, 512, 1), 256).is_err());
    assert!(Plan::new(&lights, SunnyScene::default(), ShadowModel::None, 256).is_err());
    assert!(Plan::new(&lights, SunnyScene::default(), model(5, 64, 1), 4096).is_err());
    let none = Plan::new(&[], SunnyScene::default(), model(4, 64, 1), 4096).unwrap();
    assert_eq!((none.map_count, none.size), (0, [64, 64]));
}

#[test]
fn rectangles_that_frames_subdivide_get_places_and_others_a_fixed_number() {
    let model = |most| ShadowModel::Adaptive { px: 64, down: 8, most };
    let corners = [Vec3::ZERO, Vec3::X, Vec3::new(1.0, 1.0, 0.0), Vec3::new(0.0, 2.0, 0.0)];
    let (polygon, middle) = Emitter::polygon(&corners).unwrap();
    let mut lights = vec![square(Vec3::ZERO); 2];
    lights.push(Light::area(polygon, middle, 10.0, Vec3::ONE));
    lights.push(spot(0.5));
    lights.push(square(Vec3::ONE));
    let plan = Plan::new(&lights, SunnyScene::default(), model(24), 4096).unwrap();
    assert_eq!((plan.maps, plan.map_count), (24, 3 * 24 + 9 + 1));
    let sites: Vec<usize> = plan.sites.iter().map(|site| site.light).collect();
    assert_eq!(sites, [0, 1, 4]);
    for site in &plan.sites {
        assert_eq!(plan.records[3 * site.light + 1][3] as usize, site.first_map);
        let address = plan.records[site.first_map + 1][0];
        let [x, y] = plan.faces[site.first_face].origin;
        assert_eq!(address, x | y << 16);
        let eye = DVec3::new(1.0, 2.0, 3.0);
        let moved =
            plan.faces[site.first_face + 4].world_to_view * site.world_to_view(4, eye).inverse();
        let offset = moved.transform_point3(Vec3::ZERO).length();
        // A place waits at a corner of its rectangle.
        let corner = lights[site.light].position + Vec3::X + Vec3::Z;
        let from = corner.distance(eye.as_vec3());
        assert!((offset - from).abs() < 1e-4, "{offset} {from}");
    }
    // 16 x 16 squares: three lights take 9 of them for each map, the polygon 27, and the spot 1.
    let plan = Plan::new(&lights, SunnyScene::default(), model(289), 1024).unwrap();
    assert_eq!((plan.maps, plan.map_count), (24, 3 * 24 + 9 + 1));
    assert!(plan.size[0] <= 1024 && plan.size[1] <= 1024);
    let error = Plan::new(&lights, SunnyScene::default(), model(289), 320).unwrap_err().to_string();
    assert!(
        error.contains("4 for each area light and one for each other light take 49 squares"),
        "{error}"
    );
}
