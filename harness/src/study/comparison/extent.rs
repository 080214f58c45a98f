//! How much a comparison study looks at: on a GPU, of a heavy scene, and where quick.

use crate::cli::Size;
use crate::strategy::{Role, Row, row, rows};

/// From this many triangles on a scene is heavy: drawing its surfaces takes more of a frame than
/// lighting them, so it gets fewer poses and fewer methods.
const HEAVY_TRIANGLES: u64 = 2_000_000;

/// One of each kind, for the lossy knobs, through the hierarchy.
pub(crate) const LOSSY: [&str; 4] = ["T-E", "DC-I", "SC-E", "G"];

/// From this many poses on the images of several are compared.
pub(crate) const LONG: u32 = 60;

/// A family with the sizes that its search tries.
type Sizes = (&'static str, &'static [&'static str]);

/// The sizes that a search tries.
#[derive(Clone, Copy)]
pub(crate) enum Searched {
    /// Every family of the registry, at the sizes of its row.
    All,
    /// Some families, at the sizes of their rows.
    Families(&'static [&'static str]),
    /// Some families, at sizes of the study's own.
    Sizes(&'static [Sizes]),
}

impl Searched {
    /// The families with their sizes.
    pub(crate) fn sizes(self) -> Vec<Sizes> {
        let of_row = |row: &Row| (row.family, row.sizes.many);
        match self {
            Self::All => rows().map(of_row).filter(|(_, sizes)| !sizes.is_empty()).collect(),
            Self::Families(families) => {
                families.iter().filter_map(|family| row(family)).map(of_row).collect()
            }
            Self::Sizes(sizes) => sizes.to_vec(),
        }
    }
}

/// How much a study looks at.
#[derive(Clone, Copy)]
pub(crate) struct Extent {
    pub(crate) size: Size,
    /// Frames of each method before the clock starts.
    pub(crate) warmup: &'static str,
    /// The families that take part.
    pub(crate) takes: fn(&Row) -> bool,
    /// Strategies of the example from the still camera, beside all families.
    pub(crate) main_too: &'static str,
    /// Strategies of the views of low and high depth discontinuity; `None` for all families with groups.
    pub(crate) views: Option<&'static str>,
    /// Timed frames of the still camera, and of its lossy settings.
    pub(crate) frames: u32,
    pub(crate) lossy_frames: u32,
    /// The counts of lights of the ranking, ascending.
    pub(crate) counts: &'static [u32],
    /// The most of them: those of the views and the searches too.
    pub(crate) most: u32,
    /// The counts of lights at which the frames that a renderer may draw are timed.
    pub(crate) frames_at: &'static [u32],
    /// How often each pose is drawn: six laps tell ties with a coverage of 95 %.
    pub(crate) laps: u32,
    /// Poses of a lap of the ranking: at fewer lights, and at the most lights.
    pub(crate) rank_poses: [u32; 2],
    /// Strategies of the ranking: at fewer lights; and at the most lights, beside all families with groups.
    pub(crate) ranked: &'static str,
    pub(crate) ranked_at_most_too: &'static str,
    /// Methods that take tens of milliseconds a frame, and their poses.
    pub(crate) slow: &'static str,
    pub(crate) slow_poses: u32,
    /// Poses of a lap of searches and of scaling.
    pub(crate) search_poses: u32,
    /// Counts of lights of the scaling, its strategies, and those of them that stop at `most`.
    pub(crate) scaling: &'static [u32],
    pub(crate) scaled: &'static str,
    pub(crate) scaled_whole: &'static str,
    /// Sizes searched from the list of all lights, and through the hierarchy.
    pub(crate) linear_sizes: Searched,
    pub(crate) bvh_sizes: Searched,
    /// Families whose tests are searched, and the tests.
    pub(crate) tested: &'static [&'static str],
    pub(crate) tests: &'static [&'static str],
    /// Many more lights, other radii, and the strategies under both.
    pub(crate) many: &'static [u32],
    pub(crate) radii: &'static [&'static str],
    pub(crate) beyond: &'static str,
    pub(crate) caps: &'static [u32],
    pub(crate) thresholds: &'static [&'static str],
    pub(crate) reuse: &'static [u32],
    pub(crate) reuse_poses: u32,
}

impl Extent {
    /// That of a scene.
    pub(crate) fn new(quick: bool, triangles: u64) -> Self {
        match (quick, triangles >= HEAVY_TRIANGLES) {
            (true, _) => QUICK,
            (false, true) => HEAVY,
            (false, false) => FULL,
        }
    }

    /// Strategies of the example from the still camera.
    pub(crate) fn main(&self) -> String {
        let families = rows().filter(|row| (self.takes)(row)).flat_map(Row::overview_ids);
        joined(families, self.main_too)
    }

    /// Strategies of the views of low and high depth discontinuity.
    pub(crate) fn views(&self) -> String {
        self.views.map_or_else(|| joined(self.grouped_ids(), ""), str::to_owned)
    }

    /// Strategies of the ranking at the most lights, without the slow ones.
    pub(crate) fn ranked_at_most(&self) -> String {
        let is_slow = |id: &String| self.slow.split(',').any(|slow| slow == id);
        joined(self.grouped_ids().filter(|id| !is_slow(id)), self.ranked_at_most_too)
    }

