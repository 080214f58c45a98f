//! What the engine paper (Dobetsberger 2025) claims of linearly transformed cosines.

use shading::ltc::{POLYNOMIAL_COMPONENTS, Polynomial, Table};

use crate::report::finding::lights as words_of;
use crate::report::format::{difference, significant};
use crate::study::area::claims::cost::{Faster, at, by_lights, faster, time};
use crate::study::area::claims::errors::{REFLECTED, UNIFORM, by_flip, error_of};
use crate::study::area::page::models::family;
use crate::study::claims::{Answer, Check, Verdict};
use crate::study::manifest::Done;

/// Errors this near are nearly equal; the paper's two differ by 0.43 %.
const HARDLY: f64 = 0.01;

pub(crate) const TABLES: Check = Check {
    id: "tables",
    place: "table 5.1",
    words: "The engine\u{2019}s table and that of the exact GGX give nearly equal errors; the exact one\u{2019}s is \
            slightly less.",
    paper: "FLIP 0.39606 and 0.39435; LPIPS 0.20339 and 0.20316",
    departure: "no LPIPS. \u{201c}Nearly equal\u{201d} means within 1 %",
    decide: |done, scene| {
        let models = [("ltc-hammon", "engine\u{2019}s (ltc-hammon)"), ("ltc", "exact (ltc)")];
        by_flip(done, scene, models, "both tables", |engine, exact| {
            let is_slight = (engine / exact - 1.0).abs() <= HARDLY;
            match (exact <= engine, is_slight) {
                (true, true) => Verdict::Holds,
                (true, false) => Verdict::Differs("the exact one is clearly nearer".to_owned()),
                (false, true) => {
                    Verdict::Differs("nearly equal; the engine\u{2019}s is nearer".to_owned())
                }
                (false, false) => Verdict::Fails,
            }
        })
    },
};

/// Root mean square error of the polynomials over the table's entries.
const FIT_RMSE: f64 = 0.11;

pub(crate) const POLYNOMIAL_FIT: Check = Check {
    id: "polynomial-fit",
    place: "section 5.4.3, figure 5.15",
    words: "Polynomials of low degree fit the table.",
    paper: "root mean square error below 0.11 for every component at degree 5",
    departure: "we fit M^-1 with degree 6 over roughness and sqrt(1 - cos view). The paper fits M \
                over the angle",
    decide: |_, _| {
        let Ok(table) = Table::ggx() else { return Answer::unknown("the table") };
        let errors = Polynomial::ggx().rms_errors(&table);
        let good = errors.iter().filter(|error| **error < FIT_RMSE).count();
        let told = POLYNOMIAL_COMPONENTS.iter().zip(errors);
        let told = told.map(|(name, error)| format!("{name} {}", significant(error)));
        let figure = format!("root mean square errors: {}", told.collect::<Vec<_>>().join(", "));
        Answer { figure, verdict: Verdict::of_parts(good, errors.len(), "components") }
    },
};

pub(crate) const POLYNOMIAL_IMAGE: Check = Check {
    id: "polynomial-image",
    place: "section 5.4.3, figure 5.17",
    words: "Images by polynomials and by the table look the same.",
    paper: "root mean square error below 0.01",
    departure: "the two images are not compared with each other, only with the truth",
    decide: |done, scene| {
        let models = [("ltc-polynomial", "polynomials"), ("ltc", "table")];
        by_flip(done, scene, models, "polynomials and the table", |_, _| {
            Verdict::unmeasured("the difference of the two images")
        })
    },
};

pub(crate) const TABLE_OR_POLYNOMIAL: Check = Check {
    id: "table-or-polynomial",
    place: "section 5.4.3, figure 5.18",
    words: "The table is as fast as polynomials for one light, and faster for many.",
    paper: "a figure without numbers: similar at 16 lights, then a gap that grows",
    departure: "both find the lobe once per light, as the paper does. The table is in a storage \
                buffer, not in a texture. Judged by whole frames; shading is shown too",
    decide: |done, scene| {
        let pair = |lights| {
            let polynomial = at(done, scene, "ltc-polynomial-per-light", lights)?;
            Some((at(done, scene, "ltc-per-light", lights)?, polynomial))
        };
        let (Some(one), Some(many)) = (pair(1), pair(64)) else {
            return Answer::unknown("look-ups per light at 1 and 64 lights");
        };
        let told = [(1, Some(one)), (16, pair(16)), (64, Some(many))];
        let told = told.into_iter().filter_map(|(lights, pair)| {
            let (table, polynomial) = pair?;
            let lights = words_of(lights);
            Some(format!("{lights}: table {}, polynomials {}", time(table), time(polynomial)))
        });
        let mut figure = told.collect::<Vec<_>>().join("; ");
        let once = [at(done, scene, "ltc", 64), at(done, scene, "ltc-polynomial", 64)];
        if let [Some(table), Some(polynomial)] = once {
            figure += &format!(
                "; 64 lights, with the lobe found once per sample: table {}, polynomials {}",
                time(table),
                time(polynomial)
            );
        }
        let verdict = match (faster(one.0, one.1), faster(many.0, many.1)) {
            (Faster::Tie, Faster::First) => Verdict::Holds,
            (_, Faster::First) => Verdict::Differs("not the same for one light".to_owned()),
            (_, Faster::Tie) => Verdict::Differs("a tie at 64 lights, too".to_owned()),
            (_, Faster::Second) => Verdict::Fails,
        };
        Answer { figure, verdict }
    },
};

