//! The pass `shadow-banding`: which quads of emitters show bands in the frame that was drawn.
//!
//! The paper draws the scene once more for each quad (Dobetsberger 2025, section 6.3). Here depth and normals of the
//! G-buffer give the same samples, so one compute pass tests all quads. Their flags are read back without waiting.

use assign::{
    AssignError, FrameBindings, FrameWrites, Gpu, Passes, Readback, Shader, Viewport, entry,
    storage_entry,
};
use bytemuck::{Pod, Zeroable, bytes_of, cast_slice};

use crate::{
    ShadingError, Targets,
    bound_maps::BoundMaps,
    gbuffer_inputs::{GBufferInputs, PIXELS_GROUP},
    shaders::{LISTS_GROUP, lighting_modules},
};

/// Bindings of `shadow_banding.wesl`.
const TESTS_BINDING: u32 = 28;
const FLAGS_BINDING: u32 = 29;

/// Cells along a tile of the shader whose neighbours lie in the tile.
const INSIDE: u32 = 14;

/// Words of flags.
const FLAG_WORDS: usize = 1024;

/// The most tests of a round.
pub(super) const MOST_TESTS: u32 = 32 * FLAG_WORDS as u32;

/// Frames that a round may stay unanswered. Its encoder was dropped then, so its answer never comes.
const MOST_WAITS: u32 = 16;

/// `shadow_banding.wesl`, `struct BandTest`. 48 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub(super) struct BandTest {
    /// The vectors in the records of the maps at the quad's corners.
    pub(super) corners: [u32; 4],
    /// The middle of the light, world space, metres.
    pub(super) middle_world: [f32; 3],
    /// The square of how far it may light from there.
    pub(super) reach_2: f32,
    /// Its slot.
    pub(super) light: u32,
    /// Pads to 48 bytes.
    pub(super) padding: [u32; 3],
}

/// Bytes of `struct BandTests` before its first test.
const HEADER_BYTES: u64 = 16;

/// `band_flags` of the shader: the round, and a bit per test.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
struct Flags {
    round: u32,
    words: [u32; FLAG_WORDS],
}

/// The frame whose G-buffer is tested.
#[derive(Clone, Copy)]
pub(crate) struct Drawn<'a> {
    pub(super) gpu: &'a Gpu,
    pub(super) frame: &'a FrameBindings,
    pub(super) targets: &'a Targets,
    pub(super) viewport: Viewport,
}

/// A round on its way.
#[derive(Debug)]
struct Round {
    number: u32,
    tests: usize,
    waits: u32,
}

/// The pass, and the flags that it has found.
#[derive(Debug)]
pub(super) struct Banding {
    images: GBufferInputs,
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
    tests: wgpu::Buffer,
    flags: wgpu::Buffer,
    writes: FrameWrites,
    readback: Readback<Flags>,
    rounds: u32,
    /// The round whose flags have not arrived.
    awaited: Option<Round>,
}

impl Banding {
    /// Compiles the pass, with room for so many tests.
    pub(super) fn new(
        gpu: &Gpu,
        frame: &wgpu::BindGroupLayout,
        tests: u32,
    ) -> Result<Self, AssignError> {
        let stages = wgpu::ShaderStages::COMPUTE;
        let images = GBufferInputs::of_sample(false);
        let mut entries = images.layout(stages);
        entries.extend(BoundMaps::layout(stages));
        entries.push(storage_entry(TESTS_BINDING, stages, true));
        entries.push(storage_entry(FLAGS_BINDING, stages, false));
        let layout = gpu.bind_group_layout("shadow banding", &entries);
        let module = shader(images).create(gpu, "package::shadow_banding")?;
        let layouts = [Some(frame), None, Some(&layout)];
        let pipeline = gpu.compute_pipeline(&module, "find_bands", &layouts, true);
        let bytes = HEADER_BYTES + u64::from(tests.max(1)) * size_of::<BandTest>() as u64;
        Ok(Self {
            images,
            layout,
            pipeline,
            tests: gpu.storage("tests of shadow bands", bytes)?,
            flags: gpu.storage("flags of shadow bands", size_of::<Flags>() as u64)?,
            writes: FrameWrites::new(gpu),
            readback: Readback::new(gpu, "flags of shadow bands"),
            rounds: 0,
            awaited: None,
        })
    }

