//! Fits a camera path to any scene.
//!
//! 1. Points spread over the core look around by casting rays against the scene's triangles. Points
//!    inside solids, which see back faces, or close to walls drop out.
//! 2. Each direction from each remaining point gets a score: how good would a picture from there
//!    be?
//! 3. The best views get a loop around a point ahead of them: the largest ellipse that keeps clear
//!    of all triangles. The view with the best product of score and loop wins.
//! 4. Its loop is bent, so that it climbs, sinks and weaves ([`tour`](crate::tour)).

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::{Vec2, Vec3};
use rayon::prelude::*;

use crate::{
    Aabb, CameraPath, Pose, Scene,
    bvh::TriangleBvh,
    extent::MAX_SAMPLES,
    picture::{AZIMUTHS, Column, picture_score},
    tour::Room,
};

/// The view of a scene before its path is fitted.
pub(crate) const ORIGIN: Pose = Pose::looking(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y);

/// The number of points that look around, along x, y and z.
const GRID: [u32; 3] = [14, 5, 14];

/// The elevations at which each point looks around at every azimuth, degrees.
const ELEVATIONS: [f32; 7] = [-36.0, -24.0, -12.0, -2.0, 8.0, 18.0, 28.0];

/// A point with more empty azimuths than this stands outside the scene.
const MAX_OPEN: usize = AZIMUTHS / 3;

/// The number of views whose loops are tried.
const FINALISTS: usize = 40;

/// The most lights of the scene by which a view is rated.
const MAX_LAMPS: usize = 256;

/// Knots of a loop. They are enough to pass between two columns and back.
const KNOTS: usize = 48;

/// A path through the core that shows much of the scene. It starts at the scene's first camera if
/// there is one.
pub(crate) fn path(scene: &Scene) -> CameraPath {
    let core = scene.core_bounds;
    let region = core.grown(0.25 * core.diagonal()).intersection(scene.bounds.grown(1.0));
    let fit = Fit {
        bvh: TriangleBvh::new(scene, region),
        core,
        reach_m: core.diagonal().max(f32::MIN_POSITIVE),
        middle_height: middle_height(scene),
        margin_m: 0.03 * core.size().min_element(),
        lamps: lamps(scene),
    };
    if let Some(camera) = scene.cameras.first() {
        return fit.path_from(&camera.pose);
    }
    let mut views = fit.views();
    views.sort_by(|a, b| b.score.total_cmp(&a.score));
    views.truncate(FINALISTS);
    let rated = views.iter().map(|view| {
        let ellipse = fit.ellipse(view.eye, view.heading());
        let size = (ellipse.x + 2.0 * ellipse.y) / fit.reach_m;
        (view.score * (0.1 + size).sqrt(), view, ellipse)
    });
    match rated.max_by(|a, b| a.0.total_cmp(&b.0)) {
        Some((_, view, ellipse)) => {
            // Where there is much sky, look down.
            let pitch = -0.05 - 0.25 * view.sky;
            fit.tour(view.eye, view.heading(), pitch, ellipse)
        }
        None => orbit(core),
    }
}

/// Position and range of the scene's own usable lights, at most [`MAX_LAMPS`] of them, evenly chosen.
fn lamps(scene: &Scene) -> Vec<(Vec3, f32)> {
    let usable: Vec<_> = scene.lights.iter().filter(|light| light.check().is_ok()).collect();
    let step = usable.len().div_ceil(MAX_LAMPS).max(1);
    usable.iter().step_by(step).map(|light| (light.position, light.range_m)).collect()
}

/// The median height of the triangles' corners.
fn middle_height(scene: &Scene) -> f32 {
    let sample = scene.sampled_triangles(MAX_SAMPLES);
    let mut heights: Vec<f32> = sample.map(|[a, ..]| a.y).collect();
    let middle = heights.len() / 2;
    if heights.is_empty() {
        return 0.0;
    }
    *heights.select_nth_unstable_by(middle, f32::total_cmp).1
}

/// A place to look from, and how good its picture would be.
struct View {
    eye: Vec3,
    azimuth: f32,
    score: f32,
    /// The share of rays that hit nothing.
    sky: f32,
}

impl View {
    fn heading(&self) -> Vec3 {
        direction(self.azimuth, 0.0)
    }
}

