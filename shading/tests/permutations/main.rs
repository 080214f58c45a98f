//! Links and validates every permutation of the pipeline's shaders, without a GPU.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod layers;
mod linked;
mod shadows;

use std::collections::BTreeSet;

use assign::{LightReader, Storage, StrategyWesl};
use linked::{link, link_with};

/// A strategy's look-up: name, WESL, bindings.
type LookUp = (&'static str, StrategyWesl<'static>, &'static [u32]);

const NO_CULLING: StrategyWesl<'static> = StrategyWesl {
    main: include_str!("../../../assign/src/shaders/everything.wesl"),
    imports: &[],
    flags: &[],
    reader: LightReader::Stored(Storage::Lists),
};

const LOOK_UPS: [LookUp; 2] =
    [("no culling", NO_CULLING, &[0, 1]), ("DC-I", assign_clustered::IMPLICIT_WESL, &[0, 1, 4])];

/// In the order of their bindings: slot i has bindings 2i and 2i + 1.
const TEXTURES: [&str; 4] =
    ["base_color_texture", "metallic_roughness_texture", "normal_texture", "emissive_texture"];

type Flags = BTreeSet<&'static str>;

/// Every subset of the flags of a material and of `more`. The flag `pass` is always on.
fn material_flags(pass: Option<&'static str>, more: &[&'static str]) -> Vec<Flags> {
    let flags = [&TEXTURES[..], &["uv_transforms"], more].concat();
    subsets(&flags).into_iter().map(|set| set.into_iter().chain(pass).collect()).collect()
}

fn subsets(flags: &[&'static str]) -> Vec<Flags> {
    let chosen = |bits: usize| (0..flags.len()).filter(move |i| bits >> i & 1 == 1);
    (0..1 << flags.len()).map(|bits| chosen(bits).map(|i| flags[i]).collect()).collect()
}

/// The flags of each model of area lights, each set once.
fn area_models() -> Vec<&'static [&'static str]> {
    let mut sets: Vec<&'static [&'static str]> = Vec::new();
    for model in shading::AreaModel::ALL {
        if !sets.contains(&model.flags()) {
            sets.push(model.flags());
        }
    }
    sets
}

/// Each set, and the smallest and the largest with suns too. No other flag shares a line with those
/// of suns.
fn with_suns(mut sets: Vec<Flags>) -> Vec<Flags> {
    let ends = [sets.iter().min_by_key(|set| set.len()), sets.iter().max_by_key(|set| set.len())];
    let sunny = |set: &Flags| set.iter().copied().chain(["suns"]).collect();
    let sunny: Vec<Flags> = ends.into_iter().flatten().map(sunny).collect();
    sets.extend(sunny);
    sets
}

/// Each set, without area lights and with those of each model.
fn with_areas(sets: Vec<Flags>) -> Vec<Flags> {
    let models = area_models();
    let areas = |set: &Flags, model: &[&'static str]| {
        set.iter().copied().chain(["areas"]).chain(model.iter().copied()).collect()
    };
    let with = |set: &Flags| models.iter().map(|model| areas(set, model)).collect::<Vec<Flags>>();
    sets.iter().flat_map(|set| with(set).into_iter().chain([set.clone()])).collect()
}

/// Links a pass over the triangles. Checks its entry points, and that it reads only the textures of
/// `slots` that its flags name and the lists of `look_up` in the two groups.
fn check_geometry(flags: &Flags, look_up: Option<LookUp>, fragment: Option<&str>, slots: &[u32]) {
    let linked = link("package::geometry", flags, look_up);
    let entry_points = ["vertex_depth", "vertex_surface"].into_iter().chain(fragment);
    assert_eq!(linked.entry_points, entry_points.map(str::to_owned).collect(), "{flags:?}");
    let textures = slots
        .iter()
        .filter(|&&slot| flags.contains(TEXTURES[slot as usize]))
        .flat_map(|slot| [(3, 2 * slot), (3, 2 * slot + 1)]);
    let lists = look_up.map_or(&[][..], |(_, _, bindings)| bindings);
    let expected: BTreeSet<_> = textures.chain(lists.iter().map(|&binding| (1, binding))).collect();
    let of_lists_and_textures = |&(group, _): &(u32, u32)| group == 1 || group == 3;
    let read: BTreeSet<_> = linked.bindings.into_iter().filter(of_lists_and_textures).collect();
    assert_eq!(read, expected, "{flags:?}");
}

