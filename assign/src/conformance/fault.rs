//! The faults that the suite plants, and where each must show.

use super::violation::Breach;

/// A fault that is planted in a working strategy.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fault {
    /// The last entry of every list is missing.
    DroppedLight,
    /// The first two entries of every list are swapped.
    ShuffledList,
    /// The first entry of every list is a copy of the second.
    Repeated,
    /// The last entry of every list names a light that does not exist.
    ForeignLight,
    /// The first entry of every list has lost its flags.
    LostTerms,
    /// The last entry of every list lacks the flag of the diffuse term.
    LostDiffuse,
    /// Lists are made with horizons that are a little too high.
    HighHorizon,
    /// Every list ends beyond the buffer.
    RunawayList,
    /// Lists are made from lights with 0.9 times their range.
    ShrunkenBound,
    /// Lists are made from points at the centres of area lights.
    CentredEmitter,
    /// Lists are made from emitters with 0.95 times their size. Coarse groups may hide it.
    TightEmitter,
    /// Lists are made from spots with half their half angle.
    NarrowCone,
    /// Lists are made from virtual point lights that shine only into a cone of 45 degrees.
    NarrowHalfSpace,
    /// Lists are no longer made once the lights have moved.
    StaleLists,
    /// Every other frame lacks entries.
    Flicker,
    /// Entries are missing in frames with faulty lights.
    LeakyQuarantine,
    /// Record 0 lacks a light.
    Record0,
    /// Groups that overflow are not counted.
    SilentOverflow,
    /// The pool never grows.
    StarvedPool,
    /// No frame is recorded at all.
    Unrecorded,
    /// `group_of` returns a group that does not exist.
    LostGroup,
    /// Shading gets the bind group of the first frame in every frame.
    StaleBinding,
    /// The first slot of lights that the GPU orders has a copy of the light of the second.
    CopiedSlot,
    /// The first box of the third level of the hierarchy holds no light. It shows with strategies that
    /// read the hierarchy.
    LostGrandparent,
}

impl Fault {
    /// All faults of a strategy that show with groups of any size: all but
    /// [`TightEmitter`](Self::TightEmitter), and without those in the order of the lights,
    /// [`CopiedSlot`](Self::CopiedSlot) and [`LostGrandparent`](Self::LostGrandparent).
    pub const ALL: [Self; 21] = [
        Self::DroppedLight,
        Self::ShuffledList,
        Self::Repeated,
        Self::ForeignLight,
        Self::LostTerms,
        Self::LostDiffuse,
        Self::HighHorizon,
        Self::RunawayList,
        Self::ShrunkenBound,
        Self::CentredEmitter,
        Self::NarrowCone,
        Self::NarrowHalfSpace,
        Self::StaleLists,
        Self::Flicker,
        Self::LeakyQuarantine,
        Self::Record0,
        Self::SilentOverflow,
        Self::StarvedPool,
        Self::Unrecorded,
        Self::LostGroup,
        Self::StaleBinding,
    ];

    /// The case that must reject the fault, and the promise that it breaks there.
    pub fn shows_in(self) -> (&'static str, Breach) {
        match self {
            Self::DroppedLight => ("33-lights", Breach::MissedPair),
            Self::ShuffledList => ("33-lights", Breach::NotAscending),
            Self::Repeated => ("33-lights", Breach::Repeated),
            Self::ForeignLight => ("33-lights", Breach::ForeignLight),
            Self::LostTerms => ("33-lights", Breach::NoTerm),
            Self::LostDiffuse => ("33-lights", Breach::MissedPair),
            Self::HighHorizon => ("lights-at-horizon", Breach::MissedPair),
            Self::RunawayList => ("33-lights", Breach::OutsideBuffer),
            Self::ShrunkenBound => ("light-at-tile-corner", Breach::MissedPair),
            Self::CentredEmitter | Self::TightEmitter => {
                ("area-lights-grazing", Breach::MissedPair)
            }
            Self::NarrowCone => ("spots-45", Breach::MissedPair),
            Self::NarrowHalfSpace => ("mixed-kinds", Breach::MissedPair),
            Self::StaleLists => ("lights-move", Breach::MissedPair),
            Self::Flicker => ("33-lights", Breach::Unstable),
            Self::LeakyQuarantine => ("quarantine", Breach::Quarantine),
            Self::Record0 => ("33-lights", Breach::Record0),
            Self::SilentOverflow => ("overflow", Breach::Counters),
            Self::StarvedPool => ("overflow", Breach::OverflowStays),
            Self::Unrecorded => ("33-lights", Breach::Record0),
            Self::LostGroup => ("33-lights", Breach::NoSuchGroup),
            Self::StaleBinding => ("light-count-changes", Breach::Lookup),
            Self::CopiedSlot => ("lights-from-gpu", Breach::Slots),
            Self::LostGrandparent => ("three-levels-of-nodes", Breach::MissedPair),
        }
    }

    /// The first stage of its case in which the fault may show. Stale lists are right until the
    /// lights move.
    pub fn shows_from_stage(self) -> u32 {
        match self {
            Self::StaleLists => 1,
            _ => 0,
        }
    }

    /// Whether the fault needs a strategy with groups.
    pub fn needs_groups(self) -> bool {
        matches!(
            self,
            Self::ShrunkenBound
                | Self::CentredEmitter
                | Self::TightEmitter
                | Self::NarrowCone
                | Self::NarrowHalfSpace
                | Self::StaleLists
                | Self::Record0
                | Self::SilentOverflow
                | Self::StarvedPool
                | Self::Unrecorded
                | Self::StaleBinding
        )
    }

    /// All faults of a strategy with groups; `normals` says whether it reads normals.
    pub fn all(normals: bool) -> Vec<Self> {
        Self::ALL.into_iter().filter(|fault| normals || !fault.needs_normals()).collect()
    }

    /// Whether the fault needs lists with entries and a pool.
    pub fn needs_entries(self) -> bool {
        matches!(
            self,
            Self::ShuffledList
                | Self::Repeated
                | Self::ForeignLight
                | Self::LostTerms
                | Self::LostDiffuse
                | Self::SilentOverflow
                | Self::StarvedPool
        )
    }

    /// Whether the fault needs a strategy that reads normals.
    pub fn needs_normals(self) -> bool {
        self == Self::HighHorizon
    }

    /// Whether the strategy gets altered lights.
    pub(super) fn alters_lights(self) -> bool {
        matches!(
            self,
            Self::ShrunkenBound
                | Self::CentredEmitter
                | Self::TightEmitter
                | Self::NarrowCone
                | Self::NarrowHalfSpace
                | Self::HighHorizon
        )
    }

    /// What `fault.wesl` does in a frame; 0 does nothing.
    pub(super) fn kernel_kind(self, frame: u32, rejected: bool) -> u32 {
        match self {
            Self::DroppedLight => 1,
            Self::ShuffledList => 2,
            Self::Repeated => 3,
            Self::ForeignLight => 4,
            Self::LostTerms => 5,
            Self::RunawayList => 6,
            Self::Record0 => 7,
            Self::SilentOverflow => 8,
            Self::LostDiffuse => 9,
            Self::Flicker => frame % 2,
            Self::LeakyQuarantine => u32::from(rejected),
            _ => 0,
        }
    }
}
