//! Claims of the polygon-light paper about light operations, and about what is lost.

use crate::report::format::{percent, significant};
use crate::report::rank::listed;
use crate::results::{Operations, Record};
use crate::study::claims::{Answer, Outcome, Tally, Verdict};
use crate::study::endless::cases::{Case, Cut, Setting, cases, lost, seen};
use crate::study::endless::claims::rows::{bracketed, by_case, error};
use crate::study::endless::claims::times::shares;
use crate::study::manifest::Done;

/// How far a share may lie from the paper's.
const NEAR: f64 = 0.1;

/// The share of outer specular operations that a setting leaves out of those by position.
fn left_out(record: &Record, position: &Record) -> Option<f64> {
    let outer = |record: &Record| record.lists.operations.map(|all| all.outer_specular as f64);
    let (own, all) = (outer(record)?, outer(position)?);
    (all > 0.0).then(|| 1.0 - own / all)
}

/// Cones by the paper's test leave out the paper's share; other settings of as many cones stand beside them.
fn outer(done: &Done, scene: &str, count: u32, papers: f64) -> Answer {
    by_case(done, scene, true, &|case, rows| {
        let meant = rows.cones(count)?;
        let share = left_out(meant, rows.position)?;
        let figure_of = |record: &Record, share: f64| {
            format!("{} {} %{}", bracketed(record), percent(share), error(record))
        };
        let mut figures = vec![figure_of(meant, share)];
        let position = case.position();
        for record in case.culled().filter(|record| !std::ptr::eq(*record, meant)) {
            let other = Setting::read(&record.strategy);
            let is_ours = !matches!(other.cut, Cut::ConeTest(_)) && other.exits;
            if other.cones == Some(count) && is_ours {
                figures.push(figure_of(record, left_out(record, position?)?));
            }
        }
        Some((figures.join(", "), Outcome::from((share - papers).abs() <= NEAR)))
    })
}

pub(crate) fn outer_54(done: &Done, scene: &str) -> Answer {
    outer(done, scene, 54, 0.8)
}

pub(crate) fn outer_24(done: &Done, scene: &str) -> Answer {
    outer(done, scene, 24, 0.54)
}

/// What a specular radius half as large again adds to the operations of `dif`; where that was not measured,
/// to twice the diffuse terms, which are the same. Judged at A with fewest lights, the paper's case.
pub(crate) fn growth(done: &Done, scene: &str) -> Answer {
    const PAPERS: f64 = 0.54;
    let (mut figures, mut judged) = (Vec::new(), None);
    for case in cases(done, scene) {
        let Some(all) = case.position().and_then(|record| record.lists.operations) else {
            continue;
        };
        let dif = case.find(|s| s.cut == Cut::Diffuse).and_then(|record| record.lists.operations);
        let inner = dif.map_or(2 * all.diffuse, |dif| dif.listed());
        let growth = all.listed() as f64 / inner.max(1) as f64 - 1.0;
        figures.push(format!("{}: {} % more", case.name(), percent(growth)));
        if case.place == "a" {
            judged.get_or_insert((growth - PAPERS).abs() <= NEAR);
        }
    }
    match judged {
        Some(is_near) => Answer {
            figure: figures.join("; "),
            verdict: Verdict::of_parts(usize::from(is_near), 1, "cases"),
        },
        None => Answer::unknown("light operations at A"),
    }
}

/// Listed terms over those of them that would be seen.
fn waste(record: &Record) -> Option<f64> {
    let operations = record.lists.operations.as_ref()?;
    Some(operations.listed() as f64 / seen(operations).max(1) as f64)
}

/// Cones list fewer terms in vain than position does: fewer by 24 and by 54.
pub(crate) fn in_vain(done: &Done, scene: &str) -> Answer {
    by_case(done, scene, true, &|_, rows| {
        let all = waste(rows.position)?;
        let cones = shares(rows, waste);
        let shown: Vec<String> = cones
            .iter()
            .map(|(count, waste)| format!("{count} cones {}", significant(*waste)))
            .collect();
        let many = cones.iter().filter(|(count, _)| *count >= 24);
        let is_less = many.clone().count() > 0 && many.clone().all(|(_, waste)| *waste < all);
        Some((format!("position {}, {}", significant(all), listed(&shown)), Outcome::from(is_less)))
    })
}

