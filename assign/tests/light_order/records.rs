//! Lights and records at the limits of what is accepted, and beyond them.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use assign::{
    Emitter, Light, LightEmission, LightShape, LightSphere, MAX_INTENSITY, MAX_RANGE_M,
    MIN_RANGE_M, MIN_SPOT_ANGLE,
};
use glam::Vec3;

/// A light's record. Its shape index counts from its own shape vectors.
#[derive(Clone, Debug)]
pub(crate) struct Record {
    pub(crate) sphere: LightSphere,
    pub(crate) emission: LightEmission,
    pub(crate) shapes: Vec<[f32; 4]>,
}

impl Record {
    pub(crate) fn new(light: &Light) -> Self {
        let mut shapes = Vec::new();
        Self { sphere: light.sphere(), emission: light.emission(&mut shapes), shapes }
    }

    /// The record after a change.
    pub(crate) fn with(&self, change: impl FnOnce(&mut Self)) -> Self {
        let mut changed = self.clone();
        change(&mut changed);
        changed
    }
}

pub(crate) fn spot(direction: Vec3, inner_angle: f32, outer_angle: f32) -> Light {
    let shape = LightShape::Spot { direction, inner_angle, outer_angle };
    Light { shape, ..Light::point(Vec3::ZERO, 2.0, Vec3::ONE) }
}

pub(crate) fn vpl(normal: Vec3, min_distance_m: f32) -> Light {
    let shape = LightShape::Vpl { normal, min_distance_m };
    Light { shape, ..Light::point(Vec3::ZERO, 2.0, Vec3::ONE) }
}

pub(crate) fn area(emitter: Emitter) -> Light {
    Light::area(emitter, Vec3::ZERO, 2.0, Vec3::ONE)
}

/// A polygon at the origin.
fn polygon(vertices: &[[f32; 2]]) -> Light {
    let vertices: Vec<Vec3> = vertices.iter().map(|&[x, y]| Vec3::new(x, y, 0.0)).collect();
    area(Emitter::polygon(&vertices).unwrap().0)
}

/// A square with a dent in its upper side: a corner lies outside the edge beyond the dent, by some share of
/// the square's size.
fn dented(share: f32) -> Light {
    let dent = 1.0 - 0.5 * share * 2_f32.sqrt();
    polygon(&[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [0.0, dent], [-1.0, 1.0]])
}

/// Some regular polygon.
pub(crate) fn regular(count: u32) -> Light {
    let vertex = |ix| {
        let (sin, cos) = (TAU * ix as f32 / count as f32).sin_cos();
        [cos, sin]
    };
    polygon(&(0..count).map(vertex).collect::<Vec<_>>())
}

fn rectangle(half_x: Vec3, half_y: Vec3) -> Light {
    area(Emitter::rectangle(half_x, half_y))
}

fn shared(diffuse_share: f32, range_m: f32) -> Light {
    let square = Emitter::rectangle(Vec3::X, Vec3::Y).with_diffuse_share(diffuse_share);
    Light { range_m, ..area(square) }
}

pub(crate) fn square() -> Light {
    rectangle(Vec3::X, Vec3::Y)
}

pub(crate) fn disc(radius_m: f32) -> Light {
    area(Emitter::disc(Vec3::new(0.6, 0.0, 0.8), radius_m))
}

fn sphere(radius_m: f32) -> Light {
    area(Emitter::sphere(radius_m))
}

fn line(half_m: f32, radius_m: f32) -> Light {
    area(Emitter::line(half_m * Vec3::new(0.6, 0.0, 0.8), radius_m))
}

/// Ranges that every kind of light may have, or may not.
fn ranged(range_m: f32) -> [Light; 8] {
    let kinds = [
        Light::point(Vec3::ZERO, 1.0, Vec3::ONE),
        spot(Vec3::X, 0.1, 0.5),
        vpl(Vec3::Y, 0.1),
        square(),
        regular(5),
        disc(0.3),
        sphere(0.3),
        line(0.7, 0.1),
    ];
    kinds.map(|light| Light { range_m, ..light })
}

