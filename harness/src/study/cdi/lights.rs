//! How a record of virtual point lights is named, and what is measured of it.

use crate::report::format::{number, significant};
use crate::results::{Record, Vpls};

/// The metric by which sentences compare rules.
pub(crate) const METRIC: &str = "mean_error";

/// Rules of ranges, in the order of their colours, and what each is.
pub(crate) const RULES: [(&str, &str, &str); 6] = [
    ("average", "series-0", "rays, average"),
    ("maximum", "series-1", "rays, maximum"),
    ("random", "series-3", "random"),
    ("random-discard", "series-4", "random, without lights whose rays hit nothing"),
    ("constant-discard", "series-6", "constant, without lights whose rays hit nothing"),
    ("infinite", "strategy-none", "infinite"),
];

/// The name of the rule by which ranges were found.
pub(crate) fn rule(record: &Record) -> &'static str {
    let ranges = record.indirect.as_ref().map(|vpls| vpls.ranges.as_str());
    RULES.iter().find(|(id, ..)| Some(*id) == ranges).map_or("", |(_, _, name)| name)
}

/// The time of making lights, lists and shading, ms. NaN where the clock was not steady.
pub(crate) fn total_ms(record: &Record) -> f64 {
    if record.indirect.as_ref().is_some_and(|vpls| vpls.unsteady().is_some()) {
        return f64::NAN;
    }
    record.indirect.as_ref().map_or(0.0, Vpls::total_ms) + record.assign_and_shade_ms()
}

/// The settings that differ from the usual ones: `× 3`, `0.4 to 8 m`, `8 directions`.
pub(crate) fn setting(record: &Record) -> String {
    let Some(vpls) = &record.indirect else { return String::new() };
    let mut parts = Vec::new();
    match vpls.given_ranges_m {
        Some([low, high]) if low == high => parts.push(format!("{} m", significant(low))),
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

/// Its mean error against the truth, where that is finite.
pub(crate) fn error(record: &Record) -> Option<f64> {
    record.image.truth_errors.get(METRIC).copied().flatten().filter(|error| error.is_finite())
}
