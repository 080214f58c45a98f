//! The table of cells of HC: which cells there are, and the pass `bounds` that finds those with visible samples.

use assign::{
    AssignError, DepthBindGroups, DepthImage, DepthKernels, Frame, FrameBindings, FrameWrites, Gpu,
    KeptBindGroup, LightReader, LiveGroups, Passes, Projection, Readback, Shader, Storage,
    StrategyWesl, View, entry, kernel, storage_entry, uniform_entry,
};
use bytemuck::{Pod, Zeroable, bytes_of};

use crate::surface::{self, SURFACE};

/// The strategy's WESL: `group_of` and `group_bounds`.
pub const HASHED_WESL: StrategyWesl<'static> = StrategyWesl {
    main: include_str!("shaders/hashed.wesl"),
    imports: &[("package::strategy::hash_cells", include_str!("shaders/hash_cells.wesl"))],
    flags: &[],
    reader: LightReader::Stored(Storage::Lists),
};

/// Bind group of what the pass reads and writes.
const FILL_GROUP: u32 = 1;
/// Bind group of the live groups.
const LIVE_GROUP: u32 = 2;

/// A cell's place fits its key if the edge is at least this share of the distance to the eye: the edge is
/// more than half of what it is asked to be, so places end at 2 x 126 + 1, and `PLACES` of
/// `hash_cells.wesl` is 256.
const LEAST_EDGE: f32 = 1.0 / 126.0;

/// Edges are at least this many times the rounding of a position at the eye. A cell then is wider than the box
/// of positions into which a sample may be rounded.
const EDGE_SLACKS: f32 = 16.0;

/// Slots per square of the screen that is one cell wide. A wall that faces the camera has up to 4 cells per
/// square, and slanted surfaces have more. Half of the slots stay free.
const SLOTS_PER_SQUARE: f64 = 16.0;

/// The least and the most slots of a table. The most take 256 MiB with their records.
const SLOTS: (u32, u32) = (1 << 12, 1 << 24);

/// Slots that one workgroup clears, at least.
const CLEARED: u32 = 256;

/// Which cells there are: `struct HashCells` of `hash_cells.wesl`. 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct HashCellsUniform {
    /// The eye, world space, metres.
    pub eye_world: [f32; 3],
    /// The edge of a cell is the largest power of two up to `max(edge_m, edge_per_m * distance)`, metres,
    /// `distance` being that to the eye.
    pub edge_m: f32,
    /// See `edge_m`.
    pub edge_per_m: f32,
    /// The binary logarithm of the edge of level 0, metres. An edge is no shorter.
    pub base_exponent: i32,
    /// Slots of the table, a power of two.
    pub slot_count: u32,
    /// Pads to 32 bytes.
    pub padding: u32,
}

impl HashCellsUniform {
    /// Cells with edges of at most `cell_px` pixels, unless they would be too small for their keys or for the
    /// precision of positions.
    pub fn new(cell_px: u32, view: &View, slot_count: u32) -> Self {
        let eye = view.eye();
        let rounding_m = 4.0 * view.uniform().position_error * eye.length();
        let edge = cell_px as f32 * pixel_m(view);
        let (edge_m, edge_per_m) = if is_perspective(view) { (0.0, edge) } else { (edge, 0.0) };
        let edge_m = (EDGE_SLACKS * rounding_m).max(edge_m);
        let edge_per_m = LEAST_EDGE.max(edge_per_m);
        // Every number below keeps its exponent bits, and so does its inverse.
        let shortest = edge_m.max(edge_per_m * view.near_m).clamp(1e-18, 1e18);
        Self {
            eye_world: eye.to_array(),
            edge_m,
            edge_per_m,
            base_exponent: (shortest.to_bits() >> 23) as i32 - 127,
            slot_count,
            padding: 0,
        }
    }
}

/// The size of a pixel, metres: at view depth 1, or in an orthographic view everywhere. Pixels need not be square.
fn pixel_m(view: &View) -> f32 {
    let uniform = view.uniform();
    let [width, height] =
        [0, 1].map(|i| 2.0 * uniform.ray_scale[i].abs() / uniform.viewport_size[i]);
    (width * height).sqrt()
}

fn is_perspective(view: &View) -> bool {
    matches!(view.projection, Projection::Perspective { .. })
}

