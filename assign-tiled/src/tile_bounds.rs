//! The pass `bounds`: finds the depth range of each group's samples.

use assign::{
    AssignError, DepthImage, DepthKernels, FIRST_STRATEGY_BINDING, Frame, FrameBindings,
    FrameWrites, Gpu, KeptBindGroup, Passes, Shader, entry, kernel, storage_entry, uniform_entry,
};

use crate::{TileDepths, tile_wesl::tile_wesl};

/// Bind group of the pass's own resources and of the tiles' uniform.
const BOUNDS_GROUP: u32 = 1;

/// Reads the depth buffer once, or twice for halves that shrink and for slices.
#[derive(Debug)]
pub(crate) struct TileBounds {
    tile_depths: TileDepths,
    frame: FrameBindings,
    reduce: DepthKernels<Reduce>,
    bound: KeptBindGroup,
    depths: wgpu::Buffer,
    /// The depth slices of each tile that hold samples: `array<u32>`.
    masks: Option<wgpu::Buffer>,
    counts: [u32; 2],
    /// Lists per tile.
    lists: u32,
}

/// The kernel for depth with one or with several samples per pixel.
#[derive(Debug)]
struct Reduce {
    layout: wgpu::BindGroupLayout,
    pipeline: wgpu::ComputePipeline,
}

impl Reduce {
    fn new(
        gpu: &Gpu,
        tile_depths: TileDepths,
        multisampled: bool,
        frame: &wgpu::BindGroupLayout,
    ) -> Result<Self, AssignError> {
        let stages = wgpu::ShaderStages::COMPUTE;
        let mut entries = vec![
            DepthImage::layout(0, stages, multisampled),
            storage_entry(1, stages, false),
            uniform_entry(FIRST_STRATEGY_BINDING, stages),
        ];
        if tile_depths == TileDepths::Sliced {
            entries.push(storage_entry(2, stages, false));
        }
        let layout = gpu.bind_group_layout("tile bounds", &entries);
        let shader = bounds_shader(tile_depths, multisampled);
        // SAFETY: its loops count up to the number of pixels of a tile, or of samples of a pixel.
        #[allow(unsafe_code, reason = "its loops end")]
        let module = unsafe { shader.create_uncounted(gpu, "package::tile_bounds") }?;
        let pipeline = kernel::pipeline(gpu, &module, "reduce", &[frame, &layout]);
        Ok(Self { layout, pipeline })
    }
}

impl TileBounds {
    pub(crate) fn new(gpu: &Gpu, tile_depths: TileDepths) -> Result<Self, AssignError> {
        let frame = FrameBindings::new(gpu);
        Ok(Self {
            tile_depths,
            reduce: DepthKernels::new(Reduce::new(gpu, tile_depths, false, frame.layout())?),
            frame,
            bound: KeptBindGroup::default(),
            depths: gpu.storage("tile depths", 0)?,
            masks: match tile_depths {
                TileDepths::Sliced => Some(gpu.storage("tile depth masks", 0)?),
                _ => None,
            },
            counts: [0, 0],
            lists: tile_depths.lists(),
        })
    }

    /// Sizes the buffer for `counts` tiles along x and y, and binds it: outside the clock.
    pub(crate) fn prepare(
        &mut self,
        gpu: &Gpu,
        frame: &Frame<'_>,
        depth: &DepthImage,
        (tiles, counts): (&wgpu::Buffer, [u32; 2]),
        writes: &mut FrameWrites,
    ) -> Result<(), AssignError> {
        self.frame.update_in(gpu, frame, writes)?;
        let layout = self.frame.layout();
        self.reduce.choose(depth, || Reduce::new(gpu, self.tile_depths, true, layout))?;
        self.counts = counts;
        let bytes = u64::from(counts[0]) * u64::from(counts[1]) * u64::from(self.lists) * 8;
        if self.depths.size() < bytes {
            self.depths = gpu.storage("tile depths", bytes)?;
        }
        if let Some(masks) = &mut self.masks
            && masks.size() < bytes / 2
        {
            *masks = gpu.storage("tile depth masks", bytes / 2)?;
        }
        let mut entries =
            vec![depth.entry(0), entry(1, &self.depths), entry(FIRST_STRATEGY_BINDING, tiles)];
        entries.extend(self.masks.as_ref().map(|masks| entry(2, masks)));
        self.bound.bind(gpu, "tile bounds", &self.reduce.chosen().layout, &entries);
        Ok(())
    }

    /// Records the pass `bounds`: inside the clock.
    pub(crate) fn record(&self, passes: &mut dyn Passes) {
        passes.compute("bounds", &mut |pass| {
            pass.set_bind_group(0, self.frame.bind_group(), &[]);
            pass.set_bind_group(BOUNDS_GROUP, self.bound.get(), &[]);
            pass.set_pipeline(&self.reduce.chosen().pipeline);
            pass.dispatch_workgroups(self.counts[0], self.counts[1], 1);
        });
    }

    /// Bytes of its buffers.
    pub(crate) fn bytes(&self) -> u64 {
        let masks = self.masks.as_ref().map_or(0, wgpu::Buffer::size);
        self.depths.size() + masks + self.frame.bytes()
    }

    /// What the pass fills, for the strategy's bindings from the second on: nearest and farthest view depth of
    /// each group's samples, metres, as `array<vec2f>`; and the slices that hold samples, as `array<u32>`.
    pub(crate) fn resources(&self) -> impl Iterator<Item = wgpu::BindGroupEntry<'_>> {
        let buffers = [Some(&self.depths), self.masks.as_ref()];
        (FIRST_STRATEGY_BINDING + 1..)
            .zip(buffers.into_iter().flatten())
            .map(|(binding, buffer)| entry(binding, buffer))
    }
}

fn bounds_shader<'a>(depths: TileDepths, multisampled: bool) -> Shader<'a> {
    Shader::new(BOUNDS_GROUP)
        .module("package::tile_bounds", include_str!("shaders/tile_bounds.wesl"))
        .strategy(tile_wesl(depths))
        .flag("tight_halves", depths == TileDepths::ModifiedHalfZ)
        .flag("multisampled", multisampled)
}

/// The linked WGSL of the pass, for tests of layout and validity.
pub fn bounds_source(depths: TileDepths, multisampled: bool) -> Result<String, AssignError> {
    bounds_shader(depths, multisampled).link("package::tile_bounds")
}
