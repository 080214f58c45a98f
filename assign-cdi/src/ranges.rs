//! Ranges of points on surfaces, from rays through deep images.

use std::f32::consts::{FRAC_PI_2, TAU};

use assign::{AssignError, Gpu, Passes, Shader};
use bytemuck::{Pod, Zeroable, bytes_of};
use glam::Vec3;

use crate::{
    DeepImageSettings, DeepImages,
    kernel::{self, Slot, workgroups},
};

/// How a point's range follows from the lengths of its rays.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Combine {
    /// Their mean.
    #[default]
    Average,
    /// The longest.
    Maximum,
}

/// The direction of a point's primary ray.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Primary {
    /// Along the normal.
    #[default]
    Normal,
    /// The direction in which a mirror at the point reflects light from [`RangePoints::light_world`].
    Reflected,
    /// A direction given for each point.
    Given,
}

impl Primary {
    /// `normal`, `reflected` or `given`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Normal => "normal",
            Self::Reflected => "reflected",
            Self::Given => "given",
        }
    }
}

/// The rays of a point: a primary ray, and others evenly around it (Archer et al. 2019, section 3.2). Rays without a
/// hit do not count. If no ray has a hit, the range is [`f32::MAX`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RangeRule {
    /// Rays per point, 1 to [`MAX_RAYS`].
    pub rays: u32,
    /// Angle between the primary ray and the others, radians, 0 to a quarter turn.
    pub cone_angle: f32,
    /// How the range follows from their lengths.
    pub combine: Combine,
    /// The direction of the primary ray.
    pub primary: Primary,
    /// Whether a second look-up corrects each ray (`cast_corrected_ray` of `ray_cast.wesl`). The paper does not do
    /// this; it is more accurate and slower.
    pub is_corrected: bool,
}

/// The most rays per point.
pub const MAX_RAYS: u32 = 16;

impl Default for RangeRule {
    /// The paper's six rays and their mean. The paper does not state the angle. Here it is 60 degrees: only a quarter
    /// of a Lambertian emitter's light leaves at larger angles, and no ray grazes the surface.
    fn default() -> Self {
        Self {
            rays: 6,
            cone_angle: TAU / 6.0,
            combine: Combine::default(),
            primary: Primary::default(),
            is_corrected: false,
        }
    }
}

impl RangeRule {
    /// Checks every field. The error names the first one out of its range.
    pub fn check(&self) -> Result<(), AssignError> {
        if !(1..=MAX_RAYS).contains(&self.rays) {
            return Err(AssignError::Parameter {
                field: "rays per point".into(),
                value: self.rays.to_string(),
                accepted: format!("1 to {MAX_RAYS}"),
            });
        }
        if !(0.0..=FRAC_PI_2).contains(&self.cone_angle) {
            return Err(AssignError::Parameter {
                field: "angle between rays (cone_angle)".into(),
                value: self.cone_angle.to_string(),
                accepted: format!("0 to {FRAC_PI_2} radians"),
            });
        }
        Ok(())
    }

    /// Unit vector of a ray if the primary ray is +z.
    pub fn ray(&self, ix: u32) -> Vec3 {
        if ix == 0 {
            return Vec3::Z;
        }
        let others = self.rays.saturating_sub(1).max(1);
        let (sin, cos) = (TAU * (ix - 1) as f32 / others as f32).sin_cos();
        let (radius, height) = self.cone_angle.sin_cos();
        Vec3::new(radius * cos, radius * sin, height)
    }
}

/// The points whose ranges are estimated, on the GPU.
#[derive(Clone, Copy, Debug)]
pub struct RangePoints<'a> {
    /// `array<vec4f>`: world-space positions, metres. The fourth number is not read.
    pub positions: &'a wgpu::Buffer,
    /// `array<vec4f>`: unit normals. A point whose normal is 0 casts no ray, and its range is [`f32::MAX`].
    pub normals: &'a wgpu::Buffer,
    /// `array<vec4f>`: unit primary directions, for [`Primary::Given`].
    pub primaries: Option<&'a wgpu::Buffer>,
    /// Position of the light that the points reflect, for [`Primary::Reflected`].
    pub light_world: Option<Vec3>,
    /// Number of points.
    pub count: u32,
    /// `array<f32>`: receives the ranges, metres.
    pub ranges_m: &'a wgpu::Buffer,
}

/// What the kernel reads: `struct Ranges` of `ranges.wesl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct RangesUniform {
    /// Number of points.
    pub point_count: u32,
    /// Rays per point.
    pub ray_count: u32,
    /// 1: the range is the longest ray. 0: it is the mean.
    pub is_maximum: u32,
    /// Pads to a multiple of 16 bytes.
    pub padding: u32,
    /// Position of the light that points reflect, world space.
    pub light_world: [f32; 4],
    /// Unit vectors of the rays if the primary ray is +z.
    pub rays: [[f32; 4]; MAX_RAYS as usize],
}

