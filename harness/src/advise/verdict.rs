//! Which record of a comparison to use.
//!
//! The fastest record within the error budget names the time to reach. Every record that cannot be
//! told apart from it would do as well. Of those the verdict takes one that loses nothing, then one
//! that needs less memory, then the simplest. So a lossy setting is named only where it is surely
//! faster than every exact one.

use crate::{
    registry::STRATEGIES,
    report::{indistinguishable, needs_built_hierarchy},
    results::{Record, Results},
};

/// The metric that the budget is a bound of.
pub const METRIC: &str = "rel_mse";

/// Memory within this factor of the least counts as equal.
const ALIKE_MEMORY: f64 = 1.1;

/// What to use, and what stands beside it.
#[derive(Clone, Debug)]
pub struct Verdict<'a> {
    /// The record to use.
    pub best: &'a Record,
    /// The others that cannot be told apart from the fastest, fastest first.
    pub tied: Vec<&'a Record>,
    /// What the best has over those that it ties with, in order of weight.
    pub reasons: Vec<&'static str>,
    /// The fastest of those that are slower.
    pub next: Option<&'a Record>,
    /// Where the best needs a hierarchy that was built beforehand: what to use without one.
    pub moving: Option<&'a Record>,
    /// The fastest lossy setting within the budget.
    pub lossy: Option<&'a Record>,
}

/// The error of a record by [`METRIC`]: 0 where its image is that of no culling, `None` where it is
/// not known.
pub fn error_of(record: &Record) -> Option<f64> {
    match record.is_lossless() {
        true => Some(0.0),
        false => record.errors.get(METRIC).copied().flatten(),
    }
}

/// What to use within an error budget; `None` where nothing stays within it.
pub fn verdict(results: &Results, error_budget: f64) -> Option<Verdict<'_>> {
    let mut within: Vec<&Record> = results
        .records
        .iter()
        .filter(|record| !record.is_control() && record.assign_and_shade_ms().is_finite())
        .filter(|record| error_of(record).is_some_and(|error| error <= error_budget))
        .collect();
    within.sort_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()));
    let (best, reasons) = choose(&within)?;
    let fastest = *within.first()?;
    let (mut tied, slower): (Vec<&Record>, Vec<&Record>) =
        within.iter().copied().partition(|record| ties(record, fastest));
    tied.retain(|record| !std::ptr::eq(*record, best));
    let still = needs_built_hierarchy(best);
    let without: Vec<&Record> =
        within.iter().copied().filter(|record| still && !needs_built_hierarchy(record)).collect();
    Some(Verdict {
        best,
        tied,
        reasons,
        next: slower.first().copied(),
        moving: choose(&without).map(|(record, _)| record),
        lossy: within.iter().copied().find(|record| record.is_lossy),
    })
}

/// The record to take of some, fastest first, and what it has over those that it ties with.
fn choose<'a>(within: &[&'a Record]) -> Option<(&'a Record, Vec<&'static str>)> {
    let fastest = *within.first()?;
    let mut left: Vec<&Record> =
        within.iter().copied().filter(|record| ties(record, fastest)).collect();
    let mut reasons = Vec::new();
    let mut keep =
        |left: &mut Vec<&'a Record>, reason, key: &dyn Fn(&Record) -> f64, alike: f64| {
            let least = left.iter().map(|record| key(record)).fold(f64::INFINITY, f64::min);
            let before = left.len();
            left.retain(|record| key(record) <= least * alike);
            if left.len() < before {
                reasons.push(reason);
            }
        };
    keep(&mut left, "it loses nothing", &|record| f64::from(u8::from(!record.is_exact())), 1.0);
    keep(&mut left, "it errs less", &|record| error_of(record).unwrap_or(f64::INFINITY), 1.0);
    let memory = |record: &Record| record.memory_bytes.unwrap_or(record.lists_bytes) as f64;
    keep(&mut left, "it needs less memory", &memory, ALIKE_MEMORY);
    keep(&mut left, "it is simpler", &complexity, 1.0);
    left.first().map(|best| (*best, reasons))
}

/// Whether a record cannot be told apart from the fastest. Where no rounds tell, its time alone
/// decides, and a lossy one has shown no gain.
fn ties(record: &Record, fastest: &Record) -> bool {
    std::ptr::eq(record, fastest)
        || indistinguishable(record, fastest).unwrap_or(fastest.is_lossy && !record.is_lossy)
}

/// How much there is to a method: first its knobs, then its place in the registry, which goes from
/// the simple to the involved.
fn complexity(record: &Record) -> f64 {
    let mut segments = record.strategy.split('/');
    let family = segments.next().unwrap_or_default();
    let place = STRATEGIES.iter().position(|entry| entry.family == family);
    let knobs = segments.skip(1).count();
    (knobs * STRATEGIES.len() + place.unwrap_or(STRATEGIES.len())) as f64
}
