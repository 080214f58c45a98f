//! A view made from matrices shows each point where the matrices show it.

use assign::{DepthMapping, Projection, View, ViewError, Viewport};
use glam::{DVec2, DVec3, DVec4, Mat4, Vec3, Vec4};
use proptest::prelude::*;

use crate::views::{oblique, plain, point_view, window_of};

const EPSILON: f64 = f32::EPSILON as f64;

/// What another renderer does differently.
#[derive(Clone, Copy, Debug)]
struct Engine {
    /// Looks along +Z.
    backwards: bool,
    /// View space is mirrored, as behind a planar mirror.
    mirrored: bool,
    /// Clip y points down.
    y_down: bool,
    /// The image is turned by a quarter.
    quarter: bool,
    /// Clip depth runs from -1 to 1.
    is_gl: bool,
    /// w in units of view depth, or of 1.
    w: f32,
}

fn engine() -> impl Strategy<Value = Engine> {
    let w = prop_oneof![3 => Just(1.0_f32), 1 => Just(0.25_f32), 1 => Just(8.0_f32)];
    (prop::array::uniform5(any::<bool>()), w).prop_map(
        |([backwards, mirrored, y_down, quarter, is_gl], w)| Engine {
            backwards,
            mirrored,
            y_down,
            quarter,
            is_gl,
            w,
        },
    )
}

impl Engine {
    /// The engine's `world_to_view` and `view_to_clip` of a view.
    fn matrices(self, view: &View) -> [Mat4; 2] {
        let sign = |flips: bool| if flips { -1.0 } else { 1.0 };
        let axes = Vec3::new(sign(self.mirrored), 1.0, sign(self.backwards));
        let mut turn = Mat4::from_scale(axes);
        if self.quarter {
            turn = Mat4::from_cols(Vec4::Y, Vec4::X, Vec4::Z, Vec4::W) * turn;
        }
        let mut rows = (view.view_to_clip() * turn.transpose()).transpose();
        rows.y_axis *= sign(self.y_down);
        if self.is_gl {
            rows.z_axis = 2.0 * rows.z_axis - rows.w_axis;
        }
        [turn * view.world_to_view, self.w * rows.transpose()]
    }

    fn view(self, view: &View) -> Result<View, ViewError> {
        let [world_to_view, view_to_clip] = self.matrices(view);
        let make = if self.is_gl { View::from_gl_matrices } else { View::from_matrices };
        make(world_to_view, view_to_clip, view.viewport)
    }
}

/// A view of any kind, and a place in it.
fn seen() -> impl Strategy<Value = (View, [f64; 3])> {
    let view = prop_oneof![2 => plain(), 1 => oblique().prop_map(|(view, _)| view)];
    (view, prop::array::uniform3(0.0_f64..1.0))
}

/// The world-space point at a place in the view that it shows.
fn point(view: &View, [u, v, share]: [f64; 3]) -> Option<DVec3> {
    let [min, max] = window_of(view);
    let window = min + (max - min) * DVec2::new(u, v);
    let (near_m, far_m) = view.shown_m(window)?;
    let far_m = far_m.min(1e3 * near_m.max(0.1));
    let depth_m = near_m + share * (far_m - near_m);
    Some(
        view.world_to_view.as_dmat4().inverse().transform_point3(point_view(view, window, depth_m)),
    )
}

fn clip(world_to_view: Mat4, view_to_clip: Mat4, point: DVec3) -> DVec3 {
    let clip: DVec4 = view_to_clip.as_dmat4() * (world_to_view.as_dmat4() * point.extend(1.0));
    clip.truncate() / clip.w
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    /// Its own matrices give a view again: world_to_view and the row of clip depth bit for bit, the rest to a few
    /// units in the last place.
    #[test]
    fn a_view_survives_its_own_matrices((view, _) in seen()) {
        let made = View::from_matrices(view.world_to_view, view.view_to_clip(), view.viewport).unwrap();
        prop_assert_eq!(made.world_to_view, view.world_to_view);
        prop_assert_eq!(made.view_to_clip().row(2), view.view_to_clip().row(2));
        prop_assert_eq!(made.view_to_clip().row(3), view.view_to_clip().row(3));
        prop_assert_eq!((made.depth, made.viewport), (view.depth, view.viewport));
        prop_assert_eq!(made.is_mirrored(), view.is_mirrored());
        let (window, wanted) = (window_of(&made), window_of(&view));
        let size = wanted[0].abs().max(wanted[1].abs()).max_element();
        for (corner, wanted) in window.into_iter().zip(wanted) {
            let off = (corner - wanted).abs().max_element();
            prop_assert!(off <= 4.0 * EPSILON * size, "{} {} {}", corner, wanted, off / size / EPSILON);
        }
        // Jitter moves the window, in which an oblique plane has its nearest point.
        if view.depth_row.is_none() {
            let far = |view: &View| view.far_m.map_or(f64::INFINITY, f64::from);
            let [near, other] = [&view, &made].map(|view| f64::from(view.near_m));
            let (off, allowed) = match view.projection {
                Projection::Perspective { .. } => (
                    ((1.0 / near - 1.0 / other) * near).abs()
                        .max(((1.0 / far(&view) - 1.0 / far(&made)) * near).abs()),
                    4.0 * EPSILON,
                ),
                Projection::Orthographic { .. } => (
                    (near - other).abs().max((far(&view) - far(&made)).abs()),
                    4.0 * EPSILON * far(&view),
                ),
            };
            prop_assert!(off <= allowed, "{:?} {:?}", view, made);
        }
    }

    /// Whatever the engine's conventions, a point has the place and the depth that the engine's matrices give it.
    #[test]
    fn points_appear_where_the_matrices_show_them((view, place) in seen(), engine in engine()) {
        let Some(point) = point(&view, place) else { return Ok(()); };
        let [world_to_view, view_to_clip] = engine.matrices(&view);
        let made = engine.view(&view).unwrap();
        prop_assert!(made.world_to_view.determinant() > 0.0);
        prop_assert_eq!(made.depth, view.depth);
        let mut wanted = clip(world_to_view, view_to_clip, point);
        if engine.is_gl {
            wanted.z = 0.5 * wanted.z + 0.5;
        }
        let found = clip(made.world_to_view, made.view_to_clip(), point);
        // A window far from the axis, as seen through its width.
        let [min, max] = window_of(&made);
        let aside = (min.abs().max(max.abs()) / (max - min).abs()).max_element();
        let off = (found - wanted).abs();
        prop_assert!(off.x.max(off.y) <= 16.0 * EPSILON * (1.0 + aside), "{} {}", found, wanted);
        let row = made.view_to_clip().row(2);
        let depth = (made.world_to_view.as_dmat4() * point.extend(1.0)).z;
        let scale = 1.0 + (row.as_dvec4().w / depth).abs();
        prop_assert!(off.z <= if engine.is_gl { 4.0 * EPSILON * scale } else { 0.0 }, "{} {}", found, wanted);

        // And back: the place and the depth give the point.
        let to_world = (made.view_to_clip().as_dmat4() * made.world_to_view.as_dmat4()).inverse();
        let back = to_world * found.extend(1.0);
        prop_assert!((back.truncate() / back.w - point).length() <= 1e-4 * (1.0 + point.length()));
    }
}

