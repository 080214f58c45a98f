//! Makes the virtual point lights of a stage, from the primary light's view to lights with ranges.

use assign::{EncoderPasses, Gpu, Light, LightBuffer, MAX_RANGE_M, MIN_RANGE_M, Passes, View};
use assign_cdi::{
    Combine, DeepImages, Large, Primary, RandomRanges, RangeCaster, RangePoints, RangeRule, Rsm,
    Triangles, VplBuffer, VplSettings,
};
use glam::Vec3;
use scenes::Scene;
use shading::{Renderer, WorldTriangles, rsm_view};

use crate::{
    cli::{RangeChoice, Span, StageArgs, VplArgs, name_of},
    clock::PassClock,
    deep::{figures, settings_of, settle, triangles_of},
    drift::WarmUp,
    error::HarnessError,
    pass_samples::PassSamples,
    results::{self, Vpls},
};

/// Frames to time: on a GPU, and on a software adapter.
const FRAMES: [u32; 2] = [32, 1];

/// The clamp of a light's fall-off as a share of the diagonal of the scene's core.
const CLAMP_SHARE: f32 = 0.01;

/// The longest random range as a share of it.
const RANDOM_SHARE: f32 = 0.25;

/// The constant range as a share of it: the mean of random ones.
const CONSTANT_SHARE: f32 = 0.125;

/// Half the width of the middle of a scene, as a share of the width of its core.
const MIDDLE_SHARE: f32 = 0.25;

/// An infinite range in diagonals of the scene. Within the scene, the window is then above 0.9999.
const INFINITE_DIAGONALS: f32 = 20.0;

/// Makes virtual point lights. Keeps the scene's triangles between calls.
#[derive(Default)]
pub struct VplMaker {
    triangles: Option<WorldTriangles>,
}

/// Lights, and figures about making them.
pub struct Made {
    /// The lights.
    pub lights: Vec<Light>,
    /// Times and counts of making them.
    pub figures: Vpls,
}

impl VplMaker {
    /// Turns the light of `primary` that surfaces reflect into virtual point lights. The scene must be the
    /// same in every call.
    ///
    /// # Errors
    ///
    /// The light has no shadow map, the deep images do not fit, or the device fails.
    pub fn make(
        &mut self,
        gpu: &Gpu,
        scene: &Scene,
        renderer: &Renderer,
        primary: Light,
        args: &StageArgs,
    ) -> Result<Made, HarnessError> {
        let bounds = (scene.bounds.min, scene.bounds.max);
        let view = rsm_view(&primary, args.bounce.vpls, bounds)?;
        let map = map_of(gpu, renderer, &view, primary)?;
        let mut vpls = VplBuffer::new(gpu, settings(scene, &args.bounce))?;
        vpls.prepare(gpu, &rsm_of(&map, &view, &primary))?;
        if args.bounce.ranges.casts() && self.triangles.is_none() {
            self.triangles = Some(WorldTriangles::new(gpu, scene)?);
        }
        let triangles = self.triangles.as_ref().map(triangles_of);
        let mut ranges = Ranges::new(gpu, scene, args, &vpls, (triangles, primary.position))?;
        let kind = usize::from(gpu.is_software());
        let mut samples = PassSamples::default();
        let mut clock = PassClock::new(gpu);
        let mut warm_up = WarmUp::new(gpu.is_software());
        let mut timed = 0;
        while timed < FRAMES[kind] {
            vpls.prepare(gpu, &rsm_of(&map, &view, &primary))?;
            ranges.prepare(gpu, &vpls)?;
            record(&map, &view, &mut vpls, &mut ranges, &mut clock)?;
            let times = clock.finish()?;
            // A software adapter has no clock to raise, so its first frame counts.
            if gpu.is_software() || warm_up.is_warm() {
                samples.collect(times);
                timed += 1;
            } else {
                warm_up.feed(times.iter().map(|(_, ms)| ms).sum());
            }
        }
        let counts = vpls.read_counts(gpu)?;
        let lights = vpls.read(gpu)?;
        let sum: f64 = lights.iter().map(|light| f64::from(light.range_m)).sum();
        let set = vpls.settings();
        let casts = args.bounce.ranges.casts();
        let figures = Vpls {
            rsm_px: args.bounce.vpls,
            ranges: name_of(&args.bounce.ranges),
            rays: if casts { args.bounce.rays } else { 0 },
            is_reflected: casts && args.bounce.primary_ray == Primary::Reflected,
            is_corrected: casts && args.bounce.correct_rays,
            range_scale: f64::from(set.range_scale),
            given_ranges_m: drawn_span(scene, &args.bounce).map(|span| [span.low_m, span.high_m]),
            has_fresnel: true,
            build_errors: results::Errors::new(),
            spacing_m: f64::from(set.spacing_m),
            clamp_m: f64::from(set.min_distance_m),
            candidates: u64::from(counts.chosen),
            too_small: u64::from(counts.too_small),
            too_large: u64::from(counts.too_large),
            kept: u64::from(counts.kept),
            mean_range_m: if lights.is_empty() { 0.0 } else { sum / lights.len() as f64 },
            deep: ranges.deep().map(|images| figures(images, &args.bounce.deep)),
            passes: samples.finish(),
        };
        Ok(Made { lights, figures })
    }
}

