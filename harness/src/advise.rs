//! `lightbench advise`: a short search for the strategy and parameters to use on one scene and GPU.
//!
//! Three rounds, each a comparison of its own, so that every figure can be taken again:
//!
//! 1. `families`: every strategy at its default parameters, from both sources of lights, beside no
//!    culling.
//! 2. `parameters`: the three best families at other group sizes, from the better source.
//! 3. `final`: the best of both rounds, in turns and with more frames; where the budget allows an
//!    error, with capped lists too.
//!
//! All rounds judge several poses along the scene's path, each pose several times, so that ties are
//! seen. A scene without a path, or a camera that the user placed, is judged from one view.
//!
//! With `--motion`, the lights move in all rounds, and what that costs is on the bill of each method.
//!
//! The answer is a [`verdict`] on the last round.

mod answer;
mod verdict;

pub use answer::answer;
pub use verdict::{METRIC, Verdict, error_of, verdict};

use std::time::Instant;

use assign::{AssignError, Gpu};

use crate::{
    bench::Bench,
    checks::check_motion,
    choice::Choice,
    cli::{self, AdviseArgs, CliError, CompareArgs, Invocation},
    compare::compare_on,
    error::HarnessError,
    messages::say,
    out_folder::OutFolder,
    report::{self, needs_built_hierarchy},
    results::{Record, Results},
    sight::untested,
    strategy::{BASELINE, EARLY_EXIT, Method, Role, Row, StrategyId, rows},
};

/// Families that go on to the second round.
const FINALISTS: usize = 3;

/// Strategies that go on to the last.
const LAST: usize = 5;

/// Strategies without a hierarchy among them, at least.
const LAST_LINEAR: usize = 2;

/// No culling goes on to the last round where it takes no longer than this, over the fastest.
const NEAR: f64 = 2.0;

/// Frames of a strategy from one view: in the first two rounds, and in the last; on a GPU, and on a
/// software adapter.
const FRAMES: [[u32; 2]; 2] = [[16, 48], [2, 6]];

/// Poses along the path where the command line names no number: on a GPU, and on a software
/// adapter.
const POSES: [u32; 2] = [24, 3];

/// The same where the lights move, and the frames of a lap from one view. By default, lights are sorted in
/// every eighth frame, so that laps of these lengths have as many sorts as they should.
const MOVING_POSES: [u32; 2] = [24, 8];

/// What is said where the command line asks for one pose.
const ONE_POSE: &str = "--poses 1: the camera stood still in the path's first view, which says nothing \
                        of the others; --poses 2 or more judge several";

/// Laps over the poses: in the first two rounds, and in the last, whose laps must tell ties.
const LAPS: [u32; 2] = [1, 8];

/// Frames of each method before the clock starts, at least. A GPU is warmed until it is steady anyway.
const WARMUP: &str = "4";

/// Poses at which the first two rounds compare images: enough to drop a method that loses something.
/// The last round compares as many as a comparison may.
const SEARCH_CHECKS: &str = "2";

/// Lights that a list keeps, where the budget allows an error.
const CAPS: [u32; 4] = [8, 16, 32, 64];

/// Strategies to which the caps are applied.
const CAPPED: usize = 2;

/// Searches, writes what was measured, and says what to use.
///
/// # Errors
///
/// Whatever a comparison fails with, and a choice of several modes.
pub fn advise(args: &AdviseArgs, command: Vec<String>) -> Result<String, HarnessError> {
    check_motion(&args.stage)?;
    let _held = OutFolder::hold(&args.out, &command)?;
    let mut bench = Bench::open(args.adapter.as_deref())?;
    let mut search = Search::new(args, &mut bench, &command)?;

    let lights = search.bench.stage(&args.stage)?.lights.count();
    let first = first_ids(search.bench.gpu(), lights).join(",");
    let families = search.round("families", &first, &["--source", "both"], 0)?;
    let best = fastest_by_family(&families);
    if best.is_empty() {
        return Err(CliError::new("advise: no strategy gave the image of no culling").into());
    }
    // Families of one size have no second round, and take no places in it.
    let searched =
        best.iter().map(|record| variants(&record.strategy)).filter(|ids| !ids.is_empty());
    let finalists: Vec<StrategyId> = searched.take(FINALISTS).flatten().collect();
    let parameters = search.round("parameters", &listed(&finalists), &[], 0)?;

    let ids = last_ids(&families, &parameters, args.error_budget);
    let mut finals = search.round("final", &listed(&ids), &["--truth", "full"], 1)?;
    finals.command = command;
    let text = answer(&finals, args.error_budget);
    let table = report::render_table(&finals);
    let first_line = text.lines().next().unwrap_or_default().to_owned();
    finals.warnings.insert(0, first_line);
    if args.poses == Some(1) {
        finals.warnings.push(ONE_POSE.to_owned());
    }
    finals.write(&args.out.join("results.json"))?;
    let pictures = crate::stored_report::pictures(&finals, &args.out.join("final"));
    let page = report::write_html(&finals, &pictures, &args.out)?;
    Ok(format!("{text}\n{table}\nreport   {}\nrounds   {}\n", page.display(), args.out.display()))
}

