//! The options of `advise`.

use std::path::PathBuf;

use clap::Args;
use shading::Mode;

use super::{modes::MODES, named::named, stage::StageArgs, values};

/// The options of `lightbench advise`.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct AdviseArgs {
    /// What is drawn.
    #[command(flatten)]
    pub stage: StageArgs,

    /// Largest acceptable relMSE against no culling, 0 to 1; 0 accepts only identical images
    #[arg(long, display_order = 6, value_name = "X", default_value = "0", allow_hyphen_values = true, value_parser = values::share)]
    pub error_budget: f64,

    /// How pixels are lit
    #[arg(long, display_order = 7, value_name = "MODE", default_value = "deferred", value_parser = named(MODES, Mode::name))]
    pub mode: Mode,

    /// Poses along the scene's path to measure, 1 to 100,000
    ///
    /// 1 is the first view of the path. [default: 24, or 3 on a software adapter; one view with --camera and
    /// in a scene without a path]
    #[arg(long, display_order = 8, value_name = "N", conflicts_with = "camera", allow_hyphen_values = true, value_parser = values::whole_from(1, values::MAX_FRAMES))]
    pub poses: Option<u32>,

    /// GPU to use, by any part of its name
    #[arg(long, display_order = 9, value_name = "NAME", value_parser = values::text)]
    pub adapter: Option<String>,

    /// Folder for the measurements and their report
    #[arg(long, display_order = 10, value_name = "DIR", default_value = "out/advise")]
    pub out: PathBuf,
}

impl AdviseArgs {
    /// The words of an `advise` command that its comparisons share: all options except those of the
    /// search.
    pub fn shared_words(command: &[String]) -> Vec<String> {
        let mut words = command.iter().skip_while(|word| *word != "advise").skip(1);
        let mut shared = Vec::new();
        while let Some(word) = words.next() {
            let option = word.split('=').next().unwrap_or_default();
            if !["--error-budget", "--poses", "--out"].contains(&option) {
                shared.push(word.clone());
            } else if option == word {
                words.next();
            }
        }
        shared
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comparisons_share_the_scene_and_lights_of_the_search() {
        let line = "lightbench advise --scene a.glb --error-budget 0.1 --poses=3 --out=x --seed 4";
        let words: Vec<String> = line.split(' ').map(str::to_owned).collect();
        assert_eq!(AdviseArgs::shared_words(&words), ["--scene", "a.glb", "--seed", "4"]);
    }
}
