//! The camera: world → view → clip → pixel, for every projection a renderer uses.
//!
//! View space is right-handed: +X right, +Y up, and the camera looks along -Z. *View depth* is
//! `-z`, positive in front of the camera. Clip depth runs from 0 to 1, reversed or not.
//!
//! [`View::from_matrices`] makes a view from the matrices of another renderer, whatever its conventions are.

mod depth_row;
mod extent;
mod matrices;
mod uniform;

use glam::{Mat4, Vec2, Vec3, Vec4};
use thiserror::Error;

pub use uniform::ViewUniform;

/// The window that the camera looks through.
///
/// Where a coordinate of `min` exceeds that of `max`, the image is flipped along this axis, as the image of a
/// planar mirror is ([`View::is_mirrored`]).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Perspective. The bounds are tangents: the window's corners at view depth 1.
    Perspective {
        /// Lower left corner `(left, bottom)` at view depth 1.
        min: Vec2,
        /// Upper right corner `(right, top)` at view depth 1.
        max: Vec2,
    },
    /// Orthographic. The bounds are metres.
    Orthographic {
        /// Lower left corner `(left, bottom)`, metres.
        min: Vec2,
        /// Upper right corner `(right, top)`, metres.
        max: Vec2,
    },
}

impl Projection {
    /// Whether it is perspective, and the window's corners.
    fn window(self) -> (bool, Vec2, Vec2) {
        match self {
            Self::Perspective { min, max } => (true, min, max),
            Self::Orthographic { min, max } => (false, min, max),
        }
    }
}

/// How clip depth maps to view depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DepthMapping {
    /// Near plane at 0, far plane at 1.
    Standard,
    /// Near plane at 1, far plane at 0, which gives floating-point depth an even precision.
    Reversed,
}

/// The part of the render target in which the image lies, pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Viewport {
    /// Left edge inside the target.
    pub x: u32,
    /// Top edge inside the target.
    pub y: u32,
    /// Width, `> 0`.
    pub width: u32,
    /// Height, `> 0`.
    pub height: u32,
}

/// One camera for one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// World to view space: a rotation and a translation.
    pub world_to_view: Mat4,
    /// The window that the camera looks through.
    pub projection: Projection,
    /// View depth of the near plane, metres: `> 0` for perspective, `>= 0` for orthographic.
    pub near_m: f32,
    /// View depth of the far plane, metres, `> near`; `None` means infinitely far (perspective
    /// only).
    pub far_m: Option<f32>,
    /// Direction of clip depth.
    pub depth: DepthMapping,
    /// The row of [`View::view_to_clip`] that gives clip z, if it is not the one that `near_m`, `far_m` and `depth`
    /// give: that of an oblique near plane ([`View::with_near_plane`]), or the row of a given matrix bit for bit
    /// ([`View::from_matrices`]).
    ///
    /// `near_m` and `far_m` must then be the view depths of the nearest and the farthest point that the row shows
    /// in the window without jitter. To change them or `depth`, set this field to `None`.
    pub depth_row: Option<Vec4>,
    /// The part of the target in which the image lies.
    pub viewport: Viewport,
    /// Shift of the image in pixels, +X right and +Y down, as temporal anti-aliasing uses it.
    pub jitter: Vec2,
}

/// Why a view is faulty.
#[derive(Clone, Debug, PartialEq, Error)]
#[error("view: {field} is {value}: it must be {accepted}")]
pub struct ViewError {
    /// The field's name.
    pub field: &'static str,
    /// The offending value.
    pub value: String,
    /// The accepted values.
    pub accepted: &'static str,
}

impl View {
    /// A perspective camera at `eye` that looks at `target`, with reversed infinite depth and no
    /// jitter.
    pub fn look_at(eye: Vec3, target: Vec3, fov_y: f32, near_m: f32, size: [u32; 2]) -> Self {
        let forward = (target - eye).normalize_or(Vec3::NEG_Z);
        let up = if forward.y.abs() > 0.999 { Vec3::Z } else { Vec3::Y };
        Self::looking(eye, forward, up, fov_y, near_m, size)
    }

    /// A perspective camera at `eye` that looks along the unit vector `forward`, with reversed
    /// infinite depth and no jitter. A direction keeps its precision however far the eye is from
    /// the origin.
    pub fn looking(
        eye: Vec3,
        forward: Vec3,
        up: Vec3,
        fov_y: f32,
        near_m: f32,
        size: [u32; 2],
    ) -> Self {
        let top = (fov_y * 0.5).tan();
        let corner = Vec2::new(top * size[0] as f32 / size[1].max(1) as f32, top);
        Self {
            world_to_view: glam::camera::rh::view::look_to_mat4(eye, forward, up),
            projection: Projection::Perspective { min: -corner, max: corner },
            near_m,
            far_m: None,
            depth: DepthMapping::Reversed,
            depth_row: None,
            viewport: Viewport { x: 0, y: 0, width: size[0], height: size[1] },
            jitter: Vec2::ZERO,
        }
    }

