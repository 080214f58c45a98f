//! Planes of views.

use glam::Vec3;
use scenes::Camera as SceneCamera;

use super::*;
use crate::cli::{Invocation, parse};

fn args(line: &str) -> StageArgs {
    let words = ["lightbench", "compare"].into_iter().chain(line.split_whitespace());
    let Ok(Invocation::Compare(args)) = parse(words) else { panic!("{line}") };
    args.stage
}

/// The atrium, through a camera of its own where a lens is given.
fn scene(lens: Option<Lens>, near_m: f32, far_m: Option<f32>) -> Scene {
    let mut scene = scenes::open("atrium").unwrap();
    let pose = scene.path.pose(0, 1);
    let framing = Framing::PLAIN;
    let camera = |lens| SceneCamera { name: "a".into(), pose, lens, near_m, far_m, framing };
    scene.cameras.extend(lens.map(camera));
    scene
}

fn planes(scene: &Scene, line: &str) -> Planes {
    let optics = Optics::new(scene, &args(line)).unwrap();
    let view = optics.view(scene, scene.path.pose(0, 1), [64, 36]);
    view.check().unwrap();
    optics.planes(&view)
}

fn refusal(scene: &Scene, line: &str) -> String {
    Optics::new(scene, &args(line)).map(|_| ()).unwrap_err().to_string()
}

const WIDE: Lens = Lens::Perspective { fov_y: 1.0 };
const FLAT: Lens = Lens::Orthographic { half_width: 4.0, half_height: 3.0 };

#[test]
fn without_a_camera_the_far_plane_lies_behind_the_scene_at_every_pose() {
    let scene = scene(None, 0.0, None);
    let optics = Optics::new(&scene, &args("")).unwrap();
    let corner = |ix: usize| {
        let (min, max) = (scene.bounds.min, scene.bounds.max);
        let pick = |bit: usize, axis: usize| if ix & bit == 0 { min[axis] } else { max[axis] };
        Vec3::new(pick(1, 0), pick(2, 1), pick(4, 2))
    };
    for frame in 0..12 {
        let view = optics.view(&scene, scene.path.pose(frame, 12), [64, 36]);
        view.check().unwrap();
        let far_m = view.far_m.expect("the scene's bounds give one");
        let depths = (0..8).map(|ix| -view.world_to_view.transform_point3(corner(ix)).z);
        let deepest = depths.fold(0.0, f32::max);
        assert!(deepest < far_m && far_m < 2.0 * scene.bounds.diagonal(), "{deepest} {far_m}");
    }
    let planes = planes(&scene, "");
    let near_m = f64::from(scene.core_bounds.diagonal() * NEAR_SHARE);
    assert_eq!((planes.near_m, planes.near_from), (near_m, PlaneSource::Scene));
    assert_eq!(planes.far_from, PlaneSource::Scene);
}

#[test]
fn planes_come_from_the_option_else_the_file_else_the_scene() {
    use PlaneSource::{File, Option, Scene};
    let whole = scene(Some(WIDE), 0.25, Some(20.0));
    let sources = |planes: &Planes| (planes.near_from, planes.far_from);
    let file = planes(&whole, "");
    assert_eq!((file.near_m, file.far_m, sources(&file)), (0.25, Some(20.0), (File, File)));
    let both = planes(&whole, "--near 0.5 --far 8");
    assert_eq!((both.near_m, both.far_m, sources(&both)), (0.5, Some(8.0), (Option, Option)));
    let open = planes(&whole, "--far infinite");
    assert_eq!((open.far_m, sources(&open)), (None, (File, Option)));
    let posed = planes(&whole, "--camera 0,2,4:0,1,0");
    assert_eq!(sources(&posed), (Scene, Scene));
    // The file's camera leaves its far plane open: the scene's bounds give one.
    let half = planes(&scene(Some(WIDE), 0.25, None), "");
    assert_eq!(sources(&half), (File, Scene));
    let flat = planes(&scene(Some(FLAT), 0.0, Some(30.0)), "");
    assert_eq!((flat.near_m, flat.far_m), (0.0, Some(30.0)));
}

