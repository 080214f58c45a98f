//! Builds meshes from profiles swept along paths, surfaces and boxes, with normals, tangents, and
//! uv in metres.

use std::f32::consts::TAU;

use glam::{Mat4, Vec2, Vec3};

use crate::{Aabb, Mesh, Vertex};

/// Where a profile point `(a, b)` lies along a sweep: `origin + a * x + b * y`. Its normal lies in
/// the plane of `normal_x` and `y`. That is the plane of `x` and `y` except at mitred ends.
#[derive(Clone, Copy)]
pub(crate) struct Frame {
    pub(crate) origin: Vec3,
    pub(crate) x: Vec3,
    pub(crate) y: Vec3,
    pub(crate) normal_x: Vec3,
}

/// A mesh under construction.
#[derive(Clone, Default)]
pub(crate) struct Builder {
    vertices: Vec<Vertex>,
    indices: Vec<u32>,
}

impl Builder {
    /// The finished mesh.
    pub(crate) fn mesh(self, name: &str, material: u32) -> Mesh {
        let bounds = Aabb::from_points(self.vertices.iter().map(|v| Vec3::from(v.position)));
        Mesh {
            name: name.into(),
            vertices: self.vertices,
            indices: self.indices,
            colors: Vec::new(),
            material,
            bounds,
        }
    }

    fn vertex(&mut self, position: Vec3, normal: Vec3, along_u: Vec3, uv: Vec2) {
        let normal = normal.normalize_or(Vec3::Y);
        let tangent = (along_u - normal * normal.dot(along_u))
            .try_normalize()
            .unwrap_or_else(|| normal.any_orthonormal_vector());
        self.vertices.push(Vertex {
            position: position.to_array(),
            normal: normal.to_array(),
            tangent: tangent.extend(1.0).to_array(),
            uv: uv.to_array(),
        });
    }

    /// Adds a triangle, wound to agree with its vertices' normals. Adds nothing if it has no area.
    fn triangle(&mut self, corners: [u32; 3]) {
        let [a, b, c] = corners.map(|ix| self.vertices[ix as usize]);
        let position = |v: Vertex| Vec3::from(v.position);
        let face = (position(b) - position(a)).cross(position(c) - position(a));
        if face.length_squared() < 1e-16 {
            return;
        }
        let normal = Vec3::from(a.normal) + Vec3::from(b.normal) + Vec3::from(c.normal);
        let [a, b, c] = corners;
        self.indices.extend(if face.dot(normal) < 0.0 { [a, c, b] } else { [a, b, c] });
    }

    /// Joins two rows of `count` vertices that start at `first` and `second`.
    fn strip(&mut self, first: u32, second: u32, count: u32) {
        for i in 0..count - 1 {
            self.triangle([first + i, first + i + 1, second + i + 1]);
            self.triangle([first + i, second + i + 1, second + i]);
        }
    }

    /// Adds a surface over the unit square, `columns` by `rows` quads, facing `du x dv`. uv is in
    /// metres, measured along the middle lines.
    pub(crate) fn surface(&mut self, columns: u32, rows: u32, at: impl Fn(f32, f32) -> Vec3) {
        const H: f32 = 1e-3;
        let length = |along_u: bool| {
            let point = |i: u32| {
                let t = i as f32 / 16.0;
                if along_u { at(t, 0.5) } else { at(0.5, t) }
            };
            (0..16).map(|i| point(i).distance(point(i + 1))).sum::<f32>()
        };
        let size = Vec2::new(length(true), length(false));
        let first = self.vertices.len() as u32;
        for row in 0..=rows {
            for column in 0..=columns {
                let (u, v) = (column as f32 / columns as f32, row as f32 / rows as f32);
                let du = at(u + H, v) - at(u - H, v);
                let dv = at(u, v + H) - at(u, v - H);
                self.vertex(at(u, v), du.cross(dv), du, Vec2::new(u, 1.0 - v) * size);
            }
        }
        let width = columns + 1;
        for row in 0..rows {
            self.strip(first + row * width, first + (row + 1) * width, width);
        }
    }

    /// Sweeps a profile along frames. The outside is on the profile's right: for a profile that
    /// goes up, the outside is `+a`. A repeated point makes a sharp edge; other corners are smooth.
    pub(crate) fn sweep(&mut self, frames: &[Frame], profile: &[Vec2]) {
        let mut length_v = 0.0;
        for run in profile.chunk_by(|a, b| a != b) {
            if run.len() < 2 {
                continue;
            }
            self.sweep_run(frames, run, &mut length_v);
        }
    }

    fn sweep_run(&mut self, frames: &[Frame], run: &[Vec2], length_v: &mut f32) {
        let side = |i: usize| (run[i + 1] - run[i]).normalize_or_zero();
        let place = |f: &Frame, p: Vec2| f.origin + f.x * p.x + f.y * p.y;
        let middle = run[run.len() / 2];
        let mut rows = Vec::new();
        for (i, point) in run.iter().enumerate() {
            let before = if i > 0 { side(i - 1) } else { Vec2::ZERO };
            let after = if i + 1 < run.len() { side(i) } else { Vec2::ZERO };
            let along = (before + after).normalize_or_zero();
            if i > 0 {
                *length_v += point.distance(run[i - 1]);
            }
            rows.push(self.vertices.len() as u32);
            let mut length_u = 0.0;
            for (k, frame) in frames.iter().enumerate() {
                let last = place(&frames[k.saturating_sub(1)], middle);
                let next = place(&frames[(k + 1).min(frames.len() - 1)], middle);
                length_u += last.distance(place(frame, middle));
                let normal = frame.normal_x * along.y - frame.y * along.x;
                let uv = Vec2::new(length_u, -*length_v);
                self.vertex(place(frame, *point), normal, next - last, uv);
            }
        }
        for pair in rows.windows(2) {
            self.strip(pair[0], pair[1], frames.len() as u32);
        }
    }

