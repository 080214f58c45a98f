//! Which record of a comparison to use.
//!
//! Candidates are the records within the error budget that no other is surely faster than: they tie.
//! Of those the verdict takes one that loses nothing, then one that needs less memory, then the
//! simplest. A lossy setting is a candidate only where it is surely faster than every exact one.

use crate::{
    report::{is_surely_faster, needs_built_hierarchy},
    results::{Record, Results},
    strategy::rows,
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
    /// The others that nothing is surely faster than, fastest first.
    pub tied: Vec<&'a Record>,
    /// What the best has over those that it ties with, in order of weight.
    pub reasons: Vec<&'static str>,
    /// The fastest of those that the best is surely faster than.
    pub next: Option<&'a Record>,
    /// Where the best needs a hierarchy that was built beforehand: the best without one.
    pub without_hierarchy: Option<&'a Record>,
    /// The fastest lossy setting within the budget.
    pub lossy: Option<&'a Record>,
}

/// The error of a record by [`METRIC`]: 0 where its image is that of no culling, `None` where it is
/// not known.
pub fn error_of(record: &Record) -> Option<f64> {
    match record.is_lossless() {
        true => Some(0.0),
        false => record.image.errors.get(METRIC).copied().flatten(),
    }
}

/// What to use within an error budget; `None` where nothing stays within it, or nothing was tested.
pub fn verdict(results: &Results, error_budget: f64) -> Option<Verdict<'_>> {
    let mut within: Vec<&Record> = results
        .records
        .iter()
        .filter(|record| !record.is_control() && record.lists.untested.is_none())
        .filter(|record| !record.strategy.has_flaw())
        .filter(|record| record.assign_and_shade_ms().is_finite())
        .filter(|record| error_of(record).is_some_and(|error| error <= error_budget))
        .collect();
    within.sort_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()));
    let (best, mut reasons) = choose(&within)?;
    let (mut tied, slower): (Vec<&Record>, Vec<&Record>) =
        within.iter().copied().partition(|record| is_unbeaten(record, &within));
    tied.retain(|record| !std::ptr::eq(*record, best));
    if best.is_exact() && reasons.is_empty() && tied.iter().any(|record| !record.is_exact()) {
        reasons.push("it loses nothing");
    }
    let still = needs_built_hierarchy(best);
    let without: Vec<&Record> = within
        .iter()
        .copied()
        .filter(|record| still && record.culls() && !needs_built_hierarchy(record))
        .collect();
    Some(Verdict {
        best,
        tied,
        reasons,
        next: slower.into_iter().find(|record| beats(best, record)),
        without_hierarchy: choose(&without).map(|(record, _)| record),
        lossy: within.iter().copied().find(|record| record.is_lossy),
    })
}

/// Whether nothing among some records is surely faster than one of them.
fn is_unbeaten(record: &Record, among: &[&Record]) -> bool {
    !among.iter().any(|other| beats(other, record))
}

/// Whether a record is surely faster than another. Where no rounds tell, times alone decide, and a
/// lossy record has shown no gain over an exact one.
fn beats(record: &Record, other: &Record) -> bool {
    is_surely_faster(record, other).unwrap_or_else(|| {
        let shows = !record.is_lossy || other.is_lossy;
        shows && record.assign_and_shade_ms() < other.assign_and_shade_ms()
    })
}

/// The record to take of some, fastest first, and what it has over those that it ties with.
fn choose<'a>(within: &[&'a Record]) -> Option<(&'a Record, Vec<&'static str>)> {
    let exact: Vec<&Record> = within.iter().copied().filter(|record| record.is_exact()).collect();
    // A lossy record competes only where it gains on every exact one.
    let competes = |record: &Record| record.is_exact() || exact.iter().all(|e| beats(record, e));
    let field: Vec<&Record> = within.iter().copied().filter(|record| competes(record)).collect();
    let mut left: Vec<&Record> =
        field.iter().copied().filter(|record| is_unbeaten(record, &field)).collect();
    if left.is_empty() {
        // Each is beaten by another, in a circle: the least time decides.
        left.extend(field.first());
    }
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
    let memory =
        |record: &Record| record.lists.assignment_bytes.unwrap_or(record.lists.list_bytes) as f64;
    keep(&mut left, "it needs less memory", &memory, ALIKE_MEMORY);
    keep(&mut left, "it is simpler", &complexity, 1.0);
    left.first().map(|best| (*best, reasons))
}

/// How much there is to a method: first its knobs, then its place in the registry, which goes from
/// the simple to the involved.
fn complexity(record: &Record) -> f64 {
    let id = &record.strategy;
    let (place, count) = (rows().position(|row| row.family == id.family()), rows().count());
    (id.segment_count() * count + place.unwrap_or(count)) as f64
}
