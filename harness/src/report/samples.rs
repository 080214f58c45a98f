//! Every sample of every pass, as a tick beside its median.

use super::colours::Colours;
use super::format::{number, percent, significant};
use super::markup::{Html, html};
use crate::chart::{Strip, half_width};
use crate::results::{PassTimes, Record};

/// The samples of all records of a comparison, a group of rows per strategy; empty where there is no pass.
pub(crate) fn samples(records: &[&Record], colours: &Colours<'_>) -> Html {
    let mut strips: Vec<(&Record, &PassTimes, Strip)> = Vec::new();
    for record in records {
        for (name, times) in record.times.passes.iter() {
            strips.push((record, times, strip(record, name, times, colours)));
        }
    }
    if strips.is_empty() {
        return Html::default();
    }
    let half = half_width(strips.iter().map(|(_, _, strip)| strip));
    let mut groups = Html::default();
    for record in records {
        let of_record = strips.iter_mut().filter(|(other, _, _)| std::ptr::eq(*other, *record));
        let rows: Html = of_record
            .map(|(_, times, strip)| {
                strip.half_width = half;
                row(times, strip)
            })
            .collect();
        let class = record.strategy.class();
        groups += html!(
            "<tbody><tr><th scope=\"rowgroup\" class=\"strategy\" colspan=\"4\">\
             <i class=\"dot {}\"></i>{}</th></tr>\n{}</tbody>\n",
            class,
            record.strategy.as_str(),
            rows
        );
    }
    let side = percent(half);
    html!(
        "<figure class=\"samples\"><figcaption><h3>Every sample</h3></figcaption>\n\
         <p class=\"note\">One tick per frame. Its place is its distance from the median of its pass. Ticks \
         close together mean that the clock is steady.</p>\n\
         <div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"Samples of every pass\"><table>\n\
         <thead><tr><th scope=\"col\">pass</th>\
         <th scope=\"col\" class=\"number\">median <span class=\"unit\">ms</span></th>\
         <th scope=\"col\" class=\"number\">p95 <span class=\"unit\">ms</span></th>\
         <th scope=\"col\" class=\"wide\"><span class=\"ends\"><span>\u{2212}{0} %</span><span>median</span>\
         <span>+{0} %</span></span></th></tr></thead>\n{1}</table></div></figure>\n",
        side,
        groups
    )
}

fn strip(record: &Record, name: &str, times: &PassTimes, colours: &Colours<'_>) -> Strip {
    Strip {
        name: name.to_owned(),
        class: colours.pass(name).to_owned(),
        title: format!("{}, {name}: {}", record.strategy, described(times)),
        samples: times.samples.clone(),
        median: times.median_ms,
        half_width: 1.0,
    }
}

/// `6 samples from 1.10 to 1.30 ms, median 1.20 ms, 95th percentile 1.29 ms`.
fn described(times: &PassTimes) -> String {
    let finite = || times.samples.iter().copied().filter(|sample| sample.is_finite());
    let count = finite().count();
    if count == 0 {
        return "no sample".to_owned();
    }
    let (least, most) = (finite().fold(f64::INFINITY, f64::min), finite().fold(0.0, f64::max));
    format!(
        "{} samples from {} to {} ms, median {} ms, 95th percentile {} ms",
        number(count as f64),
        significant(least),
        significant(most),
        significant(times.median_ms),
        significant(times.p95_ms)
    )
}

fn row(times: &PassTimes, strip: &Strip) -> Html {
    let beyond = match strip.beyond() {
        0 => Html::default(),
        count => html!("<span class=\"outside\">{} further out \u{25b8}</span>", count),
    };
    // Charts escape their text themselves.
    let drawing = Html::trusted(strip.to_svg());
    html!(
        "<tr><th scope=\"row\"><i class=\"dot {}\"></i>{}</th><td>{}</td><td>{}</td>\
         <td class=\"wide\">{}{}</td></tr>\n",
        strip.class,
        strip.name,
        significant(times.median_ms),
        significant(times.p95_ms),
        drawing,
        beyond
    )
}
