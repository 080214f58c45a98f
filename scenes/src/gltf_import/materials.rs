//! Reads materials and their textures.

use glam::{Affine2, Mat2, Vec2, Vec3, Vec4};
use gltf::json::{
    Index,
    extensions::texture::TextureTransform,
    material::{AlphaMode, Material as Json},
    texture::{Info, MagFilter, MinFilter, Sampler as JsonSampler, Texture, WrappingMode},
    validation::Checked,
};

use serde::Deserialize;

use super::{Warnings, file::File, images::ImageTable, warnings::kept_name};
use crate::{Dielectric, Encoding, Filter, Image, Material, Sampler, SceneError, TextureRef, Wrap};

/// The cutoff of masks without one, and of blended materials.
const DEFAULT_CUTOFF: f32 = 0.5;

/// The index of refraction of a material without one.
const DEFAULT_IOR: f32 = 1.5;

/// The extension by which older exporters describe materials.
const GLOSSINESS: &str = "KHR_materials_pbrSpecularGlossiness";

/// The roughness of materials of that extension whose glossiness is in a texture.
const GLOSSY_ROUGHNESS: f32 = 0.5;

/// The content of that extension.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase", default)]
struct Glossy {
    diffuse_factor: [f32; 4],
    diffuse_texture: Option<Info>,
    specular_factor: [f32; 3],
    glossiness_factor: f32,
    specular_glossiness_texture: Option<serde_json::Value>,
}

impl Default for Glossy {
    fn default() -> Self {
        Self {
            diffuse_factor: [1.0; 4],
            diffuse_texture: None,
            specular_factor: [1.0; 3],
            glossiness_factor: 1.0,
            specular_glossiness_texture: None,
        }
    }
}

/// The file's materials, followed by the default one, and the texture coordinates that each needs.
pub(super) struct Materials {
    pub(super) materials: Vec<Material>,
    pub(super) images: Vec<Image>,
    /// The vertex attribute TEXCOORD_n that each material reads.
    pub(super) uv_sets: Vec<u32>,
}

/// Converts all materials and decodes their images.
pub(super) fn load(file: &File, warnings: &mut Warnings) -> Result<Materials, SceneError> {
    let mut table = ImageTable::new(file);
    let mut materials = Vec::new();
    let mut uv_sets = Vec::new();
    for (ix, json) in file.root.materials.iter().enumerate() {
        let mut reader = Reader {
            file,
            table: &mut table,
            warnings,
            name: json.name.as_deref().map_or_else(|| format!("material {ix}"), kept_name),
            uv_set: None,
        };
        materials.push(reader.material(ix, json)?);
        uv_sets.push(reader.uv_set.unwrap_or(0));
    }
    materials.push(Material::default());
    uv_sets.push(0);
    let images = table.decode(file)?;
    Ok(Materials { materials, images, uv_sets })
}

struct Reader<'a> {
    file: &'a File,
    table: &'a mut ImageTable,
    warnings: &'a mut Warnings,
    name: String,
    uv_set: Option<u32>,
}

