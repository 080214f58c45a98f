//! A scene's triangles for rays: what rays hit, and whether anything lies between two points.

use glam::DVec3;
use scenes::{Material, Mesh, Scene, Vertex};

use super::{
    emissive::{Emission, EmissiveTriangles},
    seen::{SeenFrom, SurfaceSample, offset, towards},
    texture::Texture,
    triangles::{Hit, Triangles},
};
use crate::{
    geometry::{InstanceRecord, record},
    reference::Surface,
};

/// How far from a position rebuilt from depth its triangle is looked for, as a share of the distance from the eye. An H200
/// interpolates the depth of a triangle that is much larger than the view with errors above 2^-12 (`shadows/plan.rs`).
const SEARCH: f64 = 1.0 / (1 << 9) as f64;

/// The triangles of a scene in a hierarchy, with everything that the surface of a hit needs.
pub struct TracedScene<'a> {
    scene: &'a Scene,
    pub(super) triangles: Triangles,
    emissive: EmissiveTriangles,
    /// For each triangle, its instance and its index in the mesh.
    sources: Vec<(u32, u32)>,
    /// For each instance.
    records: Vec<InstanceRecord>,
    /// For each image.
    pub(super) textures: Vec<Texture>,
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
        let mut traced = Self {
            scene,
            triangles: Triangles::new(corners),
            emissive: EmissiveTriangles::default(),
            sources,
            records,
            textures: scene.images.par_iter().map(Texture::new).collect(),
        };
        traced.emissive = traced.find_emissive();
        traced
    }

    fn find_emissive(&self) -> EmissiveTriangles {
        let mut emissive = EmissiveTriangles::default();
        for (triangle, (instance, _)) in (0..).zip(&self.sources) {
            let mesh = self.scene.instances[*instance as usize].mesh;
            let material =
                &self.scene.materials[self.scene.meshes[mesh as usize].material as usize];
            // An unlit surface shows its colour and lights nothing.
            if material.unlit {
                continue;
            }
            let texture = material.emissive_texture.as_ref();
            let texel = texture.map_or(DVec3::ONE, |t| self.textures[t.image as usize].mean());
            let corners = self.triangles.corners(triangle);
            emissive.add(triangle, corners, material.emissive.as_dvec3(), texel);
        }
        emissive.finish();
        emissive
    }

    /// The number of triangles that emit.
    pub fn emissive_count(&self) -> usize {
        self.emissive.count()
    }

    /// Whether nothing lies between the sample and a point.
    pub fn sees(&self, from: &SurfaceSample, point: DVec3) -> bool {
        let origin = from.ray_origin();
        let to_point = point - origin;
        let distance_m = to_point.length();
        let direction = to_point / distance_m.max(f64::MIN_POSITIVE);
        // The light itself may lie on a surface.
        let end_m = distance_m - from.offset_m;
        !self.triangles.any(origin, direction, end_m, |hit| self.is_solid(hit))
    }

    /// Whether a ray from the sample leaves the scene.
    pub fn sees_sky(&self, from: &SurfaceSample, direction: DVec3) -> bool {
        let solid = |hit: &Hit| self.is_solid(hit);
        !self.triangles.any(from.ray_origin(), direction, f64::INFINITY, solid)
    }

    /// The distance along a ray to the first triangle, seen from either side, metres; `None` if
    /// there is none. Holes of alpha masks count as surface, as in deep images.
    pub fn distance_m(&self, origin: DVec3, direction: DVec3) -> Option<f64> {
        let hit = self.triangles.first(origin, direction, f64::INFINITY, |_| true)?;
        Some(hit.distance_m)
    }

    /// The same, with the unit normal of the triangle on the side of the ray's origin.
    pub fn surface(&self, origin: DVec3, direction: DVec3) -> Option<(f64, DVec3)> {
        let hit = self.triangles.first(origin, direction, f64::INFINITY, |_| true)?;
        Some((hit.distance_m, towards(self.geometric_normal(&hit), -direction)))
    }

    /// The first surface that a ray from a sample hits, and the density with which
    /// [`Self::draw_emission`] draws that direction, per steradian. `None` if the ray leaves the
    /// scene, or hits the back of a single-sided surface.
    pub(super) fn bounce(
        &self,
        from: &SurfaceSample,
        direction: DVec3,
    ) -> Option<(SurfaceSample, f64)> {
        let solid = |hit: &Hit| self.is_solid(hit);
        let hit = self.triangles.first(from.ray_origin(), direction, f64::INFINITY, solid)?;
        self.is_drawn(&hit).then(|| {
            let density = self.emission_density(&hit, direction);
            let mut surface = self.surface_at(&hit, &SeenFrom::afar(direction));
            if self.material(&hit).unlit {
                surface.emission = DVec3::ZERO;
            }
            (surface, density)
        })
    }

    /// A point of an emitting triangle, drawn by coordinates in 0..1; `None` if nothing emits, or
    /// not towards the sample. The caller tests whether the sample sees it.
    pub(super) fn draw_emission(
        &self,
        from: &SurfaceSample,
        coordinates: [f64; 3],
    ) -> Option<Emission> {
        let (triangle, weights) = self.emissive.draw(coordinates)?;
        let [a, b, c] = self.triangles.corners(triangle);
        let [wb, wc] = weights;
        let point = a * (1.0 - wb - wc) + b * wb + c * wc;
        let offset = point - from.ray_origin();
        let distance_m = offset.length();
        let direction = offset.try_normalize()?;
        let is_front = (b - a).cross(c - a).dot(direction) < 0.0;
        let hit = Hit { triangle, distance_m, weights, is_front };
        let density = self.emission_density(&hit, direction);
        let is_lit = self.is_drawn(&hit) && self.is_solid(&hit) && density.is_finite();
        is_lit.then(|| {
            let radiance = self.surface_at(&hit, &SeenFrom::afar(direction)).emission;
            Emission { point, direction, radiance, density }
        })
    }

    /// The density with which a hit is drawn as an emitting point, per steradian.
    fn emission_density(&self, hit: &Hit, direction: DVec3) -> f64 {
        let per_m2 = self.emissive.density(hit.triangle);
        if per_m2 == 0.0 {
            return 0.0;
        }
        per_m2 * hit.distance_m.powi(2) / self.geometric_normal(hit).dot(direction).abs()
    }

    /// A sample of a known surface. Its triangle is the first one found near the position on the line of
    /// sight. Rays start in front of this triangle, also where depth was rounded to a place behind it. If none is found, the
    /// shading normal replaces the geometric one.
    pub(super) fn seen_sample(
        &self,
        position: DVec3,
        surface: Surface,
        eye: DVec3,
        to_eye: DVec3,
    ) -> SurfaceSample {
        let distance_m = eye.distance(position);
        let offset_m = offset(position, distance_m);
        let search_m = (SEARCH * distance_m).max(8.0 * offset_m);
        let origin = position + to_eye * search_m;
        let solid = |hit: &Hit| self.is_solid(hit) && self.is_drawn(hit);
        let hit = self.triangles.first(origin, -to_eye, 2.0 * search_m, solid);
        let normal = hit.as_ref().map_or(surface.normal, |hit| self.geometric_normal(hit));
        let normal = towards(normal, to_eye);
        let in_front_m = hit.map_or(0.0, |hit| search_m - hit.distance_m);
        let behind_m = (to_eye * in_front_m).dot(normal).max(0.0);
        SurfaceSample {
            position,
            surface,
            emission: DVec3::ZERO,
            to_eye,
            geometric_normal: normal,
            offset_m: offset_m + behind_m,
        }
    }

    pub(super) fn material(&self, hit: &Hit) -> &'a Material {
        &self.scene.materials[self.mesh(hit).material as usize]
    }

    fn mesh(&self, hit: &Hit) -> &'a Mesh {
        let instance = self.scene.instances[self.sources[hit.triangle as usize].0 as usize];
        &self.scene.meshes[instance.mesh as usize]
    }

    pub(super) fn record(&self, hit: &Hit) -> &InstanceRecord {
        &self.records[self.sources[hit.triangle as usize].0 as usize]
    }

    /// The vertices of a hit's triangle, object space.
    pub(super) fn vertices(&self, hit: &Hit) -> [Vertex; 3] {
        let mesh = self.mesh(hit);
        let first = 3 * self.sources[hit.triangle as usize].1 as usize;
        [0, 1, 2].map(|corner| mesh.vertices[mesh.indices[first + corner] as usize])
    }

    /// The colours of a hit's vertices; `None` if its mesh has none.
    pub(super) fn vertex_colors(&self, hit: &Hit) -> Option<[[f32; 4]; 3]> {
        let mesh = self.mesh(hit);
        let first = 3 * self.sources[hit.triangle as usize].1 as usize;
        let color = |corner| mesh.colors[mesh.indices[first + corner] as usize];
        (!mesh.colors.is_empty()).then(|| [0, 1, 2].map(color))
    }

    /// Whether the front is hit. A mirrored model reverses the winding of its triangles.
    pub(super) fn is_front(&self, hit: &Hit) -> bool {
        hit.is_front == (self.record(hit).handedness > 0.0)
    }

    /// Whether the side that is hit is drawn.
    pub(super) fn is_drawn(&self, hit: &Hit) -> bool {
        self.material(hit).double_sided || self.is_front(hit)
    }

    /// Whether a hit is not a hole of an alpha mask.
    pub(super) fn is_solid(&self, hit: &Hit) -> bool {
        let material = self.material(hit);
        let Some(cutoff) = material.alpha_cutoff else { return true };
        self.opacity(hit, material) >= cutoff
    }

    pub(super) fn geometric_normal(&self, hit: &Hit) -> DVec3 {
        let [a, b, c] = self.triangles.corners(hit.triangle);
        (b - a).cross(c - a).normalize_or(DVec3::Y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reference::Reflectance;

    /// GPUs round the depth of large triangles to places a little behind them.
    #[test]
    fn a_position_a_little_behind_its_surface_sees_what_the_surface_sees() {
        let scene = scenes::open("atrium").expect("the built-in scene");
        let traced = TracedScene::new(&scene);
        let eye = DVec3::new(0.0, 2.0, 1.0);
        let direction = DVec3::new(0.05, -0.9, 0.1).normalize();
        let (distance_m, normal) = traced.surface(eye, direction).expect("a floor");
        let surface = Surface {
            base_color: DVec3::ONE,
            metallic: 0.0,
            normal,
            roughness: 1.0,
            dielectric: Reflectance::default(),
        };
        let sees = |behind: f64| {
            let position = eye + direction * distance_m * (1.0 + behind);
            let sample = traced.seen_sample(position, surface, eye, -direction);
            traced.sees(&sample, eye)
        };
        assert!(sees(0.0) && sees(1e-3) && sees(-1e-3));
        assert!(!sees(1e-2), "nothing this far behind a surface is on it");
    }
}