/// The share of terms that would be seen and that cones lose.
fn lost_share(record: &Record, position: &Operations) -> Option<f64> {
    let operations = record.lists.operations?;
    operations.perceptible_listed?;
    Some(lost(&operations, position).0 as f64 / seen(position).max(1) as f64)
}

/// The paper's cones lose 6 and 9 % of the terms that would be seen.
pub(crate) fn seen_lost(done: &Done, scene: &str) -> Answer {
    by_case(done, scene, true, &|_, rows| {
        let position = rows.position.lists.operations?;
        let shares = shares(rows, |record| lost_share(record, &position));
        let find = |wanted: u32| shares.iter().find(|(count, _)| *count == wanted).map(|(_, s)| *s);
        let (few, many) = (find(24)?, find(54)?);
        let is_near = (few - 0.057).abs() <= 0.03 && (many - 0.092).abs() <= 0.03;
        let shown: Vec<String> = shares
            .iter()
            .filter_map(|(count, share)| {
                let record = rows.cones(*count)?;
                Some(format!("{count} cones {} %{}", percent(*share), error(record)))
            })
            .collect();
        Some((listed(&shown), Outcome::from(is_near)))
    })
}

/// 54 cones over the whole radius: our cut by radiance, the mildest, against the paper's estimate.
pub(crate) fn inner(done: &Done, scene: &str) -> Answer {
    const PAPERS: f64 = 1.25;
    let mut tally = Tally::default();
    for case in cases(done, scene) {
        let mut cut: Vec<(f32, &Record)> = case
            .culled()
            .filter_map(|record| {
                let setting = Setting::read(&record.strategy);
                match setting.cut {
                    Cut::Below(radiance) if setting.cones == Some(54) => Some((radiance, record)),
                    _ => None,
                }
            })
            .collect();
        cut.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, mildest)) = cut.first() else { continue };
        let Some(ratio) = waste(mildest) else { continue };
        let shown: Vec<String> = cut
            .iter()
            .filter_map(|(_, record)| {
                let ratio = significant(waste(record)?);
                Some(format!("{} {ratio}{}", bracketed(record), error(record)))
            })
            .collect();
        tally.add(ratio <= PAPERS + NEAR, format!("{}: {}", case.name(), shown.join(", ")));
    }
    tally.answer("cases", "light operations by 54 cones with a cut")
}

fn flip(record: &Record) -> Option<f64> {
    record.image.errors.get("flip").copied().flatten()
}

/// 6 cones by the paper's test lose more than 24 and 54 do.
pub(crate) fn tracking(done: &Done, scene: &str) -> Answer {
    by_case(done, scene, true, &|_, rows| {
        let flips = shares(rows, flip);
        let find = |wanted: u32| flips.iter().find(|(count, _)| *count == wanted).map(|(_, f)| *f);
        let six = find(6)?;
        let others = flips.iter().filter(|(count, _)| *count != 6);
        let is_worst = others.clone().count() > 0 && others.clone().all(|(_, flip)| *flip < six);
        let shown: Vec<String> = flips
            .iter()
            .map(|(count, flip)| format!("{count} cones FLIP {}", significant(*flip)))
            .collect();
        Some((listed(&shown), Outcome::from(is_worst)))
    })
}

/// From this mean FLIP on, specular light that ends with diffuse light is taken to show.
const SHOWS: f64 = 0.01;

/// `dif` shows at B, and not at A and C.
pub(crate) fn artefact(done: &Done, scene: &str) -> Answer {
    let mut tally = Tally::default();
    for case in cases(done, scene) {
        let dif = |case: &Case<'_>| case.find(|s| s.cut == Cut::Diffuse).and_then(flip);
        let Some(flip) = dif(&case) else { continue };
        let figure = format!("{}: FLIP {}", case.name(), significant(flip));
        tally.add((flip >= SHOWS) == (case.place == "b"), figure);
    }
    tally.answer("cases", "specular light that ends with diffuse light")
}
