//! The shaders of layers: transparent surfaces, particles, fog, and the checks of their lists.

use super::{
    Flags, LOOK_UPS, check_compute, check_geometry, link, shaded_slots, subsets, with_areas,
    with_suns,
};

/// Which bindings of lighting a layer reads: it reads its numbers only for random ranges.
fn layer_inputs(flags: &Flags) -> [(u32, bool); 3] {
    [(6, "stochastic"), (10, "suns"), (18, "fogged")]
        .map(|(binding, flag)| (binding, flags.contains(flag)))
}

#[test]
fn transparent_surfaces() {
    // Materials are those of the forward pass.
    let more = ["emissive", "spots", "fogged", "base_color_texture"];
    for look_up in LOOK_UPS {
        for mut flags in with_suns(subsets(&more)) {
            flags.insert("sheets");
            check_geometry(&flags, Some(look_up), Some("fragment_sheet"), shaded_slots(&flags));
        }
    }
    for mut flags in subsets(&["emissive", "normal_texture"]) {
        flags.extend(["sheets", "captures"]);
        check_geometry(&flags, None, Some("fragment_sheet"), &[0, 1, 2]);
    }
    let fogged = link("package::geometry", &["sheets", "fogged"].into(), Some(LOOK_UPS[0]));
    assert!(fogged.used(2).contains(&18) && fogged.used(2).contains(&17));
    let clear = link("package::geometry", &["sheets"].into(), Some(LOOK_UPS[0]));
    assert!(!clear.source.contains("fog"), "no fog in a shader without fog");
}

#[test]
fn particles_and_fog() {
    let mut sets = with_areas(subsets(&["spots"]));
    sets.extend(subsets(&["fogged", "suns", "stochastic"]));
    for look_up in LOOK_UPS {
        for flags in sets.clone() {
            let check = |root: &str, always: &[u32]| {
                let linked = link(root, &flags, Some(look_up));
                let fogged = flags.contains("fogged") && root == "package::particles";
                let inputs = layer_inputs(&flags)
                    .into_iter()
                    .filter(|&(binding, is_read)| is_read && (binding != 18 || fogged));
                let mut expected: Vec<u32> = inputs.map(|(binding, _)| binding).collect();
                expected.extend(always);
                expected.extend(fogged.then_some(17));
                expected.sort_unstable();
                assert_eq!(linked.used(2), expected, "{}", linked.what);
                assert_eq!(linked.used(1), look_up.2, "{}", linked.what);
            };
            check("package::particles", &[19]);
            check("package::fog_light", &[17, 20]);
        }
    }
    let captures = ["captures"].into();
    link("package::particles", &captures, None).check_pixels(&[19, 22, 23, 25], &[]);
    link("package::fog_light", &captures, None).check_pixels(&[17, 22, 23], &[]);
    link("package::fog_sum", &Flags::new(), None).check_pixels(&[17, 19, 20], &[]);
    link("package::fog_apply", &["fogged"].into(), None).check_pixels(&[0, 17, 18], &[]);
}

/// A scene without layers compiles none of their code.
#[test]
fn without_layers_no_shader_has_their_code() {
    for (root, flags) in
        [("package::geometry", Flags::from(["forward"])), ("package::deferred", Flags::new())]
    {
        let source = link(root, &flags, Some(LOOK_UPS[0])).source;
        for word in ["fog", "particle", "capture", "scattered", "fragment_sheet"] {
            assert!(!source.contains(word), "{word} in {root} without layers");
        }
    }
}

#[test]
fn captured_samples() {
    for look_up in LOOK_UPS {
        let group_only: Vec<u32> =
            look_up.2.iter().copied().filter(|&binding| binding > 1).collect();
        check_compute("probe", &["captured"].into(), look_up, &group_only, &[8, 9, 24]);
        let linked = link("package::dump", &["captured"].into(), Some(look_up));
        assert_eq!((linked.used(1), linked.used(2)), (look_up.2.to_vec(), vec![8, 9, 10, 24]));
    }
}
