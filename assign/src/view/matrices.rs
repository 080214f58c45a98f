//! Views from the matrices of another renderer.
//!
//! Engines differ in the direction of view (along -Z or +Z), in handedness, in the direction of clip y and in clip
//! depth. None of these changes which point of the world a pixel shows. [`View::from_matrices`] therefore turns view
//! space until it is this crate's, and the window takes the opposite turn:
//!
//! ```text
//! clip = view_to_clip * world_to_view * p = (view_to_clip * turn^-1) * (turn * world_to_view) * p
//! ```
//!
//! `turn` exchanges or negates axes, so it rounds nothing.

use glam::{DMat3, DMat4, DVec2, DVec3, DVec4, Mat4};

use super::{DepthMapping, Projection, View, ViewError, Viewport, depth_row::DepthRow};

/// Lengths and angles of a rotation may be off by this share: that of [`View::check`].
const RIGID: f64 = 1e-4;

/// An orthographic near plane this share of the depth range behind the eye is one at the eye, rounded.
const AT_EYE: f64 = 1e-6;

/// The names of elements, by row and column.
type Names = [[&'static str; 4]; 4];

const WORLD_TO_VIEW: Names = [
    ["world_to_view[0][0]", "world_to_view[0][1]", "world_to_view[0][2]", "world_to_view[0][3]"],
    ["world_to_view[1][0]", "world_to_view[1][1]", "world_to_view[1][2]", "world_to_view[1][3]"],
    ["world_to_view[2][0]", "world_to_view[2][1]", "world_to_view[2][2]", "world_to_view[2][3]"],
    ["world_to_view[3][0]", "world_to_view[3][1]", "world_to_view[3][2]", "world_to_view[3][3]"],
];

const VIEW_TO_CLIP: Names = [
    ["view_to_clip[0][0]", "view_to_clip[0][1]", "view_to_clip[0][2]", "view_to_clip[0][3]"],
    ["view_to_clip[1][0]", "view_to_clip[1][1]", "view_to_clip[1][2]", "view_to_clip[1][3]"],
    ["view_to_clip[2][0]", "view_to_clip[2][1]", "view_to_clip[2][2]", "view_to_clip[2][3]"],
    ["view_to_clip[3][0]", "view_to_clip[3][1]", "view_to_clip[3][2]", "view_to_clip[3][3]"],
];

impl View {
    /// The view of a renderer that has matrices of its own: `clip = view_to_clip * world_to_view * p` for a column `p`
    /// in metres. Clip z / w is the depth buffer's value, from 0 to 1, as in Direct3D, Metal, Vulkan and WebGPU.
    /// [`View::from_gl_matrices`] takes OpenGL's matrices.
    ///
    /// Every perspective and orthographic projection is accepted: standard or reversed depth, a finite or infinite far
    /// plane, jitter, off-centre windows, views along -Z or +Z, mirrored ones (a planar reflection in `world_to_view`),
    /// flipped clip axes, images turned by a quarter, and oblique near planes.
    ///
    /// - `world_to_view` must keep lengths, because ranges of lights are metres in all spaces.
    /// - Clip y = 1 is the upper edge of the viewport, as in wgpu. In Vulkan's own clip space y points down: negate
    ///   row 1 of such a matrix first.
    /// - [`View::depth`] becomes the direction in which clip depth runs along the rays of pixels.
    /// - An orthographic view looks along -Z or +Z: the one on which its planes lie in front of the eye.
    /// - Jitter becomes a part of the window, and [`View::jitter`] is 0.
    ///
    /// Row 2 of [`View::view_to_clip`] equals the given one bit for bit (divided by the given scale of w, if that is
    /// not 1), so samples have the depths that the renderer draws. The other fields are rounded to f32: points move in
    /// the window by at most 2^-21 of its farthest coordinate.
    ///
    /// # Errors
    ///
    /// A [`ViewError`] that names the element at fault, such as `view_to_clip[3][0]` (row 3, column 0), its value, and
    /// what it must be.
    pub fn from_matrices(
        world_to_view: Mat4,
        view_to_clip: Mat4,
        viewport: Viewport,
    ) -> Result<Self, ViewError> {
        check_finite(view_to_clip, &VIEW_TO_CLIP)?;
        from_clip(world_to_view, view_to_clip.as_dmat4(), viewport)
    }

    /// As [`View::from_matrices`], for a `view_to_clip` whose clip z / w runs from -1 to 1, as in OpenGL. The depth
    /// buffer holds `0.5 * z / w + 0.5`, from 0 to 1, which is the default of `glDepthRange`. The row that gives this
    /// value is rounded to f32 once.
    ///
    /// After `glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE)` a renderer's matrices are those of
    /// [`View::from_matrices`]. The first row of the depth texture must be the upper one, as in wgpu.
    ///
    /// # Errors
    ///
    /// As [`View::from_matrices`].
    pub fn from_gl_matrices(
        world_to_view: Mat4,
        view_to_clip: Mat4,
        viewport: Viewport,
    ) -> Result<Self, ViewError> {
        check_finite(view_to_clip, &VIEW_TO_CLIP)?;
        let mut rows = view_to_clip.as_dmat4().transpose();
        rows.z_axis = 0.5 * (rows.z_axis + rows.w_axis);
        from_clip(world_to_view, rows.transpose(), viewport)
    }
}

/// The view of matrices whose clip depth runs from 0 to 1.
fn from_clip(
    world_to_view: Mat4,
    view_to_clip: DMat4,
    viewport: Viewport,
) -> Result<View, ViewError> {
    let is_right_handed = check_rigid(world_to_view)?;
    let (perspective, clip) = check_projection(view_to_clip)?;
    // Exchange x and y if the image is turned by a quarter.
    let across = if clip.row(0).x == 0.0 {
        DMat3::from_cols(DVec3::Y, DVec3::X, DVec3::Z)
    } else {
        DMat3::IDENTITY
    };
    // Turn the direction of view to -Z, and mirror x if the view is left-handed then.
    let towards = |z: f64| {
        let turn = DMat3::from_diagonal(DVec3::new(1.0, 1.0, z)) * across;
        let keeps = (turn.determinant() > 0.0) == is_right_handed;
        let mirror = DVec3::new(if keeps { 1.0 } else { -1.0 }, 1.0, 1.0);
        DMat4::from_mat3(DMat3::from_diagonal(mirror) * turn)
    };
    let (turn, seen) = if perspective {
        let turn = towards(if clip.row(3).z > 0.0 { -1.0 } else { 1.0 });
        (turn, Seen::new(perspective, clip * turn.transpose())?)
    } else {
        // Only the places of the planes tell where an orthographic view looks.
        let [ahead, behind] = [1.0, -1.0].map(towards);
        match Seen::new(perspective, clip * ahead.transpose()) {
            Ok(seen) => (ahead, seen),
            Err(error) => match Seen::new(perspective, clip * behind.transpose()) {
                Ok(seen) => (behind, seen),
                Err(_) => return Err(error),
            },
        }
    };
    let [min, max] = seen.window.map(DVec2::as_vec2);
    let far_m = seen.far_m as f32;
    let plain = View {
        world_to_view: turn.as_mat4() * world_to_view,
        projection: match perspective {
            true => Projection::Perspective { min, max },
            false => Projection::Orthographic { min, max },
        },
        near_m: seen.near_m as f32,
        far_m: far_m.is_finite().then_some(far_m),
        depth: seen.depth,
        depth_row: None,
        viewport,
        jitter: glam::Vec2::ZERO,
    };
    let row = seen.row.as_vec4();
    let depth_row = (plain.view_to_clip().row(2) != row).then_some(row);
    let view = View { depth_row, ..plain };
    view.check()?;
    Ok(view)
}

/// What a projection along -Z shows.
struct Seen {
    window: [DVec2; 2],
    row: DVec4,
    depth: DepthMapping,
    near_m: f64,
    far_m: f64,
}

impl Seen {
    fn new(perspective: bool, clip: DMat4) -> Result<Self, ViewError> {
        let scale = DVec2::new(clip.row(0).x, clip.row(1).y);
        let shift = if perspective { clip.z_axis } else { -clip.w_axis };
        let shift = shift.truncate().truncate();
        let window = [(shift - 1.0) / scale, (shift + 1.0) / scale];
        let row = clip.row(2);
        let depth_row = DepthRow { perspective, row };
        let column = if perspective { 3 } else { 2 };
        let Some(depth) = depth_row.direction() else {
            let accepted = "other than 0: it tells the depths of a ray's points apart";
            return Err(fault(&VIEW_TO_CLIP, [2, column], row[column], accepted));
        };
        let hidden = |place: String| ViewError {
            field: VIEW_TO_CLIP[2][3],
            value: format!("{}, {place}", row.w),
            accepted: "that of a near plane in front of the eye: move the eye by world_to_view",
        };
        match depth_row.span_m(window, 0.0) {
            None => Err(hidden("which hides the whole window".into())),
            Some((near_m, far_m)) if near_m < -AT_EYE * (far_m - near_m) => {
                Err(hidden(format!("which puts the near plane at {near_m} m")))
            }
            Some((near_m, far_m)) => {
                Ok(Self { window, row, depth, near_m: near_m.max(0.0), far_m })
            }
        }
    }
}

fn fault(
    names: &Names,
    [row, column]: [usize; 2],
    value: f64,
    accepted: &'static str,
) -> ViewError {
    ViewError { field: names[row][column], value: value.to_string(), accepted }
}

/// Refuses NaN and infinite elements.
fn check_finite(matrix: Mat4, names: &Names) -> Result<(), ViewError> {
    for row in 0..4 {
        for column in 0..4 {
            let value = matrix.row(row)[column];
            if !value.is_finite() {
                return Err(fault(names, [row, column], value.into(), "finite"));
            }
        }
    }
    Ok(())
}

/// Whether a transform that keeps lengths also keeps handedness. Refuses others.
fn check_rigid(world_to_view: Mat4) -> Result<bool, ViewError> {
    check_finite(world_to_view, &WORLD_TO_VIEW)?;
    let matrix = world_to_view.as_dmat4();
    for column in 0..4 {
        let (value, wanted, accepted) = match column {
            3 => (matrix.row(3).w, 1.0, "1: the projection belongs in view_to_clip"),
            _ => (matrix.row(3)[column], 0.0, "0: the projection belongs in view_to_clip"),
        };
        if value != wanted {
            return Err(fault(&WORLD_TO_VIEW, [3, column], value, accepted));
        }
    }
    let linear = DMat3::from_mat4(matrix);
    let gram = linear.transpose() * linear;
    let determinant = linear.determinant();
    if gram.abs_diff_eq(DMat3::IDENTITY, RIGID) {
        return Ok(determinant > 0.0);
    }
    let scale = determinant.abs().cbrt();
    let is_uniform = gram.abs_diff_eq(scale * scale * DMat3::IDENTITY, RIGID * scale * scale);
    Err(ViewError {
        field: "world_to_view",
        value: match is_uniform && scale > 0.0 {
            true => format!("a transform of scale {scale}"),
            false => format!("a transform with shear or uneven scale, {world_to_view}"),
        },
        accepted: "a rotation, a translation and mirrors: scale the models and the lights instead",
    })
}

/// Whether a projection is perspective, and its matrix with w = ±z or w = 1. Refuses what is no projection.
fn check_projection(view_to_clip: DMat4) -> Result<(bool, DMat4), ViewError> {
    let fail = |place: [usize; 2], accepted| {
        Err(fault(&VIEW_TO_CLIP, place, view_to_clip.row(place[0])[place[1]], accepted))
    };
    let w = view_to_clip.row(3);
    for column in 0..2 {
        if w[column] != 0.0 {
            return fail([3, column], "0: w depends on z or is constant");
        }
    }
    let perspective = w.z != 0.0;
    if perspective && w.w != 0.0 {
        return fail([3, 3], "0 in a perspective projection, whose w is z or -z");
    }
    if !perspective && w.w <= 0.0 {
        return fail([3, 3], "above 0 in an orthographic projection, whose [3][2] is 0");
    }
    let clip = view_to_clip * (1.0 / if perspective { w.z.abs() } else { w.w });
    let [x, y] = [clip.row(0), clip.row(1)];
    // The columns of the axes that clip x and clip y show.
    let axes = if x.x == 0.0 && y.y == 0.0 { [1, 0] } else { [0, 1] };
    for row in 0..2 {
        let values = clip.row(row);
        if values[axes[row]] == 0.0 {
            return fail([row, row], "other than 0: the image has a width and a height");
        }
        if values[axes[1 - row]] != 0.0 {
            return fail(
                [row, axes[1 - row]],
                "0: turn the camera by world_to_view, without shear",
            );
        }
        if perspective && values.w != 0.0 {
            return fail([row, 3], "0 in a perspective projection: move the eye by world_to_view");
        }
        if !perspective && values.z != 0.0 {
            return fail([row, 2], "0 in an orthographic projection, whose rays are parallel to z");
        }
    }
    Ok((perspective, clip))
}
