//! Claims of the polygon-light paper about light operations, and about what is lost.

use crate::report::format::{percent, significant};
use crate::report::rank::listed;
use crate::results::{Operations, Record};
use crate::study::claims::{Answer, Verdict};
use crate::study::endless::cases::{Case, Cut, Setting, cases, lost, seen, setting};
use crate::study::endless::claims::rows::{Outcome, by_case, error, verdict};
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
        let of = |record: &Record, share: f64| {
            format!("{} {} %{}", setting(&record.strategy), percent(share), error(record))
        };
        let mut said = vec![of(meant, share)];
        let position = case.position();
        for record in case.culled().filter(|record| !std::ptr::eq(*record, meant)) {
            let own = Setting::of(&record.strategy);
            let is_ours = !matches!(own.cut, Cut::ConeTest(_)) && own.exits;
            if own.cones == Some(count) && is_ours {
                said.push(of(record, left_out(record, position?)?));
            }
        }
        Some((said.join(", "), Outcome::good_if((share - papers).abs() <= NEAR)))
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
        let said: Vec<String> = cones
            .iter()
            .map(|(count, waste)| format!("{count} cones {}", significant(*waste)))
            .collect();
        let many = cones.iter().filter(|(count, _)| *count >= 24);
        let is_less = many.clone().count() > 0 && many.clone().all(|(_, waste)| *waste < all);
        Some((
            format!("position {}, {}", significant(all), listed(&said)),
            Outcome::good_if(is_less),
        ))
    })
}

/// The share of terms that would be seen and that cones lose.
fn lost_share(record: &Record, position: &Operations) -> Option<f64> {
    let own = record.lists.operations?;
    own.perceptible_listed?;
    Some(lost(&own, position).0 as f64 / seen(position).max(1) as f64)
}

/// The paper's cones lose 6 and 9 % of the terms that would be seen.
pub(crate) fn seen_lost(done: &Done, scene: &str) -> Answer {
    by_case(done, scene, true, &|_, rows| {
        let position = rows.position.lists.operations?;
        let shares = shares(rows, |record| lost_share(record, &position));
        let of = |wanted: u32| shares.iter().find(|(count, _)| *count == wanted).map(|(_, s)| *s);
        let (few, many) = (of(24)?, of(54)?);
        let is_near = (few - 0.057).abs() <= 0.03 && (many - 0.092).abs() <= 0.03;
        let said: Vec<String> = shares
            .iter()
            .filter_map(|(count, share)| {
                let record = rows.cones(*count)?;
                Some(format!("{count} cones {} %{}", percent(*share), error(record)))
            })
            .collect();
        Some((listed(&said), Outcome::good_if(is_near)))
    })
}

/// 54 cones over the whole radius: our cut by radiance, the mildest, against the paper's estimate.
pub(crate) fn inner(done: &Done, scene: &str) -> Answer {
    const PAPERS: f64 = 1.25;
    let (mut figures, mut outcomes) = (Vec::new(), Vec::new());
    for case in cases(done, scene) {
        let mut cut: Vec<(f32, &Record)> = case
            .culled()
            .filter_map(|record| {
                let own = Setting::of(&record.strategy);
                match own.cut {
                    Cut::Below(radiance) if own.cones == Some(54) => Some((radiance, record)),
                    _ => None,
                }
            })
            .collect();
        cut.sort_by(|a, b| a.0.total_cmp(&b.0));
        let Some((_, mildest)) = cut.first() else { continue };
        let Some(ratio) = waste(mildest) else { continue };
        outcomes.push(Outcome::good_if(ratio <= PAPERS + NEAR));
        let said: Vec<String> = cut
            .iter()
            .filter_map(|(_, record)| {
                let ratio = significant(waste(record)?);
                Some(format!("{} {ratio}{}", setting(&record.strategy), error(record)))
            })
            .collect();
        figures.push(format!("{}: {}", case.name(), said.join(", ")));
    }
    if outcomes.is_empty() {
        return Answer::unknown("light operations by 54 cones with a cut");
    }
    Answer { figure: figures.join("; "), verdict: verdict(&outcomes) }
}

fn flip(record: &Record) -> Option<f64> {
    record.image.errors.get("flip").copied().flatten()
}

/// 6 cones by the paper's test lose more than 24 and 54 do.
pub(crate) fn tracking(done: &Done, scene: &str) -> Answer {
    by_case(done, scene, true, &|_, rows| {
        let flips = shares(rows, flip);
        let of = |wanted: u32| flips.iter().find(|(count, _)| *count == wanted).map(|(_, f)| *f);
        let six = of(6)?;
        let others = flips.iter().filter(|(count, _)| *count != 6);
        let is_worst = others.clone().count() > 0 && others.clone().all(|(_, flip)| *flip < six);
        let said: Vec<String> = flips
            .iter()
            .map(|(count, flip)| format!("{count} cones FLIP {}", significant(*flip)))
            .collect();
        Some((listed(&said), Outcome::good_if(is_worst)))
    })
}

/// From this mean FLIP on, specular light that ends with diffuse light is taken to show.
const SHOWS: f64 = 0.01;

/// `dif` shows at B, and not at A and C.
pub(crate) fn artefact(done: &Done, scene: &str) -> Answer {
    let (mut figures, mut good, mut all) = (Vec::new(), 0, 0);
    for case in cases(done, scene) {
        let dif = |case: &Case<'_>| case.find(|s| s.cut == Cut::Diffuse).and_then(flip);
        let Some(flip) = dif(&case) else { continue };
        all += 1;
        good += usize::from((flip >= SHOWS) == (case.place == "b"));
        figures.push(format!("{}: FLIP {}", case.name(), significant(flip)));
    }
    if all == 0 {
        return Answer::unknown("specular light that ends with diffuse light");
    }
    Answer { figure: figures.join("; "), verdict: Verdict::of_parts(good, all, "cases") }
}
