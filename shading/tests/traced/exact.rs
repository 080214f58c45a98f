//! Tests the truth against the model in f64 with exact inputs, by separate code: rays against a
//! plane, the formulas of glTF's appendix B, sums over the emitter.

use std::f64::consts::PI;

use assign::{Emitter, Light, LightShape, Suns, View};
use glam::{DVec2, DVec3, Vec3};
use scenes::{Material, Scene};
use shading::{
    HdrImage, Mode,
    traced::{TracedScene, Transport, TruthSettings, truth_image},
};

use crate::common::{
    self,
    quads::{rasterise, scene_of},
};

const SIZE: [u32; 2] = [32, 24];
const EYE: Vec3 = Vec3::new(0.3, 1.7, 3.1);
const TARGET: Vec3 = Vec3::new(0.1, 0.05, -0.2);
const FOV: f32 = 0.7;

/// A tilted square: its middle and half edges.
const QUAD: [Vec3; 3] =
    [Vec3::new(0.1, 0.0, -0.1), Vec3::new(0.3, 0.1, 1.9), Vec3::new(1.8, 0.35, -0.25)];

fn view() -> View {
    View::look_at(EYE, TARGET, FOV, 0.01, SIZE)
}

fn scene(base_color: Vec3, metallic: f32, roughness: f32) -> Scene {
    let base_color = base_color.extend(1.0);
    scene_of(&[QUAD], Material { base_color, metallic, roughness, ..Material::default() }, vec![])
}

/// The point where a pixel's ray hits the square, and the unit vector to the eye.
fn seen(pixel: usize) -> Option<(DVec3, DVec3)> {
    let (eye, target) = (EYE.as_dvec3(), TARGET.as_dvec3());
    let forward = (target - eye).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let up = right.cross(forward);
    let [width, height] = SIZE.map(f64::from);
    let at = DVec2::new((pixel % SIZE[0] as usize) as f64, (pixel / SIZE[0] as usize) as f64) + 0.5;
    let top = (f64::from(FOV) / 2.0).tan();
    let x = (2.0 * at.x / width - 1.0) * top * width / height;
    let direction = (forward + right * x + up * (1.0 - 2.0 * at.y / height) * top).normalize();
    let [center, x, y] = QUAD.map(Vec3::as_dvec3);
    let normal = x.cross(y);
    let distance = normal.dot(center - eye) / normal.dot(direction);
    let point = eye + direction * distance;
    let along = |a: DVec3, b: DVec3| (point - center).cross(b).dot(normal) / a.cross(b).dot(normal);
    let inside = along(x, y).abs() < 0.98 && along(y, x).abs() < 0.98;
    (distance > 0.0 && inside).then_some((point, -direction))
}

/// The lit surface, in f64.
struct Model {
    base_color: DVec3,
    metallic: f64,
    roughness: f64,
    normal: DVec3,
}

impl Model {
    fn new(scene: &Scene) -> Self {
        let material = &scene.materials[0];
        let [_, x, y] = QUAD.map(Vec3::as_dvec3);
        Self {
            base_color: material.base_color.truncate().as_dvec3(),
            metallic: material.metallic.into(),
            roughness: material.roughness.into(),
            normal: x.cross(y).normalize(),
        }
    }

    /// The BRDF times the cosine of incidence.
    fn reflected(&self, v: DVec3, l: DVec3) -> DVec3 {
        let n = self.normal;
        let (n_l, n_v) = (n.dot(l), n.dot(v));
        if n_l <= 0.0 || n_v <= 0.0 {
            return DVec3::ZERO;
        }
        let h = (v + l).normalize();
        let alpha_2 = self.roughness.powi(4);
        let sine_2 = n.cross(h).length_squared();
        let d = alpha_2 / (PI * (alpha_2 * (1.0 - sine_2) + sine_2).powi(2));
        let lambda = |cos: f64| (alpha_2 + (1.0 - alpha_2) * cos * cos).sqrt();
        let visible = 0.5 / (n_l * lambda(n_v) + n_v * lambda(n_l));
        let f0 = DVec3::splat(0.04) * (1.0 - self.metallic) + self.base_color * self.metallic;
        let fresnel = f0 + (1.0 - f0) * (1.0 - v.dot(h)).powi(5);
        let diffuse = (1.0 - fresnel) * self.base_color * (1.0 - self.metallic) / PI;
        (diffuse + d * visible * fresnel) * n_l
    }

