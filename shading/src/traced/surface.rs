//! The surface at a hit, as `material.wesl` computes it, in f64.

use glam::{DMat4, DVec2, DVec3, DVec4, Vec2, Vec4};
use scenes::{Material, TextureRef, Vertex};

use super::{
    TracedScene,
    seen::{SeenFrom, SurfaceSample, offset, towards},
    triangles::Hit,
};
use crate::reference::Surface;

/// A hit's place in the textures of its triangle.
struct Place {
    uv: Vec2,
    /// The differences in uv to two neighbouring pixels.
    steps: [Vec2; 2],
}

impl TracedScene<'_> {
    /// The surface at a hit.
    pub(super) fn surface_at(&self, hit: &Hit, from: &SeenFrom) -> SurfaceSample {
        let direction = from.direction;
        let position = interpolate(self.triangles.corners(hit.triangle), hit.weights);
        let geometric_normal = self.geometric_normal(hit);
        let material = self.material(hit);
        let vertices = self.vertices(hit);
        let place = self.place(hit, &vertices, position, from);
        let (mut metallic, mut roughness) =
            (f64::from(material.metallic), f64::from(material.roughness));
        if let Some(texture) = &material.metallic_roughness_texture {
            let texel = self.texel(texture, &place);
            (roughness, metallic) = (roughness * texel.y, metallic * texel.z);
        }
        let mut emission = material.emissive.as_dvec3();
        if let Some(texture) = &material.emissive_texture {
            emission *= self.texel(texture, &place).truncate();
        }
        let color = self.vertex_color(hit);
        if material.unlit {
            emission *= color.truncate();
        }
        SurfaceSample {
            position,
            surface: Surface {
                base_color: (self.base_color(material, &place) * color).truncate(),
                metallic,
                normal: self.shading_normal(hit, &vertices, direction, &place),
                roughness,
                dielectric: material.dielectric.into(),
            },
            emission,
            to_eye: -direction,
            geometric_normal: towards(geometric_normal, -direction),
            offset_m: offset(position, hit.distance_m),
        }
    }

    /// Opacity at a hit, at the finest level of its texture.
    pub(super) fn opacity(&self, hit: &Hit, material: &Material) -> f32 {
        let uv = interpolate(self.vertices(hit).map(uv_of), hit.weights).as_vec2();
        let color = self.base_color(material, &Place { uv, steps: [Vec2::ZERO; 2] });
        (color.w * self.vertex_color(hit).w) as f32
    }

    /// The colour from the vertices of a hit; white if they have none.
    fn vertex_color(&self, hit: &Hit) -> DVec4 {
        let colors = self.vertex_colors(hit);
        colors.map_or(DVec4::ONE, |colors| {
            interpolate(colors.map(|color| Vec4::from(color).as_dvec4()), hit.weights)
        })
    }

    fn place(&self, hit: &Hit, vertices: &[Vertex; 3], position: DVec3, from: &SeenFrom) -> Place {
        let uvs = vertices.map(uv_of);
        let uv = interpolate(uvs, hit.weights).as_vec2();
        let [a, b, c] = self.triangles.corners(hit.triangle);
        let (ab, ac) = (b - a, c - a);
        let normal = ab.cross(ac);
        // The step from the hit to the point where a neighbour's ray hits the triangle's plane.
        let step = |(origin, direction): (DVec3, DVec3)| {
            let along = normal.dot(a - origin) / normal.dot(direction);
            let offset = origin + direction * along - position;
            let weight = |across: DVec3| across.dot(normal) / normal.length_squared();
            let step = (uvs[1] - uvs[0]) * weight(offset.cross(ac))
                + (uvs[2] - uvs[0]) * weight(ab.cross(offset));
            step.as_vec2()
        };
        Place { uv, steps: from.neighbours.map_or([Vec2::ZERO; 2], |pair| pair.map(step)) }
    }

    fn shading_normal(
        &self,
        hit: &Hit,
        vertices: &[Vertex; 3],
        direction: DVec3,
        place: &Place,
    ) -> DVec3 {
        let record = self.record(hit);
        let normal =
            interpolate(vertices.map(|v| DVec3::from(v.normal.map(f64::from))), hit.weights);
        let columns = [record.normal_x, record.normal_y, record.normal_z]
            .map(|column| DVec3::from(column.map(f64::from)));
        let normal = columns[0] * normal.x + columns[1] * normal.y + columns[2] * normal.z;
        let vertex_normal = normal.normalize_or(-direction);
        let mut normal = vertex_normal;
        let material = self.material(hit);
        if let Some(texture) = &material.normal_texture {
            let mapped = self.texel(texture, place).truncate() * 2.0 - 1.0;
            let scale = f64::from(material.normal_scale);
            let mapped = mapped * DVec3::new(scale, scale, 1.0);
            let tangent =
                interpolate(vertices.map(|v| Vec4::from(v.tangent).as_dvec4()), hit.weights);
            let to_world =
                DMat4::from_cols_array_2d(&record.object_to_world.map(|c| c.map(f64::from)));
            let along = to_world.transform_vector3(tangent.truncate());
            let flat = (along - vertex_normal * vertex_normal.dot(along)).normalize_or_zero();
            let sense = (tangent.w * f64::from(record.handedness)).signum();
            let bitangent = vertex_normal.cross(flat) * sense;
            let turned = flat * mapped.x + bitangent * mapped.y + vertex_normal * mapped.z;
            // A normal map with a zero vector leaves the vertex normal.
            normal = turned.try_normalize().unwrap_or(vertex_normal);
        }
        if self.is_front(hit) { normal } else { -normal }
    }

    fn base_color(&self, material: &Material, place: &Place) -> DVec4 {
        let texel = |texture: &TextureRef| self.texel(texture, place);
        let factor = material.base_color.as_dvec4();
        factor * material.base_color_texture.as_ref().map_or(DVec4::ONE, texel)
    }

    fn texel(&self, texture: &TextureRef, place: &Place) -> DVec4 {
        let image = &self.textures[texture.image as usize];
        image.sample(texture, place.uv, image.level(texture, place.steps)).as_dvec4()
    }
}

fn uv_of(vertex: Vertex) -> DVec2 {
    Vec2::from(vertex.uv).as_dvec2()
}

/// A vertex attribute interpolated at a hit.
fn interpolate<V>([a, b, c]: [V; 3], [wb, wc]: [f64; 2]) -> V
where
    V: std::ops::Mul<f64, Output = V> + std::ops::Add<Output = V>,
{
    a * (1.0 - wb - wc) + b * wb + c * wc
}
