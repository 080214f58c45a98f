//! A strategy that stays with the view and the depth buffer of its first frame.

use assign::{AssignError, Assignment, Frame, Gpu, Passes, SampleDomain, View, leave_to_inner};

/// Its lists are of the first frame's surfaces and of every frame's lights.
pub(crate) struct FirstView {
    inner: Box<dyn Assignment>,
    first: Option<(View, Option<wgpu::TextureView>)>,
}

impl FirstView {
    pub(crate) fn new(inner: Box<dyn Assignment>) -> Self {
        Self { inner, first: None }
    }
}

fn frame_of<'a>(
    (view, depth): &'a (View, Option<wgpu::TextureView>),
    frame: &Frame<'a>,
    samples: SampleDomain,
) -> Frame<'a> {
    let first = Frame::new(view, frame.lights).sampled_at(samples);
    match depth {
        Some(depth) => first.with_depth(depth),
        None => first,
    }
}

impl Assignment for FirstView {
    fn id(&self) -> String {
        self.inner.id()
    }

    leave_to_inner!(needs, lookup, bind_group, lists, memory_bytes);

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Self::new(self.inner.for_view(gpu)?)))
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        let first = self.first.take().unwrap_or_else(|| (*frame.view, frame.depth.cloned()));
        self.inner.prepare(gpu, &frame_of(&first, frame, frame.samples))?;
        self.first = Some(first);
        Ok(())
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        if let Some(first) = &self.first {
            self.inner.record(&frame_of(first, frame, frame.samples), passes);
        }
    }
}
