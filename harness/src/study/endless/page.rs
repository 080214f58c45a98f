//! Many polygon lights through clusters with normal cones: the paper's table and charts, by place and
//! number of lights.

use crate::report::finding::lights;
use crate::report::format::{ABSENT, difference, number, percent, significant};
use crate::report::markup::{Html, html};
use crate::report::rank::{Ratio, competes, first, listed, ranks};
use crate::results::{Operations, Record};
use crate::study::data::Entry;
use crate::study::endless::cases::{
    Case, Cut, PLACES, RULED, Setting, USUAL, cases, cases_at, lost, paper, seen, setting,
};
use crate::study::endless::charts::charts_of;
use crate::study::manifest::Done;
use crate::study::page::figure::{Charts, panels, table, unit};
use crate::study::page::part::Part;
use crate::study::page::shots::Shots;

/// What the figures of a part mean.
const NOTE: &str = "A light operation is one term, diffuse or specular, of one light at one sample. Listed: \
    the sample\u{2019}s list names it. Evaluated: listed, and not left out by shading at that sample. Outer: \
    specular, beyond the reach of the light\u{2019}s diffuse term. Seen: listed, and it would be seen; lost: \
    it would be seen, position lists it, this setting does not. Position is clusters without cones. A cut \
    leaves out specular light below a radiance; the 45\u{b0} test is the paper\u{2019}s cone test; diffuse \
    reach is the paper\u{2019}s dif, where specular light ends with diffuse light. These three lose light: \
    their errors are against no culling. For scale, linearly transformed cosines themselves have a FLIP of \
    0.018 and 0.037 against the true integral (h200-area). In brackets stands the paper\u{2019}s figure, \
    from a GTX 1060 at 1280 x 720 in another scene.";

/// A part per place, with a panel per count of lights.
pub(crate) fn places(
    done: &Done,
    scene: &str,
    charts: &mut Charts,
    shots: &mut Shots<'_>,
) -> Vec<Part> {
    let all = [PLACES.as_slice(), &[RULED]].concat();
    let cases = cases_at(done, scene, &all);
    let mut parts = Vec::new();
    for (place, title) in all {
        let shown: Vec<(String, Html)> = cases
            .iter()
            .filter(|case| case.place == place)
            .map(|case| {
                let body = view(case, shots) + operations(case) + charts_of(case, scene, charts);
                (lights(case.lights), body)
            })
            .collect();
        parts.push(Part::new(place, title, NOTE, panels("Lights", &shown)));
    }
    parts
}

/// What the camera sees.
fn view(case: &Case<'_>, shots: &mut Shots<'_>) -> Html {
    let key = case.entries.iter().find_map(|Entry { job, record }| {
        shots.file(&job.name, record.image.files.baseline.as_deref()?)
    });
    let Some(key) = key else { return Html::default() };
    html!(
        "<div class=\"views\"><figure><img data-picture=\"{0}\" alt=\"{1}\"><figcaption><b>{1}</b>, without \
         culling.</figcaption></figure></div>\n",
        key,
        case.name(),
    )
}

/// The heads of the table, with their units.
const HEADS: [(&str, &str); 15] = [
    ("cones", ""),
    ("diffuse", "listed"),
    ("specular", "listed"),
    ("outer specular", "listed"),
    ("both terms", "listed"),
    ("both terms", "evaluated"),
    ("seen", ""),
    ("lost", ""),
    ("assign", "ms"),
    ("shade", "ms"),
    ("total", "ms"),
    ("relMSE", ""),
    ("FLIP", ""),
    ("missing energy", ""),
    ("unbounded relMSE", ""),
];

/// The paper's table with ours.
fn operations(case: &Case<'_>) -> Html {
    let is_unbounded = case
        .entries
        .iter()
        .any(|entry| entry.record.image.unbounded_errors.contains_key("rel_mse"));
    let columns = HEADS.len() - usize::from(!is_unbounded);
    let head = |(head, of): &(&str, &str)| match *of {
        "" => Html::from(*head),
        in_unit => unit(head, in_unit),
    };
    let heads: Vec<Html> = HEADS.iter().take(columns).map(head).collect();
    let row = |entry: &Entry<'_>| row(case, entry.record).into_iter().take(columns).collect();
    let rows: Vec<Vec<Html>> = case.entries.iter().map(row).collect();
    table(&format!("Light operations and times, {}", case.name()), &heads, &rows)
}

