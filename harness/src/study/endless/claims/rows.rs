//! The rows that stand for those of the polygon-light paper, case by case, and how cases make a verdict.

use crate::report::format::significant;
use crate::results::Record;
use crate::study::claims::order::Order;
use crate::study::claims::{Answer, Verdict};
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
    fn of(case: &Case<'a>) -> Option<Self> {
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
        let of = |count: u32| {
            let record = case.find(|s| s.cones == Some(count) && cut(s) && frame(s))?;
            Some((count, record))
        };
        let cones: Vec<(u32, &Record)> = [6, 24, 54].into_iter().filter_map(of).collect();
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

/// What one case says of a claim.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Outcome {
    Good,
    Bad,
    /// Two times that tie.
    Tie,
    /// Too few rounds for so small a difference.
    Unsure,
}

impl Outcome {
    pub(crate) fn good_if(is_good: bool) -> Self {
        if is_good { Self::Good } else { Self::Bad }
    }

    /// Whether one record is faster than another in assign + shade, if their rounds can decide it.
    pub(crate) fn faster(record: &Record, other: &Record) -> Self {
        match Order::of_times(record, other) {
            Order::Less => Self::Good,
            Order::More => Self::Bad,
            Order::Tie => Self::Tie,
            Order::Unsure => Self::Unsure,
        }
    }
}

/// How a claim is judged: from one case, the figures as text and what they say.
pub(crate) type Judge<'f> = &'f dyn Fn(&Case<'_>, &Rows<'_>) -> Option<(String, Outcome)>;

/// Judges a claim case by case. `needs_test`: it speaks of what the paper's cone test lists, so cones without
/// a loss decide nothing, and stand there as figures.
pub(crate) fn by_case(done: &Done, scene: &str, needs_test: bool, judge: Judge<'_>) -> Answer {
    let (mut figures, mut outcomes, mut is_published) = (Vec::new(), Vec::new(), false);
    for case in cases(done, scene) {
        let Some(rows) = Rows::of(&case) else { continue };
        let Some((figure, outcome)) = judge(&case, &rows) else { continue };
        figures.push(format!("{}: {figure}", case.name()));
        outcomes.push(outcome);
        is_published |= rows.is_published;
    }
    if outcomes.is_empty() {
        return Answer::unknown("these settings");
    }
    let figure = figures.join("; ");
    if needs_test && !is_published {
        let why = "the paper\u{2019}s cone test; the figures show cones without a loss";
        return Answer { figure, verdict: Verdict::unmeasured(why) };
    }
    Answer { figure, verdict: verdict(&outcomes) }
}

/// Holds where all cases say so, fails where all deny it; ties are neither, nor are times that too few
/// rounds cannot order.
pub(crate) fn verdict(outcomes: &[Outcome]) -> Verdict {
    let count = |wanted| outcomes.iter().filter(|outcome| **outcome == wanted).count();
    let (good, ties, unsure) = (count(Outcome::Good), count(Outcome::Tie), count(Outcome::Unsure));
    if ties + unsure == 0 {
        return Verdict::of_parts(good, outcomes.len(), "cases");
    }
    let mut text = format!("holds for {good} of {} cases", outcomes.len());
    text += &match ties {
        0 => String::new(),
        1 => ", a tie in 1".to_owned(),
        many => format!(", ties in {many}"),
    };
    if unsure > 0 {
        text += &format!(", too few rounds in {unsure}");
    }
    Verdict::Differs(text)
}

/// A setting with its time, and its error where it loses something: `54 cones, cut 0.01 2.99 ms (FLIP
/// 0.106)`.
pub(crate) fn with_time(record: &Record) -> String {
    let time = significant(record.assign_and_shade_ms());
    format!("{} {time} ms{}", setting(&record.strategy), error(record))
}

/// ` (FLIP 0.106)` of a setting that loses something.
pub(crate) fn error(record: &Record) -> String {
    match record.image.errors.get("flip").copied().flatten() {
        Some(flip) if record.is_lossy => format!(" (FLIP {})", significant(flip)),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tie_is_neither_for_nor_against() {
        use Outcome::{Bad, Good, Tie};
        assert_eq!(verdict(&[Good, Good]), Verdict::Holds);
        assert_eq!(verdict(&[Bad, Bad]), Verdict::Fails);
        assert_eq!(verdict(&[Good, Bad]), Verdict::Differs("holds for 1 of 2 cases".to_owned()));
        let tied = Verdict::Differs("holds for 2 of 4 cases, a tie in 1".to_owned());
        assert_eq!(verdict(&[Good, Tie, Good, Bad]), tied);
        let all = Verdict::Differs("holds for 0 of 2 cases, ties in 2".to_owned());
        assert_eq!(verdict(&[Tie, Tie]), all);
        let few = Verdict::Differs("holds for 1 of 2 cases, too few rounds in 1".to_owned());
        assert_eq!(verdict(&[Good, Outcome::Unsure]), few);
    }
}
