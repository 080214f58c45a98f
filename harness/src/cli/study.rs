//! The options of `study`, `report` and `advise`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;

use super::{
    stage::StageArgs,
    values::{self, Size},
};

/// Which jobs of a study to run: every n-th.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// Which of them, from 1.
    pub part: u32,
    /// How many there are.
    pub parts: u32,
}

impl Shard {
    /// Whether it runs the job of an index.
    pub fn holds(self, job: usize) -> bool {
        job % self.parts as usize == self.part as usize - 1
    }
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        text.split_once('/')
            .and_then(|(part, parts)| {
                Some(Self { part: part.parse().ok()?, parts: parts.parse().ok()? })
            })
            .filter(|shard| (1..=shard.parts).contains(&shard.part) && shard.parts <= 10_000)
            .ok_or_else(|| "K/N, K from 1 to N, N at most 10,000".to_owned())
    }
}

/// The options of `lightbench study`.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct StudyArgs {
    /// Which study: `lightbench list studies` names them and says what each answers
    #[arg(value_parser = values::text)]
    pub study: String,

    /// A scene's name or a .gltf or .glb file; given again for each further scene
    #[arg(long, value_name = "NAME|FILE", default_value = "atrium", value_parser = values::text)]
    pub scene: Vec<String>,

    /// Factor on the size of a scene, 1e-6 to 1e6, in the order of the scenes [default: 1]
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = values::scale)]
    pub scene_scale: Vec<f64>,

    /// A small study, minutes on a software adapter
    #[arg(long)]
    pub quick: bool,

    /// Image size in pixels [default: the study's, 1920x1080 or 1280x720; 192x108 or
    /// 96x54 where quick]
    #[arg(long, value_name = "WxH", allow_hyphen_values = true)]
    pub size: Option<Size>,

    /// Seed of the scattered lights and of the order of methods
    #[arg(long, value_name = "N", default_value = "1", allow_hyphen_values = true, value_parser = values::seed)]
    pub seed: u64,

    /// Run only jobs whose name holds one of these words, such as models-random,truth; the report says
    /// which are missing [default: all jobs]
    #[arg(long, value_name = "WORD,WORD", value_delimiter = ',', value_parser = values::text)]
    pub only: Vec<String>,

    /// Run only every N-th job, from the K-th; `lightbench report` puts the parts together
    #[arg(long, value_name = "K/N", default_value = "1/1", allow_hyphen_values = true)]
    pub shard: Shard,

    /// Part of the adapter's name, where there are several
    #[arg(long, value_name = "NAME", value_parser = values::text)]
    pub adapter: Option<String>,

    /// Folder for jobs and report; where an interrupted study is, it goes on
    /// [default: out/study-NAME, and -quick]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

impl StudyArgs {
    /// The folder for jobs and report.
    pub fn folder(&self) -> PathBuf {
        self.out.clone().unwrap_or_else(|| {
            let quick = if self.quick { "-quick" } else { "" };
            PathBuf::from(format!("out/study-{}{quick}", self.study))
        })
    }

    /// Whether a job of that name is to run.
    pub fn wants(&self, name: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|word| name.contains(word.as_str()))
    }

    /// What decides the jobs: the command without its folder, its choice of jobs, its shard and its
    /// adapter.
    pub fn identity(&self) -> Vec<String> {
        let mut words = ["lightbench", "study", &self.study].map(str::to_owned).to_vec();
        let mut option = |name: &str, value: String| words.extend([name.to_owned(), value]);
        for scene in &self.scene {
            option("--scene", scene.clone());
        }
        for scale in &self.scene_scale {
            option("--scene-scale", scale.to_string());
        }
        if let Some(Size { width, height }) = self.size {
            option("--size", format!("{width}x{height}"));
        }
        option("--seed", self.seed.to_string());
        if self.quick {
            words.push("--quick".to_owned());
        }
        words
    }
}

/// The options of `lightbench report`.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct ReportArgs {
    /// Folder of a comparison or a study, or a file of results; the folders of all shards where a study
    /// was split
    #[arg(value_name = "DIR|FILE.json", required = true)]
    pub folders: Vec<PathBuf>,

    /// Folder for the report [default: the first folder; for FILE.json a folder FILE beside it]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

/// The options of `lightbench advise`.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct AdviseArgs {
    /// What is drawn.
    #[command(flatten)]
    pub stage: StageArgs,

    /// The greatest relMSE against no culling that is acceptable, 0 to 1; 0 asks for every bit
    #[arg(long, value_name = "X", default_value = "0", allow_hyphen_values = true, value_parser = values::share)]
    pub error_budget: f64,

    /// Poses along the scene's path to judge, 1 to 100,000; 1 is the path's first view
    /// [default: 24, or 3 on a software adapter; one view where --camera places it or the scene has
    /// no path]
    #[arg(long, value_name = "N", conflicts_with = "camera", allow_hyphen_values = true, value_parser = values::frames)]
    pub poses: Option<u32>,

    /// How pixels are lit
    #[arg(long, value_name = "MODE", default_value = "deferred")]
    pub mode: super::ModeChoice,

    /// Part of the adapter's name, where there are several
    #[arg(long, value_name = "NAME", value_parser = values::text)]
    pub adapter: Option<String>,

    /// Folder for what was measured and its report
    #[arg(long, value_name = "DIR", default_value = "out/advise")]
    pub out: PathBuf,
}

impl AdviseArgs {
    /// The words of an `advise` command that its comparisons share: all options but those of the
    /// search itself.
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
    fn shards_hold_every_job_once() {
        let shards: Vec<Shard> = (1..=3).map(|part| format!("{part}/3").parse().unwrap()).collect();
        for job in 0..20 {
            assert_eq!(shards.iter().filter(|shard| shard.holds(job)).count(), 1);
        }
        for bad in ["0/3", "4/3", "1", "a/b", "1/0", "-1/2"] {
            assert!(bad.parse::<Shard>().is_err(), "{bad}");
        }
    }

    #[test]
    fn rounds_of_advice_share_what_is_drawn() {
        let line = "lightbench advise --scene a.glb --error-budget 0.1 --poses=3 --out=x --seed 4";
        let words: Vec<String> = line.split(' ').map(str::to_owned).collect();
        assert_eq!(AdviseArgs::shared_words(&words), ["--scene", "a.glb", "--seed", "4"]);
    }
}