fn direction(azimuth: f32, elevation: f32) -> Vec3 {
    let (sin, cos) = azimuth.sin_cos();
    Vec3::new(cos, 0.0, sin) * elevation.cos() + Vec3::Y * elevation.sin()
}

struct Fit {
    bvh: TriangleBvh,
    core: Aabb,
    /// The length of rays, metres.
    reach_m: f32,
    /// Half the triangles lie below this height, metres.
    middle_height: f32,
    /// The least distance between the camera and any triangle, metres.
    margin_m: f32,
    /// Position and range of the scene's own lights. A view should show what they light.
    lamps: Vec<(Vec3, f32)>,
}

impl Fit {
    /// The best view of every usable point of a jittered grid over the core.
    fn views(&self) -> Vec<View> {
        let [nx, ny, nz] = GRID;
        // The region leaves out the rims, what lies below most of the geometry, and the roofs.
        // Where the scene has lights, it is the region that they reach.
        let size = self.core.size();
        let mut region = Aabb::new(self.core.min + 0.1 * size, self.core.max - 0.1 * size);
        let reached = |(at, range): &(Vec3, f32)| Aabb::new(*at - *range, *at + *range);
        let lit = self.lamps.iter().map(reached).fold(Aabb::EMPTY, Aabb::union);
        let lit_region = region.intersection(lit);
        if !lit_region.is_empty() {
            region = lit_region;
        }
        if lit_region.is_empty() {
            let size = self.core.size();
            region.min.y = self.middle_height.clamp(self.core.min.y, self.core.max.y);
            region.min.y -= 0.1 * size.y;
            region.max.y = self.core.min.y + 0.65 * size.y;
            region.max.y = region.max.y.max(region.min.y + 0.2 * size.y);
        }
        (0..nx * ny * nz)
            .into_par_iter()
            .filter_map(|ix| {
                let cell =
                    Vec3::new((ix % nx) as f32, (ix / nx % ny) as f32, (ix / nx / ny) as f32);
                // Jitter by Halton points in bases 2, 3 and 5.
                let jitter = Vec3::new(halton(ix, 2), halton(ix, 3), halton(ix, 5));
                let at = (cell + jitter) / Vec3::new(nx as f32, ny as f32, nz as f32);
                self.look_around(region.min + region.size() * at)
            })
            .collect()
    }

    /// The best view from `eye`; `None` where it is too close to a wall or inside a solid.
    fn look_around(&self, eye: Vec3) -> Option<View> {
        if self.bvh.clearance(eye, 2.0 * self.margin_m) < 2.0 * self.margin_m {
            return None;
        }
        let mut columns = [Column::default(); AZIMUTHS];
        let (mut hits, mut back_hits) = (0, 0);
        for (ix, column) in columns.iter_mut().enumerate() {
            for elevation in ELEVATIONS {
                let along = direction(azimuth(ix), elevation.to_radians());
                match self.bvh.cast(eye, along, self.reach_m) {
                    Some(hit) => {
                        hits += 1;
                        back_hits += usize::from(hit.is_back);
                        column.add(hit.distance_m / self.reach_m);
                        column.lit += self.lit(eye + along * hit.distance_m);
                    }
                    None => column.misses += 1.0,
                }
            }
        }
        let open = columns.iter().filter(|column| column.hits == 0.0).count();
        if hits == 0 || back_hits * 4 > hits || open > MAX_OPEN {
            return None;
        }
        let best = (0..AZIMUTHS)
            .map(|middle| (picture_score(&columns, middle, !self.lamps.is_empty()), middle))
            .max_by(|a, b| a.0.total_cmp(&b.0))?;
        // Back faces indicate open or inside-out geometry nearby.
        let front_share = 1.0 - back_hits as f32 / hits as f32;
        Some(View {
            eye,
            azimuth: azimuth(best.1),
            score: best.0 * front_share,
            sky: 1.0 - hits as f32 / (AZIMUTHS * ELEVATIONS.len()) as f32,
        })
    }

    /// 1 where one of the scene's own lights reaches `point`, else 0.
    fn lit(&self, point: Vec3) -> f32 {
        let reaches = |(at, range): &(Vec3, f32)| at.distance_squared(point) < 0.5 * range * range;
        f32::from(self.lamps.iter().any(reaches))
    }

