//! Rays against triangles: the one module that traces rays with obvhs.
//!
//! The hierarchy is traversed in single precision, over boxes a little larger than their triangles.
//! The triangles themselves are intersected in double precision. So shadow edges lie where the
//! vertices put them, and no ray slips between two triangles that share an edge.

use glam::{DVec3, Vec3};
use obvhs::{
    aabb::Aabb,
    bvh2::Bvh2,
    ray::{Ray, RayHit},
};
use scenes::{BuildEffort, DistinctTriangles, build_hierarchy};

/// How much larger boxes are than triangles, as a share of the largest coordinate: eight units in
/// the last place, for the rounding of traversal and of the ray's origin.
const BOX_SLACK: f32 = 8.0 * f32::EPSILON;

/// Where a ray hits a triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Hit {
    /// Index of the triangle.
    pub(super) triangle: u32,
    /// Distance along the ray, metres.
    pub(super) distance_m: f64,
    /// Weights of the second and the third corner.
    pub(super) weights: [f64; 2],
    /// Whether the ray came from the side on which the corners are counter-clockwise.
    pub(super) is_front: bool,
}

/// A hierarchy over triangles.
pub(super) struct Triangles {
    /// It contains one of each set of equal triangles.
    bvh: Bvh2,
    distinct: DistinctTriangles,
    corners: Vec<[Vec3; 3]>,
}

impl Triangles {
    /// Builds it over world-space corners, metres.
    pub(super) fn new(corners: Vec<[Vec3; 3]>) -> Self {
        let farthest = corners.iter().flatten().fold(0.0_f32, |m, v| m.max(v.abs().max_element()));
        let slack = farthest * BOX_SLACK;
        let distinct = DistinctTriangles::find(&corners);
        let firsts = distinct.firsts.iter();
        let boxes: Vec<Aabb> = firsts
            .map(|ix| {
                let [a, b, c] = corners[*ix as usize];
                Aabb::new((a.min(b).min(c) - slack).into(), (a.max(b).max(c) + slack).into())
            })
            .collect();
        Self { bvh: build_hierarchy(&boxes, BuildEffort::Thorough), distinct, corners }
    }

    /// World-space corners of a triangle.
    pub(super) fn corners(&self, triangle: u32) -> [DVec3; 3] {
        self.corners[triangle as usize].map(Vec3::as_dvec3)
    }

    /// The first hit along a unit direction before `max_m` that `counts`. Of two hits at the same
    /// distance, the one of the lower index wins, so the shape of the hierarchy does not matter.
    pub(super) fn first(
        &self,
        origin: DVec3,
        direction: DVec3,
        max_m: f64,
        counts: impl Fn(&Hit) -> bool,
    ) -> Option<Hit> {
        let mut first: Option<Hit> = None;
        let ray = ray(origin, direction, max_m)?;
        self.bvh.ray_traverse(ray, &mut RayHit::none(), |_, leaf| {
            let nearer = |hit: &Hit| {
                first.is_none_or(|f| (hit.distance_m, hit.triangle) < (f.distance_m, f.triangle))
            };
            let hit = self.intersect(self.triangle_of(leaf), origin, direction, max_m);
            let mut same = self.all_like(hit);
            match same.find(|hit| !nearer(hit) || counts(hit)).filter(nearer) {
                Some(hit) => {
                    first = Some(hit);
                    (hit.distance_m as f32).next_up()
                }
                None => f32::INFINITY,
            }
        });
        first
    }

    /// Whether any hit before `max_m` counts.
    pub(super) fn any(
        &self,
        origin: DVec3,
        direction: DVec3,
        max_m: f64,
        counts: impl Fn(&Hit) -> bool,
    ) -> bool {
        let Some(ray) = ray(origin, direction, max_m) else { return false };
        !self.bvh.ray_traverse_miss(ray, |_, leaf| {
            let hit = self.intersect(self.triangle_of(leaf), origin, direction, max_m);
            // Any hit before the ray's end ends the search.
            if self.all_like(hit).any(|hit| counts(&hit)) { 0.0 } else { f32::INFINITY }
        })
    }

    /// The triangle of a leaf; of equal triangles, the one with the lowest index.
    fn triangle_of(&self, leaf: usize) -> u32 {
        self.distinct.firsts[self.bvh.primitive_indices[leaf] as usize]
    }

    /// A hit, and the same hit of every equal triangle, in ascending order.
    fn all_like(&self, hit: Option<Hit>) -> impl Iterator<Item = Hit> {
        std::iter::successors(hit, |hit| {
            self.distinct.next(hit.triangle).map(|triangle| Hit { triangle, ..*hit })
        })
    }

