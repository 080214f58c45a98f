//! Tests layers over the opaque surfaces: transparent surfaces, particles, and fog.

#![allow(dead_code, reason = "the common module serves several tests")]
#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]
mod common;

use assign::conformance::{self, Reworded};
use assign::{
    AssignError, Assignment, Bounds, CullSettings, EncoderPasses, Everything, Frame, Gpu, Light,
    LightBuffer, LightLists, Lookup, Needs, Passes, SampleDomain, Sun, Suns, View,
};
use assign_clustered::{Clustered, Occupancy};
use assign_model::PerModel;
use glam::{Mat4, Vec3, Vec4};
use scenes::{Aabb, Material, Scene, scatter_particles};
use shading::{
    AreaModel, Cut, HdrImage, LayerOptions, LayerSamples, LightBvh, Lighting, LightingOptions,
    ListsTruth, Mode, RasterSpheres, Renderer, ShadingError, ShadowModel, probe,
    record_before_lighting, visit_layer_lists,
};

/// The showcase with three sheets of glass in front of it: two tinted ones that are blended, and a clear one that
/// lets light through.
fn scene() -> Scene {
    let mut scene = common::showcase();
    let glass = |name: &str, color: Vec4, transmission: f32| Material {
        name: name.into(),
        base_color: color,
        metallic: 0.0,
        roughness: 0.2,
        double_sided: true,
        is_blended: transmission == 0.0,
        alpha_cutoff: (transmission == 0.0).then_some(0.5),
        transmission,
        ..Material::default()
    };
    let first = scene.materials.len() as u32;
    scene.materials.extend([
        glass("red", Vec4::new(0.9, 0.2, 0.1, 0.4), 0.0),
        glass("green", Vec4::new(0.1, 0.8, 0.3, 0.6), 0.0),
        glass("clear", Vec4::new(0.9, 0.95, 1.0, 1.0), 0.8),
    ]);
    for (ix, place) in
        [Vec3::new(-0.8, 1.2, 0.8), Vec3::new(0.6, 1.4, 1.6), Vec3::new(0.0, 0.9, 2.4)]
            .into_iter()
            .enumerate()
    {
        let (mesh, model) = (scene.meshes.len() as u32, scene.models.len() as u32);
        scene.meshes.push(scenes::Mesh { material: first + ix as u32, ..scene.meshes[0].clone() });
        let turned = Mat4::from_rotation_y(0.5 - 0.4 * ix as f32);
        scene.models.push(scenes::Model {
            name: format!("glass {ix}"),
            bounds_object: scene.meshes[0].bounds,
            object_to_world: Mat4::from_translation(place) * turned,
        });
        scene.instances.push(scenes::Instance { mesh, model });
    }
    scene
}

/// Every kind of layer.
fn everything_shown() -> LayerOptions {
    let air = Aabb::new(Vec3::new(-2.0, 0.2, -2.0), Vec3::new(2.0, 3.0, 3.0));
    let mut particles = scatter_particles(60, 1, air).unwrap();
    particles.iter_mut().for_each(|particle| particle.radius_m *= 5.0);
    LayerOptions { sheets: true, particles, fog_per_m: Some(0.15) }
}

fn view() -> View {
    common::view([64, 36])
}

/// Clusters, with 16-pixel tiles.
fn clusters(gpu: &Gpu, bounds: Bounds, occupancy: Occupancy) -> Box<dyn Assignment> {
    let size = "16x16x16".parse().unwrap();
    Box::new(Clustered::new(gpu, size, bounds, occupancy, CullSettings::default()).unwrap())
}

/// A strategy that claims to serve any depth, but hands the frame on as one of opaque surfaces.
struct Blind(Box<dyn Assignment>);

impl Blind {
    fn opaque<'a>(frame: &Frame<'a>) -> Frame<'a> {
        frame.sampled_at(SampleDomain::OpaqueSurfaces)
    }
}

impl Assignment for Blind {
    fn id(&self) -> String {
        self.0.id()
    }
    fn needs(&self) -> Needs {
        self.0.needs()
    }
    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Self(self.0.for_view(gpu)?)))
    }
    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        self.0.prepare(gpu, &Self::opaque(frame))
    }
    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        self.0.record(&Self::opaque(frame), passes);
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