/// Whether the paper's figures stand beside a record: of all that are of one kind beside the most faithful,
/// its cone test rather than cones without a loss, its clusters, no early exit.
fn stands_for_the_paper(case: &Case<'_>, record: &Record) -> bool {
    let faith = |setting: &Setting<'_>| {
        let is_test = matches!(setting.cut, Cut::ConeTest(_));
        (is_test, setting.grid.ends_with("x24"), !setting.exits)
    };
    let own = Setting::of(&record.strategy);
    let kind = |setting: &Setting<'_>| (setting.cones, setting.cut == Cut::Diffuse);
    let is_better = |other: &Record| {
        let other = Setting::of(&other.strategy);
        let is_published = !matches!(other.cut, Cut::Below(_)) && !other.grid.ends_with("x12");
        kind(&other) == kind(&own) && is_published && faith(&other) > faith(&own)
    };
    record.culls() && !own.grid.ends_with("x12") && !case.culled().any(is_better)
}

fn row(case: &Case<'_>, record: &Record) -> Vec<Html> {
    let counted = record.lists.operations.as_ref();
    let known = |value: Option<String>| value.unwrap_or_else(|| ABSENT.to_owned());
    let count = |value: Option<u64>| known(value.map(|value| number(value as f64)));
    let theirs = match stands_for_the_paper(case, record) {
        true => paper(case.place, case.lights, &Setting::of(&record.strategy)),
        false => None,
    };
    let beside = |own: String, theirs: Option<String>| match theirs {
        Some(theirs) => html!("{} <span class=\"unit\">({})</span>", own, theirs),
        None => own.into(),
    };
    let error = |errors: &crate::results::Errors, id: &str| {
        let error = errors.get(id).copied().flatten();
        Html::from(known(error.map(difference)))
    };
    let ms = |own: f64, paper: Option<f64>| beside(significant(own), paper.map(significant));
    let evaluated = counted.and_then(|all| all.evaluated);
    vec![
        setting(&record.strategy).into(),
        count(counted.map(|all| all.diffuse)).into(),
        count(counted.map(|all| all.specular)).into(),
        count(counted.map(|all| all.outer_specular)).into(),
        beside(
            count(counted.map(Operations::listed)),
            theirs.as_ref().and_then(|theirs| theirs.listed).map(|all| number(all as f64)),
        ),
        count(evaluated.map(|all| all.diffuse + all.specular)).into(),
        count(counted.map(seen)).into(),
        known(loss(case, record)).into(),
        ms(record.times.assign_ms, theirs.as_ref().map(|theirs| theirs.assign_ms)),
        ms(record.times.shade_ms, theirs.as_ref().map(|theirs| theirs.shade_ms)),
        ms(
            record.assign_and_shade_ms(),
            theirs.as_ref().map(|theirs| theirs.assign_ms + theirs.shade_ms),
        ),
        error(&record.image.errors, "rel_mse"),
        error(&record.image.errors, "flip"),
        error(&record.image.errors, "missing_energy"),
        error(&record.image.unbounded_errors, "rel_mse"),
    ]
}

/// Terms that would be seen and that a lossy setting loses: a number, or the least that it may be.
fn loss(case: &Case<'_>, record: &Record) -> Option<String> {
    let position = case.position()?.lists.operations.as_ref()?;
    let (lost, may_be_more) =
        lost(record.lists.operations.as_ref().filter(|_| record.is_lossy)?, position);
    let least = if may_be_more { "\u{2265} " } else { "" };
    Some(format!("{least}{}", number(lost as f64)))
}

/// What is fastest without a loss, what it evaluates, and what the fastest with a loss loses.
pub(crate) fn findings(done: &Done, scene: &str) -> Vec<String> {
    cases(done, scene).iter().filter_map(|case| sentence(scene, case)).collect()
}

/// The records of a case in the usual clusters with the early exit: what is compared where the paper's own
/// rows are not asked for.
fn usual<'a>(case: &Case<'a>) -> impl Iterator<Item = &'a Record> {
    let is_usual = |record: &&Record| {
        let setting = Setting::of(&record.strategy);
        setting.grid == USUAL && setting.exits
    };
    case.culled().filter(is_usual)
}

fn fastest<'a>(all: impl Iterator<Item = &'a Record>) -> Option<&'a Record> {
    all.filter(|record| record.assign_and_shade_ms().is_finite())
        .min_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()))
}

