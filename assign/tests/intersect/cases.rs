//! Random views, groups and lights, chosen to be difficult: thin slices, far cameras, grazing rims.

use assign::intersect::UNBOUNDED;
use assign::{DepthMapping, Emitter, Light, LightShape, Projection, View, Viewport};
use glam::{DQuat, DVec3, Mat3, Quat, Vec2, Vec3};
use proptest::prelude::*;

use crate::groups::{Group, Shape};
use crate::oracle::{Overlap, overlap, wedges};

fn power_of_ten(exponents: std::ops::Range<f32>) -> impl Strategy<Value = f32> {
    exponents.prop_map(|e| 10_f32.powf(e))
}

fn vector(half: f32) -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-half..half).prop_map(Vec3::from_array)
}

fn unit() -> impl Strategy<Value = Vec3> {
    prop_oneof![
        4 => vector(1.0).prop_map(|v| v.normalize_or(Vec3::X)),
        1 => prop::sample::select(vec![Vec3::X, Vec3::NEG_Y, Vec3::NEG_Z]),
    ]
}

/// A place in the world: the origin, in a room, in a town, or 1,000 km away.
fn place() -> impl Strategy<Value = Vec3> {
    prop_oneof![
        2 => Just(Vec3::ZERO),
        4 => vector(50.0),
        1 => vector(1e3),
        1 => vector(1e6),
    ]
}

/// Window and range of view depths.
fn projection() -> impl Strategy<Value = (Projection, f32, Option<f32>)> {
    let near = || prop_oneof![Just(1e-3_f32), 0.01_f32..1.0];
    let far = || prop_oneof![Just(None), power_of_ten(0.3..5.0).prop_map(Some)];
    let symmetric = (0.04_f32..3.0, 0.3_f32..3.0).prop_map(|(top, aspect)| {
        let max = Vec2::new(top * aspect, top);
        Projection::Perspective { min: -max, max }
    });
    let window = |offset: f32, size: f32| {
        (prop::array::uniform2(-offset..offset), prop::array::uniform2(0.01 * size..size))
            .prop_map(|(min, size)| (Vec2::from(min), Vec2::from(min) + Vec2::from(size)))
    };
    let off_centre = window(2.0, 3.0).prop_map(|(min, max)| Projection::Perspective { min, max });
    let orthographic =
        window(100.0, 200.0).prop_map(|(min, max)| Projection::Orthographic { min, max });
    let perspective = (prop_oneof![3 => symmetric, 1 => off_centre], near(), far())
        .prop_map(|(window, near, far)| (window, near, far.map(|f| near * f)));
    prop_oneof![
        3 => perspective,
        1 => (orthographic, prop_oneof![Just(0.0_f32), 0.01_f32..9.0], 1.0_f32..1e3)
            .prop_map(|(window, near, depth)| (window, near, Some(near + depth))),
    ]
}

pub(crate) fn view() -> impl Strategy<Value = View> {
    let viewport = (0_u32..300, 0_u32..300, 1_u32..4000, 1_u32..2000);
    (place(), unit(), unit(), projection(), viewport, any::<bool>(), vector(0.5)).prop_map(
        |(eye, forward, up, (projection, near_m, far_m), (x, y, width, height), flip, jitter)| {
            let up =
                if up.cross(forward).length() < 0.1 { forward.any_orthogonal_vector() } else { up };
            let view = View {
                world_to_view: glam::camera::rh::view::look_to_mat4(eye, forward, up.normalize()),
                projection,
                near_m,
                far_m,
                depth: if flip { DepthMapping::Reversed } else { DepthMapping::Standard },
                viewport: Viewport { x, y, width, height },
                jitter: if flip { jitter.truncate() } else { Vec2::ZERO },
            };
            view.check().unwrap();
            view
        },
    )
}

