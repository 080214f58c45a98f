//! A case's stage: a view, surfaces traced on the CPU, and view samples.

use glam::{DMat4, DVec2, DVec3, Mat3, Vec3};

use crate::{DepthMapping, ModelBox, Projection, View};

/// A seeded stream of random numbers (SplitMix64), the same on every platform.
#[derive(Debug)]
pub(super) struct Rng(u64);

impl Rng {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// A number uniform between `low` and `high`.
    pub(super) fn range(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * (self.next() >> 11) as f64 / (1u64 << 53) as f64
    }

    /// A number whose logarithm is uniform.
    pub(super) fn log_range(&mut self, low: f64, high: f64) -> f64 {
        self.range(low.ln(), high.ln()).exp()
    }

    /// An index below `count`.
    pub(super) fn below(&mut self, count: usize) -> usize {
        (self.next() % count.max(1) as u64) as usize
    }

    /// A direction uniform on the sphere.
    pub(super) fn direction(&mut self) -> DVec3 {
        let z = self.range(-1.0, 1.0);
        let angle = self.range(0.0, std::f64::consts::TAU);
        let across = (1.0 - z * z).sqrt();
        DVec3::new(across * angle.cos(), across * angle.sin(), z)
    }
}

/// A surface in view space; distances in metres.
#[derive(Clone, Copy, Debug)]
pub(super) enum Solid {
    /// `dot(normal, p) = offset`.
    Plane { normal: DVec3, offset: f64 },
    /// A wall that faces the camera at a depth, up to a height; background is above it.
    Wall { depth: f64, top: f64 },
    /// Upright bars at a depth, a third of a period wide.
    Bars { depth: f64, period: f64 },
    /// A ball.
    Ball { center: DVec3, radius: f64 },
}

/// A view-space ray with view depth as its parameter.
#[derive(Clone, Copy, Debug)]
struct Ray {
    origin: DVec3,
    per_metre: DVec3,
}

impl Ray {
    fn at(&self, depth: f64) -> DVec3 {
        self.origin + self.per_metre * depth
    }
}

impl Solid {
    /// View depth and normal of the first hit in front of the camera.
    fn hit(&self, ray: &Ray) -> Option<(f64, DVec3)> {
        let (depth, normal) = match *self {
            Self::Plane { normal, offset } => {
                let along = normal.dot(ray.per_metre);
                ((offset - normal.dot(ray.origin)) / along, normal)
            }
            Self::Wall { depth, top } => {
                (if ray.at(depth).y < top { depth } else { -1.0 }, DVec3::Z)
            }
            Self::Bars { depth, period } => {
                let across = (ray.at(depth).x / period).rem_euclid(1.0);
                (if across < 1.0 / 3.0 { depth } else { -1.0 }, DVec3::Z)
            }
            Self::Ball { center, radius } => {
                let (from, along) = (ray.origin - center, ray.per_metre);
                let (a, b) = (along.dot(along), from.dot(along));
                let root = (b * b - a * (from.dot(from) - radius * radius)).sqrt();
                let depth = (-b - root) / a;
                (depth, (ray.at(depth) - center) / radius)
            }
        };
        (depth.is_finite() && depth > 0.0).then_some((depth, normal))
    }
}

/// A floor, a far wall under an open sky, and balls, all scaled by `scale_m`.
pub(super) fn room(rng: &mut Rng, scale_m: f64) -> Vec<Solid> {
    let mut solids = vec![
        Solid::Plane { normal: DVec3::new(0.0, 1.0, 0.05).normalize(), offset: -1.5 * scale_m },
        Solid::Wall { depth: 12.0 * scale_m, top: 3.5 * scale_m },
    ];
    for _ in 0..5 {
        let depth = rng.range(2.5, 10.0);
        let across = DVec2::new(rng.range(-0.5, 0.5), rng.range(-0.3, 0.3)) * depth;
        solids.push(Solid::Ball {
            center: across.extend(-depth) * scale_m,
            radius: rng.range(0.3, 1.2) * scale_m,
        });
    }
    solids
}

/// The model index of a sample that lies on no surface.
pub(super) const IN_THE_OPEN: u32 = u32::MAX;

/// A view sample.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sample {
    pub(super) pixel: [u32; 2],
    /// Clip depth; on a surface, the depth buffer's value.
    pub(super) depth_clip: f32,
    /// The sample's model; [`IN_THE_OPEN`] if it lies on none.
    pub(super) model_ix: u32,
    /// World-space position. Lights are aimed at it.
    pub(super) point: DVec3,
    /// Shading normal. In the open it is the normal of the surface at that pixel, or zero.
    pub(super) normal_world: Vec3,
}

/// A view, the surfaces that it sees, and the samples to look up.
#[derive(Clone, Debug)]
pub(super) struct Stage {
    pub(super) view: View,
    /// Size of the render target, pixels.
    pub(super) target: [u32; 2],
    /// World-space normal and clip depth of each texel. Background has depth -1.
    pub(super) texels: Vec<[f32; 4]>,
    /// Samples on surfaces, then samples in the open.
    pub(super) samples: Vec<Sample>,
    pub(super) on_surfaces: usize,
    /// A box around the samples of each solid. Each box is turned a little further.
    pub(super) models: Vec<ModelBox>,
    view_to_world: DMat4,
    view_to_clip: DMat4,
}