/// A search on its way.
struct Search<'a> {
    args: &'a AdviseArgs,
    bench: &'a mut Bench,
    /// The words of the command line that a round shares.
    shared: Vec<String>,
    /// Poses along the path; `None` from one view.
    poses: Option<u32>,
}

impl<'a> Search<'a> {
    fn new(
        args: &'a AdviseArgs,
        bench: &'a mut Bench,
        command: &[String],
    ) -> Result<Self, HarnessError> {
        let poses = if args.stage.motion.motion.is_some() { MOVING_POSES } else { POSES };
        let default = poses[usize::from(bench.gpu().is_software())];
        let moves = bench.stage(&args.stage)?.scene.path.moves();
        if args.poses.is_some() && !moves {
            let scene = &args.stage.scene;
            return Err(CliError::new(format!("--poses: {scene} has no camera path")).into());
        }
        if args.poses == Some(1) {
            say(format!("warning  {ONE_POSE}"));
        }
        let poses = (moves && args.stage.camera.is_none())
            .then(|| args.poses.unwrap_or(default))
            .filter(|poses| *poses > 1);
        let gpu = bench.gpu().clone();
        let stage = bench.stage(&args.stage)?;
        let all: Vec<u32> = (0..poses.unwrap_or(0)).collect();
        if let Some(why) = untested(&gpu, stage, &all, poses.unwrap_or(0))? {
            let why = why.words(stage.light_count(), poses.is_some());
            let message = format!("advise: no advice for this view: {why}");
            return Err(CliError::new(message + " (--camera, --lights)").into());
        }
        Ok(Self { args, bench, shared: AdviseArgs::shared_words(command), poses })
    }

    /// One comparison, kept in a folder of its own. `last` is 1 for the last round, else 0.
    fn round(
        &mut self,
        name: &str,
        strategies: &str,
        more: &[&str],
        last: usize,
    ) -> Result<Results, HarnessError> {
        say(format!("round    {name}: {} strategies", strategies.split(',').count()));
        let began = Instant::now();
        let out = self.args.out.join(name);
        let device = usize::from(self.bench.gpu().is_software());
        let lights_move = self.args.stage.motion.motion.is_some();
        let frames = if lights_move { MOVING_POSES[device] } else { FRAMES[device][last] };
        let frames = self.poses.unwrap_or(frames).to_string();
        let laps = LAPS[last].to_string();
        let mut words = vec!["lightbench".to_owned(), "compare".to_owned()];
        words.extend(self.shared.iter().cloned());
        let mut option = |all: &[&str]| words.extend(all.iter().map(|word| (*word).to_owned()));
        option(&["--strategies", strategies, "--frames", &frames]);
        if self.poses.is_some() {
            option(&["--path"]);
        }
        if self.poses.is_some() || lights_move {
            option(&["--laps", &laps]);
            if last == 0 {
                option(&["--checks", SEARCH_CHECKS]);
            }
        }
        if !self.bench.gpu().is_software() {
            option(&["--warmup", WARMUP]);
        }
        if last == 0 {
            option(&["--truth", "none", "--pictures", "none"]);
        }
        option(more);
        option(&["--out", &out.to_string_lossy()]);
        let Invocation::Compare(compare) = cli::parse(&words)? else {
            return Err(CliError::new("advise: a round has no strategies to compare").into());
        };
        let stage = self.args.stage.clone();
        let (results, _) =
            compare_on(self.bench, &CompareArgs { out: out.clone(), stage, ..compare }, words)?;
        results.write(&out.join("results.json"))?;
        say(format!("         {name} took {:.1} s", began.elapsed().as_secs_f64()));
        Ok(results)
    }
}