/// Draws the scene of `renderer` as the primary light sees it.
fn map_of(
    gpu: &Gpu,
    renderer: &Renderer,
    view: &View,
    primary: Light,
) -> Result<Renderer, HarnessError> {
    let mut map = renderer.beside(view)?;
    map.prepare(view, &LightBuffer::new(gpu, &[primary])?)?;
    Ok(map)
}

/// The map that virtual point lights come from.
fn rsm_of<'a>(map: &'a Renderer, view: &'a View, light: &'a Light) -> Rsm<'a> {
    let targets = map.targets();
    Rsm {
        depth: &targets.depth,
        normals: &targets.normal,
        base_color: &targets.base_color,
        view,
        light,
    }
}

/// Draws the map and chooses lights from its pixels.
fn record_map(map: &Renderer, view: &View, vpls: &VplBuffer, passes: &mut dyn Passes) {
    let mut named = OfMap(passes);
    map.record_depth(view, &mut named);
    map.record_gbuffer(view, &mut named);
    vpls.record_choose(passes);
}

/// Every step of a frame.
fn record(
    map: &Renderer,
    view: &View,
    vpls: &mut VplBuffer,
    ranges: &mut Ranges,
    passes: &mut dyn Passes,
) -> Result<(), HarnessError> {
    record_map(map, view, vpls, passes);
    ranges.record(passes)?;
    vpls.record_keep(passes);
    Ok(())
}

/// The settings that choose lights and limit their ranges.
fn settings(scene: &Scene, args: &VplArgs) -> VplSettings {
    let core_m = scene.core_bounds.diagonal();
    let is_infinite = args.ranges == RangeChoice::Infinite;
    let infinite_m = INFINITE_DIAGONALS * scene.bounds.diagonal().clamp(1e-3, 1e6);
    // Only a light whose rays meet nothing has no range, and such a light lights nothing.
    let longest_m = if is_infinite { infinite_m } else { MAX_RANGE_M };
    let (low_m, high_m) = args
        .keep_ranges
        .map_or((MIN_RANGE_M, longest_m), |span| (span.low_m as f32, span.high_m as f32));
    let high_m = high_m.clamp(MIN_RANGE_M, MAX_RANGE_M);
    VplSettings {
        spacing_m: args.vpl_spacing as f32,
        limit: None,
        // Random ranges are ranges already; the factor is only for measured distances.
        range_scale: if args.ranges.measures() { args.range_scale as f32 } else { 1.0 },
        min_range_m: low_m.clamp(MIN_RANGE_M, high_m),
        max_range_m: high_m,
        large: if is_infinite { Large::Clamp } else { Large::Discard },
        min_distance_m: args.vpl_clamp.map_or(CLAMP_SHARE * core_m, |clamp| clamp as f32),
    }
}