fn lit(intensity: Vec3) -> Light {
    Light { intensity, ..square() }
}

pub(crate) fn sound() -> Vec<Light> {
    let mut lights = [MIN_RANGE_M, 1.0, MAX_RANGE_M].map(ranged).concat();
    for outer in [MIN_SPOT_ANGLE, 1e-4, 1e-3, 0.01, 0.1, 0.8, FRAC_PI_2, 2.0, 3.0, 3.1, PI] {
        lights.extend([0.0, 0.5, 0.999, 1.0].map(|inner| spot(Vec3::Z, inner * outer, outer)));
    }
    lights.extend([(6e-5, 8e-5), (6e4, 8e4)].map(|(x, y)| rectangle(x * Vec3::X, y * Vec3::Y)));
    lights.extend([3, 4, 7, 10].map(regular));
    lights.extend([
        lit(Vec3::splat(MAX_INTENSITY)),
        lit(Vec3::new(0.0, f32::MIN_POSITIVE, 0.0)),
        spot(1.0009 * Vec3::X, 0.1, 0.5),
        spot(0.9991 * Vec3::X, 0.1, 0.5),
        vpl(1.0009 * Vec3::X, 0.0),
        vpl(Vec3::X, MAX_RANGE_M),
        shared(1e-3, 1.0),
        shared(0.5, 2.0 * MIN_RANGE_M),
        rectangle(Vec3::X, Vec3::new(0.9e-3, 1.0, 0.0)),
        // An area of 1.01e-4 of the squared size.
        rectangle(Vec3::X, 0.2525e-4 * Vec3::Y),
        dented(0.0),
        dented(0.9e-4),
        // A vertex that is given twice.
        polygon(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [0.0, 1.0]]),
        area(Emitter::rectangle(Vec3::X, Vec3::Y).two_sided()),
        area(Emitter::disc(Vec3::X, 0.5).two_sided()),
        line(1.0, 1.1e-4),
        line(1.1e-3, 1.0),
    ]);
    lights.extend([1.01e-4, 0.99e5].into_iter().flat_map(|size| [disc(size), sphere(size)]));
    lights
}

pub(crate) fn faulty() -> Vec<Light> {
    let ranges =
        [MIN_RANGE_M.next_down(), MAX_RANGE_M.next_up(), 0.0, -1.0, f32::NAN, f32::INFINITY];
    let mut lights = ranges.map(ranged).concat();
    for outer in [0.0, 0.999 * MIN_SPOT_ANGLE, -0.5, -3.0, PI + 0.01, 5.0, f32::NAN, f32::INFINITY]
    {
        lights.push(spot(Vec3::Z, 0.0, outer));
    }
    let moved = |position| Light { position, ..square() };
    let loops = |vertices: &[[f32; 2]], rounds| polygon(&vertices.repeat(rounds));
    lights.extend([
        moved(Vec3::new(f32::NAN, 0.0, 0.0)),
        moved(Vec3::new(0.5, f32::NEG_INFINITY, 0.0)),
        lit(Vec3::ZERO),
        lit(Vec3::new(1.0, -1.0, 1.0)),
        lit(Vec3::new(1.0, f32::NAN, 1.0)),
        lit(Vec3::new(1.0, 1.0, MAX_INTENSITY.next_up())),
        lit(Vec3::new(f32::INFINITY, 1.0, 1.0)),
        spot(Vec3::ZERO, 0.1, 0.5),
        spot(Vec3::NAN, 0.1, 0.5),
        vpl(Vec3::ZERO, 0.0),
        vpl(Vec3::X, 1.001 * MAX_RANGE_M),
        vpl(Vec3::X, f32::NAN),
        vpl(Vec3::X, f32::INFINITY),
        shared(1.001, 1.0),
        shared(0.0, 1.0),
        shared(-0.5, 1.0),
        shared(f32::NAN, 1.0),
        shared(0.5, MIN_RANGE_M),
        rectangle(Vec3::X, Vec3::new(1.1e-3, 1.0, 0.0)),
        rectangle(Vec3::X, Vec3::X),
        rectangle(Vec3::X, Vec3::ZERO),
        rectangle(Vec3::X, Vec3::new(0.0, f32::NAN, 0.0)),
        rectangle(Vec3::X, 1e38 * Vec3::Y),
        rectangle(0.599e-4 * Vec3::X, 0.799e-4 * Vec3::Y),
        rectangle(0.601e5 * Vec3::X, 0.801e5 * Vec3::Y),
        // An area of 0.98e-4 of the squared size.
        rectangle(Vec3::X, 0.245e-4 * Vec3::Y),
        dented(1.1e-4),
        dented(0.5),
        area(Emitter::disc(Vec3::ZERO, 1.0)),
        area(Emitter::disc(Vec3::X, 1.0).with_diffuse_share(2.0)),
        line(1.0, 0.9e-4),
        line(0.9e-3, 1.0),
        line(1.0, -0.1),
        line(f32::NAN, 0.1),
        line(1e5, 0.1e5),
        loops(&[[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]], 2),
        loops(&[[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]], 2),
    ]);
    let sizes = [0.99e-4, 1.01e5, 0.0, -1.0, f32::NAN, f32::INFINITY];
    lights.extend(sizes.into_iter().flat_map(|size| [disc(size), sphere(size)]));
    lights
}

