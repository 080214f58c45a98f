//! The row of a projection that gives clip z: which view depths it shows, and oblique near planes.
//!
//! An oblique near plane is not perpendicular to the viewing axis. A renderer of planar reflections puts it on the
//! mirror, so that nothing behind the mirror is drawn (Lengyel 2005, "Oblique View Frustum Depth Projection and
//! Clipping"). Clip depth then depends on the pixel too. With `p = (x, y, z, 1)` in view space,
//!
//! ```text
//! clip depth = dot(row, p) / w = tilt + (row.z z + row.w) / w,    tilt = row.x x / w + row.y y / w
//! ```
//!
//! where `(x, y) / w` is the place in the window, in both projections. Along the ray of a pixel `tilt` is constant, so
//! view depth follows from clip depth as it does without it. Tiles and slices are bounded by view depth, so they are
//! the same for all near planes.

use glam::{DVec2, DVec3, DVec4, Vec2, Vec4, swizzles::Vec4Swizzles};

use super::{DepthMapping, View, ViewError};

/// `near_m` and `far_m` may differ from those of the row by this share of the near plane's place.
const SAME: f64 = 1e-3;

/// A row that gives clip z, in f64.
#[derive(Clone, Copy, Debug)]
pub(super) struct DepthRow {
    pub(super) perspective: bool,
    pub(super) row: DVec4,
}

impl DepthRow {
    /// Which way depth runs along rays; `None` if it is constant along them.
    pub(super) fn direction(&self) -> Option<DepthMapping> {
        let slope = if self.perspective { self.row.w } else { self.row.z };
        match slope {
            slope if slope < 0.0 => Some(DepthMapping::Standard),
            slope if slope > 0.0 => Some(DepthMapping::Reversed),
            _ => None,
        }
    }

    /// The place of a clip depth along the ray through a point of the window: 1 / view depth in perspective, else
    /// view depth. It is linear in the window and in clip depth.
    fn place(&self, window: DVec2, depth_clip: f64) -> f64 {
        let tilt = self.row.xy().dot(window);
        if self.perspective {
            (depth_clip + self.row.z - tilt) / self.row.w
        } else {
            (self.row.w - depth_clip + tilt) / self.row.z
        }
    }

    /// The view depths that the row shows along the ray through a point of the window, metres. The second is infinite
    /// if the far plane does not cut the ray, and both are `None` if the near plane hides all of it.
    pub(super) fn shown_m(&self, depth: DepthMapping, window: DVec2) -> Option<(f64, f64)> {
        self.shown_among(depth, &[window], 0.0)
    }

    /// The least and the greatest view depth that the row shows at some of the points of the window, and so between
    /// them. Places are widened by a share of the numbers that they are computed from.
    fn shown_among(
        &self,
        depth: DepthMapping,
        windows: &[DVec2],
        slack: f64,
    ) -> Option<(f64, f64)> {
        let (near_clip, far_clip) = match depth {
            DepthMapping::Standard => (0.0, 1.0),
            DepthMapping::Reversed => (1.0, 0.0),
        };
        let size = |window: &DVec2| (self.row.xy() * *window).abs().element_sum();
        let (other, slope) =
            if self.perspective { (self.row.z, self.row.w) } else { (self.row.w, self.row.z) };
        let size = windows.iter().map(size).fold(0.0, f64::max) + 1.0 + other.abs();
        let slack = slack * size / slope.abs();
        let places = |depth_clip| windows.iter().map(move |window| self.place(*window, depth_clip));
        if self.perspective {
            let nearest = places(near_clip).fold(f64::NEG_INFINITY, f64::max) + slack;
            let farthest = places(far_clip).fold(f64::INFINITY, f64::min) - slack;
            let far_m = if farthest > 0.0 { 1.0 / farthest } else { f64::INFINITY };
            (nearest > 0.0).then_some((1.0 / nearest, far_m))
        } else {
            let near_m = places(near_clip).fold(f64::INFINITY, f64::min) - slack;
            let far_m = places(far_clip).fold(f64::NEG_INFINITY, f64::max) + slack;
            near_m.is_finite().then_some((near_m, far_m))
        }
    }

    /// The least and the greatest view depth that the row shows in a window; the second may be infinite. `None` if
    /// the near plane hides all of the window, or depth is constant.
    pub(super) fn span_m(&self, [min, max]: [DVec2; 2], slack: f64) -> Option<(f64, f64)> {
        let corners = [min, DVec2::new(max.x, min.y), DVec2::new(min.x, max.y), max];
        self.shown_among(self.direction()?, &corners, slack)
    }
}

