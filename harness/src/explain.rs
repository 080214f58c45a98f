//! `lightbench explain`: what one pixel shows, which lights its list holds, and what each of them adds.
//!
//! For each strategy, one frame is drawn as `compare` draws it. Then three questions are put to the frame:
//!
//! 1. The GPU says which group the pixel's sample belongs to, and which bounds lights were tested against.
//! 2. The look-up that shading calls returns the pixel's list, whatever the strategy stores.
//! 3. The CPU decides in f64 which lights reach the sample, and which of them the list misses. It is the check of
//!    `compare` ([`shading::is_missed`]).
//!
//! What a light adds is evaluated on the GPU, by the function that shading calls. So it holds for every model of
//! area lights, and sums up to the image.

mod frame;
mod lights;
mod pixel;
mod words;

use assign::Gpu;
use shading::Mode;

use crate::{
    bench::Bench,
    checks::{check_motion, check_reach, served},
    choice::Choice,
    cli::{CliError, ExplainArgs, LayerArgs},
    compare::DEFAULT_PATH_FRAMES,
    error::HarnessError,
    shadows::{Casting, check_shadows},
    stage::Stage,
    strategy::{BASELINE, Method},
};

use frame::{When, draw_all};
pub use pixel::{
    BoundsSeen, Difference, Explanation, GroupSeen, LightSeen, ListSeen, Material, SampleSeen,
    StrategySeen,
};
pub use words::text_of;

/// A method to explain.
pub struct Asked {
    /// Its id.
    pub id: String,
    /// Whether a setting of it loses light on purpose.
    pub is_lossy: bool,
    /// Whether its lists may be those of an earlier frame.
    pub remembers: bool,
    /// How it lights pixels.
    pub method: Method,
}

impl Asked {
    /// Makes the method of a choice.
    fn new(gpu: &Gpu, choice: &Choice, lights: u64) -> Result<Self, HarnessError> {
        Ok(Self {
            id: choice.id().to_string(),
            is_lossy: choice.is_lossy(lights),
            remembers: choice.is_reused(),
            method: choice.make(gpu)?,
        })
    }
}

/// Explains a pixel; returns what to print.
pub fn explain(args: &ExplainArgs) -> Result<String, HarnessError> {
    check(args)?;
    args.choices()?;
    let mut bench = Bench::open(args.adapter.as_deref())?;
    let explanation = explain_on(&mut bench, args)?;
    Ok(if args.json { json(&explanation) } else { text_of(&explanation, args.all) })
}

/// Explains a pixel on an open device.
pub fn explain_on(bench: &mut Bench, args: &ExplainArgs) -> Result<Explanation, HarnessError> {
    check(args)?;
    let choices = args.choices()?;
    if let Some(choice) = choices.iter().find(|choice| choice.leaves_out_hidden()) {
        let accepted = "without /occ: explain shows each light that a list misses, and lists with /occ leave out hidden ones";
        return Err(CliError::out_of_range("--strategies", choice.id().as_str(), accepted).into());
    }
    let gpu = bench.gpu().clone();
    check_frame(args, path_frames(&gpu, args))?;
    let stage = set_stage(bench, args)?;
    let (choices, left_out) = served(choices, &gpu, stage, args.cut)?;
    if let Some(choice) = choices.iter().find(|choice| choice.refuses_mode(args.mode).is_some()) {
        let why = choice.refuses_mode(args.mode).unwrap_or_default();
        let accepted = format!("another one for {}, because {why}", choice.id());
        return Err(CliError::out_of_range("--mode", args.mode.name(), &accepted).into());
    }
    let lights = stage.light_count();
    let asked: Result<Vec<Asked>, _> =
        choices.iter().map(|choice| Asked::new(&gpu, choice, lights)).collect();
    let mut explanation = explain_methods(&gpu, stage, args, asked?)?;
    explanation.notes.extend(left_out.iter().map(crate::results::RefusedStrategy::words));
    Ok(explanation)
}

