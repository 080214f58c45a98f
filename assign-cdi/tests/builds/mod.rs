//! The ways to build deep images, and the lists that each gives.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]
#![allow(dead_code, reason = "each test uses a part")]

use assign::Gpu;
use assign_cdi::{
    Build, Coverage, DeepImageSettings, DeepImagesSnapshot, Directions, Raster, Spread, Storage,
};
use glam::UVec2;

use crate::scene::{Scene, settled};

pub(crate) const SINGLE: Build = Build::SinglePass { oversampling: 1, raster: Raster::Compute };
pub(crate) const DRAWN: Build = Build::SinglePass { oversampling: 1, raster: Raster::Fragment };
pub(crate) const BRUTE: Build = Build::PerDirection { coverage: Coverage::Centres, at_once: 3 };
pub(crate) const TOUCHED: Build =
    Build::PerDirection { coverage: Coverage::Conservative, at_once: 32 };

pub(crate) fn settings(build: Build, storage: Storage) -> DeepImageSettings {
    DeepImageSettings {
        directions: Directions::new(Spread::Squares, 4, 8).unwrap(),
        size_px: 32,
        build,
        storage,
        ..Default::default()
    }
}

pub(crate) fn pixels(settings: &DeepImageSettings) -> impl Iterator<Item = (u32, UVec2)> {
    let size = settings.size_px;
    let all = move |d| (0..size * size).map(move |ix| (d, UVec2::new(ix % size, ix / size)));
    (0..settings.directions.count()).flat_map(all)
}

pub(crate) fn lists_of(
    snapshot: &DeepImagesSnapshot,
    settings: &DeepImageSettings,
) -> Vec<Vec<f32>> {
    pixels(settings).map(|(d, at)| snapshot.list(d, at).unwrap().to_vec()).collect()
}

/// Lists of a build after two frames. The build must not overflow.
pub(crate) fn lists(gpu: &Gpu, scene: &Scene, settings: DeepImageSettings) -> Vec<Vec<f32>> {
    let snapshot = settled(gpu, settings, scene).snapshot(gpu).unwrap();
    assert_eq!(snapshot.counters.is_overflowed, 0, "{settings:?}");
    assert_eq!(snapshot.counters.rejected_count, 0, "{settings:?}");
    let lists = lists_of(&snapshot, &settings);
    assert_eq!(lists.iter().map(Vec::len).sum::<usize>(), snapshot.fragment_count());
    assert_eq!(snapshot.fragment_count(), snapshot.counters.fragment_count as usize);
    if settings.storage == Storage::Arrays {
        assert!(lists.iter().all(|list| list.is_sorted()), "{settings:?}");
        let longest = lists.iter().map(Vec::len).max().unwrap();
        assert_eq!(longest, snapshot.counters.longest as usize);
    }
    lists
}
