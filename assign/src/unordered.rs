//! Lists in a random order: **a flaw**, to show what it does.
//!
//! # Idea
//!
//! The simplest kernel that makes lists lets each hit take the next place of its list by an atomic. Which hit comes
//! first then depends on how the GPU happens to schedule its lanes, so the order of a list differs from frame to
//! frame. Here a pass shuffles the finished lists by [`Frame::seed`], so that frames differ and runs repeat.
//!
//! # Where it fails
//!
//! - Shading sums in another order in each frame, so the last bits of the image flicker, also if nothing moves.
//! - With a cap on the length of lists, the lights that are lost differ from frame to frame: groups pop.
//!
//! # Cost
//!
//! The pass `shuffle` swaps entries in `6 log2 n` rounds for a list of length `n`. It stands for no cost of a real
//! renderer, where an atomic costs less than the order that it gives up.

use crate::{
    AssignError, Assignment, Frame, FrameBindings, Gpu, ListsBindings, Passes, Shader, Storage,
    entries::uniform_entry, entry, kernel, leave_to_inner,
};

/// Bind group of the lists in the kernel.
const LISTS_GROUP: u32 = 1;

/// A strategy whose lists have another order in each frame. With a cap, each list keeps its first lights only.
pub struct Unordered {
    inner: Box<dyn Assignment>,
    frame: FrameBindings,
    lists: ListsBindings,
    list_cap: Option<u32>,
    cap: wgpu::Buffer,
    pipeline: wgpu::ComputePipeline,
}

impl Unordered {
    /// Wraps a strategy. `cap` is the most lights of a list: it must be given here and not to
    /// [`LightLists::cap_lists`](crate::LightLists::cap_lists), which would drop lights before their order is random.
    ///
    /// # Errors
    ///
    /// [`AssignError::Unsupported`] if the strategy keeps lights in anything but lists ([`Storage::Lists`]), and
    /// [`AssignError::Parameter`] if the cap is 0.
    pub fn new(
        gpu: &Gpu,
        inner: Box<dyn Assignment>,
        cap: Option<u32>,
    ) -> Result<Self, AssignError> {
        if inner.lists().storage() != Storage::Lists {
            return Err(AssignError::Unsupported {
                strategy: inner.id(),
                asked: "lists in a random order".into(),
                reason: "only a plain list can be read in any order".into(),
            });
        }
        if cap == Some(0) {
            return Err(AssignError::Parameter {
                field: "lights of a list".into(),
                value: "0".into(),
                accepted: "1 or more".into(),
            });
        }
        let frame = FrameBindings::new(gpu);
        let own = uniform_entry(crate::FIRST_STRATEGY_BINDING, wgpu::ShaderStages::COMPUTE);
        let lists = ListsBindings::of_kernel(gpu, "shuffle", &[own]);
        let module = shader().create(gpu, "package::shuffle")?;
        let layouts = [frame.layout(), lists.layout()];
        let pipeline = kernel::pipeline(gpu, &module, "shuffle_lists", &layouts);
        let buffer = gpu.uniform("shuffle", 16);
        let words = [cap.unwrap_or(u32::MAX), 0, 0, 0];
        gpu.queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&words));
        Ok(Self { inner, frame, lists, list_cap: cap, cap: buffer, pipeline })
    }

    /// The kernel's linked WGSL.
    pub fn kernel_source() -> Result<String, AssignError> {
        shader().link("package::shuffle")
    }
}

fn shader() -> Shader<'static> {
    Shader::new(LISTS_GROUP).module("package::shuffle", include_str!("shaders/shuffle.wesl"))
}

impl Assignment for Unordered {
    fn id(&self) -> String {
        format!("{}/unordered", self.inner.id())
    }

    leave_to_inner!(needs, is_view_bound, compile, lookup, bind_group, lists);

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Self::new(gpu, self.inner.for_view(gpu)?, self.list_cap)?))
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        self.inner.prepare(gpu, frame)?;
        self.frame.update_in(gpu, frame, self.inner.lists_mut().writes_mut())?;
        let cap = entry(crate::FIRST_STRATEGY_BINDING, &self.cap);
        self.lists.bind(gpu, self.inner.lists(), &[cap]);
        Ok(())
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        self.inner.record(frame, passes);
        let groups = kernel::workgroups(u64::from(self.inner.lists().group_count()), 1);
        passes.compute("shuffle", &mut |pass| {
            pass.set_bind_group(0, self.frame.bind_group(), &[]);
            pass.set_bind_group(LISTS_GROUP, self.lists.bind_group(), &[]);
            pass.set_pipeline(&self.pipeline);
            pass.dispatch_workgroups(groups, 1, 1);
        });
    }

    fn memory_bytes(&self) -> u64 {
        self.inner.memory_bytes() + self.frame.bytes() + self.cap.size()
    }
}