/// A frame's image, and the check of the lists that its layers read.
fn draw(
    gpu: &Gpu,
    renderer: &mut Renderer,
    view: &View,
    lights: &LightBuffer,
    strategy: &mut dyn Assignment,
    (mode, options): (Mode, LightingOptions),
) -> Result<(HdrImage, ListsTruth), ShadingError> {
    renderer.prepare(view, lights)?;
    let options = LightingOptions { kinds: lights.kinds(), ..options };
    let lighting = Lighting::new(renderer, strategy, mode, options)?;
    // Pools grow in the second frame.
    for _ in 0..2 {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = EncoderPasses { encoder: &mut encoder };
        let frame = renderer.frame(view, lights);
        strategy.prepare(gpu, &frame)?;
        record_before_lighting(renderer, mode, strategy, &frame, &mut passes);
        lighting.record(renderer, view, strategy, &mut passes)?;
        gpu.queue.submit([encoder.finish()]);
    }
    let image = HdrImage::read(gpu, renderer.targets(), view.viewport)?;
    let frame = renderer.frame(view, lights);
    let samples = LayerSamples::capture(renderer, &frame)?;
    let snapshot = strategy.lists().snapshot(gpu)?;
    let bvh = LightBvh::new(lights.lights());
    let mut truth = ListsTruth::default();
    visit_layer_lists(renderer, strategy, &frame, &snapshot, &samples, &mut |samples, lists| {
        truth = truth.plus(bvh.check(samples, lists, false));
    })?;
    assert_eq!(truth.samples, samples.fragments() + samples.froxels());
    // The captures must not have touched the image.
    let again = HdrImage::read(gpu, renderer.targets(), view.viewport)?;
    assert_eq!(again.difference(&image)?.differing_channels, 0, "capturing changed the image");
    Ok((image, truth))
}

fn renderer(gpu: &Gpu, view: &View, layers: &LayerOptions) -> Renderer {
    let mut renderer = Renderer::new(gpu, &scene(), view).unwrap();
    renderer.show_layers(layers).unwrap();
    renderer
}

/// Points, spots and virtual point lights, or with area lights too.
fn lights(gpu: &Gpu, areas: bool) -> LightBuffer {
    let mut lights = common::lights(40);
    if areas {
        let lamp = assign::Emitter::rectangle(Vec3::X * 0.4, Vec3::Y * 0.3);
        lights.push(Light::area(lamp, Vec3::new(1.0, 1.5, -1.0), 3.0, Vec3::splat(3.0)));
        lights.push(Light::area(lamp.two_sided(), Vec3::new(-1.0, 1.0, 1.5), 2.0, Vec3::ONE));
    }
    LightBuffer::new(gpu, &lights).unwrap()
}

#[test]
fn clusters_show_layers_as_no_culling_does_and_look_ups_that_do_not_ask_are_found() {
    let gpu = common::gpu();
    let mut offset = common::view([70, 44]);
    (offset.viewport.x, offset.viewport.y) = (13, 7);
    let standard = View { depth: assign::DepthMapping::Standard, far_m: Some(12.0), ..view() };
    let orthographic = View {
        projection: assign::Projection::Orthographic {
            min: glam::Vec2::new(-3.0, -2.0),
            max: glam::Vec2::new(3.0, 2.0),
        },
        near_m: 0.0,
        far_m: Some(30.0),
        ..view()
    };
    for (name, view, mode) in [
        ("deferred", view(), Mode::Deferred),
        ("forward", view(), Mode::Forward),
        ("no pre-pass, standard depth", standard, Mode::ForwardNoPrepass),
        ("viewport with an offset", offset, Mode::DeferredIds),
        ("orthographic", orthographic, Mode::Deferred),
        ("oblique", common::oblique([64, 36]), Mode::Deferred),
    ] {
        let lights = lights(&gpu, name == "deferred");
        let mut renderer = renderer(&gpu, &view, &everything_shown());
        let mut show = |strategy: &mut dyn Assignment, exit_weight| {
            let options = LightingOptions { exit_weight, ..LightingOptions::default() };
            draw(&gpu, &mut renderer, &view, &lights, strategy, (mode, options)).unwrap()
        };
        let (reference, _) =
            show(&mut Everything::new(&gpu).unwrap(), LightingOptions::EVALUATE_ALL);
        let mut dense = clusters(&gpu, Bounds::Implicit, Occupancy::Dense);
        let (image, truth) = show(&mut *dense, 0.0);
        let difference = image.difference(&reference).unwrap();
        assert_eq!(difference.differing_channels, 0, "{name}: {difference:?}");
        assert_eq!(truth.missed, 0, "{name}: {truth:?}");
        assert!(truth.contributing > 3_000 && truth.samples > 3_000, "{name}: {truth:?}");
        assert!(truth.listed_per_sample() < 0.8 * f64::from(lights.count()), "{name}: {truth:?}");
        // Told of opaque surfaces only, it loses nothing, because look-ups ask whether their list serves them.
        let sparse = || clusters(&gpu, Bounds::Explicit, Occupancy::Sparse);
        let (image, truth) = show(&mut Blind(sparse()), 0.0);
        let difference = image.difference(&reference).unwrap();
        assert_eq!((difference.differing_channels, truth.missed), (0, 0), "{name}: {truth:?}");
        let trusting = Reworded::new(sparse(), conformance::trusting);
        let (image, truth) = show(&mut Blind(Box::new(trusting)), 0.0);
        assert!(truth.missed > 100, "{name}: {truth:?}");
        let difference = image.difference(&reference).unwrap();
        assert!(difference.differing_channels > 100, "{name}: {difference:?}");
    }
}

