//! The command line that explains a pixel of a comparison.

use clap::Arg;

use super::definition;

/// Options that the picture decides, and not the command line.
const OWN: [&str; 6] = ["strategies", "mode", "pixel", "path", "frames", "frame"];

/// What a report knows of the picture whose pixels are to be explained.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Explained<'a> {
    /// The id of the strategy that drew it.
    pub strategy: &'a str,
    /// The mode in which it did.
    pub mode: &'a str,
    /// The frames of the path, if the camera walks along it.
    pub frames: Option<u32>,
    /// The frame, if it is not the still view.
    pub frame: Option<u32>,
}

/// The words of `lightbench explain` that show pixels of a comparison, up to and including `--pixel`: what follows is
/// the pixel. `command` is the comparison's command line, program name first. `None` if that is the command line of
/// something else.
pub fn explain_words(command: &[String], of: &Explained<'_>) -> Option<Vec<String>> {
    let program = definition();
    let [compare, explain] =
        ["compare", "explain"].map(|name| program.find_subcommand(name).cloned());
    let (compare, explain) = (compare?, explain?);
    let (name, words) = command.split_first()?;
    let words = match words.first().map(String::as_str) {
        Some("compare") => &words[1..],
        Some(first) if !first.starts_with('-') => return None,
        _ => words,
    };
    let mut kept = vec![name.clone(), "explain".to_owned()];
    let is_kept = |name: &str| {
        let is_known = explain.get_arguments().any(|arg| arg.get_long() == Some(name));
        is_known && !OWN.contains(&name)
    };
    let mut words = words.iter();
    while let Some(word) = words.next() {
        let option = word.strip_prefix("--")?;
        let (option, is_whole) = match option.split_once('=') {
            Some((option, _)) => (option, true),
            None => (option, false),
        };
        let arg = compare.get_arguments().find(|arg| arg.get_long() == Some(option))?;
        let value = if is_whole || !takes_value(arg) { None } else { Some(words.next()?) };
        if is_kept(option) {
            kept.extend([word].into_iter().chain(value).cloned());
        }
    }
    let mut add = |words: &[&str]| kept.extend(words.iter().map(|word| (*word).to_owned()));
    add(&["--mode", of.mode]);
    if let Some(frames) = of.frames {
        add(&["--path", "--frames", &frames.to_string()]);
    }
    if let Some(frame) = of.frame {
        add(&["--frame", &frame.to_string()]);
    }
    add(&["--strategies", of.strategy, "--pixel"]);
    Some(kept)
}

fn takes_value(arg: &Arg) -> bool {
    arg.get_action().takes_values()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cli::{Invocation, parse};

    fn words(line: &str, of: &Explained<'_>) -> Option<String> {
        let command: Vec<String> = line.split(' ').map(str::to_owned).collect();
        Some(explain_words(&command, of)?.join(" "))
    }

    #[test]
    fn options_of_the_drawing_stay_and_those_of_the_measuring_go() {
        let of = Explained { strategy: "G/4x4x4", mode: "forward", frames: None, frame: None };
        for (line, expected) in [
            (
                "lightbench compare --scene a.gltf --lights=7 --strategies None,G --out x --mode both --warmup 3 \
                 --camera 1,2,3:0,0,0 --operations --no-own-lights",
                "lightbench explain --scene a.gltf --lights=7 --camera 1,2,3:0,0,0 --no-own-lights --mode forward \
                 --strategies G/4x4x4 --pixel",
            ),
            (
                "lightbench --fog 0.1 --transparent --particles=9 --truth none",
                "lightbench explain --fog 0.1 --transparent --particles=9 --mode forward --strategies G/4x4x4 --pixel",
            ),
            ("lightbench", "lightbench explain --mode forward --strategies G/4x4x4 --pixel"),
            (
                "lightbench --lights 3 --test hs --source bvh --frames 9",
                "lightbench explain --lights 3 --mode forward --strategies G/4x4x4 --pixel",
            ),
        ] {
            assert_eq!(words(line, &of).as_deref(), Some(expected));
            let full = format!("{expected} 1,2");
            assert!(matches!(parse(full.split(' ')), Ok(Invocation::Explain(_))), "{full}");
        }
        for other in ["lightbench advise --lights 3", "lightbench truth", "lightbench --unknown 3"]
        {
            assert_eq!(words(other, &of), None, "{other}");
        }
    }

    #[test]
    fn a_frame_of_a_path_is_named() {
        let of = Explained { strategy: "W", mode: "deferred", frames: Some(60), frame: Some(5) };
        let line = "lightbench compare --path --motion drift --checks 3 --laps 2 --frames 60";
        let expected = "lightbench explain --motion drift --mode deferred --path --frames 60 --frame 5 \
                        --strategies W --pixel";
        assert_eq!(words(line, &of).as_deref(), Some(expected));
        let full = format!("{expected} 0,0");
        assert!(matches!(parse(full.split(' ')), Ok(Invocation::Explain(_))), "{full}");
    }
}
