//! Matrices that are no view are refused, each with the element at fault and what it must be.

use assign::{View, Viewport};
use glam::{Mat4, Vec3};

const PORT: Viewport = Viewport { x: 0, y: 0, width: 64, height: 48 };

fn camera() -> Mat4 {
    glam::camera::rh::view::look_to_mat4(Vec3::new(1.0, 2.0, 3.0), Vec3::NEG_Z, Vec3::Y)
}

fn perspective() -> Mat4 {
    glam::camera::rh::proj::directx::perspective(1.0, 1.5, 0.1, 100.0)
}

fn orthographic() -> Mat4 {
    glam::camera::rh::proj::directx::orthographic(-4.0, 4.0, -3.0, 3.0, 0.0, 50.0)
}

/// The matrix with another element.
fn with(matrix: Mat4, row: usize, column: usize, value: f32) -> Mat4 {
    let mut matrix = matrix;
    matrix.col_mut(column)[row] = value;
    matrix
}

#[test]
fn what_is_no_projection_is_refused() {
    let cases = [
        (with(perspective(), 3, 0, 0.1), "view_to_clip[3][0]", "0.1", "0: w depends on z"),
        (with(perspective(), 3, 1, -0.2), "view_to_clip[3][1]", "-0.2", "0: w depends on z"),
        (with(perspective(), 3, 3, 1.0), "view_to_clip[3][3]", "1", "0 in a perspective"),
        (with(orthographic(), 3, 3, 0.0), "view_to_clip[3][3]", "0", "above 0 in an orthographic"),
        (
            with(orthographic(), 3, 3, -1.0),
            "view_to_clip[3][3]",
            "-1",
            "above 0 in an orthographic",
        ),
        (with(perspective(), 0, 0, 0.0), "view_to_clip[0][0]", "0", "other than 0"),
        (with(perspective(), 1, 1, 0.0), "view_to_clip[1][1]", "0", "other than 0"),
        (Mat4::ZERO, "view_to_clip[3][3]", "0", "above 0"),
        (with(perspective(), 0, 1, 0.3), "view_to_clip[0][1]", "0.3", "without shear"),
        (with(perspective(), 1, 0, 0.3), "view_to_clip[1][0]", "0.3", "without shear"),
        (with(perspective(), 0, 3, 0.1), "view_to_clip[0][3]", "0.1", "move the eye"),
        (with(orthographic(), 1, 2, 0.1), "view_to_clip[1][2]", "0.1", "rays are parallel"),
        (with(perspective(), 2, 3, 0.0), "view_to_clip[2][3]", "0", "other than 0"),
        (with(orthographic(), 2, 2, 0.0), "view_to_clip[2][2]", "0", "other than 0"),
        // A near plane behind the eye.
        (
            with(perspective(), 2, 3, 0.1),
            "view_to_clip[2][3]",
            "hides the whole window",
            "in front",
        ),
        (with(orthographic(), 2, 3, 0.5), "view_to_clip[2][3]", "near plane at -25", "in front"),
        (with(perspective(), 1, 2, f32::NAN), "view_to_clip[1][2]", "NaN", "finite"),
        (with(perspective(), 2, 2, f32::INFINITY), "view_to_clip[2][2]", "inf", "finite"),
    ];
    for (bad, field, value, accepted) in cases {
        let error = View::from_matrices(camera(), bad, PORT).expect_err(field);
        assert_eq!(error.field, field, "{error}");
        assert!(error.value.contains(value) && error.accepted.contains(accepted), "{error}");
    }
    for good in [perspective(), orthographic()] {
        assert!(View::from_matrices(camera(), good, PORT).is_ok(), "{good}");
    }
}

#[test]
fn transforms_that_change_lengths_are_refused() {
    let scaled = |by: Vec3| Mat4::from_scale(by) * camera();
    let mut sheared = Mat4::IDENTITY;
    sheared.y_axis.x = 0.2;
    let cases = [
        (scaled(Vec3::splat(2.0)), "world_to_view", "scale 2", "scale the models"),
        (scaled(Vec3::splat(-0.5)), "world_to_view", "scale 0.5", "scale the models"),
        (scaled(Vec3::new(1.0, 1.1, 1.0)), "world_to_view", "uneven scale", "scale the models"),
        (sheared * camera(), "world_to_view", "shear", "a rotation"),
        (Mat4::ZERO, "world_to_view[3][3]", "0", "1: the projection"),
        (with(camera(), 3, 0, 0.1), "world_to_view[3][0]", "0.1", "0: the projection"),
        (perspective() * camera(), "world_to_view[3][2]", "-1", "0: the projection"),
        (with(camera(), 1, 3, f32::NAN), "world_to_view[1][3]", "NaN", "finite"),
        (with(Mat4::ZERO, 3, 3, 1.0), "world_to_view", "uneven scale", "a rotation"),
    ];
    for (bad, field, value, accepted) in cases {
        let error = View::from_matrices(bad, perspective(), PORT).expect_err(field);
        assert_eq!(error.field, field, "{error}");
        assert!(error.value.contains(value) && error.accepted.contains(accepted), "{error}");
        assert_eq!(
            View::from_gl_matrices(bad, perspective(), PORT).map_err(|e| e.field),
            Err(field)
        );
    }
    let mirror = Mat4::from_scale(Vec3::new(1.0, -1.0, 1.0));
    assert!(View::from_matrices(camera() * mirror, perspective(), PORT).is_ok());
}

#[test]
fn an_empty_viewport_is_refused() {
    let flat = Viewport { height: 0, ..PORT };
    let error = View::from_matrices(camera(), perspective(), flat).expect_err("empty");
    assert_eq!(error.field, "viewport");
}