/// Every kind of layer changes the image, and none of them makes it dark or infinite.
#[test]
fn every_layer_shows() {
    let gpu = common::gpu();
    let view = view();
    let lights = lights(&gpu, true);
    let all = everything_shown();
    let mean = |image: &HdrImage| {
        let sum: f64 = image.pixels.iter().flatten().map(|v| f64::from(*v)).sum();
        sum / image.pixels.len() as f64
    };
    let sun = Sun { direction: Vec3::NEG_Y, irradiance: Vec3::splat(0.5) };
    let image_of = |layers: &LayerOptions, suns| {
        let mut renderer = renderer(&gpu, &view, layers);
        let mut strategy = Everything::new(&gpu).unwrap();
        let options = LightingOptions { suns, ..LightingOptions::default() };
        let drawn =
            draw(&gpu, &mut renderer, &view, &lights, &mut strategy, (Mode::Deferred, options));
        drawn.unwrap().0
    };
    let none = image_of(&LayerOptions::default(), Suns::default());
    let nothing = LayerOptions::default();
    for (name, layers) in [
        ("sheets", LayerOptions { sheets: true, ..nothing.clone() }),
        ("particles", LayerOptions { particles: all.particles.clone(), ..nothing.clone() }),
        ("fog", LayerOptions { fog_per_m: all.fog_per_m, ..nothing.clone() }),
    ] {
        let image = image_of(&layers, Suns::default());
        let difference = image.difference(&none).unwrap();
        assert!(difference.differing_channels > 1_000, "{name}: {difference:?}");
        assert!(difference.max_abs.is_finite() && mean(&image) > 0.01, "{name}: {}", mean(&image));
    }
    // A sun lights fog everywhere.
    let fog = LayerOptions { fog_per_m: Some(0.15), ..nothing };
    let [dull, sunny] =
        [Suns::default(), Suns::new(&[sun]).unwrap()].map(|suns| image_of(&fog, suns).pixels);
    assert!(dull.iter().zip(&sunny).all(|(dull, sunny)| sunny[0] > dull[0]));
}

/// In a fog whose lights fill it evenly, what it adds and keeps is known: 1 - exp(-density * distance).
#[test]
fn even_fog_follows_beers_law() {
    let gpu = common::gpu();
    let view = view();
    let lights = LightBuffer::new(&gpu, &[]).unwrap();
    let irradiance = 0.8;
    let sun = Sun { direction: Vec3::NEG_Y, irradiance: Vec3::splat(irradiance) };
    let options = LightingOptions { suns: Suns::new(&[sun]).unwrap(), ..Default::default() };
    let [(clear, _), (foggy, samples)] = [None, Some(0.2)].map(|fog_per_m| {
        let mut renderer = renderer(&gpu, &view, &LayerOptions { fog_per_m, ..Default::default() });
        let mut strategy = Everything::new(&gpu).unwrap();
        let mode = (Mode::Deferred, options);
        let (image, _) = draw(&gpu, &mut renderer, &view, &lights, &mut strategy, mode).unwrap();
        (image, probe(&renderer, &strategy, &renderer.frame(&view, &lights)).unwrap())
    });
    let scattered = irradiance / (4.0 * std::f32::consts::PI);
    assert!(samples.pixels.len() > 1_000, "{} pixels", samples.pixels.len());
    for (&pixel, &position) in samples.pixels.iter().zip(&samples.positions) {
        let (clear, foggy) = (clear.pixels[pixel as usize], foggy.pixels[pixel as usize]);
        let position = Vec3::from(position);
        // The fog begins at the near plane, and is interpolated between slices and columns.
        let through = (-0.2 * (position.distance(view.eye()) - view.near_m)).exp();
        for (clear, foggy) in clear.into_iter().zip(foggy) {
            let expected = clear * through + scattered * (1.0 - through);
            assert!((foggy - expected).abs() < 0.03 * expected, "{pixel}: {foggy}, not {expected}");
        }
    }
}

