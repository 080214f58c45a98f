//! With several samples per pixel, every strategy that serves them shows the image of no culling, and bounds from one
//! depth per pixel lose light.

use assign::conformance::{Reworded, trusting};
use assign::{
    AssignError, Assignment, EncoderPasses, Frame, Gpu, LightLists, Lookup, Needs, Passes,
    SampleDomain,
};
use harness::choice::Choice;
use harness::cli::{Invocation, parse};
use harness::stage::Stage;
use harness::strategy::{Method, Row, rows};
use shading::{HdrImage, Lighting, LightingOptions, Mode, ShadingError, record_before_lighting};

/// A fence of a pixel's width before a far wall.
fn stage(gpu: &Gpu) -> Stage {
    let line = ["lightbench", "--scene", "stability:msaa-depth", "--size", "160x90"];
    let Ok(Invocation::Compare(args)) = parse(line) else { panic!("not understood") };
    let mut stage = Stage::new(gpu, &args.stage).expect("a stage");
    stage.renderer.sample_pixels(&stage.view, 4).expect("four samples");
    stage.prepare().expect("prepares");
    stage
}

fn draw(gpu: &Gpu, stage: &Stage, strategy: &mut dyn Assignment) -> Result<HdrImage, ShadingError> {
    let Stage { renderer, view, lights, .. } = stage;
    let frame = renderer.frame(view, lights);
    assert_eq!(frame.samples, SampleDomain::NearSurfaces);
    // A refusal comes before anything is compiled.
    strategy.prepare(gpu, &frame)?;
    let options = LightingOptions { kinds: lights.kinds(), ..LightingOptions::default() };
    let lighting = Lighting::new(renderer, strategy, Mode::Forward, options)?;
    // Pools grow in the second frame.
    for _ in 0..2 {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = EncoderPasses { encoder: &mut encoder };
        strategy.prepare(gpu, &frame)?;
        lights.record(&mut passes);
        record_before_lighting(renderer, Mode::Forward, strategy, &frame, &mut passes);
        lighting.record(renderer, view, strategy, &mut passes)?;
        gpu.queue.submit([encoder.finish()]);
    }
    HdrImage::read(gpu, renderer.targets(), view.viewport)
}

fn make(gpu: &Gpu, id: &str) -> Option<Box<dyn Assignment>> {
    match Choice::parse(id).expect(id).make(gpu) {
        Ok(Method::Lists { strategy, .. }) => Some(strategy),
        _ => None,
    }
}

/// A strategy that finds its groups from another depth buffer.
struct WithDepth(Box<dyn Assignment>, wgpu::TextureView);

impl Assignment for WithDepth {
    fn id(&self) -> String {
        self.0.id()
    }
    fn needs(&self) -> Needs {
        self.0.needs()
    }
    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        self.0.prepare(gpu, &frame.with_depth(&self.1))
    }
    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        self.0.record(&frame.with_depth(&self.1), passes);
    }
    fn lookup(&self) -> Lookup<'_> {
        self.0.lookup()
    }
    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.0.bind_group()
    }
    fn lists(&self) -> &LightLists {
        self.0.lists()
    }
    fn lists_mut(&mut self) -> &mut LightLists {
        self.0.lists_mut()
    }
    fn memory_bytes(&self) -> u64 {
        self.0.memory_bytes()
    }
}

#[test]
fn every_strategy_shows_several_samples_as_no_culling_does_or_refuses_them() {
    let gpu = Gpu::open(None).expect("an adapter");
    let stage = stage(&gpu);
    let mut none = make(&gpu, "None").expect("no culling");
    let reference = draw(&gpu, &stage, &mut *none).expect("draws");
    let lit = reference.pixels.iter().filter(|pixel| pixel[0] > 0.0).count();
    assert!(lit * 2 > reference.pixels.len(), "{lit} pixels are lit");
    let more = ["SC-E/8x8x64", "SC-E/16x16x24/mask", "SC-E/16x16x24/bvh", "DA-E/8x8x64"];
    let (mut served, mut refused) = (Vec::new(), Vec::new());
    for id in rows().map(Row::default_id).chain(more.map(str::to_owned)) {
        let Some(mut strategy) = make(&gpu, &id) else { continue };
        match draw(&gpu, &stage, &mut *strategy) {
            Ok(image) => {
                let difference = image.difference(&reference).expect("compares");
                assert_eq!(difference.differing_channels, 0, "{id}: {difference:?}");
                served.push(id);
            }
            Err(ShadingError::Assign(AssignError::Unsupported { .. })) => refused.push(id),
            Err(error) => panic!("{id}: {error}"),
        }
    }
    println!("served: {}\nrefused: {}", served.join(" "), refused.join(" "));
    let families: Vec<&str> = refused.iter().filter_map(|id| id.split('/').next()).collect();
    assert_eq!(families, ["T-E1"]);
}

#[test]
fn bounds_from_one_depth_per_pixel_lose_light() {
    let gpu = Gpu::open(None).expect("an adapter");
    let stage = stage(&gpu);
    let mut none = make(&gpu, "None").expect("no culling");
    let reference = draw(&gpu, &stage, &mut *none).expect("draws");
    // The same view with one sample per pixel.
    let mut single = stage.renderer.beside(&stage.view).expect("a renderer");
    single.prepare(&stage.view, &stage.lights).expect("prepares");
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    single.record_depth(&stage.view, &mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    let depth = &single.targets().depth;
    let lost = |mut strategy: Box<dyn Assignment>| {
        let image = draw(&gpu, &stage, &mut *strategy).expect("draws");
        image.difference(&reference).expect("compares").differing_channels
    };
    let other = |strategy| -> Box<dyn Assignment> { Box::new(WithDepth(strategy, depth.clone())) };
    for id in ["SC-E/16x16x24", "DC-E/16x16x24", "DA-E/16x16x24", "T-E/16x16"] {
        let made = || make(&gpu, id).expect(id);
        let trusting = || Box::new(Reworded::new(made(), trusting));
        let four: Box<dyn Assignment> = trusting();
        let [one, four] = [other(trusting()), four].map(lost);
        println!(
            "{id}: {one} channels differ with bounds from one depth per pixel, {four} from four"
        );
        assert!(one > 0 && four < one, "{id}");
        // Look-ups that ask lose nothing, whatever the bounds hold.
        assert_eq!(lost(other(made())), 0, "{id}");
    }
}
