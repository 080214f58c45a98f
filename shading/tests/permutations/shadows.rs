//! The shaders of shadow maps, and shaders without any.

use assign_cdi::{DeepImages, Directions, Spread};

use super::{Flags, LOOK_UPS, link, link_with, subsets, with_areas};

/// Bindings of the atlas and of the records.
const MAPS: [u32; 2] = [26, 27];

#[test]
fn lighting_with_shadows_reads_the_maps() {
    for flags in with_areas(subsets(&["spots", "specular_reach", "hard_cut"])) {
        let shadowed: Flags = flags.iter().copied().chain(["shadows"]).collect();
        let forward = |flags: &Flags| flags.iter().copied().chain(["forward"]).collect::<Flags>();
        for look_up in LOOK_UPS {
            for (root, with, without) in [
                ("package::deferred", shadowed.clone(), flags.clone()),
                ("package::geometry", forward(&shadowed), forward(&flags)),
            ] {
                let used = link(root, &with, Some(look_up)).used(2);
                assert!(
                    MAPS.iter().all(|binding| used.contains(binding)),
                    "{root} {with:?}: {used:?}"
                );
                let plain = link(root, &without, Some(look_up));
                assert!(!plain.source.contains("shadow"), "{root} {without:?} has code of shadows");
                let rest: Vec<u32> = used.into_iter().filter(|b| !MAPS.contains(b)).collect();
                assert_eq!(rest, plain.used(2), "{root} {with:?}: other bindings");
            }
        }
        for root in ["package::contributions", "package::raster_spheres"] {
            let used = link(root, &shadowed, None).used(2);
            assert!(MAPS.iter().all(|binding| used.contains(binding)), "{root}: {used:?}");
        }
    }
    // Soft filters read the same, in look-ups of surfaces and in the open.
    for (root, flags) in [
        ("package::deferred", ["areas", "area_point", "shadows", "pcss"]),
        ("package::fog_light", ["areas", "area_point", "shadows", "pcss"]),
        ("package::fog_light", ["areas", "area_point", "spots", "shadows"]),
    ] {
        let used = link(root, &Flags::from(flags), Some(LOOK_UPS[0])).used(2);
        assert!(MAPS.iter().all(|binding| used.contains(binding)), "{root} {flags:?}: {used:?}");
    }
    for flags in [&["to_paraboloid"][..], &["to_paraboloid", "mask", "base_color_texture"]] {
        let linked = link("package::geometry", &flags.iter().copied().collect(), None);
        assert!(linked.entry_points.contains("fragment_paraboloid"), "{flags:?}");
    }
    let curved = Flags::from(["areas", "area_point", "shadows", "paraboloids"]);
    assert!(link("package::deferred", &curved, Some(LOOK_UPS[0])).used(2).contains(&MAPS[0]));
    // Suns have maps of their own, in lights' shadows only.
    let sunny = link("package::deferred", &Flags::from(["suns", "shadows"]), Some(LOOK_UPS[0]));
    assert!([10, 26, 27, 30].iter().all(|binding| sunny.used(2).contains(binding)));
    let sunny = link("package::fog_light", &Flags::from(["suns", "shadows"]), Some(LOOK_UPS[0]));
    assert!([10, 26, 27, 30].iter().all(|binding| sunny.used(2).contains(binding)));
    let plain = link("package::deferred", &Flags::from(["suns"]), Some(LOOK_UPS[0]));
    assert!(!plain.source.contains("shadow") && !plain.used(2).contains(&30));
    // The test for bands reads depth, normals and maps, whatever the options of lighting are.
    let used = link("package::shadow_banding", &Flags::new(), None).used(2);
    assert_eq!(used, [0, 2, MAPS[0], MAPS[1], 28, 29]);
}

/// Bindings of the points of lights, and of the deep images.
const RAYS: [u32; 5] = [27, 30, 31, 33, 34];

#[test]
fn lighting_with_rays_reads_deep_images_and_no_maps() {
    let directions = Directions::new(Spread::Squares, 8, 8).unwrap();
    let settings = shading::shadow_images(directions, 64);
    for flags in [Flags::new(), Flags::from(["spots", "areas", "area_point"])] {
        let traced: Flags = flags.iter().copied().chain(["shadows", "shadow_rays"]).collect();
        for root in ["package::deferred", "package::contributions", "package::raster_spheres"] {
            let mount = |shader| DeepImages::mount_at(&settings, shader, (2, 30));
            let look_up = (root == "package::deferred").then_some(LOOK_UPS[1]);
            let used = link_with(root, &traced, look_up, mount).used(2);
            let plain = link(root, &flags, look_up);
            assert!(!plain.source.contains("ray_images"), "{root} {flags:?} has code of rays");
            let (of_rays, rest): (Vec<u32>, Vec<u32>) =
                used.into_iter().partition(|binding| RAYS.contains(binding));
            assert_eq!(of_rays, RAYS, "{root} {flags:?}");
            assert_eq!(rest, plain.used(2), "{root} {flags:?}: other bindings");
        }
    }
}
