//! Indirect light by virtual point lights against the path-traced image: errors by how ranges are found,
//! pictures, and what is best at equal numbers of lights and at equal time.

use super::super::format::{ABSENT, difference, escape, number, percent, significant};
use super::area_pictures::{figure, linear};
use super::data::{Entry, entries};
use super::errors_plot::Plot;
use super::figure::{Charts, panels, part, table};
use super::shots::{Shots, Wanted};
use crate::errors::ERROR_METRICS;
use crate::results::{Record, TruthImage, Vpls};
use crate::study::{Done, MODELS, cdi, truth_of};

/// The metric by which rules are told apart in words.
const METRIC: &str = "mean_error";

/// Gain of pictures of differences over that of the images.
const GAIN: f32 = 4.0;

/// Rules of ranges, in the order of their colours, and what each is.
const RULES: [(&str, &str, &str); 4] = [
    ("average", "strategy-0", "rays, average"),
    ("maximum", "strategy-1", "rays, maximum"),
    ("random", "strategy-3", "random"),
    ("infinite", "strategy-none", "infinite"),
];

fn rule(record: &Record) -> &'static str {
    let ranges = record.vpls.as_ref().map(|vpls| vpls.ranges.as_str());
    RULES.iter().find(|(id, ..)| Some(*id) == ranges).map_or("", |(_, _, name)| name)
}

/// The curve that a record is on: over factors and spans, each size of the map by itself; rays that are set
/// otherwise by themselves.
fn series(record: &Record) -> String {
    let Some(vpls) = &record.vpls else { return String::new() };
    let side = vpls.rsm_px;
    match vpls.ranges.as_str() {
        "random" => format!("random, {side}\u{b2}"),
        "infinite" => "infinite".to_owned(),
        _ if !cdi::is_usual(vpls) => "rays, otherwise set".to_owned(),
        _ => format!("{}, {side}\u{b2}", rule(record)),
    }
}

fn class(record: &Record) -> String {
    let is_cast = |vpls: &Vpls| vpls.rays > 0 && !cdi::is_usual(vpls);
    if record.vpls.as_ref().is_some_and(is_cast) {
        return "strategy-5".to_owned();
    }
    RULES
        .iter()
        .find(|(_, _, name)| *name == rule(record))
        .map_or("strategy-none", |(_, class, _)| class)
        .to_owned()
}

/// Everything that a frame takes: lights, lists and shading, ms.
fn total_ms(record: &Record) -> f64 {
    record.vpls.as_ref().map_or(0.0, Vpls::total_ms) + record.assign_and_shade_ms()
}

/// What is set otherwise than usual: `× 3`, `0.4 to 8 m`, `8 directions`.
fn setting(record: &Record) -> String {
    let Some(vpls) = &record.vpls else { return String::new() };
    let mut parts = Vec::new();
    match vpls.random_m {
        Some([low, high]) => parts.push(format!("{} to {} m", significant(low), significant(high))),
        None if vpls.ranges != "infinite" => {
            parts.push(format!("\u{d7} {}", significant(vpls.range_scale)));
        }
        None => {}
    }
    for (said, words) in
        [(vpls.is_reflected, "reflected primary rays"), (vpls.is_corrected, "corrected rays")]
    {
        parts.extend(said.then(|| words.to_owned()));
    }
    if let Some(deep) = &vpls.deep {
        parts.push(format!(
            "{} directions of {2} x {2}, {1} rays",
            deep.directions(),
            vpls.rays,
            deep.size_px
        ));
    }
    parts.push(format!(
        "{} of {} lights",
        number(vpls.kept as f64),
        number(vpls.candidates as f64)
    ));
    parts.join(", ")
}

fn title(record: &Record) -> String {
    format!("{}: {}", rule(record), setting(record))
}

fn error(record: &Record) -> Option<f64> {
    record.truth_errors.get(METRIC).copied().flatten().filter(|error| error.is_finite())
}

/// Errors, times and pictures.
pub(super) fn indirect(
    done: &Done,
    scene: &str,
    charts: &mut Charts,
    shots: &mut Shots<'_>,
) -> String {
    let all = entries(done, scene, MODELS);
    let known: Vec<Entry<'_>> =
        all.iter().filter(|entry| !entry.record.truth_errors.is_empty()).copied().collect();
    let Some((_, truth)) = truth_of(done, scene) else { return String::new() };
    if known.is_empty() {
        return String::new();
    }
    let rows = errors_table(&known);
    let plot = Plot {
        slug: "indirect",
        title: "Error of indirect light against time",
        entries: known,
        errors: |record| &record.truth_errors,
        series,
        class,
        // A mark for each size of the map.
        shape: |record| {
            let side = record.vpls.as_ref()?.rsm_px;
            [256, 128, 64, 512].iter().position(|known| *known == side)
        },
        name: title,
        label: |record| {
            record.vpls.as_ref().map_or(String::new(), |vpls| number(f64::from(vpls.rsm_px)))
        },
        wanted: Wanted::Truth,
        time: "Lights, assign and shade",
        first: METRIC,
        ms: total_ms,
    };
    let body = plot.html(scene, charts, shots) + &rows;
    part(scene, "indirect", "Indirect light against the truth", &about(truth), &body)
        + &pictures(done, scene, shots)
}

