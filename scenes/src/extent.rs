//! The extent of a scene: the box around everything, and the box without a far backdrop.

use glam::Vec3;

use crate::{Aabb, Instance, Scene};

/// The share of the triangles that is cut off at both ends of an axis with a backdrop.
const CORE_SHARE: f64 = 0.02;

/// An axis has a backdrop if the scene is this many times as long as its core.
const BACKDROP_RATIO: f32 = 3.0;

/// With fewer triangles than this, percentiles are not meaningful.
const CORE_TRIANGLES: usize = 1000;

/// Scenes of more triangles are measured by a sample of at most that many, evenly chosen.
pub(crate) const MAX_SAMPLES: u64 = 2_000_000;

/// The box around all triangles drawn.
pub(crate) fn bounds(scene: &Scene) -> Aabb {
    let place = |instance: &Instance| {
        let model = &scene.models[instance.model as usize];
        let mesh = &scene.meshes[instance.mesh as usize];
        mesh.bounds.transformed(&model.object_to_world)
    };
    scene.instances.iter().map(place).fold(Aabb::EMPTY, Aabb::union)
}

/// The box around the part that most triangles belong to. Along each axis it is the range of the
/// middle 96 % of the triangles' centroids, plus a margin. Where the whole extent is at most three
/// times as long as that range, it is the whole extent.
pub(crate) fn core_bounds(scene: &Scene) -> Aabb {
    let whole = scene.bounds;
    let sample = scene.sampled_triangles(MAX_SAMPLES);
    let centroids: Vec<Vec3> = sample.map(|[a, b, c]| (a + b + c) / 3.0).collect();
    if centroids.len() < CORE_TRIANGLES {
        return whole;
    }
    let mut core = whole;
    let cut = (centroids.len() as f64 * CORE_SHARE) as usize;
    for axis in 0..3 {
        let mut along: Vec<f32> = centroids.iter().map(|p| p[axis]).collect();
        let top = along.len() - 1 - cut;
        let (_, &mut min, _) = along.select_nth_unstable_by(cut, f32::total_cmp);
        let (_, &mut max, _) = along.select_nth_unstable_by(top, f32::total_cmp);
        if whole.size()[axis] > BACKDROP_RATIO * (max - min) && max > min {
            let margin = 0.05 * (max - min);
            core.min[axis] = (min - margin).max(whole.min[axis]);
            core.max[axis] = (max + margin).min(whole.max[axis]);
        }
    }
    core
}