impl Stage {
    /// Traces `solids`. Samples every pixel with a surface, and `open` points in the open.
    pub(super) fn new(view: View, target: [u32; 2], solids: &[Solid], open: usize) -> Self {
        let mut stage = Self {
            view,
            target,
            texels: vec![[0.0, 0.0, 0.0, -1.0]; (target[0] * target[1]) as usize],
            samples: Vec::new(),
            on_surfaces: 0,
            models: Vec::new(),
            view_to_world: view.world_to_view.as_dmat4().inverse(),
            view_to_clip: view.view_to_clip().as_dmat4(),
        };
        let port = view.viewport;
        for y in port.y..port.y + port.height {
            for x in port.x..port.x + port.width {
                stage.trace([x, y], solids);
            }
        }
        stage.on_surfaces = stage.samples.len();
        stage.models = (0..solids.len() as u32).map(|ix| stage.model(ix)).collect();
        stage.sample_in_the_open(open);
        stage
    }

    /// The box of a model, around the positions at which shading rebuilds its samples.
    fn model(&self, model_ix: u32) -> ModelBox {
        let turn = Mat3::from_euler(glam::EulerRot::XYZ, 0.3, 0.5, 0.2 * model_ix as f32);
        let axes = [turn.x_axis, turn.y_axis, turn.z_axis];
        let along = |point: DVec3| DVec3::from_array(axes.map(|axis| axis.as_dvec3().dot(point)));
        let points = || self.samples.iter().filter(|s| s.model_ix == model_ix).map(|s| s.point);
        let low = points().map(along).fold(DVec3::INFINITY, DVec3::min);
        let high = points().map(along).fold(DVec3::NEG_INFINITY, DVec3::max);
        if !(low.is_finite() && high.is_finite()) {
            return ModelBox { center_world: Vec3::ZERO, axes, half_extents_m: Vec3::ZERO };
        }
        let center = 0.5 * (low + high);
        let [x, y, z] = axes.map(Vec3::as_dvec3);
        ModelBox {
            center_world: (x * center.x + y * center.y + z * center.z).as_vec3(),
            axes,
            half_extents_m: (0.5 * (high - low)).as_vec3(),
        }
    }

    /// A box around the samples on surfaces, world space; `None` without any.
    pub(super) fn surface_bounds(&self) -> Option<(Vec3, Vec3)> {
        let points = || self.samples[..self.on_surfaces].iter().map(|s| s.point.as_vec3());
        points().next()?;
        Some((
            points().fold(Vec3::INFINITY, Vec3::min),
            points().fold(Vec3::NEG_INFINITY, Vec3::max),
        ))
    }

    /// Keeps at most `count` samples of each kind.
    pub(super) fn thinned(mut self, count: usize) -> Self {
        let open = self.samples.split_off(self.on_surfaces);
        let thin = |samples: Vec<Sample>| {
            let step = samples.len().div_ceil(count.max(1)).max(1);
            samples.into_iter().step_by(step).collect::<Vec<_>>()
        };
        self.samples = thin(self.samples);
        self.on_surfaces = self.samples.len();
        self.samples.extend(thin(open));
        self
    }

    /// The world-space point of a view-space point.
    pub(super) fn to_world(&self, point_view: DVec3) -> DVec3 {
        self.view_to_world.transform_point3(point_view)
    }

    /// The place of a pixel's middle in the window.
    fn window(&self, pixel: [u32; 2]) -> DVec2 {
        let uniform = self.view.uniform();
        let pair = |v: [f32; 2]| DVec2::from_array(v.map(f64::from));
        let uv = (DVec2::new(f64::from(pixel[0]), f64::from(pixel[1])) + 0.5
            - pair(uniform.viewport_origin))
            / pair(uniform.viewport_size);
        let ndc = DVec2::new(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y);
        pair(uniform.ray_scale) * ndc + pair(uniform.ray_offset)
    }

    fn ray(&self, pixel: [u32; 2]) -> Ray {
        let window = self.window(pixel);
        match self.view.projection {
            Projection::Perspective { .. } => {
                Ray { origin: DVec3::ZERO, per_metre: window.extend(-1.0) }
            }
            Projection::Orthographic { .. } => {
                Ray { origin: window.extend(0.0), per_metre: DVec3::NEG_Z }
            }
        }
    }

    fn depth_clip(&self, ray: &Ray, depth_view: f64) -> f32 {
        let clip = self.view_to_clip * ray.at(depth_view).extend(1.0);
        ((clip.z / clip.w) as f32).clamp(0.0, 1.0)
    }

