//! The pass `bounds` of `G/…/visible`: finds the box around the visible samples, and cuts it into cells. The
//! CPU reads nothing back.

use assign::{
    AssignError, DepthBindGroups, DepthImage, DepthKernels, Frame, FrameBindings, FrameWrites, Gpu,
    Passes, Shader, View, entry, kernel, storage_entry, uniform_entry,
};
use bytemuck::{Pod, Zeroable, bytes_of};
use glam::Vec3;

use crate::{
    cells::{CellCounts, CellsUniform, GRID_WESL},
    surface::{self, SURFACE},
};

/// Bind group of what the pass reads and writes.
const BOUNDS_GROUP: u32 = 1;

/// What the pass is asked for: `struct AskedCells` of `visible.wesl`. 48 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct AskedCells {
    /// Lowest corner of the box around all lights' supports, world space, metres.
    pub lights_min: [f32; 3],
    /// Pads to 16 bytes.
    pub padding: f32,
    /// Highest corner of the box around all lights' supports.
    pub lights_max: [f32; 3],
    /// Pads to 32 bytes.
    pub padding_2: f32,
    /// Cells along each axis.
    pub counts: [u32; 3],
    /// Pads to 48 bytes.
    pub padding_3: u32,
}

impl AskedCells {
    /// Asks for cells in the part of the samples' box that lies in `lights`.
    pub fn new(counts: CellCounts, lights: (Vec3, Vec3)) -> Self {
        Self {
            lights_min: lights.0.to_array(),
            padding: 0.0,
            lights_max: lights.1.to_array(),
            padding_2: 0.0,
            counts: counts.0,
            padding_3: 0,
        }
    }
}

/// Finds the box and makes the cells.
#[derive(Debug)]
pub(crate) struct VisibleBox {
    frame: FrameBindings,
    kernels: DepthKernels<Kernels>,
    /// Of the depth buffer, and of each layer.
    bound: DepthBindGroups,
    found: wgpu::Buffer,
    asked: wgpu::Buffer,
    made: wgpu::Buffer,
}

/// The kernels in their order, for depth with one or with several samples per pixel.
#[derive(Debug)]
struct Kernels {
    layout: wgpu::BindGroupLayout,
    clear: wgpu::ComputePipeline,
    find: wgpu::ComputePipeline,
    cut: wgpu::ComputePipeline,
}

impl Kernels {
    fn new(
        gpu: &Gpu,
        multisampled: bool,
        frame: &wgpu::BindGroupLayout,
    ) -> Result<Self, AssignError> {
        let stages = wgpu::ShaderStages::COMPUTE;
        let layout = gpu.bind_group_layout(
            "visible box",
            &[
                DepthImage::layout(0, stages, multisampled),
                storage_entry(1, stages, false),
                uniform_entry(2, stages),
                storage_entry(3, stages, false),
            ],
        );
        let shader = bounds_shader(multisampled);
        // SAFETY: its loops count up to a constant, or to the number of samples of a pixel.
        #[allow(unsafe_code, reason = "its loops end")]
        let module = unsafe { shader.create_uncounted(gpu, "package::visible") }?;
        let layouts = [frame, &layout];
        let pipeline = |entry_point| kernel::pipeline(gpu, &module, entry_point, &layouts);
        let [clear, find, cut] = ["clear_box", "find_box", "cut_box"].map(pipeline);
        Ok(Self { layout, clear, find, cut })
    }
}

impl VisibleBox {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self, AssignError> {
        let frame = FrameBindings::new(gpu);
        Ok(Self {
            kernels: DepthKernels::new(Kernels::new(gpu, false, frame.layout())?),
            frame,
            bound: DepthBindGroups::default(),
            found: gpu.storage("visible box", 6 * 4)?,
            asked: gpu.uniform("asked cells", size_of::<AskedCells>() as u64),
            made: gpu.storage("made cells", size_of::<CellsUniform>() as u64)?,
        })
    }

    /// Uploads what is asked for, and binds the depth buffer and the depths of layers: outside the clock.
    pub(crate) fn prepare(
        &mut self,
        gpu: &Gpu,
        frame: &Frame<'_>,
        depths: &[DepthImage],
        asked: AskedCells,
        writes: &mut FrameWrites,
    ) -> Result<(), AssignError> {
        self.frame.update_in(gpu, frame, writes)?;
        writes.write(&self.asked, 0, bytes_of(&asked))?;
        if let Some(depth) = depths.first() {
            let frame = self.frame.layout();
            self.kernels.choose(depth, || Kernels::new(gpu, true, frame))?;
        }
        let buffers = [entry(1, &self.found), entry(2, &self.asked), entry(3, &self.made)];
        self.bound.bind(gpu, "visible box", &self.kernels.chosen().layout, depths, &buffers);
        Ok(())
    }

    /// Records the pass `bounds`: inside the clock. It makes `cells`.
    pub(crate) fn record(&self, view: &View, cells: &wgpu::Buffer, passes: &mut dyn Passes) {
        let kernels = self.kernels.chosen();
        passes.compute("bounds", &mut |pass| {
            pass.set_bind_group(0, self.frame.bind_group(), &[]);
            pass.set_bind_group(BOUNDS_GROUP, self.bound.groups().next(), &[]);
            pass.set_pipeline(&kernels.clear);
            pass.dispatch_workgroups(1, 1, 1);
            pass.set_pipeline(&kernels.find);
            let [across, down] = surface::blocks(view);
            for depth in self.bound.groups() {
                pass.set_bind_group(BOUNDS_GROUP, depth, &[]);
                pass.dispatch_workgroups(across, down, 1);
            }
            pass.set_pipeline(&kernels.cut);
            pass.dispatch_workgroups(1, 1, 1);
        });
        // A kernel cannot write a uniform.
        let bytes = size_of::<CellsUniform>() as u64;
        passes.encoder().copy_buffer_to_buffer(&self.made, 0, cells, 0, bytes);
    }

    /// Bytes of its buffers.
    pub(crate) fn bytes(&self) -> u64 {
        self.frame.bytes() + self.found.size() + self.asked.size() + self.made.size()
    }
}

/// The pass's shader.
fn bounds_shader(multisampled: bool) -> Shader<'static> {
    Shader::new(BOUNDS_GROUP)
        .module("package::visible", include_str!("shaders/visible.wesl"))
        .module(SURFACE.0, SURFACE.1)
        .strategy(GRID_WESL)
        .flag("multisampled", multisampled)
}

/// The linked WGSL of the pass, for tests of layout and of what it makes.
pub fn visible_source(multisampled: bool) -> Result<String, AssignError> {
    bounds_shader(multisampled).link("package::visible")
}