fn about(truth: &TruthImage) -> String {
    format!(
        "One bounce of the primary light at {} x {}, without what comes straight from it: path-traced on the CPU \
         in {} s, standard error {} % of the mean. Times are those of the shadow map, the deep images, the lights, \
         their lists and shading; the number beside a point is the side of the shadow map, with a light a pixel. \
         No brightness is compensated.",
        truth.width,
        truth.height,
        significant(truth.seconds),
        percent(truth.standard_error)
    )
}

fn errors_table(entries: &[Entry<'_>]) -> String {
    let mut heads = vec![
        "ranges".to_owned(),
        "mean range <span class=\"unit\">m</span>".to_owned(),
        "lights <span class=\"unit\">ms</span>".to_owned(),
        "assign + shade <span class=\"unit\">ms</span>".to_owned(),
    ];
    heads.extend(ERROR_METRICS.iter().map(|metric| escape(metric.head)));
    let rows: Vec<Vec<String>> = entries
        .iter()
        .map(|Entry { record, .. }| {
            let vpls = record.vpls.as_ref();
            let of = |value: fn(&Vpls) -> f64| {
                vpls.map_or(ABSENT.to_owned(), |vpls| significant(value(vpls)))
            };
            let mut row = vec![
                format!("<i class=\"dot {}\"></i>{}", class(record), escape(&title(record))),
                of(|vpls| vpls.mean_range_m),
                of(Vpls::total_ms),
                significant(record.assign_and_shade_ms()),
            ];
            let cell = |id: &str| {
                let error = record.truth_errors.get(id).copied().flatten();
                error.map_or_else(|| ABSENT.to_owned(), difference)
            };
            row.extend(ERROR_METRICS.iter().map(|metric| cell(metric.id)));
            row
        })
        .collect();
    let heads: Vec<&str> = heads.iter().map(String::as_str).collect();
    table("Errors of indirect light against the truth", &heads, &rows)
}

/// The best of each rule, over all that was tried, beside the truth.
fn pictures(done: &Done, scene: &str, shots: &mut Shots<'_>) -> String {
    let Some((truth_job, truth)) = truth_of(done, scene) else { return String::new() };
    let exposure = truth.exposure;
    let Some(reference) = linear(done, &truth_job.name, Some(&truth.raw)) else {
        return String::new();
    };
    let truth_key = shots.linear(&truth_job.name, &truth.raw, exposure);
    let direct = done
        .of(scene, cdi::DIRECT)
        .find_map(|(job, results)| Some((job, results.truth_image.as_ref()?)))
        .and_then(|(job, image)| shots.file(&job.name, &image.image));
    let mut shown = Vec::new();
    for (_, _, name) in RULES {
        let Some(Entry { job, record }) = best(&entries(done, scene, MODELS), name, |_| true)
        else {
            continue;
        };
        let raw = record.images.raw.as_deref();
        let Some(image) = linear(done, &job.name, raw) else { continue };
        let own = raw.and_then(|raw| shots.linear(&job.name, raw, exposure));
        let gain = GAIN * exposure as f32;
        let apart = shots.drawn(format!("{}:difference", job.name), || {
            image.difference_png(&reference, gain).ok()
        });
        let worse = |text: &str| format!("{text}, {}.", setting(record));
        let body =
            figure(direct.clone(), "Zero bounces, path-traced", "what the light reaches itself.")
                + &figure(
                    truth_key.clone(),
                    "One bounce alone, path-traced",
                    "the truth of indirect light.",
                )
                + &figure(
                    own,
                    &format!("One bounce by lights with {name} ranges"),
                    &format!("{}.", setting(record)),
                )
                + &figure(
                    apart,
                    &format!("Difference \u{d7} {}", significant(f64::from(gain))),
                    &worse("absolute, linear; black is none; light behind walls is a leak"),
                );
        shown.push((name.to_owned(), format!("<div class=\"views\">{body}</div>\n")));
    }
    let text = "Of each rule the setting of least mean error. Indirect images are under the exposure of the truth.";
    part(scene, "pictures", "What ranges look like", text, &panels("Ranges", &shown))
}

/// The record of least error of a rule among some.
fn best<'a>(
    entries: &[Entry<'a>],
    name: &str,
    among: impl Fn(&Record) -> bool,
) -> Option<Entry<'a>> {
    let own = entries.iter().filter(|entry| rule(entry.record) == name && among(entry.record));
    own.filter(|entry| error(entry.record).is_some())
        .min_by(|a, b| error(a.record).unwrap_or(0.0).total_cmp(&error(b.record).unwrap_or(0.0)))
        .copied()
}

/// Rays as they are usually cast, at the rule and factor of least error: random ranges have as many
/// settings.
fn best_cast<'a>(entries: &[Entry<'a>]) -> Option<Entry<'a>> {
    let is_usual = |record: &Record| record.vpls.as_ref().is_some_and(cdi::is_usual);
    ["rays, average", "rays, maximum"]
        .iter()
        .filter_map(|name| best(entries, name, is_usual))
        .min_by(|a, b| error(a.record).unwrap_or(0.0).total_cmp(&error(b.record).unwrap_or(0.0)))
}

