//! Rays and distances against a scene's triangles. obvhs traverses the hierarchy.

use glam::Vec3;
use obvhs::{
    Boundable,
    bvh2::Bvh2,
    ray::{Ray, RayHit},
    triangle::Triangle,
};

use crate::{Aabb, BuildEffort, DistinctTriangles, Scene, build_hierarchy};

/// The most triangles of a hierarchy. Each takes 64 bytes while it is built.
const MAX_TRIANGLES: u64 = 4_000_000;

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hit {
    /// Distance along the ray, metres.
    pub(crate) distance_m: f32,
    /// Whether the ray came from behind the triangle.
    pub(crate) is_back: bool,
}

/// A bounding volume hierarchy over world-space triangles.
pub(crate) struct TriangleBvh {
    bvh: Bvh2,
    /// The triangles in the hierarchy's order, so that its leaves index them directly.
    triangles: Vec<Triangle>,
}

impl TriangleBvh {
    /// Builds it over the triangles that touch `region`: all of them in scenes of up to
    /// [`MAX_TRIANGLES`], otherwise at most that many, the largest first. Repeats and triangles
    /// without area are left out.
    pub(crate) fn new(scene: &Scene, region: Aabb) -> Self {
        let chosen = choose(scene, region, MAX_TRIANGLES);
        let convert = |[a, b, c]: [Vec3; 3]| Triangle { v0: a.into(), v1: b.into(), v2: c.into() };
        let firsts = DistinctTriangles::find(&chosen).firsts;
        let triangles: Vec<_> = firsts.iter().map(|ix| convert(chosen[*ix as usize])).collect();
        let boxes: Vec<_> = triangles.iter().map(Boundable::aabb).collect();
        let bvh = build_hierarchy(&boxes, BuildEffort::Fast);
        let order = bvh.primitive_indices.iter();
        let triangles = order.map(|&ix| triangles[ix as usize]).collect();
        Self { bvh, triangles }
    }

    /// The first triangle along the unit `direction`; `None` when there is none within `max_m`.
    pub(crate) fn cast(&self, origin: Vec3, direction: Vec3, max_m: f32) -> Option<Hit> {
        if self.triangles.is_empty() {
            return None;
        }
        let ray = Ray::new(origin.into(), direction.into(), 0.0, max_m);
        let mut hit = RayHit::none();
        self.bvh.ray_traverse(ray, &mut hit, |ray, ix| self.triangles[ix].intersect(ray));
        // Where nothing is hit, obvhs returns an invalid id but not an infinite distance.
        let normal = self.triangles.get(hit.primitive_id as usize)?.compute_normal();
        Some(Hit { distance_m: hit.t, is_back: Vec3::from(normal).dot(direction) > 0.0 })
    }

    /// Distance from `point` to the nearest triangle, at most `max_m`.
    pub(crate) fn clearance(&self, point: Vec3, max_m: f32) -> f32 {
        let around = Aabb::new(point, point).grown(max_m);
        let around = obvhs::aabb::Aabb::new(around.min.into(), around.max.into());
        let mut nearest = max_m;
        self.bvh.aabb_traverse(around, |bvh, node_ix| {
            let node = &bvh.nodes[node_ix as usize];
            let leaf = node.first_index..node.first_index + node.prim_count;
            for triangle in &self.triangles[leaf.start as usize..leaf.end as usize] {
                nearest = nearest.min(distance_to_triangle(point, triangle));
            }
            true
        });
        nearest
    }
}

/// The triangles that touch `region`. In a scene of more than `most`, about half of that number are
/// the scene's largest triangles: walls and floors, on which views and loops depend most. The rest
/// are chosen evenly among the others.
fn choose(scene: &Scene, region: Aabb, most: u64) -> Vec<[Vec3; 3]> {
    let touching =
        scene.world_triangles().filter(|t| !Aabb::from_points(*t).intersection(region).is_empty());
    let count = scene.triangle_count();
    if count <= most {
        return touching.collect();
    }
    let half = most / 2;
    let step = count.div_ceil(half);
    // The size that about `half` of all triangles exceed, estimated from a sample.
    let mut areas: Vec<f32> = scene.sampled_triangles(half).map(double_area).collect();
    let rank = areas.len() - 1 - areas.len() / step as usize;
    let limit = *areas.select_nth_unstable_by(rank, f32::total_cmp).1;
    let (mut large, mut others) = (0, 0);
    touching
        .filter(|&triangle| {
            // The sample may mislead, so never take more than `half`.
            if large < half && double_area(triangle) > limit {
                large += 1;
                return true;
            }
            others += 1;
            (others - 1) % step == 0
        })
        .collect()
}

fn double_area([a, b, c]: [Vec3; 3]) -> f32 {
    (b - a).cross(c - a).length()
}

/// Distance from a point to a triangle (Ericson, Real-Time Collision Detection, 5.1.5).
fn distance_to_triangle(p: Vec3, triangle: &Triangle) -> f32 {
    let [a, b, c] = [triangle.v0, triangle.v1, triangle.v2].map(Vec3::from);
    let normal = (b - a).cross(c - a);
    let inside = [(a, b), (b, c), (c, a)]
        .iter()
        .all(|(from, to)| normal.cross(*to - *from).dot(p - *from) >= 0.0);
    if inside && normal != Vec3::ZERO {
        return (normal.normalize().dot(p - a)).abs();
    }
    [(a, b), (b, c), (c, a)]
        .iter()
        .map(|&(from, to)| {
            let edge = to - from;
            let t = (p - from).dot(edge) / edge.length_squared().max(f32::MIN_POSITIVE);
            p.distance(from + edge * t.clamp(0.0, 1.0))
        })
        .fold(f32::INFINITY, f32::min)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn large_scenes_keep_their_largest_triangles() {
        let scene = crate::atrium(1);
        let all = choose(&scene, scene.bounds, u64::MAX);
        assert_eq!(all.len() as u64, scene.triangle_count());
        let largest = |list: &[[Vec3; 3]]| list.iter().map(|t| double_area(*t)).fold(0.0, f32::max);
        for most in [1000, 100, 10] {
            let few = choose(&scene, scene.bounds, most);
            assert!(few.len() as u64 <= most && few.len() as u64 > most / 4, "{}", few.len());
            assert_eq!(largest(&few), largest(&all));
        }
    }

    #[test]
    fn distance_to_face_edge_and_corner() {
        let triangle = Triangle { v0: Vec3::ZERO.into(), v1: Vec3::X.into(), v2: Vec3::Y.into() };
        let distance = |x, y, z| distance_to_triangle(Vec3::new(x, y, z), &triangle);
        assert_eq!(distance(0.2, 0.2, -3.0), 3.0);
        assert_eq!(distance(0.5, -2.0, 0.0), 2.0);
        assert_eq!(distance(4.0, -4.0, 0.0), 5.0);
    }
}