#[test]
fn an_error_about_planes_in_the_wrong_order_names_the_option() {
    let scene_of = |lens| scene(Some(lens), 0.5, Some(20.0));
    let far = refusal(&scene_of(WIDE), "--far 0.25");
    assert_eq!(far, "--far is 0.25: it must be above the near plane, 0.5 m of the file's camera");
    let near = refusal(&scene_of(WIDE), "--near 20");
    assert_eq!(near, "--near is 20: it must be below the file's far plane, 20 m");
    let both = refusal(&scene_of(WIDE), "--near 3 --far 2");
    assert_eq!(both, "--far is 2: it must be above the near plane, 3 m of --near");
    let open = refusal(&scene_of(FLAT), "--far infinite");
    assert!(open.starts_with("--far is infinite: it must be a number of metres"), "{open}");
}

/// The height of the floor below the middle of a scene.
fn floor_of(scene: &Scene) -> f32 {
    let middle = scene.bounds.center();
    let down = View::looking(middle, Vec3::NEG_Y, Vec3::Z, 1e-3, 0.1, [4, 4]);
    middle.y - scene.depths_shown(&down).expect("a floor").nearest_m as f32
}

/// The view of a pose as a stage sees it.
fn fitted(scene: &Scene, line: &str, pose: Pose) -> (Optics, View) {
    let mut optics = Optics::new(scene, &args(line)).unwrap();
    optics.fit_near(scene, &[optics.view(scene, pose, [64, 36])]);
    (optics, optics.view(scene, pose, [64, 36]))
}

#[test]
fn the_near_plane_moves_only_if_it_would_cut_a_visible_surface_away() {
    let scene = scene(None, 0.0, None);
    let usual_m = scene.core_bounds.diagonal() * NEAR_SHARE;
    // The scene's own views see everything: none of them changes, at one pose or along the path.
    let mut all = Vec::new();
    for frame in 0..60 {
        let pose = scene.path.pose(frame, 60);
        let (optics, view) = fitted(&scene, "", pose);
        assert_eq!(optics.near_m(), usual_m, "frame {frame}");
        all.push(view);
    }
    // A lens just above the floor, level and straight down: half of what it sees is never cut.
    let floor = floor_of(&scene);
    let middle = scene.bounds.center();
    let above = |height: f32| Vec3::new(middle.x, floor + height, middle.z);
    for height in [0.3, 0.03, 0.003] {
        for target in [above(height) + Vec3::X, above(0.0) + 0.01 * Vec3::X * height] {
            let (_, view) = fitted(&scene, "", Pose::new(above(height), target));
            let nearest = scene.depths_shown(&view).expect("a floor").nearest_m;
            assert!(f64::from(view.near_m) <= 0.98 * nearest, "{height}: {nearest} {view:?}");
            assert!(view.near_m >= usual_m * LEAST_NEAR && view.near_m <= usual_m, "{height}");
        }
    }
    // Along a path one plane serves all.
    let close = fitted(&scene, "", Pose::new(above(0.01), above(0.0) + 0.001 * Vec3::X)).1;
    all.push(close);
    let mut optics = Optics::new(&scene, &args("")).unwrap();
    optics.fit_near(&scene, &all);
    assert_eq!(optics.near_m(), close.near_m);
    // What an option or a file says stays.
    let pose = Pose::new(above(0.01), above(0.0) + 0.001 * Vec3::X);
    assert_eq!(fitted(&scene, "--near 0.5", pose).1.near_m, 0.5);
    // A far plane in front of the usual near plane is accepted.
    let (_, view) = fitted(&scene, "--far 0.02", pose);
    view.check().unwrap();
    assert!(view.near_m < 0.02, "{view:?}");
}