    /// The semi-axes, ahead and sideways, of the largest ellipse that starts at `eye`, has its
    /// middle ahead and keeps its margin. They are zero if there is none.
    fn ellipse(&self, eye: Vec3, heading: Vec3) -> Vec2 {
        let longest = 0.5 * self.reach_m;
        let mut best = Vec2::ZERO;
        for step in (1..=16).rev() {
            let ahead = longest * step as f32 / 16.0;
            for ratio in [0.7, 0.4, 0.2, 0.1] {
                let axes = Vec2::new(ahead, ahead * ratio);
                if axes.element_sum() > best.element_sum() && self.is_clear(eye, heading, axes) {
                    best = axes;
                }
            }
        }
        best
    }

    fn is_clear(&self, eye: Vec3, heading: Vec3, axes: Vec2) -> bool {
        // Points no further apart than the margin, so that no part between them touches a triangle.
        let points = (TAU * axes.max_element() / self.margin_m.max(1e-12)).clamp(16.0, 600.0);
        let room = self.room();
        (0..points as u32)
            .all(|ix| room.is_free(on_ellipse(eye, heading, axes, TAU * ix as f32 / points)))
    }

    fn room(&self) -> Room<'_> {
        Room { bvh: &self.bvh, core: self.core, margin_m: self.margin_m }
    }

    /// Goes around the ellipse once and turns once, so that the camera always looks across it. The
    /// eye leaves the ellipse where there is room; the point that it looks at stays on it.
    fn tour(&self, eye: Vec3, heading: Vec3, pitch: f32, axes: Vec2) -> CameraPath {
        let right = heading.cross(Vec3::Y);
        let angle = |ix: usize| TAU * ix as f32 / KNOTS as f32;
        let level: Vec<Vec3> =
            (0..KNOTS).map(|ix| on_ellipse(eye, heading, axes, angle(ix))).collect();
        let eyes = self.room().bend(&level);
        let knots = eyes.into_iter().zip(level).enumerate().map(|(ix, (eye, at))| {
            let (sin, cos) = angle(ix).sin_cos();
            let across = heading * cos - right * sin + Vec3::Y * pitch;
            (eye, at + across * (0.25 * self.reach_m))
        });
        CameraPath::closed_loop(knots.collect(), Pose::new(eye, eye + heading))
    }

    fn path_from(&self, pose: &Pose) -> CameraPath {
        let forward = pose.forward();
        let flat = Vec3::new(forward.x, 0.0, forward.z);
        let Some(heading) = flat.try_normalize().filter(|_| flat.length() > 0.1) else {
            return CameraPath::still(*pose);
        };
        let pitch = forward.y / flat.length();
        self.tour(pose.eye, heading, pitch, self.ellipse(pose.eye, heading))
    }
}

fn azimuth(ix: usize) -> f32 {
    TAU * ix as f32 / AZIMUTHS as f32
}

/// The point at `angle` of the level ellipse that starts at `eye` and has its middle ahead.
fn on_ellipse(eye: Vec3, heading: Vec3, axes: Vec2, angle: f32) -> Vec3 {
    let right = heading.cross(Vec3::Y);
    let (sin, cos) = angle.sin_cos();
    eye + heading * (axes.x * (1.0 - cos)) + right * (axes.y * sin)
}

/// The radical inverse of `ix` in `base`.
fn halton(ix: u32, base: u32) -> f32 {
    let (mut rest, mut digit, mut value) = (ix + 1, 1.0, 0.0);
    while rest > 0 {
        digit /= base as f32;
        value += digit * (rest % base) as f32;
        rest /= base;
    }
    value
}

/// A path around an object that cannot be entered, from a distance that fills the picture, slightly
/// above.
fn orbit(around: Aabb) -> CameraPath {
    let center = around.center();
    let radius = 0.85 * around.diagonal();
    let knots = (0..KNOTS).map(|ix| {
        let angle = 0.5 * FRAC_PI_2 + TAU * ix as f32 / KNOTS as f32;
        (center + radius * direction(angle, PI / 9.0), center)
    });
    CameraPath::closed_loop(knots.collect(), Pose::new(center + Vec3::Z * radius, center))
}
