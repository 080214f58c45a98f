//! Finds the nearest and farthest surfaces that a view shows.
//!
//! No thin surface can be missed: every triangle that may lie in the view is clipped to its window,
//! and the depths of the remaining part count. Back faces count only where they are drawn. Holes of
//! masked materials count as surface.
//!
//! Cost: one pass over all triangles. If only near surfaces are asked for, boxes rule out whole
//! meshes and most triangles. A path of 1,200 poses is processed in batches of 32 neighbouring
//! views.

use assign::{Projection, View};
use glam::{DMat4, DVec2, DVec3, DVec4, Vec3};
use rayon::prelude::*;

use crate::{Aabb, Instance, Scene};

/// The number of views whose common box is tested first.
const TOGETHER: usize = 32;

/// View depths, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DepthSpan {
    /// The depth of the nearest surface.
    pub nearest_m: f64,
    /// The depth of the farthest surface.
    pub farthest_m: f64,
}

impl DepthSpan {
    /// The span that contains both.
    #[must_use]
    pub fn union(self, other: Self) -> Self {
        Self {
            nearest_m: self.nearest_m.min(other.nearest_m),
            farthest_m: self.farthest_m.max(other.farthest_m),
        }
    }
}

impl Scene {
    /// The smallest view depth at which one of the views shows a surface, if it is below `below_m`.
    /// Near and far planes of the views are ignored.
    pub fn nearest_shown_m(&self, views: &[View], below_m: f32) -> Option<f64> {
        let windows: Vec<Window> =
            views.iter().map(|view| Window::new(view, Some(below_m))).collect();
        let span = self.span_of(&windows)?;
        (span.nearest_m < f64::from(below_m)).then_some(span.nearest_m)
    }

    /// The view depths of all surfaces in the view's window; `None` if it shows none. Near and far
    /// plane are ignored.
    pub fn depths_shown(&self, view: &View) -> Option<DepthSpan> {
        self.span_of(&[Window::new(view, None)])
    }

    fn span_of(&self, windows: &[Window]) -> Option<DepthSpan> {
        let groups: Vec<(Aabb, &[Window])> = windows
            .chunks(TOGETHER)
            .map(|group| (group.iter().map(|w| w.reach).fold(Aabb::EMPTY, Aabb::union), group))
            .collect();
        let spans = self.instances.par_iter().filter_map(|instance| self.span(instance, &groups));
        spans.reduce_with(DepthSpan::union)
    }

    fn span(&self, instance: &Instance, groups: &[(Aabb, &[Window])]) -> Option<DepthSpan> {
        let mesh = &self.meshes[instance.mesh as usize];
        let model = &self.models[instance.model as usize];
        let to_world = model.object_to_world;
        let place = mesh.bounds.transformed(&to_world);
        let near = |group: &&(Aabb, &[Window])| touches(&place, &group.0);
        let groups: Vec<_> = groups.iter().filter(near).collect();
        if groups.is_empty() {
            return None;
        }
        let is_double = self.materials[mesh.material as usize].double_sided;
        let mirrored = model.is_mirrored();
        let mut polygon = Polygon::default();
        let mut span: Option<DepthSpan> = None;
        for triangle in mesh.triangles() {
            let mut corners = triangle.map(|corner| to_world.transform_point3(corner));
            if mirrored {
                corners.swap(1, 2);
            }
            let place = Aabb::from_points(corners);
            for (around, windows) in &groups {
                if !touches(&place, around) {
                    continue;
                }
                for window in windows.iter().filter(|window| touches(&place, &window.reach)) {
                    let shown = window.depths(corners, is_double, &mut polygon);
                    span = match (span, shown) {
                        (Some(a), Some(b)) => Some(a.union(b)),
                        (a, b) => a.or(b),
                    };
                }
            }
        }
        span
    }
}

fn touches(a: &Aabb, b: &Aabb) -> bool {
    a.min.cmple(b.max).all() && b.min.cmple(a.max).all()
}

/// The window of a view, unbounded in depth.
struct Window {
    /// Maps to the eye's space, in which z is the depth in front of the eye.
    to_view: DMat4,
    /// A point is inside where `dot(plane, (x, y, depth, 1)) >= 0`.
    planes: [DVec4; 5],
    perspective: bool,
    /// The box around the visible region, world space.
    reach: Aabb,
}

