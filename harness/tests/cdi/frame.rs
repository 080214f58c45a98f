//! Frames that make their own virtual point lights: from the reflective shadow map to the image, no light
//! crosses to the CPU.

use assign::{EncoderPasses, Gpu, LightBuffer, Mapped};
use harness::{
    choice::Choice,
    cli::{Invocation, parse},
    painter::Painter,
    stage::Stage,
    strategy::Method,
};
use shading::{Cut, HdrImage, Mode};

use crate::{ROOM_VIEW, room};

/// No culling, lists that read the hierarchy, and lists of lights that look for their groups.
const STRATEGIES: [&str; 3] = ["None", "SC-E/48x48x40/bvh", "HG"];

/// A room under the lights of a map of `side` pixels a side.
fn stage(gpu: &Gpu, side: &str) -> Stage {
    let folder = tempfile::tempdir().expect("a folder");
    let scene = room(folder.path(), 0.9);
    let small = ["--directions", "4x4", "--deep-size", "16", "--vpls", side];
    let words = [&["lightbench", "--scene", &scene], &ROOM_VIEW[..], &small].concat();
    let Ok(Invocation::Compare(args)) = parse(words) else { panic!("not understood") };
    let mut stage = Stage::new(gpu, &args.stage).expect("a stage");
    stage.prepare().expect("prepares");
    stage
}

fn method(gpu: &Gpu, id: &str) -> Method {
    Choice::parse(id).expect("a choice").make(gpu).expect("a method")
}

/// The maps that preparing a frame takes, and those from its first pass to its image.
struct Maps {
    before: Mapped,
    within: Mapped,
}

/// Draws one frame in one submission.
fn frame(gpu: &Gpu, stage: &mut Stage, painter: &mut Painter<'_>) -> Maps {
    let since = |start: Mapped| {
        let now = gpu.mapped();
        Mapped { maps: now.maps - start.maps, bytes: now.bytes - start.bytes }
    };
    let start = gpu.mapped();
    painter.prepare(gpu, stage).expect("prepares");
    let before = since(start);
    let start = gpu.mapped();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    painter.record(gpu, stage, Mode::Deferred, &mut passes).expect("records");
    gpu.queue.submit([encoder.finish()]);
    gpu.wait().expect("waits");
    Maps { before, within: since(start) }
}

/// The image after a few frames: pools have grown to what lists ask for.
fn image(gpu: &Gpu, stage: &mut Stage, id: &str) -> HdrImage {
    let mut method = method(gpu, id);
    let mut painter =
        Painter::new(stage, &mut method, Mode::Deferred, Cut::default()).expect("a painter");
    for _ in 0..3 {
        forget_lights(gpu, stage);
        frame(gpu, stage, &mut painter);
    }
    HdrImage::read(gpu, stage.renderer.targets(), stage.view.viewport).expect("an image")
}

/// Clears the lights that the last frame made.
fn forget_lights(gpu: &Gpu, stage: &Stage) {
    let Some(bounce) = &stage.bounce else { return };
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    for buffer in [bounce.vpls().counts(), bounce.vpls().spheres(), bounce.vpls().ranges_m()] {
        encoder.clear_buffer(buffer, 0, None);
    }
    gpu.queue.submit([encoder.finish()]);
}

/// Between its first pass and its image a frame maps no buffer. Before its first pass it maps the counters of
/// earlier frames: as many bytes for four times the lights.
#[test]
fn no_light_crosses_to_the_cpu() {
    let gpu = Gpu::open(None).expect("an adapter");
    let mut kept = Vec::new();
    let mut prepared: Vec<Vec<Mapped>> = Vec::new();
    for side in ["24", "48"] {
        let mut stage = stage(&gpu, side);
        kept.push(stage.light_count());
        let mut all = Vec::new();
        for id in STRATEGIES {
            let mut method = method(&gpu, id);
            let mut painter = Painter::new(&stage, &mut method, Mode::Deferred, Cut::default())
                .expect("a painter");
            for drawn in 0..4 {
                let maps = frame(&gpu, &mut stage, &mut painter);
                assert_eq!(maps.within, Mapped::default(), "{id}, frame {drawn}");
                if drawn > 1 {
                    all.push(maps.before);
                }
            }
        }
        prepared.push(all);
        // The way over the CPU maps every light: 64 bytes each.
        let start = gpu.mapped();
        let bounce = stage.bounce.as_ref().expect("lights of each frame");
        bounce.vpls().read(&gpu).expect("lights");
        assert!(gpu.mapped().bytes - start.bytes > 64 * stage.light_count());
    }
    assert!(kept[0] > 100 && kept[1] > 3 * kept[0], "{kept:?}");
    assert_eq!(prepared[0], prepared[1]);
    // Counters of lights, of deep images, and of lists.
    for Mapped { maps, bytes } in &prepared[0] {
        assert!(*maps <= 3 && *bytes < 128, "{maps} maps of {bytes} bytes");
    }
}

/// Lights that stay on the GPU give the image of the same lights from the CPU in the same order, in every
/// bit, and so does a second run.
#[test]
fn images_equal_those_of_lights_from_the_cpu() {
    let gpu = Gpu::open(None).expect("an adapter");
    let mut stage = stage(&gpu, "24");
    let from_gpu = STRATEGIES.map(|id| image(&gpu, &mut stage, id));
    let again = STRATEGIES.map(|id| image(&gpu, &mut self::stage(&gpu, "24"), id));
    let lights = stage.lights.read(&gpu).expect("lights");
    assert_eq!(lights.len() as u64, stage.light_count());
    stage.bounce = None;
    stage.lights = LightBuffer::new(&gpu, &lights).expect("a buffer");
    assert_eq!(stage.lights.lights().len(), lights.len());
    stage.prepare().expect("prepares");
    for ((id, from_gpu), again) in STRATEGIES.iter().zip(&from_gpu).zip(&again) {
        let from_cpu = image(&gpu, &mut stage, id);
        assert!(from_gpu.pixels == from_cpu.pixels, "{id}: the CPU's lights");
        assert!(from_gpu.pixels == again.pixels, "{id}: a second run");
        let lit = from_gpu.pixels.iter().filter(|pixel| **pixel != [0.0; 3]).count();
        assert!(2 * lit > from_gpu.pixels.len(), "{id}: {lit} pixels are lit");
    }
    // The control: another order changes the last bits.
    let reversed: Vec<_> = lights.iter().rev().copied().collect();
    stage.lights = LightBuffer::new(&gpu, &reversed).expect("a buffer");
    stage.prepare().expect("prepares");
    assert!(image(&gpu, &mut stage, "None").pixels != from_gpu[0].pixels);
}

/// Each frame makes the lights that it shows: without its passes there are none.
#[test]
fn a_frame_shows_its_own_lights() {
    let gpu = Gpu::open(None).expect("an adapter");
    let mut stage = stage(&gpu, "24");
    let lit = image(&gpu, &mut stage, "SC-E/48x48x40/bvh");
    assert!(lit.pixels.iter().any(|pixel| *pixel != [0.0; 3]));
    forget_lights(&gpu, &stage);
    stage.bounce = None;
    let dark = image(&gpu, &mut stage, "SC-E/48x48x40/bvh");
    assert!(dark.pixels.iter().all(|pixel| *pixel == [0.0; 3]));
}
