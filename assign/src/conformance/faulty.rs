//! Negative controls: strategies with a planted fault. The suite must reject them.

use bytemuck::bytes_of;

use super::violation::Breach;
use crate::{
    AssignError, Assignment, Frame, Gpu, Light, LightBuffer, LightLists, LightShape, Lookup, Needs,
    Passes, Shader, StrategyModule,
    kernel::{self, Slot},
};

/// A fault that is planted in a working strategy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The last entry of every list is missing.
    DroppedLight,
    /// The first two entries of every list are swapped.
    ShuffledList,
    /// The first entry of every list is a copy of the second.
    Repeated,
    /// The last entry of every list names a light that does not exist.
    ForeignLight,
    /// The first entry of every list has lost its flags.
    LostTerms,
    /// The last entry of every list lacks the flag of the diffuse term.
    LostDiffuse,
    /// Lists are made with horizons that are a little too high.
    HighHorizon,
    /// Every list ends beyond the buffer.
    RunawayList,
    /// Lists are made from lights with 0.9 times their range.
    ShrunkenBound,
    /// Lists are made from points at the centres of area lights.
    CentredEmitter,
    /// Lists are made from emitters with 0.95 times their size. Coarse groups may hide it.
    TightEmitter,
    /// Lists are made from spots with half their half angle.
    NarrowCone,
    /// Lists are made from virtual point lights that shine only into a cone of 45 degrees.
    NarrowHalfSpace,
    /// Lists are no longer made once the lights have moved.
    StaleLists,
    /// Every other frame lacks entries.
    Flicker,
    /// Entries are missing in frames with faulty lights.
    LeakyQuarantine,
    /// Record 0 lacks a light.
    Record0,
    /// Groups that overflow are not counted.
    SilentOverflow,
    /// The pool never grows.
    StarvedPool,
    /// No frame is recorded at all.
    Unrecorded,
    /// `group_of` returns a group that does not exist.
    LostGroup,
    /// Shading gets the bind group of the first frame in every frame.
    StaleBinding,
}

impl Fault {
    /// All faults that show with groups of any size: all but [`TightEmitter`](Self::TightEmitter).
    pub const ALL: [Self; 21] = [
        Self::DroppedLight,
        Self::ShuffledList,
        Self::Repeated,
        Self::ForeignLight,
        Self::LostTerms,
        Self::LostDiffuse,
        Self::HighHorizon,
        Self::RunawayList,
        Self::ShrunkenBound,
        Self::CentredEmitter,
        Self::NarrowCone,
        Self::NarrowHalfSpace,
        Self::StaleLists,
        Self::Flicker,
        Self::LeakyQuarantine,
        Self::Record0,
        Self::SilentOverflow,
        Self::StarvedPool,
        Self::Unrecorded,
        Self::LostGroup,
        Self::StaleBinding,
    ];

    /// The case that must reject the fault, and the promise that it breaks there.
    pub fn shows_in(self) -> (&'static str, Breach) {
        match self {
            Self::DroppedLight => ("33-lights", Breach::MissedPair),
            Self::ShuffledList => ("33-lights", Breach::NotAscending),
            Self::Repeated => ("33-lights", Breach::Repeated),
            Self::ForeignLight => ("33-lights", Breach::ForeignLight),
            Self::LostTerms => ("33-lights", Breach::NoTerm),
            Self::LostDiffuse => ("33-lights", Breach::MissedPair),
            Self::HighHorizon => ("lights-at-horizon", Breach::MissedPair),
            Self::RunawayList => ("33-lights", Breach::OutsideBuffer),
            Self::ShrunkenBound => ("light-at-tile-corner", Breach::MissedPair),
            Self::CentredEmitter | Self::TightEmitter => {
                ("area-lights-grazing", Breach::MissedPair)
            }
            Self::NarrowCone => ("spots-45", Breach::MissedPair),
            Self::NarrowHalfSpace => ("mixed-kinds", Breach::MissedPair),
            Self::StaleLists => ("lights-move", Breach::MissedPair),
            Self::Flicker => ("33-lights", Breach::Unstable),
            Self::LeakyQuarantine => ("quarantine", Breach::Quarantine),
            Self::Record0 => ("33-lights", Breach::Record0),
            Self::SilentOverflow => ("overflow", Breach::Counters),
            Self::StarvedPool => ("overflow", Breach::OverflowStays),
            Self::Unrecorded => ("33-lights", Breach::Unwritten),
            Self::LostGroup => ("33-lights", Breach::NoSuchGroup),
            Self::StaleBinding => ("light-count-changes", Breach::Lookup),
        }
    }