/// Faulty lights whose records are those of other lights: the list in the documentation of `GpuLights`.
pub(crate) fn hidden() -> Vec<Light> {
    vec![
        vpl(Vec3::X, -0.5),
        vpl(1.5 * Vec3::X, 0.5),
        spot(0.5 * Vec3::X, 0.1, 0.5),
        spot(Vec3::X, -0.1, 0.5),
        spot(Vec3::X, 0.6, 0.5),
        spot(Vec3::X, f32::NAN, 0.5),
        spot(Vec3::X, 0.1, PI + 5e-4),
        spot(Vec3::X, 0.1, TAU + 0.5),
    ]
}

/// The record of a regular polygon of any number of vertices, with half axes that hold them loosely.
pub(crate) fn ring(count: u32) -> Record {
    Record::new(&regular(3)).with(|r| {
        r.sphere.radius_m = 3.1;
        r.shapes[1] = [1.1, 0.0, 0.0, 2.0];
        r.shapes[2] = [0.0, 1.1, 0.0, count as f32];
        let step = TAU / count as f32;
        r.shapes[3][0] = 0.5 * count as f32 * step.sin();
        r.shapes.truncate(4);
        r.shapes.extend((0..count).map(|ix| {
            let (sin, cos) = (step * ix as f32).sin_cos();
            [cos, sin, 0.0, 0.0]
        }));
    })
}

/// A triangle whose last vertex is at its position.
pub(crate) fn corner() -> Record {
    ring(3).with(|r| {
        r.shapes[3][0] = 0.5;
        r.shapes[4] = [1.0, 0.0, 0.0, 0.0];
        r.shapes[5] = [0.0, 1.0, 0.0, 0.0];
        r.shapes[6] = [0.0; 4];
    })
}