#[test]
fn depth() {
    for flags in material_flags(None, &["mask"]) {
        let mask = flags.contains("mask");
        let slots: &[u32] = if mask { &[0] } else { &[] };
        check_geometry(&flags, None, mask.then_some("fragment_mask"), slots);
    }
}

#[test]
fn model_ids() {
    for flags in material_flags(Some("write_model_ids"), &[]) {
        check_geometry(&flags, None, Some("fragment_model_ids"), &[]);
    }
}

/// The inputs of lighting that light volumes read: only the models that draw samples read its numbers.
fn sphere_inputs(flags: &Flags) -> [(u32, bool); 3] {
    [(6, "area_monte_carlo"), (7, "area_ltc_table"), (10, "suns")]
        .map(|(binding, flag)| (binding, flags.contains(flag)))
}

#[test]
fn raster_spheres() {
    for flags in with_areas(subsets(&["emissive", "spots", "suns"])) {
        let linked = link("package::raster_spheres", &flags, None);
        let emissive = flags.contains("emissive");
        let has_suns = flags.contains("suns");
        linked.check_pixels(&[0, 1, 2], &[&[(3, emissive)], &sphere_inputs(&flags)[..]].concat());
        let entry_points = if emissive || has_suns { 4 } else { 2 };
        assert_eq!(linked.entry_points.len(), entry_points, "{flags:?}");
    }
}

/// The textures that shading reads.
fn shaded_slots(flags: &Flags) -> &'static [u32] {
    if flags.contains("emissive") { &[0, 1, 2, 3] } else { &[0, 1, 2] }
}

#[test]
fn gbuffer() {
    for flags in material_flags(Some("gbuffer"), &["emissive", "gbuffer_ids"]) {
        check_geometry(&flags, None, Some("fragment_gbuffer"), shaded_slots(&flags));
    }
}

#[test]
fn clay() {
    for flags in material_flags(Some("clay"), &[]) {
        check_geometry(&flags, None, Some("fragment_clay"), &[]);
    }
}

#[test]
fn forward() {
    for look_up in LOOK_UPS {
        let sets =
            with_suns(material_flags(Some("forward"), &["emissive", "spots", "forward_mask"]));
        // Area lights read no texture, so one material with all textures is enough.
        let areas =
            with_areas(sets.iter().max_by_key(|set| set.len()).into_iter().cloned().collect());
        for flags in sets.into_iter().chain(areas) {
            let slots = shaded_slots(&flags);
            check_geometry(&flags, Some(look_up), Some("fragment_forward"), slots);
        }
    }
}

/// Links a pass with one compute entry point. Checks that it reads `lists` of the look-up's group
/// and `images` of group 2.
fn check_compute(root: &str, flags: &Flags, look_up: LookUp, lists: &[u32], images: &[u32]) {
    let linked = link(&format!("package::{root}"), flags, Some(look_up));
    let entry_point = match root {
        "deferred" => "shade",
        "operations" => "count_operations",
        "pixel_group" => "find_groups",
        _ => root,
    };
    assert_eq!(linked.entry_points, [entry_point.to_owned()].into(), "{root} {flags:?}");
    assert_eq!(linked.used(1), lists, "{root} {flags:?} {}", look_up.0);
    let mut images = images.to_vec();
    images.extend(flags.contains("area_ltc_table").then_some(7));
    images.extend((root == "deferred" && flags.contains("suns")).then_some(10));
    images.sort_unstable();
    assert_eq!(linked.used(2), images, "{root} {flags:?} {}", look_up.0);
}

