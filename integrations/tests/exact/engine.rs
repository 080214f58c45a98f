//! Cameras as engines have them: two matrices, from which lightbench takes its view.

use assign::{DepthMapping, View, Viewport};
use glam::{Mat4, Vec2, Vec3, Vec4};
use integrations::{Shot, scene};

const NEAR_M: f32 = 0.1;
const FAR_M: f32 = 60.0;

/// An off-centre part of the target.
pub(crate) const VIEWPORT: Viewport = Viewport { x: 40, y: 8, width: 80, height: 32 };

/// A window without symmetry: lower left and upper right corner at view depth 1.
const WINDOW: [Vec2; 2] = [Vec2::new(-0.7, -0.6), Vec2::new(0.9, 0.2)];

/// Clip depth is `a w + b`. Depth from 0 to 1, and that of OpenGL from -1 to 1.
const STANDARD: [f32; 2] = [FAR_M / (FAR_M - NEAR_M), -NEAR_M * FAR_M / (FAR_M - NEAR_M)];
const REVERSED_INFINITE: [f32; 2] = [0.0, NEAR_M];
const GL: [f32; 2] =
    [(FAR_M + NEAR_M) / (FAR_M - NEAR_M), -2.0 * NEAR_M * FAR_M / (FAR_M - NEAR_M)];

/// How an engine on wgpu draws with OpenGL's matrices: clip z becomes `0.5 z + 0.5 w`.
const GL_TO_WGPU: Mat4 =
    Mat4::from_cols(Vec4::X, Vec4::Y, Vec4::new(0.0, 0.0, 0.5, 0.0), Vec4::new(0.0, 0.0, 0.5, 1.0));

fn from_rows(rows: [Vec4; 4]) -> Mat4 {
    Mat4::from_cols(rows[0], rows[1], rows[2], rows[3]).transpose()
}

/// A perspective projection. `forward` is the sign of z in front of the camera.
fn perspective(forward: f32, [a, b]: [f32; 2]) -> Mat4 {
    let [min, max] = WINDOW;
    let (scale, shift) = (2.0 / (max - min), -forward * (max + min) / (max - min));
    from_rows([
        Vec4::new(scale.x, 0.0, shift.x, 0.0),
        Vec4::new(0.0, scale.y, shift.y, 0.0),
        Vec4::new(0.0, 0.0, forward * a, b),
        Vec4::new(0.0, 0.0, forward, 0.0),
    ])
}

/// OpenGL's orthographic projection of 18 by 6 m.
fn gl_orthographic() -> Mat4 {
    let length = FAR_M - NEAR_M;
    from_rows([
        Vec4::new(1.0 / 9.0, 0.0, 0.0, 0.1),
        Vec4::new(0.0, 1.0 / 3.0, 0.0, 0.0),
        Vec4::new(0.0, 0.0, -2.0 / length, -(FAR_M + NEAR_M) / length),
        Vec4::W,
    ])
}

/// A projection with standard depth whose near plane is `plane`, in view space (Lengyel 2005, "Oblique View Frustum
/// Depth Projection and Clipping"). Points with `dot(plane, p) > 0` are shown.
fn oblique(clip: Mat4, plane: Vec4) -> Mat4 {
    let corner = clip.inverse() * Vec4::new(plane.x.signum(), plane.y.signum(), 1.0, 1.0);
    let [x, y, _, w] = [0, 1, 2, 3].map(|row| clip.row(row));
    from_rows([x, y, plane / plane.dot(corner), w])
}

/// The same projection with reversed depth.
fn reversed(clip: Mat4) -> Mat4 {
    let [x, y, z, w] = [0, 1, 2, 3].map(|row| clip.row(row));
    from_rows([x, y, w - z, w])
}

fn look(eye: Vec3, target: Vec3) -> Mat4 {
    View::look_at(eye, target, 1.0, NEAR_M, [1, 1]).world_to_view
}

/// A shot of an engine whose clip depth runs from 0 to 1.
pub(crate) fn shot(world_to_view: Mat4, view_to_clip: Mat4, viewport: Viewport) -> Shot {
    let view = View::from_matrices(world_to_view, view_to_clip, viewport).unwrap();
    Shot { world_to_clip: view_to_clip * world_to_view, view }
}

fn gl_shot(world_to_view: Mat4, view_to_clip: Mat4) -> Shot {
    let view = View::from_gl_matrices(world_to_view, view_to_clip, VIEWPORT).unwrap();
    Shot { world_to_clip: GL_TO_WGPU * view_to_clip * world_to_view, view }
}

