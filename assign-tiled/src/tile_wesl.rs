//! The WESL of tiles: one module, the flags of each variant, and what finds a tile's range of depths.

use assign::{LightReader, Storage, StrategyWesl};

use crate::TileDepths;

/// The WESL of tiles: `group_of` and `group_bounds`.
pub const fn tile_wesl(depths: TileDepths) -> StrategyWesl<'static> {
    match depths {
        TileDepths::Implicit => IMPLICIT,
        TileDepths::Explicit => EXPLICIT,
        TileDepths::ExplicitAtOnce => AT_ONCE,
        TileDepths::HalfZ | TileDepths::ModifiedHalfZ => HALVES,
        TileDepths::Sliced => SLICED,
    }
}

const RANGE: (&str, &str) = ("package::strategy::range", include_str!("shaders/tile_range.wesl"));

const IMPLICIT: StrategyWesl<'static> = tiles_wesl(
    &[("explicit_bounds", false), ("one_pass", false), ("halves", false), ("sliced", false)],
    &[],
);
const EXPLICIT: StrategyWesl<'static> = tiles_wesl(
    &[("explicit_bounds", true), ("one_pass", false), ("halves", false), ("sliced", false)],
    &[RANGE],
);
const AT_ONCE: StrategyWesl<'static> = tiles_wesl(
    &[("explicit_bounds", false), ("one_pass", true), ("halves", false), ("sliced", false)],
    &[RANGE, ("package::strategy::by_lanes", include_str!("shaders/by_lanes.wesl"))],
);
const HALVES: StrategyWesl<'static> = tiles_wesl(
    &[("explicit_bounds", true), ("one_pass", false), ("halves", true), ("sliced", false)],
    &[RANGE],
);
const SLICED: StrategyWesl<'static> = tiles_wesl(
    &[("explicit_bounds", true), ("one_pass", false), ("halves", false), ("sliced", true)],
    &[RANGE],
);

const fn tiles_wesl(
    flags: &'static [(&'static str, bool)],
    imports: &'static [(&'static str, &'static str)],
) -> StrategyWesl<'static> {
    StrategyWesl {
        main: include_str!("shaders/tiles.wesl"),
        imports,
        flags,
        reader: LightReader::Stored(Storage::Lists),
    }
}
