//! An upper bound of the specular radiance that an area light adds to a group. `gloss.wesl` derives
//! it.

use std::f32::consts::PI;

use glam::Vec3;

use super::{
    Aabb, LightVolume, NormalCone, eye_world,
    facing::{OFF_PLANE, OFF_SQUARE},
    volume::PROJECTIONS,
};
use crate::{Light, LightShape, View};

/// As in `brdf.wesl`.
const MIN_ROUGHNESS: f32 = 0.045;
/// WGSL's acos may be off by 7e-5 (accuracy of built-in functions); the bound sums four such angles.
const ANGLE_SLACK: f32 = 5e-4;

/// What is known about the reflection of a group's surfaces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gloss {
    /// Least and greatest perceptual roughness.
    pub roughness: [f32; 2],
    /// Greatest reflectance at normal incidence.
    pub f0: f32,
}

/// A group of glossy surfaces, seen from the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SeenGroup {
    bounds: Aabb,
    center: Vec3,
    radius_m: f32,
    /// Direction from the group's centre to the eye, and its mirror direction about the cone's
    /// axis.
    to_eye: Vec3,
    mirror: Vec3,
    /// Spreads, radians.
    eye_spread: f32,
    mirror_spread: f32,
    alpha: [f32; 2],
    f0: f32,
    /// The greatest value of V cos.
    visibility: f32,
}

impl SeenGroup {
    /// The surfaces in a box whose normals lie in a cone.
    pub fn new(view: &View, bounds: Aabb, cone: &NormalCone, gloss: Gloss) -> Self {
        let uniform = view.uniform();
        let center = 0.5 * (bounds.min_world + bounds.max_world);
        let radius_m = center.distance(bounds.max_world) + bounds.slack_m;
        let (to_eye, eye_spread) = if uniform.perspective > 0.5 {
            let across = eye_world(&uniform) - center;
            (across / across.length().max(1e-20), spread_of(radius_m, across.length()))
        } else {
            let [x, y, z, _] = uniform.view_to_world[2];
            (Vec3::new(x, y, z), 0.0)
        };
        let half_angle = cone.sin_half.atan2(cone.cos_half);
        let n_dot_v = cone.axis.dot(to_eye);
        let alpha = gloss.roughness.map(|r| r.max(MIN_ROUGHNESS) * r.max(MIN_ROUGHNESS));
        let farthest = n_dot_v.abs().min(1.0).acos() + half_angle + eye_spread + ANGLE_SLACK;
        let cos_v = if farthest < 0.5 * PI { farthest.cos() } else { 0.0 };
        let alpha_2 = alpha[0] * alpha[0];
        Self {
            bounds,
            center,
            radius_m,
            to_eye,
            mirror: 2.0 * n_dot_v * cone.axis - to_eye,
            eye_spread,
            mirror_spread: 2.0 * half_angle + eye_spread + ANGLE_SLACK,
            alpha,
            f0: gloss.f0,
            visibility: 0.5 / (cos_v * cos_v * (1.0 - alpha_2) + alpha_2).sqrt(),
        }
    }

    /// An upper bound of the specular radiance that an area light adds to a sample of the group;
    /// infinite for points and spots.
    pub fn specular_bound(&self, light: &Light) -> f32 {
        let LightShape::Area(emitter) = &light.shape else { return f32::INFINITY };
        let volume = LightVolume::from(light);
        let area_m2 = emitter.area();
        let slack_m = self.bounds.slack_m + self.bounds.slack_per_m * volume.radius_m;
        let nearest = self.gap_to_outline(&volume, slack_m);
        let ratio_2 = nearest * nearest / (volume.range_m * volume.range_m);
        let window = (1.0 - ratio_2 * ratio_2).max(0.0);
        let scale = light.intensity.max_element() / area_m2 * window * window * self.visibility;
        let [x, y] = volume.half_axes;
        // A line's surface is curved towards the sample. At most half of it is visible, less than
        // twice its area.
        let is_line = volume.thick_m > 0.0 && x != Vec3::ZERO;
        let seen_m2 = if is_line { 2.0 * area_m2 } else { area_m2 };
        let whole = self.reflected_of(&volume, seen_m2, nearest, slack_m);

        let [long, short] = if x.length_squared() >= y.length_squared() { [x, y] } else { [y, x] };
        let count = pieces_of(long.length_squared(), short.length_squared());
        if count == 1 {
            return scale * whole;
        }
        let pieces = count as f32;
        // A polygon may fill its rectangle unevenly, but never fills a piece by more than the
        // piece's area.
        let piece_m2 = if is_line {
            // A piece at the end of a line has its round end, too.
            seen_m2.min(seen_m2 / pieces + 2.0 * PI * volume.thick_m * volume.thick_m)
        } else {
            area_m2.min(4.0 * OFF_SQUARE * long.length() * short.length() / pieces)
        };
        let sum: f32 = (0..count)
            .map(|ix| {
                let center = volume.center + ((2 * ix + 1) as f32 / pieces - 1.0) * long;
                let piece = LightVolume { center, half_axes: [long / pieces, short], ..volume };
                self.reflected_of(&piece, piece_m2, nearest, slack_m)
            })
            .sum();
        scale * whole.min(sum)
    }