/// The verb of a setting.
fn takes(record: &Record) -> &'static str {
    match Setting::of(&record.strategy).cones {
        Some(cones) if cones > 1 => "take",
        _ => "takes",
    }
}

fn is_of_the_paper(record: &&Record) -> bool {
    Setting::of(&record.strategy).is_of_the_paper()
}

fn sentence(scene: &str, case: &Case<'_>) -> Option<String> {
    let time = |record: &Record| significant(record.assign_and_shade_ms());
    let position = case.position()?;
    let ranked = ranks(usual(case).filter(is_of_the_paper));
    let leaders = first(&ranked);
    let leader = *leaders.first()?;
    let names: Vec<String> = leaders.iter().map(|record| setting(&record.strategy)).collect();
    let times: Vec<String> = leaders.iter().map(|record| time(record)).collect();
    let mut text = format!(
        "In {scene} at location {} under {}, without a loss, ",
        case.place.to_uppercase(),
        lights(case.lights)
    );
    text += &match leaders.len() {
        1 => format!("{} {} least time: {} ms", names[0], takes(leader), times[0]),
        _ => format!("{} tie: {} ms", listed(&names), listed(&times)),
    };
    if !leaders.iter().any(|record| std::ptr::eq(*record, position)) {
        text += &format!(", position alone {} ms", time(position));
        if let (Some(own), Some(all)) = (&leader.lists.operations, &position.lists.operations) {
            let fewer = 1.0 - own.listed() as f64 / all.listed().max(1) as f64;
            text += &format!(", with {} % fewer listed terms", percent(fewer));
        }
    }
    let other = fastest(usual(case).filter(|record| competes(record) && !is_of_the_paper(record)));
    if let Some(other) = other {
        let against = match Ratio::between(other, leader) {
            Some(ratio) if ratio.is_tie() => "as much",
            Some(ratio) if ratio.is_faster() => "less",
            Some(_) => "more",
            None => "beside them",
        };
        let name = setting(&other.strategy);
        text += &format!(
            "; {name}, which the paper does not have, takes {against}, {} ms",
            time(other)
        );
    }
    if let Some(lossy) = fastest(usual(case).filter(|record| record.is_lossy)) {
        let flip = lossy.image.errors.get("flip").copied().flatten();
        let flip =
            flip.map_or_else(String::new, |flip| format!(" with a FLIP of {}", significant(flip)));
        let (name, takes) = (setting(&lossy.strategy), takes(lossy));
        text += &format!("; {name} {takes} {} ms{flip}", time(lossy));
        if let (Some(lost), Some(all)) = (loss(case, lossy), &position.lists.operations) {
            let all = number(seen(all) as f64);
            text += &format!("; of {all} terms that would be seen, {lost} are lost");
        }
    }
    Some(text + ".")
}

/// In how many cases cones of the paper's numbers beat position without a loss, in the first scene that has
/// figures.
pub(crate) fn headline(done: &Done) -> Option<String> {
    let scene = done.scenes().into_iter().find(|scene| !cases(done, scene).is_empty())?;
    let (mut faster, mut ties, mut all) = (Vec::new(), 0, 0);
    for case in cases(done, scene) {
        let Some(position) = case.position().filter(|record| competes(record)) else { continue };
        let cones: Vec<&Record> = usual(&case)
            .filter(is_of_the_paper)
            .filter(|record| competes(record) && Setting::of(&record.strategy).cones.is_some())
            .collect();
        if cones.is_empty() {
            continue;
        }
        all += 1;
        let ratio = |record: &Record| Ratio::between(record, position);
        let is_faster = |record: &Record| match ratio(record) {
            Some(ratio) => ratio.is_faster(),
            None => record.assign_and_shade_ms() < position.assign_and_shade_ms(),
        };
        if let Some(best) = fastest(cones.iter().copied().filter(|record| is_faster(record))) {
            faster.push(format!("{} at {}", setting(&best.strategy), case.name()));
        } else if cones.iter().any(|record| ratio(record).is_some_and(|ratio| ratio.is_tie())) {
            ties += 1;
        }
    }
    (all > 0).then(|| {
        let named = match faster.len() {
            0 => String::new(),
            _ => format!(" ({})", listed(&faster)),
        };
        let slower = all - faster.len() - ties;
        format!(
            "Without a loss, 6, 24 or 54 cones beat clusters by position in {} of {all} cases in \
             {scene}{named}, tie in {ties} and take longer in {slower}.",
            faster.len()
        )
    })
}
