//! A scene's triangles for rays, and the surfaces they meet, as `material.wesl` computes them.

use assign::{Projection, View};
use glam::{DVec3, Vec2, Vec3, Vec4};
use scenes::{Material, Mesh, Scene, TextureRef, Vertex};

use super::{
    texture::Texture,
    triangles::{Hit, Triangles},
};
use crate::{
    geometry::{InstanceRecord, record},
    reference::Surface,
};

/// How far rays start off their surface, as a share of the largest of its coordinates and its
/// distance from where it was seen: four times what rebuilding a position from depth may err by.
const RAY_OFFSET: f64 = 64.0 * f32::EPSILON as f64;

/// How far around a position its triangle is looked for, in multiples of [`RAY_OFFSET`].
const SEARCH: f64 = 8.0;

/// A point of a surface, seen from one direction.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceSample {
    /// World space, metres.
    pub position: DVec3,
    /// Its material and shading normal.
    pub surface: Surface,
    /// Emitted radiance, linear RGB.
    pub emission: DVec3,
    /// Unit vector to whence it is seen.
    pub to_eye: DVec3,
    /// Unit normal of its triangle, on the side of the eye.
    pub geometric_normal: DVec3,
    /// How far rays start above the surface, and end before a light, metres.
    pub offset_m: f64,
}

impl SurfaceSample {
    /// Where its rays start: off the surface on the side of the eye.
    pub fn ray_origin(&self) -> DVec3 {
        self.position + self.geometric_normal * self.offset_m
    }
}

/// The triangles of a scene in a hierarchy, with all that a hit's surface needs.
pub struct TracedScene<'a> {
    scene: &'a Scene,
    triangles: Triangles,
    /// Instance and place in its mesh, by triangle.
    sources: Vec<(u32, u32)>,
    /// By instance.
    records: Vec<InstanceRecord>,
    /// By image.
    textures: Vec<Texture>,
}

impl<'a> TracedScene<'a> {
    /// Builds the hierarchy and the textures' mip chains.
    pub fn new(scene: &'a Scene) -> Self {
        use rayon::prelude::*;
        let mut sources = Vec::new();
        let mut corners = Vec::new();
        let mut records = Vec::new();
        for (instance_ix, instance) in (0..).zip(&scene.instances) {
            let model = &scene.models[instance.model as usize];
            let mesh = &scene.meshes[instance.mesh as usize];
            let to_world = |p| model.object_to_world.transform_point3(p);
            records.push(record(model, instance.model, mesh.material));
            corners.extend(mesh.triangles().map(|triangle| triangle.map(to_world)));
            sources.extend((0..mesh.triangle_count() as u32).map(|ix| (instance_ix, ix)));
        }
        Self {
            scene,
            triangles: Triangles::new(corners),
            sources,
            records,
            textures: scene.images.par_iter().map(Texture::new).collect(),
        }
    }

    /// Whether nothing lies between the sample and a point.
    pub fn sees(&self, from: &SurfaceSample, point: DVec3) -> bool {
        let origin = from.ray_origin();
        let to_point = point - origin;
        let distance_m = to_point.length();
        let direction = to_point / distance_m.max(f64::MIN_POSITIVE);
        // A light may lie on a surface.
        let end_m = distance_m - from.offset_m;
        !self.triangles.any(origin, direction, end_m, |hit| self.is_solid(hit))
    }

    /// Whether a ray from the sample leaves the scene.
    pub fn sees_sky(&self, from: &SurfaceSample, direction: DVec3) -> bool {
        let solid = |hit: &Hit| self.is_solid(hit);
        !self.triangles.any(from.ray_origin(), direction, f64::INFINITY, solid)
    }

    /// How far a ray goes before it meets a triangle, from either side, metres; `None` where it meets
    /// none. Holes of alpha masks count as surface, as in deep images.
    pub fn distance_m(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let hit = self.triangles.first(origin, direction, f64::INFINITY, |_| true)?;
        Some(hit.distance_m)
    }

