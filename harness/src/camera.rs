//! Chooses the camera of a stage: one of the scene's file, or a pose.

use glam::DVec3;
use scenes::{Camera as SceneCamera, Pose, Scene};

use crate::cli::{Camera, CliError, StageArgs};

/// The most cameras that an error lists.
const MOST_LISTED: usize = 20;

/// The most characters of a camera's name that an error shows.
const MOST_CHARACTERS: usize = 60;

/// The camera of the scene's file that gives the lens and the planes: the one that `--camera` names, else the
/// scene's default. `None` for `--camera X,Y,Z:X,Y,Z` and for files without cameras.
///
/// # Errors
///
/// No camera, or more than one, has that name or number; the [`CliError`] lists the cameras.
pub fn file_camera<'a>(
    scene: &'a Scene,
    args: &StageArgs,
) -> Result<Option<&'a SceneCamera>, CliError> {
    let cameras = &scene.cameras;
    match &args.camera {
        Some(Camera::Pose(_)) => Ok(None),
        None | Some(Camera::OnPath { .. }) => Ok(cameras.get(scene.view_camera)),
        Some(Camera::Numbered(ix)) => match cameras.get(*ix as usize) {
            Some(camera) => Ok(Some(camera)),
            None => Err(camera_error(scene, &format!("#{ix}"))),
        },
        Some(Camera::Named(name)) => {
            let mut alike = cameras.iter().filter(|camera| camera.name == *name);
            match (alike.next(), alike.next()) {
                (Some(camera), None) => Ok(Some(camera)),
                _ => Err(camera_error(scene, name)),
            }
        }
    }
}

/// The pose of a stage's camera.
///
/// # Errors
///
/// As [`file_camera`].
pub fn pose(scene: &Scene, args: &StageArgs) -> Result<Pose, CliError> {
    Ok(match &args.camera {
        Some(Camera::Pose(pose)) => {
            // Subtract in f64 first, because the difference is small near the scene.
            let eye = DVec3::from(pose.eye) - scene.origin;
            Pose::level(eye.as_vec3(), pose.forward().as_vec3())
        }
        Some(Camera::OnPath { frame, count }) => scene.path.pose(*frame, *count),
        _ => match file_camera(scene, args)? {
            // A camera may be tilted, and the path is level.
            Some(camera) if args.camera.is_some() || !scene.path.is_animation() => camera.pose,
            _ => scene.path.pose(0, 1),
        },
    })
}

/// The error for a name or number that no camera has, or more than one.
fn camera_error(scene: &Scene, value: &str) -> CliError {
    let listed = |(ix, camera): (usize, &SceneCamera)| {
        let mut name: String = camera.name.chars().take(MOST_CHARACTERS).collect();
        if name.len() < camera.name.len() {
            name.push_str("...");
        }
        format!("'#{ix}' {name:?}")
    };
    let count = scene.cameras.len();
    let mut all: Vec<String> =
        scene.cameras.iter().enumerate().take(MOST_LISTED).map(listed).collect();
    if count > MOST_LISTED {
        all.push(format!("... and {} more", count - MOST_LISTED));
    }
    let accepted = match count {
        0 => format!("a pose or path:FRAME/COUNT, because {} has no cameras", scene.name),
        _ => format!(
            "one of the cameras of {}, by a unique name or by #N: {}",
            scene.name,
            all.join(", ")
        ),
    };
    CliError::out_of_range("--camera", value, &accepted)
}

#[cfg(test)]
mod tests {
    use glam::Vec3;
    use scenes::Lens;

    use super::*;
    use crate::cli::{Invocation, parse};

    fn args(camera: &str) -> StageArgs {
        let option = format!("--camera={camera}");
        let words = ["lightbench", "compare", &option];
        let Ok(Invocation::Compare(args)) = parse(words) else { panic!("{camera}") };
        args.stage
    }

    fn scene(names: &[&str]) -> Scene {
        let mut scene = scenes::open("atrium").unwrap();
        scene.cameras = names
            .iter()
            .zip(1_u16..)
            .map(|(name, number)| SceneCamera {
                name: (*name).to_owned(),
                pose: Pose::looking(Vec3::X * f32::from(number), Vec3::NEG_Z, Vec3::X),
                lens: Lens::Perspective { fov_y: 1.0 },
                near_m: 0.1,
                far_m: None,
                framing: scenes::Framing::PLAIN,
            })
            .collect();
        scene
    }

    #[test]
    fn every_camera_of_a_file_can_be_chosen() {
        let scene = scene(&["south", "2,3", "south", "#0"]);
        let eye = |camera: &str| pose(&scene, &args(camera)).unwrap().eye.x;
        assert_eq!(["#0", "#1", "#2", "#3"].map(eye), [1.0, 2.0, 3.0, 4.0]);
        let refused = |camera: &str| file_camera(&scene, &args(camera)).unwrap_err().to_string();
        let list = "'#0' \"south\", '#1' \"2,3\", '#2' \"south\", '#3' \"#0\"";
        for (camera, shown) in [("south", "south"), ("north", "north"), ("#4", "#4")] {
            let error = refused(camera);
            assert!(
                error.starts_with(&format!("--camera is {shown}: it must be one of")),
                "{error}"
            );
            assert!(error.ends_with(list), "{error}");
        }
        let mut unique = scene.clone();
        unique.cameras[2].name = "north".into();
        let pose_of = |camera: &str| pose(&unique, &args(camera)).unwrap();
        assert_eq!((pose_of("north").eye.x, pose_of("north").up), (3.0, Vec3::X));
        // The default is the first camera with its tilt.
        let words = ["lightbench", "compare"];
        let Ok(Invocation::Compare(default)) = parse(words) else { panic!() };
        assert_eq!(pose(&unique, &default.stage).unwrap(), unique.cameras[0].pose);
    }

    #[test]
    fn errors_list_a_bounded_number_of_short_names() {
        let long = "x".repeat(5_000_000);
        let mut many = vec!["a\n"; 300];
        many[0] = &long;
        let error = file_camera(&scene(&many), &args("b")).unwrap_err().to_string();
        assert!(error.len() < 1_000 && error.contains("and 280 more"), "{error}");
        assert_eq!(error.lines().count(), 1);
        let error = file_camera(&scene(&[]), &args("b")).unwrap_err().to_string();
        assert!(error.ends_with("atrium has no cameras"), "{error}");
    }

    #[test]
    fn poses_are_in_the_coordinates_of_the_file() {
        let mut scene = scene(&[]);
        scene.origin = DVec3::new(1e6, 0.0, -3.0);
        let found = pose(&scene, &args("1000000.125,2,-3:1000000.125,2,-3.5")).unwrap();
        assert_eq!((found.eye, found.forward()), (Vec3::new(0.125, 2.0, 0.0), Vec3::NEG_Z));
    }
}
