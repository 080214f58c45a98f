//! Where the camera is, as a function of the frame number.

use glam::{Quat, Vec3};

use crate::{Pose, animated_node::AnimatedNode};

/// A smooth path of a camera.
#[derive(Clone, Debug)]
pub struct CameraPath(Way);

#[derive(Clone, Debug)]
enum Way {
    Still(Pose),
    /// Closed uniform Catmull-Rom splines through the eyes and the targets.
    Loop(Vec<(Vec3, Vec3)>),
    /// A glTF camera's animation, scaled by the factor.
    Animated(Box<AnimatedNode>, f32),
    /// Equal small steps away from a pose and back: metres and radians per frame.
    Steps {
        start: Pose,
        step_m: Vec3,
        turn: f32,
    },
    /// A cut in every frame: frame F shows pose F, and so on in turn.
    Cuts(Vec<Pose>),
}

impl CameraPath {
    /// A camera that does not move.
    pub fn still(pose: Pose) -> Self {
        Self(Way::Still(pose))
    }

    /// A closed loop through `(eye, target)` knots that starts at the first. It is a Catmull-Rom
    /// spline, so position and velocity are continuous. Knots should lie about evenly apart,
    /// because each takes the same time. With fewer than three knots the camera stays still, at the
    /// first one or at `fallback`.
    pub fn closed_loop(knots: Vec<(Vec3, Vec3)>, fallback: Pose) -> Self {
        if knots.len() < 3 {
            Self::still(knots.first().map_or(fallback, |k| Pose::new(k.0, k.1)))
        } else {
            Self(Way::Loop(knots))
        }
    }

    /// Moves by `step_m` metres (world space) and turns by `turn` radians to the left per frame. In the second
    /// half of a run it goes the same way back, so that the last frame is one step from the first.
    pub fn steps(start: Pose, step_m: Vec3, turn: f32) -> Self {
        Self(Way::Steps { start, step_m, turn })
    }

    /// Jumps in every frame: frame F shows the pose F modulo their number. Without poses, the camera stays at
    /// `fallback`.
    pub fn cuts(poses: Vec<Pose>, fallback: Pose) -> Self {
        if poses.is_empty() { Self::still(fallback) } else { Self(Way::Cuts(poses)) }
    }

    pub(crate) fn animated(node: AnimatedNode) -> Self {
        Self(Way::Animated(Box::new(node), 1.0))
    }

    /// Whether the camera moves.
    pub fn moves(&self) -> bool {
        !matches!(self.0, Way::Still(_))
    }

    /// Whether it comes from an animation of the scene's file.
    pub fn is_animation(&self) -> bool {
        matches!(self.0, Way::Animated(..))
    }

    /// The pose of frame `frame` of a run of `frame_count` frames.
    ///
    /// A loop closes after `frame_count` frames. An animation reaches its last key in frame
    /// `frame_count - 1`. Frames beyond the run wrap around.
    pub fn pose(&self, frame: u32, frame_count: u32) -> Pose {
        let count = frame_count.max(1);
        let frame = frame % count;
        match &self.0 {
            Way::Still(pose) => *pose,
            Way::Loop(knots) => loop_pose(knots, f64::from(frame) / f64::from(count)),
            Way::Animated(node, scale) => {
                let t = f64::from(frame) / f64::from((count - 1).max(1));
                node.pose(t as f32).scaled(*scale)
            }
            Way::Steps { start, step_m, turn } => {
                let steps = frame.min(count - frame) as f32;
                let forward = Quat::from_axis_angle(start.up.normalize(), steps * turn);
                Pose::looking(start.eye + steps * step_m, forward * start.forward(), start.up)
            }
            Way::Cuts(poses) => poses[frame as usize % poses.len()],
        }
    }

    /// The values of a frame that go into the path's hash: its eye, a point that it looks at, and
    /// its up direction. On a loop, that point is the spline's, so that hashes of earlier versions
    /// hold.
    pub(crate) fn marks(&self, frame: u32, frame_count: u32) -> [Vec3; 3] {
        let pose = self.pose(frame, frame_count);
        let target = match &self.0 {
            Way::Loop(knots) => {
                let count = frame_count.max(1);
                loop_points(knots, f64::from(frame % count) / f64::from(count)).1
            }
            _ => pose.eye + pose.forward(),
        };
        [pose.eye, target, pose.up]
    }

    /// Scaled about the origin.
    pub fn scaled(self, factor: f32) -> Self {
        Self(match self.0 {
            Way::Still(pose) => Way::Still(pose.scaled(factor)),
            Way::Loop(mut knots) => {
                for (eye, target) in &mut knots {
                    *eye *= factor;
                    *target *= factor;
                }
                Way::Loop(knots)
            }
            Way::Animated(node, scale) => Way::Animated(node, scale * factor),
            Way::Steps { start, step_m, turn } => {
                Way::Steps { start: start.scaled(factor), step_m: step_m * factor, turn }
            }
            Way::Cuts(poses) => {
                Way::Cuts(poses.into_iter().map(|pose| pose.scaled(factor)).collect())
            }
        })
    }
}

