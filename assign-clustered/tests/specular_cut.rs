//! Each cut takes only the specular flag, and only from the area lights that it is meant for: those too dim over a
//! group, by the bound's twin in Rust; those that no normal mirrors to the eye; those whose diffuse term does not
//! reach the group.

#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use assign::{
    Assignment, Bounds, CullSettings, ENTRY_DIFFUSE, ENTRY_LIGHT, ENTRY_SPECULAR, Emitter,
    EncoderPasses, Frame, Gpu, Light, LightBuffer, LightShape, View,
    conformance::{flat_depth, flat_half_floats},
    intersect::{Aabb, Gloss, LightVolume, MirrorGroup, NormalCone, SeenGroup},
};
use assign_clustered::{
    ClusterOptions, Clustered, Normals, Occupancy, PAPERS_LOBE_DEGREES, SpecularCut,
};
use glam::Vec3;

const SIZE: [u32; 2] = [64, 48];
const BOTH: u32 = ENTRY_DIFFUSE | ENTRY_SPECULAR;

fn gpu() -> Gpu {
    Gpu::open(None).unwrap_or_else(|e| panic!("this test runs shaders: {e}"))
}

/// The eye is two metres in front of a white wall of roughness 1 in the plane z = 0.
fn view() -> View {
    View::look_at(Vec3::new(0.0, 0.0, 2.0), Vec3::ZERO, 1.0, 0.1, SIZE)
}

/// The box around the wall's samples.
fn wall(view: &View) -> Aabb {
    let half = 2.0 * 0.5_f32.tan();
    let [width, height] = SIZE.map(|pixels| pixels as f32);
    let x = half * width / height * (1.0 - 1.0 / width);
    let corner = Vec3::new(x, half * (1.0 - 1.0 / height), 0.0);
    Aabb::new(view, -corner, corner)
}

/// An image of one colour in half floats. Components must be 0 or 1.
fn flat(gpu: &Gpu, texel: [f32; 4]) -> wgpu::TextureView {
    let bits = texel.map(|x| if x == 0.0 { 0_u16 } else { 0x3c00 });
    flat_half_floats(gpu, SIZE, bits)
}

