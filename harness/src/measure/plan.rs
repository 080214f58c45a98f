//! Which methods are timed, and which frames are drawn.

use shading::Cut;

use crate::cli::MAX_CHECKS;

/// Which methods of a [`Contest`](super::Contest) are timed, by index.
#[derive(Clone, Copy, Debug)]
pub struct Timetable<'a> {
    /// Those on the clock.
    pub timed: &'a [usize],
    /// Of those, the ones whose lists depend on the frames before: along a path they must see every
    /// pose before the one that is compared.
    pub remember: &'a [usize],
}

/// Which frames to draw.
#[derive(Clone, Copy, Debug)]
pub struct Plan {
    /// Frames of each method before the clock starts, at least: a GPU is warmed until its times are
    /// steady ([`WarmUp`](crate::drift::WarmUp)). 0: no warm-up.
    pub warmup: u32,
    /// Frames of each method on the clock; along a path, poses of one lap.
    pub timed: u32,
    /// How often the camera goes along its path, one pose per frame; 0: it stands still.
    pub laps: u32,
    /// Frames whose images are compared, 8 at most. They differ, or follow each other.
    pub checks: u32,
    /// Whether the frames whose images are compared follow each other.
    pub is_temporal: bool,
    /// Decides the order of methods in each round.
    pub seed: u64,
    /// How fall-off ends.
    pub cut: Cut,
    /// Whether light operations are counted.
    pub operations: bool,
}

impl Plan {
    /// The frames whose images are compared: poses of a lap.
    pub(crate) fn compared_frames(&self) -> Vec<u32> {
        match (self.is_temporal, self.laps) {
            (true, 0) => (0..self.checks).collect(),
            (true, _) => (0..self.checks.min(self.timed)).collect(),
            (false, _) => checked_poses(self.timed, self.checks),
        }
    }
}

/// The poses at which images are compared: an odd number of poses apart, so that lists used for 2, 4
/// or 8 frames are seen at every age.
fn checked_poses(poses: u32, checks: u32) -> Vec<u32> {
    let step = (poses / MAX_CHECKS).saturating_sub(1).max(1) | 1;
    (0..poses).step_by(step as usize).take(checks as usize).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reused_lists_are_seen_at_every_age() {
        for poses in [60, 120, 240, 1_200] {
            let checks = checked_poses(poses, MAX_CHECKS);
            assert_eq!(checks.len(), MAX_CHECKS as usize, "{poses}");
            assert!(checks.iter().all(|pose| *pose < poses), "{poses}: {checks:?}");
            let ages: std::collections::BTreeSet<u32> =
                checks.iter().map(|pose| pose % 8).collect();
            assert_eq!(ages.len(), 8, "{poses}: {checks:?}");
        }
        assert_eq!(checked_poses(1, MAX_CHECKS), [0]);
        assert_eq!(checked_poses(3, MAX_CHECKS), [0, 1, 2]);
        assert_eq!(checked_poses(240, 1), [0]);
    }
}