/// Records, fastest first.
fn by_time<'a>(records: impl Iterator<Item = &'a Record>) -> Vec<&'a Record> {
    let mut records: Vec<&Record> =
        records.filter(|record| record.assign_and_shade_ms().is_finite()).collect();
    records.sort_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()));
    records
}

/// The fastest record of each family that culls, fastest first; those that lost something are left
/// out.
fn fastest_by_family(results: &Results) -> Vec<&Record> {
    let mut best: Vec<&Record> = Vec::new();
    let exact = results.records.iter().filter(|record| record.culls() && record.is_exact());
    for record in by_time(exact) {
        if best.iter().all(|known| known.strategy.family() != record.strategy.family()) {
            best.push(record);
        }
    }
    best
}

/// Ids as the command line takes them: `None,Sphere`.
fn listed(ids: &[StrategyId]) -> String {
    ids.iter().map(StrategyId::as_str).collect::<Vec<_>>().join(",")
}

/// What the first round compares: no culling, without and with the early exit, and every family that shows the same
/// image and that the device can run with so many lights, at its default parameters.
fn first_ids(gpu: &Gpu, lights: u32) -> Vec<String> {
    let is_compared = |row: &&Row| row.role != Role::Control && row.tolerance.is_none();
    let is_unsupported = |id: &str| match Choice::parse(id).map(|choice| choice.make(gpu)) {
        Ok(Err(error)) => matches!(error, AssignError::Unsupported { .. }),
        Ok(Ok(Method::Lists { strategy, .. })) => {
            let reader = strategy.lookup().module.wesl().reader;
            reader.check_lights(gpu, id, lights).is_err()
        }
        Ok(Ok(_)) | Err(_) => false,
    };
    let ids = rows().filter(is_compared).flat_map(Row::overview_ids);
    ids.filter(|id| !is_unsupported(id)).collect()
}

/// The same strategy at the other group sizes of its row, from the same source.
fn variants(id: &StrategyId) -> Vec<StrategyId> {
    let sizes = id.row().map_or(&[][..], |row| row.sizes.few);
    let sized = |size: &&str| id.with(|options| options.parameters = (*size).to_owned()).ok();
    sizes.iter().filter_map(sized).collect()
}

/// What the last round compares: the fastest exact methods, some of them without a hierarchy; no
/// culling where it is near; and, where the budget allows an error, shorter lists.
fn last_ids(families: &Results, parameters: &Results, error_budget: f64) -> Vec<StrategyId> {
    let all = || families.records.iter().chain(&parameters.records);
    let exact = by_time(all().filter(|record| record.culls() && record.is_exact()));
    let mut last: Vec<&Record> = Vec::new();
    let is_new = |last: &[&Record], record: &Record| {
        last.iter().all(|known| known.strategy != record.strategy)
    };
    for &record in &exact {
        if last.len() < LAST && is_new(&last, record) {
            last.push(record);
        }
    }
    let linear = |record: &&&Record| !needs_built_hierarchy(record);
    for &record in exact.iter().filter(linear) {
        if last.iter().filter(|known| linear(known)).count() < LAST_LINEAR && is_new(&last, record)
        {
            last.push(record);
        }
    }
    let mut ids: Vec<StrategyId> = Vec::new();
    let limit = NEAR * last.first().map_or(f64::INFINITY, |record| record.assign_and_shade_ms());
    let near = |id: &str| {
        all().any(|record| record.strategy == id && record.assign_and_shade_ms() <= limit)
    };
    ids.extend([BASELINE, EARLY_EXIT].iter().filter(|id| near(id)).map(|id| StrategyId::from(*id)));
    ids.extend(last.iter().map(|record| record.strategy.clone()));
    if error_budget > 0.0 {
        for record in last.iter().take(CAPPED) {
            // A longer list loses nothing and gains nothing.
            let shorter = CAPS.iter().filter(|cap| u64::from(**cap) < record.lists.longest);
            let capped = |cap: &u32| record.strategy.with(|options| options.cap = Some(*cap)).ok();
            ids.extend(shorter.filter_map(capped));
        }
    }
    ids
}

#[cfg(test)]
mod tests;
