//! How far virtual point lights reach.

use std::sync::Arc;

use assign::{Gpu, MAX_RANGE_M, MIN_RANGE_M, Passes};
use assign_cdi::{
    Combine, DeepImages, Large, RandomRanges, RangeCaster, RangePoints, RangeRule, VplBuffer,
    VplSettings,
};
use glam::Vec3;
use scenes::Scene;
use shading::WorldTriangles;

use crate::{
    cli::{RangeChoice, Span, StageArgs, VplArgs},
    deep::{DeepChoice, triangles_of},
    error::HarnessError,
};

/// The clamp of a light's fall-off as a share of the diagonal of the scene's core.
const CLAMP_SHARE: f32 = 0.01;

/// The longest random range as a share of it.
const RANDOM_SHARE: f32 = 0.25;

/// The constant range as a share of it: the mean of random ones.
const CONSTANT_SHARE: f32 = 0.125;

/// An infinite range in diagonals of the scene. Within the scene, the window is then above 0.9999.
const INFINITE_DIAGONALS: f32 = 20.0;

/// How much longer than the scene's diagonal a ray through deep images may be: rounding, and a footprint.
const LONGEST_RAY: f32 = 1.25;

/// How much longer than its bound a drawn range may be: rounding.
const LONGEST_DRAWN: f32 = 1.01;

/// The settings that choose lights and limit their ranges.
pub(super) fn settings(scene: &Scene, args: &VplArgs) -> VplSettings {
    let core_m = scene.core_bounds.diagonal();
    let is_infinite = args.ranges == RangeChoice::Infinite;
    // Random ranges are ranges already; the factor is only for measured distances.
    let range_scale = if args.ranges.measures() { args.range_scale as f32 } else { 1.0 };
    // Only a light whose rays meet nothing has a longer range, and such a light lights nothing.
    let longest_m = match drawn_span(scene, args) {
        Some(span) => span.high_m as f32 * LONGEST_DRAWN,
        None if is_infinite => INFINITE_DIAGONALS * scene.bounds.diagonal().clamp(1e-3, 1e6),
        None => LONGEST_RAY * range_scale * scene.bounds.diagonal(),
    };
    let (low_m, high_m) = args
        .keep_ranges
        .map_or((MIN_RANGE_M, longest_m), |span| (span.low_m as f32, span.high_m as f32));
    let high_m = high_m.clamp(MIN_RANGE_M, MAX_RANGE_M);
    VplSettings {
        spacing_m: args.vpl_spacing as f32,
        limit: None,
        range_scale,
        min_range_m: low_m.clamp(MIN_RANGE_M, high_m),
        max_range_m: high_m,
        large: if is_infinite { Large::Clamp } else { Large::Discard },
        min_distance_m: args.vpl_clamp.map_or(CLAMP_SHARE * core_m, |clamp| clamp as f32),
    }
}

/// The bounds of ranges that do not come from the lengths of rays. Both are equal for a constant range.
pub(super) fn drawn_span(scene: &Scene, args: &VplArgs) -> Option<Span> {
    let share = |share: f32| f64::from((share * scene.core_bounds.diagonal()).clamp(1e-3, 1e6));
    match args.ranges {
        RangeChoice::Random | RangeChoice::RandomDiscard => {
            Some(args.random_ranges.unwrap_or(Span { low_m: 0.0, high_m: share(RANDOM_SHARE) }))
        }
        RangeChoice::ConstantDiscard => {
            let range_m = args.constant_range.unwrap_or_else(|| share(CONSTANT_SHARE));
            Some(Span { low_m: range_m, high_m: range_m })
        }
        RangeChoice::Average | RangeChoice::Maximum | RangeChoice::Infinite => None,
    }
}

/// Where ranges come from.
pub(super) enum Ranges {
    Cast {
        images: Box<DeepImages>,
        triangles: Arc<WorldTriangles>,
        caster: RangeCaster,
        light_world: Vec3,
        /// Replaces the measured lengths. Lights whose rays met nothing stay left out.
        drawn: Option<RandomRanges>,
    },
    Random(RandomRanges),
    Infinite,
}

impl Ranges {
    pub(super) fn new(
        gpu: &Gpu,
        scene: &Scene,
        args: &StageArgs,
        vpls: &VplBuffer,
        (triangles, light_world): (Option<Arc<WorldTriangles>>, Vec3),
    ) -> Result<Self, HarnessError> {
        let args = (&args.bounce, args.seed);
        let drawn = |mut random: RandomRanges| {
            let Some(Span { low_m, high_m }) = drawn_span(scene, args.0) else { return Ok(None) };
            let bounds = (low_m as f32, high_m as f32);
            let (ranges, count) = (vpls.ranges_m(), vpls.capacity());
            random.prepare(gpu, ranges, count, bounds, args.1 as u32)?;
            Ok::<_, HarnessError>(Some(random))
        };
        if let (true, Some(triangles)) = (args.0.ranges.casts(), triangles) {
            let mut images = DeepImages::new(gpu, DeepChoice::of_ranges(&args.0.deep).settings()?)?;
            images.settle(gpu, &triangles_of(&triangles))?;
            let caster = RangeCaster::new(gpu, &images, rule_of(args.0))?;
            let images = Box::new(images);
            let drawn = drawn(RandomRanges::keeping_unknown(gpu)?)?;
            return Ok(Self::Cast { images, triangles, caster, light_world, drawn });
        }
        if let Some(random) = drawn(RandomRanges::new(gpu)?)? {
            return Ok(Self::Random(random));
        }
        let all = vec![f32::MAX; vpls.capacity() as usize];
        gpu.queue.write_buffer(vpls.ranges_m(), 0, bytemuck::cast_slice(&all));
        Ok(Self::Infinite)
    }

    pub(super) fn prepare(&mut self, gpu: &Gpu, vpls: &VplBuffer) -> Result<(), HarnessError> {
        if let Self::Cast { images, triangles, caster, light_world, .. } = self {
            images.prepare(gpu, &triangles_of(triangles))?;
            caster.prepare(gpu, &points_of(vpls, Some(*light_world)))?;
        }
        Ok(())
    }

    pub(super) fn record(&mut self, passes: &mut dyn Passes) -> Result<(), HarnessError> {
        match self {
            Self::Cast { images, caster, drawn, .. } => {
                images.record(passes);
                caster.record(images, passes)?;
                if let Some(drawn) = drawn {
                    drawn.record(passes);
                }
            }
            Self::Random(random) => random.record(passes),
            Self::Infinite => {}
        }
        Ok(())
    }

    pub(super) fn deep(&self) -> Option<&DeepImages> {
        match self {
            Self::Cast { images, .. } => Some(images),
            Self::Random(_) | Self::Infinite => None,
        }
    }
}

/// The rays of a light.
fn rule_of(args: &VplArgs) -> RangeRule {
    let combine = match args.ranges {
        RangeChoice::Maximum => Combine::Maximum,
        _ => Combine::Average,
    };
    RangeRule {
        rays: args.rays,
        combine,
        primary: args.primary_ray,
        is_corrected: args.correct_rays,
        ..RangeRule::default()
    }
}

/// The lights whose ranges are wanted.
pub fn points_of(vpls: &VplBuffer, light_world: Option<Vec3>) -> RangePoints<'_> {
    RangePoints {
        positions: vpls.positions(),
        normals: vpls.normals(),
        primaries: None,
        light_world,
        count: vpls.capacity(),
        ranges_m: vpls.ranges_m(),
    }
}
