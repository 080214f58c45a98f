//! How much a comparison study looks at: on a GPU, of a heavy scene, and where quick.

use crate::cli::Size;

/// From this many triangles on a scene is heavy: drawing its surfaces takes more of a frame than
/// lighting them, so it gets fewer poses and fewer methods.
const HEAVY_TRIANGLES: u64 = 2_000_000;

/// One of each kind, for the lossy knobs, through the hierarchy.
pub(crate) const LOSSY: [&str; 4] = ["T-E", "DC-I", "SC-E", "G"];

/// From this many poses on the images of several are compared.
pub(crate) const LONG: u32 = 60;

/// A family with the sizes that its search tries.
type Sizes = (&'static str, &'static [&'static str]);

/// How much a study looks at.
#[derive(Clone, Copy)]
pub(crate) struct Extent {
    pub(crate) size: Size,
    /// Frames of each method before the clock starts.
    pub(crate) warmup: &'static str,
    /// Strategies of the example from the still camera.
    pub(crate) main: &'static str,
    /// Strategies of the views of low and high depth discontinuity.
    pub(crate) views: &'static str,
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
    /// Strategies of the ranking, likewise.
    pub(crate) ranked: &'static str,
    pub(crate) ranked_at_most: &'static str,
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
    pub(crate) linear_sizes: &'static [Sizes],
    pub(crate) bvh_sizes: &'static [Sizes],
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
    pub(crate) fn of(quick: bool, triangles: u64) -> Self {
        match (quick, triangles >= HEAVY_TRIANGLES) {
            (true, _) => QUICK,
            (false, true) => HEAVY,
            (false, false) => FULL,
        }
    }
}

const TILES: &[&str] = &["16x16", "20x20", "24x24", "28x28", "32x32", "40x40"];

/// Nine sizes around that of the paper, wide enough that the best found so far lie inside.
const DENSE_IMPLICIT: &[&str] = &[
    "96x96x24",
    "96x96x40",
    "96x96x64",
    "128x128x24",
    "128x128x40",
    "128x128x64",
    "192x192x24",
    "192x192x40",
    "192x192x64",
];
const DENSE_EXPLICIT: &[&str] = &[
    "48x48x24", "48x48x40", "48x48x64", "64x64x24", "64x64x40", "64x64x64", "96x96x24", "96x96x40",
    "96x96x64",
];
const SPARSE: &[&str] = &[
    "32x32x40", "32x32x64", "32x32x96", "48x48x40", "48x48x64", "48x48x96", "64x64x40", "64x64x64",
    "64x64x96",
];
const CELLS: &[&str] = &["12x12x12", "16x16x16", "20x20x20", "24x24x24", "28x28x28", "40x12x20"];

const FULL: Extent = Extent {
    size: Size { width: 1920, height: 1080 },
    warmup: "4",
    main: "None,Sphere,RasterSphere,Clay,T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,HG,M,M/2,\
           T-E/bvh,DC-E/bvh,SC-E/bvh,G/bvh,M/2/bvh",
    views: "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,HG,M,M/2",
    frames: 16,
    lossy_frames: 8,
    counts: &[100, 1_000, 10_000],
    most: 10_000,
    frames_at: &[100, 10_000],
    laps: 6,
    rank_poses: [240, 240],
    ranked: "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,M/2,T-E/bvh,SC-E/bvh,G/bvh",
    ranked_at_most: "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,HG,M/2,G/20x20x20/surfaces,\
                     T-E/bvh,DC-E/bvh,SC-E/bvh,G/bvh",
    slow: "None,M",
    slow_poses: 12,
    search_poses: 24,
    scaling: &[100, 1_000, 3_000, 10_000, 30_000],
    scaled: "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,M/2,SC-E/bvh",
    scaled_whole: "M",
    linear_sizes: &[
        ("T-I", TILES),
        ("T-E", TILES),
        ("DC-I", DENSE_IMPLICIT),
        ("DC-E", DENSE_EXPLICIT),
        ("SC-I", SPARSE),
        ("SC-E", SPARSE),
        ("HG", &["32x32x40", "48x48x40", "64x64x40"]),
        ("G", CELLS),
        ("M", &["1", "2", "4"]),
    ],
    bvh_sizes: &[("T-E", TILES), ("DC-E", DENSE_EXPLICIT), ("SC-E", SPARSE), ("G", CELLS)],
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
    main: "None,Sphere,T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,M,M/2,SC-E/bvh",
    views: "T-E,SC-E,G,M,M/2",
    frames: 8,
    rank_poses: [16, 24],
    ranked: "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,SC-E/bvh",
    ranked_at_most: "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,M/2,DC-E/bvh,SC-E/bvh,G/bvh",
    slow: "M",
    slow_poses: 6,
    search_poses: 8,
    scaling: &[100, 1_000, 3_000, 10_000],
    scaled: "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G",
    frames_at: &[],
    linear_sizes: &[("T-E", TILES), ("SC-E", SPARSE), ("G", CELLS)],
    bvh_sizes: &[("SC-E", SPARSE)],
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
    main: "None,Sphere,RasterSphere,Clay,T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,HG,M,M/2,SC-E/bvh",
    views: "T-E,SC-E,G,M/2",
    frames: 6,
    lossy_frames: 6,
    counts: &[100, 500],
    most: 500,
    frames_at: &[100, 500],
    laps: 6,
    rank_poses: [1, 2],
    ranked: "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,SC-E/bvh",
    ranked_at_most: "T-I,T-E,DC-I,DC-E,SC-I,SC-E,G,HG,M,M/2,SC-E/bvh,G/bvh",
    slow: "",
    slow_poses: 1,
    search_poses: 1,
    scaling: &[100, 300, 500, 1_000],
    scaled: "T-E,DC-E,SC-E,SC-I,G,SC-E/bvh",
    scaled_whole: "",
    linear_sizes: &[
        ("T-E", &["16x16", "28x28"]),
        ("SC-E", &["16x16x16", "32x32x16"]),
        ("G", &["8x8x8", "16x16x16"]),
    ],
    bvh_sizes: &[("SC-E", &["16x16x16", "32x32x16"])],
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