    /// The same, with the unit normal of the triangle on the side that the ray comes from.
    pub fn surface(&self, origin: DVec3, direction: DVec3) -> Option<(f64, DVec3)> {
        let hit = self.triangles.first(origin, direction, f64::INFINITY, |_| true)?;
        Some((hit.distance_m, towards(self.geometric_normal(&hit), -direction)))
    }

    /// What a ray from a sample meets first; `None` where it leaves the scene, or meets the back of
    /// a surface that has none.
    pub fn bounce(&self, from: &SurfaceSample, direction: DVec3) -> Option<SurfaceSample> {
        let solid = |hit: &Hit| self.is_solid(hit);
        let hit = self.triangles.first(from.ray_origin(), direction, f64::INFINITY, solid)?;
        self.is_drawn(&hit).then(|| self.surface_at(&hit, direction, 0.0))
    }

    /// What a pixel of the viewport shows, by a ray through its centre: as the rasteriser draws it,
    /// up to rounding, and textures at one level of mips instead of a blend of two.
    pub fn primary(&self, view: &View, pixel: [u32; 2]) -> Option<SurfaceSample> {
        let uniform = view.uniform();
        let size = Vec2::from(uniform.viewport_size);
        let uv = (Vec2::new(pixel[0] as f32, pixel[1] as f32) + 0.5) / size;
        let ndc = Vec2::new(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y);
        let at = Vec2::from(uniform.ray_scale) * ndc + Vec2::from(uniform.ray_offset);
        let view_to_world = view.world_to_view.inverse().as_dmat4();
        let (origin, direction) = match view.projection {
            Projection::Perspective { .. } => (DVec3::ZERO, at.extend(-1.0).as_dvec3()),
            Projection::Orthographic { .. } => (at.extend(0.0).as_dvec3(), DVec3::NEG_Z),
        };
        let pixel_size = f64::from(2.0 * (Vec2::from(uniform.ray_scale) / size).max_element());
        // Depth along the viewing axis of a distance along the ray.
        let per_metre = 1.0 / direction.length();
        let origin = view_to_world.transform_point3(origin);
        let direction = view_to_world.transform_vector3(direction).normalize();
        let start_m = f64::from(view.near_m) / per_metre;
        let end_m = view.far_m.map_or(f64::INFINITY, |far_m| f64::from(far_m) / per_metre);
        let drawn = |hit: &Hit| self.is_drawn(hit) && self.is_solid(hit);
        let start = origin + direction * start_m;
        let hit = self.triangles.first(start, direction, end_m - start_m, drawn)?;
        let distance_m = match view.projection {
            Projection::Perspective { .. } => start_m + hit.distance_m,
            Projection::Orthographic { .. } => 1.0,
        };
        let mut sample = self.surface_at(&hit, direction, pixel_size * distance_m);
        sample.offset_m = offset(sample.position, start_m + hit.distance_m);
        Some(sample)
    }

    /// A sample of a known surface: its triangle is the one found around the position, on the line
    /// of sight; without one, the shading normal serves.
    pub(super) fn seen_sample(
        &self,
        position: DVec3,
        surface: Surface,
        eye: DVec3,
        to_eye: DVec3,
    ) -> SurfaceSample {
        let offset_m = offset(position, eye.distance(position));
        let search_m = SEARCH * offset_m;
        let origin = position + to_eye * search_m;
        let solid = |hit: &Hit| self.is_solid(hit) && self.is_drawn(hit);
        let hit = self.triangles.first(origin, -to_eye, 2.0 * search_m, solid);
        let normal = hit.map_or(surface.normal, |hit| self.geometric_normal(&hit));
        SurfaceSample {
            position,
            surface,
            emission: DVec3::ZERO,
            to_eye,
            geometric_normal: towards(normal, to_eye),
            offset_m,
        }
    }