/// How full the table of a frame was: `struct TableUse` of `fill.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Pod, Zeroable)]
pub struct TableUse {
    /// Slots of the table.
    pub slots: u32,
    /// Cells that found a slot.
    pub filled: u32,
    /// Tries to put a cell into the table that found no slot. The cell's samples read all lights.
    pub lost: u32,
}

impl TableUse {
    /// The slots that such a frame needs. Half of them stay free.
    fn needed(self) -> u32 {
        let lost = if self.lost > 0 { self.slots.saturating_mul(2) } else { 0 };
        let filled = self.filled.saturating_mul(2).checked_next_power_of_two();
        lost.max(filled.unwrap_or(SLOTS.1)).min(SLOTS.1)
    }
}

/// The slots with which a table starts: a power of two.
fn slots_of(cell_px: u32, view: &View) -> u32 {
    let pixels = f64::from(view.viewport.width) * f64::from(view.viewport.height);
    let least_px = if is_perspective(view) { LEAST_EDGE / pixel_m(view) } else { 0.0 };
    let squares = pixels / f64::from(least_px.max(cell_px as f32)).powi(2);
    let slots = (SLOTS_PER_SQUARE * squares).min(f64::from(SLOTS.1)) as u32;
    slots.next_power_of_two().clamp(SLOTS.0, SLOTS.1)
}

/// The table, and the pass that fills it.
#[derive(Debug)]
pub(crate) struct HashTable {
    cell_px: u32,
    /// The slots of the prepared frame, and the most that a caller allows.
    slots: u32,
    most_slots: u32,
    frame: FrameBindings,
    kernels: DepthKernels<Kernels>,
    live_layout: wgpu::BindGroupLayout,
    /// Of the depth buffer, and of each layer.
    bound: DepthBindGroups,
    bound_live: KeptBindGroup,
    table: wgpu::Buffer,
    asked: wgpu::Buffer,
    table_use: wgpu::Buffer,
    readback: Readback<TableUse>,
    live: LiveGroups,
}

/// The kernels for depth with one or with several samples per pixel.
#[derive(Debug)]
struct Kernels {
    layout: wgpu::BindGroupLayout,
    clear: wgpu::ComputePipeline,
    fill: wgpu::ComputePipeline,
}

impl Kernels {
    fn new(
        gpu: &Gpu,
        multisampled: bool,
        [frame, live]: [&wgpu::BindGroupLayout; 2],
    ) -> Result<Self, AssignError> {
        let stages = wgpu::ShaderStages::COMPUTE;
        let layout = gpu.bind_group_layout(
            "cell table",
            &[
                DepthImage::layout(0, stages, multisampled),
                storage_entry(1, stages, false),
                uniform_entry(2, stages),
                storage_entry(3, stages, false),
            ],
        );
        let shader = fill_shader(multisampled);
        // SAFETY: a loop counts up to a constant; or to the number of slots, at most 2^24, by a step of at least
        // one workgroup; or over levels, at most 31; or over the samples of a pixel.
        #[allow(unsafe_code, reason = "its loops end")]
        let module = unsafe { shader.create_uncounted(gpu, "package::fill") }?;
        let layouts = [frame, &layout, live];
        let pipeline = |entry_point| kernel::pipeline(gpu, &module, entry_point, &layouts);
        let (clear, fill) = (pipeline("clear_table"), pipeline("fill_table"));
        Ok(Self { layout, clear, fill })
    }
}

impl HashTable {
    pub(crate) fn new(gpu: &Gpu, cell_px: u32) -> Result<Self, AssignError> {
        let stages = wgpu::ShaderStages::COMPUTE;
        let live_layout = gpu.bind_group_layout("live groups", &[storage_entry(0, stages, false)]);
        let frame = FrameBindings::new(gpu);
        Ok(Self {
            cell_px,
            slots: 0,
            most_slots: SLOTS.1,
            kernels: DepthKernels::new(Kernels::new(gpu, false, [frame.layout(), &live_layout])?),
            frame,
            live_layout,
            bound: DepthBindGroups::default(),
            bound_live: KeptBindGroup::default(),
            table: gpu.storage("cell table", 0)?,
            asked: gpu.uniform("hash cells", size_of::<HashCellsUniform>() as u64),
            table_use: gpu.storage("table use", size_of::<TableUse>() as u64)?,
            readback: Readback::new(gpu, "table use"),
            live: LiveGroups::new(gpu)?,
        })
    }

