//! Tiles whose bit masks subgroups read together: samples read all lights of their masks, and the suite rejects
//! tiles with each planted fault.

use assign::{
    AssignError, Assignment, Bounds, CullSettings, EncoderPasses, Frame, FrameBindings, Gpu, Keep,
    Light, LightBuffer, LightKinds, LightReader, LightSource, Shader, Storage, StrategyWesl,
    Touched, View,
    conformance::{
        self, Bound, Breach, CASES, LinkedModule, Reworded, download, faulty::Fault, reword,
        run_kernel, upload,
    },
    kernel::Slot,
};
use assign_tiled::{Tiled, tile_wesl};
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

fn scalar(
    size: &'static str,
    bounds: Bounds,
    source: LightSource,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    tiles(size, bounds, source, Storage::ScalarMasks)
}

#[test]
fn scalar_masks_conform() {
    for (size, bounds, source) in [
        ("16x16", Bounds::Implicit, LightSource::Linear),
        ("13x9", Bounds::Explicit, LightSource::Hierarchy),
    ] {
        // The probe reads at most 16,384 lights of a sample. Here, samples of several tiles read more together.
        for case in CASES.iter().filter(|case| case.name != "65537-lights") {
            conformance::run_case(case.name, &scalar(size, bounds, source)).expect(case.name);
        }
    }
}

#[test]
fn many_lights_conform() {
    let make = scalar("16x16", Bounds::Implicit, LightSource::Hierarchy);
    conformance::run_case("three-levels-of-nodes", &make).expect("conforms");
}

#[test]
fn kept_and_touched_masks_conform() {
    let make = scalar("16x16", Bounds::Explicit, LightSource::Hierarchy);
    let touched = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Touched::new(gpu, make(gpu)?)?))
    };
    let kept = |gpu: &Gpu| -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Keep::new(gpu, make(gpu)?, 3)?))
    };
    for case in ["33-lights", "light-count-changes", "gpu-order-some-move", "lights-from-gpu"] {
        conformance::run_case(case, &touched).expect(case);
        conformance::run_case(case, &kept).expect(case);
    }
}

#[test]
fn planted_faults_are_rejected() {
    let make = scalar("16x16", Bounds::Implicit, LightSource::Linear);
    let planted = conformance::rejects_faults(&make).expect("rejects");
    let left_out = |fault: &Fault| !planted.contains(fault);
    let missing: Vec<Fault> = Fault::all(false).into_iter().filter(left_out).collect();
    assert!(missing.iter().all(|fault| fault.needs_entries()), "{missing:?}");
}

const LOOK_UP: &str = include_str!("../../assign/src/shaders/look_up_mask.wesl");

/// The flags of implicit tiles and of masks that subgroups read together.
const FLAGS: &[(&str, bool)] = &[
    ("explicit_bounds", false),
    ("one_pass", false),
    ("halves", false),
    ("sliced", false),
    ("both_masks", false),
    ("subgroups", true),
];

/// Tiles with another look-up.
fn reworded(look_up: &'static str) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    let make = scalar("16x16", Bounds::Implicit, LightSource::Linear);
    let other =
        move |wesl| StrategyWesl { reader: LightReader::Own(look_up), flags: FLAGS, ..wesl };
    move |gpu| Ok(Box::new(Reworded::new(make(gpu)?, other)))
}

#[test]
fn faults_of_the_look_up_are_rejected() {
    for (what, part, other) in [
        (
            "the first lane's bits",
            "subgroupOr(select(0u, low",
            "subgroupBroadcastFirst(select(0u, low",
        ),
        (
            "lights of others count",
            "extractBits(select((*cursor).own_high, (*cursor).own_low, is_low), bit, 1u)",
            "1u",
        ),
    ] {
        let make = reworded(reword(LOOK_UP, part, other));
        let breach = Breach::MissedPair;
        conformance::rejects_in(what, "5000-lights", breach, &make).expect("rejects");
    }
}

const SIZE: [u32; 2] = [64, 48];
const LIGHTS: usize = 512;

/// Reads the lights of 64 samples after each lane has read another number of lights alone. Writes the lights that
/// it finds.
const READER: &str = "
import package::lists::ENTRY_LIGHT;
import package::look_up::{next_light, open_lights};
import package::sample::sample_at;
@group(2) @binding(0) var<storage, read_write> found: array<u32>;
@compute @workgroup_size(64) fn gather(@builtin(global_invocation_id) id: vec3u) {
  let pixel = vec2f(f32(id.x) + 0.5, 24.5);
  var cursor = open_lights(sample_at(pixel, 0.05, vec3f(0.0), 0u));
  var count = 0u;
  for (var alone = (id.x * 7u) % 64u; alone > 0u && next_light(&cursor); alone--) {
    found[id.x * 1024u + count] = cursor.entry & ENTRY_LIGHT;
    count += 1u;
  }
  while count < 1000u && next_light(&cursor) {
    found[id.x * 1024u + count] = cursor.entry & ENTRY_LIGHT;
    count += 1u;
  }
  found[id.x * 1024u + 1023u] = count;
}";

