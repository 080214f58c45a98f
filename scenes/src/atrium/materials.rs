//! The atrium's materials, from rough to polished.

use glam::{Affine2, Vec2, Vec3, Vec4};

use super::textures::Texture;
use crate::{Material, TextureRef};

/// Indices into [`make`]'s materials.
#[derive(Clone, Copy)]
pub(super) enum Surface {
    /// Ashlar of the outer walls: textured, with normal and roughness maps.
    Ashlar,
    /// Smooth limestone of columns and arches.
    Limestone,
    /// Polished white marble.
    MarbleWhite,
    /// Polished dark marble.
    MarbleDark,
    /// Honed marble of balusters and mouldings.
    MarbleHoned,
    /// Rough fired clay.
    Terracotta,
    /// Oiled wood of the ceilings.
    Wood,
    /// Glossy bronze.
    Bronze,
    /// Dull wrought iron.
    Iron,
    /// Glazed ceramic.
    Glaze,
    /// Still water.
    Water,
    /// Lantern glass.
    Glow,
    /// Four cloths of different colours.
    Crimson,
    Blue,
    Green,
    Gold,
}

fn plain(name: &str, color: [f32; 3], roughness: f32, metallic: f32) -> Material {
    Material {
        name: name.into(),
        base_color: Vec3::from(color).extend(1.0),
        metallic,
        roughness,
        ..Material::default()
    }
}

/// A texture that repeats every `metres`.
fn texture(texture: Texture, metres: f32) -> Option<TextureRef> {
    Some(TextureRef {
        uv_transform: Affine2::from_scale(Vec2::splat(1.0 / metres)),
        ..TextureRef::new(texture as u32)
    })
}

/// All materials, in the order of [`Surface`].
pub(super) fn make() -> Vec<Material> {
    let marble = |name, image, roughness, tint: f32, metres| Material {
        base_color: Vec4::new(tint, tint, tint, 1.0),
        base_color_texture: texture(image, metres),
        ..plain(name, [1.0; 3], roughness, 0.0)
    };
    let cloth = |name, color| Material {
        double_sided: true,
        normal_texture: texture(Texture::ClothNormal, 0.25),
        ..plain(name, color, 0.92, 0.0)
    };
    vec![
        Material {
            base_color_texture: texture(Texture::StoneColor, 1.6),
            metallic_roughness_texture: texture(Texture::StoneRoughness, 1.6),
            normal_texture: texture(Texture::StoneNormal, 1.6),
            ..plain("ashlar", [1.0; 3], 1.0, 0.0)
        },
        plain("limestone", [0.62, 0.54, 0.43], 0.75, 0.0),
        marble("marble white, polished", Texture::MarbleWhite, 0.12, 1.0, 2.4),
        marble("marble dark, polished", Texture::MarbleDark, 0.08, 1.0, 2.4),
        marble("marble, honed", Texture::MarbleWhite, 0.38, 0.85, 1.2),
        plain("terracotta", [0.48, 0.19, 0.10], 0.88, 0.0),
        plain("wood", [0.20, 0.105, 0.05], 0.5, 0.0),
        plain("bronze", [0.72, 0.45, 0.20], 0.16, 1.0),
        plain("iron", [0.20, 0.19, 0.18], 0.55, 1.0),
        plain("glaze", [0.05, 0.16, 0.32], 0.1, 0.0),
        plain("water", [0.02, 0.06, 0.07], 0.03, 0.0),
        Material {
            emissive: Vec3::new(6.0, 3.6, 1.5),
            ..plain("lantern glass", [0.9, 0.7, 0.45], 0.4, 0.0)
        },
        cloth("cloth crimson", [0.42, 0.02, 0.03]),
        cloth("cloth blue", [0.03, 0.07, 0.34]),
        cloth("cloth green", [0.03, 0.20, 0.06]),
        cloth("cloth gold", [0.60, 0.36, 0.04]),
    ]
}
