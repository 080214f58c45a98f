//! What a strategy tells the culling driver about its groups: their shape, how they face, which live.

use crate::LiveGroups;

/// The shape of a strategy's groups. It decides which tests run.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GroupShape {
    /// A pixel rectangle and a depth range: `bounds_frustum.wesl`.
    Frustum,
    /// The same, with a mask of the depth slices that hold samples: [`Frustum`](Self::Frustum) with the flag
    /// `depth_mask`. A light is listed only if it reaches such a slice.
    MaskedFrustum,
    /// A box along the world's axes: `bounds_box.wesl`.
    Box,
    /// A box along axes of its own: `bounds_oriented_box.wesl`.
    OrientedBox,
}

/// What the kernel knows about the directions in which a group's surfaces face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Facing {
    /// Nothing.
    #[default]
    Unknown,
    /// A cone around the normals of groups that are boxes. The strategy's module has
    /// `group_facing(group: u32) -> NormalCone`. Lists omit lights below the horizon of every
    /// surface (`facing.wesl`).
    Horizon,
    /// `Horizon`, and how the surfaces reflect: `group_gloss(group: u32) -> Gloss`. Lists omit
    /// specular terms of area lights that add less than a threshold (`gloss.wesl`). Lossy.
    HorizonAndGloss,
    /// How groups that are boxes mirror light, after Swarbrick 2025: `group_reflection(group: u32)
    /// -> Reflection`. Where a light's diffuse term does not reach, lists omit its specular term
    /// unless the group mirrors it to the eye (`reflected.wesl`). Lossy.
    ReflectedCone,
    /// Nothing. Lists omit a light's specular term where its diffuse term does not reach. Lossy.
    WhereDiffuse,
    /// How polished the surfaces of groups that are boxes are: `group_reach(group: u32) -> f32`, the greatest
    /// `specular_reach_bound` of a group's samples (`specular_reach.wesl`). Beyond their range, points and spots are
    /// listed for their specular term, out to that many ranges.
    SpecularReach,
}

/// Which groups get a list in a frame.
#[derive(Clone, Copy, Debug)]
pub enum Groups<'a> {
    /// All groups; the value is their number.
    All(u32),
    /// The groups that the strategy's own pass appended.
    Live {
        /// Number of all groups, live or not.
        count: u32,
        /// The live groups.
        live: &'a LiveGroups,
    },
}

impl Groups<'_> {
    /// Number of all groups, live or not.
    pub(crate) fn count(&self) -> u32 {
        match self {
            Self::All(count) | Self::Live { count, .. } => *count,
        }
    }
}