    /// Distance between the group's box and the ball around the outline, metres.
    fn gap_to_ball(&self, volume: &LightVolume, slack_m: f32) -> f32 {
        let on_box = volume.center.clamp(self.bounds.min_world, self.bounds.max_world);
        let outline = OFF_SQUARE * volume.outline_radius();
        (volume.center.distance(on_box) - outline - slack_m).max(0.0)
    }

    /// Distance between the group's box and the outline, metres: the gap along the axis between the
    /// nearest points. It is at most the true distance, and at least the distance to the ball.
    fn gap_to_outline(&self, volume: &LightVolume, slack_m: f32) -> f32 {
        let closest = |point: Vec3| point.clamp(self.bounds.min_world, self.bounds.max_world);
        let mut on_box = closest(volume.center);
        let mut on_outline = volume.center;
        for _ in 0..PROJECTIONS {
            on_outline = volume.closest_on_outline(on_box);
            on_box = closest(on_outline);
        }
        let across = on_outline - on_box;
        let axis = across / across.length().max(1e-20);
        let off_plane = OFF_PLANE * OFF_SQUARE * volume.outline_radius();
        let extent = volume.outline_extent(axis) + off_plane;
        self.gap_to_ball(volume, slack_m).max(axis.dot(volume.center - on_box) - extent - slack_m)
    }

    /// An upper bound of solid angle times D times F for a piece of an emitter. The parameters are
    /// the piece's outline as a volume, the piece's area, and the least distance of the whole
    /// emitter.
    fn reflected_of(&self, volume: &LightVolume, area_m2: f32, least_m: f32, slack_m: f32) -> f32 {
        let nearest = least_m.max(self.gap_to_ball(volume, slack_m));
        let solid_angle = (2.0 * PI).min(area_m2 / (nearest * nearest).max(1e-20));

        let across = volume.center - self.center;
        let distance_m = across.length();
        let to_light = across / distance_m.max(1e-20);
        let outline = OFF_SQUARE * volume.outline_radius();
        let light_spread = spread_of(self.radius_m + outline + slack_m, distance_m);

        let off = angle_between(to_light, self.mirror) - self.mirror_spread - light_spread;
        let tilt = 0.5 * off.max(0.0);
        let sine_2 = tilt.sin() * tilt.sin();
        let alpha = tilt.min(1.57).tan().clamp(self.alpha[0], self.alpha[1]);
        let peak = alpha * alpha * (1.0 - sine_2) + sine_2;
        let distribution = alpha * alpha / (PI * peak * peak);

        let apart =
            angle_between(to_light, self.to_eye) + self.eye_spread + light_spread + ANGLE_SLACK;
        let fresnel = self.f0 + (1.0 - self.f0) * (1.0 - (0.5 * apart.min(PI)).cos()).powi(5);
        solid_angle * distribution * fresnel
    }
}

/// The most pieces of a long emitter.
const MOST_PIECES: u32 = 16;

/// The number of pieces, a power of two, into which an outline is cut so that each is about as long
/// as wide.
fn pieces_of(long_2: f32, short_2: f32) -> u32 {
    let mut pieces = 1;
    // A piece longer than 1.5 widths is halved.
    while pieces < MOST_PIECES && (pieces * pieces) as f32 * 2.25 * short_2 < long_2 {
        pieces *= 2;
    }
    pieces
}

/// Half the angle under which a ball is seen, radians; pi from inside.
fn spread_of(radius_m: f32, distance_m: f32) -> f32 {
    if radius_m < distance_m { (radius_m / distance_m).asin() } else { PI }
}

fn angle_between(a: Vec3, b: Vec3) -> f32 {
    a.dot(b).clamp(-1.0, 1.0).acos()
}
