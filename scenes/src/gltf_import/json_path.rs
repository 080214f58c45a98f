//! JSON paths in the file's own names.
//!
//! The parser uses names of its own: `extensions.khrLightsPunctual.lights[3]`. A reader who
//! searches the file for that name finds nothing.

/// Extensions by the parser's name and by the file's. `specular`, `volume` and others are also
/// fields of materials, so a name means an extension only directly after `extensions`.
const NAMES: &[(&str, &str)] = &[
    ("khrLightsPunctual", "KHR_lights_punctual"),
    ("khrMaterialsVariants", "KHR_materials_variants"),
    ("pbrSpecularGlossiness", "KHR_materials_pbrSpecularGlossiness"),
    ("unlit", "KHR_materials_unlit"),
    ("transmission", "KHR_materials_transmission"),
    ("volume", "KHR_materials_volume"),
    ("specular", "KHR_materials_specular"),
    ("ior", "KHR_materials_ior"),
    ("emissiveStrength", "KHR_materials_emissive_strength"),
    ("textureTransform", "KHR_texture_transform"),
];

/// The path with the file's names of extensions.
pub(super) fn as_in_file(path: &str) -> String {
    let mut parts: Vec<&str> = Vec::new();
    for part in path.split('.') {
        let known = NAMES.iter().find(|(parsers, _)| *parsers == part);
        let is_extension = parts.last() == Some(&"extensions");
        parts.push(known.filter(|_| is_extension).map_or(part, |(_, files)| files));
    }
    parts.join(".")
}

#[cfg(test)]
mod tests {
    use super::as_in_file;

    #[test]
    fn extensions_are_named_as_in_the_file() {
        for (parsers, files) in [
            (
                "extensions.khrLightsPunctual.lights[3].type",
                "extensions.KHR_lights_punctual.lights[3].type",
            ),
            (
                "nodes[1].extensions.khrLightsPunctual.light",
                "nodes[1].extensions.KHR_lights_punctual.light",
            ),
            (
                "materials[0].extensions.specular.specularTexture.index",
                "materials[0].extensions.KHR_materials_specular.specularTexture.index",
            ),
            (
                "materials[0].emissiveTexture.extensions.textureTransform",
                "materials[0].emissiveTexture.extensions.KHR_texture_transform",
            ),
            ("materials[0].specular", "materials[0].specular"),
            ("buffers[0].uri", "buffers[0].uri"),
            ("", ""),
        ] {
            assert_eq!(as_in_file(parsers), files);
        }
    }
}