/// By how much FLIP must rise without splitting for artefacts to be in the picture.
const SHOWS: f64 = 0.02;

pub(crate) const SPLITTING: Check = Check {
    id: "splitting",
    place: "section 5.4.4, figure 5.19",
    words: "Long edges give noisy highlights, and splitting them removes the noise.",
    paper: "pictures only",
    departure: "the lights of the study are at most five times as long as wide. A test of shading \
                has a light of 1,000 to 1: it shows the noise, and splitting removes it",
    decide: |done, scene| {
        let models = [("ltc-unsplit", "unsplit"), ("ltc", "split")];
        by_flip(done, scene, models, "ltc-unsplit", |before, after| {
            if before > after * (1.0 + SHOWS) {
                Verdict::Holds
            } else if after > before * (1.0 + SHOWS) {
                Verdict::Fails
            } else {
                Verdict::undecided("no edge of this view is long enough")
            }
        })
    },
};

/// Up to this ratio of shading, splitting edges costs little.
const LITTLE: f64 = 1.1;

pub(crate) const SPLITTING_COST: Check = Check {
    id: "splitting-cost",
    place: "section 5.5.3",
    words: "Splitting edges costs little.",
    paper: "without it MRP\u{2019}s lead of 30 % is only slightly lower",
    departure: "split edges use another polynomial for the angle than unsplit ones. \
                \u{201c}Little\u{201d} means at most 10 % of shading",
    decide: |done, scene| {
        by_lights(done, scene, ["ltc", "ltc-unsplit"], |split, unsplit| {
            let ratio = split.times.shade_ms / unsplit.times.shade_ms;
            let figure =
                format!("with split edges, shading takes {} times as long", significant(ratio));
            (figure, ratio <= LITTLE)
        })
    },
};

pub(crate) const LEAST: Check = Check {
    id: "least",
    place: "table 5.2",
    words: "LTC is nearest to the truth of all algorithms.",
    paper: "FLIP 0.39245; MRP 0.51880, stochastic 0.51994 to 0.52226",
    departure: "stochastic algorithms have up to 32 samples. Uniform samples, which are not the \
                paper\u{2019}s, compete too. mrp-published is our reading of equation 5.5, so MRP counts where mrp agrees with it",
    decide: least,
};

/// MRP by our reading of equation 5.5, and with derived weights.
const MRP: [&str; 2] = ["mrp-published", "mrp"];

/// LTC's FLIP is below that of every other algorithm of the paper, and of uniform samples.
fn least(done: &Done, scene: &str) -> Answer {
    let flip = |model: &str| error_of(done, scene, model, "flip");
    let Some(ltc) = flip("ltc") else { return Answer::unknown("ltc") };
    let sampled = [2, 8, 32, 4, 16, 64]
        .into_iter()
        .flat_map(|samples| [REFLECTED, UNIFORM].map(|family| format!("{family}:{samples}")));
    let others: Vec<(String, f64)> = sampled
        .chain(MRP.map(str::to_owned))
        .filter_map(|name| flip(&name).map(|error| (name, error)))
        .collect();
    let Some(nearest) = others.iter().min_by(|a, b| a.1.total_cmp(&b.1)) else {
        return Answer::unknown("another algorithm");
    };
    let figure = format!(
        "FLIP of ltc: {}; least FLIP of the others: {} with {}",
        difference(ltc),
        nearest.0,
        difference(nearest.1)
    );
    let nearer: Vec<&str> =
        others.iter().filter(|other| other.1 <= ltc).map(|other| other.0.as_str()).collect();
    let by_mrp = MRP.iter().filter(|name| nearer.contains(name)).count();
    let is_beaten = by_mrp == MRP.len() || nearer.iter().any(|name| family(name) == REFLECTED);
    let verdict = match (is_beaten, by_mrp, nearer.is_empty()) {
        (true, ..) => Verdict::Fails,
        (false, 1.., _) => Verdict::Differs("MRP is nearer by one of two readings".to_owned()),
        (false, 0, false) => Verdict::Differs(format!("uniform {} is nearer", nearer.join(", "))),
        (false, 0, true) if MRP.into_iter().all(|name| flip(name).is_some()) => Verdict::Holds,
        (false, 0, true) => Verdict::Differs("MRP not measured by both readings".to_owned()),
    };
    Answer { figure, verdict }
}
