//! Tests the counts of light operations against f64, for a few lights over a floor: listed,
//! evaluated and perceptible terms.

#![allow(dead_code, reason = "the common module serves several tests")]
#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]
mod common;

use assign::{
    Assignment, Bounds, CullSettings, ENTRY_DIFFUSE, ENTRY_LIGHT, ENTRY_SPECULAR, Emitter,
    EncoderPasses, Everything, Gpu, Light, LightBuffer, LightShape, View,
};
use assign_clustered::{ClusterOptions, Clustered, Normals, Occupancy, SpecularCut};
use glam::{DVec3, Vec3};
use scenes::{Instance, Scene};
use shading::{
    HdrImage, Lighting, LightingOptions, Mode, Operations, Renderer, Samples, Terms,
    count_operations, ltc, probe, record_before_lighting,
    reference::{Surface, ltc_contribution},
};

const SIZE: [u32; 2] = [48, 32];
/// The factor from radiance to the display's scale. 0.005 on that scale is a radiance of 8.7e-5,
/// within the range of the lights.
const EXPOSURE: f32 = 0.1;
const ROUGHNESS: f32 = 0.5;
/// Closer than this to an edge or a threshold, f32 may decide differently.
const DOUBT: f64 = 1e-3;

/// A floor of one material.
fn floor() -> Scene {
    let mut scene = common::showcase();
    scene.instances = vec![Instance { mesh: 0, model: 0 }];
    scene.materials[0].roughness = ROUGHNESS;
    scene
}

/// A lamp that faces the floor and whose diffuse light ends early, a triangle that the floor cuts,
/// a lamp that faces away, a point and a spot.
fn lights() -> Vec<Light> {
    let down = Emitter::rectangle(0.6 * Vec3::X, 0.3 * Vec3::Z).with_diffuse_share(0.6);
    let corners =
        [Vec3::new(1.0, -0.5, -1.0), Vec3::new(2.0, -0.4, -1.2), Vec3::new(1.5, 0.9, -1.1)];
    let (triangle, middle) = Emitter::polygon(&corners).unwrap();
    let up = Emitter::rectangle(0.5 * Vec3::Z, 0.5 * Vec3::X);
    let spot = LightShape::Spot {
        direction: Vec3::new(0.2, -1.0, 0.1).normalize(),
        inner_angle: 0.2,
        outer_angle: 0.6,
    };
    let point = Light::point(Vec3::new(1.0, 0.5, 1.0), 1.5, Vec3::new(0.02, 0.05, 0.01));
    vec![
        Light::area(down, Vec3::new(-1.0, 1.0, 0.0), 2.5, Vec3::new(0.3, 0.2, 0.1)),
        Light::area(triangle.two_sided().with_diffuse_share(0.5), middle, 2.0, Vec3::splat(0.4)),
        Light::area(up, Vec3::new(0.0, 0.6, -2.0), 3.0, Vec3::ONE),
        point,
        Light { position: Vec3::new(-2.0, 1.5, -1.0), range_m: 2.5, shape: spot, ..point },
    ]
}

/// One strategy's lists for the floor's lights, and the GPU's counts.
struct Counted {
    operations: Operations,
    /// The entries of each sample's list.
    lists: Vec<Vec<u32>>,
    samples: Samples,
    image: HdrImage,
}

fn count(gpu: &Gpu, all: &[Light], strategy: &mut dyn Assignment, exit_weight: f32) -> Counted {
    let view = common::view(SIZE);
    let lights = LightBuffer::new(gpu, all).unwrap();
    assert!(lights.rejected().is_empty());
    let mut renderer = Renderer::new(gpu, &floor(), &view).unwrap();
    renderer.prepare(&view, &lights).unwrap();
    let options = LightingOptions { kinds: lights.kinds(), exit_weight, ..Default::default() };
    let frame = renderer.frame(&view, &lights);
    strategy.prepare(gpu, &frame).unwrap();
    let lighting = Lighting::new(&renderer, strategy, Mode::Deferred, options).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let mut passes = EncoderPasses { encoder: &mut encoder };
    record_before_lighting(&renderer, Mode::Deferred, strategy, &frame, &mut passes);
    lighting.record(&renderer, &view, strategy, &mut passes).unwrap();
    gpu.queue.submit([encoder.finish()]);
    let image = HdrImage::read(gpu, renderer.targets(), view.viewport).unwrap();
    let operations = count_operations(&renderer, strategy, &frame, options, EXPOSURE).unwrap();
    let samples = probe(&renderer, strategy, &frame).unwrap();
    let snapshot = strategy.lists().snapshot(gpu).unwrap();
    let every = |ix: usize| ix as u32 | ENTRY_DIFFUSE | ENTRY_SPECULAR;
    let list_of = |&group: &u32| match snapshot.entries_of(group) {
        Some(entries) if group != assign::ALL_LIGHTS => entries.to_vec(),
        _ => (0..all.len()).map(every).collect(),
    };
    let lists = samples.groups.iter().map(list_of).collect();
    Counted { operations, lists, samples, image }
}

