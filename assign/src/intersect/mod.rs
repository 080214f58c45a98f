//! Intersection tests on the CPU: may a light reach a group?
//!
//! The culling kernel runs these tests in WESL; here they are in Rust, f32 for f32, under the same
//! names: [`Frustum`] is `bounds_frustum.wesl`, [`Aabb`] `bounds_box.wesl`, [`OrientedBox`]
//! `bounds_oriented_box.wesl`, and [`LightVolume`] what they share, `lights.wesl` and
//! `volume.wesl`.
//!
//! # The tests
//!
//! Enhuber 2019, section 3.5, for balls; every test is a search for an axis on which light and
//! group do not overlap, so a spot takes the same tests with its own extent along that axis
//! ([`LightVolume::extent_along`]), and one more: its cone against a sphere around the group
//! ([`LightVolume::cone_misses_sphere`]).
//!
//! | group | test | axes |
//! |---|---|---|
//! | frustum | HS | the normals of its planes |
//! | frustum | SAT-N | from its nearest corner to the light |
//! | box | NP | from its nearest point to the light |
//! | oriented box | NPT | the same in the box's frame |
//!
//! A frustum without far plane ([`UNBOUNDED`]) has no far corners: it takes HS alone.
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
//! 3. Shading compares cosines to find a cone's edge, which for a narrow cone moves the edge
//!    by more than any position is off: [`LightVolume`] widens the cone by that angle.
//!
//! # How loose
//!
//! Share of hits that are false, per cent: the light is certainly apart from the frustum or the
//! box, in f64. Clusters of 64x64 pixels at 1920x1080 and 24 exponential slices from 0.1 to 100 m,
//! their boxes along the world's axes and along the view's; lights uniform in a box of Sponza's
//! size, ranges of the comparison's gamma distribution, random directions; 600 clusters, 8,000
//! lights of each kind. A box is no better a bound than the frustum in it: these are the tests'
//! errors, not the bounds'.
//!
//! | test | point | spot 15° | spot 45° | spot 75° | spot 90° |
//! |---|---|---|---|---|---|
//! | frustum, HS | 36.0 | 21.7 | 25.7 | 32.0 | 34.8 |
//! | frustum, HS+SAT-N | 6.5 | 20.4 | 15.2 | 14.5 | 14.1 |
//! | box | 0.0 | 16.7 | 12.5 | 7.6 | 5.8 |
//! | oriented box | 0.0 | 16.5 | 11.5 | 7.5 | 5.5 |
//!
//! Measured on 2026-11-22 by `cargo test -p assign --test intersect rates -- --nocapture`, which
//! fails where this table is off by more than 0.3.

mod aabb;
mod frustum;
mod oriented_box;
mod volume;

use glam::Vec3;

pub use aabb::Aabb;
pub use frustum::Frustum;
pub use oriented_box::OrientedBox;
pub use volume::LightVolume;

use crate::ViewUniform;

/// View depth from which on a frustum has no far plane, metres: `UNBOUNDED` of
/// `bounds_frustum.wesl`.
pub const UNBOUNDED: f32 = 3.4e38;

/// World-space position of the camera.
fn eye_world(uniform: &ViewUniform) -> Vec3 {
    let [x, y, z, _] = uniform.view_to_world[3];
    Vec3::new(x, y, z)
}
