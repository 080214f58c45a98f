//! The camera's path through the atrium.

use glam::Vec3;

use crate::{CameraPath, Pose};

/// Leads through the court, up to the gallery's parapet and down again, out between columns at its
/// east end, along the north walkway and back in at the west end. Each knot is (x, y, z) of the eye
/// and of the point looked at.
pub(super) fn path() -> CameraPath {
    let knots = [
        ([-9.2, 1.9, 4.4], [3.0, 2.9, -2.6]),
        ([-6.2, 3.4, 4.3], [4.0, 2.8, -3.0]),
        ([-3.0, 5.6, 4.2], [6.0, 2.5, -3.0]),
        ([0.2, 7.0, 4.1], [9.0, 2.3, -2.5]),
        ([3.4, 6.2, 3.8], [11.0, 2.2, -2.5]),
        ([6.4, 4.2, 2.9], [13.0, 2.2, -3.0]),
        ([9.1, 2.5, 1.7], [14.0, 2.2, -4.5]),
        ([11.6, 1.7, 0.4], [13.5, 2.1, -8.0]),
        ([13.0, 1.7, -2.3], [12.0, 2.0, -9.0]),
        ([12.8, 1.7, -5.3], [9.0, 2.1, -9.0]),
        ([11.2, 1.8, -7.7], [3.0, 2.2, -8.2]),
        ([8.2, 2.3, -8.1], [-1.0, 2.3, -7.8]),
        ([5.0, 3.0, -8.1], [-4.0, 2.3, -7.8]),
        ([1.8, 3.3, -8.1], [-7.0, 2.2, -7.8]),
        ([-1.4, 3.0, -8.1], [-10.0, 2.1, -7.7]),
        ([-4.6, 2.3, -8.1], [-13.0, 2.0, -7.2]),
        ([-7.8, 1.8, -8.1], [-14.0, 2.0, -5.0]),
        ([-10.9, 1.7, -7.6], [-13.0, 2.0, -1.5]),
        ([-12.8, 1.7, -5.2], [-9.5, 2.1, 1.0]),
        ([-13.0, 1.7, -2.2], [-5.0, 2.2, 1.0]),
        ([-12.3, 1.8, 0.5], [-2.0, 2.5, -0.5]),
        ([-10.6, 1.9, 2.4], [1.0, 2.8, -2.0]),
    ];
    let knots: Vec<_> = knots.map(|(eye, target)| (Vec3::from(eye), Vec3::from(target))).to_vec();
    let start = Pose::new(knots[0].0, knots[0].1);
    CameraPath::closed_loop(knots, start)
}