/// The luminance of a colourless radiance on a display of gamma 2.2.
fn shown(radiance: f64) -> f64 {
    (radiance * f64::from(EXPOSURE)).max(0.0).powf(1.0 / 2.2)
}

/// The two terms of a colourless light on a white dielectric.
fn white_terms(
    table: &ltc::Table,
    light: &Light,
    position: DVec3,
    normal: DVec3,
    eye: DVec3,
) -> [f64; 2] {
    let white = Light { intensity: Vec3::splat(light.intensity.max_element()), ..*light };
    let radiance = |base_color: f64, metallic: f64| {
        let roughness = f64::from(ROUGHNESS);
        let base_color = DVec3::splat(base_color);
        let dielectric = Default::default();
        let surface = Surface { base_color, metallic, normal, roughness, dielectric };
        ltc_contribution(table, &white, position, &surface, (eye - position).normalize()).x
    };
    // A metal with a dielectric's reflectance has only the specular term.
    let specular = radiance(0.04, 1.0);
    [radiance(1.0, 0.0) - specular, specular]
}

/// The number of perceptible terms by appendix I of the paper, if only the named terms exist.
fn perceptible([diffuse, specular]: [f64; 2]) -> u64 {
    match (shown(diffuse) > 0.005, shown(specular) > 0.005) {
        (true, true) if shown(diffuse + specular) > 0.01 => 2,
        (true, true) | (false, false) => 0,
        _ => 1,
    }
}

/// The numbers of terms that are too close to call.
#[derive(Clone, Copy, Debug, Default)]
struct Doubts {
    /// Because of where light ends.
    reach: u64,
    /// Because of that, or of the visibility of a light.
    seen: u64,
    /// The same for entries that name only one term.
    cut: u64,
}

/// The same counts in f64, and the numbers of terms that are too close to call.
fn expected(lights: &[Light], counted: &Counted, view: &View, exits: bool) -> (Operations, Doubts) {
    let table = ltc::Table::ggx().unwrap();
    let (mut sum, mut doubts) = (Operations::default(), Doubts::default());
    let add = |terms: &mut Terms, [diffuse, specular]: [bool; 2], is_outer: bool| {
        terms.diffuse += u64::from(diffuse);
        terms.specular += u64::from(specular);
        terms.outer_specular += u64::from(specular && is_outer);
    };
    for (ix, list) in counted.lists.iter().enumerate() {
        let position = Vec3::from(counted.samples.positions[ix]).as_dvec3();
        let normal = Vec3::from(counted.samples.normals[ix]).as_dvec3().normalize();
        for entry in list {
            let light = &lights[(entry & ENTRY_LIGHT) as usize];
            let named = [entry & ENTRY_DIFFUSE != 0, entry & ENTRY_SPECULAR != 0];
            let reach = light.reach(position);
            let rise = light.above_horizon(position, normal);
            let diffuse_reach = light.diffuse_reach(position);
            let is_outer = match &light.shape {
                LightShape::Area(emitter) => {
                    let offset = position - light.position.as_dvec3();
                    offset.distance(emitter.closest(offset)) >= f64::from(light.diffuse_range_m())
                }
                _ => false,
            };
            let is_lit = reach > 0.0 && rise > 0.0;
            let drawn = [is_lit && diffuse_reach > 0.0, is_lit];
            let evaluated = [0, 1].map(|term| named[term] && (!exits || drawn[term]));
            add(&mut sum.listed, named, is_outer);
            add(&mut sum.evaluated, evaluated, is_outer);
            let white = white_terms(&table, light, position, normal, view.eye().as_dvec3());
            let only = |named: [bool; 2]| [0, 1].map(|ix| if named[ix] { white[ix] } else { 0.0 });
            sum.perceptible += perceptible(only(named));
            sum.perceptible_of_lights += perceptible(white);
            let [diffuse, specular] = white;
            let near =
                |radiance: f64, threshold: f64| (shown(radiance) / threshold - 1.0).abs() < 0.02;
            let is_at_end = [reach, rise, diffuse_reach].iter().any(|d| d.abs() < DOUBT);
            let is_doubtful = is_at_end
                || near(diffuse, 0.005)
                || near(specular, 0.005)
                || near(diffuse + specular, 0.01);
            doubts.reach += 2 * u64::from(is_at_end);
            doubts.seen += 2 * u64::from(is_doubtful);
            doubts.cut += 2 * u64::from(is_doubtful && named != [true, true]);
        }
    }
    (sum, doubts)
}

/// Perceptible terms that no list names.
fn lost(all: &Operations) -> i64 {
    all.perceptible_of_lights as i64 - all.perceptible as i64
}

