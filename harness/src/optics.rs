//! The lens, the near plane and the far plane of a stage's camera.
//!
//! A camera of the scene's file sets all three. `--near` and `--far` replace its planes.
//!
//! A stability scenario also says where the image lies in its window and in the target, whether it is mirrored, and
//! which way depth runs ([`Framing`]).
//!
//! Without these, the planes cut away no triangle. The near plane lies at 1/500 of the scene's size. If this
//! would cut away a visible surface, such as a floor under the lens, it lies at half the depth of the nearest
//! one. Along a path, all poses have the same near plane. The far plane lies just beyond the farthest corner
//! of the scene's bounds, seen from the eye. It follows the eye along a path and does not depend on the
//! direction of view.
//!
//! If a plane from an option or the file cuts away surfaces, a note says so ([`Optics::notes`]).

use assign::{Projection, View};
use glam::Vec2;
use scenes::{DepthSpan, Framing, Lens, Pose, Scene};

use crate::{
    camera::file_camera,
    cli::{CliError, FarPlane, StageArgs},
    digits::rounded,
    report::significant,
    results::{PlaneSource, Planes},
};

/// The vertical field of view for scenes without a camera, radians.
const FOV_Y: f32 = 60.0 * std::f32::consts::PI / 180.0;

/// The near plane as a share of the scene's size: 5 cm in a hall of 25 m.
const NEAR_SHARE: f32 = 0.002;

/// Surfaces nearer than this many usual near planes may be cut away.
const CUT: f32 = 1.01;

/// The near plane as a share of the depth of such a surface.
const NEAR_OF_SURFACE: f64 = 0.5;

/// The smallest near plane as a share of the usual one, for an eye that touches a surface.
const LEAST_NEAR: f32 = 1e-3;

/// Depth of the far plane / depth of the scene's farthest corner. Above 1, because a surface exactly at the
/// far plane looks like background.
const BEYOND: f32 = 1.001;

/// No note for surfaces that a plane cuts away by less than this share of its depth.
const SLACK: f64 = 1e-4;

/// If positions are this share of the near plane apart, the nearest surfaces lose their shape.
const COARSE: f32 = 0.25;

/// Lens, near plane and far plane of a stage's camera.
#[derive(Clone, Copy, Debug)]
pub struct Optics {
    lens: Option<Lens>,
    framing: Framing,
    near_m: f32,
    near_from: PlaneSource,
    /// The near plane if no surface is nearer, metres.
    usual_m: f32,
    far: Far,
}

/// The far plane.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Far {
    /// At a view depth, metres.
    At(f32, PlaneSource),
    /// Just beyond the scene.
    Bounds,
    /// No far plane.
    Infinite(PlaneSource),
}

impl Optics {
    /// The planes of the options, else of the file's camera, else those that suit the scene.
    /// `--camera X,Y,Z:X,Y,Z` ignores the file's cameras.
    ///
    /// # Errors
    ///
    /// A [`CliError`] that names the option at fault.
    pub fn new(scene: &Scene, args: &StageArgs) -> Result<Self, CliError> {
        let camera = file_camera(scene, args)?;
        let far = match (args.far, camera.and_then(|camera| camera.far_m)) {
            (Some(FarPlane::At(far)), _) => Far::At(far as f32, PlaneSource::Option),
            (Some(FarPlane::Infinite), _) => Far::Infinite(PlaneSource::Option),
            (None, None) if camera.is_some_and(|camera| camera.framing.is_endless) => {
                Far::Infinite(PlaneSource::File)
            }
            (None, Some(far)) => Far::At(far, PlaneSource::File),
            (None, None) => Far::Bounds,
        };
        let (near_m, near_from) = match (args.near, camera) {
            (Some(near), _) => (near as f32, PlaneSource::Option),
            (None, Some(camera)) => (camera.near_m, PlaneSource::File),
            (None, None) => {
                let near_m = (scene.core_bounds.diagonal() * NEAR_SHARE).max(1e-6);
                let most_m = if let Far::At(far_m, _) = far { 0.5 * far_m } else { near_m };
                (near_m.min(most_m), PlaneSource::Scene)
            }
        };
        let lens = camera.map(|camera| camera.lens);
        let framing = camera.map_or(Framing::PLAIN, |camera| camera.framing);
        let optics = Self { lens, framing, near_m, near_from, usual_m: near_m, far };
        optics.check()?;
        Ok(optics)
    }