    fn window(distance: f64, range_m: f32) -> f64 {
        (1.0 - (distance / f64::from(range_m)).powi(4)).max(0.0).powi(2)
    }

    /// Radiance of a light to the eye.
    fn lit(&self, light: &Light, point: DVec3, v: DVec3) -> DVec3 {
        let intensity = light.intensity.as_dvec3();
        let offset = light.position.as_dvec3() - point;
        let (distance, l) = (offset.length(), offset.normalize());
        match &light.shape {
            LightShape::Area(emitter) => {
                // The closest point comes from the cells, too.
                let (mut sum, mut closest) = (DVec3::ZERO, f64::INFINITY);
                let steps = if self.roughness < 0.2 { 400 } else { 120 };
                let vertices: Vec<DVec3> =
                    emitter.vertices().iter().map(|vertex| vertex.as_dvec3() + offset).collect();
                for pair in vertices[1..].windows(2) {
                    let [x, y] = [pair[0] - vertices[0], pair[1] - vertices[0]];
                    let normal = x.cross(y);
                    let area = 0.5 * normal.length() / f64::from(steps * steps);
                    for_cells(steps, |s, t| {
                        let to = vertices[0] + x * s + y * t;
                        let distance_2 = to.length_squared();
                        closest = closest.min(distance_2);
                        let cos = -normal.dot(to) / (normal.length() * distance_2.sqrt());
                        let share = area * cos.max(0.0) / distance_2;
                        sum += self.reflected(v, to / distance_2.sqrt()) * share;
                    });
                }
                let area = f64::from(emitter.area());
                intensity / area * sum * Self::window(closest.sqrt(), light.range_m)
            }
            LightShape::Spot { direction, inner_angle, outer_angle } => {
                let [inner, outer] =
                    [inner_angle, outer_angle].map(|angle| f64::from(*angle).cos());
                let cos = -direction.as_dvec3().normalize().dot(l);
                let ramp = ((cos - outer) / (inner - outer)).clamp(0.0, 1.0).powi(2);
                let weight = ramp / (distance * distance) * Self::window(distance, light.range_m);
                intensity * weight * self.reflected(v, l)
            }
            _ => {
                let weight = Self::window(distance, light.range_m) / (distance * distance);
                intensity * weight * self.reflected(v, l)
            }
        }
    }
}

/// Middles of the cells of a triangle that is cut into `steps` squared equal cells, as shares of
/// its two edges.
fn for_cells(steps: u32, mut cell: impl FnMut(f64, f64)) {
    let side = f64::from(steps);
    for i in 0..steps {
        for j in 0..steps - i {
            let (s, t) = (f64::from(i), f64::from(j));
            cell((s + 1.0 / 3.0) / side, (t + 1.0 / 3.0) / side);
            if i + j + 1 < steps {
                cell((s + 2.0 / 3.0) / side, (t + 2.0 / 3.0) / side);
            }
        }
    }
}

