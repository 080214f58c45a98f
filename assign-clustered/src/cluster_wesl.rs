//! The WESL of clusters: one main module, the modules that it imports, and the flags of each variant.

use assign::{Bounds, LightReader, Storage, StrategyWesl};

use crate::cluster_options::ClusterOptions;

/// The shared froxel grid, to mount next to a main module that imports it.
pub(crate) const FROXELS: (&str, &str) =
    ("package::strategy::froxels", include_str!("shaders/froxels.wesl"));

const IMPORTS: &[(&str, &str)] = &[
    FROXELS,
    ("package::strategy::cascades", include_str!("shaders/cascades.wesl")),
    ("package::strategy::marks", include_str!("shaders/marks.wesl")),
    ("package::strategy::normal_bins", include_str!("shaders/normal_bins.wesl")),
];

/// Clusters bounded by their frusta: `group_of` and `group_bounds`.
pub const IMPLICIT_WESL: StrategyWesl<'static> = clusters(&[
    ("explicit_bounds", false),
    ("split_by_normals", false),
    ("glossy", false),
    ("polished", false),
    ("cascaded", false),
]);

/// Clusters bounded by the samples in them: `group_of` and `group_bounds`.
pub const EXPLICIT_WESL: StrategyWesl<'static> = clusters(&[
    ("explicit_bounds", true),
    ("split_by_normals", false),
    ("glossy", false),
    ("polished", false),
    ("cascaded", false),
]);

/// [`IMPLICIT_WESL`] for tiles that grow towards the eye.
pub const IMPLICIT_CASCADES_WESL: StrategyWesl<'static> = clusters(&[
    ("explicit_bounds", false),
    ("split_by_normals", false),
    ("glossy", false),
    ("polished", false),
    ("cascaded", true),
]);

/// [`EXPLICIT_WESL`] for tiles that grow towards the eye.
pub const EXPLICIT_CASCADES_WESL: StrategyWesl<'static> = clusters(&[
    ("explicit_bounds", true),
    ("split_by_normals", false),
    ("glossy", false),
    ("polished", false),
    ("cascaded", true),
]);

/// Clusters bounded by the samples in them and split by normals: also `group_facing` and
/// `group_reflection`.
pub const BINS_WESL: StrategyWesl<'static> = clusters(&[
    ("explicit_bounds", true),
    ("split_by_normals", true),
    ("glossy", false),
    ("polished", false),
    ("cascaded", false),
]);

/// [`BINS_WESL`] for clusters that also know how their samples reflect: `group_gloss` too.
pub const GLOSSY_BINS_WESL: StrategyWesl<'static> = clusters(&[
    ("explicit_bounds", true),
    ("split_by_normals", true),
    ("glossy", true),
    ("polished", false),
    ("cascaded", false),
]);

/// [`EXPLICIT_WESL`] for clusters that also know how far specular terms reach on them: `group_reach` too.
pub const POLISHED_WESL: StrategyWesl<'static> = clusters(&[
    ("explicit_bounds", true),
    ("split_by_normals", false),
    ("glossy", false),
    ("polished", true),
    ("cascaded", false),
]);

/// [`POLISHED_WESL`] for tiles that grow towards the eye.
pub const POLISHED_CASCADES_WESL: StrategyWesl<'static> = clusters(&[
    ("explicit_bounds", true),
    ("split_by_normals", false),
    ("glossy", false),
    ("polished", true),
    ("cascaded", true),
]);

const fn clusters(flags: &'static [(&'static str, bool)]) -> StrategyWesl<'static> {
    StrategyWesl {
        main: include_str!("shaders/clusters.wesl"),
        imports: IMPORTS,
        flags,
        reader: LightReader::Stored(Storage::Lists),
    }
}

/// The WESL of clusters. Only clusters with explicit bounds have normals, gloss or a specular reach; those with normals
/// have no cascades.
pub(crate) fn cluster_wesl(options: &ClusterOptions) -> StrategyWesl<'static> {
    match (options.bounds, options.slices.is_cascaded()) {
        (Bounds::Implicit, false) => IMPLICIT_WESL,
        (Bounds::Implicit, true) => IMPLICIT_CASCADES_WESL,
        (Bounds::Explicit, _) if options.cut.is_glossy() => GLOSSY_BINS_WESL,
        (Bounds::Explicit, _) if options.normals.is_some() => BINS_WESL,
        (Bounds::Explicit, false) if options.reach.is_some() => POLISHED_WESL,
        (Bounds::Explicit, true) if options.reach.is_some() => POLISHED_CASCADES_WESL,
        (Bounds::Explicit, false) => EXPLICIT_WESL,
        (Bounds::Explicit, true) => EXPLICIT_CASCADES_WESL,
    }
}