    /// The first stage of its case in which the fault may show. Stale lists are right until the
    /// lights move.
    pub fn shows_from_stage(self) -> u32 {
        match self {
            Self::StaleLists => 1,
            _ => 0,
        }
    }

    /// Whether the fault needs a strategy with groups.
    pub fn needs_groups(self) -> bool {
        matches!(
            self,
            Self::ShrunkenBound
                | Self::CentredEmitter
                | Self::TightEmitter
                | Self::NarrowCone
                | Self::NarrowHalfSpace
                | Self::StaleLists
                | Self::Record0
                | Self::SilentOverflow
                | Self::StarvedPool
                | Self::Unrecorded
                | Self::StaleBinding
        )
    }

    /// All faults of a strategy with groups; `normals` says whether it reads normals.
    pub fn all(normals: bool) -> Vec<Self> {
        Self::ALL.into_iter().filter(|fault| normals || !fault.needs_normals()).collect()
    }

    /// Whether the fault needs a strategy that reads normals.
    pub fn needs_normals(self) -> bool {
        self == Self::HighHorizon
    }

    /// Whether the strategy gets altered lights.
    fn alters_lights(self) -> bool {
        matches!(
            self,
            Self::ShrunkenBound
                | Self::CentredEmitter
                | Self::TightEmitter
                | Self::NarrowCone
                | Self::NarrowHalfSpace
                | Self::HighHorizon
        )
    }

    /// What `fault.wesl` does in a frame; 0 does nothing.
    fn kernel_kind(self, frame: u32, rejected: bool) -> u32 {
        match self {
            Self::DroppedLight => 1,
            Self::ShuffledList => 2,
            Self::Repeated => 3,
            Self::ForeignLight => 4,
            Self::LostTerms => 5,
            Self::RunawayList => 6,
            Self::Record0 => 7,
            Self::SilentOverflow => 8,
            Self::LostDiffuse => 9,
            Self::Flicker => frame % 2,
            Self::LeakyQuarantine => u32::from(rejected),
            _ => 0,
        }
    }
}

/// A look-up that returns a group that does not exist.
const LOST_GROUP_WESL: &str = "
import package::sample::ViewSample;

fn group_of(sample: ViewSample) -> u32 {
  return 0x7ffffff0u;
}
";

/// A strategy with a fault.
pub struct Faulty {
    inner: Box<dyn Assignment>,
    fault: Fault,
    frame: u32,
    /// The altered lights that the strategy gets.
    altered: LightBuffer,
    uniform: wgpu::Buffer,
    plant: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    bind_group: Option<wgpu::BindGroup>,
    record_count: u32,
    /// The lights of the first frame.
    first_lights: Option<Vec<Light>>,
    /// The look-up's bind group of the first frame.
    first_binding: Option<wgpu::BindGroup>,
}

impl Faulty {
    /// Plants `fault` in `inner`.
    pub fn new(gpu: &Gpu, inner: Box<dyn Assignment>, fault: Fault) -> Result<Self, AssignError> {
        let (plant, layout) = plant_pipeline(gpu)?;
        Ok(Self {
            inner,
            fault,
            frame: 0,
            altered: LightBuffer::new(gpu, &[])?,
            uniform: gpu.uniform("fault", 16),
            plant,
            layout,
            bind_group: None,
            record_count: 0,
            first_lights: None,
            first_binding: None,
        })
    }

    /// A light as the strategy gets it: with a part of its support, or at a place that is lower
    /// above every surface that faces the eye.
    fn alter(&self, light: &Light, frame: &Frame<'_>) -> Light {
        let shape = match (self.fault, &light.shape) {
            (Fault::CentredEmitter, LightShape::Area(_)) => LightShape::Point,
            (Fault::TightEmitter, LightShape::Area(emitter)) => {
                LightShape::Area(emitter.scaled(0.95))
            }
            (Fault::NarrowCone, &LightShape::Spot { direction, inner_angle, outer_angle }) => {
                let outer_angle = 0.5 * outer_angle;
                let inner_angle = inner_angle.min(outer_angle);
                LightShape::Spot { direction, inner_angle, outer_angle }
            }
            (Fault::NarrowHalfSpace, &LightShape::Vpl { normal: direction, .. }) => {
                let outer_angle = 0.5 * std::f32::consts::FRAC_PI_2;
                LightShape::Spot { direction, inner_angle: 0.0, outer_angle }
            }
            (_, shape) => *shape,
        };
        let away = (light.position - frame.view.eye()).normalize_or_zero();
        match self.fault {
            Fault::HighHorizon => {
                Light { position: light.position + 0.05 * light.range_m * away, ..*light }
            }
            Fault::ShrunkenBound => Light { range_m: 0.9 * light.range_m, ..*light },
            _ => Light { shape, ..*light },
        }
    }

