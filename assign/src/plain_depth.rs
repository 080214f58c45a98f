//! Lists from view depths that ignore an oblique near plane: **a flaw that loses lights**, to show what it does.
//!
//! # Idea
//!
//! Many renderers turn clip depth into view depth by two numbers, `b / (depth - a)`, which near and far plane give.
//! An oblique near plane, such as a mirror's, makes clip depth depend on the pixel too
//! ([`View::with_near_plane`]). The two numbers then give the depths of other samples.
//!
//! # Where it fails
//!
//! Bounds made from these depths hold other parts of the scene. In reflections, tiles and clusters lack the lights of
//! what they show. Views without an oblique near plane stay right.

use crate::{AssignError, Assignment, Frame, Gpu, Passes, View, leave_to_inner};

/// A strategy that makes its lists as if the near plane were perpendicular to the viewing axis. Shading rebuilds
/// samples as the view says.
pub struct PlainDepth {
    inner: Box<dyn Assignment>,
}

impl PlainDepth {
    /// Wraps a strategy.
    pub fn new(inner: Box<dyn Assignment>) -> Self {
        Self { inner }
    }
}

/// The view with the planes that `near_m` and `far_m` give.
fn plain(view: &View) -> View {
    View { depth_row: None, ..*view }
}

impl Assignment for PlainDepth {
    fn id(&self) -> String {
        format!("{}/plain-depth", self.inner.id())
    }

    leave_to_inner!(needs, is_view_bound, compile, lookup, bind_group, lists, memory_bytes);

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Self::new(self.inner.for_view(gpu)?)))
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        self.inner.prepare(gpu, &Frame { view: &plain(frame.view), ..*frame })
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        self.inner.record(&Frame { view: &plain(frame.view), ..*frame }, passes);
    }
}