    /// Intersects from either side. The volumes between ray and edges are those of Woop et al. 2013
    /// (section 3.2), without the shear. Triangles on both sides of an edge compute the same number
    /// with opposite signs, so no ray slips between them.
    fn intersect(&self, triangle: u32, origin: DVec3, direction: DVec3, max_m: f64) -> Option<Hit> {
        let [a, b, c] = self.corners(triangle);
        let normal = (b - a).cross(c - a);
        let [a, b, c] = [a - origin, b - origin, c - origin];
        let volumes = [b.cross(c), c.cross(a), a.cross(b)].map(|across| direction.dot(across));
        let inside = volumes.iter().all(|v| *v >= 0.0) || volumes.iter().all(|v| *v <= 0.0);
        let sum: f64 = volumes.iter().sum();
        // Comparisons with NaN are false, so edge-on triangles are missed.
        let distance_m = normal.dot(a) / normal.dot(direction);
        let is_hit = inside && sum != 0.0 && distance_m > 0.0 && distance_m < max_m;
        is_hit.then(|| Hit {
            triangle,
            distance_m,
            weights: [volumes[1] / sum, volumes[2] / sum],
            is_front: normal.dot(direction) < 0.0,
        })
    }
}

/// The ray in single precision; `None` if it is not finite.
fn ray(origin: DVec3, direction: DVec3, max_m: f64) -> Option<Ray> {
    let (origin, direction) = (origin.as_vec3a(), direction.as_vec3a());
    let sound = origin.is_finite() && direction.is_finite() && max_m > 0.0;
    sound.then(|| Ray::new(origin, direction, 0.0, (max_m as f32).next_up()))
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_pcg::Pcg64Mcg;

    use super::*;

    fn random(rng: &mut Pcg64Mcg) -> DVec3 {
        DVec3::new(rng.random(), rng.random(), rng.random()) * 2.0 - 1.0
    }

    #[test]
    fn the_hierarchy_finds_what_a_loop_finds() {
        let mut rng = Pcg64Mcg::seed_from_u64(1);
        let corner = |rng: &mut Pcg64Mcg, at: DVec3| (at * 5.0 + random(rng)).as_vec3();
        let corners = (0..400)
            .map(|_| {
                let at = random(&mut rng);
                [corner(&mut rng, at), corner(&mut rng, at), corner(&mut rng, at)]
            })
            .collect();
        let triangles = Triangles::new(corners);
        let mut hits = 0;
        for _ in 0..2000 {
            let (origin, direction) = (random(&mut rng) * 6.0, random(&mut rng).normalize());
            // Every third triangle lets the ray through.
            let counts = |hit: &Hit| !hit.triangle.is_multiple_of(3);
            let looped = (0..400)
                .filter_map(|ix| triangles.intersect(ix, origin, direction, 5.0))
                .filter(counts)
                .min_by(|a, b| a.distance_m.total_cmp(&b.distance_m));
            assert_eq!(triangles.first(origin, direction, 5.0, counts), looped);
            assert_eq!(triangles.any(origin, direction, 5.0, counts), looped.is_some());
            hits += usize::from(looped.is_some());
        }
        assert!((200..1500).contains(&hits), "{hits}");
    }

    /// The hierarchy contains one of the equal triangles, and all of them can be hit.
    #[test]
    fn coincident_triangles_take_seconds_and_hit_in_ascending_order() {
        let mut corners = vec![[Vec3::ZERO; 3]; 100_000];
        corners.extend(vec![[Vec3::ZERO, Vec3::X, Vec3::Y]; 200_000]);
        // A pile of triangles that differ by less than the growth of their boxes.
        corners.extend((1..100_000).map(|ix| {
            let away = Vec3::Z * (-1e-6 * ix as f32);
            [away, Vec3::X + away, Vec3::Y + away]
        }));
        let start = std::time::Instant::now();
        let triangles = Triangles::new(corners);
        let origin = DVec3::new(0.2, 0.2, 1.0);
        for least in [0, 100_000, 250_000, 299_999] {
            let counts = |hit: &Hit| hit.triangle >= least;
            let hit = triangles.first(origin, DVec3::NEG_Z, 2.0, counts).expect("hit");
            assert_eq!((hit.triangle, hit.distance_m), (least.max(100_000), 1.0));
            assert!(triangles.any(origin, DVec3::NEG_Z, 2.0, counts));
            assert!(!triangles.any(origin, DVec3::NEG_Z, 0.5, counts));
        }
        let seconds = start.elapsed().as_secs_f64();
        println!("{seconds:.2} s");
        assert!(seconds < 30.0, "{seconds} s");
    }

    #[test]
    fn nothing_slips_through_an_edge_and_odd_rays_hit_nothing() {
        let corner = |x, z| Vec3::new(x, 0.3, z);
        let (a, b, c, d) =
            (corner(-0.7, -0.9), corner(0.8, -0.7), corner(0.9, 1.1), corner(-1.0, 0.8));
        let triangles = Triangles::new(vec![[a, b, c], [a, c, d]]);
        for step in 1..1000 {
            // Onto the diagonal shared by both.
            let target = a.as_dvec3().lerp(c.as_dvec3(), f64::from(step) / 1000.0);
            let origin = DVec3::new(0.1, 2.0, -0.4);
            let direction = (target - origin).normalize();
            assert!(triangles.first(origin, direction, 9.0, |_| true).is_some(), "{step}");
        }
        assert!(!triangles.any(DVec3::NAN, DVec3::Y, 1.0, |_| true));
        assert!(Triangles::new(vec![]).first(DVec3::ZERO, DVec3::Y, 1.0, |_| true).is_none());
    }
}
