//! No culling: every sample's list holds all lights. It is the ground truth for lists, and `None`
//! in the comparison.

use crate::{
    AssignError, Assignment, Frame, Gpu, LightLists, ListsBindings, Lookup, Needs, Passes,
    StrategyModule,
};

/// The strategy that assigns every light to every sample.
#[derive(Debug)]
pub struct Everything {
    lists: LightLists,
    bindings: ListsBindings,
}

impl Everything {
    /// Makes the strategy.
    pub fn new(gpu: &Gpu) -> Result<Self, AssignError> {
        Ok(Self {
            lists: LightLists::new(gpu)?,
            bindings: ListsBindings::of_look_up(gpu, "None", &[]),
        })
    }

    /// The same strategy for another view: [`Assignment::for_view`].
    ///
    /// # Errors
    ///
    /// [`AssignError::OutOfMemory`] if the device has no memory left.
    pub fn view(&self, gpu: &Gpu) -> Result<Self, AssignError> {
        let mut view = Self::new(gpu)?;
        view.lists.limit_as(&self.lists);
        Ok(view)
    }
}

impl Assignment for Everything {
    fn id(&self) -> String {
        "None".into()
    }

    fn needs(&self) -> Needs {
        Needs::default()
    }

    fn specular_reach(&self) -> f32 {
        f32::INFINITY
    }

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(self.view(gpu)?))
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        frame.view.check()?;
        self.lists.prepare(gpu, frame.lights, 0)?;
        self.bindings.bind(gpu, &self.lists, &[]);
        Ok(())
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        self.lists.record_reset(passes.encoder(), frame.lights.live_count());
    }

    fn lookup(&self) -> Lookup<'_> {
        // SAFETY: it has no loop.
        #[allow(unsafe_code, reason = "it has no loop")]
        let module = unsafe { StrategyModule::new(include_str!("shaders/everything.wesl")) };
        Lookup { module, bindings: &self.bindings, shape: None }
    }

    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.bindings.bind_group()
    }

    fn lists(&self) -> &LightLists {
        &self.lists
    }

    fn lists_mut(&mut self) -> &mut LightLists {
        &mut self.lists
    }

    fn memory_bytes(&self) -> u64 {
        self.lists.memory_bytes()
    }
}