    /// Checks every field.
    pub fn check(&self) -> Result<(), ViewError> {
        let fail = |field, value: String, accepted| Err(ViewError { field, value, accepted });
        if !self.is_rigid() {
            return fail(
                "world_to_view",
                self.world_to_view.to_string(),
                "a rotation and a translation, without scale, shear or mirror",
            );
        }
        let (perspective, min, max) = self.window();
        let is_open = (max - min).abs().min_element() > 0.0;
        if !(min.is_finite() && max.is_finite() && is_open) {
            return fail(
                "projection",
                format!("{min} to {max}"),
                "a finite window whose width and height are not 0",
            );
        }
        let near_ok =
            self.near_m.is_finite() && (self.near_m > 0.0 || (!perspective && self.near_m == 0.0));
        if !near_ok {
            return fail(
                "near",
                self.near_m.to_string(),
                "above 0 (0 is allowed for orthographic)",
            );
        }
        match self.far_m {
            Some(far) if !(far.is_finite() && far > self.near_m) => {
                return fail("far", far.to_string(), "finite and above near");
            }
            None if !perspective => {
                return fail("far", "infinite".into(), "finite for orthographic");
            }
            _ => {}
        }
        let Viewport { width, height, .. } = self.viewport;
        if width == 0 || height == 0 {
            return fail("viewport", format!("{width}x{height}"), "at least 1x1 pixels");
        }
        if !self.jitter.is_finite() {
            return fail("jitter", self.jitter.to_string(), "finite");
        }
        self.check_depth_row()?;
        if !self.view_to_clip().is_finite() {
            return fail("far", format!("{:?}", self.far_m), "small enough for f32, or infinite");
        }
        Ok(())
    }

    /// Whether `world_to_view` preserves lengths and handedness, so that a light's range is the
    /// same in all spaces.
    fn is_rigid(&self) -> bool {
        let matrix = self.world_to_view;
        let linear = glam::Mat3::from_mat4(matrix);
        let gram = linear.transpose() * linear;
        matrix.is_finite()
            && matrix.row(3) == Vec4::W
            && gram.abs_diff_eq(glam::Mat3::IDENTITY, 1e-4)
            && linear.determinant() > 0.0
    }

    /// Whether the view is perspective, and the window's corners with jitter applied.
    fn window(&self) -> (bool, Vec2, Vec2) {
        let (perspective, min, max) = self.projection.window();
        let size = Vec2::new(self.viewport.width.max(1) as f32, self.viewport.height.max(1) as f32);
        // To move the image right, the window moves left. Image y points down.
        let shift = Vec2::new(-self.jitter.x, self.jitter.y) * (max - min) / size;
        (perspective, min + shift, max + shift)
    }

    /// Whether the image is that of a mirror: its window is flipped along one axis. The front of a triangle then
    /// appears clockwise in the image.
    pub fn is_mirrored(&self) -> bool {
        let (_, min, max) = self.window();
        (max.x < min.x) != (max.y < min.y)
    }

    /// The eye, world space.
    pub fn eye(&self) -> Vec3 {
        self.world_to_view.inverse().w_axis.truncate()
    }

    /// View to clip space, with jitter. [`View::depth`] sets the direction of clip depth.
    /// [`View::depth_row`] takes the place of the third row.
    pub fn view_to_clip(&self) -> Mat4 {
        let (perspective, min, max) = self.window();
        let near = self.near_m;
        // Clip depth is (a z + b) / w with w = -z or 1; at_near and at_far are its end values.
        let (at_near, at_far) = match self.depth {
            DepthMapping::Standard => (0.0, 1.0),
            DepthMapping::Reversed => (1.0, 0.0),
        };
        let (a, b) = match (perspective, self.far_m) {
            (true, Some(far)) => (
                (at_near * near - at_far * far) / (far - near),
                near * (far / (far - near)) * (at_near - at_far),
            ),
            (true, None) => (-at_far, near * (at_near - at_far)),
            (false, far) => {
                let far = far.unwrap_or(near + 1.0);
                ((at_near - at_far) / (far - near), (at_near * far - at_far * near) / (far - near))
            }
        };
        let row = self.depth_row.unwrap_or(Vec4::new(0.0, 0.0, a, b));
        let scale = 2.0 / (max - min);
        let offset = (max + min) / (max - min);
        if perspective {
            Mat4::from_cols(
                Vec4::new(scale.x, 0.0, row.x, 0.0),
                Vec4::new(0.0, scale.y, row.y, 0.0),
                Vec4::new(offset.x, offset.y, row.z, -1.0),
                Vec4::new(0.0, 0.0, row.w, 0.0),
            )
        } else {
            Mat4::from_cols(
                Vec4::new(scale.x, 0.0, row.x, 0.0),
                Vec4::new(0.0, scale.y, row.y, 0.0),
                Vec4::new(0.0, 0.0, row.z, 0.0),
                Vec4::new(-offset.x, -offset.y, row.w, 1.0),
            )
        }
    }

