//! The town's materials.

use glam::{Affine2, Vec2, Vec3};

use super::textures::Texture;
use crate::{Material, TextureRef};

/// Indices into [`make`]'s materials.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Surface {
    /// Plaster of the houses, in four colours.
    Cream,
    Ochre,
    Rose,
    Grey,
    /// Brick of houses and chimneys.
    Brick,
    /// Squared stone of plinths, sills, church and walls.
    Stone,
    /// Dark beams.
    Timber,
    /// White window frames.
    White,
    /// Shutters and doors, in three colours.
    Green,
    Blue,
    Oxblood,
    /// Roof tiles, in two colours, and slates.
    TileRed,
    TileBrown,
    Slate,
    /// Window panes.
    Glass,
    /// Lamps, railings, vanes.
    Iron,
    /// Glowing glass of the lamps.
    Glow,
    /// Setts of the streets, in two colours.
    Sett,
    SettDark,
    /// Flagstones of pavements and the square.
    Flag,
    /// Ground of the town.
    Earth,
    /// Ground of gardens and meadows.
    Grass,
    /// Bark and leaves.
    Bark,
    Leaf,
    LeafDark,
    /// Flowers and awnings.
    Petal,
    Awning,
    /// Still water.
    Water,
    /// Gilded metal.
    Gold,
}

fn plain(name: &str, color: [f32; 3], roughness: f32) -> Material {
    Material {
        name: name.into(),
        base_color: Vec3::from(color).extend(1.0),
        metallic: 0.0,
        roughness,
        ..Material::default()
    }
}

/// All materials, in the order of [`Surface`].
pub(super) fn make() -> Vec<Material> {
    let texture = |texture: Texture, metres: f32| {
        Some(TextureRef {
            uv_transform: Affine2::from_scale(Vec2::splat(1.0 / metres)),
            ..TextureRef::new(texture as u32)
        })
    };
    let grained = |name, color, roughness, image, metres| Material {
        base_color_texture: texture(image, metres),
        ..plain(name, color, roughness)
    };
    let plaster = |name, color| grained(name, color, 0.9, Texture::Grain, 3.0);
    let leaf = |name, color| Material { double_sided: true, ..plain(name, color, 0.75) };
    let metal =
        |name, color, roughness| Material { metallic: 1.0, ..plain(name, color, roughness) };
    vec![
        plaster("plaster cream", [0.85, 0.76, 0.58]),
        plaster("plaster ochre", [0.80, 0.56, 0.26]),
        plaster("plaster rose", [0.76, 0.46, 0.36]),
        plaster("plaster grey", [0.68, 0.70, 0.69]),
        Material {
            base_color_texture: texture(Texture::BrickColor, 1.2),
            normal_texture: texture(Texture::BrickNormal, 1.2),
            ..plain("brick", [0.95, 0.95, 0.95], 0.9)
        },
        grained("stone", [0.62, 0.58, 0.50], 0.85, Texture::Grain, 1.5),
        plain("timber", [0.13, 0.075, 0.04], 0.7),
        plain("white paint", [0.80, 0.79, 0.75], 0.45),
        plain("green paint", [0.07, 0.20, 0.11], 0.45),
        plain("blue paint", [0.09, 0.19, 0.33], 0.45),
        plain("oxblood paint", [0.30, 0.06, 0.05], 0.45),
        grained("red tiles", [0.62, 0.22, 0.11], 0.8, Texture::Grain, 1.7),
        grained("brown tiles", [0.42, 0.23, 0.14], 0.8, Texture::Grain, 1.7),
        grained("slates", [0.21, 0.23, 0.27], 0.5, Texture::Grain, 1.1),
        plain("glass", [0.035, 0.05, 0.06], 0.06),
        metal("iron", [0.14, 0.14, 0.15], 0.5),
        Material {
            emissive: Vec3::new(5.0, 3.4, 1.6),
            ..plain("lamp glass", [0.9, 0.75, 0.5], 0.4)
        },
        grained("setts", [0.40, 0.38, 0.36], 0.7, Texture::Grain, 2.3),
        grained("dark setts", [0.27, 0.25, 0.25], 0.7, Texture::Grain, 2.3),
        grained("flagstones", [0.60, 0.56, 0.49], 0.75, Texture::Grain, 2.9),
        grained("earth", [0.24, 0.20, 0.15], 0.95, Texture::Grain, 1.9),
        grained("grass", [0.15, 0.25, 0.06], 0.95, Texture::Grain, 2.1),
        plain("bark", [0.16, 0.11, 0.075], 0.9),
        leaf("leaves", [0.16, 0.30, 0.06]),
        leaf("dark leaves", [0.05, 0.15, 0.05]),
        leaf("petals", [0.70, 0.10, 0.16]),
        Material { double_sided: true, ..plain("awning", [0.72, 0.62, 0.40], 0.9) },
        plain("water", [0.03, 0.08, 0.09], 0.04),
        metal("gold", [0.90, 0.65, 0.25], 0.25),
    ]
}
