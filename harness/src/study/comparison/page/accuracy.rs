//! Speed against accuracy: what each lossy knob gains in time and costs in error.

use crate::digits::rounded;
use crate::report::format::{difference, significant};
use crate::report::markup::Html;
use crate::report::rank::Ratio;
use crate::results::Record;
use crate::study::data::{entries, lines};
use crate::study::manifest::Done;
use crate::study::page::errors_plot::{FIRST, Plot};
use crate::study::page::figure::Charts;
use crate::study::page::part::Part;
use crate::study::page::shots::{Shots, Wanted};

/// The three charts of a scene.
pub(crate) fn accuracy(
    done: &Done,
    scene: &str,
    charts: &mut Charts,
    shots: &mut Shots<'_>,
) -> [Part; 2] {
    let mut html = Html::default();
    let label = |record: &Record| record.strategy.knob().unwrap_or_else(|| "lossless".to_owned());
    let series = |record: &Record| record.strategy.family().to_owned();
    let caps = Plot {
        slug: "caps",
        title: "Culling error of capped lists",
        entries: entries(done, scene, "caps"),
        errors: |record| &record.image.errors,
        series,
        class: |record| record.strategy.class(),
        shape: |_| None,
        name: |record| record.strategy.to_string(),
        label,
        wanted: Wanted::Pair,
        time: "Assign + shade",
        first: FIRST,
        ms: Record::assign_and_shade_ms,
    };
    let reuse = Plot {
        slug: "reuse",
        title: "Culling error of lists that are reused for several frames of the path",
        entries: entries(done, scene, "reuse"),
        time: "Assign + shade, mean along the path",
        ..caps
    };
    html += caps.html(scene, charts, shots);
    html += reuse.html(scene, charts, shots);
    let culling = Part::new(
        "accuracy",
        "Speed against accuracy: culling error",
        "An error is the difference from the image without culling (None), drawn by the same \
         shader. Points at the lower left are best. The staircase joins the settings that no other \
         setting beats in both time and error. The others are faded. Exact images lie in the strip \
         at error 0. Click a point to see its pictures, if they were kept.",
        html,
    );
    let ranges = Plot {
        slug: "ranges",
        title: "Error of the lights\u{2019} range",
        entries: entries(done, scene, "ranges"),
        errors: |record| &record.image.unbounded_errors,
        series: |record| {
            let cut = record.setting.cut.as_deref().unwrap_or("windowed");
            format!("{}, {cut}", record.strategy.family())
        },
        class: |record| record.strategy.class(),
        shape: |record| Some(usize::from(record.setting.cut.as_deref() == Some("hard"))),
        name: |record| record.strategy.to_string(),
        label: |record| record.setting.threshold.map_or_else(String::new, rounded),
        wanted: Wanted::Unbounded,
        time: "Assign + shade",
        first: FIRST,
        ms: Record::assign_and_shade_ms,
    };
    let ranges = Part::new(
        "ranges",
        "Speed against accuracy: the lights\u{2019} range",
        "This error is separate from the one above. Lights end at the distance where their \
         intensity falls to a threshold. The error is the difference from the image under lights \
         that have no range. It does not depend on the strategy, because lists are exact. Only the \
         time does. Each point is labelled with its threshold.",
        ranges.html(scene, charts, shots),
    );
    [culling, ranges]
}

/// The cheapest setting of a section whose error stays below a bound, in words.
pub(crate) fn cheapest(done: &Done, scene: &str, bound: f64) -> Option<String> {
    let entries = entries(done, scene, "caps");
    let fastest = |lossy: bool| {
        lines(&entries)
            .into_iter()
            .flat_map(|(_, records)| records)
            .filter(|record| record.is_lossy == lossy)
            .filter(|record| record.assign_and_shade_ms().is_finite())
            .filter(|record| {
                let error = record.image.errors.get("rel_mse").copied().flatten();
                error.is_some_and(|error| match lossy {
                    true => error > 0.0 && error <= bound,
                    false => error == 0.0,
                })
            })
            .min_by(|a, b| a.assign_and_shade_ms().total_cmp(&b.assign_and_shade_ms()))
    };
    let (lossy, lossless) = (fastest(true)?, fastest(false)?);
    let [time, exact] = [lossy, lossless].map(Record::assign_and_shade_ms);
    let error = difference(lossy.image.errors.get("rel_mse").copied().flatten().unwrap_or(0.0));
    let is_faster = Ratio::between(lossy, lossless).is_some_and(|ratio| ratio.is_faster());
    Some(if is_faster {
        format!(
            "A relMSE of {error} saves {} % of the time: {} takes {} ms, and {}, the fastest exact \
             method of the same run, takes {} ms.",
            significant((1.0 - time / exact) * 100.0),
            lossy.strategy,
            significant(time),
            lossless.strategy,
            significant(exact)
        )
    } else {
        format!(
            "No cap with a relMSE up to {bound} beats the fastest exact method, {} with {} ms.",
            lossless.strategy,
            significant(exact)
        )
    })
}