    fn check(&self) -> Result<(), CliError> {
        if self.framing.clip_plane.is_some() && self.near_from == PlaneSource::Option {
            let accepted =
                "left out: the near plane of this scene's camera is oblique, and lies on a mirror";
            return Err(CliError::out_of_range("--near", &self.near_m.to_string(), accepted));
        }
        match self.far {
            Far::Infinite(_) if matches!(self.lens, Some(Lens::Orthographic { .. })) => {
                let accepted = "a number of metres, because the file's camera is orthographic";
                Err(CliError::out_of_range("--far", "infinite", accepted))
            }
            Far::At(far, source) if far <= self.near_m => {
                let (option, value, accepted) = match source {
                    PlaneSource::Option => {
                        let near = format!("above the near plane, {}", self.near());
                        ("--far", far, near)
                    }
                    _ => ("--near", self.near_m, format!("below the file's far plane, {far} m")),
                };
                Err(CliError::out_of_range(option, &value.to_string(), &accepted))
            }
            _ => Ok(()),
        }
    }

    /// The depth of the near plane and its source, in words.
    fn near(&self) -> String {
        format!("{} m {}", rounded(self.near_m.into()), source_words(self.near_from, "of --near"))
    }

    /// Moves the near plane in front of every surface in the views, unless an option or the file sets it.
    pub fn fit_near(&mut self, scene: &Scene, views: &[View]) {
        if self.near_from != PlaneSource::Scene {
            return;
        }
        let nearest_m = scene.nearest_shown_m(views, self.usual_m * CUT);
        let wanted = nearest_m.map_or(self.usual_m, |depth| (depth * NEAR_OF_SURFACE) as f32);
        self.near_m = wanted.clamp(self.usual_m * LEAST_NEAR, self.usual_m);
    }

    /// The view from a pose, for an image of a size in pixels.
    pub fn view(&self, scene: &Scene, pose: Pose, size: [u32; 2]) -> View {
        let less = self.framing.less_px;
        let size = [0, 1].map(|axis| size[axis].saturating_sub(less[axis]).max(1));
        let fov_y = match self.lens {
            Some(Lens::Perspective { fov_y }) => fov_y,
            _ => FOV_Y,
        };
        let mut view = View::looking(pose.eye, pose.forward(), pose.up, fov_y, self.near_m, size);
        if let Some(Lens::Orthographic { half_height, .. }) = self.lens {
            // The aspect ratio of the image sets the width of the view.
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
            Far::Infinite(_) => None,
        };
        self.framed(view)
    }

    /// A view around the axis, moved, mirrored and jittered as the camera's framing says.
    fn framed(&self, mut view: View) -> View {
        let Framing { shift, jitter_px, is_mirrored, before_px: [x, y], depth, clip_plane, .. } =
            self.framing;
        let window = |min: Vec2, max: Vec2| {
            let shift = shift * (max - min);
            let (mut min, mut max) = (min + shift, max + shift);
            if is_mirrored {
                std::mem::swap(&mut min.x, &mut max.x);
            }
            (min, max)
        };
        match &mut view.projection {
            Projection::Perspective { min, max } | Projection::Orthographic { min, max } => {
                (*min, *max) = window(*min, *max);
            }
        }
        (view.viewport.x, view.viewport.y) = (x, y);
        (view.jitter, view.depth) = (jitter_px, depth);
        clip_plane.map_or(view, |plane| view.with_near_plane(plane))
    }

    /// A view whose viewport covers the whole target of one of its views, also what lies to the right of the image
    /// and below it.
    pub fn target(&self, view: &View) -> View {
        let mut target = *view;
        let [right, below] = self.framing.after_px;
        target.viewport.width = target.viewport.width.saturating_add(right);
        target.viewport.height = target.viewport.height.saturating_add(below);
        target
    }

