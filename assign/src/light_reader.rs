//! How shading reads a sample's lights one after the other: the WESL module `package::look_up`.

use crate::{AssignError, Gpu, LightSource, Storage};

/// WESL of tests against boxes along the world's axes. With the flag `lane_bounds`, each lane has a box of its
/// own, for look-ups that test lights; without, the workgroup has one.
pub const BOUNDS_BOX_WESL: &str = include_str!("shaders/bounds_box.wesl");

/// What reads the lights of a sample: which `package::look_up` a shader gets.
///
/// Each defines `struct LightCursor` with the field `entry`, `open_lights(sample: ViewSample) -> LightCursor`, and
/// `next_light(cursor: ptr<function, LightCursor>) -> bool`, which finds the next entry in ascending light index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum LightReader<'a> {
    /// Reads what the culling driver stored for the sample's group.
    Stored(Storage),
    /// Reads the lights that are in the bit masks of both groups of a sample: the strategy's module also defines
    /// `second_group_of(sample: ViewSample) -> u32`. If one is `ALL_LIGHTS`, both are.
    BothMasks,
    /// Reads no list: tests lights while it looks them up. The strategy's module defines `lights: Cull`, and
    /// `light_nodes: array<LightNode>` if lights come from the hierarchy.
    Walk {
        /// Who tests lights together.
        team: Team,
        /// Whether boxes around lights are tested before.
        source: LightSource,
    },
    /// The strategy's own.
    Own(&'a str),
}

/// Who tests lights together while looking them up.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Team {
    /// The lanes of a subgroup that look lights up at the same time: each tests one light, and the box around
    /// all their samples counts. It needs `wgpu::Features::SUBGROUP`.
    Subgroup,
    /// Each lane for itself.
    Lane,
}

impl<'a> LightReader<'a> {
    /// The same for another storage, if it reads what is stored for one group.
    #[must_use]
    pub const fn of_storage(self, storage: Storage) -> Self {
        match self {
            Self::Stored(_) => Self::Stored(storage),
            other => other,
        }
    }

    /// Whether samples of one group may read different lights.
    pub const fn is_per_sample(self) -> bool {
        !matches!(self, Self::Stored(Storage::Lists | Storage::Masks))
    }

    /// Whether it tests lights while it looks them up.
    const fn tests_lights(self) -> bool {
        matches!(self, Self::Stored(Storage::PrunedLists | Storage::Trees) | Self::Walk { .. })
    }

    /// Whether its shaders use subgroup operations. Fragment shaders must not: mount them with
    /// [`Shader::without_subgroups`](crate::Shader::without_subgroups).
    pub const fn needs_subgroups(self) -> bool {
        matches!(
            self,
            Self::Stored(Storage::PrunedLists | Storage::ScalarMasks)
                | Self::Walk { team: Team::Subgroup, .. }
        )
    }

    /// Checks that a device can run it. `strategy` is the strategy's id.
    ///
    /// # Errors
    ///
    /// [`AssignError::Unsupported`] if it needs subgroup operations, and the device has none.
    pub fn check(self, gpu: &Gpu, strategy: &str) -> Result<(), AssignError> {
        if self.needs_subgroups() && !gpu.has_subgroups() {
            return Err(AssignError::Unsupported {
                strategy: strategy.into(),
                asked: format!("the device {}", gpu.info.name),
                reason: "it has no subgroup operations (wgpu::Features::SUBGROUP)".into(),
            });
        }
        Ok(())
    }

    /// The most loop rounds of an invocation that looks so many lights up, besides those of its own loop over the
    /// lights. llvmpipe counts a round if any of 8 lanes takes it, and one for each loop that no lane enters.
    pub const fn loop_rounds(self, lights: u64) -> u64 {
        match self {
            // One round to test a light at most, and one to return it; 64 lights below a box take two more.
            Self::Stored(Storage::PrunedLists) | Self::Walk { .. } => 2 * lights + lights / 16 + 16,
            // One round to test a light, for each lane at another time.
            Self::Stored(Storage::Trees) => 8 * lights,
            // One for each light, one for each 64 lights and for each 2,048, and a few while a lane waits for others.
            Self::Stored(Storage::Masks | Storage::ScalarMasks) | Self::BothMasks => {
                lights + lights / 4 + 64
            }
            Self::Stored(Storage::Lists) | Self::Own(_) => 0,
        }
    }

    /// Checks that a device can read so many lights for a sample. llvmpipe ends an invocation's loops silently
    /// after a number of rounds.
    ///
    /// # Errors
    ///
    /// [`AssignError::Unsupported`] above that number.
    pub fn check_lights(self, gpu: &Gpu, strategy: &str, lights: u32) -> Result<(), AssignError> {
        // Its own round for each light, as the caller's loop has.
        let rounds = u64::from(lights) + self.loop_rounds(u64::from(lights));
        match gpu.max_loop_rounds() {
            Some(most) if self.tests_lights() && rounds > u64::from(most) => {
                Err(AssignError::Unsupported {
                    strategy: strategy.into(),
                    asked: format!("{lights} lights"),
                    reason: format!(
                        "{} ends loops silently after {most} rounds, and these may take {rounds}",
                        gpu.info.name
                    ),
                })
            }
            _ => Ok(()),
        }
    }

    /// Path and source of the module `package::look_up` and of what only it imports.
    pub(crate) fn modules(self) -> Vec<(&'static str, &'a str)> {
        let look_up = |source| ("package::look_up", source);
        match self {
            Self::Stored(Storage::Lists) => {
                vec![look_up(include_str!("shaders/look_up_list.wesl"))]
            }
            Self::Stored(Storage::Masks | Storage::ScalarMasks) | Self::BothMasks => {
                vec![look_up(include_str!("shaders/look_up_mask.wesl"))]
            }
            Self::Stored(Storage::Trees) => {
                vec![look_up(include_str!("shaders/look_up_tree.wesl"))]
            }
            Self::Stored(Storage::PrunedLists) | Self::Walk { .. } => vec![
                look_up(include_str!("shaders/look_up_walk.wesl")),
                ("package::lane_bounds", BOUNDS_BOX_WESL),
            ],
            Self::Own(source) => vec![look_up(source)],
        }
    }

    /// Name and value of each flag that these modules read.
    pub(crate) fn flags(self) -> Vec<(&'static str, bool)> {
        let walk = |team, source, listed| {
            vec![
                ("lane_bounds", true),
                ("subgroups", team == Team::Subgroup),
                ("walk_nodes", source == LightSource::Hierarchy),
                ("listed", listed),
            ]
        };
        let mask = |subgroups, both| vec![("subgroups", subgroups), ("both_masks", both)];
        match self {
            Self::Stored(Storage::PrunedLists) => walk(Team::Subgroup, LightSource::Linear, true),
            Self::Walk { team, source } => walk(team, source, false),
            Self::Stored(storage @ (Storage::Masks | Storage::ScalarMasks)) => {
                mask(storage == Storage::ScalarMasks, false)
            }
            Self::BothMasks => mask(false, true),
            Self::Stored(Storage::Lists | Storage::Trees) | Self::Own(_) => Vec::new(),
        }
    }
}