    fn trace(&mut self, pixel: [u32; 2], solids: &[Solid]) {
        let ray = self.ray(pixel);
        let Some((near, far)) = self.view.shown_m(self.window(pixel)) else {
            return;
        };
        let nearest = (0..)
            .zip(solids)
            .filter_map(|(model_ix, solid)| Some((model_ix, solid.hit(&ray)?)))
            .filter(|(_, (depth, _))| (near..=far).contains(depth))
            .min_by(|(_, a), (_, b)| a.0.total_cmp(&b.0));
        let Some((model_ix, (depth, normal))) = nearest else {
            return;
        };
        let depth_clip = self.depth_clip(&ray, depth);
        // A renderer treats the cleared depth as background.
        if depth_clip == self.view.depth_clear() {
            return;
        }
        let normal = self.view_to_world.transform_vector3(normal).as_vec3();
        self.texels[(pixel[0] + pixel[1] * self.target[0]) as usize] =
            normal.extend(depth_clip).to_array();
        self.samples.push(Sample {
            pixel,
            depth_clip,
            model_ix,
            point: self.rebuilt(pixel, depth_clip),
            normal_world: normal,
        });
    }

    /// The world-space point that shading rebuilds from a clip depth, in shading's f32. With a near
    /// plane of millimetres and depth not reversed, it is far from the point that was drawn.
    fn rebuilt(&self, pixel: [u32; 2], depth_clip: f32) -> DVec3 {
        let [.., [_, _, m22, m23], [_, _, m32, m33]] = self.view.view_to_clip().to_cols_array_2d();
        let [x, y] = pixel.map(|at| at as f32 + 0.5);
        let [right, down, at_origin] = self.view.uniform().depth_tilt;
        let tilt = right.mul_add(x, down.mul_add(y, at_origin));
        let over = m32 - depth_clip * m33 + m33 * tilt;
        let under = m22 - depth_clip * m23 + m23 * tilt;
        self.to_world(self.ray(pixel).at(f64::from(over / under)))
    }

    /// Samples points at random depths, every eighth on the near or the far plane.
    fn sample_in_the_open(&mut self, count: usize) {
        let mut rng = Rng::new(u64::from(self.target[0]));
        let nearest = f64::from(self.view.near_m);
        let scale = self.deepest_surface().max(4.0 * nearest).max(1.0);
        for i in 0..count {
            let port = self.view.viewport;
            let x = port.x + rng.below(port.width as usize) as u32;
            let y = port.y + rng.below(port.height as usize) as u32;
            // An oblique near plane hides some rays.
            let Some((near, far)) = self.view.shown_m(self.window([x, y])) else {
                continue;
            };
            let is_endless = far.is_infinite();
            let far = far.min(4.0 * scale).max(near);
            let at_far = self.view.depth_clear();
            let depth_clip = match i % 16 {
                0 => 1.0 - at_far,
                8 if is_endless => continue,
                8 => at_far,
                _ => {
                    let depth = rng.log_range(near.max(1e-3 * far), far);
                    self.depth_clip(&self.ray([x, y]), depth)
                }
            };
            let point = self.rebuilt([x, y], depth_clip);
            // No depth buffer can distinguish a point so far away from infinity.
            if !point.is_finite() {
                continue;
            }
            let pixel = [x, y];
            let [normal_x, normal_y, normal_z, _] = self.texels[(x + y * self.target[0]) as usize];
            self.samples.push(Sample {
                pixel,
                depth_clip,
                model_ix: IN_THE_OPEN,
                point,
                normal_world: Vec3::new(normal_x, normal_y, normal_z),
            });
        }
    }

    /// Moves some samples in the open in front of the near plane or behind the far plane, and drops all others.
    pub(super) fn beyond_planes(mut self) -> Self {
        let at_far = self.view.depth_clear();
        let outwards = 1.0 - 2.0 * at_far;
        let open = self.samples.split_off(self.on_surfaces);
        self.samples.clear();
        self.on_surfaces = 0;
        for (ix, sample) in open.into_iter().step_by(4).enumerate() {
            let is_near = self.view.far_m.is_none() || ix.is_multiple_of(2);
            // With reversed depth and a near plane much nearer than the far plane: at half the distance of the near plane,
            // and a little behind the far plane.
            let depth_clip =
                if is_near { 1.0 - at_far + outwards } else { at_far - 2e-4 * outwards };
            let point = self.rebuilt(sample.pixel, depth_clip);
            self.samples.push(Sample { depth_clip, point, ..sample });
        }
        self
    }

    /// Whether no surface lies between the eye and a sample.
    pub(super) fn is_in_front(&self, sample: &Sample) -> bool {
        let [x, y] = sample.pixel;
        let [.., surface] = self.texels[(x + y * self.target[0]) as usize];
        let nearer = match self.view.depth {
            DepthMapping::Standard => sample.depth_clip <= surface,
            DepthMapping::Reversed => sample.depth_clip >= surface,
        };
        surface < 0.0 || nearer
    }

    fn deepest_surface(&self) -> f64 {
        let world_to_view = self.view.world_to_view.as_dmat4();
        let depth = |s: &Sample| -world_to_view.transform_point3(s.point).z;
        self.samples.iter().map(depth).fold(0.0, f64::max)
    }
}