/// The pose at `turn` (0..1) of the closed spline through `knots`.
fn loop_pose(knots: &[(Vec3, Vec3)], turn: f64) -> Pose {
    let (eye, target) = loop_points(knots, turn);
    Pose::new(eye, target)
}

/// Eye and target at `turn` (0..1) of the closed spline through `knots`.
fn loop_points(knots: &[(Vec3, Vec3)], turn: f64) -> (Vec3, Vec3) {
    let n = knots.len();
    let at = turn.rem_euclid(1.0) * n as f64;
    let segment = (at as usize).min(n - 1);
    let t = (at - segment as f64) as f32;
    let knot = |offset: usize| knots[(segment + n + offset - 1) % n];
    let (p, q, r, s) = (knot(0), knot(1), knot(2), knot(3));
    (catmull_rom(p.0, q.0, r.0, s.0, t), catmull_rom(p.1, q.1, r.1, s.1, t))
}

/// Uniform Catmull-Rom from `q` (t = 0) to `r` (t = 1).
pub(crate) fn catmull_rom(p: Vec3, q: Vec3, r: Vec3, s: Vec3, t: f32) -> Vec3 {
    let linear = 0.5 * (r - p);
    let square = p - 2.5 * q + 2.0 * r - 0.5 * s;
    let cube = 0.5 * (s - p) + 1.5 * (q - r);
    q + t * (linear + t * (square + t * cube))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn square() -> CameraPath {
        let corners = [(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (0.0, 4.0)];
        let knots = corners.map(|(x, z)| (Vec3::new(x, 1.0, z), Vec3::new(2.0, 1.0, 2.0)));
        CameraPath::closed_loop(knots.to_vec(), Pose::new(Vec3::ZERO, Vec3::X))
    }

    #[test]
    fn loops_pass_their_knots_and_close() {
        let path = square();
        assert_eq!(path.pose(0, 1200).eye, Vec3::new(0.0, 1.0, 0.0));
        assert_eq!(path.pose(300, 1200).eye, Vec3::new(4.0, 1.0, 0.0));
        assert_eq!(path.pose(1200, 1200), path.pose(0, 1200));
        assert_eq!(path.pose(7, 0), path.pose(0, 1));
    }

    /// Second differences of a C1 cubic are bounded by its curvature, here under 40 m per turn
    /// squared, times the step squared. A kink would be of the order of the step itself.
    #[test]
    fn velocity_is_continuous() {
        let path = square();
        let n = 1200;
        for frame in 0..n {
            let eye = |offset: u32| path.pose(frame + offset, n).eye;
            let bend = (eye(2) - 2.0 * eye(1) + eye(0)).length();
            assert!(bend < 1e-3, "frame {frame}: {bend}");
        }
    }

    #[test]
    fn steps_are_equal_and_the_last_frame_is_one_step_from_the_first() {
        let start = Pose::new(Vec3::ZERO, Vec3::NEG_Z);
        let path = CameraPath::steps(start, Vec3::new(0.01, 0.0, 0.0), 1e-3).scaled(2.0);
        assert_eq!(path.pose(0, 9), start);
        for frame in 0..10 {
            let (here, next) = (path.pose(frame, 10), path.pose(frame + 1, 10));
            assert!((here.eye.distance(next.eye) - 0.02).abs() < 1e-6, "frame {frame}");
            let turn = here.forward().angle_between(next.forward());
            assert!((turn - 1e-3).abs() < 2e-4, "frame {frame}: {turn}");
        }
        // It turns to the left.
        assert!(path.pose(3, 10).forward().x < 0.0);
    }

    #[test]
    fn cuts_show_their_poses_in_turn() {
        let [a, b] = [1.0, 2.0].map(|x| Pose::new(Vec3::X * x, Vec3::ZERO));
        let path = CameraPath::cuts(vec![a, a, b], b);
        let eyes: Vec<f32> = (0..6).map(|frame| path.pose(frame, 1200).eye.x).collect();
        assert_eq!(eyes, [1.0, 1.0, 2.0, 1.0, 1.0, 2.0]);
        assert_eq!(CameraPath::cuts(Vec::new(), b).pose(0, 1), b);
    }

    #[test]
    fn scaling_scales_eyes() {
        let path = square().scaled(2.0);
        assert_eq!(path.pose(300, 1200).eye, Vec3::new(8.0, 2.0, 0.0));
    }
}
