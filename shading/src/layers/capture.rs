//! The samples at which layers look lights up, for checks of lists on the CPU.

use assign::{Assignment, EncoderPasses, Frame, Gpu, ListsSnapshot, Passes};
use bytemuck::pod_collect_to_vec;

use crate::{
    Renderer, Samples, ShadingError,
    dump::{Asked, visit_lists_at},
    gbuffer_inputs::PIXELS_GROUP,
    layers::{
        blend::{Blend, Fragments},
        capture_buffers::CaptureBuffers,
        fog::FogVolume,
    },
    probe::CAPTURED_BYTES,
    shaders::{LISTS_GROUP, lighting_modules},
};

/// The most samples that are kept of each kind, 128 MiB: of more, every second or third one is kept, and so on.
const MOST_SAMPLES: u32 = 4 << 20;

/// The samples at which a frame's layers look lights up.
#[derive(Clone, Debug, Default)]
pub struct LayerSamples {
    /// Visible fragments of transparent surfaces and particles: how many there are, and the records of those that are kept.
    fragments: (u64, Vec<u8>),
    /// The same of froxels.
    froxels: (u64, Vec<u8>),
}

impl LayerSamples {
    /// Captures the samples of the prepared view. Depth must be drawn. Blocks.
    ///
    /// # Errors
    ///
    /// [`ShadingError::Assign`] if the device has no room for them.
    pub fn capture(renderer: &Renderer, frame: &Frame<'_>) -> Result<Self, ShadingError> {
        let Some(layers) = &renderer.layers else { return Ok(Self::default()) };
        let mut samples = Self::default();
        if layers.kinds().is_blended() {
            samples.fragments = captured(&renderer.gpu, |buffers, passes| {
                let fragments = Fragments::Capture(buffers, &renderer.targets.depth);
                let blend = Blend::new(renderer, layers, None, fragments)?;
                blend.record(renderer, layers, frame.view, (None, fragments), passes);
                Ok(())
            })?;
        }
        if let Some(fog) = layers.fog_volume() {
            samples.froxels = captured(&renderer.gpu, |buffers, passes| {
                capture_froxels(renderer, fog, buffers, passes)
            })?;
        }
        Ok(samples)
    }

    /// The number of fragments of transparent surfaces and particles.
    pub fn fragments(&self) -> u64 {
        self.fragments.0
    }

    /// The number of froxels of the fog.
    pub fn froxels(&self) -> u64 {
        self.froxels.0
    }
}

/// Records a pass twice: first to count its samples, and then to keep them.
fn captured(
    gpu: &Gpu,
    record: impl Fn(&CaptureBuffers, &mut dyn Passes) -> Result<(), ShadingError>,
) -> Result<(u64, Vec<u8>), ShadingError> {
    let run = |room, step| -> Result<(u32, CaptureBuffers), ShadingError> {
        let buffers = CaptureBuffers::new(gpu, room, step)?;
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        record(&buffers, &mut EncoderPasses { encoder: &mut encoder })?;
        gpu.queue.submit([encoder.finish()]);
        let count: Vec<u32> = pod_collect_to_vec(&gpu.read(&buffers.count, 4)?);
        Ok((count.first().copied().unwrap_or(0), buffers))
    };
    let (total, _) = run(0, 1)?;
    let step = total.div_ceil(MOST_SAMPLES).max(1);
    let room = total.div_ceil(step);
    let (_, buffers) = run(room, step)?;
    Ok((u64::from(total), gpu.read(&buffers.kept, u64::from(room) * CAPTURED_BYTES)?))
}

fn capture_froxels(
    renderer: &Renderer,
    fog: &FogVolume,
    buffers: &CaptureBuffers,
    passes: &mut dyn Passes,
) -> Result<(), ShadingError> {
    let gpu = &renderer.gpu;
    let stages = wgpu::ShaderStages::COMPUTE;
    let mut entries = vec![FogVolume::grid_layout(stages)];
    entries.extend(CaptureBuffers::layout(stages));
    let layout = gpu.bind_group_layout("fog capture", &entries);
    let mut resources = vec![fog.grid_entry()];
    resources.extend(buffers.entries());
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("fog capture"),
        layout: &layout,
        entries: &resources,
    });
    let shader = lighting_modules(LISTS_GROUP).flag("captures", true);
    let module = shader.create(gpu, "package::fog_light")?;
    let layouts = [Some(renderer.frame.layout()), None, Some(&layout)];
    let pipeline = gpu.compute_pipeline(&module, "light_froxels", &layouts, true);
    let [x, y, z] = fog.counts().map(|count| count.div_ceil(4));
    passes.compute("fog-light", &mut |pass| {
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, renderer.frame.bind_group(), &[]);
        pass.set_bind_group(PIXELS_GROUP, &group, &[]);
        pass.dispatch_workgroups(x, y, z);
    });
    Ok(())
}

/// As [`visit_lists`](crate::visit_lists), for captured samples. Fragments look lights up for themselves; froxels do
/// so as deferred shading does.
///
/// # Errors
///
/// [`ShadingError::Unsteady`] if a sample's second look-up returned another number of lights than its first.
pub fn visit_layer_lists(
    renderer: &Renderer,
    strategy: &dyn Assignment,
    frame: &Frame<'_>,
    snapshot: &ListsSnapshot,
    samples: &LayerSamples,
    visit: &mut dyn FnMut(&Samples, &ListsSnapshot),
) -> Result<(), ShadingError> {
    let viewport = frame.view.viewport;
    // A pass over the viewport looks up one sample per pixel.
    let at_once = viewport.width as usize * viewport.height as usize * CAPTURED_BYTES as usize;
    for ((_, records), is_alone) in [(&samples.fragments, true), (&samples.froxels, false)] {
        for records in records.chunks(at_once.max(CAPTURED_BYTES as usize)) {
            let buffer = renderer.gpu.storage("samples to look up", records.len() as u64)?;
            renderer.gpu.queue.write_buffer(&buffer, 0, records);
            let asked = Asked { captured: Some(&buffer), is_alone };
            visit_lists_at(renderer, strategy, frame, snapshot, asked, visit)?;
        }
    }
    Ok(())
}
