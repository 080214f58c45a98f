//! Negative controls: strategies with a planted fault. The suite must reject them.

use bytemuck::bytes_of;

pub use super::fault::Fault;
use crate::{
    AssignError, Assignment, Frame, Gpu, Light, LightBuffer, LightNode, LightShape, Lookup, Passes,
    Shader, StrategyModule,
    kernel::{self, Slot},
    leave_to_inner,
};

/// A look-up that returns a group that does not exist.
const LOST_GROUP_WESL: &str = "
import package::sample::ViewSample;

fn group_of(sample: ViewSample) -> u32 {
  return 0x7ffffff0u;
}

fn second_group_of(sample: ViewSample) -> u32 {
  return 0x7ffffff0u;
}
";

/// Bytes of a light's sphere, and of its emission.
const RECORD_BYTES: u64 = 16;

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
    /// Holds a record while it is copied from slot to slot.
    record: wgpu::Buffer,
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
            record: gpu.storage("record", RECORD_BYTES)?,
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

    /// Spoils the ordered lights, or the boxes over them.
    fn spoil(&self, lights: &LightBuffer, encoder: &mut wgpu::CommandEncoder) {
        match self.fault {
            Fault::CopiedSlot => {
                for records in [lights.spheres(), lights.emissions()] {
                    let second = RECORD_BYTES;
                    encoder.copy_buffer_to_buffer(records, second, &self.record, 0, RECORD_BYTES);
                    encoder.copy_buffer_to_buffer(&self.record, 0, records, 0, RECORD_BYTES);
                }
            }
            Fault::LostGrandparent if lights.levels().levels == 3 => {
                let bytes = size_of::<LightNode>() as u64;
                let first = u64::from(lights.levels().first_grandparent) * bytes;
                encoder.clear_buffer(lights.nodes(), first, Some(bytes));
            }
            _ => {}
        }
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
        let buffers = [lists.lists(), lists.entries(), &self.uniform];
        self.bind_group = Some(kernel::bind_buffers(gpu, &self.layout, &buffers));
    }
}

impl Assignment for Faulty {
    fn id(&self) -> String {
        format!("{} with {:?}", self.inner.id(), self.fault)
    }

    leave_to_inner!(needs, compile, lists, memory_bytes);

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Self::new(gpu, self.inner.for_view(gpu)?, self.fault)?))
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
        self.spoil(frame.lights, passes.encoder());
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
                let reader = inner.module.wesl().reader;
                Lookup { module: module.read_by(reader), ..inner }
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
}

/// The pipeline that spoils lists, and the layout of what it reads and writes.
fn plant_pipeline(
    gpu: &Gpu,
) -> Result<(wgpu::ComputePipeline, wgpu::BindGroupLayout), AssignError> {
    let module = Shader::new(0)
        .module("package::fault", include_str!("fault.wesl"))
        .create(gpu, "package::fault")?;
    let slots = [Slot::Write, Slot::Write, Slot::Uniform];
    let layout = kernel::layout(gpu, "fault", wgpu::ShaderStages::COMPUTE, &slots);
    Ok((kernel::pipeline(gpu, &module, "plant", &[&layout]), layout))
}
