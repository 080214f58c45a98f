//! What methods pay for: memory against what the device allocated, and passes against what was drawn.

use std::collections::BTreeMap;

use assign::{EncoderPasses, Gpu, Passes};
use harness::choice::Choice;
use harness::cli::{Invocation, parse};
use harness::measure::memory_bytes;
use harness::moving::order_bytes;
use harness::painter::Painter;
use harness::results::{PassKind, is_raster_pass, pass_kind};
use harness::stage::Stage;
use harness::strategy::{Method, Row, StrategyId, rows};
use shading::{Cut, Mode, record_before_lighting};

/// A small stage on the adapter of this machine.
fn stage() -> (Gpu, Stage) {
    let gpu = Gpu::open(None).expect("an adapter");
    let line = ["lightbench", "--lights", "300", "--size", "160x90"];
    let Ok(Invocation::Compare(args)) = parse(line) else { panic!("not understood") };
    let mut stage = Stage::new(&gpu, &args.stage).expect("a stage");
    stage.prepare().expect("prepares");
    (gpu, stage)
}

/// Sizes of what is allocated on the device, by name; wgpu's own is left out.
fn allocated(gpu: &Gpu) -> Option<BTreeMap<String, Vec<u64>>> {
    gpu.wait().expect("waits");
    let report = gpu.device.generate_allocator_report()?;
    let mut sizes: BTreeMap<String, Vec<u64>> = BTreeMap::new();
    for allocation in report.allocations {
        if !allocation.name.starts_with("(wgpu internal)") {
            sizes.entry(allocation.name).or_default().push(allocation.size);
        }
    }
    Some(sizes)
}

fn bytes_and_count(sizes: &BTreeMap<String, Vec<u64>>) -> (u64, u64) {
    let all = || sizes.values().flatten();
    (all().sum(), all().count() as u64)
}

/// A driver rounds each allocation up, by less than this.
const ROUNDING: u64 = 256;

/// No buffer is forgotten: what a strategy says of its memory is what the device allocated for it, up
/// to the driver's rounding, and the hierarchy that it shares with others.
#[test]
fn memory_is_what_the_device_allocated() {
    let (gpu, stage) = stage();
    let hierarchy = stage.lights.nodes().size();
    let more = ["SC-E/bvh", "G/bvh", "M/2", "SC-E/n24/s0.001", "T-E/bvh/cap4"].map(str::to_owned);
    let ids = rows().map(Row::default_id).chain(more);
    let mut checked = 0;
    for id in ids {
        let Some(before) = allocated(&gpu) else {
            println!("skipped: {} tells nothing of allocations", gpu.info.name);
            return;
        };
        let choice = Choice::parse(&id).expect("a choice");
        let Method::Lists { mut strategy, .. } = choice.make(&gpu).expect("a method") else {
            continue;
        };
        let frame = stage.renderer.frame(&stage.view, &stage.lights);
        // The second frame has the pool that the first one asked for.
        for _ in 0..3 {
            strategy.prepare(&gpu, &frame).expect("prepares");
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut passes = EncoderPasses { encoder: &mut encoder };
            record_before_lighting(
                &stage.renderer,
                Mode::Deferred,
                strategy.as_mut(),
                &frame,
                &mut passes,
            );
            gpu.queue.submit([encoder.finish()]);
            gpu.wait().expect("waits");
        }
        let after = allocated(&gpu).expect("as before");
        let shared = if id.contains("/bvh") { hierarchy } else { 0 };
        let said = strategy.memory_bytes() - shared;
        let ((old, olds), (new, news)) = (bytes_and_count(&before), bytes_and_count(&after));
        let (grown, buffers) = (new - old, news - olds);
        assert!(
            said <= grown && grown < said + buffers * ROUNDING,
            "{id} says {said} bytes; {buffers} buffers of {grown} bytes were allocated: {after:?}"
        );
        // Lists alone are not all of it.
        assert!(strategy.memory_bytes() > strategy.lists().bytes(), "{id}");
        checked += 1;
    }
    assert!(checked > 12, "{checked} strategies");
}