    /// The frame with the altered lights.
    fn altered<'a>(altered: &'a LightBuffer, frame: &Frame<'a>) -> Frame<'a> {
        Frame { lights: altered, ..*frame }
    }

    /// Binds the finished lists to `fault.wesl`.
    fn bind(&mut self, gpu: &Gpu, frame: &Frame<'_>) {
        let lists = self.inner.lists();
        let groups = lists.group_count();
        let first_record = u32::from(groups > 0);
        let rejected = !frame.lights.rejected().is_empty();
        let parameters = [
            self.fault.kernel_kind(self.frame, rejected),
            first_record,
            groups + 1,
            frame.lights.count(),
        ];
        gpu.queue.write_buffer(&self.uniform, 0, bytes_of(&parameters));
        self.record_count = groups + 1 - first_record;
        let buffers = [lists.lists(), lists.entries(), lists.counters(), &self.uniform];
        self.bind_group = Some(kernel::bind_buffers(gpu, &self.layout, &buffers));
    }
}

impl Assignment for Faulty {
    fn id(&self) -> String {
        format!("{} with {:?}", self.inner.id(), self.fault)
    }

    fn needs(&self) -> Needs {
        self.inner.needs()
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        match self.fault {
            fault if fault.alters_lights() => {
                let lights = frame.lights.lights().iter();
                let lights: Vec<Light> = lights.map(|light| self.alter(light, frame)).collect();
                self.altered.update(gpu, &lights)?;
                let frame = Self::altered(&self.altered, frame);
                self.inner.prepare(gpu, &frame)?;
            }
            Fault::StarvedPool => {
                self.inner.lists_mut().limit_pool(64);
                self.inner.prepare(gpu, frame)?;
            }
            _ => self.inner.prepare(gpu, frame)?,
        }
        if self.first_binding.is_none() {
            self.first_binding = self.inner.bind_group().cloned();
        }
        self.bind(gpu, frame);
        Ok(())
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        self.frame += 1;
        let lights = frame.lights.lights();
        let first_lights = self.first_lights.get_or_insert_with(|| lights.to_vec());
        match self.fault {
            Fault::StaleLists if *first_lights != lights => return,
            Fault::Unrecorded => return,
            fault if fault.alters_lights() => {
                let frame = Self::altered(&self.altered, frame);
                self.inner.record(&frame, passes);
            }
            _ => self.inner.record(frame, passes),
        }
        passes.compute("fault", &mut |pass| {
            pass.set_pipeline(&self.plant);
            pass.set_bind_group(0, self.bind_group.as_ref(), &[]);
            pass.dispatch_workgroups(self.record_count.div_ceil(64), 1, 1);
        });
    }

    fn lookup(&self) -> Lookup<'_> {
        let inner = self.inner.lookup();
        match self.fault {
            Fault::LostGroup => {
                // SAFETY: it has no loop.
                #[allow(unsafe_code, reason = "it has no loop")]
                let module = unsafe { StrategyModule::new(LOST_GROUP_WESL) };
                Lookup { module, ..inner }
            }
            _ => inner,
        }
    }

    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        match self.fault {
            Fault::StaleBinding => self.first_binding.as_ref(),
            _ => self.inner.bind_group(),
        }
    }

    fn lists(&self) -> &LightLists {
        self.inner.lists()
    }

    fn lists_mut(&mut self) -> &mut LightLists {
        self.inner.lists_mut()
    }

    fn memory_bytes(&self) -> u64 {
        self.inner.memory_bytes()
    }
}

/// The pipeline that spoils lists, and the layout of what it reads and writes.
fn plant_pipeline(
    gpu: &Gpu,
) -> Result<(wgpu::ComputePipeline, wgpu::BindGroupLayout), AssignError> {
    let module = Shader::new(0)
        .module("package::fault", include_str!("fault.wesl"))
        .create(gpu, "package::fault")?;
    let slots = [Slot::Write, Slot::Write, Slot::Write, Slot::Uniform];
    let layout = kernel::layout(gpu, "fault", wgpu::ShaderStages::COMPUTE, &slots);
    Ok((kernel::pipeline(gpu, &module, "plant", &[&layout]), layout))
}
