//! `--camera`: a pose, a frame of the scene's path, or a camera of the scene's file.

use std::str::FromStr;

use glam::DVec3;

/// The most frames of a path.
const MAX_FRAMES: u32 = 100_000;

/// The camera's position and a point that it looks at: `0,2,10:0,1,0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraPose {
    /// The camera's position in the coordinates of the scene's file, metres.
    pub eye: [f64; 3],
    /// A point that it looks at, different from the eye.
    pub target: [f64; 3],
}

impl CameraPose {
    /// The unit view direction.
    pub fn forward(&self) -> DVec3 {
        let along = DVec3::from(self.target) - DVec3::from(self.eye);
        // In f64 even the squared distance of points at the limits of f32 is finite.
        along.normalize_or(DVec3::NEG_Z)
    }
}

impl FromStr for CameraPose {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let number = |text: &str| {
            let number: f64 = text.trim().parse().ok()?;
            // What the GPU can hold.
            (number as f32).is_finite().then_some(number)
        };
        let point = |text: &str| {
            let mut numbers = text.split(',').map(number);
            let point = [numbers.next()??, numbers.next()??, numbers.next()??];
            numbers.next().is_none().then_some(point)
        };
        text.split_once(':')
            .and_then(|(eye, target)| Some(Self { eye: point(eye)?, target: point(target)? }))
            .filter(|pose| pose.eye != pose.target)
            .ok_or_else(|| {
                "eye and target as x,y,z:x,y,z: six finite numbers in metres, two different points"
                    .to_owned()
            })
    }
}

/// Where the camera stands.
#[derive(Clone, Debug, PartialEq)]
pub enum Camera {
    /// At a pose: `0,2,10:0,1,0`.
    Pose(CameraPose),
    /// At a frame of the scene's path: `path:300/1200`.
    OnPath {
        /// The frame, from 0.
        frame: u32,
        /// Frames of the whole path.
        count: u32,
    },
    /// A camera of the scene's file by its number, from 0: `#1`.
    Numbered(u32),
    /// A camera of the scene's file by its name.
    Named(String),
}

impl FromStr for Camera {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(place) = text.strip_prefix("path:") {
            return on_path(place);
        }
        if let Some(number) = text.strip_prefix('#') {
            let number = number.parse().map(Self::Numbered);
            return number.map_err(|_| {
                "#N, where N is the number of a camera in the scene's file, from 0".to_owned()
            });
        }
        // Text that starts with a number and holds commas is meant as a pose.
        let is_number =
            text.trim_start().starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c));
        match text.parse() {
            Ok(pose) => Ok(Self::Pose(pose)),
            Err(accepted) if text.trim().is_empty() || (is_number && text.contains(',')) => {
                Err(format!(
                    "{accepted}, or path:FRAME/COUNT, or a camera of the scene's file: NAME or #N"
                ))
            }
            Err(_) => Ok(Self::Named(text.to_owned())),
        }
    }
}

fn on_path(place: &str) -> Result<Camera, String> {
    let frame = |text: &str| text.parse::<u32>().ok();
    place
        .split_once('/')
        .and_then(|(at, count)| Some((frame(at)?, frame(count)?)))
        .filter(|(at, count)| at < count && *count <= MAX_FRAMES)
        .map(|(frame, count)| Camera::OnPath { frame, count })
        .ok_or_else(|| "path:FRAME/COUNT, with FRAME below COUNT and COUNT at most 100,000".into())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn poses_frames_numbers_and_names_are_distinguished() {
        let camera = |text: &str| text.parse::<Camera>();
        let named = |name: &str| Ok(Camera::Named(name.to_owned()));
        assert_eq!(camera("path:3/12"), Ok(Camera::OnPath { frame: 3, count: 12 }));
        assert_eq!(camera("#2"), Ok(Camera::Numbered(2)));
        for name in ["Camera", "Camera.001", "a:b", "south, from above", "2nd", "Ærø #1"] {
            assert_eq!(camera(name), named(name));
        }
        for bad in ["", " ", "#", "#-1", "#x", "path:", "path:3/3", "1,2:3", "-1,2,3:4,5,x", ".5,1"]
        {
            assert!(camera(bad).is_err(), "{bad}");
        }
        let Ok(Camera::Pose(pose)) = camera("1000000.3,0,0:1000000.3,0,-0.25") else { panic!() };
        assert_eq!(pose.eye[0], 1_000_000.3);
        assert_eq!(pose.forward(), DVec3::NEG_Z);
    }
}
