//! Describes a stage and its faults, on the terminal and in the results.

use shading::Cut;

use crate::{
    choice::Choice,
    messages::say,
    report::significant,
    results::{RejectedLight, Results},
    stage::Stage,
};

/// The most left-out lights that the terminal names; the results name all of them.
const MOST_REJECTED_SHOWN: usize = 20;

/// Adds the faults of the scene and its lights to the results.
pub(crate) fn note_faults(results: &mut Results, stage: &Stage) {
    results.warnings.extend(stage.scene.warnings.iter().cloned());
    results.warnings.extend(stage.notes.iter().cloned());
    results.warnings.extend(stage.open_lights.map(|open| open.note()));
    let rejected = stage.rejected().iter();
    results.rejected_lights = rejected
        .map(|rejected| RejectedLight {
            scene: stage.scene.name.clone(),
            index: rejected.index as u64,
            reason: rejected.fault.to_string(),
        })
        .collect();
}

/// Says which methods fail on purpose, and how.
pub(crate) fn note_flaws(results: &mut Results, choices: &[Choice], cut: Cut) {
    for choice in choices {
        if let Some(flaw) = choice.id().flaw() {
            let words = format!("{} fails on purpose: {}", choice.id(), flaw.fails);
            results.warnings.push(words);
        }
    }
    if cut == Cut::Never && choices.iter().any(Choice::culls) {
        let words = "with --cut never lights go on beyond the ranges that lists are made for, so every strategy \
                     that culls loses light on purpose";
        results.warnings.push(words.to_owned());
    }
}

/// Prints the contents and the faults of a stage.
pub(crate) fn describe(stage: &Stage) {
    say(format!(
        "scene    {}: {} triangles, {} models, {} lights{}",
        stage.scene.name,
        stage.scene.triangle_count(),
        stage.scene.models.len(),
        stage.light_count(),
        match stage.suns.as_slice().len() {
            0 => String::new(),
            1 => ", 1 sun".to_owned(),
            count => format!(", {count} suns"),
        }
    ));
    if let Some(open) = &stage.open_lights {
        say(format!("lights   {}", open.note()));
    }
    if stage.vpls.is_none() && stage.lights.count() as usize > stage.own_lights + 1 {
        say(format!(
            "lights   scattered with a mean radius of {} m",
            significant(stage.radius_scale)
        ));
    }
    for warning in stage.scene.warnings.iter().chain(&stage.notes) {
        say(format!("warning  {warning}"));
    }
    let rejected = stage.rejected();
    for rejected in rejected.iter().take(MOST_REJECTED_SHOWN) {
        say(format!("warning  light {} is left out: {}", rejected.index, rejected.fault));
    }
    if rejected.len() > MOST_REJECTED_SHOWN {
        let more = rejected.len() - MOST_REJECTED_SHOWN;
        say(format!("warning  {more} more lights are left out"));
    }
}