/// A point, a spot, a rectangle and a polygon.
fn lights() -> [(&'static str, Light); 4] {
    let color = Vec3::new(20.0, 12.0, 6.0);
    let position = Vec3::new(-0.4, 2.1, -1.9);
    let towards = Vec3::new(0.1, 0.0, -0.1) - position;
    let direction = towards.normalize();
    let spot = LightShape::Spot { direction, inner_angle: 0.3, outer_angle: 0.6 };
    let x = Vec3::new(0.5, 0.1, 0.05);
    // It faces the square: counter-clockwise seen from it.
    let y = towards.cross(x).normalize() * 0.3;
    let corners = [(-1.0, -0.8), (0.6, -1.0), (1.1, 0.1), (0.1, 1.2), (-0.9, 0.5)];
    let corners = corners.map(|(s, t): (f32, f32)| position + x * s + y * t);
    let (polygon, middle) = Emitter::polygon(&corners).unwrap();
    [
        ("point", Light::point(position, 1e3, color)),
        ("spot", Light { shape: spot, ..Light::point(position, 30.0, color) }),
        ("rectangle", Light::area(Emitter::rectangle(x, y), position, 30.0, color)),
        ("polygon", Light::area(polygon, middle, 1e8, color)),
    ]
}

/// The error of an image: relMSE as in the table of metrics, and the worst of the bright pixels.
struct Off {
    rel_mse: f64,
    highlight: f64,
}

fn off(pairs: &[(DVec3, DVec3)]) -> Off {
    let count = 3.0 * pairs.len() as f64;
    let mean = pairs.iter().map(|(_, expected)| expected.element_sum()).sum::<f64>() / count;
    let brightest = pairs.iter().map(|(_, e)| e.max_element()).fold(0.0, f64::max);
    let mut off = Off { rel_mse: 0.0, highlight: 0.0 };
    for (found, expected) in pairs {
        for (found, expected) in found.to_array().into_iter().zip(expected.to_array()) {
            let floor = (0.1 * mean).powi(2);
            off.rel_mse += (found - expected).powi(2) / (expected.powi(2) + floor) / count;
            if expected > 0.05 * brightest {
                off.highlight = off.highlight.max((found / expected - 1.0).abs());
            }
        }
    }
    off
}

/// Pixels at which images are compared. For lights without area, all of them. Otherwise the
/// brightest ones, where the lobe is narrow, and some of the others.
fn compared(image: &HdrImage, light: &Light) -> Vec<usize> {
    let mut pixels: Vec<usize> = (0..image.pixels.len()).filter(|p| seen(*p).is_some()).collect();
    if matches!(light.shape, LightShape::Area(_)) {
        pixels.sort_by(|a, b| image.pixels[*b][0].total_cmp(&image.pixels[*a][0]));
        let others = pixels.iter().skip(4).step_by(97).copied();
        pixels = pixels[..4].iter().copied().chain(others).collect();
    }
    pixels
}

fn pairs(image: &HdrImage, scene: &Scene, light: &Light) -> Vec<(DVec3, DVec3)> {
    let model = Model::new(scene);
    let found = |pixel: usize| Vec3::from(image.pixels[pixel]).as_dvec3();
    let pair = |pixel: usize| {
        let (point, to_eye) = seen(pixel)?;
        Some((found(pixel), model.lit(light, point, to_eye)))
    };
    compared(image, light).into_iter().filter_map(pair).collect()
}

fn truth(scene: &Scene, light: &Light) -> HdrImage {
    let traced = TracedScene::new(scene);
    let view = view();
    let sample_of =
        |pixel: usize| traced.primary(&view, [pixel as u32 % SIZE[0], pixel as u32 / SIZE[0]]);
    let settings = TruthSettings::new(Transport::Unshadowed);
    truth_image(&traced, &[*light], SIZE, sample_of, settings, &|_, _| ()).radiance
}

const COLORED: Vec3 = Vec3::new(0.9, 0.3, 0.02);

#[test]
fn the_truth_matches_the_model_on_exact_inputs() {
    for (base_color, metallic) in [(Vec3::ONE, 0.0), (COLORED, 0.0), (COLORED, 1.0)] {
        for roughness in [0.05, 0.3, 1.0] {
            let scene = scene(base_color, metallic, roughness);
            for (name, light) in lights() {
                let pairs = pairs(&truth(&scene, &light), &scene, &light);
                let off = off(&pairs);
                let what = format!("{name}, {base_color}, {metallic}, {roughness}");
                println!("{what}: {:.1e}, {:.1e}", off.rel_mse, off.highlight);
                assert!(pairs.len() > 9 && off.rel_mse < 1e-6, "{what}: {}", off.rel_mse);
                assert!(off.highlight < 5e-3, "{what}: {}", off.highlight);
            }
        }
    }
}

#[test]
fn forward_shading_keeps_its_digits_in_a_highlight_and_the_g_buffer_does_not() {
    let gpu = common::gpu();
    let scene = scene(Vec3::ONE, 1.0, 0.05);
    let (_, light) = lights()[0];
    let [forward, deferred] = [Mode::Forward, Mode::Deferred].map(|mode| {
        let (_, image) = rasterise(&gpu, &scene, &view(), &[light], Suns::default(), mode);
        off(&pairs(&image, &scene, &light))
    });
    println!("forward {:.1e}, deferred {:.1e}", forward.highlight, deferred.highlight);
    assert!(forward.highlight < 1e-3, "{}", forward.highlight);
    // The control: a truth lit from the G-buffer would fail.
    assert!(deferred.highlight > 50.0 * forward.highlight, "{}", deferred.highlight);
}
