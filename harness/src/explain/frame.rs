//! Draws one frame with every method, and asks it about a pixel.

use assign::{ALL_LIGHTS, Assignment, EncoderPasses, Gpu, Light, ListsSnapshot};
use glam::{DVec3, Vec3};
use shading::{
    GroupVolume, HdrImage, LightingOptions, PixelGroup, PixelSurface, groups_of_pixel, light_pixel,
    list_of_pixel, record_for_probe,
};

use super::{
    Asked, layer_note,
    lights::{Place, entries_of, list_seen, reaching},
    mode_note,
    pixel::{
        BoundsSeen, Difference, Explanation, GroupSeen, ListSeen, Material, SampleSeen,
        StrategySeen,
    },
};
use crate::{
    cli::ExplainArgs, error::HarnessError, measure::draw_unclocked, moving::lights_by_slot,
    painter::Painter, stage::Stage, visible::visible,
};

/// Frames in which the pool of a method may grow to what its lists ask for.
const MAX_SETTLING: u32 = 8;

/// Which frame is explained.
#[derive(Clone, Copy)]
pub(super) struct When {
    /// The frame; `None` for the still view.
    pub(super) frame: Option<u32>,
    /// The frames of the camera's path.
    pub(super) frames: u32,
}

/// What was seen at the pixel with one method.
struct Seen {
    strategy: StrategySeen,
    sample: Option<SampleSeen>,
}

/// Draws the frame with every method, the first of them no culling, and explains the pixel.
pub(super) fn draw_all(
    gpu: &Gpu,
    stage: &mut Stage,
    args: &ExplainArgs,
    when: When,
    asked: &mut [Asked],
) -> Result<Explanation, HarnessError> {
    stage.prepare()?;
    let facts: Vec<(String, bool, bool)> =
        asked.iter().map(|a| (a.id.clone(), a.is_lossy, a.remembers)).collect();
    let mut painters = Vec::new();
    for asked in asked.iter_mut() {
        painters.push(Painter::new(stage, &mut asked.method, args.mode, args.cut)?);
    }
    let remembers: Vec<bool> = facts.iter().map(|(.., remembers)| *remembers).collect();
    bring_to(gpu, stage, args, when, &mut painters, &remembers)?;
    let mut strategies: Vec<StrategySeen> = Vec::new();
    let mut sample = None;
    for ((id, is_lossy, _), painter) in facts.into_iter().zip(&mut painters) {
        draw_unclocked(gpu, stage, args.mode, painter)?;
        let mut seen = look(gpu, stage, args, painter)?;
        seen.strategy.strategy = visible(&id).into_owned();
        seen.strategy.is_lossy = is_lossy;
        let baseline = strategies.first().map(|none| none.radiance);
        seen.strategy.difference = baseline.map(|none| difference(seen.strategy.radiance, none));
        sample = sample.or(seen.sample);
        strategies.push(seen.strategy);
    }
    let sample_note = sample.as_ref().and_then(position_note);
    let notes = [mode_note(args.mode), layer_note(&args.layers), sample_note];
    Ok(Explanation {
        scene: visible(&stage.scene.name).into_owned(),
        lights: stage.light_count(),
        size: [stage.view.viewport.width, stage.view.viewport.height],
        mode: args.mode.name().to_owned(),
        frame: when.frame,
        path_frames: args.path.then_some(when.frames),
        pixel: [args.pixel.x, args.pixel.y],
        sample,
        strategies,
        notes: notes.into_iter().flatten().collect(),
    })
}

/// The note for a sample without a position.
fn position_note(sample: &SampleSeen) -> Option<String> {
    let is_finite = sample.position_world.iter().all(|x| x.is_finite());
    (!is_finite).then(|| {
        "the sample's position is not a number, so no light can be said to reach it: `compare` counts it as missed"
            .to_owned()
    })
}

