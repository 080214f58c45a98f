//! Intersection tests on the CPU: may a light reach a group?
//!
//! The culling kernel runs these tests in WESL. This module has them in Rust with the same f32
//! operations and the same names: [`Frustum`] is `bounds_frustum.wesl`, [`Aabb`] `bounds_box.wesl`,
//! [`OrientedBox`] `bounds_oriented_box.wesl`, [`NormalCone`] `facing.wesl`, [`SeenGroup`]
//! `gloss.wesl`, [`MirrorGroup`] `reflected.wesl`. [`LightVolume`] is what they share:
//! `lights.wesl` and `volume.wesl`.
//!
//! # The tests
//!
//! For balls the tests are those of Enhuber 2019, section 3.5. Every test searches for an axis on
//! which light and group do not overlap. So a spot takes the same tests with its own extent along
//! the axis ([`LightVolume::extent_along`]). One test is added: its cone against a sphere around
//! the group ([`LightVolume::cone_misses_sphere`]). A flat emitter extends by its outline too, and
//! a one-sided one is a cone of 90°. For emitters, axes start at the point nearest to the group,
//! and the group's farthest corner is tested against the emitter's plane.
//!
//! | group | test | axes |
//! |---|---|---|
//! | frustum | HS | the normals of its planes |
//! | frustum | SAT-E | the directions of its edges |
//! | frustum | SAT-N | from the light to its nearest corner |
//! | frustum | SAT-P | the normals of its planes, both ends |
//! | frustum | SAT-V | from the light to every corner |
//! | box | NP | from its nearest point to the light |
//! | oriented box | NPT | the same in the box's frame |
//!
//! A frustum without a far plane ([`UNBOUNDED`]) has no far corners. It takes only HS, and rejects
//! nothing if HS is off.
//!
//! Nodes of the light hierarchy are boxes. Each shape's `reaches_box` says whether a light whose
//! support lies in such a box may reach the group.
//!
//! # Loose, never tight
//!
//! A test is *loose* if it says "reaches" for a light that does not reach: shading evaluates the
//! light and adds 0. A test is *tight* if it says "misses" for a light that reaches a sample: the
//! image is wrong. Loose is allowed and measured. Tight is a failure, even in the last bit, because
//! a lossless strategy shows the image of no culling bit for bit. So every comparison adds a
//! *slack* for each of these roundings:
//!
//! 1. `slack_m`, from the group and the camera: a sample's position, rebuilt from depth, is off by
//!    up to [`ViewUniform::position_error`](crate::ViewUniform::position_error) metres per metre of
//!    its distance from the world's origin and from the eye. So are a group's corners and planes.
//!    This slack is metres at 1,000 km from the origin, and micrometres in a room.
//! 2. `slack_per_m`: the test's own distances are off by as much per metre of the light's range. If
//!    the group has no far end that bounds its samples, the light's distance from the origin counts
//!    too.
//! 3. An angle by which [`LightVolume`] widens the cone: shading compares squared chords to find a
//!    cone's edge. For a narrow cone their rounding moves the edge by more than any position is
//!    off.
//!
//! # How loose
//!
//! The table shows the share of false hits, per cent: in f64 the light is certainly apart from the
//! frustum or the box. The groups are 600 clusters of 64x64 pixels at 1920x1080 with 24 exponential
//! slices from 0.1 to 100 m, and their boxes along the world's axes and along the view's. The
//! lights, 8,000 of each kind, are uniform in a box of Sponza's size, with ranges from the
//! comparison's gamma distribution and random directions. Emitters are one-sided with half axes of
//! 0.1 to 1 m; a polygon is tested as the smallest rectangle around it. The table shows the error
//! of the tests, not of the bounds: the frustum in a box is the tighter bound.
//!
//! | test | point | spot 15° | spot 45° | spot 75° | spot 90° | rectangle | triangle | hexagon |
//! |---|---|---|---|---|---|---|---|---|
//! | frustum, HS | 36.0 | 21.7 | 25.7 | 32.0 | 34.8 | 31.9 | 36.2 | 37.0 |
//! | frustum, SAT-E | 60.3 | 71.5 | 64.1 | 61.8 | 61.3 | 55.3 | 58.7 | 58.9 |
//! | frustum, SAT-N | 53.5 | 86.7 | 76.1 | 66.6 | 63.0 | 43.9 | 49.6 | 48.6 |
//! | frustum, SAT-P | 35.1 | 21.4 | 25.0 | 31.3 | 34.0 | 31.1 | 35.5 | 36.3 |
//! | frustum, SAT-V | 41.1 | 79.7 | 66.0 | 55.0 | 51.1 | 32.5 | 39.2 | 38.2 |
//! | frustum, HS+SAT-N | 6.5 | 20.4 | 15.2 | 14.5 | 14.1 | 8.2 | 15.0 | 15.3 |
//! | frustum, HS+SAT-E+SAT-P+SAT-V | 5.5 | 17.6 | 12.8 | 12.3 | 12.1 | 6.5 | 13.6 | 13.7 |
//! | box, NP | 0.0 | 16.7 | 12.5 | 7.6 | 5.8 | 2.1 | 8.6 | 7.3 |
//! | oriented box, NPT | 0.0 | 16.5 | 11.5 | 7.5 | 5.5 | 2.0 | 8.8 | 7.3 |
//!
//! Measured on 2026-11-25 by `cargo test -p lightbench-assign --test intersect rates -- --nocapture`. That
//! test fails if this table is off by more than 0.3.

mod aabb;
mod facing;
mod frustum;
mod gloss;
mod oriented_box;
mod reflected;
mod volume;

use glam::Vec3;

pub use aabb::Aabb;
pub use facing::NormalCone;
pub use frustum::Frustum;
pub use gloss::{Gloss, SeenGroup};
pub use oriented_box::OrientedBox;
pub use reflected::MirrorGroup;
pub use volume::LightVolume;

use crate::ViewUniform;

/// A frustum that ends at this view depth or beyond has no far plane, metres: `UNBOUNDED` of
/// `bounds_frustum.wesl`.
pub const UNBOUNDED: f32 = 3.4e38;

/// The length with which rounding grows in a test of a box around lights, metres. It is at least
/// the distance from the origin and the range of every light in the box.
fn box_magnitude(min_world: Vec3, max_world: Vec3) -> f32 {
    min_world.abs().max(max_world.abs()).element_sum() + min_world.distance(max_world)
}

/// World-space position of the camera.
fn eye_world(uniform: &ViewUniform) -> Vec3 {
    let [x, y, z, _] = uniform.view_to_world[3];
    Vec3::new(x, y, z)
}
