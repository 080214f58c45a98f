//! What engines ship, in the terms of our methods: grid, slices, limits.
//!
//! The facts come from public sources, which each engine names. Our methods stand in for the engines' own: they test
//! lights on the GPU, list them in ascending index, and lose a light only where the id says so. What else differs is
//! said in a sentence.

use super::StrategyId;

/// The prefix of a name that stands for an engine's default: `engine:bevy`.
pub const PREFIX: &str = "engine:";

/// The default of an engine.
#[derive(Clone, Copy, Debug)]
pub struct Engine {
    /// Its name after the prefix.
    pub name: &'static str,
    /// The engine, and what part of it.
    pub title: &'static str,
    /// The id of our method, for an image of that width and height, pixels.
    id: fn([u32; 2]) -> String,
    /// What differs from the engine.
    pub differs: &'static str,
    /// Where its settings are public.
    pub source: &'static str,
}

impl Engine {
    /// The id of our method, for an image of that width and height, pixels.
    pub fn id(&self, size_px: [u32; 2]) -> String {
        (self.id)(size_px.map(|side| side.max(1)))
    }
}

/// What `lightbench list engines` prints, with ids for an image of 1920 x 1080 pixels.
pub fn list() -> String {
    let entry = |engine: &Engine| {
        let Engine { name, title, differs, source, .. } = engine;
        let id = engine.id([1920, 1080]);
        format!(
            "{PREFIX}{name:<12} {title}\n{0:20}{id} at 1920x1080\n{0:20}{source}\n{0:20}differs: {differs}\n",
            ""
        )
    };
    ENGINES.iter().map(entry).collect()
}

/// All engines, by name.
pub const ENGINES: &[Engine] = &[
    Engine {
        name: "babylon",
        title: "Babylon.js, clustered lights",
        id: |[width, height]| format!("ZB/{}x{}x16", width.div_ceil(64), height.div_ceil(64)),
        differs: "Babylon.js rasterises a rectangle around each light into the tiles, and its slices span the camera's \
                  whole depth range; spots count as balls",
        source: "Babylon.js, clusteredLightContainer: 64 x 64 tiles, 16 depth slices",
    },
    Engine {
        name: "bevy",
        title: "Bevy 0.19, clustered forward",
        id: |size| {
            let [x, y] = tiles_of(size, 4096.0 / 24.0);
            let [width, height] = [size[0].div_ceil(x), size[1].div_ceil(y)];
            format!("DC-I/{width}x{height}x24/near5")
        },
        differs: "Bevy makes the clusters of a frame larger if the lists of the frame before were too long, and takes \
                  the farthest light of that frame as the end of the slices",
        source: "Bevy, ClusterConfig::FixedZ: 4,096 clusters, 24 slices, the first one of 5 m",
    },
    Engine {
        name: "filament",
        title: "Filament, froxels",
        id: |size| {
            let [x, y] = tiles_of(size, 512.0);
            let side = size[0].div_ceil(x).max(size[1].div_ceil(y)).next_multiple_of(8);
            format!("DC-I/{side}x{side}x16/near5/nearest256")
        },
        differs: "Filament's slices end at 100 m, and lights beyond that are skipped; where the memory of its lists is \
                  full, a froxel lists all lights, as ours do",
        source: "Filament, Froxelizer: 8,192 froxels, 16 slices, 5 m to 100 m; CONFIG_MAX_LIGHT_COUNT 256",
    },
    Engine {
        name: "godot",
        title: "Godot 4, Forward+",
        id: |_| "ZB/32x32x32/even/first512".to_owned(),
        differs: "Godot's slices are equally deep up to the camera's far plane, which is at 4,000 m unless it is set, and \
                  its limit counts each kind of light by itself",
        source: "Godot, ClusterBuilderRD: 32 px, 32 slices; max_clustered_elements 512",
    },
    Engine {
        name: "playcanvas",
        title: "PlayCanvas, clustered lighting",
        id: |_| "G/10x3x10/supports/first254/cap255".to_owned(),
        differs: "PlayCanvas tests boxes around lights, not balls, so its lists are longer",
        source: "PlayCanvas, LightingParams: 10 x 3 x 10 cells, 255 lights per cell, 254 lights",
    },
    Engine {
        name: "three",
        title: "three.js, ClusteredLightsNode",
        id: |_| "DC-I/32x32x24/first1024/cap64".to_owned(),
        differs: "three.js sorts lights by depth, so a full list loses other lights than ours, which keeps the first ones",
        source: "three.js, ClusteredLightsNode: 32 px, 24 slices, 64 lights per cluster, 1,024 lights",
    },
    Engine {
        name: "three-tiled",
        title: "three.js, TiledLightsNode (until 2026)",
        id: |_| "T-I/32x32/first1024/cap8".to_owned(),
        differs: "three.js tests the circle of a light on the screen, and knows only point lights",
        source: "three.js, TiledLightsNode: 32 px, 8 lights per tile, 1,024 lights",
    },
    Engine {
        name: "unreal",
        title: "Unreal Engine 5, light grid",
        id: |_| "DC-I/64x64x32".to_owned(),
        differs: "Unreal limits the lists of all cells together (32 lights per cell on average), and where its slices \
                  begin and end is not public",
        source: "Unreal Engine, r.Forward.LightGridPixelSize 64, r.Forward.LightGridSizeZ 32",
    },
    Engine {
        name: "urp",
        title: "Unity URP, Forward+",
        id: |_| "ZB/32x32x409/first256".to_owned(),
        differs: "Unity makes tiles of 16 px with few lights and of 64 px with more than 256 lights and probes, and which \
                  lights are lost beyond 256 is not public",
        source: "Unity, ForwardLights: 256 lights, tiles from 8 px on, 4,096 words of z-bins",
    },
];

