//! Tiles whose lists have trees of depths: samples read fewer lights and miss none, and the suite rejects tiles with
//! each planted fault.

use assign::{
    AssignError, Assignment, Bounds, CullSettings, ENTRY_LIGHT, EncoderPasses, Frame, Gpu, Keep,
    Light, LightBuffer, LightReader, LightShape, LightSource, Reuse, Storage, StrategyWesl,
    Touched, View,
    conformance::{self, Breach, Reworded, faulty::Fault, reword},
};
use assign_tiled::Tiled;
use glam::Vec3;

fn tiles(
    size: &'static str,
    bounds: Bounds,
    source: LightSource,
    storage: Storage,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    let settings = CullSettings { source, storage, ..CullSettings::default() };
    move |gpu| Ok(Box::new(Tiled::new(gpu, size.parse()?, bounds, settings)?))
}

fn trees(
    size: &'static str,
    bounds: Bounds,
    source: LightSource,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    tiles(size, bounds, source, Storage::Trees)
}

#[test]
fn trees_conform() {
    // llvmpipe might end the loops over so many lights silently: see `LightReader::check_lights`.
    let may_refuse = &["65537-lights", "gpu-order-many"];
    for (size, bounds, source) in [
        ("28x28", Bounds::Implicit, LightSource::Linear),
        ("13x9", Bounds::Explicit, LightSource::Hierarchy),
        // One tile, whose list does not fit into the workgroup's memory.
        ("4096x4096", Bounds::Implicit, LightSource::Linear),
    ] {
        conformance::run_allowing(&trees(size, bounds, source), may_refuse).expect("conforms");
    }
}

#[test]
fn planted_faults_are_rejected() {
    let make = trees("16x16", Bounds::Implicit, LightSource::Linear);
    let planted = conformance::rejects_faults(&make).expect("rejects");
    assert_eq!(planted, Fault::all(false));
}

const LOOK_UP: &str = include_str!("../../assign/src/shaders/look_up_tree.wesl");
const DEPTHS: &str = include_str!("../../assign/src/shaders/tree_depths.wesl");

#[test]
fn faults_of_the_look_up_are_rejected() {
    let rejects = |what: &str, case: &str, look_up: &'static str, depths: &'static str| {
        let imports = vec![("package::tree_depths", depths)].leak();
        let make = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
            let other = |wesl| StrategyWesl { reader: LightReader::Own(look_up), imports, ..wesl };
            let inner = trees("28x28", Bounds::Implicit, LightSource::Linear)(gpu)?;
            Ok(Box::new(Reworded::new(inner, other)))
        };
        conformance::rejects_in(what, case, Breach::MissedPair, &make).expect("rejects");
    };
    for (what, case, part, other) in [
        ("the next run", "5000-lights", "(first, ix / RUN)", "(first, ix / RUN + 1u)"),
        ("the next light", "33-lights", "(first, ix))", "(first, ix + 1u))"),
        ("all lights", "overflow", "(*cursor).first == 0u ||", ""),
        ("a nearer sample", "33-lights", "(sample.depth_view)", "(0.8 * sample.depth_view)"),
    ] {
        rejects(what, case, reword(LOOK_UP, part, other), DEPTHS);
    }
    for (what, part, other) in [
        ("a late begin", "code >= (interval & 0xffffu)", "code >= (interval & 0xffffu) + 8u"),
        ("an early end", "code <= (interval >> 16u)", "code + 8u <= (interval >> 16u)"),
    ] {
        rejects(what, "5000-lights", LOOK_UP, reword(DEPTHS, part, other));
    }
}

#[test]
fn later_frames_are_refused() {
    let gpu = Gpu::open(None).expect("a GPU");
    let make = || {
        let make = trees("16x16", Bounds::Implicit, LightSource::Linear);
        make(&gpu).expect("tiles")
    };
    let refused = [
        Keep::new(&gpu, make(), 3).err(),
        Touched::new(&gpu, make()).err(),
        Reuse::new(make(), 2).err(),
    ];
    for (error, asked) in refused.into_iter().zip(["keep3", "touched", "reuse2"]) {
        let error = error.expect(asked).to_string();
        assert!(error.contains(asked) && error.contains("depths of a tree"), "{error}");
    }
}