/// What orders lights that move counts for methods that read the hierarchy, and the ordered copies are part of
/// it, whoever moves the lights.
#[test]
fn memory_counts_what_orders_the_lights() {
    let gpu = Gpu::open(None).expect("an adapter");
    let order_of = |options: &str| {
        let line = format!("lightbench --lights 300 --size 16x9 {options}");
        let Ok(Invocation::Compare(args)) = parse(line.split_whitespace()) else {
            panic!("{line}")
        };
        let mut stage = Stage::new(&gpu, &args.stage).expect("a stage");
        stage.prepare().expect("prepares");
        let counted = ["T-E", "T-E/bvh"].map(|id| {
            let choice = Choice::parse(id).expect("a choice");
            let method = choice.make(&gpu).expect("a method");
            let Method::Lists { mut strategy, .. } = method else { panic!("{id} has lists") };
            strategy.prepare(&gpu, &stage.renderer.frame(&stage.view, &stage.lights)).expect(id);
            memory_bytes(&stage, strategy.as_ref(), Mode::Deferred) - strategy.memory_bytes()
        });
        assert_eq!(counted[0], 0, "{options}: the plain list needs no order");
        assert_eq!(counted[1], order_bytes(&stage.lights), "{options}");
        counted[1]
    };
    assert_eq!(order_of(""), 0);
    // Two records of 16 bytes and an index for each light, at least.
    let [by_gpu, by_cpu] =
        ["gpu", "cpu"].map(|who| order_of(&format!("--motion drift --moved-by {who}")));
    assert!((300 * 36..300 * 200).contains(&by_gpu), "{by_gpu}");
    // The CPU's lights have room for a quarter more.
    assert!((by_gpu..=by_gpu * 3 / 2).contains(&by_cpu), "{by_cpu} against {by_gpu}");
}

/// Passes by name and how they were recorded.
struct Recorder<'a> {
    inner: EncoderPasses<'a>,
    drawn: Vec<(String, bool)>,
}

impl Passes for Recorder<'_> {
    fn compute(&mut self, name: &str, record: &mut dyn FnMut(&mut wgpu::ComputePass<'_>)) {
        self.drawn.push((name.to_owned(), false));
        self.inner.compute(name, record);
    }
    fn render(
        &mut self,
        name: &str,
        descriptor: &wgpu::RenderPassDescriptor<'_>,
        record: &mut dyn FnMut(&mut wgpu::RenderPass<'_>),
    ) {
        self.drawn.push((name.to_owned(), true));
        self.inner.render(name, descriptor, record);
    }
    fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        self.inner.encoder()
    }
}

#[test]
fn making_the_lights_is_on_no_bill() {
    for mode in Mode::ALL {
        for name in ["rsm-depth", "cdi-ranges", "random-ranges", "vpl-keep", "vpl-order"] {
            assert_eq!(pass_kind(name, mode), PassKind::Other, "{name} in {}", mode.name());
        }
        assert_eq!(pass_kind("order", mode), PassKind::Assign);
    }
}

/// Names tell which passes rasterise and who pays, in every mode.
#[test]
fn passes_are_told_by_their_names() {
    let (gpu, mut stage) = stage();
    let ids = ["None", "RasterSphere", "Clay", "T-I/28x28", "T-E/28x28", "SC-E/48x48x40/n6", "M/2"];
    let mut assigned: BTreeMap<(&str, &str), String> = BTreeMap::new();
    for mode in Mode::ALL {
        for id in ids {
            let unserved = (id == "RasterSphere" && mode.is_forward())
                || (id == "Clay" && mode == Mode::ForwardNoPrepass);
            if unserved {
                continue;
            }
            let mut method = Choice::parse(id).expect("a choice").make(&gpu).expect("a method");
            let mut painter =
                Painter::new(&stage, &mut method, mode, Cut::default()).expect("a painter");
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let inner = EncoderPasses { encoder: &mut encoder };
            let mut recorder = Recorder { inner, drawn: Vec::new() };
            painter.draw(&gpu, &mut stage, mode, &mut recorder).expect("draws");
            let drawn = recorder.drawn;
            gpu.queue.submit([encoder.finish()]);
            for (name, is_render) in &drawn {
                let what = format!("{name} of {id} in {}", mode.name());
                assert_eq!(is_raster_pass(name, mode, &StrategyId::read(id)), *is_render, "{what}");
            }
            let billed: Vec<&str> = drawn
                .iter()
                .map(|(name, _)| name.as_str())
                .filter(|name| pass_kind(name, mode) == PassKind::Assign)
                .collect();
            assigned.insert((mode.name(), id), billed.join(","));
        }
    }
    for (mode, id, passes) in [
        ("deferred", "T-E/28x28", "bounds,cull"),
        ("deferred", "M/2", "model-ids,cull"),
        ("deferred-ids", "M/2", "cull"),
        ("deferred-ids", "SC-E/48x48x40/n6", "bounds,cull"),
        ("forward", "T-E/28x28", "bounds,cull"),
        ("forward", "SC-E/48x48x40/n6", "gbuffer,bounds,cull"),
        ("forward", "M/2", "cull"),
        ("forward-no-prepass", "T-I/28x28", "cull"),
        ("forward-no-prepass", "T-E/28x28", "depth,bounds,cull"),
        ("forward-no-prepass", "SC-E/48x48x40/n6", "depth,gbuffer,bounds,cull"),
    ] {
        assert_eq!(assigned.get(&(mode, id)).map(String::as_str), Some(passes), "{id} in {mode}");
    }
}