/// The stage that the arguments ask for, with its camera on the path if they ask for that.
pub fn set_stage<'a>(
    bench: &'a mut Bench,
    args: &ExplainArgs,
) -> Result<&'a mut Stage, HarnessError> {
    let frames = path_frames(bench.gpu(), args);
    let stage = bench.stage(&args.stage)?;
    stage.area_model = args.area_model.unwrap_or_default();
    stage.compensation = args.compensate.map(|lights| lights as f32);
    stage.specular_reach = args.specular_reach.map(|most| most as f32);
    stage.area_lod = args.area_lod.map(|angle| angle as f32);
    stage.show_layers(&args.layers, args.stage.seed)?;
    stage.cast_shadows(args.shadows, Casting { cut: args.cut, finds_occluders: false })?;
    if args.path {
        stage.follow_path(frames);
    }
    Ok(stage)
}

/// Explains a pixel for methods that the caller made, on the stage of [`set_stage`]. No culling is drawn first, as the
/// reference of the others.
pub fn explain_methods(
    gpu: &Gpu,
    stage: &mut Stage,
    args: &ExplainArgs,
    asked: Vec<Asked>,
) -> Result<Explanation, HarnessError> {
    let mut all: Vec<Asked> = asked.into_iter().filter(|asked| asked.id != BASELINE).collect();
    let baseline = Choice::parse(BASELINE).map_err(CliError::from)?;
    all.insert(0, Asked::new(gpu, &baseline, stage.light_count())?);
    let frames = path_frames(gpu, args);
    let when = When { frame: args.frame, frames };
    draw_all(gpu, stage, args, when, &mut all)
}

/// Frames of the whole path.
fn path_frames(gpu: &Gpu, args: &ExplainArgs) -> u32 {
    args.frames.unwrap_or(DEFAULT_PATH_FRAMES[usize::from(gpu.is_software())])
}

/// Refuses options that contradict each other.
fn check(args: &ExplainArgs) -> Result<(), CliError> {
    check_motion(&args.stage)?;
    check_reach(args.specular_reach, args.cut)?;
    check_shadows(args.shadows, &args.stage, (args.path, 1))?;
    let (pixel, size) = (args.pixel, args.stage.size);
    if pixel.x >= size.width || pixel.y >= size.height {
        let accepted = format!(
            "inside the image of {}x{} pixels: X from 0 to {}, Y from 0 to {}",
            size.width,
            size.height,
            size.width - 1,
            size.height - 1
        );
        return Err(CliError::out_of_range("--pixel", &pixel.to_string(), &accepted));
    }
    args.frames.map_or(Ok(()), |frames| check_frame(args, frames))
}

/// Refuses a frame beyond the path.
fn check_frame(args: &ExplainArgs, frames: u32) -> Result<(), CliError> {
    match args.frame.filter(|frame| args.path && *frame >= frames) {
        None => Ok(()),
        Some(frame) => {
            let accepted = format!("0 to {}, because the path has {frames} frames", frames - 1);
            Err(CliError::out_of_range("--frame", &frame.to_string(), &accepted))
        }
    }
}

fn json(explanation: &Explanation) -> String {
    // Numbers that JSON cannot hold become null.
    let text = serde_json::to_string_pretty(explanation);
    text.map_or_else(
        |error| format!("{{\"error\": {:?}}}\n", error.to_string()),
        |text| text + "\n",
    )
}

/// The words for layers, which stand between the eye and the surface.
fn layer_note(layers: &LayerArgs) -> Option<String> {
    (*layers != LayerArgs::default()).then(|| {
        "transparent surfaces, particles or fog are drawn over the surface: the radiance contains them, and the sample, \
         its list and what lights add are those of the opaque surface behind them; what their own samples miss is \
         counted by `compare` only"
            .to_owned()
    })
}

/// The words for a mode's inexactness: in forward modes shading rounds no normal, and the G-buffer does.
fn mode_note(mode: Mode) -> Option<String> {
    mode.is_forward().then(|| {
        "what lights add is evaluated with the normal and the colours that the G-buffer rounds; forward shading \
         rounds neither"
            .to_owned()
    })
}
