//! The strategy M: models, whole or in parts.

use assign::{
    AssignError, Assignment, CullSettings, Culler, CullerDescriptor, FIRST_STRATEGY_BINDING,
    Facing, Frame, Gpu, GroupShape, Groups, LightLists, LightTraits, Lookup, ModelBox, Needs,
    Passes, SampleDomain, StrategyModule, entry, storage_entry,
};
use bytemuck::cast_slice;

use crate::parts::{ModelRecord, Parts};

/// The strategy M: each model, or each part of a model, has a list of lights.
#[derive(Debug)]
pub struct PerModel {
    limit_m: Option<f32>,
    settings: CullSettings,
    /// The boxes whose parts the buffers hold.
    boxes: Option<Vec<ModelBox>>,
    models: wgpu::Buffer,
    model_of_group: wgpu::Buffer,
    group_count: u32,
    culler: Culler,
}

/// The strategy's WESL module: `group_of` and `group_bounds`.
pub const MODELS_WESL: &str = include_str!("shaders/models.wesl");

impl PerModel {
    /// Makes the strategy. `limit_m` is the largest size of a part along each axis of its model's
    /// box, metres, 0.001 to 1,000,000; `None` leaves models whole.
    pub fn new(
        gpu: &Gpu,
        limit_m: Option<f32>,
        settings: CullSettings,
    ) -> Result<Self, AssignError> {
        if let Some(limit) = limit_m.filter(|limit| !(1e-3..=1e6).contains(limit)) {
            return Err(AssignError::Parameter {
                field: "size of a part".into(),
                value: limit.to_string(),
                accepted: "0.001 to 1000000 m".into(),
            });
        }
        Ok(Self {
            limit_m,
            settings,
            boxes: None,
            models: gpu.storage("models", size_of::<ModelRecord>() as u64)?,
            model_of_group: gpu.storage("model of group", 0)?,
            group_count: 0,
            culler: Culler::new(
                gpu,
                &CullerDescriptor {
                    label: "M",
                    shape: GroupShape::OrientedBox,
                    settings,
                    sparse: false,
                    facing: Facing::Unknown,
                    // SAFETY: it has no loop.
                    #[allow(unsafe_code, reason = "it has no loop")]
                    module: unsafe { StrategyModule::new(MODELS_WESL) },
                    bindings: &bindings(),
                },
            )?,
        })
    }

    /// What the strategy needs of a device with such settings.
    pub fn required_limits(settings: CullSettings) -> wgpu::Limits {
        Culler::required_limits(&bindings(), false, settings)
    }

    /// The same strategy for another view: [`Assignment::for_view`].
    ///
    /// # Errors
    ///
    /// [`AssignError::OutOfMemory`] if the device has no memory left.
    pub fn view(&self, gpu: &Gpu) -> Result<Self, AssignError> {
        let mut view = Self::new(gpu, self.limit_m, self.settings)?;
        view.culler.share(&self.culler);
        Ok(view)
    }

    /// Cuts the models and uploads the parts, unless the models are the last frame's. Other models get other buffers,
    /// because commands that are not submitted yet may read the old ones.
    fn upload(&mut self, gpu: &Gpu, boxes: &[ModelBox]) -> Result<(), AssignError> {
        if self.boxes.as_deref() == Some(boxes) {
            return Ok(());
        }
        let parts = Parts::new(boxes, self.limit_m)?;
        let (models, of_group): (&[u8], &[u8]) =
            (cast_slice(&parts.models), cast_slice(&parts.model_of_group));
        let buffers = [
            gpu.storage("models", models.len().max(size_of::<ModelRecord>()) as u64)?,
            gpu.storage("model of group", of_group.len() as u64)?,
        ];
        [self.models, self.model_of_group] = buffers;
        gpu.queue.write_buffer(&self.models, 0, models);
        gpu.queue.write_buffer(&self.model_of_group, 0, of_group);
        self.group_count = parts.model_of_group.len() as u32;
        self.boxes = Some(boxes.to_vec());
        Ok(())
    }
}

/// The strategy's resources that culling and the look-up read.
fn bindings() -> [wgpu::BindGroupLayoutEntry; 2] {
    let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
    [0, 1].map(|place| storage_entry(FIRST_STRATEGY_BINDING + place, stages, true))
}

impl Assignment for PerModel {
    fn id(&self) -> String {
        let limit = self.limit_m.map_or(String::new(), |limit| format!("/{limit}"));
        format!("M{limit}{}", self.settings.suffix(GroupShape::OrientedBox))
    }

    fn needs(&self) -> Needs {
        let hierarchy = self.culler.reads_hierarchy();
        let occluders = self.culler.reads_occluders();
        Needs { models: true, hierarchy, occluders, ..Needs::default() }
    }

    fn is_view_bound(&self) -> bool {
        false
    }

    fn updates_groups(&self) -> bool {
        true
    }

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(self.view(gpu)?))
    }

    fn compile(&mut self, gpu: &Gpu, lights: LightTraits) -> Result<(), AssignError> {
        self.culler.compile(gpu, lights)
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        frame.view.check()?;
        let served =
            [SampleDomain::OpaqueSurfaces, SampleDomain::NearSurfaces, SampleDomain::InFront];
        let reason = "samples in the open lie on no model, and would read all lights";
        frame.check_domain(&self.id(), &served, reason)?;
        let missing = || AssignError::Missing { strategy: self.id(), missing: "models" };
        self.upload(gpu, frame.models.ok_or_else(missing)?)?;
        self.culler.prepare(
            gpu,
            frame,
            Groups::All(self.group_count),
            &[
                entry(FIRST_STRATEGY_BINDING, &self.models),
                entry(FIRST_STRATEGY_BINDING + 1, &self.model_of_group),
            ],
        )
    }

    fn record(&mut self, _frame: &Frame<'_>, passes: &mut dyn Passes) {
        self.culler.record(passes);
    }

    fn lookup(&self) -> Lookup<'_> {
        self.culler.lookup()
    }

    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.culler.bind_group()
    }

    fn lists(&self) -> &LightLists {
        self.culler.lists()
    }

    fn lists_mut(&mut self) -> &mut LightLists {
        self.culler.lists_mut()
    }

    fn memory_bytes(&self) -> u64 {
        self.models.size() + self.model_of_group.size() + self.culler.memory_bytes()
    }
}