/// The code of a depth: `depth_code` of `tree_depths.wesl`.
fn code(depth_m: f32) -> u32 {
    let (nearest, farthest) = ((-12.0_f32).exp2().to_bits(), 20.0_f32.exp2().to_bits() - 1);
    (depth_m.max(0.0).to_bits().clamp(nearest, farthest) - nearest) >> 12
}

/// Reads the buffers of one frame: each list holds the intervals of its lights, which are hardly longer than the
/// lights' own, and the intervals of its runs.
#[test]
fn trees_hold_the_depths_of_their_lights() {
    let gpu = Gpu::open(None).expect("a GPU");
    let view = View::look_at(Vec3::new(0.0, 0.0, 4.0), Vec3::ZERO, 1.0, 0.1, [64, 48]);
    let lights: Vec<Light> = (0..300)
        .map(|ix| {
            let place = Vec3::new(0.0, 0.0, 2.0 - ix as f32 / 20.0);
            let mut light = Light::point(place, 1.5, Vec3::ONE);
            if ix % 3 == 0 {
                let (inner_angle, outer_angle) = (0.2, 0.4);
                // It shines away from the eye.
                light.shape = LightShape::Spot { direction: Vec3::NEG_Z, inner_angle, outer_angle };
            }
            light
        })
        .collect();
    let buffer = LightBuffer::new(&gpu, &lights).expect("lights");
    let frame = Frame::new(&view, &buffer);
    let make = trees("64x48", Bounds::Implicit, LightSource::Linear);
    let mut tiles = make(&gpu).expect("tiles");
    // The first frame may find too small a pool.
    for _ in 0..4 {
        tiles.prepare(&gpu, &frame).expect("prepares");
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        tiles.record(&frame, &mut EncoderPasses { encoder: &mut encoder });
        gpu.queue.submit([encoder.finish()]);
        gpu.wait().expect("waits");
    }
    let lists = tiles.lists();
    let snapshot = lists.snapshot(&gpu).expect("lists");
    let list = snapshot.list(0).expect("one tile");
    assert!(list.first > 0 && list.count > 250, "{list:?}");
    let words = snapshot.entries;
    let (first, count) = (list.first as usize, list.count as usize);
    let interval = |ix: usize| words[first - 2 - ix - ix / 8];
    for ix in 0..count {
        let light = &lights[(words[first + ix] & ENTRY_LIGHT) as usize];
        let depth_m = 4.0 - light.position.z;
        let is_spot = matches!(light.shape, LightShape::Spot { .. });
        let near_m = if is_spot { depth_m } else { depth_m - light.range_m };
        let (low, high) = (interval(ix) & 0xffff, interval(ix) >> 16);
        let (near, far) = (code(near_m), code(depth_m + light.range_m));
        // Spots widen their cones a little.
        let most = if is_spot { 16 } else { 1 };
        assert!(low <= near && near - low <= most, "light {ix}: {low} is not {near}");
        assert!(far <= high && high - far <= most, "light {ix}: {high} is not {far}");
    }
    for run in 0..count.div_ceil(8) {
        let of_run = || (8 * run..count.min(8 * run + 8)).map(interval);
        let low = of_run().map(|interval| interval & 0xffff).min();
        let high = of_run().map(|interval| interval >> 16).max();
        let joined = words[first - 1 - 9 * run];
        assert_eq!((Some(joined & 0xffff), Some(joined >> 16)), (low, high), "run {run}");
    }
    // The pool holds two words per entry and one per run.
    let counters = snapshot.counters;
    assert_eq!(counters.requested(), u64::from(list.count));
    assert_eq!(counters.cursor, 2 * list.count + list.count.div_ceil(8));
}

/// A tree that skips nothing conforms too, so this test checks that samples read fewer lights.
#[test]
fn samples_read_fewer_lights() {
    for (bounds, most) in [(Bounds::Implicit, 0.6), (Bounds::Explicit, 0.8)] {
        let listed = |storage| {
            let make = tiles("28x28", bounds, LightSource::Linear, storage);
            let report = conformance::run_case("depth-discontinuity", &make).expect("conforms");
            report.listed_per_sample().expect("passed")
        };
        let [whole, read] = [Storage::Lists, Storage::Trees].map(listed);
        println!("{bounds:?}: {whole} lights listed per sample, {read} read");
        assert!(read < most * whole, "{bounds:?}: {read} of {whole}");
    }
}