#[test]
fn deferred() {
    for look_up in LOOK_UPS {
        let flags = ["emissive", "spots", "model_ids", "hard_cut", "compensation"];
        for flags in with_suns(with_areas(subsets(&flags))) {
            let mut images = vec![0, 1, 2, 4, 6];
            images.extend(flags.contains("emissive").then_some(3));
            images.extend(flags.contains("model_ids").then_some(5));
            images.sort_unstable();
            check_compute("deferred", &flags, look_up, look_up.2, &images);
        }
        for flags in [
            Flags::from(["stochastic"]),
            Flags::from(["stochastic", "spots", "hard_cut"]),
            Flags::from(["no_cut"]),
            Flags::from(["stochastic", "spots", "no_cut"]),
            Flags::from(["specular_reach"]),
            Flags::from(["specular_reach", "spots", "hard_cut"]),
        ] {
            check_compute("deferred", &flags, look_up, look_up.2, &[0, 1, 2, 4, 6]);
        }
    }
}

#[test]
fn operations() {
    for look_up in LOOK_UPS {
        for flags in with_suns(with_areas(subsets(&["spots", "model_ids"]))) {
            let mut images = vec![0, 1, 2, 6, 8, 9];
            images.extend(flags.contains("model_ids").then_some(5));
            images.sort_unstable();
            check_compute("operations", &flags, look_up, look_up.2, &images);
        }
        let flags = Flags::from(["stochastic", "spots"]);
        check_compute("operations", &flags, look_up, look_up.2, &[0, 1, 2, 6, 8, 9]);
    }
}

#[test]
fn probe() {
    for look_up in LOOK_UPS {
        // It computes the group and reads no list.
        let group_only: Vec<u32> =
            look_up.2.iter().copied().filter(|&binding| binding > 1).collect();
        check_compute("probe", &Flags::new(), look_up, &group_only, &[0, 2, 8, 9]);
        let model_ids = ["model_ids"].into();
        check_compute("probe", &model_ids, look_up, &group_only, &[0, 2, 5, 8, 9]);
    }
}

#[test]
fn pixel_group() {
    for look_up in LOOK_UPS {
        // It computes the group and reads no list.
        let group_only: Vec<u32> =
            look_up.2.iter().copied().filter(|&binding| binding > 1).collect();
        check_compute("pixel_group", &Flags::new(), look_up, &group_only, &[0, 2, 8, 9]);
        let model_ids = ["model_ids"].into();
        check_compute("pixel_group", &model_ids, look_up, &group_only, &[0, 2, 5, 8, 9]);
    }
}

#[test]
fn contributions() {
    let always = [0, 1, 2, 6, 8, 9, 12, 13];
    for flags in with_suns(with_areas(subsets(&["emissive", "dielectrics", "spots", "hard_cut"]))) {
        let linked = link("package::contributions", &flags, None);
        assert_eq!(linked.entry_points, ["evaluate".to_owned()].into(), "{flags:?}");
        let more = [
            (3, flags.contains("emissive")),
            (7, flags.contains("area_ltc_table")),
            (10, flags.contains("suns")),
            (11, flags.contains("dielectrics")),
        ];
        linked.check_pixels(&always, &more);
    }
}

#[test]
fn surfaces() {
    for flags in subsets(&["emissive"]) {
        let linked = link("package::surfaces", &flags, None);
        let emissive = flags.contains("emissive");
        linked.check_pixels(&[0, 1, 2, 12, 13, 14], &[(3, emissive), (15, emissive)]);
        assert_eq!(linked.entry_points, ["surfaces".to_owned()].into(), "{flags:?}");
    }
}

/// Flags that bind nothing change the module as well.
#[test]
fn flags_change_the_shader() {
    let source = |flags: &[&'static str]| {
        let flags = flags.iter().copied().collect();
        link("package::geometry", &flags, Some(LOOK_UPS[0]))
    };
    let forward = source(&["forward", "base_color_texture"]);
    let moved = source(&["forward", "base_color_texture", "uv_transforms"]);
    assert_ne!(moved.source, forward.source);
    for flag in ["emissive", "forward_mask"] {
        assert_ne!(source(&["forward", flag]).source, source(&["forward"]).source, "{flag}");
    }
    assert_ne!(source(&["gbuffer", "gbuffer_ids"]).source, source(&["gbuffer"]).source);
    let shapes = (0, 3);
    let spots = source(&["forward", "base_color_texture", "spots"]);
    assert!(spots.bindings.contains(&shapes) && !forward.bindings.contains(&shapes));
}

