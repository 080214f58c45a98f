//! Random lights aimed at groups, chosen to be difficult: many barely touch their group.

use assign::{Emitter, Light, LightShape};
use glam::{DQuat, DVec3, Vec3};
use proptest::prelude::*;

use crate::cases::{power_of_ten, unit};
use crate::groups::Group;
use crate::oracle::{Overlap, overlap, wedges};

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
    /// A disc, turned in the same way, a sphere or a line.
    Curved,
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

    /// A disc that faces along `normal`, a sphere, or a line across `normal`.
    fn curved(self, normal: DVec3) -> Emitter {
        match self.vertices % 3 {
            0 if self.two_sided => Emitter::disc(normal.as_vec3(), self.half_m).two_sided(),
            0 => Emitter::disc(normal.as_vec3(), self.half_m),
            1 => Emitter::sphere(self.half_m),
            _ => {
                let along = normal.any_orthonormal_vector();
                let along = DQuat::from_axis_angle(normal, self.turn.into()) * along;
                Emitter::line(along.as_vec3() * self.half_m, self.half_m * self.aspect)
            }
        }
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
            Kind::Curved => {
                let normal = direction(std::f32::consts::FRAC_PI_2);
                light.shape = LightShape::Area(self.outline.curved(normal));
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