/// A tile of pixels anywhere in the viewport, or the whole viewport, between two depths.
pub(crate) fn frustum() -> impl Strategy<Value = Group> {
    let tile = (0.0_f32..1.0, 0.0_f32..1.0, prop_oneof![4 => 1_u32..100, 1 => Just(4000)]);
    let first = prop_oneof![1 => Just(0.0_f32), 3 => power_of_ten(-3.0..3.3)];
    let thickness = prop_oneof![
        2 => power_of_ten(-1.0..2.7).prop_map(|m| (0.0, m)),
        2 => power_of_ten(-4.0..0.5).prop_map(|share| (share, 0.0)),
        1 => Just((0.0, UNBOUNDED)),
    ];
    (view(), tile, first, thickness).prop_map(|(view, (u, v, size), first, (share, metres))| {
        let Viewport { x, y, width, height } = view.viewport;
        let edge = |share: f32, pixels: u32| (share * pixels as f32) as u32 / size * size;
        let (left, top) = (x + edge(u, width), y + edge(v, height));
        let ndc = |px: u32, py: u32| {
            let uv = Vec2::new((px - x) as f32, (py - y) as f32)
                / Vec2::new(width as f32, height as f32);
            Vec2::new(2.0 * uv.x - 1.0, 1.0 - 2.0 * uv.y)
        };
        let (upper_left, lower_right) = (ndc(left, top), ndc(left + size, top + size));
        let depth_min = view.near_m + first;
        let shape = Shape::Frustum {
            ndc_min: Vec2::new(upper_left.x, lower_right.y),
            ndc_max: Vec2::new(lower_right.x, upper_left.y),
            depth_min,
            depth_max: depth_min * (1.0 + share) + metres,
        };
        Group { view, shape }
    })
}

fn extents() -> impl Strategy<Value = Vec3> {
    let extent = || prop_oneof![8 => power_of_ten(-3.0..2.7), 1 => Just(0.0_f32)];
    // The box of a single sample has no extent.
    prop_oneof![
        4 => (extent(), extent(), extent()).prop_map(|(x, y, z)| Vec3::new(x, y, z)),
        1 => Just(Vec3::ZERO),
    ]
}

pub(crate) fn aabb() -> impl Strategy<Value = Group> {
    (view(), place(), extents()).prop_map(|(view, min_world, size)| Group {
        view,
        shape: Shape::Aabb { min_world, max_world: min_world + size },
    })
}

pub(crate) fn oriented() -> impl Strategy<Value = Group> {
    let turn = (unit(), 0.0_f32..6.3, any::<bool>());
    (view(), place(), extents(), turn).prop_map(
        |(view, center_world, half_extents_m, (about, angle, mirrored))| {
            let axes = Mat3::from_quat(Quat::from_axis_angle(about, angle));
            let x = if mirrored { -axes.x_axis } else { axes.x_axis };
            let shape = Shape::Oriented {
                center_world,
                axes: [x, axes.y_axis, axes.z_axis],
                half_extents_m,
            };
            Group { view, shape }
        },
    )
}

pub(crate) fn group() -> impl Strategy<Value = Group> {
    prop_oneof![3 => frustum(), 1 => aabb(), 1 => oriented()]
}

/// A light's position and range, relative to a group.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Aim {
    /// Corner weights of the point near which the light lies, and of the point at which a spot is
    /// aimed.
    near: [f64; 8],
    at: [f64; 8],
    away: Vec3,
    gap_m: f32,
    at_eye: bool,
    range: Range,
    kind: Kind,
    cone: Cone,
    outline: Outline,
}

/// The kind of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    Point,
    Spot,
    /// A flat emitter, turned so that its plane lies where the edge of a 90-degree spot would be.
    Area,
}

/// The outline of an emitter.
#[derive(Clone, Copy, Debug)]
struct Outline {
    /// 2 for a rectangle, else the number of a polygon's vertices.
    vertices: u32,
    half_m: f32,
    aspect: f32,
    turn: f32,
    two_sided: bool,
}