impl Reader<'_> {
    fn material(&mut self, ix: usize, json: &Json) -> Result<Material, SceneError> {
        use Encoding::{Linear, Srgb};
        let pbr = &json.pbr_metallic_roughness;
        let name = self.name.clone();
        let strength = json
            .extensions
            .as_ref()
            .and_then(|e| e.emissive_strength.as_ref())
            .map_or(1.0, |s| s.emissive_strength.0);
        let mut material = Material {
            base_color: Vec4::from(pbr.base_color_factor.0).clamp(Vec4::ZERO, Vec4::ONE),
            metallic: pbr.metallic_factor.0.clamp(0.0, 1.0),
            roughness: pbr.roughness_factor.0.clamp(0.0, 1.0),
            emissive: Vec3::from(json.emissive_factor.0) * strength,
            normal_scale: json.normal_texture.as_ref().map_or(1.0, |t| t.scale),
            alpha_cutoff: self.alpha(json),
            is_blended: matches!(json.alpha_mode, Checked::Valid(AlphaMode::Blend)),
            transmission: self.transmission(ix, json)?,
            double_sided: json.double_sided,
            base_color_texture: self.info(pbr.base_color_texture.as_ref(), Srgb),
            metallic_roughness_texture: self.info(pbr.metallic_roughness_texture.as_ref(), Linear),
            normal_texture: json.normal_texture.as_ref().and_then(|t| {
                let transform = t.extensions.as_ref().and_then(|e| {
                    let value = e.others.get("KHR_texture_transform")?;
                    serde_json::from_value(value.clone()).ok()
                });
                self.texture(t.index, t.tex_coord, transform.as_ref(), Linear)
            }),
            emissive_texture: self.info(json.emissive_texture.as_ref(), Srgb),
            dielectric: self.dielectric(ix, json)?,
            unlit: false,
            name,
        };
        if let Some(value) = json.extensions.as_ref().and_then(|e| e.others.get(GLOSSINESS)) {
            self.make_glossy(ix, value, &mut material)?;
        }
        if json.extensions.as_ref().is_some_and(|e| e.unlit.is_some()) {
            make_unlit(&mut material);
        }
        let emissive = material.emissive;
        if !(emissive.is_finite() && emissive.min_element() >= 0.0) {
            let field = format!("materials[{ix}].emissiveFactor");
            return Err(self.file.invalid(field, emissive, "finite and at least 0"));
        }
        if !material.normal_scale.is_finite() {
            let field = format!("materials[{ix}].normalTexture.scale");
            return Err(self.file.invalid(field, material.normal_scale, "finite"));
        }
        Ok(material)
    }

    /// Reads KHR_materials_ior and KHR_materials_specular, without their textures.
    fn dielectric(&mut self, ix: usize, json: &Json) -> Result<Dielectric, SceneError> {
        let extensions = json.extensions.as_ref();
        let ior = extensions.and_then(|e| e.ior.as_ref()).map_or(DEFAULT_IOR, |ior| ior.ior.0);
        let specular = extensions.and_then(|e| e.specular.as_ref());
        let factor = specular.map_or(1.0, |s| s.specular_factor.0);
        let color = specular.map_or(Vec3::ONE, |s| Vec3::from(s.specular_color_factor.0));
        let fail = |name: &str, value: String, accepted: &str| {
            Err(self.file.invalid(format!("materials[{ix}].extensions.{name}"), value, accepted))
        };
        // 0 stands for an infinite index of refraction (KHR_materials_ior).
        if !(ior == 0.0 || ior >= 1.0 && ior.is_finite()) {
            return fail("KHR_materials_ior.ior", ior.to_string(), "0, or finite and at least 1");
        }
        if !(0.0..=1.0).contains(&factor) {
            let field = "KHR_materials_specular.specularFactor";
            return fail(field, factor.to_string(), "between 0 and 1");
        }
        if !(color.is_finite() && color.min_element() >= 0.0) {
            let field = "KHR_materials_specular.specularColorFactor";
            return fail(field, color.to_string(), "finite and at least 0");
        }
        let textures = specular.map(|s| {
            [
                ("specularTexture", s.specular_texture.is_some()),
                ("specularColorTexture", s.specular_color_texture.is_some()),
            ]
        });
        for (texture, _) in textures.into_iter().flatten().filter(|(_, is_used)| *is_used) {
            self.warnings.add(format!(
                "material {:?}: {texture} of KHR_materials_specular is ignored; its factors are used",
                self.name
            ));
        }
        let normal = if ior == DEFAULT_IOR {
            Dielectric::default().f0
        } else if ior == 0.0 {
            Vec3::ONE
        } else {
            Vec3::splat(((ior - 1.0) / (ior + 1.0)).powi(2))
        };
        Ok(Dielectric { f0: (normal * color).min(Vec3::ONE) * factor, f90: factor })
    }

    /// Reads the older model: a diffuse and a specular colour. A dielectric of that reflectance
    /// looks the same, except for the texture of specular colour and glossiness, which is ignored.
    fn make_glossy(
        &mut self,
        ix: usize,
        value: &serde_json::Value,
        material: &mut Material,
    ) -> Result<(), SceneError> {
        let fail = |accepted: String| {
            let field = format!("materials[{ix}].extensions.{GLOSSINESS}");
            self.file.invalid(field, value, accepted)
        };
        let glossy: Glossy = serde_json::from_value(value.clone())
            .map_err(|error| fail(format!("diffuse, specular and glossiness: {error}")))?;
        let factors = [&glossy.diffuse_factor[..], &glossy.specular_factor].concat();
        if !factors.iter().chain([&glossy.glossiness_factor]).all(|x| (0.0..=1.0).contains(x)) {
            return Err(fail("factors between 0 and 1".into()));
        }
        let textures = self.file.root.textures.len();
        if glossy.diffuse_texture.as_ref().is_some_and(|t| t.index.value() >= textures) {
            return Err(fail(format!("a diffuseTexture with an index below {textures}")));
        }
        material.base_color = Vec4::from(glossy.diffuse_factor);
        material.base_color_texture = self.info(glossy.diffuse_texture.as_ref(), Encoding::Srgb);
        (material.metallic, material.metallic_roughness_texture) = (0.0, None);
        material.roughness = 1.0 - glossy.glossiness_factor;
        material.dielectric.f0 = Vec3::from(glossy.specular_factor);
        if glossy.specular_glossiness_texture.is_some() {
            // The factors without their texture would make it a mirror.
            material.dielectric = Dielectric::default();
            material.roughness = GLOSSY_ROUGHNESS;
            self.warnings.add(format!(
                "material {:?}: specularGlossinessTexture is ignored; the material is drawn with \
                 roughness {GLOSSY_ROUGHNESS} and glTF's default reflectance",
                self.name
            ));
        }
        Ok(())
    }

    fn alpha(&mut self, json: &Json) -> Option<f32> {
        match json.alpha_mode {
            Checked::Valid(AlphaMode::Mask) => {
                Some(json.alpha_cutoff.map_or(DEFAULT_CUTOFF, |cutoff| cutoff.0))
            }
            Checked::Valid(AlphaMode::Blend) => {
                self.warnings.add(format!(
                    "material {:?}: alphaMode BLEND is drawn as MASK with cutoff {DEFAULT_CUTOFF}, unless \
                     transparent surfaces are drawn",
                    self.name
                ));
                Some(DEFAULT_CUTOFF)
            }
            _ => None,
        }
    }

    /// Reads KHR_materials_transmission, without its texture.
    fn transmission(&mut self, ix: usize, json: &Json) -> Result<f32, SceneError> {
        let extension = json.extensions.as_ref().and_then(|e| e.transmission.as_ref());
        let Some(extension) = extension else { return Ok(0.0) };
        let factor = extension.transmission_factor.0;
        if !(0.0..=1.0).contains(&factor) {
            let name = "KHR_materials_transmission.transmissionFactor";
            let field = format!("materials[{ix}].extensions.{name}");
            return Err(self.file.invalid(field, factor, "between 0 and 1"));
        }
        if extension.transmission_texture.is_some() {
            self.warnings.add(format!(
                "material {:?}: transmissionTexture of KHR_materials_transmission is ignored; its factor is used",
                self.name
            ));
        }
        if factor > 0.0 {
            self.warnings.add(format!(
                "material {:?}: KHR_materials_transmission is left out, unless transparent surfaces are drawn",
                self.name
            ));
        }
        Ok(factor)
    }

    fn info(&mut self, info: Option<&Info>, encoding: Encoding) -> Option<TextureRef> {
        let info = info?;
        let extensions = info.extensions.as_ref();
        let transform = extensions.and_then(|e| e.texture_transform.as_ref());
        self.texture(info.index, info.tex_coord, transform, encoding)
    }

    fn texture(
        &mut self,
        index: Index<Texture>,
        tex_coord: u32,
        transform: Option<&TextureTransform>,
        encoding: Encoding,
    ) -> Option<TextureRef> {
        // `file::parse` has validated the indices.
        let texture = &self.file.root.textures[index.value()];
        if texture.source.value() == u32::MAX as usize {
            let extensions = texture.extensions.iter().flat_map(|e| e.others.keys());
            let mut extensions: Vec<_> = extensions.map(String::as_str).collect();
            if extensions.is_empty() {
                extensions.push("none");
            }
            self.warnings.add(format!(
                "texture {index} has no image of a supported format ({}): materials are drawn without it",
                extensions.join(", ")
            ));
            return None;
        }
        let set = transform.and_then(|t| t.tex_coord).unwrap_or(tex_coord);
        if *self.uv_set.get_or_insert(set) != set {
            self.warnings.add(format!(
                "material {:?}: its textures use several TEXCOORD sets; the first set is used for all",
                self.name
            ));
        }
        let sampler = texture.sampler.and_then(|ix| self.file.root.get(ix));
        Some(TextureRef {
            image: self.table.number(texture.source.value(), encoding),
            sampler: sampler.map_or_else(Sampler::default, convert_sampler),
            uv_transform: transform.map_or(Affine2::IDENTITY, uv_transform),
        })
    }
}

