//! The options that let lights move.

use clap::{Args, ValueEnum};
use scenes::MotionLaw;

use super::{headings::MOTION, named::named, values};

/// Whether and how lights move.
#[derive(Args, Clone, Debug, PartialEq)]
pub struct MotionArgs {
    /// Move the lights in every frame
    ///
    /// Frame F shows the time F / 60 s, and is the same on every run. The camera stands still unless --path
    /// moves it. Lights are ordered and boxed on the GPU in every frame, on the clock (see --light-order).
    #[arg(long, value_name = "LAW", value_parser = named(LAWS, MotionLaw::name), help_heading = MOTION, hide_short_help = true)]
    pub motion: Option<MotionLaw>,

    /// Speed of the lights in metres per second, 0 to 1e6
    #[arg(long, value_name = "M/S", default_value = "1", allow_hyphen_values = true, value_parser = values::number_from(0.0, 1e6), help_heading = MOTION, hide_short_help = true)]
    pub speed: f64,

    /// Who moves the lights
    #[arg(long, value_name = "WHO", default_value = "cpu", help_heading = MOTION, hide_short_help = true)]
    pub moved_by: MovedBy,
}

/// The laws of motion, with what each does.
const LAWS: [(MotionLaw, &str); MotionLaw::LIST.len()] = {
    let mut laws = [(MotionLaw::Drift, ""); MotionLaw::LIST.len()];
    let mut ix = 0;
    while ix < laws.len() {
        laws[ix] = (MotionLaw::LIST[ix], MotionLaw::LIST[ix].summary());
        ix += 1;
    }
    laws
};

/// Who moves the lights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MovedBy {
    /// The CPU, which uploads what changed: the pass upload
    Cpu,
    /// A kernel on the GPU: no light crosses to the GPU
    Gpu,
}
