//! With several samples per pixel, every strategy that serves them shows the image of no culling, and bounds from one
//! depth per pixel lose light.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::conformance::{Reworded, trusting};
use assign::{
    AssignError, Assignment, Bounds, CullSettings, EncoderPasses, Everything, Frame, Gpu,
    LightBuffer, LightLists, Lookup, Needs, Passes, SampleDomain, Storage, View,
};
use assign_clustered::{Clustered, HybridGrid, Occupancy};
use assign_model::PerModel;
use glam::Vec3;
use shading::{
    HdrImage, Lighting, LightingOptions, Mode, Renderer, ShadingError, record_before_lighting,
};

/// A fence of a pixel's width before a far wall.
struct Stage {
    gpu: Gpu,
    renderer: Renderer,
    view: View,
    lights: LightBuffer,
}

impl Stage {
    fn new() -> Self {
        let gpu = Gpu::open(None).unwrap();
        let scene = scenes::open("stability:msaa-depth").unwrap();
        let view = View::look_at(Vec3::ZERO, -25.0 * Vec3::Z, 1.0, 0.1, [160, 90]);
        let mut renderer = Renderer::new(&gpu, &scene, &view).unwrap();
        renderer.sample_pixels(&view, 4).unwrap();
        let lights = LightBuffer::new(&gpu, &scene.lights).unwrap();
        renderer.prepare(&view, &lights).unwrap();
        Self { gpu, renderer, view, lights }
    }

    fn draw(&self, strategy: &mut dyn Assignment) -> Result<HdrImage, ShadingError> {
        let Self { gpu, renderer, view, lights } = self;
        let frame = renderer.frame(view, lights);
        assert_eq!(frame.samples, SampleDomain::NearSurfaces);
        let options = LightingOptions { kinds: lights.kinds(), ..LightingOptions::default() };
        let lighting = Lighting::new(renderer, strategy, Mode::Forward, options)?;
        // Pools grow in the second frame.
        for _ in 0..2 {
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut passes = EncoderPasses { encoder: &mut encoder };
            strategy.prepare(gpu, &frame)?;
            record_before_lighting(renderer, Mode::Forward, strategy, &frame, &mut passes);
            lighting.record(renderer, view, strategy, &mut passes)?;
            gpu.queue.submit([encoder.finish()]);
        }
        HdrImage::read(gpu, renderer.targets(), view.viewport)
    }

    fn clusters(&self, size: &str, bounds: Bounds, occupancy: Occupancy) -> Box<dyn Assignment> {
        let (size, settings) = (size.parse().unwrap(), CullSettings::default());
        Box::new(Clustered::new(&self.gpu, size, bounds, occupancy, settings).unwrap())
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
    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Self(self.0.for_view(gpu)?, self.1.clone())))
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
fn strategies_show_several_samples_as_no_culling_does() {
    let stage = Stage::new();
    let reference = stage.draw(&mut Everything::new(&stage.gpu).unwrap()).unwrap();
    let lit = reference.pixels.iter().filter(|pixel| pixel[0] > 0.0).count();
    assert!(lit * 2 > reference.pixels.len(), "{lit} pixels are lit");
    let gpu = &stage.gpu;
    let masks = CullSettings { storage: Storage::Masks, ..CullSettings::default() };
    let size = "16x16x24".parse().unwrap();
    let all: [Box<dyn Assignment>; 10] = [
        stage.clusters("16x16x24", Bounds::Implicit, Occupancy::Dense),
        stage.clusters("16x16x24", Bounds::Explicit, Occupancy::Dense),
        stage.clusters("16x16x24", Bounds::Implicit, Occupancy::Sparse),
        stage.clusters("16x16x24", Bounds::Explicit, Occupancy::Sparse),
        stage.clusters("4x4x64", Bounds::Explicit, Occupancy::Sparse),
        stage.clusters("16x16x24", Bounds::Implicit, Occupancy::DepthAware),
        stage.clusters("16x16x24", Bounds::Explicit, Occupancy::DepthAware),
        Box::new(Clustered::new(gpu, size, Bounds::Explicit, Occupancy::Sparse, masks).unwrap()),
        Box::new(HybridGrid::new(gpu, size).unwrap()),
        Box::new(PerModel::new(gpu, None, CullSettings::default()).unwrap()),
    ];
    for mut strategy in all {
        let image = stage.draw(&mut *strategy).unwrap();
        let difference = image.difference(&reference).unwrap();
        assert_eq!(difference.differing_channels, 0, "{}: {difference:?}", strategy.id());
    }
    // Deferred shading reads a G-buffer of one sample.
    let none = Everything::new(gpu).unwrap();
    let options = LightingOptions::default();
    let error = Lighting::new(&stage.renderer, &none, Mode::Deferred, options).unwrap_err();
    assert!(error.to_string().contains("only forward modes draw them"), "{error}");
}

#[test]
fn bounds_from_one_depth_per_pixel_lose_light() {
    let stage = Stage::new();
    let Stage { gpu, renderer, view, lights } = &stage;
    let reference = stage.draw(&mut Everything::new(gpu).unwrap()).unwrap();
    // The same view with one sample per pixel.
    let mut single = renderer.beside(view).unwrap();
    single.prepare(view, lights).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    single.record_depth(view, &mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    let depth = &single.targets().depth;
    let lost = |mut strategy: Box<dyn Assignment>| {
        let image = stage.draw(&mut *strategy).unwrap();
        image.difference(&reference).unwrap().differing_channels
    };
    let other = |strategy: Box<dyn Assignment>| -> Box<dyn Assignment> {
        Box::new(WithDepth(strategy, depth.clone()))
    };
    for occupancy in [Occupancy::Sparse, Occupancy::Dense] {
        let made = || stage.clusters("16x16x24", Bounds::Explicit, occupancy);
        let blind = || -> Box<dyn Assignment> { Box::new(Reworded::new(made(), trusting)) };
        let (one, four) = (lost(other(blind())), lost(blind()));
        println!(
            "{occupancy:?}: {one} channels differ with bounds from one depth, {four} from four"
        );
        assert!(one > 0 && four < one, "{occupancy:?}: {one}, {four}");
        // Look-ups that ask lose nothing, whatever the bounds hold.
        assert_eq!(lost(other(made())), 0, "{occupancy:?}");
    }
}