/// Without suns, a scene compiles none of their code and binds nothing for them.
#[test]
fn without_suns_the_shader_has_no_sun_code() {
    let source = |flags: &[&'static str]| {
        let flags = flags.iter().copied().collect();
        link("package::deferred", &flags, Some(LOOK_UPS[0]))
    };
    let (with, without) = (source(&["suns"]), source(&[]));
    assert!(with.source.contains("sun_light") && with.bindings.contains(&(2, 10)));
    assert!(!without.source.contains("sun") && !without.bindings.contains(&(2, 10)));
}

/// Without the option, nothing of the reach of specular terms is compiled.
#[test]
fn without_a_specular_reach_the_shader_has_none() {
    let has_reach = |flags: &[&'static str]| {
        let flags = flags.iter().copied().collect();
        link("package::deferred", &flags, Some(LOOK_UPS[0])).source.contains("lobe_peak")
    };
    assert!(has_reach(&["spots", "specular_reach"]) && !has_reach(&["spots"]));
}

/// Without area lights, a scene compiles none of their code and binds nothing for them, whatever
/// the model.
#[test]
fn without_area_lights_no_model_changes_the_shader() {
    let source = |flags: &[&'static str]| {
        let flags = flags.iter().copied().collect();
        link("package::deferred", &flags, Some(LOOK_UPS[0]))
    };
    let plain = source(&["spots"]);
    assert!(!plain.bindings.contains(&(2, 7)), "no table");
    for word in ["area_lobes", "Emitter", "ltc_"] {
        assert!(!plain.source.contains(word), "{word} in a shader without area lights");
    }
    let mut sources: Vec<String> = Vec::new();
    for model in area_models() {
        let with = source(&[&["spots", "areas"], model].concat());
        assert!(with.source.contains("Emitter"), "{model:?}");
        assert!(!sources.contains(&with.source), "{model:?} compiles as another does");
        for more in [&["curved"][..], &["area_lod"], &["curved", "area_lod"]] {
            let more = source(&[&["spots", "areas"], more, model].concat());
            assert_eq!(more.bindings.contains(&(2, 7)), with.bindings.contains(&(2, 7)));
            assert!(!sources.contains(&more.source), "{model:?} compiles as another does");
            sources.push(more.source);
        }
        sources.push(with.source);
    }
}

/// Flags of materials that few scenes have, together with the flags that they affect.
#[test]
fn flags_of_rare_materials() {
    let base = ["base_color_texture", "emissive"];
    for rare in subsets(&["vertex_colors", "unlit", "dielectrics"]) {
        let with = |more: &[&'static str]| -> Flags {
            rare.iter().chain(&base).chain(more).copied().collect()
        };
        check_geometry(&with(&["gbuffer", "gbuffer_ids"]), None, Some("fragment_gbuffer"), &[0]);
        check_geometry(&with(&["mask"]), None, Some("fragment_mask"), &[0]);
        check_geometry(&with(&["forward"]), Some(LOOK_UPS[0]), Some("fragment_forward"), &[0]);
        // Fields keep their names when modules are linked.
        let source = link("package::geometry", &with(&["gbuffer"]), None).source;
        assert_eq!(source.contains(".dielectric"), rare.contains("dielectrics"), "{rare:?}");
        assert_eq!(source.contains(".color"), rare.contains("vertex_colors"), "{rare:?}");
    }
    for flags in with_suns(with_areas(vec![["dielectrics"].into()])) {
        check_compute("deferred", &flags, LOOK_UPS[0], LOOK_UPS[0].2, &[0, 1, 2, 4, 6, 11]);
        let spheres = link("package::raster_spheres", &flags, None);
        spheres.check_pixels(&[0, 1, 2, 11], &sphere_inputs(&flags));
    }
    let surfaces = link("package::surfaces", &["dielectrics"].into(), None);
    surfaces.check_pixels(&[0, 1, 2, 11, 12, 13, 14, 16], &[]);
}
