//! The WESL of tiles: one module, and the flag of each variant.

use assign::{Storage, StrategyWesl};

/// The WESL of tiles bounded by their frusta: `group_of` and `group_bounds`.
pub const IMPLICIT_WESL: StrategyWesl<'static> = tiles_wesl(&[("explicit_bounds", false)]);

/// The WESL of tiles bounded by the samples in them: `group_of` and `group_bounds`.
pub const EXPLICIT_WESL: StrategyWesl<'static> = tiles_wesl(&[("explicit_bounds", true)]);

const fn tiles_wesl(flags: &'static [(&'static str, bool)]) -> StrategyWesl<'static> {
    StrategyWesl {
        main: include_str!("shaders/tiles.wesl"),
        imports: &[],
        flags,
        storage: Storage::Lists,
    }
}