impl Outline {
    /// The emitter that faces along `normal`, and the offset of its centre.
    fn emitter(self, normal: DVec3) -> (Emitter, Vec3) {
        let x = normal.any_orthonormal_vector();
        let x = DQuat::from_axis_angle(normal, self.turn.into()) * x * f64::from(self.half_m);
        let y = normal.cross(x) * f64::from(self.aspect);
        let (emitter, center) = if self.vertices == 2 {
            (Emitter::rectangle(x.as_vec3(), y.as_vec3()), Vec3::ZERO)
        } else {
            let corner = |ix: u32| {
                let (sin, cos) =
                    (std::f64::consts::TAU * f64::from(ix) / f64::from(self.vertices)).sin_cos();
                (x * cos + y * sin).as_vec3()
            };
            Emitter::polygon(&(0..self.vertices).map(corner).collect::<Vec<_>>()).unwrap()
        };
        (if self.two_sided { emitter.two_sided() } else { emitter }, center)
    }
}

#[derive(Clone, Copy, Debug)]
enum Range {
    /// The range at which the light just touches the group, times this.
    Touch(f32),
    Metres(f32),
}

#[derive(Clone, Copy, Debug)]
struct Cone {
    outer: f32,
    /// Angle between the cone's axis and the target point: the first value times `outer`, plus the
    /// second.
    tilt: (f64, f64),
    about: f64,
}

/// Corner weights of a corner, of a point on an edge, or of a point inside.
fn weights() -> impl Strategy<Value = [f64; 8]> {
    let corner = |i: usize| std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 });
    prop_oneof![
        1 => (0_usize..8).prop_map(corner),
        1 => (0_usize..8, 0_usize..3, 0.0..1.0).prop_map(|(i, axis, t)| std::array::from_fn(|j| {
            if j == i { t } else if j == i ^ 1 << axis { 1.0 - t } else { 0.0 }
        })),
        2 => prop::array::uniform8(0.01..1.0),
    ]
}

fn cone() -> impl Strategy<Value = Cone> {
    use std::f32::consts::{FRAC_PI_2, FRAC_PI_4, PI};
    let outer = prop_oneof![
        4 => 0.02_f32..3.1,
        2 => power_of_ten(-3.5..-1.0),
        2 => (prop::sample::select(vec![FRAC_PI_4, FRAC_PI_2]), -1e-3_f32..1e-3).prop_map(|(a, b)| a + b),
        1 => Just(FRAC_PI_2),
        1 => prop::sample::select(vec![PI, PI - 1e-3, PI - 0.05]),
    ];
    let tilt = prop_oneof![
        2 => (power_of_ten(-7.0..-3.0), any::<bool>())
            .prop_map(|(more, out)| (1.0, f64::from(if out { more } else { -more }))),
        2 => (0.0_f64..1.2, Just(0.0)),
        1 => (Just(0.0), 0.0_f64..3.2),
        // The spot points straight away, or nearly.
        1 => power_of_ten(-6.0..-1.0).prop_map(|e| (0.0, std::f64::consts::PI - f64::from(e))),
    ];
    (outer, tilt, 0.0_f64..6.3).prop_map(|(outer, tilt, about)| Cone { outer, tilt, about })
}

fn outline() -> impl Strategy<Value = Outline> {
    let half = prop_oneof![3 => power_of_ten(-2.0..2.0), 1 => power_of_ten(-3.5..4.0)];
    let aspect = prop_oneof![3 => 0.2_f32..1.0, 1 => power_of_ten(-3.0..0.0)];
    (2_u32..=10, half, aspect, 0.0_f32..6.3, prop::bool::weighted(0.3)).prop_map(
        |(vertices, half_m, aspect, turn, two_sided)| Outline {
            vertices,
            half_m,
            aspect,
            turn,
            two_sided,
        },
    )
}

