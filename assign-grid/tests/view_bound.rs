//! Grids over the view's frustum and over the visible samples keep the contract's promises, and the suite rejects
//! them with planted faults.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

mod first_view;

use assign::{
    AssignError, Assignment, CullSettings, EncoderPasses, Frame, FrameBindings, Gpu, Keep, Light,
    LightBuffer, LightSource, SampleDomain, Shader, Touched, View,
    conformance::{
        self, Bound, Breach, Reworded, download, faulty::Fault, reword, run_kernel, upload,
    },
    kernel::Slot,
};
use assign_grid::{AskedCells, CellCounts, CellsUniform, Grid, GridBox};
use first_view::FirstView;
use glam::Vec3;

const BOXES: [GridBox; 2] = [GridBox::Frustum, GridBox::Visible];

fn grid(
    counts: &str,
    grid_box: GridBox,
    source: LightSource,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    let settings = CullSettings { source, ..CullSettings::default() };
    move |gpu| Ok(Box::new(Grid::new(gpu, counts.parse()?, grid_box, settings)?))
}

fn conforms(counts: &str, grid_box: GridBox, source: LightSource) {
    conformance::run(&grid(counts, grid_box, source)).expect("conforms");
}

#[test]
fn grids_over_the_frustum_conform() {
    conforms("12x7x9", GridBox::Frustum, LightSource::Linear);
    conforms("3x17x2", GridBox::Frustum, LightSource::Hierarchy);
}

#[test]
fn grids_over_visible_samples_conform() {
    conforms("12x7x9", GridBox::Visible, LightSource::Linear);
    conforms("3x17x2", GridBox::Visible, LightSource::Hierarchy);
}

#[test]
fn kept_and_touched_lists_conform() {
    for grid_box in BOXES {
        let make = grid("8x8x8", grid_box, LightSource::Linear);
        let kept = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
            Ok(Box::new(Keep::new(gpu, make(gpu)?, 3)?))
        };
        let touched = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
            Ok(Box::new(Touched::new(gpu, make(gpu)?)?))
        };
        for case in ["33-lights", "lights-move", "camera-teleports", "gpu-order-some-move"] {
            conformance::run_case(case, &kept).expect(case);
            conformance::run_case(case, &touched).expect(case);
        }
    }
}

#[test]
fn faults_are_rejected() {
    for grid_box in BOXES {
        let make = grid("8x8x8", grid_box, LightSource::Linear);
        assert_eq!(conformance::rejects_faults(&make).expect("rejects"), Fault::all(false));
    }
}

/// Cells that were made for another view serve no sample outside their box.
#[test]
fn samples_outside_the_box_read_all_lights() {
    for grid_box in BOXES {
        let make = grid("8x8x8", grid_box, LightSource::Linear);
        let first_view = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
            Ok(Box::new(FirstView::new(make(gpu)?)))
        };
        conformance::run_case("camera-teleports", &first_view).expect("conforms");
        let clamped = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
            Ok(Box::new(Reworded::new(first_view(gpu)?, |wesl| assign::StrategyWesl {
                main: reword(wesl.main, "if !is_served &&", "if false &&"),
                ..wesl
            })))
        };
        let (what, case) = ("samples outside the box read a border cell", "camera-teleports");
        conformance::rejects_in(what, case, Breach::MissedPair, &clamped).expect("rejects");
    }
}

/// Smaller boxes have smaller cells, and so shorter lists.
#[test]
fn lists_are_shorter_than_over_the_supports() {
    let listed = |grid_box| {
        let make = grid("16x16x16", grid_box, LightSource::Linear);
        let case = conformance::run_case("opaque-surfaces-only", &make).expect("conforms");
        case.listed_per_sample().expect("passed")
    };
    let [supports, frustum, visible] =
        [GridBox::Supports, GridBox::Frustum, GridBox::Visible].map(listed);
    println!(
        "{supports:.1} over supports, {frustum:.1} over the frustum, {visible:.1} over samples"
    );
    assert!(visible < frustum && frustum < supports, "{supports}, {frustum}, {visible}");
}

#[test]
fn visible_samples_need_depth_and_serve_only_them() {
    let gpu = Gpu::open(None).unwrap();
    let lights = LightBuffer::new(&gpu, &[]).unwrap();
    let view = View::look_at(Vec3::ONE, Vec3::ZERO, 1.0, 0.1, [64, 48]);
    let frame = Frame::new(&view, &lights);
    let mut strategy = grid("8x8x8", GridBox::Visible, LightSource::Linear)(&gpu).unwrap();
    let error = strategy.prepare(&gpu, &frame).unwrap_err().to_string();
    assert!(error.contains("needs depth"), "{error}");
    let any = frame.sampled_at(SampleDomain::AnyDepth);
    let error = strategy.prepare(&gpu, &any).unwrap_err();
    assert!(matches!(error, AssignError::Unsupported { .. }), "{error}");
    let mut frustum = grid("8x8x8", GridBox::Frustum, LightSource::Linear)(&gpu).unwrap();
    frustum.prepare(&gpu, &any).unwrap();
}

