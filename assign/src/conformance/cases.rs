//! The named cases, each a situation in which light assignment fails in practice: a view, surfaces
//! and lights from a seed.

use glam::Vec3;

use super::{
    lights::{Kinds, at_horizon, bad_lights, lights_at, mix, reaching},
    living,
    plan::{Lit, Plan, default_view, in_room},
    stage::{IN_THE_OPEN, Rng, Solid, Stage, room},
    views::{self, SIZE},
};
use crate::{DepthMapping, Light, LightShape, View};

/// A named case of the suite.
#[derive(Clone, Copy, Debug)]
pub struct Case {
    /// The case's name, for [`run_case`](super::run_case).
    pub name: &'static str,
    /// The difficulty of the case, in one line.
    pub about: &'static str,
    /// Whether some light reaches some sample. If so, the case fails if it checked no pair.
    pub has_pairs: bool,
    pub(super) build: fn(&mut Rng) -> Plan,
}

const fn case(name: &'static str, about: &'static str, build: fn(&mut Rng) -> Plan) -> Case {
    Case { name, about, has_pairs: true, build }
}

/// All cases in the order in which they run.
#[rustfmt::skip]
pub const CASES: &[Case] = &[
    Case { has_pairs: false, ..case("no-lights", "no light at all", |r| count(r, 0)) },
    case("1-light", "one light", |r| count(r, 1)),
    case("31-lights", "one less than a word of hits", |r| count(r, 31)),
    case("33-lights", "one more than a word of hits", |r| count(r, 33)),
    case("5000-lights", "more lights than one scan of the kernel", |r| count(r, 5_000)),
    case("65537-lights", "more lights than 16 bits name", many_lights),
    case("2000-lights-in-one-group", "lists longer than the kernel stages", long_list),
    case("lights-at-one-point", "coincident centres", |r| still(r, &default_view(), 500, coincident)),
    case("one-covers-everything", "one light of 10 km and many of centimetres", one_and_many),
    case("camera-inside-lights", "the eye inside every light", |r| {
        still(r, &default_view(), 200, |r, s, n| around(r, s, n, 0.0, 0.9))
    }),
    case("camera-before-lights", "lights behind the eye that reach forward", lights_behind),
    case("camera-between-lights", "lights on all sides of the eye", |r| {
        still(r, &default_view(), 300, |r, s, n| around(r, s, n, 0.5, 1.5))
    }),
    case("light-at-eye", "lights exactly at the eye", at_eye),
    case("light-on-surface", "lights exactly on the samples they light", |r| {
        still(r, &default_view(), 400, on_surface)
    }),
    case("lights-at-horizon", "lights that barely rise above a sample's horizon", |r| {
        still(r, &default_view(), 600, |r, s, n| and_a_spot(at_horizon(r, s, n)))
    }),
    case("light-at-tile-corner", "large lights that barely reach one sample", grazing),
    case("spots-near-0", "spots of half angles of a degree and less", |r| spots(r, 0.0008, 0.02)),
    case("spots-45", "spots of half angle 45 degrees", |r| spots(r, 0.785, 0.786)),
    case("spots-90", "spots of half angle 90 degrees", |r| spots(r, 1.570, 1.571)),
    case("spots-135", "spots of half angle 135 degrees", |r| spots(r, 2.356, 2.357)),
    case("spots-180", "spots of half angles up to 180 degrees", |r| spots(r, 3.1, 3.2)),
    case("area-lights", "rectangles and polygons, faces, corners and edges on", |r| {
        still(r, &default_view(), 600, |r, s, n| {
            and_a_spot(mix(r, s, n, (0.1, 8.0), Kinds::Areas))
        })
    }),
    case("area-lights-grazing", "emitters that barely reach one sample", |r| {
        still(r, &default_view(), 400, |r, s, n| {
            and_a_spot(lights_at(r, s, n, (0.05, 20.0), Kinds::Areas, 1.0))
        })
    }),
    case("mixed-kinds", "points, spots of every angle, rectangles and polygons", |r| {
        still(r, &default_view(), 600, |r, s, n| mix(r, s, n, (0.1, 8.0), Kinds::Mixed))
    }),
    case("thin-near-slices", "a near plane at 1 mm, a wall at 3 cm", |r| near_wall(r, &views::thin_near())),
    case("thin-near-standard-depth", "a near plane at 1 mm, depth not reversed, far 1 km", |r| {
        still(r, &views::standard(0.001, Some(1_000.0)), 300, default_mix)
    }),
    case("far-slices", "a plain seen for kilometres", far_slices),
    case("finite-far", "a far plane, depth reversed", |r| {
        still(r, &View { far_m: Some(40.0), ..default_view() }, 300, default_mix)
    }),
    case("lights-end-before-far", "a far plane far behind the last light", |r| {
        still(r, &View { far_m: Some(2_000.0), ..default_view() }, 300, default_mix)
    }),
    case("standard-depth", "a far plane, depth not reversed", |r| {
        still(r, &views::standard(0.1, Some(40.0)), 300, default_mix)
    }),
    case("infinite-standard-depth", "no far plane, depth not reversed", |r| {
        still(r, &views::standard(0.1, None), 300, default_mix)
    }),
    case("lights-beyond-far", "lights beyond the far plane that reach in", beyond_far),
    case("far-plane-standard-depth", "samples that rounding of depth puts beyond the far plane", far_plane),
    case("orthographic-near-0", "orthographic, near plane at the eye", |r| {
        still(r, &views::orthographic(DepthMapping::Standard), 300, default_mix)
    }),
    case("orthographic-reversed", "orthographic, depth reversed", |r| {
        still(r, &views::orthographic(DepthMapping::Reversed), 300, default_mix)
    }),
    case("off-centre", "a window that does not hold the axis", |r| {
        still(r, &views::off_centre(), 300, default_mix)
    }),
    case("mirrored", "the flipped window of a planar mirror", |r| {
        still(r, &views::mirrored(), 300, default_mix)
    }),
    case("oblique-near-plane", "a mirror's near plane across the room", |r| {
        still(r, &views::oblique(), 300, default_mix)
    }),
    case("oblique-grazing", "a lake's near plane, which hides the lower half, depth not reversed", |r| {
        still(r, &views::grazing(), 300, default_mix)
    }),
    case("oblique-orthographic", "an oblique near plane of parallel rays", |r| {
        still(r, &views::oblique_orthographic(), 300, default_mix)
    }),
    case("own-matrices", "matrices of a left-handed engine with OpenGL's depth", |r| {
        still(r, &views::own_matrices(), 300, default_mix)
    }),
    case("jitter", "sub-pixel jitter", |r| still(r, &views::jittered(), 300, default_mix)),
    case("viewport-offset", "a viewport inside a larger target", offset),
    case("odd-size", "83 x 57 pixels: no multiple of any tile", |r| {
        still(r, &views::sized([83, 57]), 300, default_mix)
    }),
    case("tiny-target", "5 x 3 pixels: smaller than any tile", |r| {
        still(r, &views::sized([5, 3]), 300, default_mix)
    }),
    case("far-from-origin", "a camera 1,000 km from the origin", |r| {
        still(r, &views::far_from_origin(), 800, |r, s, n| mix(r, s, n, (0.2, 4.0), Kinds::Mixed))
    }),
    case("depth-discontinuity", "a fence before a far wall, lights in the void between", fence),
    case("opaque-surfaces-only", "look-ups on opaque surfaces alone", |r| {
        let mut lit = lit(r, &default_view(), 300, default_mix);
        lit.opaque_only = true;
        Plan::Still(lit)
    }),
    case("resize", "the viewport grows, shrinks and moves", resize),
    case("lights-move", "every light moves, then teleports", lights_move),
    case("camera-teleports", "the camera jumps", camera_teleports),
    case("light-count-changes", "lights come and go, spots among them", counts_change),
    case("gpu-order", "the GPU sorts lights that move in every frame", |r| living::few(r, 1, false)),
    case("gpu-order-stale", "lights move, come and go without a new order", |r| living::few(r, 3, false)),
    case("gpu-order-some-move", "a few lights move at a time, and all stay in their slots", living::some),
    case("gpu-order-many", "14,000 lights that move, in a hierarchy of two levels", living::many),
    case("lights-from-gpu", "the GPU writes lights, faulty ones among them, and their number", |r| {
        living::few(r, 2, true)
    }),
    case("overflow", "5,000 lights at one point, a pool of 64 entries", |r| {
        let mut lit = lit(r, &default_view(), 5_000, coincident);
        lit.stage = lit.stage.thinned(400);
        Plan::Overflow(lit)
    }),
    case("quarantine", "faulty lights among sound ones", quarantine),
];

