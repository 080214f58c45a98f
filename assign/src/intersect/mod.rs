//! Intersection tests on the CPU: may a light reach a group?
//!
//! The culling kernel runs these tests in WESL; here they are in Rust, f32 for f32, under the same
//! names: [`Frustum`] is `bounds_frustum.wesl`, [`Aabb`] `bounds_box.wesl`, [`OrientedBox`]
//! `bounds_oriented_box.wesl`, [`NormalCone`] `facing.wesl`, [`SeenGroup`] `gloss.wesl`,
//! [`MirrorGroup`] `reflected.wesl`, and [`LightVolume`] what they share, `lights.wesl` and
//! `volume.wesl`.
//!
//! # The tests
//!
//! Enhuber 2019, section 3.5, for balls; every test is a search for an axis on which light and
//! group do not overlap, so a spot takes the same tests with its own extent along that axis
//! ([`LightVolume::extent_along`]), and one more: its cone against a sphere around the group
//! ([`LightVolume::cone_misses_sphere`]). A flat emitter extends by its outline as well, one-sided
//! as a cone of 90°; axes start at its point nearest to the group, and the group's farthest corner
//! is tried against its plane.
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
//! A frustum without far plane ([`UNBOUNDED`]) has no far corners: it takes HS alone, and without
//! HS rejects nothing.
//!
//! Nodes of the light hierarchy are boxes; `reaches_box` says of each shape whether a light whose
//! support lies in such a box may reach it.
//!
//! # Loose, never tight
//!
//! A test is *loose* where it says "reaches" of a light that does not: shading evaluates the light
//! and adds 0. It is *tight* where it says "misses" of a light that reaches a sample: the image is
//! wrong. Loose is allowed and measured; tight is a failure, in the last bit too, because a
//! lossless strategy shows the image of no culling bit for bit. So every comparison gives way by
//! a *slack* for each of these roundings:
//!
//! 1. A sample's position, rebuilt from depth, is off by up to
//!    [`ViewUniform::position_error`](crate::ViewUniform::position_error) metres per metre of its
//!    distance from the world's origin and from the eye, and so are a group's corners and planes:
//!    `slack_m`, from the group and the camera. It is metres a thousand kilometres from the
//!    origin, and micrometres in a room.
//! 2. The test's own distances are off by as much per metre of the light's range, and, where the
//!    group has no far end that would bound its samples, of the light's distance from the origin:
//!    `slack_per_m`.
//! 3. Shading compares squared chords to find a cone's edge, which for a narrow cone moves the edge
//!    by more than any position is off: [`LightVolume`] widens the cone by that angle.
//!
//! # How loose
//!
//! Share of hits that are false, per cent: the light is certainly apart from the frustum or the
//! box, in f64. Clusters of 64x64 pixels at 1920x1080 and 24 exponential slices from 0.1 to 100 m,
//! their boxes along the world's axes and along the view's; lights uniform in a box of Sponza's
//! size, ranges of the comparison's gamma distribution, random directions, emitters one-sided with
//! half axes of 0.1 to 1 m; 600 clusters, 8,000 lights of each kind. Of a polygon the smallest
//! rectangle around it is tested. A box is no better a bound than the frustum in it: these are the tests'
//! errors, not the bounds'.
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
//! Measured on 2026-11-25 by `cargo test -p assign --test intersect rates -- --nocapture`, which
//! fails where this table is off by more than 0.3.

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

/// View depth from which on a frustum has no far plane, metres: `UNBOUNDED` of
/// `bounds_frustum.wesl`.
pub const UNBOUNDED: f32 = 3.4e38;

/// What rounding grows with in a test of a box around lights, metres: no less than the distance
/// from the origin and the range of any light in it.
fn box_magnitude(min_world: Vec3, max_world: Vec3) -> f32 {
    min_world.abs().max(max_world.abs()).element_sum() + min_world.distance(max_world)
}

/// World-space position of the camera.
fn eye_world(uniform: &ViewUniform) -> Vec3 {
    let [x, y, z, _] = uniform.view_to_world[3];
    Vec3::new(x, y, z)
}
