//! The options that let lights move.

use clap::{Args, ValueEnum};
use scenes::MotionLaw;

use super::{
    headings::MOTION,
    named::{name_of, named},
    values,
};

/// Whether and how lights move.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct MotionArgs {
    /// Move the lights in every frame
    ///
    /// Frame F shows the time F / 60 s, and is the same on every run. What moving lights cost in each frame is
    /// on the clock: the GPU boxes them in every frame and sorts them in every eighth (see --light-order of
    /// `compare`).
    #[arg(long, value_name = "LAW", value_parser = named(MOTIONS, MotionChoice::name), help_heading = MOTION, hide_short_help = true)]
    pub motion: Option<MotionChoice>,

    /// Speed of the lights, m/s, 0 to 1e6; with --motion file a factor on its clock
    #[arg(long, value_name = "M/S", default_value = "1", allow_hyphen_values = true, value_parser = values::number_from(0.0, 1e6), help_heading = MOTION, hide_short_help = true)]
    pub speed: f64,

    /// Who moves the lights
    #[arg(long, value_name = "WHO", default_value = "cpu", help_heading = MOTION, hide_short_help = true)]
    pub moved_by: MovedBy,
}

impl MotionArgs {
    /// The words that ask for this motion; none if the lights stand still.
    pub fn words(&self) -> Vec<String> {
        let Some(motion) = self.motion else { return Vec::new() };
        let (speed, mover) = (self.speed.to_string(), name_of(&self.moved_by));
        let words = ["--motion", motion.name(), "--speed", &speed, "--moved-by", &mover];
        words.map(str::to_owned).to_vec()
    }

    /// Whether the GPU moves the lights.
    pub fn is_on_gpu(&self) -> bool {
        self.motion.is_some() && self.moved_by == MovedBy::Gpu
    }
}

/// How lights move.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotionChoice {
    /// By a law.
    Law(MotionLaw),
    /// As the scene's file animates its own lights.
    File,
}

impl MotionChoice {
    /// Its name on the command line.
    pub fn name(self) -> &'static str {
        match self {
            Self::Law(law) => law.name(),
            Self::File => "file",
        }
    }
}

/// The motions, with what each does.
const MOTIONS: [(MotionChoice, &str); MotionLaw::LIST.len() + 1] = [
    (MotionChoice::Law(MotionLaw::Drift), "Each light wanders smoothly around its place"),
    (MotionChoice::Law(MotionLaw::Orbit), "Each light circles around its place"),
    (MotionChoice::Law(MotionLaw::Teleport), "All lights drift; one in four also jumps"),
    (MotionChoice::Law(MotionLaw::Flicker), "The intensity of each light swings and jumps"),
    (MotionChoice::Law(MotionLaw::Births), "Lights die and are born again at other places"),
    (MotionChoice::Law(MotionLaw::Turn), "Spots and area lights turn; point lights stay"),
    (MotionChoice::Law(MotionLaw::All), "Each light follows one of the laws above"),
    (MotionChoice::File, "The scene's own lights move as its file animates them"),
];

/// Who moves the lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MovedBy {
    /// The CPU, which uploads what changed: the pass upload
    Cpu,
    /// A kernel on the GPU: no light crosses to the GPU
    Gpu,
}