impl View {
    /// This view with an oblique near plane: it draws only the points `p` of the world with
    /// `dot(plane_world.xyz, p) + plane_world.w >= 0`. The eye must lie on the other side, as it does behind a mirror.
    /// The normal may have any length.
    ///
    /// `near_m` becomes the nearest view depth of the plane in the window. The far plane tilts too. It cuts away
    /// nothing in front of `far_m`, which becomes its farthest view depth, or `None` (Lengyel 2005, "Oblique View
    /// Frustum Depth Projection and Clipping", here for clip depths from 0 to 1).
    ///
    /// [`View::check`] refuses the view if the plane hides all of the window, or if the eye lies on the side that the
    /// plane shows.
    #[must_use]
    pub fn with_near_plane(self, plane_world: Vec4) -> Self {
        let (perspective, min, max) = self.projection.window();
        let (min, max) = (min.as_dvec2(), max.as_dvec2());
        // Planes transform by the transpose of the inverse, which is the way back.
        let to_world = self.world_to_view.as_dmat4().inverse();
        let plane = to_world.transpose() * plane_world.as_dvec4();
        // Clip depth is 1 at the corner of the far plane that lies farthest in front of the near plane.
        let in_front = |x: f64, y: f64| {
            let corner = match (perspective, self.far_m) {
                // Per metre of view depth.
                (true, far_m) => {
                    DVec4::new(x, y, -1.0, far_m.map_or(0.0, |far_m| 1.0 / f64::from(far_m)))
                }
                (false, far_m) => {
                    DVec4::new(x, y, -f64::from(far_m.unwrap_or(self.near_m + 1.0)), 1.0)
                }
            };
            plane.dot(corner)
        };
        let corners = [(min.x, min.y), (max.x, min.y), (min.x, max.y), (max.x, max.y)];
        let most = corners.map(|(x, y)| in_front(x, y)).into_iter().fold(0.0, f64::max);
        let standard = if most > 0.0 { plane / most } else { DVec4::ZERO };
        let w = if perspective { DVec4::new(0.0, 0.0, -1.0, 0.0) } else { DVec4::W };
        let row = match self.depth {
            DepthMapping::Standard => standard,
            DepthMapping::Reversed => w - standard,
        };
        let view = Self { depth_row: Some(row.as_vec4()), ..self };
        let Some((near_m, far_m)) = view.row().span_m([min, max], 0.0) else {
            return view;
        };
        let far_m = far_m as f32;
        Self { near_m: near_m as f32, far_m: far_m.is_finite().then_some(far_m), ..view }
    }

    /// The view depths, metres, between which the ray through a point of the window is drawn: at view depth 1 in
    /// perspective, at every depth else. The second is infinite without a far plane on this ray. `None` if the near
    /// plane hides the whole ray.
    pub fn shown_m(&self, window: DVec2) -> Option<(f64, f64)> {
        if self.is_tilted() {
            return self.row().shown_m(self.depth, window);
        }
        Some((self.near_m.into(), self.far_m.map_or(f64::INFINITY, f64::from)))
    }

    /// Whether clip depth depends on the pixel.
    pub(super) fn is_tilted(&self) -> bool {
        self.depth_row.is_some_and(|row| row.xy() != Vec2::ZERO)
    }

    /// The row that gives clip z.
    fn row(&self) -> DepthRow {
        let (perspective, ..) = self.projection.window();
        DepthRow { perspective, row: self.view_to_clip().row(2).as_dvec4() }
    }

    /// The least and the greatest view depth that shading can rebuild in a view of an oblique near plane, metres. The
    /// second is `None` if it is unbounded.
    pub(super) fn rebuilt_span_m(&self) -> (f32, Option<f32>) {
        let (_, min, max) = self.window();
        // Shading adds four numbers, each of them rounded, and divides to 2.5 units in the last place.
        let slack = 8.0 * f64::from(f32::EPSILON);
        let Some((near_m, far_m)) = self.row().span_m([min.as_dvec2(), max.as_dvec2()], slack)
        else {
            return (0.0, None);
        };
        let far_m = (far_m * (1.0 + slack)) as f32;
        ((near_m - slack * near_m.abs()) as f32, far_m.is_finite().then_some(far_m))
    }

    /// [`ViewUniform::depth_tilt`](super::ViewUniform::depth_tilt).
    pub(super) fn depth_tilt(&self) -> [f32; 3] {
        let Some(row) = self.depth_row.filter(|_| self.is_tilted()) else {
            return [0.0; 3];
        };
        let (_, min, max) = self.window();
        let (min, max) = (min.as_dvec2(), max.as_dvec2());
        let port = self.viewport;
        let origin = DVec2::new(port.x.into(), port.y.into());
        let size = DVec2::new(port.width.into(), port.height.into());
        // Image y points down, so the upper left corner of the window is (min.x, max.y).
        let per_pixel = row.xy().as_dvec2() * (max - min) * DVec2::new(1.0, -1.0) / size;
        let upper_left = row.xy().as_dvec2().dot(DVec2::new(min.x, max.y));
        DVec3::new(per_pixel.x, per_pixel.y, upper_left - per_pixel.dot(origin))
            .as_vec3()
            .to_array()
    }

    /// Checks that `depth_row` agrees with the other fields.
    pub(super) fn check_depth_row(&self) -> Result<(), ViewError> {
        let Some(given) = self.depth_row else {
            return Ok(());
        };
        let fail =
            |accepted| Err(ViewError { field: "depth_row", value: given.to_string(), accepted });
        if !given.is_finite() {
            return fail("finite");
        }
        let (perspective, min, max) = self.projection.window();
        if self.row().direction() != Some(self.depth) {
            return fail(match perspective {
                true => {
                    "of the direction of `depth`: w below 0 for standard, above 0 for reversed (the eye lies behind the near plane)"
                }
                false => {
                    "of the direction of `depth`: z below 0 for standard, above 0 for reversed"
                }
            });
        }
        let Some((near_m, far_m)) = self.row().span_m([min.as_dvec2(), max.as_dvec2()], 0.0) else {
            return fail("that of a near plane which hides only a part of the window");
        };
        // Places along the axis: those that are linear in clip depth.
        let given_far = self.far_m.map_or(f64::INFINITY, f64::from);
        let given_near = f64::from(self.near_m);
        let (off, size) = if perspective {
            ([1.0 / near_m - 1.0 / given_near, 1.0 / far_m - 1.0 / given_far], 1.0 / near_m)
        } else {
            ([near_m - given_near, far_m - given_far], far_m - near_m)
        };
        // Written so that NaN fails.
        if !off.iter().all(|off| off.abs() <= SAME * size) {
            return fail("None, or a row that shows view depths from near_m to far_m");
        }
        Ok(())
    }
}
