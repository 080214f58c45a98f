//! The claim on times.

use crate::report::format::{number, significant};
use crate::results::Record;
use crate::study::claims::{Answer, Check, Tally};
use crate::study::data::entries;
use crate::study::manifest::Done;
use crate::study::shadows::cells::{atlas, atlases, fell_back, maps, on_software};
use crate::study::shadows::jobs::MAPS;

use super::SOFTWARE;

/// The time to shade by the number of maps in an atlas of this side, ascending, ms.
fn shade_ms(done: &Done, scene: &str, atlas_px: u32) -> Vec<(u32, f64)> {
    let time = |record: &Record| {
        Some((maps(record)?.maps, record.times.shade_ms)).filter(|(_, ms)| ms.is_finite())
    };
    let mut times: Vec<(u32, f64)> = entries(done, scene, MAPS)
        .iter()
        .filter(|entry| atlas(entry) == Some(atlas_px) && !fell_back(entry.record))
        .filter_map(|entry| time(entry.record))
        .collect();
    times.sort_by_key(|(maps, _)| *maps);
    times
}

pub(crate) const TIME: Check = Check {
    id: "time",
    place: "section 6.2",
    words: "The number of shadow maps decides the time, their resolution hardly.",
    paper: "no numbers",
    departure: "the paper draws its maps in every frame and counts frames per second. Here maps are drawn once, and \
                the time to shade is compared: from the smallest to the largest atlas it must change by less than from \
                one number of maps to the next",
    decide: |done, scene| {
        if on_software(done) {
            return Answer::undecided(SOFTWARE);
        }
        let sides = atlases(done, scene);
        let (Some(small), Some(large)) = (sides.first(), sides.last()) else {
            return Answer::unknown("two atlases");
        };
        let mut tally = Tally::default();
        let times = shade_ms(done, scene, *large);
        for pair in shade_ms(done, scene, *small).windows(2) {
            let [(count, ms), (next, next_ms)] = *pair else { continue };
            let Some((_, large_ms)) = times.iter().find(|(maps, _)| *maps == count) else {
                continue;
            };
            let figure = format!(
                "{count} maps: {} ms in {}\u{b2} and {} ms in {}\u{b2}; {next} maps: {} ms",
                significant(ms),
                number(f64::from(*small)),
                significant(*large_ms),
                number(f64::from(*large)),
                significant(next_ms)
            );
            if small != large {
                tally.add((large_ms / ms).ln().abs() < (next_ms / ms).ln().abs(), figure);
            }
        }
        tally.answer("numbers of maps", "times of two atlases")
    },
};
