//! Materials and textures on the GPU. Each material binds only the textures that it has.

use std::collections::HashMap;

use assign::{Gpu, texture_entry};
use bytemuck::{Pod, Zeroable, cast_slice};
use scenes::{Dielectric, Encoding, Filter, Image, Material, Sampler, Scene, TextureRef, Wrap};
use wgpu::util::DeviceExt;

use crate::{ShadingError, mips::mip_chain};

/// `scene.wesl`, `struct Material`. 192 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct MaterialRecord {
    /// Linear RGB and alpha.
    pub base_color: [f32; 4],
    /// Emitted radiance, linear RGB.
    pub emissive: [f32; 3],
    /// 0 dielectric to 1 metal.
    pub metallic: f32,
    /// Perceptual roughness.
    pub roughness: f32,
    /// Scale of the normal map's x and y.
    pub normal_scale: f32,
    /// Alpha below which a fragment is discarded.
    pub alpha_cutoff: f32,
    /// The share of light that the dielectric share lets through.
    pub transmission: f32,
    /// What the dielectric share reflects at normal incidence, and at grazing incidence.
    pub dielectric: [f32; 4],
    /// Rows of each texture's uv transform.
    pub uv_transforms: [[f32; 4]; 8],
}

/// The properties of a material that its shader is compiled for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct MaterialKey {
    /// Base colour, metallic-roughness, normal, emissive.
    pub(crate) textures: [bool; 4],
    pub(crate) uv_transforms: bool,
    pub(crate) mask: bool,
    pub(crate) double_sided: bool,
    pub(crate) unlit: bool,
    /// Whether the drawn mesh has vertex colours.
    pub(crate) vertex_colors: bool,
}

/// The flags of the four textures, in binding order: slot i has bindings 2i and 2i + 1.
pub(crate) const TEXTURE_FLAGS: [&str; 4] =
    ["base_color_texture", "metallic_roughness_texture", "normal_texture", "emissive_texture"];

impl MaterialKey {
    fn new(material: &Material) -> Self {
        let textures = material.textures();
        let moved = |t: &&TextureRef| t.uv_transform != glam::Affine2::IDENTITY;
        Self {
            textures: textures.map(|t| t.is_some()),
            uv_transforms: textures.iter().flatten().any(moved),
            mask: material.alpha_cutoff.is_some(),
            double_sided: material.double_sided,
            unlit: material.unlit,
            vertex_colors: false,
        }
    }
}

/// A scene's materials on the GPU.
#[derive(Clone, Debug)]
pub(crate) struct Materials {
    keys: Vec<MaterialKey>,
    groups: Vec<wgpu::BindGroup>,
    layouts: HashMap<[bool; 4], wgpu::BindGroupLayout>,
    pub(crate) factors: wgpu::Buffer,
    pub(crate) has_emissive: bool,
    /// Whether any material has a reflectance other than that of glTF's default dielectric.
    pub(crate) has_dielectrics: bool,
}

impl Materials {
    pub(crate) fn new(gpu: &Gpu, scene: &Scene) -> Result<Self, ShadingError> {
        let keys: Vec<MaterialKey> = scene.materials.iter().map(MaterialKey::new).collect();
        let records: Vec<MaterialRecord> = scene.materials.iter().map(record).collect();
        let factors = gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("materials"),
            contents: cast_slice(&records),
            usage: wgpu::BufferUsages::STORAGE,
        });
        let textures = upload_images(gpu, &scene.images)?;
        let mut samplers = HashMap::new();
        let mut layouts = HashMap::new();
        let groups = scene
            .materials
            .iter()
            .map(|material| {
                let key = material.textures().map(|t| t.is_some());
                let layout = layouts.entry(key).or_insert_with(|| layout(gpu, key));
                for texture in material.textures().into_iter().flatten() {
                    samplers
                        .entry(texture.sampler)
                        .or_insert_with(|| sampler(gpu, texture.sampler));
                }
                group(gpu, layout, material, &textures, &samplers)
            })
            .collect();
        Ok(Self {
            keys,
            groups,
            layouts,
            factors,
            has_emissive: scene.materials.iter().any(|m| m.emissive != glam::Vec3::ZERO),
            has_dielectrics: scene.materials.iter().any(|m| m.dielectric != Dielectric::default()),
        })
    }

    pub(crate) fn key(&self, material: u32) -> MaterialKey {
        self.keys.get(material as usize).copied().unwrap_or_default()
    }

    pub(crate) fn bind_group(&self, material: u32) -> Option<&wgpu::BindGroup> {
        self.groups.get(material as usize)
    }

    pub(crate) fn layout(&self, key: MaterialKey) -> Option<&wgpu::BindGroupLayout> {
        self.layouts.get(&key.textures)
    }
}