    /// Notes, one sentence each, for planes that cut away surfaces and for positions too large for f32.
    pub fn notes(&self, scene: &Scene, views: &[View]) -> Vec<String> {
        let mut notes = Vec::new();
        let given_far =
            if let Far::At(far_m, from) = self.far { Some((far_m, from)) } else { None };
        let is_least = self.near_m <= self.usual_m * LEAST_NEAR;
        let is_given = self.near_from != PlaneSource::Scene;
        let span = (is_given || is_least || given_far.is_some())
            .then(|| views.iter().filter_map(|view| scene.depths_shown(view)))
            .and_then(|spans| spans.reduce(DepthSpan::union));
        let shown = |metres: f64| significant(metres);
        if let Some(span) = span {
            let near_m = f64::from(self.near_m);
            if span.nearest_m < near_m * (1.0 - SLACK) {
                notes.push(format!(
                    "the nearest surface, at {} m, lies in front of the near plane, {} m {}: the view cuts such surfaces \
                     away",
                    shown(span.nearest_m),
                    shown(near_m),
                    source_words(self.near_from, "of --near"),
                ));
            }
            if let Some((far_m, from)) = given_far
                && span.farthest_m > f64::from(far_m) * (1.0 + SLACK)
            {
                notes.push(format!(
                    "the farthest surface, at {} m, lies behind the far plane, {} m {}: the view does not show such \
                     surfaces",
                    shown(span.farthest_m),
                    shown(f64::from(far_m)),
                    source_words(from, "of --far"),
                ));
            }
        }
        let off = |view: &&View| view.eye().abs().max_element();
        let Some(view) = views.iter().max_by(|a, b| off(a).total_cmp(&off(b))) else {
            return notes;
        };
        let off_m = off(&view);
        let step_m = off_m * f32::EPSILON;
        if step_m > finest_m(scene, view) {
            notes.push(format!(
                "the camera is {} m from the scene's origin, where f32 positions are up to {} m apart: the \
                 positions of surfaces and lights have errors of this size",
                shown(f64::from(off_m)),
                shown(f64::from(step_m)),
            ));
        }
        notes
    }

    /// The planes of one of its views, for the record.
    pub fn planes(&self, view: &View) -> Planes {
        Planes {
            near_m: f64::from(view.near_m),
            near_from: self.near_from,
            far_m: view.far_m.map(f64::from),
            far_from: match self.far {
                Far::At(_, source) => source,
                Far::Bounds => PlaneSource::Scene,
                Far::Infinite(source) => source,
            },
        }
    }

    /// The near plane, metres. In a view with a clip plane, this plane takes its place.
    pub fn near_m(&self) -> f32 {
        self.near_m
    }

    /// Moves the near plane of a view to that of [`fit_near`](Self::fit_near). A clip plane stays where it is.
    pub fn place_near(&self, view: &mut View) {
        if self.framing.clip_plane.is_none() {
            view.near_m = self.near_m;
        }
    }
}

/// The largest step between positions, metres, at which surfaces in a view keep their shape: a share of the
/// near plane. For an orthographic view it is one pixel; for a distant scene at most one pixel.
fn finest_m(scene: &Scene, view: &View) -> f32 {
    let core = scene.core_bounds;
    let eye = view.eye();
    let away_m = eye.distance(eye.clamp(core.min, core.max.max(core.min)));
    let height = view.viewport.height as f32;
    match view.projection {
        Projection::Orthographic { min, max } => (max.y - min.y) / height,
        // Nearer than the near plane, rounding may have moved the eye out of the core.
        Projection::Perspective { min, max } if away_m > view.near_m => {
            ((max.y - min.y) / height * away_m).min(COARSE * view.near_m)
        }
        Projection::Perspective { .. } => COARSE * view.near_m,
    }
}

/// The source of a plane's depth, in words.
fn source_words(from: PlaneSource, option: &'static str) -> &'static str {
    match from {
        PlaneSource::Option => option,
        PlaneSource::File => "of the file's camera",
        PlaneSource::Scene => "of the scene",
    }
}

#[cfg(test)]
mod tests;