/// The projections of glam, by right- and left-handed engines: which view each of them is.
#[test]
fn projections_of_a_library_are_recognised() {
    use glam::camera::{lh, rh};
    let port = Viewport { x: 3, y: 4, width: 160, height: 90 };
    let (fov, wide, near, far) = (1.0_f32, 16.0 / 9.0, 0.1_f32, 100.0_f32);
    let (eye, ahead) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(0.0, -0.3, -1.0).normalize());
    let right = rh::view::look_to_mat4(eye, ahead, Vec3::Y);
    let left = lh::view::look_to_mat4(eye, ahead, Vec3::Y);
    let y_up = |matrix: Mat4| Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0)) * matrix;
    let standard = (DepthMapping::Standard, near, Some(far));
    let endless = (DepthMapping::Standard, near, None);
    let reversed = (DepthMapping::Reversed, near, None);
    let flat = (DepthMapping::Standard, 0.0, Some(50.0));
    let backwards = (DepthMapping::Reversed, 0.0, Some(50.0));
    let ortho = [-4.0, 4.0, -3.0, 3.0];
    let [l, r, b, t] = ortho;
    let (d3d, gl) = (View::from_matrices, View::from_gl_matrices);
    type Make = fn(Mat4, Mat4, Viewport) -> Result<View, ViewError>;
    type Seen = (DepthMapping, f32, Option<f32>);
    let cases: [(Make, Mat4, Mat4, Seen); 14] = [
        (d3d, right, rh::proj::directx::perspective(fov, wide, near, far), standard),
        (d3d, left, lh::proj::directx::perspective(fov, wide, near, far), standard),
        (d3d, right, rh::proj::directx::perspective_infinite(fov, wide, near), endless),
        (d3d, left, lh::proj::directx::perspective_infinite(fov, wide, near), endless),
        (d3d, right, rh::proj::directx::perspective_infinite_reverse(fov, wide, near), reversed),
        (d3d, left, lh::proj::directx::perspective_infinite_reverse(fov, wide, near), reversed),
        (d3d, right, y_up(rh::proj::vulkan::perspective(fov, wide, near, far)), standard),
        (d3d, left, y_up(lh::proj::vulkan::perspective(fov, wide, near, far)), standard),
        (gl, right, rh::proj::opengl::perspective(fov, wide, near, far), standard),
        (gl, left, lh::proj::opengl::perspective(fov, wide, near, far), standard),
        (gl, right, rh::proj::opengl::orthographic(l, r, b, t, 0.0, 50.0), flat),
        (d3d, right, rh::proj::directx::orthographic(l, r, b, t, 0.0, 50.0), flat),
        (d3d, left, lh::proj::directx::orthographic(l, r, b, t, 0.0, 50.0), flat),
        // Exchanged planes reverse depth.
        (d3d, left, lh::proj::directx::orthographic(l, r, b, t, 50.0, 0.0), backwards),
    ];
    for (ix, (make, world_to_view, view_to_clip, (depth, near_m, far_m))) in (0..).zip(cases) {
        let view = make(world_to_view, view_to_clip, port).unwrap_or_else(|e| panic!("{ix}: {e}"));
        assert_eq!((view.depth, view.far_m.is_some()), (depth, far_m.is_some()), "{ix}");
        assert!((view.near_m - near_m).abs() < 1e-5, "{ix}: {view:?}");
        let far = |far: Option<f32>| far.map_or(0.0, |far| 1.0 / far);
        assert!((far(view.far_m) - far(far_m)).abs() < 1e-4, "{ix}: {view:?}");
        assert_eq!(view.is_mirrored(), world_to_view == left, "{ix}");
        // The eye's own axes, whatever the engine's: only right and left are exchanged.
        let forward = -view.world_to_view.row(2).truncate();
        assert!(view.eye().distance(eye) < 1e-5 && forward.distance(ahead) < 1e-5, "{ix}");
        let above = view.world_to_clip() * (eye + ahead + 0.1 * Vec3::Y).extend(1.0);
        assert!(above.y > 0.0, "{ix}: upside down");
    }
}
