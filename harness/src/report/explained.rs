//! The command that explains a pixel of a record's pictures, and the places that are worth it.

use super::page::shell_words;
use crate::cli::{Explained, explain_words};
use crate::report::format::significant;
use crate::results::Record;

/// The command line that explains a pixel of a record, up to `--pixel`. `command` is the command line of its run, and
/// `frame` the frame that shows the pixel; `None` for the still view, which pictures show. `None` if the run was no
/// comparison.
pub(crate) fn explain_command(
    command: &[String],
    record: &Record,
    frame: Option<u32>,
) -> Option<String> {
    let setting = &record.setting;
    let explained = Explained {
        strategy: record.strategy.as_str(),
        mode: setting.mode.name(),
        frames: setting.poses.filter(|_| setting.path_hash.is_some()),
        // Without a path and a motion, all frames show the same.
        frame: frame.filter(|_| setting.path_hash.is_some() || setting.motion.is_some()),
    };
    Some(shell_words(&explain_words(command, &explained)?))
}

/// The worst pixel of a record and its first missed pair, with the command that explains one of them, in sentences;
/// `None` where a record shows nothing wrong.
pub(crate) fn worst_places(command: &[String], record: &Record) -> Option<String> {
    if record.is_lossless() {
        return None;
    }
    let mut sentences = Vec::new();
    let mut shown = None;
    if let Some(missed) = &record.lists.first_missed {
        let [x, y] = missed.pixel;
        let light = match (missed.light, missed.given) {
            (Some(_), Some(given)) => format!("light {given} (as given)"),
            (Some(light), None) => format!("light {light} (by its slot)"),
            (None, _) => "every light, because its position is not a number".to_owned(),
        };
        sentences.push(format!("The first missed pair is {light} at pixel {x},{y}."));
        shown = Some((missed.pixel, None));
    }
    if let Some(worst) = &record.image.worst_pixel {
        let [x, y] = worst.pixel;
        let frame = worst.frame.map_or_else(String::new, |frame| format!(" of frame {frame}"));
        let off = match worst.rel_diff {
            Some(off) => format!("{} times its value without culling", significant(off)),
            None => "an amount that is not finite".to_owned(),
        };
        sentences.push(format!("The worst pixel is {x},{y}{frame}: it is off by {off}."));
        // There a missed light shows; at the first missed pair it may add nothing.
        shown = Some((worst.pixel, worst.frame));
    }
    let ([x, y], frame) = shown?;
    if let Some(command) = explain_command(command, record, frame) {
        sentences.push(format!("Why: `{command} {x},{y}`"));
    }
    Some(sentences.join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::{MissedPair, Results, WorstPixel};

    #[test]
    fn a_wrong_record_names_its_places_and_the_command_that_explains_them() {
        let example: Results =
            serde_json::from_str(include_str!("../results/example.json")).expect("the example");
        let mut record = example.records[0].clone();
        let command = ["lightbench", "compare", "--lights", "30", "--out", "x"].map(str::to_owned);
        (record.lists.missed_pairs, record.image.differing_channels) = (Some(0), Some(0));
        record.image.max_abs_diff = Some(0.0);
        assert_eq!(worst_places(&command, &record), None);
        record.image.differing_channels = Some(3);
        assert_eq!(worst_places(&command, &record), None, "results of earlier versions");
        record.setting.path_hash = Some("of a path".to_owned());
        record.setting.poses = Some(60);
        let worst = WorstPixel { pixel: [3, 4], frame: Some(7), rel_diff: Some(0.25) };
        record.image.worst_pixel = Some(worst);
        let mode = record.setting.mode.name();
        let id = record.strategy.to_string();
        let expected = format!(
            "The worst pixel is 3,4 of frame 7: it is off by 0.250 times its value without culling. Why: \
             `lightbench explain --lights 30 --mode {mode} --path --frames 60 --frame 7 --strategies {id} --pixel 3,4`"
        );
        assert_eq!(worst_places(&command, &record), Some(expected));
        record.lists.missed_pairs = Some(1);
        let missed = MissedPair { pixel: [5, 6], light: Some(8), given: Some(9) };
        record.lists.first_missed = Some(missed);
        let words = worst_places(&["lightbench".to_owned(), "advise".to_owned()], &record);
        let words = words.expect("places");
        assert!(words.starts_with("The first missed pair is light 9 (as given) at pixel 5,6. "));
        assert!(!words.contains("lightbench"), "the run was no comparison: {words}");
    }
}