/// Tiles along x and y, about as wide as high, of which an image has about `count`.
fn tiles_of(size_px: [u32; 2], count: f64) -> [u32; 2] {
    let aspect = f64::from(size_px[0]) / f64::from(size_px[1]);
    [(count * aspect).sqrt(), (count / aspect).sqrt()].map(|side| (side as u32).max(1))
}

/// Whether a name stands for an engine's default.
pub fn is_engine(name: &str) -> bool {
    name.to_lowercase().starts_with(PREFIX)
}

/// The ids that a name such as `engine:bevy` or `engine:all` stands for; `None` if it is no such name.
///
/// # Errors
///
/// The names of all engines, if there is no engine of that name.
pub fn expand(name: &str, size_px: [u32; 2]) -> Option<Result<Vec<String>, Vec<String>>> {
    let lower = name.to_lowercase();
    let engine = lower.strip_prefix(PREFIX)?;
    let found: Vec<String> = ENGINES
        .iter()
        .filter(|known| engine == "all" || known.name == engine)
        .map(|known| known.id(size_px))
        .collect();
    let names = || ENGINES.iter().map(|known| format!("{PREFIX}{}", known.name)).collect();
    Some(if found.is_empty() { Err(names()) } else { Ok(found) })
}

/// The engines whose default an id is, at a size.
pub fn engines_of(id: &StrategyId, size_px: [u32; 2]) -> impl Iterator<Item = &'static Engine> {
    let text = id.to_string();
    ENGINES.iter().filter(move |engine| {
        StrategyId::parse(&engine.id(size_px)).is_ok_and(|own| own.to_string() == text)
    })
}

/// The engine whose default an id is, or is without what loses light, at a size.
pub fn engine_of(id: &StrategyId, size_px: [u32; 2]) -> Option<&'static Engine> {
    let is_whole = |engine: &&Engine| {
        let default = StrategyId::parse(&engine.id(size_px)).ok();
        default.and_then(|default| default.nearest_lossless()).is_some_and(|whole| whole == *id)
    };
    engines_of(id, size_px).next().or_else(|| ENGINES.iter().find(is_whole))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_defaults_at_full_hd_are_those_of_the_engines() {
        let id = |name: &str| match expand(name, [1920, 1080]) {
            Some(Ok(ids)) => ids.join(","),
            other => panic!("{name}: {other:?}"),
        };
        // 17 x 9 clusters; 27 x 15 froxels; 64 x 64 tiles.
        assert_eq!(id("engine:bevy"), "DC-I/113x120x24/near5");
        assert_eq!(id("Engine:Filament"), "DC-I/72x72x16/near5/nearest256");
        assert_eq!(id("engine:babylon"), "ZB/30x17x16");
        assert_eq!(id("engine:all").split(',').count(), ENGINES.len());
        assert!(matches!(expand("engine:doom", [1920, 1080]), Some(Err(_))));
        assert!(expand("SC-E", [1920, 1080]).is_none());
    }

    #[test]
    fn ids_are_canonical_at_every_size_and_engines_are_found_by_them() {
        for engine in ENGINES {
            for size in [[1, 1], [3, 1000], [96, 54], [1920, 1080], [16_384, 16_384]] {
                let id = engine.id(size);
                let parsed = StrategyId::parse(&id).unwrap_or_else(|e| panic!("{id}: {e}"));
                assert_eq!(parsed.to_string(), id, "{}", engine.name);
                assert!(engines_of(&parsed, size).any(|found| found.name == engine.name), "{id}");
            }
            for size in [[1, 1], [1920, 1080]] {
                let default = StrategyId::parse(&engine.id(size)).expect("an id");
                let whole = default.nearest_lossless();
                assert_eq!(whole.is_some(), default.is_lossy(u64::MAX), "{default}");
                let Some(whole) = whole else { continue };
                assert!(!whole.is_lossy(u64::MAX) && whole.nearest_lossless().is_none(), "{whole}");
                assert_eq!((whole.family(), whole.size()), (default.family(), default.size()));
                assert_eq!(whole.options().slices, default.options().slices, "{whole}");
                assert_eq!(engine_of(&whole, size).map(|found| found.name), Some(engine.name));
            }
            for text in [engine.title, engine.differs, engine.source] {
                assert!(!text.is_empty() && !text.contains("  ") && !text.ends_with('.'), "{text}");
            }
        }
    }
}
