//! Claims on the lengths of lists: depth discontinuity (section 4.4.1.2) and models.

use crate::report::format::{number, percent, significant};
use crate::report::rank::listed;
use crate::results::Record;
use crate::study::claims::order::Order;
use crate::study::claims::{Answer, Verdict};
use crate::study::comparison::page::views::is_of_view;
use crate::study::data::{Entry, counts, entries, is_of_the_paper, means, nearest_count, ranking};
use crate::study::manifest::Done;

/// Below this growth of T-E's lists the two views are too alike to tell anything.
const LEAST_GROWTH: f64 = 0.05;

/// The growth of SC-E's lists is far less than T-E's up to this share of it. Our limit, set when the
/// figures were known.
const FAR_LESS: f64 = 0.5;

/// Results this near to [`FAR_LESS`], as a share of it, depend on where we drew it.
const NEAR_LIMIT: f64 = 0.1;

/// Lists whose entries differ by no more than this share are the same: rounding moves the edges of
/// cells by an ulp as the camera moves.
const SAME: f64 = 1e-3;

/// A list with at least this share of all lights is extremely long.
const EXTREME: f64 = 0.25;

/// The records of a family in the views of low and of high discontinuity.
fn in_both<'a>(done: &'a Done, scene: &'a str, name: &str) -> Option<[&'a Record; 2]> {
    let views = entries(done, scene, "views");
    let record = |low: bool| {
        let is_wanted = |entry: &&Entry<'_>| {
            let id = &entry.record.strategy;
            is_of_view(entry, low) && id.family() == name && is_of_the_paper(entry.record)
        };
        views.iter().find(is_wanted).map(|entry| entry.record)
    };
    Some([record(true)?, record(false)?])
}

/// From low to high discontinuity T-E's lists grow far more than SC-E's.
pub(crate) fn discontinuity(done: &Done, scene: &str) -> Answer {
    let listed = |name: &str| {
        let [low, high] = in_both(done, scene, name)?;
        Some([low.lists.listed_per_sample?, high.lists.listed_per_sample?])
    };
    let (Some(tiles), Some(clusters)) = (listed("T-E"), listed("SC-E")) else {
        return Answer::unknown("lists of T-E and SC-E in views of low and high discontinuity");
    };
    let growth = |[low, high]: [f64; 2]| high / low - 1.0;
    let growth_of = |name: &str, both: [f64; 2]| {
        let [low, high] = both.map(significant);
        format!("{name}: from {low} to {high} lights, a change of {} %", percent(growth(both)))
    };
    let mut figure = format!(
        "lights listed per sample, from the view of low to the view of high depth discontinuity; {}; {}",
        growth_of("T-E", tiles),
        growth_of("SC-E", clusters)
    );
    for name in ["G", "M"] {
        if let Some(both) = listed(name) {
            figure += &format!("; {}", growth_of(name, both));
        }
    }
    let verdict = match (growth(tiles), growth(clusters)) {
        (tiles, _) if tiles.is_nan() || tiles <= LEAST_GROWTH => {
            Verdict::undecided("the two views are too alike")
        }
        (tiles, clusters) if (clusters / tiles / FAR_LESS - 1.0).abs() <= NEAR_LIMIT => {
            let share = percent(clusters / tiles);
            Verdict::Differs(format!(
                "{share} % of T-E\u{2019}s growth, near our limit of {} %",
                percent(FAR_LESS)
            ))
        }
        (tiles, clusters) if clusters <= FAR_LESS * tiles => Verdict::Holds,
        (tiles, clusters) if clusters < tiles => {
            let share = percent(clusters / tiles);
            Verdict::Differs(format!("less, but {share} % of T-E\u{2019}s growth"))
        }
        _ => Verdict::Fails,
    };
    Answer { figure, verdict }
}

/// The lists of G and of M are the same in both views.
pub(crate) fn view_free(done: &Done, scene: &str) -> Answer {
    let (mut good, mut all, mut figures, mut missing) = (0, 0, Vec::new(), Vec::new());
    for name in ["G", "M", "T-E", "SC-E"] {
        let is_judged = ["G", "M"].contains(&name);
        let Some([low, high]) = in_both(done, scene, name) else {
            missing.extend(is_judged.then(|| format!("{name} not measured")));
            continue;
        };
        let change = (high.lists.entries as f64 / low.lists.entries.max(1) as f64 - 1.0).abs();
        if is_judged {
            all += 1;
            good += usize::from(change <= SAME);
        }
        let entries = [low, high].map(|record| number(record.lists.entries as f64));
        figures.push(format!("{}: {} and {}", low.strategy.short(), entries[0], entries[1]));
    }
    if all == 0 {
        return Answer::unknown("lists of G and M in two views");
    }
    let figure = format!(
        "entries of all lists, in the view of low and in the view of high depth discontinuity; {}",
        figures.join("; ")
    );
    let verdict = Verdict::of_parts(good, all, "strategies").qualified(&missing);
    Answer { figure, verdict }
}