/// Random ranges of least error from the map that a record's lights come from.
fn best_random_of_map<'a>(entries: &[Entry<'a>], vpls: &Vpls) -> Option<Entry<'a>> {
    best(entries, "random", |record| {
        record.vpls.as_ref().is_some_and(|other| other.candidates == vpls.candidates)
    })
}

/// Rays against random ranges: at as many lights, and at the time of the rays.
pub(super) fn quietest(done: &Done, scene: &str) -> Vec<String> {
    let all = entries(done, scene, MODELS);
    let mut found = Vec::new();
    let Some(cast) = best_cast(&all) else { return found };
    let (Some(own), Some(vpls)) = (error(cast.record), cast.record.vpls.as_ref()) else {
        return found;
    };
    let kept = |record: &Record| record.vpls.as_ref().map_or(0, |other| other.kept);
    let same_map = best_random_of_map(&all, vpls);
    let same_count = best(&all, "random", |record| kept(record) <= vpls.kept);
    let say = |other: Entry<'_>, what: &str| {
        let theirs = error(other.record).unwrap_or(f64::NAN);
        format!(
            "In {scene} ranges by rays ({}) err by {} of the mean in {} ms; the best random ranges {what} ({}) by {} in \
             {} ms: {}.",
            setting(cast.record),
            difference(own),
            significant(total_ms(cast.record)),
            setting(other.record),
            difference(theirs),
            significant(total_ms(other.record)),
            if own < theirs { "rays are nearer to the truth" } else { "random ranges are nearer" }
        )
    };
    found.extend(same_map.map(|other| say(other, "from the same map")));
    found.extend(same_count.map(|other| say(other, "of no more lights")));
    let limit = total_ms(cast.record);
    let same_time = best(&all, "random", |record| total_ms(record) <= limit);
    found.extend(same_time.map(|other| say(other, "in no more time")));
    if let Some(other) = best(&all, "infinite", |_| true) {
        let theirs = error(other.record).unwrap_or(f64::NAN);
        found.push(format!(
            "In {scene} lights of infinite range err by {} of the mean and take {} ms.",
            difference(theirs),
            significant(total_ms(other.record))
        ));
    }
    found
}

/// Rays against random ranges from the same map, in the first scene that has both.
pub(super) fn headline(done: &Done) -> Option<String> {
    done.scenes().into_iter().find_map(|scene| {
        let all = entries(done, scene, MODELS);
        let cast = best_cast(&all)?;
        let random = best_random_of_map(&all, cast.record.vpls.as_ref()?)?;
        let (own, theirs) = (error(cast.record)?, error(random.record)?);
        Some(format!(
            "In {scene} lights with ranges by rays err by {} of the mean in {} ms, with the best random ranges by \
             {} in {} ms.",
            significant(own),
            significant(total_ms(cast.record)),
            significant(theirs),
            significant(total_ms(random.record))
        ))
    })
}

/// The setting of a rule that errs least on average over the scenes, with that error and the greatest of
/// any scene: what a renderer would set once.
fn best_in_common(done: &Done, is_of: fn(&str) -> bool) -> Option<(String, f64, f64)> {
    let scenes = done.scenes();
    let mut settings: Vec<(String, Vec<f64>)> = Vec::new();
    for scene in &scenes {
        for Entry { job, record } in entries(done, scene, MODELS) {
            let name = job.name.strip_prefix(&format!("{scene}-{MODELS}-")).unwrap_or_default();
            let Some(error) = error(record).filter(|_| is_of(name)) else { continue };
            match settings.iter_mut().find(|(known, _)| known == name) {
                Some((_, errors)) => errors.push(error),
                None => settings.push((name.to_owned(), vec![error])),
            }
        }
    }
    settings
        .into_iter()
        .filter(|(_, errors)| errors.len() == scenes.len())
        .map(|(name, errors)| {
            let worst = errors.iter().copied().fold(0.0, f64::max);
            (name, errors.iter().sum::<f64>() / errors.len() as f64, worst)
        })
        .min_by(|a, b| a.1.total_cmp(&b.1))
}

/// One setting for all scenes: rays against random ranges, where there are several scenes.
pub(super) fn in_common(done: &Done) -> Option<String> {
    let scenes = done.scenes().len();
    if scenes < 2 {
        return None;
    }
    let (_, own, own_worst) = best_in_common(done, |name| name.contains("-x"))?;
    let is_random = |name: &str| name.starts_with("random-") && !name.contains("rsm");
    let (_, theirs, their_worst) = best_in_common(done, is_random)?;
    Some(format!(
        "With one setting for all {scenes} scenes, lights with ranges by rays err by {} of the mean ({} at worst), with \
         random ranges by {} ({}).",
        significant(own),
        significant(own_worst),
        significant(theirs),
        significant(their_worst)
    ))
}
