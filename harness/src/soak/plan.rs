//! What a round draws, and each of its frames: all from the seed and the round's number.

use rand::{Rng, RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use shading::Mode;

use super::ROUND_FRAMES;
use crate::{
    choice::Choice,
    cli::{CliError, Invocation, SoakArgs, StageArgs, parse},
    strategy::{Axis, BASELINE, Row, rows},
};

/// The largest image, pixels.
const WIDEST: u32 = 96;
const HIGHEST: u32 = 64;

/// The most lights of a round.
const MOST_LIGHTS: f64 = 2_000.0;

/// Strategies of a round, besides no culling.
const STRATEGIES: usize = 3;

/// Ids that are tried for one strategy before its default parameters are taken.
const TRIES: usize = 20;

/// The share of axes that an id sets.
const AXIS_SHARE: f64 = 0.25;

/// Sizes of tiles, and numbers of cells and slices: powers of two, their neighbours, and 1.
const PARAMETERS: [u32; 12] = [1, 2, 3, 7, 8, 12, 16, 20, 31, 33, 48, 64];

/// Laws by which lights move, with the words that ask for each.
const LAWS: [&str; 5] = ["drift", "teleport", "births", "flicker", "all"];

/// What a round draws.
pub(super) struct Round {
    /// The options of the stage, to name them.
    pub(super) words: Vec<String>,
    /// The same, parsed.
    pub(super) stage: StageArgs,
    /// How pixels are lit.
    pub(super) mode: Mode,
    /// The strategies, without no culling.
    pub(super) choices: Vec<Choice>,
    /// The frames.
    pub(super) frames: Vec<FramePlan>,
}

/// One frame.
#[derive(Clone, Debug)]
pub(super) struct FramePlan {
    /// Where the camera stands.
    pub(super) camera: CameraPlan,
    /// The frame whose lights are shown.
    pub(super) lights_at: u32,
    /// The most entries of each strategy's pool; `None` is enough of them.
    pub(super) pools: Vec<Option<u32>>,
}

/// Where the camera of a frame stands.
#[derive(Clone, Copy, Debug)]
pub(super) enum CameraPlan {
    /// At a share of the way along the scene's path.
    OnPath(f64),
    /// At a share of the scene's box along each axis, looking along a vector.
    Anywhere {
        /// Beyond 0 and 1 it stands outside.
        at: [f64; 3],
        /// Not of unit length.
        along: [f64; 3],
    },
}

/// The stage between rounds: few lights, and targets of the largest size.
pub(super) fn canonical_stage(scene: &str) -> Result<StageArgs, CliError> {
    let size = format!("{WIDEST}x{HIGHEST}");
    stage_of(&["--scene", scene, "--lights", "8", "--size", &size].map(str::to_owned))
}

/// The stage that some options ask for.
fn stage_of(words: &[String]) -> Result<StageArgs, CliError> {
    let program = ["lightbench", "compare"].map(str::to_owned);
    match parse(program.iter().chain(words))? {
        Invocation::Compare(args) => Ok(args.stage),
        _ => Err(CliError::new("the options of a round are not those of a comparison")),
    }
}

impl Round {
    /// The round of a number.
    pub(super) fn new(args: &SoakArgs, ix: u32) -> Result<Self, CliError> {
        let mixed = args.seed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(u64::from(ix));
        let mut rng = Pcg64Mcg::seed_from_u64(mixed);
        let words = stage_words(&mut rng, &args.scene);
        let stage = stage_of(&words)?;
        let modes = [Mode::Deferred, Mode::Deferred, Mode::DeferredIds, Mode::Forward];
        let mode = modes[rng.random_range(0..modes.len())];
        let choices = choices(&mut rng, mode, u64::from(stage.scattered()));
        let is_moving = stage.motion.motion.is_some();
        let frames = frames(&mut rng, is_moving, choices.len());
        Ok(Self { words, stage, mode, choices, frames })
    }

    /// `T-I/8x16, G/3x7x1/bvh: 1,200 lights`.
    pub(super) fn summary(&self) -> String {
        let ids: Vec<&str> = self.choices.iter().map(|choice| choice.id().as_str()).collect();
        format!("{}: {} lights", ids.join(", "), self.stage.scattered())
    }
}

/// The options of a round's stage.
fn stage_words(rng: &mut impl Rng, scene: &str) -> Vec<String> {
    // One round in eight has an image that may be smaller than a tile.
    let divisor = if rng.random_range(0..8) == 0 { 8 } else { 1 };
    let [width, height] = [WIDEST, HIGHEST].map(|most| {
        let most = most / divisor;
        rng.random_range((most / 3).max(1)..=most)
    });
    let size = format!("{width}x{height}");
    let lights = match rng.random_range(0..8) {
        0 => rng.random_range(0..3),
        1 => [31, 32, 33, 63, 64, 65][rng.random_range(0..6)],
        _ => MOST_LIGHTS.powf(rng.random_range(0.4..1.0)) as u32,
    };
    let seed = rng.random_range(0..1_000_000_u32);
    let mut words = ["--scene", scene].map(str::to_owned).to_vec();
    let mut add = |name: &str, value: String| words.extend([name.to_owned(), value]);
    add("--size", size);
    add("--lights", lights.to_string());
    add("--seed", seed.to_string());
    add("--radius-scale", format!("{:.3}", 10_f64.powf(rng.random_range(-0.2..1.4))));
    match rng.random_range(0..6) {
        0 | 1 => add("--spots", "0.4".to_owned()),
        2 => {
            add("--spots", "0.3".to_owned());
            add("--areas", "0.3".to_owned());
            add("--outlines", "all".to_owned());
        }
        _ => {}
    }
    let moves = rng.random_bool(0.5);
    let mover = if rng.random_bool(0.5) { "gpu" } else { "cpu" };
    if moves {
        add("--motion", LAWS[rng.random_range(0..LAWS.len())].to_owned());
        add("--speed", format!("{:.2}", 10_f64.powf(rng.random_range(-1.0..2.0))));
        add("--moved-by", mover.to_owned());
    }
    let orders: &[&str] = match (moves, mover) {
        (true, "gpu") => &["gpu", "gpu4", "gpu20%"],
        _ => &["given", "morton", "bvh", "gpu", "gpu4"],
    };
    add("--light-order", orders[rng.random_range(0..orders.len())].to_owned());
    words
}

/// Strategies that show the image of no culling, with random parameters and axes.
fn choices(rng: &mut impl Rng, mode: Mode, lights: u64) -> Vec<Choice> {
    let fits = |row: &&Row| row.family != BASELINE && row.refuses_mode(mode).is_none();
    let families: Vec<&Row> = rows().filter(fits).collect();
    let mut choices: Vec<Choice> = Vec::new();
    // Bounded, whatever the registry holds.
    for _ in 0..10 * STRATEGIES {
        if choices.len() == STRATEGIES || families.is_empty() {
            break;
        }
        let row = families[rng.random_range(0..families.len())];
        let Some(choice) = choice_of(rng, row, lights) else { continue };
        if !choice.is_control() && choices.iter().all(|known| known.id() != choice.id()) {
            choices.push(choice);
        }
    }
    choices
}

/// A strategy of a family.
fn choice_of(rng: &mut impl Rng, row: &Row, lights: u64) -> Option<Choice> {
    for _ in 0..TRIES {
        let mut id = row.id_of(&parameters_of(rng, row.default));
        for &axis in row.axes {
            if !rng.random_bool(AXIS_SHARE) {
                continue;
            }
            id.extend(segment_of(rng, axis).map(|segment| format!("/{segment}")));
        }
        if let Ok(choice) = Choice::parse(&id)
            && is_exact(&choice, lights)
        {
            return Some(choice);
        }
    }
    Choice::parse(row.family).ok().filter(|choice| is_exact(choice, lights))
}

/// Whether a strategy promises the image of no culling in frames that differ.
fn is_exact(choice: &Choice, lights: u64) -> bool {
    !choice.is_lossy(lights) && choice.id().options().reuse.is_none()
}

/// Random parameters in place of the numbers of a family's default ones.
fn parameters_of(rng: &mut impl Rng, default: &str) -> String {
    let random = |part: &str, rng: &mut dyn Rng| match part.parse::<u32>() {
        Ok(_) => PARAMETERS[rng.random_range(0..PARAMETERS.len())].to_string(),
        Err(_) => part.to_owned(),
    };
    let parts: Vec<String> = default.split('x').map(|part| random(part, rng)).collect();
    parts.join("x")
}

/// A value of an axis that loses no light; `None` for axes that may.
fn segment_of(rng: &mut impl Rng, axis: Axis) -> Option<&'static str> {
    let values: &[&str] = match axis {
        Axis::Slices => &["even", "near2", "cascades2", "cascades4"],
        Axis::Scatter => &["raster"],
        Axis::Box => &["positions", "supports", "surfaces", "frustum", "visible"],
        Axis::Normals => &["n1", "n6", "n24"],
        Axis::Tests => &["hs", "sat-e", "sat-p", "sat-v+hs", "hs+sat-e+sat-n+sat-p+sat-v"],
        Axis::Source => &["bvh", "bvh", "linear"],
        Axis::AreaBounds => &["ball"],
        Axis::Storage => &["mask", "scalar", "prune", "tree"],
        Axis::Keep => &["keep2", "keep4"],
        Axis::Touched => &["touched"],
        Axis::Exit => &["no-exit"],
        Axis::Specular | Axis::Fewer | Axis::Stochastic | Axis::Reuse | Axis::Cap => return None,
        // It loses no light, and shows what it gains only where specular terms reach beyond ranges.
        Axis::Reach => return None,
        // It needs shadow maps, which these frames have none of.
        Axis::Occlusion => return None,
        // These fail on purpose.
        Axis::Rectangle | Axis::Half | Axis::PlainDepth | Axis::Order => return None,
    };
    Some(values[rng.random_range(0..values.len())])
}

