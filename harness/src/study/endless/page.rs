//! Many polygon lights through clusters with normal cones: the paper's table and charts, by place and
//! number of lights.

use crate::report::column::{Better, Column};
use crate::report::finding::lights;
use crate::report::format::{ABSENT, difference, number, percent, significant};
use crate::report::markup::{Html, html};
use crate::report::rank::{Ratio, competes, first, listed, ranks};
use crate::report::table::{Look, Row, Table};
use crate::results::{Errors, Operations, Record};
use crate::study::claims::capitalised;
use crate::study::data::Entry;
use crate::study::endless::cases::{
    Case, Cut, HALF_SLICES, PAPER_SLICES, PLACES, Published, RULED, Setting, USUAL, cases,
    cases_at, lost, paper, seen, setting,
};
use crate::study::endless::charts::charts_of;
use crate::study::manifest::Done;
use crate::study::page::figure::{Charts, panels};
use crate::study::page::part::Part;
use crate::study::page::shots::Shots;

/// The meaning of a part's figures.
const NOTE: &str = "A light operation is one term, diffuse or specular, of one light at one \
                    sample. Listed: the sample\u{2019}s list contains it. Evaluated: listed, and \
                    shading does not skip it at that sample. Outer: a specular term beyond the \
                    reach of the light\u{2019}s diffuse term. Seen: listed and visible. Lost: \
                    visible and listed by position, but not listed by this setting. Position means \
                    clusters without cones. A cut removes specular light below a radiance. The \
                    45\u{b0} test is the paper\u{2019}s cone test. Diffuse reach is the \
                    paper\u{2019}s dif: specular light ends where diffuse light ends. These three \
                    lose light. Their errors are differences from the image without culling. For \
                    scale, linearly transformed cosines themselves have a FLIP of 0.018 and 0.037 \
                    against the true integral (h200-area). Brackets hold the paper\u{2019}s \
                    figure, from a GTX 1060 at 1280 x 720 in another scene.";

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

/// A picture of the view.
fn view(case: &Case<'_>, shots: &mut Shots<'_>) -> Html {
    let key = case.entries.iter().find_map(|Entry { job, record, .. }| {
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

/// The paper's table with ours.
fn operations<'a>(case: &'a Case<'a>) -> Html {
    let rows = case.entries.iter();
    let row = |entry: &'a Entry<'a>| {
        Row::new(setting(&entry.record.strategy) + entry.mark(), entry.record)
    };
    let columns = [terms(case), times(case), errors()].into_iter().flatten();
    Table::new("cones", columns, rows.map(row).collect())
        .competing(|_| false)
        .html(&format!("Light operations and times, {}", case.name()), Look::Plain)
}

/// Columns of light operations and of lost operations.
fn terms<'a>(case: &'a Case<'a>) -> Vec<Column<'a, &'a Record>> {
    let count = |head, unit, of: fn(&Operations) -> Option<u64>| {
        let value = move |record: &&Record| {
            record.lists.operations.as_ref().and_then(of).map(|terms| terms as f64)
        };
        Column::figure(head, unit, Better::Less, value, number)
    };
    vec![
        count("diffuse", "listed", |all| Some(all.diffuse)),
        count("specular", "listed", |all| Some(all.specular)),
        count("outer specular", "listed", |all| Some(all.outer_specular)),
        count("both terms", "listed", |all| Some(all.listed())).note(|record| {
            beside(of_the_paper(case, record).and_then(|paper| paper.listed), |terms| {
                number(terms as f64)
            })
        }),
        count("both terms", "evaluated", |all| {
            Some(all.evaluated?.diffuse + all.evaluated?.specular)
        }),
        count("seen", "", |all| Some(seen(all))),
        Column::words("lost", "", |record: &&Record| {
            loss(case, record).unwrap_or_else(|| ABSENT.to_owned())
        }),
    ]
}

/// Columns of times, with the paper's.
fn times<'a>(case: &'a Case<'a>) -> Vec<Column<'a, &'a Record>> {
    let ms = |head, time: fn(&Record) -> f64, paper: fn(&Published) -> f64| {
        Column::ms(head, move |record: &&Record| Some(time(record)))
            .note(move |record| beside(of_the_paper(case, record).as_ref().map(paper), significant))
    };
    vec![
        ms("assign", |record| record.times.assign_ms, |paper| paper.assign_ms),
        ms("shade", |record| record.times.shade_ms, |paper| paper.shade_ms),
        ms("total", Record::assign_and_shade_ms, |paper| paper.assign_ms + paper.shade_ms),
    ]
}

