//! The options of `study`.

use std::path::PathBuf;
use std::str::FromStr;

use clap::Args;

use super::{
    headings::JOBS,
    motion::MotionArgs,
    values::{self, Size},
};

/// Which jobs of a study to run: part K of N runs every N-th job.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shard {
    /// The part's number, from 1.
    pub part: u32,
    /// The number of parts.
    pub parts: u32,
}

impl Shard {
    /// Whether this part runs the job with that index.
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
            .ok_or_else(|| "K/N, with K from 1 to N and N at most 10,000".to_owned())
    }
}

/// The options of `lightbench study`.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct StudyArgs {
    /// Study to run: `lightbench list studies` lists them
    #[arg(value_parser = values::text)]
    pub study: String,

    /// Scene: a name or a .gltf or .glb file; give --scene again for each further scene
    ///
    /// [default: atrium; of the study stability, all its scenarios; of gloss, those of gloss and the atrium]
    #[arg(long, value_name = "NAME|FILE", value_parser = values::text)]
    pub scene: Vec<String>,

    /// Factor on the size of a scene, 1e-6 to 1e6; one per scene, in their order [default: 1]
    #[arg(long, value_name = "X", allow_hyphen_values = true, value_parser = values::scale)]
    pub scene_scale: Vec<f64>,

    /// Run a small version of the study: minutes on a software adapter
    #[arg(long)]
    pub quick: bool,

    /// Image size in pixels, each side 1 to 16,384
    ///
    /// [default: that of the study: 1920x1080 or 1280x720; with --quick 192x108 or 96x54]
    #[arg(long, value_name = "WxH", allow_hyphen_values = true)]
    pub size: Option<Size>,

    /// Seed of the scattered lights and of the order in which methods run
    #[arg(long, value_name = "N", default_value = "1", allow_hyphen_values = true, value_parser = values::seed)]
    pub seed: u64,

    /// Run only jobs whose name contains one of these words, such as models-random,truth [default: all]
    ///
    /// The report lists the missing jobs.
    #[arg(long, value_name = "WORD,WORD", value_delimiter = ',', value_parser = values::text, help_heading = JOBS)]
    pub only: Vec<String>,

    /// Run only every N-th job, starting at the K-th
    ///
    /// `lightbench report DIR DIR ...` joins the parts.
    #[arg(long, value_name = "K/N", default_value = "1/1", allow_hyphen_values = true, help_heading = JOBS)]
    pub shard: Shard,

    /// In place of the study stability, draw N random frames and check each, as `lightbench soak` does
    #[arg(long, value_name = "N", allow_hyphen_values = true, value_parser = values::whole_from(1, 1_000_000), help_heading = JOBS)]
    pub soak: Option<u32>,

    /// Lights that move, in every comparison.
    #[command(flatten)]
    pub motion: MotionArgs,

    /// GPU to use, by any part of its name
    #[arg(long, value_name = "NAME", value_parser = values::text)]
    pub adapter: Option<String>,

    /// Folder for the jobs and the report [default: out/study-NAME, or out/study-NAME-quick]
    ///
    /// An interrupted study continues in its folder.
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

    /// These arguments, with the scenes that the study has by itself where they name none.
    pub(crate) fn with_scenes(&self, known: fn(&Self) -> Vec<String>) -> Self {
        let scene = if self.scene.is_empty() { known(self) } else { self.scene.clone() };
        Self { scene, ..self.clone() }
    }

    /// Whether a job of that name is to run.
    pub fn wants(&self, name: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|word| name.contains(word.as_str()))
    }

    /// The words that determine the jobs: the command without --out, --only, --shard and --adapter.
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
        words.extend(self.motion.words());
        if self.quick {
            words.push("--quick".to_owned());
        }
        words
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motion_is_part_of_what_a_study_is() {
        let identity = |line: &str| {
            let words =
                ["lightbench", "study", "culling"].into_iter().chain(line.split_whitespace());
            match crate::cli::parse(words) {
                Ok(crate::cli::Invocation::Study(args)) => {
                    args.with_scenes(|_| vec!["atrium".to_owned()]).identity().join(" ")
                }
                other => panic!("{line}: {other:?}"),
            }
        };
        let still = "lightbench study culling --scene atrium --seed 1";
        assert_eq!(identity(""), still);
        let moved = identity("--motion drift --speed 0.5 --moved-by gpu --quick");
        assert_eq!(moved, format!("{still} --motion drift --speed 0.5 --moved-by gpu --quick"));
        // What is not said has its default.
        let plain = identity("--motion orbit");
        assert_eq!(plain, format!("{still} --motion orbit --speed 1 --moved-by cpu"));
    }

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
}