    /// The ids of the families with groups that take part.
    fn grouped_ids(&self) -> impl Iterator<Item = String> {
        let families = rows().filter(|row| row.has_groups && (self.takes)(row));
        families.flat_map(Row::overview_ids)
    }
}

fn joined(ids: impl Iterator<Item = String>, more: &str) -> String {
    let more = more.split(',').filter(|id| !id.is_empty()).map(str::to_owned);
    ids.chain(more).collect::<Vec<_>>().join(",")
}

/// Whether a family is of the comparison paper, or a baseline that its strategies are compared with.
fn is_of_the_paper(row: &Row) -> bool {
    matches!(row.role, Role::Baseline | Role::EarlyExit | Role::ComparisonPaper)
}

const FULL: Extent = Extent {
    size: Size { width: 1920, height: 1080 },
    warmup: "4",
    takes: |_| true,
    main_too: "T-E/bvh,DC-E/bvh,SC-E/bvh,G/bvh,M/2/bvh",
    views: None,
    frames: 16,
    lossy_frames: 8,
    counts: &[100, 1_000, 10_000],
    most: 10_000,
    frames_at: &[100, 10_000],
    laps: 6,
    rank_poses: [240, 240],
    ranked: "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,M/2,T-E/bvh,SC-E/bvh,G/bvh",
    ranked_at_most_too: "G/20x20x20/surfaces,T-E/bvh,DC-E/bvh,SC-E/bvh,G/bvh",
    slow: "None,M",
    slow_poses: 12,
    search_poses: 24,
    scaling: &[100, 1_000, 3_000, 10_000, 30_000],
    scaled: "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,M/2,SC-E/bvh",
    scaled_whole: "M",
    linear_sizes: Searched::All,
    bvh_sizes: Searched::Families(&["T-E", "DC-E", "SC-E", "G"]),
    tested: &["T-E", "DC-I", "SC-I"],
    tests: &[
        "hs",
        "hs+sat-e",
        "hs+sat-n",
        "hs+sat-p",
        "hs+sat-v",
        "sat-e+sat-n+sat-p",
        "hs+sat-e+sat-p+sat-v",
        "hs+sat-e+sat-n+sat-p+sat-v",
    ],
    many: &[100_000],
    radii: &["gamma", "equal", "log-normal"],
    beyond: "T-E/bvh,DC-E/bvh,SC-E/bvh,G/bvh,HG",
    caps: &[4, 8, 16, 32, 64],
    thresholds: &["0.005", "0.02", "0.2"],
    reuse: &[2, 4, 8],
    reuse_poses: 60,
};

/// Of a scene whose surfaces take long to draw: the paper's strategies, fewer poses, no lossy knobs.
const HEAVY: Extent = Extent {
    takes: is_of_the_paper,
    main_too: "SC-E/bvh",
    views: Some("T-E,SC-E,G,M,M/2"),
    frames: 8,
    rank_poses: [16, 24],
    ranked: "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,SC-E/bvh",
    ranked_at_most_too: "DC-E/bvh,SC-E/bvh,G/bvh",
    slow: "M",
    slow_poses: 6,
    search_poses: 8,
    scaling: &[100, 1_000, 3_000, 10_000],
    scaled: "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G",
    frames_at: &[],
    linear_sizes: Searched::Families(&["T-E", "SC-E", "G"]),
    bvh_sizes: Searched::Families(&["SC-E"]),
    tested: &["T-E"],
    tests: &["hs", "hs+sat-n", "hs+sat-e+sat-p+sat-v"],
    many: &[],
    radii: &[],
    caps: &[],
    thresholds: &[],
    reuse: &[],
    ..FULL
};

const QUICK: Extent = Extent {
    size: Size { width: 192, height: 108 },
    warmup: "1",
    takes: |_| true,
    main_too: "SC-E/bvh",
    views: Some("T-E,SC-E,G,M/2"),
    frames: 6,
    lossy_frames: 6,
    counts: &[100, 500],
    most: 500,
    frames_at: &[100, 500],
    laps: 6,
    rank_poses: [1, 2],
    ranked: "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,SC-E/bvh",
    ranked_at_most_too: "SC-E/bvh,G/bvh",
    slow: "",
    slow_poses: 1,
    search_poses: 1,
    scaling: &[100, 300, 500, 1_000],
    scaled: "T-E,DC-E,SC-E,SC-I,G,SC-E/bvh",
    scaled_whole: "",
    linear_sizes: Searched::Sizes(&[
        ("T-E", &["16x16", "28x28"]),
        ("SC-E", &["16x16x16", "32x32x16"]),
        ("G", &["8x8x8", "16x16x16"]),
    ]),
    bvh_sizes: Searched::Sizes(&[("SC-E", &["16x16x16", "32x32x16"])]),
    tested: &["T-E", "SC-I"],
    tests: &["hs", "hs+sat-n", "hs+sat-e+sat-p+sat-v"],
    many: &[2_000],
    radii: &["gamma", "equal"],
    beyond: "T-E/bvh,SC-E/bvh,G/bvh,HG",
    caps: &[4, 16],
    thresholds: &["0.01", "0.1"],
    reuse: &[4],
    reuse_poses: 16,
};