/// All counts by name, each with the number of terms that are too close to call.
fn figures(all: &Operations, doubts: Doubts) -> [(&'static str, i64, u64); 9] {
    let figure = |name, count: u64, doubt| (name, count as i64, doubt);
    [
        // Lists are the same in both.
        figure("listed diffuse", all.listed.diffuse, 0),
        figure("listed specular", all.listed.specular, 0),
        figure("listed outer specular", all.listed.outer_specular, doubts.reach),
        figure("evaluated diffuse", all.evaluated.diffuse, doubts.reach),
        figure("evaluated specular", all.evaluated.specular, doubts.reach),
        figure("evaluated outer specular", all.evaluated.outer_specular, doubts.reach),
        figure("perceptible", all.perceptible, doubts.seen),
        figure("perceptible of lights", all.perceptible_of_lights, doubts.seen),
        ("lost", lost(all), doubts.cut),
    ]
}

/// Asserts that the GPU's counts equal those of f64, up to the terms that are too close to call.
fn check(name: &str, counted: &Counted, exits: bool) -> (Operations, Doubts) {
    let (truth, doubts) = expected(&lights(), counted, &common::view(SIZE), exits);
    println!("{name}: {:?}, f64 {truth:?}, {doubts:?}", counted.operations);
    assert!(doubts.seen * 20 < truth.listed.specular, "{name}: {doubts:?} of {truth:?}");
    let pairs = figures(&counted.operations, doubts).into_iter().zip(figures(&truth, doubts));
    for ((figure, ours, doubt), (_, theirs, _)) in pairs {
        let off = ours.abs_diff(theirs);
        assert!(off <= doubt, "{name}, {figure}: {ours}, f64 {theirs}, {doubt} doubtful");
    }
    (truth, doubts)
}

fn clusters(gpu: &Gpu, cut: SpecularCut) -> Clustered {
    let (size, settings) = ("16x16x8".parse().unwrap(), CullSettings::default());
    let plain = ClusterOptions::new(size, Bounds::Explicit, Occupancy::Sparse, settings);
    let options = ClusterOptions { normals: Normals::Bins(6), cut, ..plain };
    Clustered::with_options(gpu, options).unwrap()
}

#[test]
fn operation_counts_match_f64() {
    let gpu = common::gpu();
    let all = lights();
    let mut none = Everything::new(&gpu).unwrap();
    let counted = count(&gpu, &all, &mut none, LightingOptions::EVALUATE_ALL);
    let (truth, doubts) = check("no culling", &counted, false);
    assert_eq!(counted.operations.listed, counted.operations.evaluated, "all are evaluated");
    // The count exceeds the doubtful terms, so a count of zero fails.
    assert!(truth.perceptible > doubts.seen, "{truth:?}, {doubts:?}");
    assert!(truth.listed.outer_specular > doubts.reach, "{truth:?}, {doubts:?}");

    let counted = count(&gpu, &all, &mut none, 0.0);
    let (truth, doubts) = check("no culling, early exit", &counted, true);
    // Far fewer are evaluated, so counting listed terms would fail here.
    assert!(2 * truth.evaluated.specular < truth.listed.specular, "{truth:?}");
    assert!(truth.evaluated.outer_specular > doubts.reach, "{truth:?}, {doubts:?}");

    let mut lossless = clusters(&gpu, SpecularCut::None);
    check("clusters", &count(&gpu, &all, &mut lossless, 0.0), true);

    let mut cut = clusters(&gpu, SpecularCut::Below(5.0));
    let counted = count(&gpu, &all, &mut cut, 0.0);
    let (truth, doubts) = check("clusters, cut", &counted, true);
    // The cut removes visible terms, so a count that ignores the list's flags would fail here.
    let lost = lost(&truth);
    assert!(lost > 20 && lost > doubts.cut as i64, "{lost} are lost: {truth:?}, {doubts:?}");
}

/// One light must light exactly the pixels at which a term is counted as evaluated. Its diffuse
/// light reaches as far as the specular one, whose lobe may be exactly 0.
#[test]
fn a_pixel_is_lit_exactly_where_a_term_is_evaluated() {
    let gpu = common::gpu();
    for mut light in lights() {
        if let LightShape::Area(emitter) = &mut light.shape {
            *emitter = emitter.with_diffuse_share(1.0);
        }
        let mut none = Everything::new(&gpu).unwrap();
        let counted = count(&gpu, &[light], &mut none, 0.0);
        let lit =
            counted.image.pixels.iter().filter(|pixel| pixel.iter().any(|c| *c > 0.0)).count();
        assert_eq!(counted.operations.evaluated.specular, lit as u64, "{light:?}");
        let seen = counted.samples.positions.len() as u64;
        assert_eq!(counted.operations.listed.specular, seen, "{light:?}");
    }
}
