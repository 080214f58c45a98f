//! Groups of every shape, with the bounds of the code under test and with exact hulls.

use crate::oracle::Hull;
use assign::intersect::{Aabb, Frustum, LightVolume, OrientedBox, UNBOUNDED};
use assign::{FrustumTests, Light, View};
use glam::{DMat4, DVec2, DVec3, Mat4, Vec2, Vec3};

/// A group as a strategy describes it.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Shape {
    Frustum { ndc_min: Vec2, ndc_max: Vec2, depth_min: f32, depth_max: f32 },
    Aabb { min_world: Vec3, max_world: Vec3 },
    Oriented { center_world: Vec3, axes: [Vec3; 3], half_extents_m: Vec3 },
}

#[derive(Clone, Copy, Debug)]
pub(crate) struct Group {
    pub(crate) view: View,
    pub(crate) shape: Shape,
}

/// A group's bounds in the Rust mirror of the WESL.
#[derive(Clone, Copy, Debug)]
#[allow(clippy::large_enum_variant, reason = "one value a test")]
pub(crate) enum Bounds {
    Frustum(Frustum),
    Aabb(Aabb),
    Oriented(OrientedBox),
}

/// Unions of tests: each test on its own, and the unions that a user would choose.
pub(crate) const UNIONS: [&str; 7] =
    ["hs", "sat-e", "sat-n", "sat-p", "sat-v", "hs+sat-n", "hs+sat-e+sat-p+sat-v"];

pub(crate) fn union(text: &str) -> FrustumTests {
    text.parse().unwrap()
}

/// The box around a light's support, as in the light hierarchy.
pub(crate) fn box_of(light: &Light) -> (Vec3, Vec3) {
    let volume = LightVolume::from(light);
    let along = |sign: f32| {
        Vec3::new(
            volume.extent_along(sign * Vec3::X),
            volume.extent_along(sign * Vec3::Y),
            volume.extent_along(sign * Vec3::Z),
        )
    };
    (light.position - along(-1.0), light.position + along(1.0))
}

impl Bounds {
    pub(crate) fn reaches(&self, light: &Light, tests: FrustumTests) -> bool {
        let volume = LightVolume::from(light);
        match self {
            Self::Frustum(frustum) => frustum.reaches(&volume, tests),
            Self::Aabb(aabb) => aabb.reaches(&volume),
            Self::Oriented(oriented) => oriented.reaches(&volume),
        }
    }

    /// Whether a light in a box may reach the group.
    pub(crate) fn reaches_box(&self, min_world: Vec3, max_world: Vec3) -> bool {
        match self {
            Self::Frustum(frustum) => frustum.reaches_box(min_world, max_world),
            Self::Aabb(aabb) => aabb.reaches_box(min_world, max_world),
            Self::Oriented(oriented) => oriented.reaches_box(min_world, max_world),
        }
    }

    /// The same bounds with `factor` times the slack.
    pub(crate) fn with_slack(mut self, factor: f32) -> Self {
        match &mut self {
            Self::Frustum(f) => {
                f.slack_m *= factor;
                f.slack_per_m *= factor;
            }
            Self::Aabb(b) => {
                b.slack_m *= factor;
                b.slack_per_m *= factor;
            }
            Self::Oriented(b) => {
                b.slack_m *= factor;
                b.slack_per_m *= factor;
            }
        }
        self
    }
}

impl Group {
    pub(crate) fn bounds(&self) -> Bounds {
        match self.shape {
            Shape::Frustum { ndc_min, ndc_max, depth_min, depth_max } => {
                Bounds::Frustum(Frustum::new(&self.view, ndc_min, ndc_max, depth_min, depth_max))
            }
            Shape::Aabb { min_world, max_world } => {
                Bounds::Aabb(Aabb::new(&self.view, min_world, max_world))
            }
            Shape::Oriented { center_world, axes, half_extents_m } => {
                Bounds::Oriented(OrientedBox::new(&self.view, center_world, axes, half_extents_m))
            }
        }
    }

    /// The exact hull, relative to `center`. A group without a far plane ends so far away that it
    /// keeps everything within `reach_m` of `center`, and the hull's nearest point.
    pub(crate) fn hull(&self, center: DVec3, reach_m: f64) -> Hull {
        let corner = |i: usize| DVec3::new((i & 1) as f64, (i >> 1 & 1) as f64, (i >> 2) as f64);
        Hull(match self.shape {
            Shape::Frustum { depth_min, depth_max, .. } => {
                let near = f64::from(depth_min);
                let far = if depth_max < UNBOUNDED {
                    f64::from(depth_max)
                } else {
                    near + 2.0 * self.world_at(DVec3::ZERO, near).distance(center) + reach_m + 1.0
                };
                std::array::from_fn(|i| {
                    let at = corner(i);
                    self.world_at(at, near + (far - near) * at.z) - center
                })
            }
            Shape::Aabb { min_world, max_world } => {
                let (min, max) = (min_world.as_dvec3(), max_world.as_dvec3());
                std::array::from_fn(|i| min + (max - min) * corner(i) - center)
            }
            Shape::Oriented { center_world, axes, half_extents_m } => std::array::from_fn(|i| {
                let at = (2.0 * corner(i) - 1.0) * half_extents_m.as_dvec3();
                let [x, y, z] = axes.map(Vec3::as_dvec3);
                center_world.as_dvec3() + x * at.x + y * at.y + z * at.z - center
            }),
        })
    }

    /// The exact world-space position at shares `at.xy` of the tile and at a view depth.
    fn world_at(&self, at: DVec3, depth_view: f64) -> DVec3 {
        let Shape::Frustum { ndc_min, ndc_max, .. } = self.shape else {
            unreachable!("only frusta have depths");
        };
        let uniform = self.view.uniform();
        let wide = |v: [f32; 2]| Vec2::from_array(v).as_dvec2();
        let (low, high) = (ndc_min.as_dvec2(), ndc_max.as_dvec2());
        let ndc = low + (high - low) * DVec2::new(at.x, at.y);
        let ray = wide(uniform.ray_scale) * ndc + wide(uniform.ray_offset);
        let window = if uniform.perspective > 0.5 { ray * depth_view } else { ray };
        let to_world: DMat4 = Mat4::from_cols_array_2d(&uniform.view_to_world).as_dmat4();
        to_world.transform_point3(window.extend(-depth_view))
    }

    /// A sample of the group, rebuilt in f32 as a shader does.
    pub(crate) fn sample(&self, at: Vec3) -> Vec3 {
        match self.shape {
            Shape::Frustum { ndc_min, ndc_max, depth_min, depth_max } => {
                let uniform = self.view.uniform();
                let far = if depth_max < UNBOUNDED { depth_max } else { depth_min + 1e3 };
                let depth = (depth_min + (far - depth_min) * at.z).clamp(depth_min, far);
                let ndc = (ndc_min + (ndc_max - ndc_min) * at.truncate()).clamp(ndc_min, ndc_max);
                let ray = Vec2::from(uniform.ray_scale) * ndc + Vec2::from(uniform.ray_offset);
                let window = if uniform.perspective > 0.5 { ray * depth } else { ray };
                Mat4::from_cols_array_2d(&uniform.view_to_world)
                    .transform_point3(window.extend(-depth))
            }
            Shape::Aabb { min_world, max_world } => {
                (min_world + (max_world - min_world) * at).clamp(min_world, max_world)
            }
            Shape::Oriented { center_world, axes, half_extents_m } => {
                let local = half_extents_m * (2.0 * at - 1.0);
                center_world + axes[0] * local.x + axes[1] * local.y + axes[2] * local.z
            }
        }
    }
}