/// Grows the pools, then shows the frame. The frames before it are drawn too with the methods that remember them.
fn bring_to(
    gpu: &Gpu,
    stage: &mut Stage,
    args: &ExplainArgs,
    when: When,
    painters: &mut [Painter<'_>],
    remembers: &[bool],
) -> Result<(), HarnessError> {
    let When { frame, frames } = when;
    if let Some(frame) = frame {
        stage.go_to(frame, frames)?;
    }
    // No culling, the first, has no pool.
    for painter in painters.iter_mut().skip(1) {
        for drawn in 0..=MAX_SETTLING {
            let settled = draw_unclocked(gpu, stage, args.mode, painter)?;
            // The counters of the first frame come back with the second.
            if settled && (drawn > 0 || !painter.has_groups()) {
                break;
            }
        }
    }
    let Some(frame) = frame else { return Ok(()) };
    stage.expire_order();
    painters.iter_mut().for_each(Painter::expire);
    if remembers.contains(&true) {
        for before in 0..frame {
            stage.go_to(before, frames)?;
            for (painter, _) in painters.iter_mut().zip(remembers).filter(|(_, keeps)| **keeps) {
                draw_unclocked(gpu, stage, args.mode, painter)?;
            }
        }
    }
    stage.go_to(frame, frames)
}

/// Looks at the pixel of the frame that a painter just drew.
fn look(
    gpu: &Gpu,
    stage: &Stage,
    args: &ExplainArgs,
    painter: &Painter<'_>,
) -> Result<Seen, HarnessError> {
    let image = HdrImage::read(gpu, stage.renderer.targets(), stage.view.viewport)?;
    let pixel_ix = args.pixel.y * image.width + args.pixel.x;
    let mut strategy = StrategySeen {
        strategy: String::new(),
        is_lossy: false,
        radiance: image.pixels.get(pixel_ix as usize).copied().unwrap_or_default(),
        difference: None,
        groups: Vec::new(),
        list: None,
    };
    let Painter::Lists { strategy: assignment, lighting, .. } = painter else {
        return Ok(Seen { strategy, sample: None });
    };
    let lists = Lists { gpu, stage, args, strategy: &**assignment, options: lighting.options() };
    if args.mode.is_forward() {
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let mut passes = EncoderPasses { encoder: &mut encoder };
        record_for_probe(&stage.renderer, &stage.view, lists.strategy, &mut passes);
        gpu.queue.submit([encoder.finish()]);
    }
    let lights = lights_by_slot(gpu, &stage.lights)?;
    let Some((sample, list)) = lists.list(pixel_ix, &lights)? else {
        return Ok(Seen { strategy, sample: None });
    };
    strategy.groups = lists.groups()?;
    strategy.list = Some(list);
    Ok(Seen { strategy, sample: Some(sample) })
}

/// A frame of a strategy with lists.
struct Lists<'a> {
    gpu: &'a Gpu,
    stage: &'a Stage,
    args: &'a ExplainArgs,
    strategy: &'a dyn Assignment,
    options: LightingOptions,
}

