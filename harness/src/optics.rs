//! How the camera of a stage sees: its lens, its near plane and its far plane.
//!
//! A camera of the scene's file brings all three. Where the file leaves the far plane open, or has no
//! camera, the far plane lies just beyond the farthest corner of the scene's bounds, as seen from the
//! eye: it follows the eye along a path and does not depend on where the camera looks. No triangle is
//! lost to it. `--near` and `--far` replace either plane.

use assign::{Projection, View};
use glam::Vec2;
use scenes::{Lens, Pose, Scene};

use crate::{
    cli::{Camera, CliError, FarPlane, StageArgs},
    results::{PlaneSource, Planes},
};

/// Vertical field of view where the scene names none, radians.
const FOV_Y: f32 = 60.0 * std::f32::consts::PI / 180.0;

/// The near plane as a share of the scene's size: 5 cm in a hall of 25 m.
const NEAR_SHARE: f32 = 0.002;

/// How much farther than the scene the far plane lies: what is drawn exactly at it cannot be told from
/// background.
const BEYOND: f32 = 1.001;

/// Lens, near plane and far plane of a stage's camera.
#[derive(Clone, Copy, Debug)]
pub struct Optics {
    lens: Option<Lens>,
    near_m: f32,
    near_from: PlaneSource,
    far: Far,
}

/// Where the far plane is.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Far {
    /// At a view depth, metres.
    At(f32, PlaneSource),
    /// Just beyond the scene.
    Bounds,
    /// Nowhere.
    Infinite,
}

impl Optics {
    /// What the options ask for, else what the file's first camera says, else what suits the scene.
    /// A pose of one's own (`--camera X,Y,Z:X,Y,Z`) leaves the file's camera out.
    ///
    /// # Errors
    ///
    /// A [`CliError`] that names the option at fault.
    pub fn new(scene: &Scene, args: &StageArgs) -> Result<Self, CliError> {
        let is_posed = matches!(args.camera, Some(Camera::Pose(_)));
        let camera = scene.cameras.first().filter(|_| !is_posed);
        let (near_m, near_from) = match (args.near, camera) {
            (Some(near), _) => (near as f32, PlaneSource::Option),
            (None, Some(camera)) => (camera.near_m, PlaneSource::File),
            (None, None) => {
                let near_m = (scene.core_bounds.diagonal() * NEAR_SHARE).max(1e-6);
                (near_m, PlaneSource::Scene)
            }
        };
        let far = match (args.far, camera.and_then(|camera| camera.far_m)) {
            (Some(FarPlane::At(far)), _) => Far::At(far as f32, PlaneSource::Option),
            (Some(FarPlane::Infinite), _) => Far::Infinite,
            (None, Some(far)) => Far::At(far, PlaneSource::File),
            (None, None) => Far::Bounds,
        };
        let optics = Self { lens: camera.map(|camera| camera.lens), near_m, near_from, far };
        optics.check()?;
        Ok(optics)
    }

    fn check(&self) -> Result<(), CliError> {
        match self.far {
            Far::Infinite if matches!(self.lens, Some(Lens::Orthographic { .. })) => {
                let accepted = "a number of metres: the file's camera is orthographic";
                Err(CliError::out_of_range("--far", "infinite", accepted))
            }
            Far::At(far, source) if far <= self.near_m => {
                let (option, value, accepted) = match source {
                    PlaneSource::Option => {
                        let near = format!("above the near plane, {}", self.near());
                        ("--far", far, near)
                    }
                    _ => {
                        ("--near", self.near_m, format!("below the far plane of the file, {far} m"))
                    }
                };
                Err(CliError::out_of_range(option, &value.to_string(), &accepted))
            }
            _ => Ok(()),
        }
    }

    /// The near plane in words: where it is, and what says so.
    fn near(&self) -> String {
        let from = match self.near_from {
            PlaneSource::Option => "of --near",
            PlaneSource::File => "of the file's camera",
            _ => "of the scene",
        };
        format!("{} m {from}", self.near_m)
    }

    /// The view from a pose.
    pub fn view(&self, scene: &Scene, pose: Pose, size: [u32; 2]) -> View {
        let fov_y = match self.lens {
            Some(Lens::Perspective { fov_y }) => fov_y,
            _ => FOV_Y,
        };
        let mut view = View {
            world_to_view: pose.world_to_view(),
            ..View::look_at(pose.eye, pose.target, fov_y, self.near_m, size)
        };
        if let Some(Lens::Orthographic { half_height, .. }) = self.lens {
            // The picture's own shape decides its width.
            let corner =
                Vec2::new(half_height * size[0] as f32 / size[1].max(1) as f32, half_height);
            view.projection = Projection::Orthographic { min: -corner, max: corner };
        }
        view.far_m = match self.far {
            Far::At(far_m, _) => Some(far_m),
            Far::Bounds => {
                let farthest = view.farthest_m(scene.bounds.min, scene.bounds.max) * BEYOND;
                // A scene without triangles has no bounds.
                let farthest = if farthest.is_finite() { farthest } else { 0.0 };
                Some(farthest.max(2.0 * self.near_m).max(f32::MIN_POSITIVE))
            }
            Far::Infinite => None,
        };
        view
    }

    /// The planes of a view that it made, for the record.
    pub fn planes(&self, view: &View) -> Planes {
        Planes {
            near_m: f64::from(view.near_m),
            near_from: self.near_from,
            far_m: view.far_m.map(f64::from),
            far_from: match self.far {
                Far::At(_, source) => source,
                Far::Bounds => PlaneSource::Scene,
                Far::Infinite => PlaneSource::Option,
            },
        }
    }
}

#[cfg(test)]
mod tests {
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
        let camera = |lens| SceneCamera { name: "a".into(), pose, lens, near_m, far_m };
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
    fn a_scene_without_a_camera_is_seen_to_its_end_from_every_pose() {
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
    fn planes_in_the_wrong_order_are_refused_by_the_option_at_fault() {
        let scene_of = |lens| scene(Some(lens), 0.5, Some(20.0));
        let far = refusal(&scene_of(WIDE), "--far 0.25");
        assert_eq!(
            far,
            "--far is 0.25: it must be above the near plane, 0.5 m of the file's camera"
        );
        let near = refusal(&scene_of(WIDE), "--near 20");
        assert_eq!(near, "--near is 20: it must be below the far plane of the file, 20 m");
        let both = refusal(&scene_of(WIDE), "--near 3 --far 2");
        assert_eq!(both, "--far is 2: it must be above the near plane, 3 m of --near");
        let open = refusal(&scene_of(FLAT), "--far infinite");
        assert!(open.starts_with("--far is infinite: it must be a number of metres"), "{open}");
    }
}
