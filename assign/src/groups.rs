//! What a strategy tells the culling driver about its groups: their shape, how they face, which live.

use crate::LiveGroups;

/// The shape of a strategy's groups, and with it the test.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GroupShape {
    /// A pixel rectangle and a depth range: `bounds_frustum.wesl`.
    Frustum,
    /// A box along the world's axes: `bounds_box.wesl`.
    Box,
    /// A box along axes of its own: `bounds_oriented_box.wesl`.
    OrientedBox,
}

/// What the kernel knows of how a group's surfaces face.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Facing {
    /// Nothing.
    #[default]
    Unknown,
    /// A cone around their normals, of groups that are boxes: the strategy's module has
    /// `group_facing(group: u32) -> NormalCone`, and lights that rise above no horizon are left
    /// out (`facing.wesl`).
    Horizon,
    /// The same, and how they reflect: `group_gloss(group: u32) -> Gloss`. Specular terms of area
    /// lights that add less than a threshold are left out (`gloss.wesl`). Lossy.
    HorizonAndGloss,
    /// How groups mirror light in the terms of Swarbrick 2025: `group_reflection(group: u32) ->
    /// Reflection`, of groups that are boxes. Where a light's diffuse term does not reach, its specular
    /// one is left out unless it is mirrored to the eye (`reflected.wesl`). Lossy.
    ReflectedCone,
    /// Nothing, and a light's specular term is left out where its diffuse term does not reach. Lossy.
    WhereDiffuse,
}

/// Which groups get a list in a frame.
#[derive(Clone, Copy, Debug)]
pub enum Groups<'a> {
    /// All of them: their number.
    All(u32),
    /// Those that the strategy's own pass appended.
    Live {
        /// Number of all groups, live or not.
        count: u32,
        /// The live ones.
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