    /// Adds a solid of revolution about +Y. The profile is (radius, height), going up.
    pub(crate) fn lathe(&mut self, center: Vec3, segments: u32, profile: &[Vec2]) {
        let frames: Vec<_> = (0..=segments)
            .map(|i| {
                let (sin, cos) = (TAU * (i % segments) as f32 / segments as f32).sin_cos();
                let x = Vec3::new(cos, 0.0, -sin);
                Frame { origin: center, x, y: Vec3::Y, normal_x: x }
            })
            .collect();
        self.sweep(&frames, profile);
    }

    /// Adds a straight moulding from `from` to `to`. The profile's `a` points towards `out`.
    /// `mitre` shifts the ends along the run by that many metres per metre of `a`.
    pub(crate) fn moulding(
        &mut self,
        from: Vec3,
        to: Vec3,
        out: Vec3,
        mitre: f32,
        profile: &[Vec2],
    ) {
        let along = (to - from).normalize_or(Vec3::X);
        let frame = |origin: Vec3, shift: f32| Frame {
            origin,
            x: out + along * shift,
            y: Vec3::Y,
            normal_x: out,
        };
        self.sweep(&[frame(from, -mitre), frame(to, mitre)], profile);
    }

    /// Adds a copy of another mesh, moved and turned but not scaled.
    pub(crate) fn append(&mut self, other: &Self, rigid: &Mat4) {
        let first = self.vertices.len() as u32;
        let turned = |v: [f32; 3]| rigid.transform_vector3(v.into());
        self.vertices.extend(other.vertices.iter().map(|vertex| {
            let [x, y, z, w] = vertex.tangent;
            Vertex {
                position: rigid.transform_point3(vertex.position.into()).to_array(),
                normal: turned(vertex.normal).normalize_or(Vec3::Y).to_array(),
                tangent: turned([x, y, z]).normalize_or(Vec3::X).extend(w).to_array(),
                uv: vertex.uv,
            }
        }));
        self.indices.extend(other.indices.iter().map(|ix| first + ix));
    }

    /// Adds a flat quad with a given normal: `corner` and two edges. The face is on the side of `u
    /// x v`, which must be the normal's side.
    pub(crate) fn card(&mut self, corner: Vec3, u: Vec3, v: Vec3, normal: Vec3) {
        let first = self.vertices.len() as u32;
        for (p, uv) in [
            (corner, Vec2::ZERO),
            (corner + u, Vec2::X),
            (corner + v, Vec2::Y),
            (corner + u + v, Vec2::ONE),
        ] {
            self.vertex(p, normal, u, uv);
        }
        self.strip(first, first + 2, 2);
    }

    /// Adds a triangle that faces the side from which it is counter-clockwise.
    pub(crate) fn gable(&mut self, corners: [Vec3; 3]) {
        let first = self.vertices.len() as u32;
        let [a, b, c] = corners;
        let along = (b - a).normalize_or(Vec3::X);
        let normal = along.cross(c - a).normalize_or(Vec3::Y);
        let up = normal.cross(along);
        for p in corners {
            self.vertex(p, normal, along, Vec2::new(p.dot(along), -p.dot(up)));
        }
        self.triangle([first, first + 1, first + 2]);
    }

    /// Adds a flat quad: `corner` and two edges. The face is on the side of `u x v`.
    pub(crate) fn quad(&mut self, corner: Vec3, u: Vec3, v: Vec3) {
        let first = self.vertices.len() as u32;
        let normal = u.cross(v);
        // uv comes from world positions, so the pattern continues from one quad to the next.
        let (unit_u, unit_v) = (u.normalize_or_zero(), v.normalize_or_zero());
        for p in [corner, corner + u, corner + v, corner + u + v] {
            self.vertex(p, normal, u, Vec2::new(p.dot(unit_u), -p.dot(unit_v)));
        }
        self.strip(first, first + 2, 2);
    }

    /// Adds a box between two corners.
    pub(crate) fn block(&mut self, min: Vec3, max: Vec3) {
        let d = max - min;
        let (x, y, z) = (Vec3::X * d.x, Vec3::Y * d.y, Vec3::Z * d.z);
        self.quad(min + z, x, y);
        self.quad(min + x, -x, y);
        self.quad(min + x + z, -z, y);
        self.quad(min, z, y);
        self.quad(min + y + z, x, -z);
        self.quad(min, x, z);
    }

    /// Adds a box, given the middle of its lower face and its size.
    pub(crate) fn block_on(&mut self, foot: Vec3, size: Vec3) {
        let half = Vec3::new(0.5 * size.x, 0.0, 0.5 * size.z);
        self.block(foot - half, foot + half + Vec3::Y * size.y);
    }
}

/// Points of a circular arc in a profile, from angle to angle in degrees.
pub(crate) fn arc(center: [f32; 2], radius: [f32; 2], from: f32, to: f32, steps: u32) -> Vec<Vec2> {
    let point = |i: u32| {
        let angle = (from + (to - from) * i as f32 / steps as f32).to_radians();
        Vec2::from(center) + Vec2::from(radius) * Vec2::new(angle.cos(), angle.sin())
    };
    (0..=steps).map(point).collect()
}

/// A polygon as a profile with sharp corners: inner points are doubled.
pub(crate) fn sharp(points: &[[f32; 2]]) -> Vec<Vec2> {
    let last = points.len() - 1;
    let twice = |(i, p): (usize, &[f32; 2])| {
        let count = if i == 0 || i == last { 1 } else { 2 };
        std::iter::repeat_n(Vec2::from(*p), count)
    };
    points.iter().enumerate().flat_map(twice).collect()
}
