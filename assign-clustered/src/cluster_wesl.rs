//! The WESL of clusters: one main module, the modules that it imports, and the flags of each variant.

use assign::{Bounds, LightReader, Storage, StrategyWesl};

use crate::Normals;

/// The shared froxel grid, to mount next to a main module that imports it.
pub(crate) const FROXELS: (&str, &str) =
    ("package::strategy::froxels", include_str!("shaders/froxels.wesl"));

const IMPORTS: &[(&str, &str)] = &[
    FROXELS,
    ("package::strategy::marks", include_str!("shaders/marks.wesl")),
    ("package::strategy::normal_bins", include_str!("shaders/normal_bins.wesl")),
];

/// Clusters bounded by their frusta: `group_of` and `group_bounds`.
pub const IMPLICIT_WESL: StrategyWesl<'static> =
    clusters(&[("explicit_bounds", false), ("split_by_normals", false), ("glossy", false)]);

/// Clusters bounded by the samples in them: `group_of` and `group_bounds`.
pub const EXPLICIT_WESL: StrategyWesl<'static> =
    clusters(&[("explicit_bounds", true), ("split_by_normals", false), ("glossy", false)]);

/// Clusters bounded by the samples in them and split by normals: also `group_facing` and
/// `group_reflection`.
pub const BINS_WESL: StrategyWesl<'static> =
    clusters(&[("explicit_bounds", true), ("split_by_normals", true), ("glossy", false)]);

/// [`BINS_WESL`] for clusters that also know how their samples reflect: `group_gloss` too.
pub const GLOSSY_BINS_WESL: StrategyWesl<'static> =
    clusters(&[("explicit_bounds", true), ("split_by_normals", true), ("glossy", true)]);

const fn clusters(flags: &'static [(&'static str, bool)]) -> StrategyWesl<'static> {
    StrategyWesl {
        main: include_str!("shaders/clusters.wesl"),
        imports: IMPORTS,
        flags,
        reader: LightReader::Stored(Storage::Lists),
    }
}

/// The WESL of a variant. Only clusters with explicit bounds have normals or gloss.
pub(crate) fn cluster_wesl(
    bounds: Bounds,
    normals: Normals,
    glossy: bool,
) -> StrategyWesl<'static> {
    match bounds {
        Bounds::Implicit => IMPLICIT_WESL,
        Bounds::Explicit if glossy => GLOSSY_BINS_WESL,
        Bounds::Explicit if normals.is_some() => BINS_WESL,
        Bounds::Explicit => EXPLICIT_WESL,
    }
}