/// Turns a material's colour into emission, and makes it reflect nothing. Holes of its mask stay.
fn make_unlit(material: &mut Material) {
    material.emissive = material.base_color.truncate();
    material.emissive_texture = material.base_color_texture;
    material.base_color = Vec4::new(0.0, 0.0, 0.0, material.base_color.w);
    (material.metallic, material.metallic_roughness_texture) = (0.0, None);
    (material.normal_texture, material.normal_scale) = (None, 1.0);
    material.dielectric = Dielectric::BLACK;
    material.unlit = true;
}

/// Translation * rotation * scale. The rotation is counter-clockwise in an image whose v axis
/// points down (KHR_texture_transform).
fn uv_transform(transform: &TextureTransform) -> Affine2 {
    let (sin, cos) = transform.rotation.0.sin_cos();
    let rotation = Mat2::from_cols(Vec2::new(cos, -sin), Vec2::new(sin, cos));
    let scale = Mat2::from_diagonal(Vec2::from(transform.scale.0));
    let whole = Affine2::from_mat2_translation(rotation * scale, Vec2::from(transform.offset.0));
    if whole.is_finite() { whole } else { Affine2::IDENTITY }
}

fn convert_sampler(json: &JsonSampler) -> Sampler {
    use Filter::{Linear, Nearest};
    let wrap = |mode| match mode {
        Checked::Valid(WrappingMode::ClampToEdge) => Wrap::ClampToEdge,
        Checked::Valid(WrappingMode::MirroredRepeat) => Wrap::MirroredRepeat,
        _ => Wrap::Repeat,
    };
    let (min, mip) = match json.min_filter {
        Some(Checked::Valid(filter)) => match filter {
            MinFilter::Nearest => (Nearest, None),
            MinFilter::Linear => (Linear, None),
            MinFilter::NearestMipmapNearest => (Nearest, Some(Nearest)),
            MinFilter::LinearMipmapNearest => (Linear, Some(Nearest)),
            MinFilter::NearestMipmapLinear => (Nearest, Some(Linear)),
            MinFilter::LinearMipmapLinear => (Linear, Some(Linear)),
        },
        _ => (Linear, Some(Linear)),
    };
    Sampler {
        wrap_s: wrap(json.wrap_s),
        wrap_t: wrap(json.wrap_t),
        mag: match json.mag_filter {
            Some(Checked::Valid(MagFilter::Nearest)) => Nearest,
            _ => Linear,
        },
        min,
        mip,
    }
}
