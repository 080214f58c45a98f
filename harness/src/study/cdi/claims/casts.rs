//! What the deep-image paper claims of casting rays through deep images.

use crate::report::format::{percent, significant};
use crate::results::{CastTimes, PassKind, Vpls, median};
use crate::study::cdi::claims::builds::usual;
use crate::study::cdi::claims::scenes::{other, too_alike};
use crate::study::cdi::jobs;
use crate::study::cdi::times::{runs, timed_casts, timed_runs};
use crate::study::claims::{Answer, Verdict, on_another_gpu};
use crate::study::data::entries;
use crate::study::manifest::Done;

/// Passes of the lights, ms.
fn passes_ms(vpls: &Vpls, is_own: fn(&str) -> bool) -> f64 {
    let passes = vpls.passes.iter().filter(|(pass, _)| is_own(pass));
    passes.map(|(_, times)| times.median_ms).sum()
}

pub(crate) fn cast_share(done: &Done, scene: &str) -> Answer {
    /// Half and twice the paper's 1 %.
    const ABOUT: std::ops::RangeInclusive<f64> = 0.005..=0.02;
    let all = entries(done, scene, jobs::STEPS);
    let steps = all.first().and_then(|entry| Some((entry.record, entry.record.indirect.as_ref()?)));
    let Some((record, vpls)) = steps.filter(|(_, vpls)| vpls.unsteady().is_none()) else {
        return Answer::unknown("the steps of a frame at a steady clock");
    };
    let lights_ms = passes_ms(vpls, |pass| pass.starts_with("vpl-") || pass.ends_with("ranges"));
    let cast_ms = passes_ms(vpls, |pass| pass.ends_with("ranges"));
    let scene_ms = record.times.passes.median_ms(Some(PassKind::Scene));
    let total_ms = vpls.total_ms() + scene_ms + record.assign_and_shade_ms();
    let figure = format!(
        "choosing lights and casting rays takes {} of {} ms, {} %; only casting takes {} ms",
        significant(lights_ms),
        significant(total_ms),
        percent(lights_ms / total_ms),
        significant(cast_ms)
    );
    let share = lights_ms / total_ms;
    let verdict = match ABOUT.contains(&share) {
        true => Verdict::Holds,
        false => Verdict::Differs(format!("{} %", percent(share))),
    };
    Answer { figure, verdict }
}

/// Times of rays through arrays that count, of maps of the whole scene, from the smallest map on.
pub(crate) fn casts<'a>(done: &'a Done, scene: &'a str) -> Vec<&'a CastTimes> {
    let all = runs(done, scene, jobs::CASTS).into_iter();
    let arrays = all.filter(|run| run.deep.build != "linked-lists");
    let mut casts: Vec<&CastTimes> = arrays
        .flat_map(|run| timed_casts(done, scene, run))
        .filter(|cast| !cast.is_middle)
        .collect();
    casts.sort_by_key(|cast| cast.rsm_px);
    casts
}

fn rays_of(cast: &CastTimes) -> f64 {
    cast.lights as f64 * f64::from(cast.rays)
}

pub(crate) fn rays_linear(done: &Done, scene: &str) -> Answer {
    /// Exponents that are called nearly linear; the paper's are 0.88 and 0.89.
    const NEARLY: std::ops::RangeInclusive<f64> = 0.8..=1.2;
    let all = casts(done, scene);
    let exponent = |a: &CastTimes, b: &CastTimes| {
        let ms = median(&b.cast_ms) / median(&a.cast_ms);
        ms.ln() / (rays_of(b) / rays_of(a)).ln()
    };
    let ([first, .., last], [.., before, _]) = (&all[..], &all[..]) else {
        return Answer::unknown("rays from two sizes of map at a steady clock");
    };
    let (whole, end) = (exponent(first, last), exponent(before, last));
    let figure = format!(
        "{} times the rays take {} times as long, an exponent of {whole:.2}; from {2} x {2} to {3} \
         x {3} pixels, the exponent is {end:.2}",
        significant(rays_of(last) / rays_of(first)),
        significant(median(&last.cast_ms) / median(&first.cast_ms)),
        before.rsm_px,
        last.rsm_px
    );
    let verdict = match (NEARLY.contains(&whole), NEARLY.contains(&end)) {
        (true, _) => Verdict::Holds,
        (false, true) => Verdict::Differs(
            "only between the largest maps, because few rays do not fill this GPU".into(),
        ),
        (false, false) => Verdict::Fails,
    };
    Answer { figure, verdict }
}