/// For each light, the flags with which any group lists it.
fn flags(gpu: &Gpu, lights: &[Light], normals: Normals, cut: SpecularCut) -> Vec<u32> {
    let view = view();
    // A clip depth of near / 2.
    let depth = flat_depth(gpu, SIZE, 0.05);
    let normal_image = flat(gpu, [0.0, 0.0, 1.0, 1.0]);
    let base_color = flat(gpu, [1.0, 1.0, 1.0, 0.0]);
    let buffer = LightBuffer::new(gpu, lights).unwrap();
    assert!(buffer.rejected().is_empty());
    // One tile; the wall lies in one of its slices.
    let (size, settings) = ("64x64x8".parse().unwrap(), CullSettings::default());
    let plain = ClusterOptions::new(size, Bounds::Explicit, Occupancy::Sparse, settings);
    let options = ClusterOptions { normals, cut, ..plain };
    let mut strategy = Clustered::with_options(gpu, options).unwrap();
    let frame = Frame::new(&view, &buffer)
        .with_depth(&depth)
        .with_normals(&normal_image)
        .with_base_color(&base_color);
    strategy.prepare(gpu, &frame).unwrap();
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    strategy.record(&frame, &mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    let lists = strategy.lists().snapshot(gpu).unwrap();
    let mut flags = vec![0; lights.len()];
    for group in 0..strategy.lists().group_count() {
        // Groups without samples have the list of all lights.
        if lists.is_all_lights(group) {
            continue;
        }
        for entry in lists.entries_of(group).unwrap() {
            flags[(entry & ENTRY_LIGHT) as usize] |= entry & !ENTRY_LIGHT;
        }
    }
    flags
}

fn below(threshold: f32) -> SpecularCut {
    if threshold > 0.0 { SpecularCut::Below(threshold) } else { SpecularCut::None }
}

#[test]
fn dim_area_lights_lose_their_specular_flag() {
    let gpu = gpu();
    let emitter = |share: f32| Emitter::rectangle(Vec3::X, Vec3::NEG_Y).with_diffuse_share(share);
    let position = Vec3::new(0.0, 0.0, 3.0);
    let lights = [
        Light::point(position, 20.0, Vec3::ONE),
        Light::area(emitter(1.0), position, 20.0, Vec3::ONE),
        // Its diffuse light ends in front of the wall.
        Light::area(emitter(0.05), position, 20.0, Vec3::ONE),
    ];
    for bins in [1, 6] {
        let flags = |threshold| flags(&gpu, &lights, Normals::Bins(bins), below(threshold));
        assert_eq!(flags(0.0), [BOTH, BOTH, ENTRY_SPECULAR], "lossless");
        assert_eq!(
            flags(1e-9),
            [BOTH, BOTH, ENTRY_SPECULAR],
            "lights brighter than the threshold keep their flags"
        );
        // The light's own radiance is 1/4, and roughness 1 reflects a small part of it.
        assert_eq!(
            flags(10.0),
            [BOTH, ENTRY_DIFFUSE, 0],
            "lights dimmer than the threshold lose the specular flag"
        );
    }
}

/// Area lights in front of the wall and to its side, near and far, bright and dim, and two tubes of 100 : 1.
fn lamps() -> Vec<Light> {
    let square = Emitter::rectangle(0.3 * Vec3::X, 0.3 * Vec3::NEG_Y);
    let tube = Emitter::rectangle(8.0 * Vec3::X, 0.08 * Vec3::NEG_Y);
    let lamp = |emitter, x: f32, y: f32, z: f32, intensity: f32| {
        Light::area(emitter, Vec3::new(x, y, z), 40.0, Vec3::splat(intensity))
    };
    vec![
        lamp(square, 0.0, 0.0, 3.0, 1.0),
        lamp(square, 0.0, 0.0, 9.0, 1.0),
        lamp(square, 12.0, 1.0, 4.0, 1.0),
        lamp(square.two_sided(), 9.0, 0.0, 0.5, 0.2),
        lamp(square, -6.0, 2.0, 6.0, 0.01),
        lamp(tube, 0.0, 0.0, 6.0, 1.0),
        lamp(tube, 0.0, 12.0, 4.0, 0.05),
    ]
}

/// The lights' bounds over the wall by their twin in Rust, for a wall of this roughness.
fn bounds_of(lights: &[Light], roughness: f32) -> Vec<f32> {
    let view = view();
    // The slacks of `normal_bins.wesl` and of `clusters.wesl`.
    let cone = NormalCone::of_box(Vec3::Z, Vec3::Z).widened(2e-3);
    let roughness = [0.999 * roughness, 1.001 * roughness];
    let seen = SeenGroup::new(&view, wall(&view), &cone, Gloss { roughness, f0: 0.05 });
    lights.iter().map(|light| seen.specular_bound(light)).collect()
}

/// At a threshold between two lights' bounds, exactly the lights below it lose the flag.
#[test]
fn lights_are_cut_one_by_one_as_the_threshold_rises() {
    let gpu = gpu();
    let lights = lamps();
    let bounds = bounds_of(&lights, 1.0);
    let mut sorted = bounds.clone();
    sorted.sort_by(f32::total_cmp);
    let between = |pair: &[f32]| (pair[1] > 1.1 * pair[0]).then(|| (pair[0] * pair[1]).sqrt());
    let thresholds: Vec<f32> = sorted.windows(2).filter_map(between).collect();
    assert!(thresholds.len() >= 4, "some kept and some cut: {sorted:?}");
    let expected = |bounds: &[f32], threshold: f32| -> Vec<u32> {
        bounds.iter().map(|bound| if *bound < threshold { ENTRY_DIFFUSE } else { BOTH }).collect()
    };
    // Negative control: with the bounds of a smoother wall, other lights lose the flag.
    let smoother = bounds_of(&lights, 0.5);
    let mut differing = 0;
    for bins in [1, 54] {
        for &threshold in &thresholds {
            let found = flags(&gpu, &lights, Normals::Bins(bins), below(threshold));
            assert_eq!(found, expected(&bounds, threshold), "{bins} bins, {threshold}: {bounds:?}");
            differing += usize::from(found != expected(&smoother, threshold));
        }
    }
    assert!(differing > 0, "bounds {bounds:?}, of a smoother wall {smoother:?}");
}

/// A tube of 100 : 1 above a group is cut. The group is inside the ball around the tube, so the bound by that ball
/// would be that of light from all directions.
#[test]
fn a_long_tube_is_cut() {
    let gpu = gpu();
    let lights = [lamps()[5], lamps()[6]];
    let bounds = bounds_of(&lights, 1.0);
    let from_everywhere = |light: &Light| {
        let LightShape::Area(emitter) = &light.shape else { panic!("an area light") };
        // Solid angle 2 pi, D of alpha 1, no less than F0; V cos is 0.5 at least.
        light.intensity.x / emitter.area() * 2.0 * 0.5 * 0.05
    };
    for (light, bound) in lights.iter().zip(&bounds) {
        assert!(4.0 * bound < from_everywhere(light), "{bound}, {}", from_everywhere(light));
        let cut = below(2.0 * bound);
        assert_eq!(flags(&gpu, &[*light], Normals::Bins(6), cut), [ENTRY_DIFFUSE]);
        let kept = below(0.5 * bound);
        assert_eq!(flags(&gpu, &[*light], Normals::Bins(6), kept), [BOTH]);
    }
}

/// Swarbrick's cone test and his `dif`: only lights whose diffuse term does not reach lose the flag.
#[test]
fn the_papers_cuts_leave_out_what_the_paper_does() {
    let gpu = gpu();
    let view = view();
    let lamp = |x: f32, z: f32, share: f32| {
        let square = Emitter::rectangle(0.3 * Vec3::X, 0.3 * Vec3::NEG_Y).two_sided();
        Light::area(square.with_diffuse_share(share), Vec3::new(x, 0.0, z), 40.0, Vec3::ONE)
    };
    // Places whose mirror direction is 0, 63, 90, 108 and 174 degrees off the eye.
    let places = [(0.0, 5.0), (6.0, 3.0), (8.0, 0.0), (9.0, -3.0), (0.3, -3.0)];
    let outer: Vec<Light> = places.iter().map(|&(x, z)| lamp(x, z, 0.01)).collect();
    let inner: Vec<Light> = places.iter().map(|&(x, z)| lamp(x, z, 1.0)).collect();
    let half_angles = [(6, 54.736_f32), (54, 25.239)];
    let mut rejected = Vec::new();
    for (bins, half_angle) in half_angles {
        let cut = SpecularCut::ReflectedCone(PAPERS_LOBE_DEGREES);
        let (half_angle, lobe) = (half_angle.to_radians(), PAPERS_LOBE_DEGREES.to_radians());
        let group = MirrorGroup::new(&view, &wall(&view), Vec3::Z, half_angle, lobe);
        let mirrors = |light: &Light| group.mirrors(&LightVolume::from(light));
        let expected: Vec<u32> =
            outer.iter().map(|light| if mirrors(light) { ENTRY_SPECULAR } else { 0 }).collect();
        assert_eq!(flags(&gpu, &outer, Normals::Bins(bins), cut), expected, "{bins} bins");
        rejected.push(expected.iter().filter(|flags| **flags == 0).count());
        // Lights behind the wall are kept too: the paper tests no horizon.
        assert_eq!(flags(&gpu, &inner, Normals::Bins(bins), cut), [BOTH; 5], "{bins} bins");
    }
    assert_eq!(rejected, [1, 2], "rejected: lights beyond 154 and beyond 95 degrees");
    let dif = |lights: &[Light]| flags(&gpu, lights, Normals::None, SpecularCut::WhereDiffuse);
    assert_eq!((dif(&outer), dif(&inner)), (vec![0; 5], vec![BOTH; 5]));
    let all = flags(&gpu, &outer, Normals::None, SpecularCut::None);
    assert_eq!(all, [ENTRY_SPECULAR; 5], "without a cut all lights reach the wall");
}