    /// World to clip space.
    pub fn world_to_clip(&self) -> Mat4 {
        self.view_to_clip() * self.world_to_view
    }

    /// The clip depth to which a depth buffer is cleared: the far end.
    pub fn depth_clear(&self) -> f32 {
        match self.depth {
            DepthMapping::Standard => 1.0,
            DepthMapping::Reversed => 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_rigid_transforms_are_views() {
        let view = View::look_at(Vec3::ONE, Vec3::ZERO, 1.0, 0.1, [64, 48]);
        assert_eq!(view.check(), Ok(()));
        let mut sheared = Mat4::IDENTITY;
        sheared.y_axis.x = 0.2;
        for bad in [
            Mat4::from_scale(Vec3::splat(0.5)),
            Mat4::from_scale(Vec3::splat(2.0)),
            Mat4::from_scale(Vec3::new(-1.0, 1.0, 1.0)),
            Mat4::ZERO,
            sheared,
        ] {
            let error = View { world_to_view: bad * view.world_to_view, ..view }.check();
            assert_eq!(error.map_err(|e| e.field), Err("world_to_view"), "{bad}");
        }
    }

    #[test]
    fn a_flipped_window_mirrors_the_image() {
        let view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 0.1, [64, 48]);
        let Projection::Perspective { min, max } = view.projection else { panic!() };
        let flipped = |x: bool, y: bool| {
            let pick = |flip: bool, a: f32, b: f32| if flip { (b, a) } else { (a, b) };
            let ((x_min, x_max), (y_min, y_max)) = (pick(x, min.x, max.x), pick(y, min.y, max.y));
            let (min, max) = (Vec2::new(x_min, y_min), Vec2::new(x_max, y_max));
            View { projection: Projection::Perspective { min, max }, ..view }
        };
        let right = Vec4::new(0.5, 0.2, -2.0, 1.0);
        let seen = |view: &View| (view.view_to_clip() * right).truncate().truncate();
        for (x, y) in [(true, false), (false, true), (true, true)] {
            let flipped = flipped(x, y);
            assert_eq!(flipped.check(), Ok(()));
            assert_eq!(flipped.is_mirrored(), x != y);
            let sign = Vec2::new(if x { -1.0 } else { 1.0 }, if y { -1.0 } else { 1.0 });
            assert_eq!(seen(&flipped), sign * seen(&view));
        }
        let flat = Projection::Perspective { min, max: Vec2::new(min.x, max.y) };
        let error = View { projection: flat, ..view }.check().map_err(|error| error.field);
        assert_eq!(error, Err("projection"));
    }

    #[test]
    fn a_far_plane_at_the_end_of_f32_overflows_nothing() {
        let mut view = View::look_at(Vec3::ONE, Vec3::ZERO, 1.0, 10.0, [64, 48]);
        view.far_m = Some(f32::MAX);
        for depth in [DepthMapping::Standard, DepthMapping::Reversed] {
            view.depth = depth;
            assert_eq!(view.check(), Ok(()));
            let clip = view.view_to_clip();
            assert!(clip.is_finite(), "{depth:?}: not finite: {clip}");
            let depth_of = |depth_m: f32| {
                let point = clip * Vec4::new(0.0, 0.0, -depth_m, 1.0);
                point.z / point.w
            };
            // The near plane and a distant point have the right depths.
            let near = 1.0 - view.depth_clear();
            assert!(
                (depth_of(10.0) - near).abs() < 1e-6,
                "{depth:?}: the near plane has depth {}",
                depth_of(10.0)
            );
            assert!((depth_of(1e9) - view.depth_clear()).abs() < 1e-6, "{depth:?}");
        }
    }
}