    /// Whether the table was too small in an earlier frame, and may grow.
    pub(crate) fn wants_growth(&self) -> bool {
        let needed = self.readback.latest().map_or(0, TableUse::needed);
        needed.min(self.most_slots) > self.slots
    }

    /// Sizes the table for a frame and binds it: outside the clock. Returns the number of slots. In frames that
    /// keep their groups, the table stays as it is.
    pub(crate) fn prepare(
        &mut self,
        gpu: &Gpu,
        frame: &Frame<'_>,
        depths: &[DepthImage],
        writes: &mut FrameWrites,
    ) -> Result<u32, AssignError> {
        self.readback.poll();
        if frame.changes.is_some() {
            return Ok(self.slots);
        }
        self.frame.update_in(gpu, frame, writes)?;
        let needed = self.readback.latest().map_or(0, TableUse::needed);
        // It does not shrink, so that a moving camera does not resize it in every frame.
        let wanted = slots_of(self.cell_px, frame.view).max(needed).max(self.slots);
        self.slots = wanted.min(self.most_slots);
        let cells = HashCellsUniform::new(self.cell_px, frame.view, self.slots);
        writes.write(&self.asked, 0, bytes_of(&cells))?;
        let bytes = size_of::<HashCellsUniform>() as u64 + u64::from(self.slots) * 4;
        if self.table.size() < bytes {
            self.table = gpu.storage("cell table", bytes)?;
        }
        self.live.prepare(gpu, self.slots)?;
        if let Some(depth) = depths.first() {
            let layouts = [self.frame.layout(), &self.live_layout];
            self.kernels.choose(depth, || Kernels::new(gpu, true, layouts))?;
        }
        let buffers = [entry(1, &self.table), entry(2, &self.asked), entry(3, &self.table_use)];
        self.bound.bind(gpu, "cell table", &self.kernels.chosen().layout, depths, &buffers);
        let live = [entry(0, self.live.buffer())];
        self.bound_live.bind(gpu, "live groups", &self.live_layout, &live);
        Ok(self.slots)
    }

    /// Records the pass `bounds`: inside the clock.
    pub(crate) fn record(&mut self, view: &View, passes: &mut dyn Passes) {
        let kernels = self.kernels.chosen();
        passes.compute("bounds", &mut |pass| {
            pass.set_bind_group(0, self.frame.bind_group(), &[]);
            pass.set_bind_group(FILL_GROUP, self.bound.groups().next(), &[]);
            pass.set_bind_group(LIVE_GROUP, self.bound_live.get(), &[]);
            pass.set_pipeline(&kernels.clear);
            pass.dispatch_workgroups(kernel::workgroups(self.slots.into(), CLEARED), 1, 1);
            pass.set_pipeline(&kernels.fill);
            let [across, down] = surface::blocks(view);
            for depth in self.bound.groups() {
                pass.set_bind_group(FILL_GROUP, depth, &[]);
                pass.dispatch_workgroups(across, down, 1);
            }
        });
        self.readback.record(passes.encoder(), &self.table_use, 0);
    }

    /// Caps the slots of the table.
    pub(crate) fn limit(&mut self, slots: u32) {
        self.most_slots = slots.clamp(1, SLOTS.1).next_power_of_two();
    }

    /// Caps the slots as those of another table.
    pub(crate) fn limit_as(&mut self, other: &Self) {
        self.most_slots = other.most_slots;
    }

    /// How full the table was, in the newest frame that has arrived.
    pub(crate) fn table_use(&self) -> Option<TableUse> {
        self.readback.latest()
    }

    /// The table: `struct CellTable`.
    pub(crate) fn buffer(&self) -> &wgpu::Buffer {
        &self.table
    }

    /// The slots with cells.
    pub(crate) fn live(&self) -> &LiveGroups {
        &self.live
    }

    /// Bytes of its buffers.
    pub(crate) fn bytes(&self) -> u64 {
        self.table.size()
            + self.asked.size()
            + self.table_use.size()
            + self.readback.bytes()
            + self.live.bytes()
            + self.frame.bytes()
    }
}

