//! The WESL of tiles: one module, and the flag of each variant.

use assign::{LightReader, Storage, StrategyWesl};

use crate::TileDepths;

/// The WESL of tiles: `group_of` and `group_bounds`.
pub const fn tile_wesl(depths: TileDepths) -> StrategyWesl<'static> {
    match depths {
        TileDepths::Implicit => IMPLICIT,
        TileDepths::Explicit => EXPLICIT,
        TileDepths::HalfZ | TileDepths::ModifiedHalfZ => HALVES,
        TileDepths::Sliced => SLICED,
    }
}

const IMPLICIT: StrategyWesl<'static> =
    tiles_wesl(&[("explicit_bounds", false), ("halves", false), ("sliced", false)]);
const EXPLICIT: StrategyWesl<'static> =
    tiles_wesl(&[("explicit_bounds", true), ("halves", false), ("sliced", false)]);
const HALVES: StrategyWesl<'static> =
    tiles_wesl(&[("explicit_bounds", true), ("halves", true), ("sliced", false)]);
const SLICED: StrategyWesl<'static> =
    tiles_wesl(&[("explicit_bounds", true), ("halves", false), ("sliced", true)]);

const fn tiles_wesl(flags: &'static [(&'static str, bool)]) -> StrategyWesl<'static> {
    StrategyWesl {
        main: include_str!("shaders/tiles.wesl"),
        imports: &[],
        flags,
        reader: LightReader::Stored(Storage::Lists),
    }
}