/// The number of cells with lights where the depth buffer holds one depth.
fn occupied(depth: f32, size: [u32; 2]) -> u32 {
    let gpu = Gpu::open(None).unwrap();
    let view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 0.125, size);
    let light = Light::point(Vec3::new(0.0, 0.0, -4.0), 50.0, Vec3::ONE);
    let lights = LightBuffer::new(&gpu, &[light; 3]).unwrap();
    let depth = conformance::flat_depth(&gpu, size, depth);
    let mut strategy = grid("4x4x4", GridBox::Visible, LightSource::Linear)(&gpu).unwrap();
    let frame = Frame::new(&view, &lights).with_depth(&depth);
    strategy.prepare(&gpu, &frame).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    strategy.record(&frame, &mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    strategy.lists().snapshot(&gpu).unwrap().counters.occupied_groups
}

#[test]
fn any_depth_buffer_has_cells() {
    // A wall at 4 m has one layer of cells.
    assert_eq!(occupied(0.125 / 4.0, [64, 48]), 16);
    // Background has one cell, in a corner of the lights' box, where no light reaches.
    assert_eq!(occupied(0.0, [64, 48]), 0);
    // So far away that positions are no numbers.
    assert_eq!(occupied(1e-40, [64, 48]), 0);
    assert_eq!(occupied(0.125 / 4.0, [1, 1]), 1);
    // Farther away than any light reaches: one thin cell at the end of the lights' box.
    assert_eq!(occupied(1e-9, [64, 48]), 1);
}

/// `key_of` of `keys.wesl`.
fn key_of(number: f32) -> u32 {
    let bits = number.to_bits();
    bits ^ if bits >> 31 == 1 { u32::MAX } else { 1 << 31 }
}

/// The GPU cuts a box into the cells into which the CPU cuts it.
#[test]
fn the_gpu_cuts_boxes_as_the_cpu_does() {
    let gpu = Gpu::open(None).unwrap();
    let view = View::look_at(Vec3::new(3.0, 4.0, 0.0), Vec3::ZERO, 1.0, 0.1, [64, 48]);
    let no_lights = LightBuffer::new(&gpu, &[]).unwrap();
    let mut bindings = FrameBindings::new(&gpu);
    bindings.update(&gpu, &Frame::new(&view, &no_lights)).unwrap();
    let module = Shader::new(1)
        .module("package::visible", include_str!("../src/shaders/visible.wesl"))
        .module("package::surface", include_str!("../src/shaders/surface.wesl"))
        .strategy(assign_grid::GRID_WESL)
        .create(&gpu, "package::visible")
        .unwrap();
    let counts = CellCounts([20, 6, 9]);
    let lights = (Vec3::new(-9.0, -1.0, -20.0), Vec3::new(7.0, 5.0, 30.0));
    let asked = upload(&gpu, "asked", &[AskedCells::new(counts, lights)]).unwrap();
    let made = gpu.storage("made", size_of::<CellsUniform>() as u64).unwrap();
    let cut = |found: [u32; 6]| {
        let found = upload(&gpu, "found", &found).unwrap();
        let buffers =
            [(1, Slot::Write, &found), (2, Slot::Uniform, &asked), (3, Slot::Write, &made)];
        let frame = Bound::Group(bindings.layout(), bindings.bind_group().unwrap());
        run_kernel(&gpu, &module, "cut_box", &[frame, Bound::Buffers(&buffers)], 1);
        download::<CellsUniform>(&gpu, &made, 1).unwrap()[0]
    };
    for (low, high, layers) in [
        (Vec3::new(-3.0, 0.0, -2.0), Vec3::new(4.0, 2.0, 25.0), 6),
        // Larger than the box of the lights on some sides.
        (Vec3::new(-30.0, 0.0, -2.0), Vec3::new(4.0, 20.0, 25.0), 6),
        // A floor has one layer.
        (Vec3::new(-3.0, 1.0, -2.0), Vec3::new(4.0, 1.0, 25.0), 1),
        // Where no light reaches.
        (Vec3::new(10.0, 0.0, -2.0), Vec3::new(12.0, 2.0, 25.0), 6),
    ] {
        let keys = [low.x, low.y, low.z, -high.x, -high.y, -high.z].map(key_of);
        let found = cut(keys);
        // `position_slack_m`.
        let extreme = low.abs().max(high.abs()).length();
        let slack_m = 2.0 * view.uniform().position_error * (5.0 + 2.0 * extreme);
        let overlap = (low.max(lights.0), high.min(lights.1));
        let wanted = CellsUniform::new(counts, overlap, Some(lights)).within((low, high), slack_m);
        assert_eq!((found.counts, wanted.counts), ([20, layers, 9], [20, layers, 9]));
        let numbers = |cells: &CellsUniform| {
            let corners = [
                cells.min_world,
                cells.reach_min,
                cells.reach_max,
                cells.lights_min,
                cells.lights_max,
            ];
            corners.into_iter().chain([cells.cell_m]).flatten().chain([cells.slack_m]).collect()
        };
        let (found, wanted): (Vec<f32>, Vec<f32>) = (numbers(&found), numbers(&wanted));
        for (found, wanted) in found.iter().zip(&wanted) {
            let tolerance = 1e-6 * wanted.abs().max(1e-3);
            assert!((found - wanted).abs() <= tolerance, "{low} to {high}: {found} and {wanted}");
        }
    }
    let none = cut([u32::MAX; 6]);
    assert_eq!(none.counts, [1; 3], "no samples");
    assert!(none.cell_m.iter().all(|m| *m > 0.0), "{none:?}");
}