/// Shots by matrices: each with a name.
pub(crate) fn shots() -> [(&'static str, Shot); 8] {
    let camera = look(Vec3::new(9.0, 3.0, 11.0), Vec3::new(0.0, 0.5, 0.0));
    let left_handed = Mat4::from_scale(Vec3::new(1.0, 1.0, -1.0)) * camera;
    // A camera above the floor looks into a mirror at x = 8, whose front faces the pillars.
    let reflection = Mat4::from_cols(-Vec4::X, Vec4::Y, Vec4::Z, Vec4::new(16.0, 0.0, 0.0, 1.0));
    let mirrored = look(Vec3::new(6.0, 9.0, 6.0), Vec3::new(16.0, 0.0, 0.0)) * reflection;
    let mirror = mirrored.inverse().transpose() * Vec4::new(-1.0, 0.0, 0.0, 8.0);
    let standard = perspective(-1.0, STANDARD);
    let in_part = |world_to_view, clip| shot(world_to_view, clip, VIEWPORT);
    [
        ("reversed infinite", in_part(camera, perspective(-1.0, REVERSED_INFINITE))),
        ("standard finite", in_part(camera, standard)),
        ("left-handed", in_part(left_handed, perspective(1.0, STANDARD))),
        ("mirrored", in_part(mirrored, perspective(-1.0, REVERSED_INFINITE))),
        ("oblique", in_part(mirrored, oblique(standard, mirror))),
        ("oblique reversed", in_part(mirrored, reversed(oblique(standard, mirror)))),
        ("OpenGL perspective", gl_shot(camera, perspective(-1.0, GL))),
        ("OpenGL orthographic", gl_shot(camera, gl_orthographic())),
    ]
}

/// The farthest that the view shows a vertex from where the engine draws it: pixels, and depth.
fn farthest(Shot { world_to_clip, view }: Shot) -> (f32, f32) {
    let half = Vec2::new(view.viewport.width as f32, view.viewport.height as f32) / 2.0;
    let place = |matrix: Mat4, position: Vec3| {
        let clip = matrix * position.extend(1.0);
        let ndc = clip.truncate() / clip.w;
        // Vertices that are not drawn may be as far outside as they like.
        let is_drawn = clip.w > 0.0 && ndc.abs().max_element() <= 1.0 && ndc.z >= 0.0;
        is_drawn.then_some((half * ndc.truncate(), ndc.z))
    };
    let mut farthest = (0.0f32, 0.0f32);
    let mut drawn = 0;
    for vertex in scene().0 {
        let Some((pixel, depth)) = place(world_to_clip, vertex.position) else { continue };
        let clip = view.world_to_clip() * vertex.position.extend(1.0);
        let ndc = clip.truncate() / clip.w;
        let moved = (half * ndc.truncate() - pixel).abs().max_element();
        farthest = (farthest.0.max(moved), farthest.1.max((ndc.z - depth).abs()));
        drawn += 1;
    }
    assert!(drawn > 50, "only {drawn} vertices are drawn");
    farthest
}

/// A view shows every vertex where the engine's own matrices draw it.
#[test]
fn views_show_what_the_engine_draws() {
    for (name, shot) in shots() {
        let (pixels, depth) = farthest(shot);
        assert!(pixels < 1e-3 && depth < 1e-5, "{name}: off by {pixels} pixels and {depth}");
        assert_eq!(shot.view.is_mirrored(), name.starts_with(['m', 'o']), "{name}");
        let tilt = shot.view.depth_row.unwrap_or_default().truncate().truncate();
        assert_eq!(tilt != Vec2::ZERO, name.starts_with("oblique"), "{name}: {tilt}");
        let is_reversed = shot.view.depth == DepthMapping::Reversed;
        let wanted = name.contains("reversed") || name == "mirrored";
        assert_eq!(is_reversed, wanted, "{name}");
    }
    // OpenGL's matrices are not those of other engines.
    let camera = look(Vec3::new(9.0, 3.0, 11.0), Vec3::new(0.0, 0.5, 0.0));
    let wrong = shot(camera, perspective(-1.0, GL), VIEWPORT).view;
    let (_, depth) = farthest(Shot { view: wrong, ..gl_shot(camera, perspective(-1.0, GL)) });
    assert!(depth > 1e-4, "a view of the wrong convention is off by {depth} only");
}
