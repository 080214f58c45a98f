//! The rows that stand for those of the polygon-light paper, case by case, and how cases make a verdict.

use crate::report::format::significant;
use crate::results::Record;
use crate::study::claims::order::Order;
use crate::study::claims::{Answer, Outcome, Tally, Verdict};
use crate::study::endless::cases::{Case, Cut, PAPER_SLICES, Setting, USUAL, cases, setting};
use crate::study::manifest::Done;

/// The rows of one case: the paper's own settings where they were measured, that is its clusters and its
/// cone test without an early exit; else its cone test in our clusters; else cones without a loss.
pub(crate) struct Rows<'a> {
    pub(crate) position: &'a Record,
    /// Its `dif`.
    pub(crate) dif: Option<&'a Record>,
    cones: Vec<(u32, &'a Record)>,
    /// Whether the cones are by the paper's test.
    is_published: bool,
}

type Wanted<'f> = &'f dyn Fn(&Setting<'_>) -> bool;

impl<'a> Rows<'a> {
    fn find(case: &Case<'a>) -> Option<Self> {
        let published = |s: &Setting<'_>| s.slices == Some(PAPER_SLICES) && !s.exits;
        let usual = |s: &Setting<'_>| s.grid == USUAL && s.exits;
        let test = |s: &Setting<'_>| matches!(s.cut, Cut::ConeTest(_));
        let plain = |s: &Setting<'_>| s.cut == Cut::None;
        Self::pick(case, &published, &test, true)
            .or_else(|| Self::pick(case, &usual, &test, true))
            .or_else(|| Self::pick(case, &usual, &plain, false))
    }

    fn pick(case: &Case<'a>, frame: Wanted<'_>, cut: Wanted<'_>, published: bool) -> Option<Self> {
        let position = case.find(|s| s.is_position() && frame(s))?;
        let row = |count: u32| {
            let record = case.find(|s| s.cones == Some(count) && cut(s) && frame(s))?;
            Some((count, record))
        };
        let cones: Vec<(u32, &Record)> = [6, 24, 54].into_iter().filter_map(row).collect();
        let dif = case.find(|s| s.cut == Cut::Diffuse && frame(s));
        (!cones.is_empty()).then_some(Self { position, dif, cones, is_published: published })
    }

    /// The row of a number of cones.
    pub(crate) fn cones(&self, wanted: u32) -> Option<&'a Record> {
        self.cones.iter().find(|(count, _)| *count == wanted).map(|(_, record)| *record)
    }

    /// All rows with cones.
    pub(crate) fn all_cones(&self) -> impl Iterator<Item = (u32, &'a Record)> {
        self.cones.iter().copied()
    }
}

/// Whether one record is faster than another in assign + shade, if their rounds can decide it.
pub(crate) fn faster(record: &Record, other: &Record) -> Outcome {
    Order::of_times(record, other).into()
}

/// How a claim is judged: from one case, the figures as text and what they say.
pub(crate) type Judge<'f> = &'f dyn Fn(&Case<'_>, &Rows<'_>) -> Option<(String, Outcome)>;

/// Judges a claim case by case. `needs_test`: it speaks of what the paper's cone test lists, so cones without
/// a loss decide nothing, and stand there as figures.
pub(crate) fn by_case(done: &Done, scene: &str, needs_test: bool, judge: Judge<'_>) -> Answer {
    let (mut tally, mut is_published) = (Tally::default(), false);
    for case in cases(done, scene) {
        let Some(rows) = Rows::find(&case) else { continue };
        let Some((figure, outcome)) = judge(&case, &rows) else { continue };
        tally.add(outcome, format!("{}: {figure}", case.name()));
        is_published |= rows.is_published;
    }
    let is_measured = tally.all > 0;
    let mut answer = tally.answer("cases", "these settings");
    if is_measured && needs_test && !is_published {
        let why = "the paper\u{2019}s cone test; the figures show cones without a loss";
        answer.verdict = Verdict::unmeasured(why);
    }
    answer
}

/// A setting with its time, and its error where it loses something: `54 cones (cut 0.01) 2.99 ms (FLIP
/// 0.106)`.
pub(crate) fn with_time(record: &Record) -> String {
    let time = significant(record.assign_and_shade_ms());
    format!("{} {time} ms{}", bracketed(record), error(record))
}

/// A setting whose details stand in brackets: `54 cones (cut 0.01)`.
pub(crate) fn bracketed(record: &Record) -> String {
    let name = setting(&record.strategy);
    match name.split_once(", ") {
        Some((what, details)) => format!("{what} ({details})"),
        None => name,
    }
}

/// ` (FLIP 0.106)` of a setting that loses something.
pub(crate) fn error(record: &Record) -> String {
    match record.image.errors.get("flip").copied().flatten() {
        Some(flip) if record.is_lossy => format!(" (FLIP {})", significant(flip)),
        _ => String::new(),
    }
}