/// Cases that [`run`](super::run) leaves out: what all strategies share and takes long, so that one strategy runs it
/// by [`run_case`](super::run_case), and what only [`run_unstated`](super::run_unstated) asks for.
pub const SHARED_CASES: &[Case] = &[
    case(
        "three-levels-of-nodes",
        "a hierarchy of three levels, for a strategy that reads it",
        living::sparse,
    ),
    case(
        BEYOND_PLANES,
        "samples and lights in front of the near plane and behind the far plane",
        |r| {
            let stage = in_room(r, &View { far_m: Some(40.0), ..default_view() }).beyond_planes();
            Plan::Still(on(r, stage, 400, |r, s, n| mix(r, s, n, (0.01, 1.0), Kinds::Points)))
        },
    ),
];

/// The case of samples that only [`run_unstated`](super::run_unstated) looks up. A fragment that covers only some of a
/// pixel's samples is shaded at the pixel's centre, to which its surface is extrapolated: beyond the planes, too.
pub(super) const BEYOND_PLANES: &str = "beyond-planes";

/// Makes lights for a stage.
type Lights = fn(&mut Rng, &Stage, usize) -> Vec<Light>;

fn default_mix(rng: &mut Rng, stage: &Stage, count: usize) -> Vec<Light> {
    mix(rng, stage, count, (0.1, 8.0), Kinds::Mixed)
}

