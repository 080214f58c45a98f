//! Two views in one submission: each shows the image of no culling.

use assign::{Gpu, Hitches, LightBuffer, LightKinds, View};
use shading::{HdrImage, Renderer};

use crate::stage::{Contender, few, image, lighting, lights, record_frame, scene, truth, view};

/// Two cameras in one scene.
struct Cameras {
    renderers: [Renderer; 2],
    views: [View; 2],
    lights: LightBuffer,
    truths: [HdrImage; 2],
}

impl Cameras {
    /// The second camera sees another part of the scene, in the right part of its target.
    fn new(gpu: &Gpu) -> Self {
        let scene = scene();
        let mut views = [view(&scene, 0.0, [64, 36]), view(&scene, 0.4, [50, 44])];
        (views[1].viewport.x, views[1].viewport.y) = (64, 8);
        let lights = LightBuffer::new(gpu, &lights(&scene, 200)).expect("lights");
        let first = Renderer::new(gpu, &scene, &views[0]).expect("a renderer");
        let second = first.beside(&views[1]).expect("a renderer");
        let mut renderers = [first, second];
        for (renderer, view) in renderers.iter_mut().zip(&views) {
            renderer.prepare(view, &lights).expect("prepares");
        }
        let truths = [0, 1].map(|i| truth(&renderers[i], &views[i], &lights));
        Self { renderers, views, lights, truths }
    }

    /// Draws both views in one submission. `contenders` has one strategy per view, or one for both.
    fn draw(&self, contenders: &mut [Contender]) {
        let gpu = self.renderers[0].gpu();
        let last = contenders.len() - 1;
        let lighting = lighting(&self.renderers[0], &self.lights, &contenders[0]);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        for (i, renderer) in self.renderers.iter().enumerate() {
            let strategy = contenders[i.min(last)].strategy.as_mut();
            let seen = (&self.views[i], &self.lights);
            record_frame(renderer, seen, strategy, &lighting, &mut encoder);
        }
        gpu.queue.submit([encoder.finish()]);
    }

    /// Channels of both images that differ from those of no culling.
    fn differences(&self) -> [u64; 2] {
        [0, 1].map(|i| {
            let shown = image(&self.renderers[i], &self.views[i]);
            shown.difference(&self.truths[i]).expect("as large").differing_channels
        })
    }
}

/// Whether a strategy shows every light, whatever the number of lights.
fn is_lossless(contender: &Contender) -> bool {
    let id = harness::strategy::StrategyId::parse(&contender.id).expect("an id");
    !id.is_lossy(200) && !id.has_flaw()
}

#[test]
fn two_instances_in_one_submission_are_exact_and_compile_once() {
    let gpu = Gpu::open(None).expect("an adapter");
    let cameras = Cameras::new(&gpu);
    let mut tested = 0;
    for first in few(&gpu).filter(is_lossless) {
        let id = first.id.clone();
        let early_exit = first.early_exit;
        let mut both = vec![first];
        // The first frame compiles for the kinds of lights.
        cameras.draw(&mut both);
        let before = gpu.hitches();
        let strategy = both[0].strategy.for_view(&gpu).expect("a second view");
        assert_eq!(strategy.id(), both[0].strategy.id());
        assert_eq!(strategy.lookup().layout(), both[0].strategy.lookup().layout(), "{id}");
        both.push(Contender { id: id.clone(), strategy, early_exit });
        // Pools grow in the second frame.
        for frame in 0..3 {
            cameras.draw(&mut both);
            assert_eq!(cameras.differences(), [0, 0], "{id}, frame {frame}");
        }
        let Hitches { pipelines, modules, .. } = gpu.hitches().since(before);
        assert_eq!((pipelines, modules), (0, 0), "{id} compiled for the second view");
        tested += 1;
    }
    assert!(tested > 12, "{tested} strategies");
}

/// Parameters reach the GPU in the order of commands. If they went through the queue, the first view would be drawn
/// with the second view's.
#[test]
fn one_instance_prepared_twice_before_a_submission_is_exact() {
    let gpu = Gpu::open(None).expect("an adapter");
    let cameras = Cameras::new(&gpu);
    for contender in few(&gpu).filter(is_lossless) {
        let id = contender.id.clone();
        let mut one = [contender];
        for frame in 0..3 {
            cameras.draw(&mut one);
            assert_eq!(cameras.differences(), [0, 0], "{id}, frame {frame}");
        }
    }
}

/// The comparison finds a view that is drawn with another view's lists.
#[test]
fn lists_of_another_view_are_found() {
    let gpu = Gpu::open(None).expect("an adapter");
    let cameras = Cameras::new(&gpu);
    assert_eq!(cameras.lights.kinds(), LightKinds { spots: true, ..LightKinds::default() });
    let mut one = [crate::stage::contender(&gpu, "SC-E/48x48x40").expect("clusters")];
    let lighting = lighting(&cameras.renderers[0], &cameras.lights, &one[0]);
    cameras.draw(&mut one);
    // The second view reads the first view's lists.
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let seen = (&cameras.views[0], &cameras.lights);
    let strategy = one[0].strategy.as_mut();
    record_frame(&cameras.renderers[0], seen, strategy, &lighting, &mut encoder);
    let mut passes = assign::EncoderPasses { encoder: &mut encoder };
    lighting
        .record(&cameras.renderers[1], &cameras.views[1], strategy, &mut passes)
        .expect("lights");
    gpu.queue.submit([encoder.finish()]);
    let [first, second] = cameras.differences();
    assert!(first == 0 && second > 0, "{first} and {second} channels differ");
}