#[test]
fn notes_name_the_planes_that_cut_surfaces_away() {
    let notes = |scene: &Scene, line: &str, pose: Pose| {
        let (optics, view) = fitted(scene, line, pose);
        optics.notes(scene, &[view])
    };
    let open = scene(None, 0.0, None);
    let pose = open.path.pose(0, 1);
    for line in ["", "--near 0.01", "--far 1000", "--far infinite", "--near 0.01 --far 1000"] {
        assert_eq!(notes(&open, line, pose), [""; 0], "{line}");
    }
    let far = notes(&open, "--far 8", pose);
    assert!(far.len() == 1 && far[0].contains("behind the far plane, 8.00 m of --far"), "{far:?}");
    let near = notes(&open, "--near 7", pose);
    assert!(near.len() == 1 && near[0].contains("near plane, 7.00 m of --near"), "{near:?}");
    let filed = scene(Some(WIDE), 7.0, Some(8.0));
    let both = notes(&filed, "", pose);
    assert!(both.len() == 2 && both.iter().all(|note| note.contains("of the file's")), "{both:?}");
    // An eye in a surface that is seen from both sides.
    let mut sheet = open.clone();
    sheet.materials.iter_mut().for_each(|material| material.double_sided = true);
    let eye = open.bounds.center().with_y(floor_of(&open));
    let inside = notes(&sheet, "", Pose::new(eye, eye + Vec3::new(1.0, 0.01, 0.0)));
    assert!(inside.iter().any(|note| note.contains("in front of the near plane")), "{inside:?}");
    // A camera so far from the scene's origin that f32 cannot place it.
    let away = Vec3::new(1e6, 0.0, 0.0);
    let coarse = notes(&open, "", Pose::new(away, away + Vec3::X));
    assert!(coarse.len() == 1 && coarse[0].contains("apart"), "{coarse:?}");
    let flat = scene(Some(FLAT), 0.0, Some(1000.0));
    assert_eq!(notes(&flat, "", pose), [""; 0], "an orthographic near plane at the eye");
}

/// A stability scenario's camera moves, mirrors and crops the image, and may have no far plane.
#[test]
fn a_framing_reaches_the_view() {
    let mut scene = scene(Some(WIDE), 0.1, None);
    let view = |scene: &Scene, line: &str| {
        let optics = Optics::new(scene, &args(line)).unwrap();
        let view = optics.view(scene, scene.path.pose(0, 1), [64, 36]);
        view.check().unwrap();
        (view, optics.target(&view), optics.planes(&view))
    };
    let (plain, ..) = view(&scene, "");
    scene.cameras[0].framing = Framing {
        shift: Vec2::new(0.5, -0.25),
        jitter_px: Vec2::new(0.25, 0.5),
        is_mirrored: true,
        before_px: [7, 3],
        after_px: [5, 11],
        less_px: [9, 2],
        is_endless: true,
        depth: assign::DepthMapping::Standard,
        clip_plane: None,
    };
    let (framed, target, planes) = view(&scene, "");
    let Projection::Perspective { min, max } = framed.projection else { panic!("perspective") };
    let Projection::Perspective { min: low, max: high } = plain.projection else { panic!() };
    // 55 x 34 pixels show a little less width for their height than 64 x 36.
    let half = Vec2::new(high.y * 55.0 / 34.0, high.y);
    assert!((min - Vec2::new(2.0 * half.x, -1.5 * half.y)).length() < 1e-6, "{min} {low} {high}");
    assert!((max - Vec2::new(0.0, 0.5 * half.y)).length() < 1e-6, "{max}");
    assert!(framed.is_mirrored() && !plain.is_mirrored());
    let viewport = assign::Viewport { x: 7, y: 3, width: 55, height: 34 };
    assert_eq!(framed.viewport, viewport);
    assert_eq!(target.viewport, assign::Viewport { width: 60, height: 45, ..viewport });
    assert_eq!(
        (framed.jitter, framed.depth),
        (Vec2::new(0.25, 0.5), assign::DepthMapping::Standard)
    );
    assert_eq!((framed.far_m, planes.far_from), (None, PlaneSource::File));
    // An option replaces the plane, and a pose leaves the whole camera out.
    assert_eq!(view(&scene, "--far 50").0.far_m, Some(50.0));
    let (posed, ..) = view(&scene, "--camera=0,2,0:1,2,0");
    assert_eq!(posed.viewport, plain.viewport);
    assert!(posed.far_m.is_some() && !posed.is_mirrored());
    // No image is empty.
    scene.cameras[0].framing.less_px = [1000, 1000];
    let (tiny, ..) = view(&scene, "");
    assert_eq!((tiny.viewport.width, tiny.viewport.height), (1, 1));
}