/// The pass's shader.
fn fill_shader(multisampled: bool) -> Shader<'static> {
    Shader::new(FILL_GROUP)
        .module("package::fill", include_str!("shaders/fill.wesl"))
        .module("package::live", LiveGroups::WESL)
        .module(SURFACE.0, SURFACE.1)
        .strategy(HASHED_WESL)
        .flag("multisampled", multisampled)
}

/// The linked WGSL of the pass, for tests of layout and validity.
pub fn fill_source(multisampled: bool) -> Result<String, AssignError> {
    fill_shader(multisampled).link("package::fill")
}

#[cfg(test)]
mod tests {
    use glam::{Vec2, Vec3};

    use super::*;

    /// The edge of the cells at a distance from the eye, metres, as `hash_cells.wesl` finds it.
    fn edge_at(cells: &HashCellsUniform, distance_m: f32) -> f32 {
        let wanted = cells.edge_m.max(cells.edge_per_m * distance_m);
        let level = (wanted.to_bits() >> 23) as i32 - 127 - cells.base_exponent;
        ((cells.base_exponent + level.clamp(0, 30)) as f32).exp2()
    }

    #[test]
    fn cells_are_as_wide_as_asked() {
        // A pixel is 0.01 m wide at a distance of 1 m.
        let fov_y = 2.0 * 0.5_f32.atan();
        let view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, fov_y, 0.1, [200, 100]);
        let cells = HashCellsUniform::new(48, &view, 64);
        assert!((cells.edge_per_m - 0.48).abs() < 1e-6, "{cells:?}");
        assert_eq!([1.0, 2.5, 10.0, 20.0].map(|m| edge_at(&cells, m)), [0.25, 1.0, 4.0, 8.0]);
        for distance_m in [0.1, 0.7, 3.0, 99.0, 1e6] {
            let pixels = edge_at(&cells, distance_m) / (0.01 * distance_m);
            assert!((24.0..=48.0).contains(&pixels), "at {distance_m} m: {pixels} pixels");
        }
        // Keys bound how small they are.
        let small = HashCellsUniform::new(1, &view, 64);
        assert!((1.0 / 252.0..=0.01).contains(&edge_at(&small, 1.0)), "{small:?}");
        let window = (Vec2::splat(-1.0), Vec2::ONE);
        let projection = Projection::Orthographic { min: window.0, max: window.1 };
        let flat = View { projection, near_m: 0.0, far_m: Some(99.0), ..view };
        let flat = HashCellsUniform::new(48, &flat, 64);
        // Pixels are 0.01 x 0.02 m.
        assert_eq!([0.0, 5.0, 50.0].map(|m| edge_at(&flat, m)), [0.5, 0.5, 0.5]);
    }

    #[test]
    fn cells_are_wider_than_rounding_far_from_the_origin() {
        let eye = Vec3::new(800_000.0, 1_000.0, -600_000.0);
        let view = View::look_at(eye, eye + Vec3::X, 1.0, 0.1, [64, 48]);
        let cells = HashCellsUniform::new(1, &view, 64);
        for distance_m in [0.0, 1.0, 1e3, 1e6, 1e9] {
            // `slack_m` of `fill.wesl`.
            let sizes = 2.0 * eye.length() + 2.0 * distance_m;
            let slack_m = 2.0 * view.uniform().position_error * sizes;
            assert!(edge_at(&cells, distance_m) > 2.0 * slack_m, "at {distance_m} m");
        }
    }

    #[test]
    fn tables_grow_by_what_a_frame_counted() {
        let view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 0.1, [1920, 1080]);
        // Cells are at least 7.8 pixels wide.
        assert_eq!([1, 48, 16_384].map(|px| slots_of(px, &view)), [1 << 20, 1 << 14, 1 << 12]);
        let needed = |slots, filled, lost| TableUse { slots, filled, lost }.needed();
        assert!(needed(4096, 2048, 0) <= 4096);
        assert_eq!(needed(4096, 2049, 0), 8192);
        assert_eq!(needed(4096, 1000, 1), 8192);
        assert_eq!(needed(u32::MAX, u32::MAX, 1), 1 << 24);
    }
}
