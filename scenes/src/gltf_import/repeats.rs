//! Removes triangles that never show: those without area, and those that repeat an earlier one
//! exactly.
//!
//! A few bytes of a file can stand for hundreds of thousands of them. They cost time in every pass
//! over triangles and in every hierarchy. A mesh with only a few of them stays as it is.

use std::{
    collections::HashMap,
    hash::{DefaultHasher, Hash, Hasher},
};

use bytemuck::bytes_of;
use glam::{DVec3, Vec3};

use super::Warnings;
use crate::Mesh;

/// A mesh keeps up to this many of each kind.
const MOST: usize = 4096;

/// Removes both kinds where there are many. Skinned meshes must not be passed in, because a skin
/// moves vertices of the same place apart.
pub(super) fn drop_repeats(mesh: &mut Mesh, warnings: &mut Warnings) {
    if mesh.triangle_count() <= MOST {
        return;
    }
    drop_where(
        mesh,
        "have no area",
        |mesh, ix| {
            let corners =
                corners(mesh, ix).map(|v| Vec3::from(mesh.vertices[v].position).as_dvec3());
            (corners[1] - corners[0]).cross(corners[2] - corners[0]) == DVec3::ZERO
        },
        warnings,
    );
    let mut firsts = HashMap::new();
    drop_where(
        mesh,
        "repeat another triangle",
        |mesh, ix| {
            let vertices = |ix: usize| corners(mesh, ix).map(|v| mesh.vertices[v]);
            let colors = |ix: usize| corners(mesh, ix).map(|v| mesh.colors.get(v).copied());
            let mut hasher = DefaultHasher::new();
            vertices(ix).iter().for_each(|v| bytes_of(v).hash(&mut hasher));
            let first = *firsts.entry(hasher.finish()).or_insert(ix);
            first != ix && vertices(first) == vertices(ix) && colors(first) == colors(ix)
        },
        warnings,
    );
}

fn corners(mesh: &Mesh, triangle: usize) -> [usize; 3] {
    [0, 1, 2].map(|corner| mesh.indices[3 * triangle + corner] as usize)
}

fn drop_where(
    mesh: &mut Mesh,
    what: &str,
    mut is_dropped: impl FnMut(&Mesh, usize) -> bool,
    warnings: &mut Warnings,
) {
    let dropped: Vec<bool> = (0..mesh.triangle_count()).map(|ix| is_dropped(mesh, ix)).collect();
    let count = dropped.iter().filter(|dropped| **dropped).count();
    if count <= MOST {
        return;
    }
    warnings.add(format!(
        "mesh {:?}: {count} of {} triangles {what} and are left out",
        mesh.name,
        dropped.len()
    ));
    let mut corner = 0;
    mesh.indices.retain(|_| {
        corner += 1;
        !dropped[(corner - 1) / 3]
    });
}