fn record(material: &Material) -> MaterialRecord {
    let mut uv_transforms = [[1.0, 0.0, 0.0, 0.0]; 8];
    for (slot, texture) in material.textures().into_iter().enumerate() {
        let transform = texture.map_or(glam::Affine2::IDENTITY, |t| t.uv_transform);
        let (x, y, t) = (transform.matrix2.x_axis, transform.matrix2.y_axis, transform.translation);
        uv_transforms[2 * slot] = [x.x, y.x, t.x, 0.0];
        uv_transforms[2 * slot + 1] = [x.y, y.y, t.y, 0.0];
    }
    MaterialRecord {
        base_color: material.base_color.to_array(),
        emissive: material.emissive.to_array(),
        metallic: material.metallic,
        roughness: material.roughness,
        normal_scale: material.normal_scale,
        alpha_cutoff: material.alpha_cutoff.unwrap_or(0.0),
        transmission: material.transmission,
        dielectric: material.dielectric.f0.extend(material.dielectric.f90).to_array(),
        uv_transforms,
    }
}

fn layout(gpu: &Gpu, textures: [bool; 4]) -> wgpu::BindGroupLayout {
    let entries: Vec<wgpu::BindGroupLayoutEntry> = (0..4)
        .filter(|&slot| textures[slot])
        .flat_map(|slot| {
            let stages = wgpu::ShaderStages::FRAGMENT;
            let filtered = wgpu::TextureSampleType::Float { filterable: true };
            let first = 2 * slot as u32;
            let sampler = wgpu::BindGroupLayoutEntry {
                binding: first + 1,
                visibility: stages,
                ty: wgpu::BindingType::Sampler(wgpu::SamplerBindingType::Filtering),
                count: None,
            };
            [texture_entry(first, stages, filtered), sampler]
        })
        .collect();
    gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("material"),
        entries: &entries,
    })
}

fn group(
    gpu: &Gpu,
    layout: &wgpu::BindGroupLayout,
    material: &Material,
    textures: &[wgpu::TextureView],
    samplers: &HashMap<Sampler, wgpu::Sampler>,
) -> wgpu::BindGroup {
    let entries: Vec<wgpu::BindGroupEntry<'_>> = material
        .textures()
        .into_iter()
        .enumerate()
        .filter_map(|(slot, texture)| Some((slot, texture?)))
        .flat_map(|(slot, texture)| {
            let first = 2 * slot as u32;
            [
                wgpu::BindGroupEntry {
                    binding: first,
                    resource: wgpu::BindingResource::TextureView(&textures[texture.image as usize]),
                },
                wgpu::BindGroupEntry {
                    binding: first + 1,
                    resource: wgpu::BindingResource::Sampler(&samplers[&texture.sampler]),
                },
            ]
        })
        .collect();
    gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some(&material.name),
        layout,
        entries: &entries,
    })
}

fn sampler(gpu: &Gpu, sampler: Sampler) -> wgpu::Sampler {
    let wrap = |wrap| match wrap {
        Wrap::Repeat => wgpu::AddressMode::Repeat,
        Wrap::MirroredRepeat => wgpu::AddressMode::MirrorRepeat,
        Wrap::ClampToEdge => wgpu::AddressMode::ClampToEdge,
    };
    let filter = |filter| match filter {
        Filter::Nearest => wgpu::FilterMode::Nearest,
        Filter::Linear => wgpu::FilterMode::Linear,
    };
    gpu.device.create_sampler(&wgpu::SamplerDescriptor {
        label: Some("material"),
        address_mode_u: wrap(sampler.wrap_s),
        address_mode_v: wrap(sampler.wrap_t),
        mag_filter: filter(sampler.mag),
        min_filter: filter(sampler.min),
        mipmap_filter: match sampler.mip {
            Some(Filter::Linear) => wgpu::MipmapFilterMode::Linear,
            _ => wgpu::MipmapFilterMode::Nearest,
        },
        lod_max_clamp: if sampler.mip.is_some() { 32.0 } else { 0.0 },
        ..Default::default()
    })
}

fn upload_images(gpu: &Gpu, images: &[Image]) -> Result<Vec<wgpu::TextureView>, ShadingError> {
    use rayon::prelude::*;
    let limit = gpu.device.limits().max_texture_dimension_2d;
    if let Some(image) = images.iter().find(|i| i.width.max(i.height) > limit) {
        return Err(ShadingError::Texture {
            name: image.name.clone(),
            width: image.width,
            height: image.height,
            limit,
        });
    }
    let chains: Vec<(u32, Vec<u8>)> = images.par_iter().map(mip_chain).collect();
    let upload = |(image, (levels, bytes)): (&Image, (u32, Vec<u8>))| {
        let texture = gpu.device.create_texture_with_data(
            &gpu.queue,
            &wgpu::TextureDescriptor {
                label: Some(&image.name),
                size: wgpu::Extent3d {
                    width: image.width,
                    height: image.height,
                    depth_or_array_layers: 1,
                },
                mip_level_count: levels,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: match image.encoding {
                    Encoding::Srgb => wgpu::TextureFormat::Rgba8UnormSrgb,
                    Encoding::Linear => wgpu::TextureFormat::Rgba8Unorm,
                },
                usage: wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            },
            wgpu::util::TextureDataOrder::MipMajor,
            &bytes,
        );
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    };
    let bytes = chains.iter().map(|(_, bytes)| bytes.len() as u64).sum();
    Ok(gpu.allocate("textures", bytes, || images.iter().zip(chains).map(upload).collect())?)
}