/// The lights that each of 64 lanes reads.
fn read(make: &impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError>) -> Vec<Vec<u32>> {
    let gpu = Gpu::open(None).expect("a GPU");
    let mut strategy = make(&gpu).expect("tiles");
    let place = |ix: usize| Vec3::new((ix % 37) as f32 / 10.0 - 1.8, (ix % 11) as f32 / 10.0, 0.0);
    let lights = (0..LIGHTS).map(|ix| Light::point(place(ix), 0.5, Vec3::ONE));
    let lights = LightBuffer::new(&gpu, &lights.collect::<Vec<_>>()).expect("lights");
    let view = View::look_at(Vec3::new(0.0, 0.0, 2.0), Vec3::ZERO, 1.0, 0.1, SIZE);
    let frame = Frame::new(&view, &lights);
    strategy.prepare(&gpu, &frame).expect("prepares");
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    strategy.record(&frame, &mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    let mut bindings = FrameBindings::new(&gpu);
    bindings.update(&gpu, &frame).expect("the frame");
    let lookup = strategy.lookup();
    let shader = Shader::new(1).module("package::reader", READER).strategy(lookup.module);
    let module = shader.create(&gpu, "package::reader").expect("links");
    let found = upload(&gpu, "found", &[u32::MAX; 64 * 1024]).expect("a buffer");
    let groups = [
        Bound::Group(bindings.layout(), bindings.bind_group().expect("a frame")),
        Bound::Group(lookup.layout(), strategy.bind_group().expect("lists")),
        Bound::Buffers(&[(0, Slot::Write, &found)]),
    ];
    run_kernel(&gpu, &module, "gather", &groups, 1);
    let found: Vec<u32> = download(&gpu, &found, 64 * 1024).expect("lights");
    found.chunks(1024).map(|lane| lane[..lane[1023] as usize].to_vec()).collect()
}

/// The number of lanes that read all lights of their masks once and in order.
fn right_lanes(masks: &[Vec<u32>], found: &[Vec<u32>]) -> usize {
    let is_right = |(mask, found): &(&Vec<u32>, &Vec<u32>)| {
        found.is_sorted_by(|a, b| a < b) && mask.iter().all(|light| found.contains(light))
    };
    masks.iter().zip(found).filter(is_right).count()
}

#[test]
fn lanes_at_different_places_read_all_their_lights_once_and_in_order() {
    let masks = read(&tiles("16x16", Bounds::Implicit, LightSource::Linear, Storage::Masks));
    assert!(masks.iter().all(|mask| mask.len() > 64), "{:?}", masks.iter().map(Vec::len));
    assert_eq!(right_lanes(&masks, &masks), 64);
    let found = read(&scalar("16x16", Bounds::Implicit, LightSource::Linear));
    assert_eq!(right_lanes(&masks, &found), 64);
    for (part, other) in [
        // Lanes that do not wait for others read their lights twice.
        ("is_ahead && node <", "false && node <"),
        // Lanes that go on with the last node of all read others after it.
        ("subgroupMin(own)", "subgroupMax(own)"),
    ] {
        let found = read(&reworded(reword(LOOK_UP, part, other)));
        assert!(right_lanes(&masks, &found) < 64, "{other}");
    }
}

/// Fragment shaders read plain masks.
#[test]
fn without_subgroups_the_shader_is_that_of_plain_masks() {
    for kinds in LightKinds::ALL {
        let [plain, scalar] = [Storage::Masks, Storage::ScalarMasks].map(|storage| {
            let reader = LightReader::Stored(storage);
            let wesl = StrategyWesl { reader, ..tile_wesl(assign_tiled::TileDepths::Implicit) };
            let shader = Shader::new(1).module("package::reader", READER).strategy(wesl);
            let shader = shader.light_kinds(kinds);
            let linked = shader.link("package::reader").expect("links");
            match storage {
                Storage::Masks => LinkedModule::new("plain masks", &linked),
                _ => LinkedModule::with_subgroups("scalarised masks", &linked),
            };
            [linked, shader.without_subgroups().link("package::reader").expect("links")]
        });
        assert_eq!(plain[0], plain[1]);
        assert_ne!(plain[0], scalar[0]);
        assert_eq!(plain[0], scalar[1]);
    }
}
