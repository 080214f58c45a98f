//! Reuse of lists over several frames: the `update` axis.

use crate::{AssignError, Assignment, Frame, Gpu, Passes, SampleDomain, leave_to_inner};

/// A strategy that makes its lists only every `frames` frames.
///
/// It is lossy if groups move with the camera, or if lights or models move: a sample then reads its
/// group's old list. It is lossless if nothing of that moves, as with grid cells and still lights.
pub struct Reuse {
    inner: Box<dyn Assignment>,
    frames: u32,
    /// Frames since the lists were made; `None` if they must be made again.
    age: Option<u32>,
    /// The buffers and counts for which the lists were made.
    made: Option<Made>,
}

#[derive(PartialEq)]
struct Made {
    lists: wgpu::Buffer,
    entries: wgpu::Buffer,
    light_count: u32,
    group_count: u32,
    samples: SampleDomain,
    generation: u32,
    /// Lists name places in an order of the lights.
    order: u32,
}

impl Reuse {
    /// Wraps a strategy. With `frames` 1 it makes its lists every frame.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] if `frames` is 0, and [`AssignError::Unsupported`] if lists have
    /// [trees](crate::Storage::Trees).
    pub fn new(inner: Box<dyn Assignment>, frames: u32) -> Result<Self, AssignError> {
        if frames == 0 {
            return Err(AssignError::Parameter {
                field: "frames of a list".into(),
                value: "0".into(),
                accepted: "1 or more".into(),
            });
        }
        inner.lists().check_later_frames(inner.id(), &format!("reuse{frames}"))?;
        Ok(Self { inner, frames, age: None, made: None })
    }
}

impl Assignment for Reuse {
    fn id(&self) -> String {
        format!("{}/reuse{}", self.inner.id(), self.frames)
    }

    leave_to_inner!(needs, is_view_bound, compile, lookup, bind_group, lists, memory_bytes);

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Self::new(self.inner.for_view(gpu)?, self.frames)?))
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        self.inner.prepare(gpu, frame)?;
        let lists = self.inner.lists();
        let now = Made {
            lists: lists.lists().clone(),
            entries: lists.entries().clone(),
            light_count: frame.lights.count(),
            group_count: lists.group_count(),
            samples: frame.samples,
            generation: lists.generation(),
            order: frame.lights.order_generation(),
        };
        // A new buffer holds no lists.
        if self.made.as_ref() != Some(&now) {
            self.made = Some(now);
            self.age = None;
        }
        Ok(())
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        let age = self.age.map_or(0, |age| (age + 1) % self.frames);
        if age == 0 {
            self.inner.record(frame, passes);
        } else {
            // The look-up reads old lists for the new view.
            self.inner.lists_mut().record_writes(passes.encoder());
        }
        self.age = Some(age);
    }
}
