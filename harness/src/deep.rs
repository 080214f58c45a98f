//! Deep images of a scene with the settings of the command line.

use assign::AssignError;
use assign_cdi::{
    Build, Coverage, DeepImageSettings, DeepImages, Directions, Raster, Spread, Storage, Triangles,
};
use shading::WorldTriangles;

use crate::{
    cli::{BuildChoice, DeepArgs, DirectionCounts, name_of},
    results,
};

/// What deep images are like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DeepChoice {
    directions: DirectionCounts,
    spread: Spread,
    size_px: u32,
    oversampling: u32,
    build: BuildChoice,
}

impl DeepChoice {
    /// Those of rays that find ranges: the paper's, unless the command line says otherwise.
    pub fn of_ranges(args: &DeepArgs) -> Self {
        Self {
            directions: args.directions.unwrap_or(DirectionCounts { stacks: 13, slices: 13 }),
            spread: args.spread.unwrap_or(Spread::StacksAndSlices),
            size_px: args.deep_size.unwrap_or(64),
            oversampling: args.oversampling,
            build: args.build.unwrap_or(BuildChoice::Compute),
        }
    }

    /// Those of rays that find shadows ([`shading::shadow_images`]), unless the command line says otherwise.
    pub fn of_shadows(args: &DeepArgs) -> Self {
        Self {
            directions: args.directions.unwrap_or(DirectionCounts { stacks: 8, slices: 8 }),
            spread: args.spread.unwrap_or(Spread::Squares),
            size_px: args.deep_size.unwrap_or(512),
            oversampling: args.oversampling,
            build: args.build.unwrap_or(BuildChoice::PerDirectionBatched),
        }
    }

    /// Their settings.
    ///
    /// # Errors
    ///
    /// Names the first option out of its range.
    pub fn settings(self) -> Result<DeepImageSettings, AssignError> {
        let Self { directions, spread, size_px, oversampling, build } = self;
        let visits = [
            BuildChoice::PerDirection,
            BuildChoice::PerDirectionBatched,
            BuildChoice::Conservative,
        ];
        if oversampling > 1 && visits.contains(&build) {
            return Err(AssignError::Parameter {
                field: "--oversampling".into(),
                value: oversampling.to_string(),
                accepted: format!("1 for --build {}", name_of(&build)),
            });
        }
        let single = |raster| Build::SinglePass { oversampling, raster };
        let each = |coverage, at_once| Build::PerDirection { coverage, at_once };
        let directions = Directions::new(spread, directions.stacks, directions.slices)?;
        let settings = DeepImageSettings {
            directions,
            size_px,
            build: match build {
                BuildChoice::Compute | BuildChoice::LinkedLists => single(Raster::Compute),
                BuildChoice::Fragment => single(Raster::Fragment),
                BuildChoice::PerDirection => each(Coverage::Centres, 1),
                BuildChoice::PerDirectionBatched => each(Coverage::Centres, directions.count()),
                BuildChoice::Conservative => each(Coverage::Conservative, directions.count()),
            },
            storage: match build {
                BuildChoice::LinkedLists => Storage::LinkedLists,
                _ => Storage::Arrays,
            },
            ..DeepImageSettings::default()
        };
        settings.check()?;
        Ok(settings)
    }

    /// What is stored of images that were made so.
    pub fn figures(self, images: &DeepImages) -> results::DeepImages {
        let stats = images.stats().unwrap_or_default();
        results::DeepImages {
            stacks: self.directions.stacks,
            slices: self.directions.slices,
            spread: self.spread.name().to_owned(),
            size_px: self.size_px,
            oversampling: self.oversampling,
            build: name_of(&self.build),
            footprint_m: f64::from(images.space().footprint_m),
            samples: u64::from(stats.sample_count),
            fragments: u64::from(stats.fragment_count),
            longest_list: u64::from(stats.longest),
            bytes: images.bytes(),
        }
    }
}

/// The buffer of a scene's triangles, as deep images take it.
pub fn triangles_of(triangles: &WorldTriangles) -> Triangles<'_> {
    Triangles {
        positions: &triangles.positions,
        count: triangles.count,
        bounds_world: triangles.bounds_world,
    }
}