/// Records that no light has.
pub(crate) fn contradictions() -> Vec<(&'static str, Record)> {
    let point = Record::new(&Light::point(Vec3::ZERO, 2.0, Vec3::ONE));
    let obtuse = Record::new(&spot(Vec3::X, 0.3, 2.0));
    let spot = Record::new(&spot(Vec3::X, 0.3, 0.5));
    let vpl = Record::new(&vpl(Vec3::X, 0.3));
    let square = Record::new(&square());
    let flat = Record::new(&rectangle(2.0 * Vec3::X, Vec3::Y));
    let hexagon = Record::new(&regular(6));
    let [disc, ball, tube] = [disc(0.3), sphere(0.3), line(0.7, 0.1)].map(|l| Record::new(&l));
    let kind = |kind: u32| point.with(|r| r.emission.kind_and_shape = kind << 28);
    let at = |x: f32, y: f32| square.with(|r| r.sphere.position_world = [x, y, 0.0]);
    let far = |record: &Record| record.with(|r| r.emission.kind_and_shape |= 0x0fff_0000);
    vec![
        ("kind 8", kind(8)),
        ("kind 15", kind(15)),
        ("left of the box", at(-0.5, 0.0)),
        ("above the box", at(0.5, 1.5)),
        ("a point's range", point.with(|r| r.sphere.radius_m = 1.5 * MAX_RANGE_M)),
        ("a spot's range", spot.with(|r| r.sphere.radius_m = 1.5 * MAX_RANGE_M)),
        ("a spot's index", far(&spot)),
        ("a VPL's index", far(&vpl)),
        ("a rectangle's index", far(&square)),
        ("a polygon's index", far(&hexagon)),
        ("a spot's axis", spot.with(|r| r.shapes[0][0] = 1.0005)),
        ("a spot's cosine", spot.with(|r| r.shapes[0][3] += 1e-4)),
        ("a spot's cosine is NaN", spot.with(|r| r.shapes[0][3] = f32::NAN)),
        ("a spot's sine", spot.with(|r| r.shapes[1][1] -= 1e-4)),
        ("a spot's sine is negative", obtuse.with(|r| r.shapes[1][1] *= -1.0)),
        (
            "a spot's sine and chord",
            obtuse.with(|r| {
                r.shapes[1][1] *= 0.999;
                let chord = [r.shapes[1][1], 1.0 - r.shapes[0][3]];
                r.shapes[1][2] = chord[0] * chord[0] + chord[1] * chord[1];
                r.shapes[1][0] = 1.1 / r.shapes[1][2];
            }),
        ),
        ("a spot's chord is short", spot.with(|r| r.shapes[1][2] *= 0.9999)),
        ("a spot's chord is long", spot.with(|r| r.shapes[1][2] *= 1.0001)),
        ("a spot's chord is NaN", spot.with(|r| r.shapes[1][2] = f32::NAN)),
        ("a spot's ramp is flat", spot.with(|r| r.shapes[1][0] = 0.99 / r.shapes[1][2])),
        ("a spot's ramp is steep", spot.with(|r| r.shapes[1][0] = 1.1e30)),
        ("a spot's ramp is negative", spot.with(|r| r.shapes[1][0] *= -1.0)),
        ("a VPL's normal", vpl.with(|r| r.shapes[0][0] = 1.0005)),
        ("a VPL's cosine", vpl.with(|r| r.shapes[0][3] = 1e-3)),
        ("a VPL's sine", vpl.with(|r| r.shapes[1][1] = 0.999)),
        ("a VPL's distance", vpl.with(|r| r.shapes[1][2] = -1.0)),
        ("a ball without its range", square.with(|r| r.sphere.radius_m = 2.0)),
        ("a ball that is small", hexagon.with(|r| r.sphere.radius_m *= 0.9999)),
        (
            "a normal that is long",
            square.with(|r| {
                r.shapes[0][2] *= 1.0005;
                r.shapes[3][0] /= 1.0005;
            }),
        ),
        ("a normal backwards", square.with(|r| r.shapes[0][2] = -1.0)),
        ("a normal in the plane", square.with(|r| r.shapes[0] = [1.0, 0.0, 0.0, 2.0])),
        (
            "a normal that tilts",
            hexagon.with(|r| {
                let (sin, cos) = 1e-3_f32.sin_cos();
                r.shapes[0] = [sin, 0.0, cos, 2.0];
            }),
        ),
        ("an emitter's range", square.with(|r| r.shapes[0][3] = 2.5)),
        ("a first half axis that is short", hexagon.with(|r| r.shapes[1][0] *= 0.9999)),
        ("a second half axis that is short", hexagon.with(|r| r.shapes[2][1] *= 0.9999)),
        ("a half axis that is 0", hexagon.with(|r| r.shapes[2] = [0.0, 0.0, 0.0, 6.0])),
        ("a half axis that is NaN", hexagon.with(|r| r.shapes[2][0] = f32::NAN)),
        ("half axes that are skewed", hexagon.with(|r| r.shapes[1][1] += 0.01)),
        ("a half axis off the plane", hexagon.with(|r| r.shapes[1][2] = 0.01)),
        ("a rectangle in large half axes", square.with(|r| r.shapes[1][0] = 1.01)),
        (
            "half axes that are swapped",
            flat.with(|r| {
                (r.shapes[1], r.shapes[2]) = ([0.0, 1.0, 0.0, 2.0], [2.0, 0.0, 0.0, 4.0]);
            }),
        ),
        ("a diffuse range beyond", square.with(|r| r.shapes[1][3] = 2.5)),
        ("a diffuse range of 0", square.with(|r| r.shapes[1][3] = 0.0)),
        ("2 vertices", hexagon.with(|r| r.shapes[2][3] = 2.0)),
        ("3.5 vertices", ring(3).with(|r| r.shapes[2][3] = 3.5)),
        ("11 vertices", ring(11)),
        ("NaN vertices", hexagon.with(|r| r.shapes[2][3] = f32::NAN)),
        ("a rectangle of 3 vertices", square.with(|r| r.shapes[2][3] = 3.0)),
        (
            "a rectangle of 5 vertices",
            square.with(|r| {
                r.shapes[2][3] = 5.0;
                r.shapes.push(r.shapes[7]);
            }),
        ),
        ("an area that is large", hexagon.with(|r| r.shapes[3][0] *= 1.001)),
        ("an area of 0", hexagon.with(|r| r.shapes[3][0] = 0.0)),
        ("an area that is NaN", hexagon.with(|r| r.shapes[3][0] = f32::NAN)),
        ("an area of infinity", hexagon.with(|r| r.shapes[3][0] = f32::INFINITY)),
        ("a vertex that is NaN", hexagon.with(|r| r.shapes[5][1] = f32::NAN)),
        ("a vertex that is huge", hexagon.with(|r| r.shapes[5][1] = 3e38)),
        ("a vertex off the plane", hexagon.with(|r| r.shapes[5][2] = 1.5e-4)),
        (
            "an outline before the position",
            hexagon.with(|r| r.shapes[4..].iter_mut().for_each(|vertex| vertex[2] += 1.5e-4)),
        ),
        ("a disc's normal", disc.with(|r| r.shapes[0][0] = -0.6)),
        (
            "a disc's half axis that is short",
            disc.with(|r| r.shapes[1][..3].iter_mut().for_each(|x| *x *= 0.999)),
        ),
        (
            "a disc's half axis that is long",
            disc.with(|r| r.shapes[2][..3].iter_mut().for_each(|x| *x *= 1.001)),
        ),
        ("a disc's area", disc.with(|r| r.shapes[3][0] *= 1.001)),
        ("a disc of a small radius", disc.with(|r| r.shapes[3][1] *= 0.9)),
        ("a disc of 4 vertices", disc.with(|r| r.shapes[2][3] = 4.0)),
        ("a disc's index", far(&disc)),
        ("a sphere with a half axis", ball.with(|r| r.shapes[1][0] = 0.1)),
        ("a sphere with a normal", ball.with(|r| r.shapes[0][0] = 1.0)),
        ("a sphere in a small ball", ball.with(|r| r.sphere.radius_m = 2.2)),
        ("a one-sided sphere", ball.with(|r| r.shapes[2][3] = 1.0)),
        ("a sphere's radius is NaN", ball.with(|r| r.shapes[3][1] = f32::NAN)),
        ("a line of two half axes", tube.with(|r| r.shapes[2][1] = 0.1)),
        ("a line that is longer than its area", tube.with(|r| r.shapes[1][0] *= 1.01)),
        ("a line that is thicker than its area", tube.with(|r| r.shapes[3][1] *= 1.01)),
        ("vertices the other way round", hexagon.with(|r| r.shapes[4..].reverse())),
        ("corners in another order", square.with(|r| r.shapes[4..].rotate_left(1))),
    ]
}