    fn material(&self, hit: &Hit) -> &'a Material {
        &self.scene.materials[self.mesh(hit).material as usize]
    }

    fn mesh(&self, hit: &Hit) -> &'a Mesh {
        let instance = self.scene.instances[self.sources[hit.triangle as usize].0 as usize];
        &self.scene.meshes[instance.mesh as usize]
    }

    fn record(&self, hit: &Hit) -> &InstanceRecord {
        &self.records[self.sources[hit.triangle as usize].0 as usize]
    }

    /// The vertices of a hit's triangle, object space.
    fn vertices(&self, hit: &Hit) -> [Vertex; 3] {
        let mesh = self.mesh(hit);
        let first = 3 * self.sources[hit.triangle as usize].1 as usize;
        [0, 1, 2].map(|corner| mesh.vertices[mesh.indices[first + corner] as usize])
    }

    /// Whether the front is hit: a mirrored model turns its triangles' sense.
    fn is_front(&self, hit: &Hit) -> bool {
        hit.is_front == (self.record(hit).handedness > 0.0)
    }

    /// Whether the side that is hit is drawn.
    fn is_drawn(&self, hit: &Hit) -> bool {
        self.material(hit).double_sided || self.is_front(hit)
    }

    /// Whether a hit is no hole of an alpha mask.
    fn is_solid(&self, hit: &Hit) -> bool {
        let material = self.material(hit);
        let Some(cutoff) = material.alpha_cutoff else { return true };
        let uv = interpolate(self.vertices(hit).map(|v| v.uv), hit.weights, Vec2::from);
        self.base_color(material, uv, |_| 0.0).w >= cutoff
    }

    fn geometric_normal(&self, hit: &Hit) -> DVec3 {
        let [a, b, c] = self.triangles.corners(hit.triangle);
        (b - a).cross(c - a).normalize_or(DVec3::Y)
    }

    /// The surface at a hit of a ray, textures averaged over about `footprint_m` across the ray.
    fn surface_at(&self, hit: &Hit, direction: DVec3, footprint_m: f64) -> SurfaceSample {
        let corners = self.triangles.corners(hit.triangle);
        let [wb, wc] = hit.weights;
        let position = corners[0] * (1.0 - wb - wc) + corners[1] * wb + corners[2] * wc;
        let geometric_normal = self.geometric_normal(hit);
        let material = self.material(hit);
        let vertices = self.vertices(hit);
        let uv = interpolate(vertices.map(|v| v.uv), hit.weights, Vec2::from);
        // The footprint is longest along the slope.
        let slope = geometric_normal.dot(direction).abs().max(1e-3);
        let level = self.level_of(corners, &vertices, footprint_m / slope);
        let (mut metallic, mut roughness) = (material.metallic, material.roughness);
        if let Some(texture) = &material.metallic_roughness_texture {
            let texel = self.texel(texture, uv, &level);
            (roughness, metallic) = (roughness * texel.y, metallic * texel.z);
        }
        let mut emission = material.emissive;
        if let Some(texture) = &material.emissive_texture {
            emission *= self.texel(texture, uv, &level).truncate();
        }
        let normal = self.shading_normal(hit, &vertices, direction, uv, &level);
        SurfaceSample {
            position,
            surface: Surface {
                base_color: self.base_color(material, uv, &level).truncate().as_dvec3(),
                metallic: f64::from(metallic),
                normal,
                roughness: f64::from(roughness),
            },
            emission: emission.as_dvec3(),
            to_eye: -direction,
            geometric_normal: towards(geometric_normal, -direction),
            offset_m: offset(position, hit.distance_m),
        }
    }

    fn shading_normal(
        &self,
        hit: &Hit,
        vertices: &[Vertex; 3],
        direction: DVec3,
        uv: Vec2,
        level: impl Fn(&TextureRef) -> f32,
    ) -> DVec3 {
        let record = self.record(hit);
        let normal = interpolate(vertices.map(|v| v.normal), hit.weights, Vec3::from);
        let columns = [record.normal_x, record.normal_y, record.normal_z].map(Vec3::from);
        let normal = columns[0] * normal.x + columns[1] * normal.y + columns[2] * normal.z;
        let vertex_normal = normal.normalize_or(-direction.as_vec3());
        let mut normal = vertex_normal;
        let material = self.material(hit);
        if let Some(texture) = &material.normal_texture {
            let mapped = self.texel(texture, uv, level).truncate() * 2.0 - 1.0;
            let mapped = mapped * Vec3::new(material.normal_scale, material.normal_scale, 1.0);
            let tangent = interpolate(vertices.map(|v| v.tangent), hit.weights, Vec4::from);
            let to_world = glam::Mat4::from_cols_array_2d(&record.object_to_world);
            let along = to_world.transform_vector3(tangent.truncate());
            let flat = (along - vertex_normal * vertex_normal.dot(along)).normalize_or_zero();
            let bitangent = vertex_normal.cross(flat) * (tangent.w * record.handedness).signum();
            let turned = flat * mapped.x + bitangent * mapped.y + vertex_normal * mapped.z;
            // A map that points nowhere leaves the vertex normal.
            normal = turned.try_normalize().unwrap_or(vertex_normal);
        }
        let facing = if self.is_front(hit) { 1.0 } else { -1.0 };
        (normal * facing).as_dvec3().normalize()
    }

    fn base_color(
        &self,
        material: &Material,
        uv: Vec2,
        level: impl Fn(&TextureRef) -> f32,
    ) -> Vec4 {
        let texel = |texture: &TextureRef| self.texel(texture, uv, level);
        material.base_color * material.base_color_texture.as_ref().map_or(Vec4::ONE, texel)
    }

    fn texel(&self, texture: &TextureRef, uv: Vec2, level: impl Fn(&TextureRef) -> f32) -> Vec4 {
        self.textures[texture.image as usize].sample(texture, uv, level(texture))
    }

    /// The level of mips at which a texel of a texture is as wide as a footprint on a triangle.
    fn level_of(
        &self,
        [a, b, c]: [DVec3; 3],
        vertices: &[Vertex; 3],
        footprint_m: f64,
    ) -> impl Fn(&TextureRef) -> f32 {
        let area_m2 = (b - a).cross(c - a).length();
        let [uv_a, uv_b, uv_c] = vertices.map(|v| Vec2::from(v.uv));
        let uv_area = (uv_b - uv_a).perp_dot(uv_c - uv_a).abs();
        move |texture| {
            let scale = texture.uv_transform.matrix2.determinant().abs();
            let texels = uv_area * scale * self.textures[texture.image as usize].texel_count();
            let per_metre = (f64::from(texels) / area_m2).sqrt();
            // A footprint of 0 is at the finest level.
            (footprint_m * per_metre).max(1.0).log2() as f32
        }
    }
}

/// How far rays start off a position that was seen from a distance, metres.
fn offset(position: DVec3, distance_m: f64) -> f64 {
    RAY_OFFSET * position.abs().max_element().max(distance_m)
}

/// The normal or its opposite, on the side of a direction.
fn towards(normal: DVec3, direction: DVec3) -> DVec3 {
    if normal.dot(direction) < 0.0 { -normal } else { normal }
}

/// A vertex attribute at a hit.
fn interpolate<A, V>(corners: [A; 3], weights: [f64; 2], vector: impl Fn(A) -> V) -> V
where
    V: std::ops::Mul<f32, Output = V> + std::ops::Add<Output = V>,
{
    let [wb, wc] = weights.map(|w| w as f32);
    let [a, b, c] = corners.map(vector);
    a * (1.0 - wb - wc) + b * wb + c * wc
}
