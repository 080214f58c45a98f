//! The claim on bounds: what they do to the slope and the offset of times.

use super::pairs::Pairs;
use crate::report::fit::Fit;
use crate::report::format::significant;
use crate::report::raster::MARK;
use crate::results::Record;
use crate::study::claims::Answer;
use crate::study::claims::order::Order;
use crate::study::data::{Entry, entries, is_of_the_paper, lines};
use crate::study::manifest::Done;
use crate::study::page::lines::{Time, fit};

/// Explicit against implicit bounds of the same groups from the same source: slope lower, offset
/// higher. Decided as in the paper, where methods that read depth pay for a depth pre-pass; the bill of
/// a renderer that draws one anyway stands beside it.
pub(crate) fn explicit_against_implicit(done: &Done, scene: &str) -> Answer {
    let scaling: Vec<Entry<'_>> = entries(done, scene, "scaling")
        .into_iter()
        .filter(|entry| is_of_the_paper(entry.record))
        .collect();
    let lines = lines(&scaling);
    let fits = |wanted: String, bvh: bool| {
        let (_, records) =
            lines.iter().find(|(id, _)| id.family() == wanted && id.is_bvh() == bvh)?;
        let fit = |time: Time| fit(records, time).filter(|fit: &Fit| fit.points > 2);
        Some((fit(Record::with_depth_ms)?, fit(Record::assign_and_shade_ms)?))
    };
    // The pre-pass rasterises, which some chips do on a few of their processors.
    let is_weak = done.results.values().any(|results| results.machine.weak_raster().is_some());
    let mark = if is_weak { format!(" {MARK}") } else { String::new() };
    let mut pairs = Pairs::default();
    let has_depth = scaling.iter().any(|entry| entry.record.times.passes.get("depth").is_some());
    let mut figures = Vec::new();
    for group in ["T", "DC", "SC"] {
        for bvh in [false, true] {
            let pair = (fits(format!("{group}-E"), bvh), fits(format!("{group}-I"), bvh));
            let (Some((explicit, explicit_without)), Some((implicit, implicit_without))) = pair
            else {
                continue;
            };
            let source = if bvh { "/bvh" } else { "" };
            for (what, order) in [
                ("slope", Order::of_fits(explicit.slope, implicit.slope)),
                ("offset", Order::of_fits(implicit.offset, explicit.offset)),
            ] {
                let [explicit, implicit] =
                    ["E", "I"].map(|kind| format!("{group}-{kind}{source}\u{2019}s {what}"));
                let [less, more] = match what {
                    "slope" => [explicit, implicit],
                    _ => [implicit, explicit],
                };
                pairs.add(&less, &more, order);
            }
            figures.push(format!(
                "from {group}-I{source} to {group}-E{source}: the slope is multiplied by {}. With \
                 the depth pre-pass, the offset goes from {} to {} ms{mark}. Without it, the \
                 offset goes from {} to {} ms",
                significant(explicit.slope / implicit.slope),
                significant(implicit.offset),
                significant(explicit.offset),
                significant(implicit_without.offset),
                significant(explicit_without.offset),
            ));
        }
    }
    if figures.is_empty() || !has_depth {
        return Answer::unknown("scaling of explicit and implicit bounds, with the depth pre-pass");
    }
    let mut notes: Vec<String> = lines
        .iter()
        .filter(|(id, _)| id.family() == "T-I")
        .filter_map(|(id, _)| Some(format!("with {}", id.stand_in()?)))
        .collect();
    notes.dedup();
    let verdict = pairs.verdict().qualified(&notes);
    Answer { figure: figures.join("; ") + &pairs.exceptions(), verdict }
}