/// Columns of errors.
fn errors<'a>() -> Vec<Column<'a, &'a Record>> {
    let error = |head, errors: fn(&Record) -> &Errors, id: &'static str| {
        let value = move |record: &&Record| errors(record).get(id).copied().flatten();
        Column::figure(head, "", Better::Less, value, difference)
    };
    vec![
        error("relMSE", |record| &record.image.errors, "rel_mse"),
        error("FLIP", |record| &record.image.errors, "flip"),
        error("missing energy", |record| &record.image.errors, "missing_energy"),
        error("unbounded relMSE", |record| &record.image.unbounded_errors, "rel_mse").optional(),
    ]
}

/// The paper's figure, in brackets after ours; nothing where it has none.
fn beside<T>(paper: Option<T>, show: fn(T) -> String) -> Html {
    paper
        .map_or_else(Html::default, |paper| html!(" <span class=\"unit\">({})</span>", show(paper)))
}

/// The paper's figures of a setting, where they stand beside it.
fn of_the_paper(case: &Case<'_>, record: &Record) -> Option<Published> {
    let setting = Setting::read(&record.strategy);
    stands_for_the_paper(case, record).then(|| paper(case.place, case.lights, &setting)).flatten()
}

/// Whether the paper's figures stand beside a record: of all that are of one kind beside the most faithful,
/// its cone test rather than cones without a loss, its clusters, no early exit.
fn stands_for_the_paper(case: &Case<'_>, record: &Record) -> bool {
    let faith = |setting: &Setting<'_>| {
        let is_test = matches!(setting.cut, Cut::ConeTest(_));
        (is_test, setting.slices == Some(PAPER_SLICES), !setting.exits)
    };
    let setting = Setting::read(&record.strategy);
    let kind = |setting: &Setting<'_>| (setting.cones, setting.cut == Cut::Diffuse);
    let is_better = |other: &Record| {
        let other = Setting::read(&other.strategy);
        let is_published = !matches!(other.cut, Cut::Below(_)) && other.slices != Some(HALF_SLICES);
        kind(&other) == kind(&setting) && is_published && faith(&other) > faith(&setting)
    };
    record.culls() && setting.slices != Some(HALF_SLICES) && !case.culled().any(is_better)
}

/// Terms that would be seen and that a lossy setting loses: a number, or the least that it may be.
fn loss(case: &Case<'_>, record: &Record) -> Option<String> {
    let position = case.position()?.lists.operations.as_ref()?;
    let (lost, may_be_more) =
        lost(record.lists.operations.as_ref().filter(|_| record.is_lossy)?, position);
    let least = if may_be_more { "\u{2265} " } else { "" };
    Some(format!("{least}{}", number(lost as f64)))
}

/// Names the fastest setting without a loss, what it evaluates, and what the fastest lossy setting loses.
pub(crate) fn findings(done: &Done, scene: &str) -> Vec<String> {
    cases(done, scene).iter().filter_map(|case| sentence(scene, case)).collect()
}

/// The records of a case in the usual clusters with the early exit: what is compared where the paper's own
/// rows are not asked for.
fn usual<'a>(case: &Case<'a>) -> impl Iterator<Item = &'a Record> {
    let is_usual = |record: &&Record| {
        let setting = Setting::read(&record.strategy);
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
    match Setting::read(&record.strategy).cones {
        Some(cones) if cones > 1 => "take",
        _ => "takes",
    }
}

fn is_of_the_paper(record: &&Record) -> bool {
    Setting::read(&record.strategy).is_of_the_paper()
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
        1 => format!("{} {} the least time: {} ms", names[0], takes(leader), times[0]),
        _ => format!("{} tie: {} ms", listed(&names), listed(&times)),
    };
    if !leaders.iter().any(|record| std::ptr::eq(*record, position)) {
        text += &format!(". Position alone takes {} ms", time(position));
        if let (Some(own), Some(all)) = (&leader.lists.operations, &position.lists.operations) {
            let fewer = 1.0 - own.listed() as f64 / all.listed().max(1) as f64;
            text += &format!(", and the fastest lists {} % fewer terms", percent(fewer));
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
        let name = capitalised(&setting(&other.strategy));
        text += &format!(
            ". {name}, which the paper does not have, takes {against}: {} ms",
            time(other)
        );
    }
    if let Some(lossy) = fastest(usual(case).filter(|record| record.is_lossy)) {
        let flip = lossy.image.errors.get("flip").copied().flatten();
        let flip =
            flip.map_or_else(String::new, |flip| format!(" with a FLIP of {}", significant(flip)));
        let (name, takes) = (capitalised(&setting(&lossy.strategy)), takes(lossy));
        text += &format!(". {name} {takes} {} ms{flip}", time(lossy));
        if let (Some(lost), Some(all)) = (loss(case, lossy), &position.lists.operations) {
            let all = number(seen(all) as f64);
            text += &format!(". Of {all} visible terms, {lost} are lost");
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
            .filter(|record| competes(record) && Setting::read(&record.strategy).cones.is_some())
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
             {scene}{named}, tie in {ties} and are slower in {slower}.",
            faster.len()
        )
    })
}
