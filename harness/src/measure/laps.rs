//! Frames that differ: along the camera's path, or of lights that move.
//!
//! 1. Pools grow, at some poses that are spread over the path.
//! 2. Images are compared with that of no culling, in a lap of its own off the clock: comparing them
//!    keeps the CPU busy for long, and the GPU's clock would fall among the timed frames.
//! 3. All methods warm up.
//! 4. Lap after lap, each pose is drawn with all methods on the clock, in an order of its own. A lap
//!    takes the same poses each time, so laps are repetitions of each other, as rounds are from a
//!    still camera. Lists that are used for several frames are made anew where a lap begins.

use super::{Compare, Contest, Shown, Timetable};
use crate::{error::HarnessError, schedule::Orders, stage::Stage};

/// Poses along the path at which pools grow before the clock starts: on a GPU, and on a software
/// adapter.
const SETTLING_POSES: [u32; 2] = [24, 6];

impl Contest<'_> {
    /// Grows the pools, then compares the images at some poses.
    pub(super) fn compare_along_path(
        &mut self,
        stage: &mut Stage,
        timetable: Timetable<'_>,
        seen: &mut Compare<'_>,
    ) -> Result<(), HarnessError> {
        let Timetable { timed, remember } = timetable;
        let count = self.plan.timed;
        let poses = SETTLING_POSES[usize::from(self.gpu.is_software())].min(count);
        for pose in 0..poses {
            stage.go_to(pose * count / poses, count)?;
            for &method in timed {
                // Methods without lists have no pool to grow, and no culling is slow to draw.
                if !self.contenders[method].painter.has_groups() {
                    continue;
                }
                for _ in 0..2 {
                    self.draw(stage, method)?;
                }
            }
        }
        self.expire_lists(stage);
        let checks = self.plan.compared_frames();
        for pose in 0..=checks.last().copied().unwrap_or(0) {
            let is_checked = checks.contains(&pose);
            if !is_checked && remember.is_empty() {
                continue;
            }
            stage.go_to(pose, count)?;
            if !is_checked {
                for &method in remember {
                    self.draw(stage, method)?;
                }
                continue;
            }
            self.draw_reference(stage)?;
            let reference = self.reference.as_ref().map(|(method, _)| *method);
            let mut images = Vec::new();
            for &method in timed {
                if Some(method) == reference {
                    images.push(Shown::Same);
                    continue;
                }
                self.draw(stage, method)?;
                images.extend(self.look(stage)?);
            }
            if reference.is_some() {
                seen(pose, &images)?;
            }
            stage.count_left_out()?;
        }
        Ok(())
    }

    /// Takes the times, lap after lap.
    pub(super) fn time_along_path(
        &mut self,
        stage: &mut Stage,
        timed: &[usize],
        orders: &mut Orders,
        tick: &mut dyn FnMut(),
    ) -> Result<(), HarnessError> {
        let count = self.plan.timed;
        stage.go_to(0, count)?;
        self.warm_up(stage, timed)?;
        for _ in 0..self.plan.laps {
            self.expire_lists(stage);
            for pose in 0..count {
                stage.go_to(pose, count)?;
                for place in orders.next_round() {
                    self.frame(stage, timed[place])?;
                    tick();
                }
            }
        }
        stage.count_left_out()
    }

    /// Has lists and orders of lights that are used for several frames made anew, so that they are of the
    /// same age at a pose in every lap and on every run.
    fn expire_lists(&mut self, stage: &mut Stage) {
        stage.expire_order();
        for contender in &mut self.contenders {
            contender.painter.expire();
        }
    }
}
