//! Animated nodes: the transforms of the nodes from the root to a camera or light, evaluated exactly
//! at any time.

use glam::{DMat4, DVec3, Mat4, Quat, Vec3, Vec4, Vec4Swizzles};
use gltf::json::{animation::Interpolation, scene::Node};

use crate::Pose;

/// A camera that is animated, or below a node that is animated.
#[derive(Clone, Debug)]
pub(crate) struct AnimatedNode {
    /// The nodes from the root to the camera.
    pub(crate) chain: Vec<Part>,
    /// The origin of world space, in the file's coordinates.
    pub(crate) origin: DVec3,
    pub(crate) start_s: f32,
    pub(crate) end_s: f32,
}

#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub(crate) local: Local,
    pub(crate) translation: Option<Track>,
    pub(crate) rotation: Option<Track>,
    pub(crate) scale: Option<Track>,
}

#[derive(Clone, Debug)]
pub(crate) struct Track {
    /// Strictly increasing, seconds.
    pub(crate) times: Vec<f32>,
    /// One per key, three for cubic splines: in-tangent, value, out-tangent.
    pub(crate) values: Vec<Vec4>,
    pub(crate) interpolation: Interpolation,
    pub(crate) is_rotation: bool,
}

/// Where a node is, in f64. `gltf_import::walk` places nodes at rest in the same way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Placement {
    pub(crate) place: DMat4,
    /// The same with scales of 0 replaced by 1, because such a scale does not turn a camera or a
    /// light.
    pub(crate) facing: DMat4,
}

/// A node's local transform, before any animation.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Local {
    Matrix(Mat4),
    Parts { translation: Vec3, rotation: Quat, scale: Vec3 },
}

impl Local {
    pub(crate) fn from_node(node: &Node) -> Self {
        if let Some(matrix) = node.matrix {
            return Self::Matrix(Mat4::from_cols_array(&matrix));
        }
        let rotation = node.rotation.map_or(Quat::IDENTITY, |r| Quat::from_array(r.0));
        Self::Parts {
            translation: node.translation.map_or(Vec3::ZERO, Vec3::from),
            rotation: if rotation.length_squared() > 0.0 {
                rotation.normalize()
            } else {
                Quat::IDENTITY
            },
            scale: node.scale.map_or(Vec3::ONE, Vec3::from),
        }
    }

    pub(crate) fn matrix(&self) -> Mat4 {
        match *self {
            Self::Matrix(matrix) => matrix,
            Self::Parts { translation, rotation, scale } => {
                Mat4::from_scale_rotation_translation(scale, rotation, translation)
            }
        }
    }

    /// The matrix with axes of length 0 replaced, so that it still turns directions along them.
    pub(crate) fn facing(&self) -> Mat4 {
        match *self {
            Self::Matrix(matrix) => with_axes(matrix),
            Self::Parts { translation, rotation, scale } => {
                let scale = Vec3::select(scale.cmpeq(Vec3::ZERO), Vec3::ONE, scale);
                Mat4::from_scale_rotation_translation(scale, rotation, translation)
            }
        }
    }
}

/// A matrix whose axes of length 0 are replaced by axes perpendicular to the others.
fn with_axes(matrix: Mat4) -> Mat4 {
    let mut axes = [matrix.x_axis, matrix.y_axis, matrix.z_axis].map(Vec4::truncate);
    for ix in 0..3 {
        if axes[ix] != Vec3::ZERO {
            continue;
        }
        let (next, last) = (axes[(ix + 1) % 3], axes[(ix + 2) % 3]);
        let across = next.cross(last).try_normalize();
        let any = || {
            let other = if next == Vec3::ZERO { last } else { next };
            let unit = other.try_normalize().map(|axis| axis.any_orthonormal_vector());
            unit.unwrap_or(Vec3::AXES[ix])
        };
        axes[ix] = across.unwrap_or_else(any);
    }
    let [x, y, z] = axes.map(|axis| axis.extend(0.0));
    Mat4::from_cols(x, y, z, matrix.w_axis)
}

impl AnimatedNode {
    /// The pose at `t` (0..1) of the animation.
    pub(crate) fn pose(&self, t: f32) -> Pose {
        let time = self.start_s + (self.end_s - self.start_s) * t;
        let root = Placement::from_origin(self.origin);
        let parts = self.chain.iter();
        parts.fold(root, |placement, part| placement.below(&part.local(time))).pose()
    }
}

impl Placement {
    pub(crate) const IDENTITY: Self = Self { place: DMat4::IDENTITY, facing: DMat4::IDENTITY };

    /// The root of a file's nodes, in a world that begins at `origin` of the file.
    pub(crate) fn from_origin(origin: DVec3) -> Self {
        let root = DMat4::from_translation(-origin);
        Self { place: root, facing: root }
    }

    /// The placement of a node below.
    pub(crate) fn below(&self, local: &Local) -> Self {
        Self {
            place: self.place * local.matrix().as_dmat4(),
            facing: self.facing * local.facing().as_dmat4(),
        }
    }