impl Lists<'_> {
    /// The pixel's sample and its list; `None` if it shows no surface.
    fn list(
        &self,
        pixel_ix: u32,
        lights: &[Light],
    ) -> Result<Option<(SampleSeen, ListSeen)>, HarnessError> {
        let Stage { renderer, view, lights: buffer, .. } = self.stage;
        let frame = renderer.frame(view, buffer);
        let pixel = [self.args.pixel.x, self.args.pixel.y];
        let Some(seen) = light_pixel(renderer, &frame, self.options, pixel, &[])? else {
            return Ok(None);
        };
        let is_forward = self.args.mode.is_forward();
        let list = list_of_pixel(renderer, self.strategy, &frame, pixel_ix, is_forward)?;
        let vector = |v: [f32; 4]| DVec3::new(v[0].into(), v[1].into(), v[2].into());
        let point = vector(seen.surface.position_world);
        let normal = vector(seen.surface.normal_roughness);
        let knows_normals = self.strategy.needs().normals;
        let place = Place { point, normal: knows_normals.then_some(normal) };
        let entries = entries_of(&list, lights, place);
        let lit = light_pixel(renderer, &frame, self.options, pixel, &entries)?;
        let radiance = lit.map(|lit| lit.radiance).unwrap_or_default();
        let seen_list = list_seen((&entries, &radiance), list.len(), lights, buffer, place);
        Ok(Some((self.sample(&seen.surface, reaching(lights, point)), seen_list)))
    }

    fn sample(&self, surface: &PixelSurface, reached_by: usize) -> SampleSeen {
        let first3 = |v: [f32; 4]| [v[0], v[1], v[2]];
        let position = Vec3::from(first3(surface.position_world));
        SampleSeen {
            position_world: self.in_file(position.to_array()),
            position_view: self.stage.view.world_to_view.transform_point3(position).to_array(),
            depth_view_m: surface.from_suns[3],
            depth_clip: surface.emission[3],
            normal_world: first3(surface.normal_roughness),
            material: Material {
                base_color: first3(surface.base_color),
                metallic: surface.base_color[3],
                roughness: surface.normal_roughness[3],
                dielectric: surface.dielectric,
            },
            emission: first3(surface.emission),
            from_suns: first3(surface.from_suns),
            reached_by,
        }
    }

    /// The groups of the pixel's sample.
    fn groups(&self) -> Result<Vec<GroupSeen>, HarnessError> {
        let Stage { renderer, view, lights, .. } = self.stage;
        let frame = renderer.frame(view, lights);
        let pixel = [self.args.pixel.x, self.args.pixel.y];
        let found = groups_of_pixel(renderer, self.strategy, &frame, pixel)?;
        let lists = self.strategy.lists();
        let snapshot = lists.snapshot(self.gpu)?;
        let group = |found: &PixelGroup| GroupSeen {
            index: (found.group != ALL_LIGHTS).then_some(found.group),
            count: lists.group_count(),
            bounds: found.bounds.map(|bounds| self.bounds(bounds)),
            overflowed: !lists.storage().is_mask() && is_overflowed(&snapshot, found.group),
        };
        Ok(found.iter().map(group).collect())
    }

    fn bounds(&self, volume: GroupVolume) -> BoundsSeen {
        match volume {
            GroupVolume::Frustum { ndc_min, ndc_max, depth_m, slices } => {
                let viewport = self.stage.view.viewport;
                let x = |ndc: f32| (0.5 + 0.5 * ndc) * viewport.width as f32;
                let y = |ndc: f32| (0.5 - 0.5 * ndc) * viewport.height as f32;
                BoundsSeen::Frustum {
                    low_px: [x(ndc_min[0]), y(ndc_max[1])],
                    high_px: [x(ndc_max[0]), y(ndc_min[1])],
                    // Deeper than any view: without a far plane.
                    depth_m: depth_m.map(|depth| (depth < 1e38).then_some(depth)),
                    slices: slices.map(u32::count_ones),
                }
            }
            GroupVolume::Box { min_world, max_world } => BoundsSeen::Box {
                min_world: self.in_file(min_world),
                max_world: self.in_file(max_world),
            },
            GroupVolume::OrientedBox { center_world, axes, half_extents_m } => {
                BoundsSeen::OrientedBox {
                    center_world: self.in_file(center_world),
                    axes,
                    half_extents_m,
                }
            }
        }
    }

    /// A position in the coordinates of the scene's file.
    fn in_file(&self, position: [f32; 3]) -> [f64; 3] {
        (self.stage.scene.origin + Vec3::from(position).as_dvec3()).to_array()
    }
}

/// Whether a group's list did not fit: only then does it share the entries of the list of all lights.
fn is_overflowed(snapshot: &ListsSnapshot, group: u32) -> bool {
    let list = snapshot.list(group).unwrap_or_default();
    group != ALL_LIGHTS && list.count > 0 && list.first == 0
}

/// How a radiance differs from that of no culling.
fn difference(radiance: [f32; 3], none: [f32; 3]) -> Difference {
    let pairs = || radiance.into_iter().zip(none);
    let mut off = [0.0; 3];
    for (off, (a, b)) in off.iter_mut().zip(pairs()) {
        *off = a - b;
    }
    let relative = |(a, b): (f32, f32)| {
        let (a, b) = (f64::from(a), f64::from(b));
        let relative = (a - b).abs() / b.abs().max(1e-6);
        if relative.is_finite() { relative } else { f64::INFINITY }
    };
    Difference {
        radiance: off,
        relative: pairs().map(relative).fold(0.0, f64::max),
        is_same: pairs().all(|(a, b)| a.to_bits() == b.to_bits()),
    }
}