impl Window {
    /// The region up to a view depth, or without a limit.
    fn new(view: &View, below_m: Option<f32>) -> Self {
        let (perspective, min, max) = match view.projection {
            Projection::Perspective { min, max } => (true, min.as_dvec2(), max.as_dvec2()),
            Projection::Orthographic { min, max } => (false, min.as_dvec2(), max.as_dvec2()),
        };
        let (min, max) = (min.min(max), min.max(max));
        // A side at `edge` metres, or at `edge` metres for each metre of depth.
        let side = |axis: DVec2, sign: f64, edge: f64| match perspective {
            true => DVec4::new(sign * axis.x, sign * axis.y, -sign * edge, 0.0),
            false => DVec4::new(sign * axis.x, sign * axis.y, 0.0, -sign * edge),
        };
        let planes = [
            side(DVec2::X, 1.0, min.x),
            side(DVec2::X, -1.0, max.x),
            side(DVec2::Y, 1.0, min.y),
            side(DVec2::Y, -1.0, max.y),
            DVec4::Z,
        ];
        let world_to_view = view.world_to_view.as_dmat4();
        let reach = below_m.map_or(Aabb::new(Vec3::NEG_INFINITY, Vec3::INFINITY), |below_m| {
            let to_world = world_to_view.inverse();
            let corner = |ix: usize, depth: f64| {
                let x = if ix & 1 == 0 { min.x } else { max.x };
                let y = if ix & 2 == 0 { min.y } else { max.y };
                let footprint = if perspective { depth } else { 1.0 };
                let at = DVec3::new(x * footprint, y * footprint, -depth);
                to_world.transform_point3(at).as_vec3()
            };
            let ends = [0.0, f64::from(below_m)];
            let corners = ends.into_iter().flat_map(|depth| (0..4).map(move |ix| (ix, depth)));
            let exact = Aabb::from_points(corners.map(|(ix, depth)| corner(ix, depth)));
            // A margin for the rounding of f32.
            exact.grown(f32::EPSILON * 4.0 * exact.max.abs().max(exact.min.abs()).max_element())
        });
        let depth = DMat4::from_scale(DVec3::new(1.0, 1.0, -1.0));
        Self { to_view: depth * world_to_view, planes, perspective, reach }
    }

    /// The depths of the part of a triangle that lies in the window.
    fn depths(
        &self,
        corners: [Vec3; 3],
        is_double: bool,
        polygon: &mut Polygon,
    ) -> Option<DepthSpan> {
        let [a, b, c] = corners.map(|corner| self.to_view.transform_point3(corner.as_dvec3()));
        // Reversing z mirrors the triangle: the front is where the normal points away from the eye.
        let normal = (b - a).cross(c - a);
        let towards = if self.perspective { normal.dot(a) } else { normal.z };
        if !is_double && towards <= 0.0 {
            return None;
        }
        polygon.corners.clear();
        polygon.corners.extend([a, b, c]);
        for plane in self.planes {
            polygon.clip(plane);
        }
        // A corner on the plane of the eye may round to behind it.
        let depths = polygon.corners.iter().map(|corner| corner.z.max(0.0));
        let at = |depth| DepthSpan { nearest_m: depth, farthest_m: depth };
        depths.map(at).reduce(DepthSpan::union)
    }
}

/// A convex polygon that is clipped by planes (Sutherland and Hodgman 1974).
#[derive(Default)]
struct Polygon {
    corners: Vec<DVec3>,
    kept: Vec<DVec3>,
}

