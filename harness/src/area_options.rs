//! Checks the options of area lights before any long work starts.

use assign::AssignError;
use shading::AreaModel;

use crate::{
    choice::Choice,
    cli::{CliError, CompareArgs},
    stage::Stage,
};

/// Refuses options of area lights where no light is an area light. Only the scene's file tells.
pub(crate) fn check_area_options(args: &CompareArgs, stage: &Stage) -> Result<(), CliError> {
    let given = [
        ("--area-model", args.area_model.map(|model| model.to_string())),
        ("--area-lod", args.area_lod.map(|angle| angle.to_string())),
        ("--influence", args.stage.influence.map(|least| least.to_string())),
    ];
    let has_areas = stage.lights.kinds().areas || stage.light_count() == 0;
    match given.into_iter().find_map(|(option, value)| Some((option, value?))) {
        Some((option, value)) if !has_areas => {
            let accepted =
                "left out, because no light is an area light (--areas SHARE scatters some)";
            Err(CliError::out_of_range(option, &value, accepted))
        }
        _ => Ok(()),
    }
}

/// Refuses points for far area lights where all area lights are points.
pub(crate) fn check_area_lod(args: &CompareArgs) -> Result<(), CliError> {
    match args.area_lod {
        Some(angle) if args.area_model == Some(AreaModel::Point) => {
            let accepted = "left out with --area-model point, which lights all of them as points";
            Err(CliError::out_of_range("--area-lod", &angle.to_string(), accepted))
        }
        _ => Ok(()),
    }
}

/// Refuses points for far area lights with light volumes.
pub(crate) fn check_lit_by_emitters(choice: &Choice, stage: &Stage) -> Result<(), AssignError> {
    match stage.area_lod {
        Some(angle) => Err(AssignError::Unsupported {
            strategy: choice.id().to_string(),
            asked: format!("points for area lights that look smaller than {angle} steradians"),
            reason: "its light volumes light by whole emitters".into(),
        }),
        None => Ok(()),
    }
}