/// Estimates the ranges of points.
#[derive(Debug)]
pub struct RangeCaster {
    settings: DeepImageSettings,
    rule: RangeRule,
    pipeline: wgpu::ComputePipeline,
    layout: wgpu::BindGroupLayout,
    uniform: wgpu::Buffer,
    group: Option<wgpu::BindGroup>,
    count: u32,
}

impl RangeCaster {
    /// Makes the kernel for images with the settings of `images`. Checks the rule.
    pub fn new(gpu: &Gpu, images: &DeepImages, rule: RangeRule) -> Result<Self, AssignError> {
        rule.check()?;
        let shader = Self::shader(images.settings(), rule);
        let module = kernel::uncounted(gpu, &shader, "package::ranges")?;
        let slots = [Slot::Uniform, Slot::Read, Slot::Read, Slot::Read, Slot::Write];
        let layout = kernel::layout(gpu, "ranges", wgpu::ShaderStages::COMPUTE, &slots);
        let layouts = [images.layout(), &layout];
        Ok(Self {
            pipeline: kernel::pipeline(gpu, &module, "estimate_ranges", &layouts),
            layout,
            uniform: gpu.uniform("ranges", size_of::<RangesUniform>() as u64),
            group: None,
            count: 0,
            settings: *images.settings(),
            rule,
        })
    }

    /// The kernel's modules. The root is `package::ranges`.
    pub fn shader(settings: &DeepImageSettings, rule: RangeRule) -> Shader<'static> {
        DeepImages::mount(settings, Shader::new(3), 0)
            .module("package::ranges", include_str!("shaders/ranges.wesl"))
            .flag("reflected_primary", rule.primary == Primary::Reflected)
            .flag("given_primary", rule.primary == Primary::Given)
            .flag("corrected", rule.is_corrected)
    }

    /// Binds the points of a frame.
    pub fn prepare(&mut self, gpu: &Gpu, points: &RangePoints<'_>) -> Result<(), AssignError> {
        let primaries = match (self.rule.primary, points.primaries) {
            (Primary::Normal | Primary::Reflected, _) => points.normals,
            (Primary::Given, Some(primaries)) => primaries,
            (Primary::Given, None) => {
                return Err(AssignError::Parameter {
                    field: "buffer of primary directions (primaries)".into(),
                    value: "missing".into(),
                    accepted: "present if the rule is Primary::Given".into(),
                });
            }
        };
        if self.rule.primary == Primary::Reflected && points.light_world.is_none() {
            return Err(AssignError::Parameter {
                field: "position of the light (light_world)".into(),
                value: "missing".into(),
                accepted: "present if the rule is Primary::Reflected".into(),
            });
        }
        let buffers = [
            ("positions", points.positions, 16),
            ("normals", points.normals, 16),
            ("primaries", primaries, 16),
            ("ranges_m", points.ranges_m, 4),
        ];
        for (field, buffer, bytes) in buffers {
            let needed = u64::from(points.count) * bytes;
            if buffer.size() < needed {
                return Err(AssignError::Parameter {
                    field: format!("buffer `{field}` of the points"),
                    value: format!("{} bytes", buffer.size()),
                    accepted: format!("at least {needed} bytes for {} points", points.count),
                });
            }
        }
        let mut uniform = RangesUniform {
            point_count: points.count,
            ray_count: self.rule.rays,
            is_maximum: u32::from(self.rule.combine == Combine::Maximum),
            light_world: points.light_world.unwrap_or_default().extend(0.0).into(),
            ..RangesUniform::default()
        };
        for (ix, ray) in (0..self.rule.rays).zip(&mut uniform.rays) {
            *ray = self.rule.ray(ix).extend(0.0).into();
        }
        gpu.queue.write_buffer(&self.uniform, 0, bytes_of(&uniform));
        let bound = [&self.uniform, points.positions, points.normals, primaries, points.ranges_m];
        self.group = Some(kernel::bind_buffers(gpu, &self.layout, &bound));
        self.count = points.count;
        Ok(())
    }

    /// Records the pass `cdi-ranges`, after the passes of the images. An error before both are prepared, or if the
    /// images have other settings than the kernel was made for.
    pub fn record(&self, images: &DeepImages, passes: &mut dyn Passes) -> Result<(), AssignError> {
        let missing = |missing| AssignError::Missing { strategy: "cdi-ranges".into(), missing };
        let group = self.group.as_ref().ok_or_else(|| missing("prepared points"))?;
        let rays = images.bind_group().ok_or_else(|| missing("prepared deep images"))?;
        if *images.settings() != self.settings {
            return Err(AssignError::Parameter {
                field: "settings of deep images".into(),
                value: format!("{:?}", images.settings()),
                accepted: format!("{:?}", self.settings),
            });
        }
        passes.compute("cdi-ranges", &mut |pass| {
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, rays, &[]);
            pass.set_bind_group(1, group, &[]);
            pass.dispatch_workgroups(workgroups(u64::from(self.count), 256), 1, 1);
        });
        Ok(())
    }
}