#[test]
fn what_serves_only_opaque_surfaces_refuses_layers() {
    let gpu = common::gpu();
    let view = view();
    let lights = lights(&gpu, false);
    let mut renderer = renderer(&gpu, &view, &everything_shown());
    let explicit = [
        clusters(&gpu, Bounds::Explicit, Occupancy::Dense),
        clusters(&gpu, Bounds::Implicit, Occupancy::Sparse),
        clusters(&gpu, Bounds::Explicit, Occupancy::Sparse),
        Box::new(PerModel::new(&gpu, None, CullSettings::default()).unwrap()),
    ];
    for mut strategy in explicit {
        let id = strategy.id();
        let mode = (Mode::Deferred, LightingOptions::default());
        let error = draw(&gpu, &mut renderer, &view, &lights, &mut *strategy, mode).unwrap_err();
        let error = error.to_string();
        assert!(error.contains(&id) && error.contains("at any depth"), "{error}");
    }
    let (area, suns) = (AreaModel::default(), Suns::default());
    let shadows = ShadowModel::None;
    let error = RasterSpheres::new(&renderer, lights.kinds(), area, Cut::default(), suns, shadows)
        .unwrap_err();
    assert!(error.to_string().contains("layers over the opaque surfaces"), "{error}");
    let options = LightingOptions { compensation: Some(10.0), ..LightingOptions::default() };
    let strategy = Everything::new(&gpu).unwrap();
    let error = Lighting::new(&renderer, &strategy, Mode::Forward, options).unwrap_err();
    assert!(error.to_string().contains("off with fog and particles"), "{error}");
}

#[test]
fn faulty_options_and_other_layers_are_errors() {
    let gpu = common::gpu();
    let view = view();
    let mut plain = Renderer::new(&gpu, &common::showcase(), &view).unwrap();
    let sheets = LayerOptions { sheets: true, ..LayerOptions::default() };
    let error = plain.show_layers(&sheets).unwrap_err().to_string();
    assert!(error.contains("no material of the scene is transparent"), "{error}");
    for fog in [0.0, -1.0, f32::NAN, 2e3] {
        let fog = LayerOptions { fog_per_m: Some(fog), ..LayerOptions::default() };
        let error = plain.show_layers(&fog).unwrap_err().to_string();
        assert!(error.contains("fog is") && error.contains("per metre"), "{error}");
    }
    let mut faulty = everything_shown();
    faulty.particles[3].radius_m = 0.0;
    let error = plain.show_layers(&LayerOptions { sheets: false, ..faulty }).unwrap_err();
    assert!(error.to_string().contains("particle 3"), "{error}");
    // A pass that was made before the layers.
    let lights = lights(&gpu, false);
    let mut renderer = Renderer::new(&gpu, &scene(), &view).unwrap();
    let mut strategy = Everything::new(&gpu).unwrap();
    let options = LightingOptions { kinds: lights.kinds(), ..LightingOptions::default() };
    let lighting = Lighting::new(&renderer, &strategy, Mode::Deferred, options).unwrap();
    renderer.show_layers(&sheets).unwrap();
    renderer.prepare(&view, &lights).unwrap();
    strategy.prepare(&gpu, &renderer.frame(&view, &lights)).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    let recorded = lighting.record(&renderer, &view, &strategy, &mut passes);
    assert!(matches!(recorded, Err(ShadingError::Layers { .. })), "{recorded:?}");
}