    /// The placement after another one, which is relative to this one.
    pub(crate) fn then(&self, next: &Self) -> Self {
        Self { place: self.place * next.place, facing: self.facing * next.facing }
    }

    /// The pose of a camera or spot there.
    pub(crate) fn pose(&self) -> Pose {
        Pose::of_node(&DMat4 { w_axis: self.place.w_axis, ..self.facing })
    }
}

impl Part {
    /// The transform before any animation.
    pub(crate) fn still(&self) -> Mat4 {
        self.local.matrix()
    }

    /// The tracks of its translation, rotation and scale.
    pub(crate) fn tracks(&self) -> [Option<&Track>; 3] {
        [self.translation.as_ref(), self.rotation.as_ref(), self.scale.as_ref()]
    }

    /// The times of its first and last key, seconds.
    pub(crate) fn ends(&self) -> Option<(f32, f32)> {
        let ends = |t: &Track| (t.times[0], t.times[t.times.len() - 1]);
        let ends = self.tracks().into_iter().flatten().map(ends);
        ends.reduce(|all, one| (all.0.min(one.0), all.1.max(one.1)))
    }

    /// The transform at a time.
    pub(crate) fn local(&self, time: f32) -> Local {
        let sample = |track: &Option<Track>| track.as_ref().map(|t| t.sample(time));
        match self.local {
            Local::Matrix(_) => self.local,
            Local::Parts { translation, rotation, scale } => Local::Parts {
                translation: sample(&self.translation).map_or(translation, Vec4::xyz),
                rotation: sample(&self.rotation).map_or(rotation, quaternion),
                scale: sample(&self.scale).map_or(scale, Vec4::xyz),
            },
        }
    }
}

fn quaternion(v: Vec4) -> Quat {
    let unit = v.try_normalize().unwrap_or(Vec4::W);
    Quat::from_vec4(unit)
}

impl Track {
    /// The value at `time`, clamped to the first and last key.
    fn sample(&self, time: f32) -> Vec4 {
        let next = self.times.partition_point(|t| *t <= time);
        let last = self.times.len() - 1;
        if next == 0 || next > last {
            return self.value(if next == 0 { 0 } else { last });
        }
        let span_s = self.times[next] - self.times[next - 1];
        let t = (time - self.times[next - 1]) / span_s;
        let (from, to) = (self.value(next - 1), self.value(next));
        match self.interpolation {
            Interpolation::Step => from,
            Interpolation::Linear if self.is_rotation => {
                Vec4::from(quaternion(from).slerp(quaternion(to), t))
            }
            Interpolation::Linear => from.lerp(to, t),
            Interpolation::CubicSpline => {
                let out_tangent = self.values[(next - 1) * 3 + 2] * span_s;
                let in_tangent = self.values[next * 3] * span_s;
                hermite(from, out_tangent, to, in_tangent, t)
            }
        }
    }

    fn value(&self, key: usize) -> Vec4 {
        match self.interpolation {
            Interpolation::CubicSpline => self.values[key * 3 + 1],
            _ => self.values[key],
        }
    }
}

/// Cubic Hermite spline (glTF 2.0, appendix C.5).
fn hermite(from: Vec4, out_tangent: Vec4, to: Vec4, in_tangent: Vec4, t: f32) -> Vec4 {
    let (t2, t3) = (t * t, t * t * t);
    from * (2.0 * t3 - 3.0 * t2 + 1.0)
        + out_tangent * (t3 - 2.0 * t2 + t)
        + to * (3.0 * t2 - 2.0 * t3)
        + in_tangent * (t3 - t2)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn sample(interpolation: Interpolation, values: &[f32], time: f32) -> f32 {
        let track = Track {
            times: vec![1.0, 3.0],
            values: values.iter().map(|v| Vec4::splat(*v)).collect(),
            interpolation,
            is_rotation: false,
        };
        track.sample(time).x
    }

    #[test]
    fn tracks_interpolate_and_clamp() {
        assert_eq!(sample(Interpolation::Linear, &[2.0, 6.0], 2.0), 4.0);
        assert_eq!(sample(Interpolation::Linear, &[2.0, 6.0], 0.0), 2.0);
        assert_eq!(sample(Interpolation::Linear, &[2.0, 6.0], 9.0), 6.0);
        assert_eq!(sample(Interpolation::Step, &[2.0, 6.0], 2.9), 2.0);
        let flat = [0.0, 2.0, 0.0, 0.0, 6.0, 0.0];
        assert_eq!(sample(Interpolation::CubicSpline, &flat, 2.0), 4.0);
        // Tangents of 2 per second over two seconds make the cubic a straight line.
        let line = [2.0, 2.0, 2.0, 2.0, 6.0, 2.0];
        assert_eq!(sample(Interpolation::CubicSpline, &line, 1.5), 3.0);
    }
}
