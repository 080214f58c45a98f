//! Materials (glTF's metallic-roughness model), their textures and images.

use glam::{Affine2, Vec3, Vec4};

/// A surface's appearance: the metallic-roughness model of glTF 2.0. Every factor multiplies its
/// texture if there is one.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// A name for people; it need not be unique.
    pub name: String,
    /// Base colour and opacity, linear.
    pub base_color: Vec4,
    /// 0 dielectric, 1 metal.
    pub metallic: f32,
    /// Perceptual roughness, 0..1; GGX's alpha is its square.
    pub roughness: f32,
    /// Emitted radiance, linear RGB, including KHR_materials_emissive_strength.
    pub emissive: Vec3,
    /// Scale of the normal texture's x and y.
    pub normal_scale: f32,
    /// The opacity below which nothing is drawn; `None` is opaque.
    pub alpha_cutoff: Option<f32>,
    /// Whether a renderer of transparent surfaces blends it by its opacity (glTF's `alphaMode` BLEND). Other
    /// renderers draw it by [`alpha_cutoff`](Self::alpha_cutoff).
    pub is_blended: bool,
    /// The share of light that its dielectric part lets through instead of scattering it, 0..=1
    /// (KHR_materials_transmission). Only a renderer of transparent surfaces shows it.
    pub transmission: f32,
    /// Whether back faces are drawn, with the normal turned to the viewer.
    pub double_sided: bool,
    /// Base colour and opacity, sRGB.
    pub base_color_texture: Option<TextureRef>,
    /// Roughness in green, metalness in blue, linear.
    pub metallic_roughness_texture: Option<TextureRef>,
    /// Tangent-space normal, `2 rgb - 1`, linear.
    pub normal_texture: Option<TextureRef>,
    /// Emission, sRGB.
    pub emissive_texture: Option<TextureRef>,
    /// Reflectance of its dielectric share (KHR_materials_ior, KHR_materials_specular).
    pub dielectric: Dielectric,
    /// Whether its colour is shown as it is (KHR_materials_unlit). `emissive` then holds the
    /// colour, and nothing is reflected. Vertex colours multiply the emission.
    pub unlit: bool,
}

/// Reflectance of a dielectric: Schlick's curve from normal to grazing incidence.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Dielectric {
    /// At normal incidence, linear RGB.
    pub f0: Vec3,
    /// At grazing incidence.
    pub f90: f32,
}

impl Default for Dielectric {
    /// glTF's default: an index of refraction of 1.5.
    fn default() -> Self {
        Self { f0: Vec3::splat(0.04), f90: 1.0 }
    }
}

impl Dielectric {
    /// A surface that reflects nothing.
    pub const BLACK: Self = Self { f0: Vec3::ZERO, f90: 0.0 };
}

impl Default for Material {
    /// glTF's default material: white, metallic 1, roughness 1.
    fn default() -> Self {
        Self {
            name: "default".into(),
            base_color: Vec4::ONE,
            metallic: 1.0,
            roughness: 1.0,
            emissive: Vec3::ZERO,
            normal_scale: 1.0,
            alpha_cutoff: None,
            is_blended: false,
            transmission: 0.0,
            double_sided: false,
            base_color_texture: None,
            metallic_roughness_texture: None,
            normal_texture: None,
            emissive_texture: None,
            dielectric: Dielectric::default(),
            unlit: false,
        }
    }
}

impl Material {
    /// Whether a renderer of transparent surfaces shows what lies behind it.
    pub fn is_transparent(&self) -> bool {
        self.is_blended || self.transmission > 0.0
    }

    /// Its textures: base colour, metallic-roughness, normal, emissive.
    pub fn textures(&self) -> [Option<&TextureRef>; 4] {
        [
            self.base_color_texture.as_ref(),
            self.metallic_roughness_texture.as_ref(),
            self.normal_texture.as_ref(),
            self.emissive_texture.as_ref(),
        ]
    }
}

/// An image as one material reads it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TextureRef {
    /// Index into [`Scene::images`](crate::Scene::images).
    pub image: u32,
    /// How it is sampled.
    pub sampler: Sampler,
    /// Maps the vertex's uv to the texture's (KHR_texture_transform); the identity by default.
    pub uv_transform: Affine2,
}

impl TextureRef {
    /// The image, repeated, filtered trilinearly, with uv untransformed.
    pub fn new(image: u32) -> Self {
        Self { image, sampler: Sampler::default(), uv_transform: Affine2::IDENTITY }
    }
}

/// How a texture is sampled.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Sampler {
    /// Behaviour outside 0..1 in u.
    pub wrap_s: Wrap,
    /// Behaviour outside 0..1 in v.
    pub wrap_t: Wrap,
    /// Filter between texels when magnified.
    pub mag: Filter,
    /// Filter between texels when minified.
    pub min: Filter,
    /// Filter between mip levels; `None` reads only the finest level.
    pub mip: Option<Filter>,
}

impl Default for Sampler {
    fn default() -> Self {
        Self {
            wrap_s: Wrap::Repeat,
            wrap_t: Wrap::Repeat,
            mag: Filter::Linear,
            min: Filter::Linear,
            mip: Some(Filter::Linear),
        }
    }
}

/// What a texture shows outside 0..1.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Wrap {
    /// The texture again.
    Repeat,
    /// The mirrored texture.
    MirroredRepeat,
    /// Its edge.
    ClampToEdge,
}

/// How neighbouring texels are combined.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Filter {
    /// Only the nearest one.
    Nearest,
    /// A linear blend.
    Linear,
}

/// Pixels of a texture, top row first.
#[derive(Clone, PartialEq)]
pub struct Image {
    /// A name for people; it need not be unique.
    pub name: String,
    /// Pixels per row, `> 0`.
    pub width: u32,
    /// Rows, `> 0`.
    pub height: u32,
    /// `width * height` pixels of red, green, blue, alpha.
    pub rgba: Vec<u8>,
    /// Whether the numbers are sRGB or linear.
    pub encoding: Encoding,
}

impl std::fmt::Debug for Image {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Image({:?}, {}x{}, {:?})", self.name, self.width, self.height, self.encoding)
    }
}

/// The encoding of an [`Image`]'s numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Encoding {
    /// Colour in the sRGB transfer function; alpha is linear.
    Srgb,
    /// Linear data.
    Linear,
}