pub(crate) fn against_random(done: &Done, scene: &str) -> Answer {
    /// Half and twice the paper's ten.
    const ABOUT: std::ops::RangeInclusive<f64> = 5.0..=20.0;
    let all = casts(done, scene);
    let ratio = |cast: &&CastTimes| median(&cast.cast_ms) / median(&cast.random_ms);
    let ratios: Vec<f64> = all.iter().map(ratio).collect();
    let sizes: Vec<String> = all
        .iter()
        .zip(&ratios)
        .map(|(cast, ratio)| {
            format!("{0} x {0} pixels: {1} times", cast.rsm_px, significant(*ratio))
        })
        .collect();
    let good = ratios.iter().filter(|ratio| ABOUT.contains(ratio)).count();
    Answer {
        figure: sizes.join("; "),
        verdict: Verdict::of_parts(good, ratios.len(), "sizes of map"),
    }
}

pub(crate) fn rate(done: &Done, scene: &str) -> Answer {
    /// Rays a millisecond: 25 million in 20 ms.
    const PAPER: f64 = 25e6 / 20.2;
    /// Half to twice the paper's rate.
    const ABOUT: std::ops::RangeInclusive<f64> = 0.5..=2.0;
    let all = casts(done, scene);
    let Some(last) = all.last() else { return Answer::unknown("rays at a steady clock") };
    let ms = median(&last.cast_ms);
    let figure = format!(
        "{} million rays in {} ms, {} thousand million a second; the paper has {} thousand million",
        significant(rays_of(last) / 1e6),
        significant(ms),
        significant(rays_of(last) / ms / 1e6),
        significant(PAPER / 1e6)
    );
    let share = rays_of(last) / ms / PAPER;
    let verdict = match on_another_gpu(done, "GTX 1060") {
        Some(verdict) => verdict,
        None if ABOUT.contains(&share) => Verdict::Holds,
        None if share > 1.0 => Verdict::Differs("more than twice the rate".into()),
        None => Verdict::Fails,
    };
    Answer { figure, verdict }
}

pub(crate) fn geometry(done: &Done, scene: &str) -> Answer {
    /// The paper's text.
    const MOST: f64 = 1.1;
    let simple = match other(done, scene) {
        Ok(simple) => simple,
        Err(answer) => return answer,
    };
    let per_ray = |scene| {
        let all = casts(done, scene);
        all.last().map(|cast| (cast.rsm_px, median(&cast.cast_ms) / rays_of(cast)))
    };
    let (Some((px, own)), Some((known_px, known))) = (per_ray(scene), per_ray(simple)) else {
        return Answer::unknown("rays at a steady clock in both scenes");
    };
    if px != known_px {
        return Answer::unknown("rays from maps of one size");
    }
    let figure = format!("{} times the time per ray in {simple}", significant(own / known));
    let verdict = match too_alike(done, scene, simple) {
        Some(verdict) => verdict,
        None if own / known <= MOST => Verdict::Holds,
        None => Verdict::Fails,
    };
    Answer { figure, verdict }
}

pub(crate) fn arrays(done: &Done, scene: &str) -> Answer {
    let build = |wanted: &str| {
        let mut all = timed_runs(done, scene, jobs::BUILDS);
        all.retain(|run| run.deep.build == wanted && run.deep.oversampling == 1);
        let most = all.iter().map(|run| run.deep.directions()).max()?;
        let usual_px = usual(done, scene, "compute")?.deep.size_px;
        all.retain(|run| run.deep.directions() == most && run.deep.size_px == usual_px);
        all.first().map(|run| run.build_ms())
    };
    let cast = |linked: bool| {
        let all = runs(done, scene, jobs::CASTS).into_iter();
        let found = all.filter(|run| (run.deep.build == "linked-lists") == linked);
        let whole =
            found.flat_map(|run| timed_casts(done, scene, run)).filter(|cast| !cast.is_middle);
        whole.max_by_key(|cast| cast.rsm_px).map(|cast| (cast.rsm_px, median(&cast.cast_ms)))
    };
    let builds = build("linked-lists").zip(build("compute"));
    let (Some((list_ms, array_ms)), Some((linked, arrays))) = (builds, cast(true).zip(cast(false)))
    else {
        return Answer::unknown("builds and rays through both, at a steady clock");
    };
    if linked.0 != arrays.0 {
        return Answer::unknown("rays from maps of one size");
    }
    let figure = format!(
        "linked lists: build {} ms, cast {} ms; arrays: build {} ms, cast {} ms",
        significant(list_ms),
        significant(linked.1),
        significant(array_ms),
        significant(arrays.1)
    );
    let parts = [list_ms < array_ms, arrays.1 < linked.1, array_ms + arrays.1 < list_ms + linked.1];
    let good = parts.iter().filter(|part| **part).count();
    Answer { figure, verdict: Verdict::of_parts(good, parts.len(), "statements") }
}