pub(crate) fn aim(kind: Kind) -> impl Strategy<Value = Aim> {
    let gap =
        prop_oneof![4 => power_of_ten(-3.0..3.0), 1 => power_of_ten(3.0..6.0), 1 => Just(0.0_f32)];
    let range = prop_oneof![
        4 => prop_oneof![Just(1.0_f32), 1.0_f32..1.001].prop_map(Range::Touch),
        1 => (0.3_f32..3.0).prop_map(Range::Touch),
        2 => power_of_ten(-4.0..6.0).prop_map(Range::Metres),
    ];
    let at_eye = prop::bool::weighted(0.05);
    (weights(), weights(), unit(), gap, at_eye, range, cone(), outline()).prop_map(
        move |(near, at, away, gap_m, at_eye, range, cone, outline)| Aim {
            near,
            at,
            away,
            gap_m,
            at_eye,
            range,
            kind,
            cone,
            outline,
        },
    )
}

impl Aim {
    pub(crate) fn light(&self, group: &Group) -> Light {
        let world = group.hull(DVec3::ZERO, 0.0);
        let beside = world.blend(self.near) + self.away.as_dvec3() * f64::from(self.gap_m);
        let position = if self.at_eye { group.view.eye() } else { beside.as_vec3() };
        let center = position.as_dvec3();
        let target = group.hull(center, 0.0).blend(self.at);
        let mut light = Light::point(position, 1.0, Vec3::ONE);
        let towards = target.normalize_or(DVec3::NEG_Y);
        let about =
            DQuat::from_axis_angle(towards, self.cone.about) * towards.any_orthonormal_vector();
        let direction = |outer: f32| {
            let tilt = self.cone.tilt.0 * f64::from(outer) + self.cone.tilt.1;
            DQuat::from_axis_angle(about, tilt) * towards
        };
        let outer_angle = self.cone.outer;
        match self.kind {
            Kind::Point => {}
            Kind::Spot => {
                light.shape = LightShape::Spot {
                    direction: direction(outer_angle).as_vec3().normalize(),
                    inner_angle: 0.5 * outer_angle,
                    outer_angle,
                };
            }
            Kind::Area => {
                let normal = direction(std::f32::consts::FRAC_PI_2);
                let (emitter, center) = self.outline.emitter(normal);
                light.shape = LightShape::Area(emitter);
                light.position += center;
            }
        }
        light.range_m = match self.range {
            Range::Metres(metres) => metres,
            Range::Touch(factor) => touching_range(group, light) * factor,
        };
        light.range_m = light.range_m.clamp(1e-4, 1e9);
        light.check().unwrap();
        light
    }
}

/// The shortest range, to 1e-7 of it, at which the light certainly reaches the group; 1 m if the
/// group contains the light's centre or is never reached.
fn touching_range(group: &Group, mut light: Light) -> f32 {
    let center = light.position.as_dvec3();
    let distance = group.hull(center, 0.0).distance(DVec3::ZERO);
    if distance == 0.0 {
        return 1.0;
    }
    let size_m = light.radius_m() - light.range_m;
    let mut low = (distance as f32 - size_m).max(1e-4);
    if size_m == 0.0 && f64::from(low) < distance {
        low = low.next_up();
    }
    if light.shape == LightShape::Point {
        return low;
    }
    let mut touches = |range: f32| {
        light.range_m = range;
        witness(group, &light).is_some()
    };
    let mut high = low;
    for _ in 0..8 {
        if touches(high) {
            break;
        }
        (low, high) = (high, high * 4.0);
    }
    for _ in 0..24 {
        let middle = 0.5 * (low + high);
        if touches(middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    if touches(high) { high } else { 1.0 }
}

/// A world-space point of the group that the light's support contains; `None` if none was found.
/// Above a half angle of π/2, there may be one all the same.
pub(crate) fn witness(group: &Group, light: &Light) -> Option<DVec3> {
    let center = light.position.as_dvec3();
    let radius = f64::from(light.radius_m());
    let hull = group.hull(center, radius);
    let nearest = hull.nearest(DVec3::ZERO);
    if nearest.length() > radius {
        return None;
    }
    if light.shape == LightShape::Point {
        return Some(center + nearest);
    }
    wedges(light, nearest).iter().find_map(|wedge| match overlap(&hull, wedge) {
        Overlap::At(point) => Some(center + point),
        Overlap::Apart | Overlap::Unknown => None,
    })
}