fn lit(rng: &mut Rng, view: &View, count: usize, lights: Lights) -> Lit {
    let stage = in_room(rng, view);
    on(rng, stage, count, lights)
}

fn on(rng: &mut Rng, stage: Stage, count: usize, lights: Lights) -> Lit {
    Lit { lights: lights(rng, &stage, count), stage, opaque_only: false }
}

fn still(rng: &mut Rng, view: &View, count: usize, lights: Lights) -> Plan {
    Plan::Still(lit(rng, view, count, lights))
}

fn count(rng: &mut Rng, count: usize) -> Plan {
    let mut lit =
        lit(rng, &default_view(), count, |r, s, n| mix(r, s, n, (0.2, 5.0), Kinds::Points));
    if count > 1_000 {
        lit.stage = lit.stage.thinned(1_000);
    }
    Plan::Still(lit)
}

fn many_lights(rng: &mut Rng) -> Plan {
    let mut lit = lit(rng, &views::sized([32, 24]), 65_537, |r, s, n| {
        mix(r, s, n, (0.05, 0.5), Kinds::Points)
    });
    // The last light's index must be in some list.
    if let (Some(last), Some(sample)) = (lit.lights.last_mut(), lit.stage.samples.first()) {
        *last = Light::point(sample.point.as_vec3(), 1.0, Vec3::ONE);
    }
    lit.stage = lit.stage.thinned(100);
    Plan::Still(lit)
}

fn long_list(rng: &mut Rng) -> Plan {
    still(rng, &default_view(), 2_000, |r, s, n| {
        let point = s.samples[s.on_surfaces / 2].point;
        (0..n).map(|_| reaching(r, point, 0.3)).collect()
    })
}

