//! Builds the deep images of a scene with the settings of the command line.

use assign::{AssignError, EncoderPasses, Gpu};
use assign_cdi::{
    Build, Coverage, DeepImageSettings, DeepImages, Directions, Raster, Storage, Triangles,
};
use shading::WorldTriangles;

use crate::{
    cli::{BuildChoice, DeepArgs, name_of},
    error::HarnessError,
    results,
};

/// The most builds until the buffers are large enough.
const MAX_SETTLING: u32 = 8;

/// The settings on the command line.
pub fn settings_of(args: &DeepArgs) -> Result<DeepImageSettings, AssignError> {
    let visits =
        [BuildChoice::PerDirection, BuildChoice::PerDirectionBatched, BuildChoice::Conservative];
    if args.oversampling > 1 && visits.contains(&args.build) {
        return Err(AssignError::Parameter {
            field: "--oversampling".into(),
            value: args.oversampling.to_string(),
            accepted: format!("1 for --build {}", name_of(&args.build)),
        });
    }
    let single = |raster| Build::SinglePass { oversampling: args.oversampling, raster };
    let each = |coverage, at_once| Build::PerDirection { coverage, at_once };
    let directions = Directions::new(args.spread, args.directions.stacks, args.directions.slices)?;
    let settings = DeepImageSettings {
        directions,
        size_px: args.deep_size,
        build: match args.build {
            BuildChoice::Compute | BuildChoice::LinkedLists => single(Raster::Compute),
            BuildChoice::Fragment => single(Raster::Fragment),
            BuildChoice::PerDirection => each(Coverage::Centres, 1),
            BuildChoice::PerDirectionBatched => each(Coverage::Centres, directions.count()),
            BuildChoice::Conservative => each(Coverage::Conservative, directions.count()),
        },
        storage: match args.build {
            BuildChoice::LinkedLists => Storage::LinkedLists,
            _ => Storage::Arrays,
        },
        ..DeepImageSettings::default()
    };
    settings.check()?;
    Ok(settings)
}

/// The buffer of a scene's triangles, as deep images take it.
pub fn triangles_of(triangles: &WorldTriangles) -> Triangles<'_> {
    Triangles {
        positions: &triangles.positions,
        count: triangles.count,
        bounds_world: triangles.bounds_world,
    }
}

/// Builds prepared images once, untimed, and waits for them.
pub fn build(gpu: &Gpu, images: &mut DeepImages) -> Result<(), AssignError> {
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    images.record(&mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    gpu.wait()
}

/// Builds until nothing overflows.
///
/// # Errors
///
/// Where the images do not fit, with what they would need.
pub fn settle(
    gpu: &Gpu,
    images: &mut DeepImages,
    triangles: &Triangles<'_>,
) -> Result<(), HarnessError> {
    for built in 0..=MAX_SETTLING {
        images.prepare(gpu, triangles)?;
        // The counters of a build come back with the next.
        if built > 1 && images.is_complete() == Some(true) {
            return Ok(());
        }
        build(gpu, images)?;
    }
    let fragments = images.stats().map_or(0, |stats| stats.fragment_count);
    Err(AssignError::TooLarge {
        what: format!("deep images of {fragments} fragments"),
        bytes: u64::from(fragments) * 4,
        limit: gpu.max_storage_bytes(),
    }
    .into())
}

/// What is stored of deep images.
pub fn figures(images: &DeepImages, args: &DeepArgs) -> results::DeepImages {
    let stats = images.stats().unwrap_or_default();
    results::DeepImages {
        stacks: args.directions.stacks,
        slices: args.directions.slices,
        spread: args.spread.name().to_owned(),
        size_px: args.deep_size,
        oversampling: args.oversampling,
        build: name_of(&args.build),
        footprint_m: f64::from(images.space().footprint_m),
        samples: u64::from(stats.sample_count),
        fragments: u64::from(stats.fragment_count),
        longest_list: u64::from(stats.longest),
        bytes: images.bytes(),
    }
}