/// The bounds of ranges that do not come from the lengths of rays. Both are equal for a constant range.
fn drawn_span(scene: &Scene, args: &VplArgs) -> Option<Span> {
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
enum Ranges<'a> {
    Cast {
        images: Box<DeepImages>,
        triangles: Triangles<'a>,
        caster: RangeCaster,
        light_world: Vec3,
        /// Replaces the measured lengths. Lights whose rays met nothing stay left out.
        drawn: Option<RandomRanges>,
    },
    Random(RandomRanges),
    Infinite,
}

impl<'a> Ranges<'a> {
    fn new(
        gpu: &Gpu,
        scene: &Scene,
        args: &StageArgs,
        vpls: &VplBuffer,
        (triangles, light_world): (Option<Triangles<'a>>, Vec3),
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
            let mut images = DeepImages::new(gpu, settings_of(&args.0.deep)?)?;
            settle(gpu, &mut images, &triangles)?;
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

    fn prepare(&mut self, gpu: &Gpu, vpls: &VplBuffer) -> Result<(), HarnessError> {
        if let Self::Cast { images, triangles, caster, light_world, .. } = self {
            images.prepare(gpu, triangles)?;
            caster.prepare(gpu, &points_of(vpls, Some(*light_world)))?;
        }
        Ok(())
    }

    fn record(&mut self, passes: &mut dyn Passes) -> Result<(), HarnessError> {
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

    fn deep(&self) -> Option<&DeepImages> {
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

/// Records passes under the name of the map.
struct OfMap<'a>(&'a mut dyn Passes);

impl Passes for OfMap<'_> {
    fn compute(&mut self, name: &str, record: &mut dyn FnMut(&mut wgpu::ComputePass<'_>)) {
        self.0.compute(&format!("rsm-{name}"), record);
    }

    fn render(
        &mut self,
        name: &str,
        descriptor: &wgpu::RenderPassDescriptor<'_>,
        record: &mut dyn FnMut(&mut wgpu::RenderPass<'_>),
    ) {
        self.0.render(&format!("rsm-{name}"), descriptor, record);
    }

    fn encoder(&mut self) -> &mut wgpu::CommandEncoder {
        self.0.encoder()
    }
}

/// Draws the map once and makes a light of each texel that shows a surface, with position and normal. If
/// `is_middle`, the map shows the middle of the scene, so that almost every texel shows a surface.
///
/// # Errors
///
/// As [`VplMaker::make`].
pub fn all_texels(
    gpu: &Gpu,
    scene: &Scene,
    renderer: &Renderer,
    primary: Light,
    (size_px, is_middle): (u32, bool),
) -> Result<VplBuffer, HarnessError> {
    let mut view = rsm_view(&primary, size_px, (scene.bounds.min, scene.bounds.max))?;
    let (centre, half) = (scene.core_bounds.center(), MIDDLE_SHARE * scene.core_bounds.size());
    // A spot of the scene may point elsewhere.
    if let (true, Ok(middle)) =
        (is_middle, rsm_view(&primary, size_px, (centre - half, centre + half)))
    {
        view.projection = middle.projection;
    }
    let map = map_of(gpu, renderer, &view, primary)?;
    let mut vpls = VplBuffer::new(gpu, VplSettings::default())?;
    vpls.prepare(gpu, &rsm_of(&map, &view, &primary))?;
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    record_map(&map, &view, &vpls, &mut EncoderPasses { encoder: &mut encoder });
    gpu.queue.submit([encoder.finish()]);
    gpu.wait()?;
    Ok(vpls)
}