fn coincident(rng: &mut Rng, stage: &Stage, count: usize) -> Vec<Light> {
    let point = stage.samples[stage.on_surfaces / 2].point.as_vec3();
    let range = |r: &mut Rng| r.log_range(0.2, 6.0) as f32;
    (0..count).map(|_| Light::point(point, range(rng), Vec3::ONE)).collect()
}

fn one_and_many(rng: &mut Rng) -> Plan {
    still(rng, &default_view(), 500, |r, s, n| {
        let mut lights = mix(r, s, n, (0.02, 0.3), Kinds::Points);
        lights[n / 2].range_m = 1e4;
        lights
    })
}

/// Lights around the eye, at `low` to `high` times their range from it.
fn around(rng: &mut Rng, stage: &Stage, count: usize, low: f64, high: f64) -> Vec<Light> {
    let eye = stage.view.eye().as_dvec3();
    let one = |_| {
        let range = rng.log_range(1.0, 15.0);
        let center = eye + rng.direction() * range * rng.range(low, high);
        Light::point(center.as_vec3(), range as f32, Vec3::ONE)
    };
    (0..count).map(one).collect()
}

fn lights_behind(rng: &mut Rng) -> Plan {
    still(rng, &default_view(), 300, |r, s, n| {
        let mut lights = around(r, s, n, 0.1, 0.95);
        for light in &mut lights {
            let view = s.view.world_to_view.transform_point3(light.position);
            let behind = view.with_z(view.z.abs());
            light.position = s.to_world(behind.as_dvec3()).as_vec3();
        }
        lights
    })
}

fn at_eye(rng: &mut Rng) -> Plan {
    still(rng, &default_view(), 60, |r, s, n| {
        let mut lights = mix(r, s, n, (0.5, 15.0), Kinds::Mixed);
        lights.iter_mut().for_each(|l| l.position = s.view.eye());
        lights
    })
}

/// Adds a spot. Kernels are compiled for the kinds of the lights, and those for area lights take a software
/// adapter seconds: with a spot they are the kernels of the mixed cases.
fn and_a_spot(mut lights: Vec<Light>) -> Vec<Light> {
    let shape = LightShape::Spot { direction: Vec3::NEG_Y, inner_angle: 0.2, outer_angle: 0.4 };
    lights.extend(lights.first().map(|light| Light { shape, ..*light }));
    lights
}

fn on_surface(rng: &mut Rng, stage: &Stage, count: usize) -> Vec<Light> {
    lights_at(rng, stage, count, (0.01, 2.0), Kinds::Mixed, 0.0)
}

fn grazing(rng: &mut Rng) -> Plan {
    still(rng, &default_view(), 1_000, |r, s, n| {
        lights_at(r, s, n, (0.5, 50.0), Kinds::Points, 1.0)
    })
}

fn spots(rng: &mut Rng, low: f64, high: f64) -> Plan {
    let stage = in_room(rng, &default_view());
    let lights = mix(rng, &stage, 300, (0.3, 10.0), Kinds::Spots(low, high));
    Plan::Still(Lit { stage, lights, opaque_only: false })
}

fn near_wall(rng: &mut Rng, view: &View) -> Plan {
    let stage = Stage::new(*view, SIZE, &room(rng, 0.003), 1_000);
    Plan::Still(on(rng, stage, 300, |r, s, n| mix(r, s, n, (0.0005, 0.1), Kinds::Mixed)))
}

fn far_slices(rng: &mut Rng) -> Plan {
    let stage = Stage::new(default_view(), SIZE, &room(rng, 300.0), 1_000);
    Plan::Still(on(rng, stage, 300, |r, s, n| mix(r, s, n, (5.0, 900.0), Kinds::Mixed)))
}

fn beyond_far(rng: &mut Rng) -> Plan {
    let view = View { far_m: Some(9.0), ..default_view() };
    still(rng, &view, 300, |r, s, n| {
        let mut lights = mix(r, s, n, (2.0, 9.0), Kinds::Points);
        for light in &mut lights {
            let view = s.view.world_to_view.transform_point3(light.position);
            let beyond = view.with_z(-9.0 - 0.7 * light.range_m * r.range(0.0, 1.0) as f32);
            light.position = s.to_world(beyond.as_dvec3()).as_vec3();
        }
        lights
    })
}