impl Polygon {
    /// Keeps the side on which the plane is not negative.
    fn clip(&mut self, plane: DVec4) {
        self.kept.clear();
        let count = self.corners.len();
        for ix in 0..count {
            let (from, to) = (self.corners[ix], self.corners[(ix + 1) % count]);
            let (at_from, at_to) = (plane.dot(from.extend(1.0)), plane.dot(to.extend(1.0)));
            if at_from >= 0.0 {
                self.kept.push(from);
            }
            if (at_from < 0.0) != (at_to < 0.0) {
                self.kept.push(from.lerp(to, at_from / (at_from - at_to)));
            }
        }
        std::mem::swap(&mut self.corners, &mut self.kept);
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec2;

    use super::*;
    use crate::{CameraPath, Pose};

    /// A floor of 200 m whose front faces up.
    fn floor() -> Scene {
        let mut scene = crate::atrium(1);
        let corner = |x: f32, z: f32| crate::Vertex {
            position: [x, 0.0, z],
            normal: [0.0, 1.0, 0.0],
            ..Default::default()
        };
        let (near, far) = (-100.0, 100.0);
        let mut mesh = scene.meshes[0].clone();
        mesh.vertices =
            vec![corner(near, near), corner(near, far), corner(far, far), corner(far, near)];
        mesh.indices = vec![0, 1, 2, 0, 2, 3];
        mesh.bounds = Aabb::new(Vec3::new(near, 0.0, near), Vec3::new(far, 0.0, far));
        scene.materials[mesh.material as usize].double_sided = false;
        scene.meshes = vec![mesh];
        scene.models.truncate(1);
        scene.models[0].object_to_world = glam::Mat4::IDENTITY;
        scene.instances = vec![Instance { mesh: 0, model: 0 }];
        scene.path = CameraPath::still(Pose::new(Vec3::Y, Vec3::ZERO));
        scene
    }

    fn view(eye: Vec3, target: Vec3) -> View {
        View::look_at(eye, target, 1.0, 5.0, [160, 90])
    }

    #[test]
    fn the_nearest_ground_is_found_exactly() {
        let scene = floor();
        let nearest = |views: &[View], below| scene.nearest_shown_m(views, below);
        // A level eye 1.6 m above the ground sees it from 1.6 / tan(0.5) on.
        let level = view(Vec3::new(3.0, 1.6, 4.0), Vec3::new(9.0, 1.6, 4.0));
        let expected = 1.6 / 0.5_f64.tan();
        let found = nearest(&[level], 10.0).expect("ground");
        assert!((found - expected).abs() < 1e-5 * expected, "{found} {expected}");
        // Nothing is as near as that, and nothing is visible from below or looking up.
        assert_eq!(nearest(&[level], 2.9), None);
        assert_eq!(nearest(&[view(Vec3::NEG_Y, Vec3::X)], 50.0), None);
        assert_eq!(nearest(&[view(Vec3::Y, Vec3::new(0.0, 9.0, 0.1))], 50.0), None);
        // Of several views the nearest surface counts, in any order.
        let close = view(Vec3::new(0.0, 0.1, 0.0), Vec3::new(0.1, 0.0, 0.0));
        let mut many = vec![level; 70];
        many[51] = close;
        let found = nearest(&many, 10.0).expect("ground");
        assert_eq!(Some(found), nearest(&[close], 10.0));
        assert!(found > 0.05 && found < 0.15, "{found}");
        // The eye lies in the surface.
        let inside = view(Vec3::ZERO, Vec3::new(1.0, -0.1, 0.0));
        assert_eq!(nearest(&[inside], 1.0), None, "the eye is behind its front");
        let mut both = scene.clone();
        both.materials.iter_mut().for_each(|material| material.double_sided = true);
        assert_eq!(both.nearest_shown_m(&[inside], 1.0), Some(0.0));
    }

    #[test]
    fn depths_are_those_of_the_window() {
        let scene = floor();
        let mut down = view(Vec3::new(0.0, 8.0, 0.0), Vec3::ZERO);
        let depths = |view: &View| scene.depths_shown(view).expect("ground");
        let span = depths(&down);
        assert!((span.nearest_m - 8.0).abs() < 1e-5 && (span.farthest_m - 8.0).abs() < 1e-5);
        down.projection = Projection::Orthographic { min: Vec2::splat(-3.0), max: Vec2::ONE };
        let span = depths(&down);
        assert!((span.nearest_m - 8.0).abs() < 1e-5 && (span.farthest_m - 8.0).abs() < 1e-5);
        // The farthest point lies along the axis, at the edge of the window.
        let level = view(Vec3::new(0.0, 1.6, 0.0), Vec3::new(1.0, 1.6, 0.0));
        assert!((depths(&level).farthest_m - 100.0).abs() < 1e-3, "{:?}", depths(&level));
    }
}