    /// The flags of the last round, one per test, once they have arrived.
    pub(super) fn arrived(&mut self) -> Option<Vec<bool>> {
        let round = self.awaited.as_ref()?;
        self.readback.poll();
        let flags = self.readback.latest().filter(|flags| flags.round == round.number)?;
        let flag = |test: usize| flags.words[test / 32] >> (test % 32) & 1 == 1;
        let flags = (0..round.tests).map(flag).collect();
        self.awaited = None;
        Some(flags)
    }

    /// Whether a round is on its way. Counts how often it is asked, and gives a round up that never answers.
    pub(super) fn is_waiting(&mut self) -> bool {
        let Some(round) = &mut self.awaited else { return false };
        round.waits += 1;
        if round.waits > MOST_WAITS {
            self.awaited = None;
        }
        self.awaited.is_some()
    }

    /// Records a round: tests quads against the G-buffer of the frame, at one pixel in `down` along each axis.
    pub(super) fn record(
        &mut self,
        drawn: Drawn<'_>,
        down: u32,
        maps: &BoundMaps,
        tests: &[BandTest],
        passes: &mut dyn Passes,
    ) -> Result<(), ShadingError> {
        self.rounds = self.rounds.wrapping_add(1);
        let header = [self.rounds, down, 0, 0];
        self.writes.write(&self.tests, 0, bytes_of(&header))?;
        self.writes.write(&self.tests, HEADER_BYTES, cast_slice(tests))?;
        let encoder = passes.encoder();
        self.writes.record(encoder);
        encoder.clear_buffer(&self.flags, 0, None);
        encoder.copy_buffer_to_buffer(&self.tests, 0, &self.flags, 0, 4);
        let mut resources = self.images.entries(drawn.targets);
        resources.extend(maps.entries());
        resources.push(entry(TESTS_BINDING, &self.tests));
        resources.push(entry(FLAGS_BINDING, &self.flags));
        let group = drawn.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("shadow banding"),
            layout: &self.layout,
            entries: &resources,
        });
        let tiles = [drawn.viewport.width, drawn.viewport.height]
            .map(|pixels| pixels.div_ceil(down).div_ceil(INSIDE));
        passes.compute("shadow-banding", &mut |pass| {
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, drawn.frame.bind_group(), &[]);
            pass.set_bind_group(PIXELS_GROUP, &group, &[]);
            pass.dispatch_workgroups(tiles[0], tiles[1], tests.len() as u32);
        });
        self.readback.record(passes.encoder(), &self.flags, 0);
        self.awaited = Some(Round { number: self.rounds, tests: tests.len(), waits: 0 });
        Ok(())
    }
}

fn shader(images: GBufferInputs) -> Shader<'static> {
    images.set_flags(lighting_modules(LISTS_GROUP))
}

#[cfg(test)]
mod tests {
    use assign::{conformance::LinkedModule, struct_layout};

    use super::*;

    #[test]
    fn the_shader_links_and_has_its_bindings_and_layouts() {
        let images = GBufferInputs::of_sample(false);
        let source = shader(images).link("package::shadow_banding").expect("links");
        let module = LinkedModule::new("shadow banding", &source);
        let group_2: Vec<u32> = module
            .used_bindings()
            .into_iter()
            .filter(|(group, _)| *group == 2)
            .map(|(_, b)| b)
            .collect();
        assert_eq!(group_2, [0, 2, 26, 27, TESTS_BINDING, FLAGS_BINDING]);
        assert_eq!(module.constant("INSIDE"), INSIDE);
        let rust = struct_layout!(BandTest: corners, middle_world, reach_2, light);
        assert_eq!(module.layout_of("BandTest"), rust, "WESL, then Rust");
    }
}