/// With the near plane at 1 mm and the far plane at 1 km, clip depth 1 is rebuilt as 1,049 m.
fn far_plane(rng: &mut Rng) -> Plan {
    let mut stage = in_room(rng, &views::standard(0.001, Some(1_000.0)));
    stage.samples.retain(|s| s.model_ix != IN_THE_OPEN || s.depth_clip == 1.0);
    stage = stage.thinned(60);
    Plan::Still(on(rng, stage, 300, |r, s, n| mix(r, s, n, (1.0, 60.0), Kinds::Mixed)))
}

fn offset(rng: &mut Rng) -> Plan {
    let view = views::offset();
    let stage = Stage::new(view, [130, 90], &room(rng, 1.0), 1_000);
    Plan::Still(on(rng, stage, 300, default_mix))
}

fn fence(rng: &mut Rng) -> Plan {
    let solids =
        [Solid::Bars { depth: 3.0, period: 0.6 }, Solid::Wall { depth: 60.0, top: f64::INFINITY }];
    let stage = Stage::new(default_view(), SIZE, &solids, 1_000);
    Plan::Still(on(rng, stage, 400, |r, s, n| {
        let mut lights = mix(r, s, n, (0.5, 10.0), Kinds::Mixed);
        for light in lights.iter_mut().step_by(2) {
            let view = s.view.world_to_view.transform_point3(light.position);
            let void = view * r.range(4.0, 58.0) as f32 / -view.z;
            light.position = s.to_world(void.as_dvec3()).as_vec3();
        }
        lights
    }))
}

fn resize(rng: &mut Rng) -> Plan {
    let mut offset = views::offset();
    offset.viewport.width = 40;
    let views = [views::sized([64, 48]), views::sized([150, 97]), views::sized([31, 70]), offset];
    Plan::Sequence(views.map(|view| lit(rng, &view, 200, default_mix)).into())
}

fn lights_move(rng: &mut Rng) -> Plan {
    let first = lit(rng, &default_view(), 400, default_mix);
    let mut moved = first.clone();
    for light in &mut moved.lights {
        light.position += rng.direction().as_vec3() * 0.5;
    }
    let stage = first.stage.clone();
    let teleported = on(rng, stage, 400, default_mix);
    Plan::Sequence(vec![first, moved, teleported])
}

fn camera_teleports(rng: &mut Rng) -> Plan {
    let first = lit(rng, &default_view(), 300, default_mix);
    let mut second = lit(rng, &views::elsewhere(), 300, default_mix);
    // Half of the second stage's lights are the first stage's; the others are aimed at the new
    // samples.
    second.lights[..150].copy_from_slice(&first.lights[..150]);
    Plan::Sequence(vec![first.clone(), second, first])
}

fn counts_change(rng: &mut Rng) -> Plan {
    let stage = in_room(rng, &default_view());
    let counts = [
        (40, Kinds::Points),
        (700, Kinds::Mixed),
        (0, Kinds::Points),
        (33, Kinds::Mixed),
        (1_500, Kinds::Points),
    ];
    let stages = counts.map(|(count, kinds)| Lit {
        lights: mix(rng, &stage, count, (0.2, 5.0), kinds),
        stage: stage.clone(),
        opaque_only: false,
    });
    Plan::Sequence(stages.into())
}

fn quarantine(rng: &mut Rng) -> Plan {
    let clean = lit(rng, &default_view(), 300, default_mix);
    let mut dirty = clean.clone();
    let mut bad = Vec::new();
    for (ix, light) in bad_lights(&clean.lights).into_iter().enumerate() {
        // Insertions ascend, so that earlier ones do not move later ones.
        bad.push(ix * 13);
        dirty.lights.insert(ix * 13, light);
    }
    Plan::Quarantine { clean, dirty: Box::new(dirty), bad }
}