fn frames(rng: &mut impl Rng, is_moving: bool, strategies: usize) -> Vec<FramePlan> {
    let mut way = rng.random::<f64>();
    let mut lights_at = 0;
    let mut plan = Vec::new();
    for ix in 0..ROUND_FRAMES {
        let camera = match rng.random_range(0..10) {
            0..6 => {
                // The next step of a walk.
                way = (way + 0.002).fract();
                CameraPlan::OnPath(way)
            }
            6..8 => {
                way = rng.random();
                CameraPlan::OnPath(way)
            }
            _ => CameraPlan::Anywhere {
                at: std::array::from_fn(|_| rng.random_range(-0.2..1.2)),
                along: std::array::from_fn(|_| rng.random_range(-1.0..1.0)),
            },
        };
        if is_moving && ix > 0 {
            lights_at = match rng.random_range(0..10) {
                0..7 => lights_at + 1,
                7 => lights_at,
                _ => rng.random_range(0..10_000),
            };
        }
        let pool = |rng: &mut dyn Rng| rng.random_bool(0.3).then(|| rng.random_range(0..60));
        let pools = (0..strategies).map(|_| pool(rng)).collect();
        plan.push(FramePlan { camera, lights_at, pools });
    }
    plan
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeSet;

    use super::*;

    fn args(seed: u64) -> SoakArgs {
        let scene = "town-small".to_owned();
        SoakArgs { frames: 10, seed, from: 0, scene, adapter: None }
    }

    #[test]
    fn a_round_follows_from_its_number_and_the_seed() {
        let drawn = |seed, ix| {
            let round = Round::new(&args(seed), ix).expect("a round");
            format!("{} {:?} {:?}", round.summary(), round.words, round.frames)
        };
        assert_eq!(drawn(1, 3), drawn(1, 3));
        assert_ne!(drawn(1, 3), drawn(1, 4));
        assert_ne!(drawn(1, 3), drawn(2, 3));
    }

    #[test]
    fn rounds_reach_every_family_and_every_axis_that_loses_no_light() {
        let mut families = BTreeSet::new();
        let mut segments = BTreeSet::new();
        let mut small_pools = 0;
        for ix in 0..400 {
            let round = Round::new(&args(1), ix).expect("a round");
            assert!(round.choices.len() == STRATEGIES, "{}", round.summary());
            for choice in &round.choices {
                assert!(is_exact(choice, u64::from(round.stage.scattered())), "{}", choice.id());
                families.insert(choice.row().family);
                let id = choice.id().to_string();
                segments.extend(id.split('/').skip(1).map(str::to_owned));
            }
            let frames = round.frames.iter();
            small_pools += frames.filter(|frame| frame.pools.iter().any(Option::is_some)).count();
        }
        let all: BTreeSet<&str> = rows()
            .filter(|row| {
                Choice::parse(row.family).is_ok_and(|c| is_exact(&c, 1) && !c.is_control())
            })
            .map(|row| row.family)
            .filter(|family| *family != BASELINE)
            .collect();
        assert_eq!(families, all);
        let wanted =
            ["bvh", "mask", "scalar", "prune", "tree", "n6", "keep4", "touched", "even", "raster"];
        for segment in wanted {
            assert!(segments.contains(segment), "{segment} of {segments:?}");
        }
        assert!(small_pools > 1_000, "{small_pools}");
    }
}