/// M whole, M in parts and G at the most lights: their lists and their times.
struct Models<'a> {
    lights: u64,
    lists: Vec<&'a Record>,
    times: Vec<&'a Record>,
}

impl<'a> Models<'a> {
    fn at(done: &'a Done, scene: &'a str) -> Option<Self> {
        let (main, ranked) = (entries(done, scene, "main"), ranking(done, scene));
        let lights = nearest_count(&counts(&ranked), 10_000)?;
        let linear = |all: Vec<Entry<'a>>| -> Vec<&'a Record> {
            let records = all.into_iter().map(|entry| entry.record);
            let chosen = records.filter(|r| r.setting.lights == lights && !r.strategy.is_bvh());
            chosen.filter(|record| !record.is_lossy).collect()
        };
        Some(Self { lights, lists: linear(main), times: linear(ranked) })
    }

    fn find(records: &[&'a Record], name: &str) -> Option<&'a Record> {
        records.iter().copied().find(|record| record.strategy.short() == name)
    }

    /// The time of a strategy: along the path where it was measured there.
    fn timed(&self, name: &str) -> Option<&'a Record> {
        Self::find(&self.times, name).or_else(|| Self::find(&self.lists, name))
    }

    /// The time of the grid, or of its stand-in.
    fn grid(&self) -> Option<&'a Record> {
        self.timed("G").or_else(|| self.timed("G/supports"))
    }
}

/// Lists of whole models hold a large share of all lights; those of parts are shorter and faster.
pub(crate) fn models(done: &Done, scene: &str) -> Answer {
    let Some(models) = Models::at(done, scene) else {
        return Answer::unknown("the main comparison");
    };
    let lists = ["M", "M/2"].map(|name| Models::find(&models.lists, name));
    let times = ["M", "M/2"].map(|name| models.timed(name));
    let ([Some(long), Some(short)], [Some(whole), Some(parts)]) = (lists, times) else {
        return Answer::unknown("M and M/2");
    };
    let (Some(of_whole), Some(of_parts)) =
        (long.lists.listed_per_sample, short.lists.listed_per_sample)
    else {
        return Answer::unknown("lengths of lists");
    };
    let ms = [whole, parts].map(Record::assign_and_shade_ms);
    let figure = format!(
        "at {} lights, from M to M/2; the longest list goes from {} to {} lights; the mean number of listed \
         lights per sample goes from {} to {}; the time goes from {} to {} ms ({})",
        number(models.lights as f64),
        number(long.lists.longest as f64),
        number(short.lists.longest as f64),
        significant(of_whole),
        significant(of_parts),
        significant(ms[0]),
        significant(ms[1]),
        means(whole)
    );
    let is_faster = Order::of_times(parts, whole) == Order::Less;
    let is_extreme = long.lists.longest as f64 >= EXTREME * long.setting.lights as f64;
    let parts = [
        (is_extreme, "no list is extremely long"),
        (of_parts < of_whole, "M/2 does not have shorter lists"),
        (is_faster, "M/2 is not faster"),
    ];
    let failed: Vec<&str> = parts.iter().filter(|part| !part.0).map(|part| part.1).collect();
    let verdict = match Verdict::of_parts(parts.len() - failed.len(), parts.len(), "statements") {
        Verdict::Differs(why) => Verdict::Differs(format!("{why}, but {}", listed(&failed))),
        other => other,
    };
    Answer { figure, verdict }
}

/// M in parts is at least as fast as G.
pub(crate) fn subdivision(done: &Done, scene: &str) -> Answer {
    let Some(models) = Models::at(done, scene) else {
        return Answer::unknown("the main comparison");
    };
    let (Some(parts), Some(grid)) = (models.timed("M/2"), models.grid()) else {
        return Answer::unknown("M/2 and G");
    };
    let ids = parts.times.passes.get("model-ids").map_or(0.0, |pass| pass.median_ms);
    let ms = [parts, grid].map(Record::assign_and_shade_ms);
    let mut figure = format!(
        "at {} lights, {}: M/2 takes {} ms, {} takes {} ms",
        number(models.lights as f64),
        means(parts),
        significant(ms[0]),
        grid.strategy.short(),
        significant(ms[1])
    );
    if ids > 0.0 {
        figure += &format!(
            "; without the pass that draws model ids, M/2 takes {} ms",
            significant(ms[0] - ids)
        );
    }
    let verdict = match (Order::of_times(parts, grid), grid.strategy.stand_in()) {
        (Order::Unsure, _) => Verdict::Differs("too few laps for so small a difference".to_owned()),
        (_, Some(what)) => Verdict::Differs(format!("with {what}")),
        (Order::Less | Order::Tie, None) => Verdict::Holds,
        (Order::More, None) if ms[0] - ids <= ms[1] => {
            Verdict::Differs("holds only if the G-buffer has the model ids".to_owned())
        }
        (Order::More, None) => Verdict::Fails,
    };
    Answer { figure, verdict }
}
