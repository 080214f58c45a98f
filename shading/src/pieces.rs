//! Parts of a scene's draws with boxes around them, so that a face of a shadow map draws only what it may show.
//!
//! A piece is a run of triangles of one instance. Neighbours in a mesh mostly lie close together, so the boxes are small.
//! Drawing all pieces draws every triangle once. The order does not matter, because only the nearest depth stays.

use glam::{Mat4, Vec3};
use scenes::Mesh;

use crate::draws::Draw;

/// Triangles of a piece.
const TRIANGLES: usize = 256;

/// Some triangles of one instance of a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Piece {
    /// The draw that it is a part of: an index.
    draw: u32,
    first_index: u32,
    index_count: u32,
    instance: u32,
    /// Lowest and highest corner of the box around it, world space.
    pub(crate) bounds: [Vec3; 2],
}

impl Piece {
    /// The pieces of an instance of a mesh, in order. `first_index` is the mesh's in the shared buffer.
    pub(crate) fn of_instance(
        draw: u32,
        mesh: &Mesh,
        first_index: u32,
        instance: u32,
        object_to_world: Mat4,
    ) -> impl Iterator<Item = Self> {
        mesh.indices.chunks(3 * TRIANGLES).zip(0..).map(move |(indices, chunk): (_, u32)| {
            let corners = indices.iter().map(|ix| {
                let position = Vec3::from(mesh.vertices[*ix as usize].position);
                object_to_world.transform_point3(position)
            });
            let empty = [Vec3::INFINITY, Vec3::NEG_INFINITY];
            let bounds = corners.fold(empty, |[low, high], at| [low.min(at), high.max(at)]);
            Self {
                draw,
                first_index: first_index + chunk * 3 * TRIANGLES as u32,
                index_count: indices.len() as u32,
                instance,
                bounds,
            }
        })
    }

    /// Whether `next` can be drawn by the same call as `drawn`, and that call. The triangles of one instance follow each
    /// other, or whole instances of a mesh do.
    fn join(drawn: Draw, next: Draw, whole: Draw) -> Option<Draw> {
        let index_count = drawn.index_count + next.index_count;
        let follows = drawn.instance_count == 1
            && next.first_instance == drawn.first_instance
            && next.first_index == drawn.first_index + drawn.index_count;
        if follows {
            return Some(Draw { index_count, ..drawn });
        }
        let is_whole = |draw: Draw| draw.index_count == whole.index_count;
        let is_next = next.first_instance == drawn.first_instance + drawn.instance_count;
        (is_whole(drawn) && is_whole(next) && is_next)
            .then_some(Draw { instance_count: drawn.instance_count + 1, ..drawn })
    }
}

/// The draws of all pieces that may be seen, neighbours joined.
pub(crate) fn seen_draws(
    draws: &[Draw],
    pieces: &[Piece],
    may_see: impl Fn([Vec3; 2]) -> bool,
) -> Vec<Draw> {
    let mut joined: Vec<(u32, Draw)> = Vec::new();
    for piece in pieces.iter().filter(|piece| may_see(piece.bounds)) {
        let whole = draws[piece.draw as usize];
        let next = Draw {
            first_index: piece.first_index,
            index_count: piece.index_count,
            first_instance: piece.instance,
            instance_count: 1,
            ..whole
        };
        let last = joined.last_mut().filter(|(draw, _)| *draw == piece.draw);
        match last.and_then(|(_, last)| Some((Piece::join(*last, next, whole)?, last))) {
            Some((both, last)) => *last = both,
            None => joined.push((piece.draw, next)),
        }
    }
    joined.into_iter().map(|(_, draw)| draw).collect()
}

#[cfg(test)]
mod tests {
    use scenes::{Aabb, Vertex};

    use super::*;
    use crate::{draws::DrawKey, materials::MaterialKey};

    /// A strip of triangles along x, one per metre.
    fn strip(triangles: u32) -> Mesh {
        let vertex = |ix: u32| Vertex {
            position: [ix as f32, (ix % 2) as f32, 0.0],
            normal: [0.0, 0.0, 1.0],
            tangent: [1.0, 0.0, 0.0, 1.0],
            uv: [0.0, 0.0],
        };
        Mesh {
            name: "strip".into(),
            vertices: (0..triangles + 2).map(vertex).collect(),
            indices: (0..triangles).flat_map(|ix| [ix, ix + 1, ix + 2]).collect(),
            colors: Vec::new(),
            material: 0,
            bounds: Aabb::new(Vec3::ZERO, Vec3::splat(triangles as f32 + 2.0)),
        }
    }

    fn draw(index_count: u32, instance_count: u32) -> Draw {
        Draw {
            key: DrawKey { material: MaterialKey::default(), mirrored: false },
            material: 0,
            first_index: 30,
            index_count,
            base_vertex: 0,
            first_instance: 4,
            instance_count,
            is_transparent: false,
        }
    }

    /// The triangles that draws draw, as instance and first index, sorted.
    fn triangles(draws: &[Draw]) -> Vec<(u32, u32)> {
        let of_draw = |draw: &Draw| {
            let draw = *draw;
            (draw.first_instance..draw.first_instance + draw.instance_count).flat_map(move |one| {
                (draw.first_index..draw.first_index + draw.index_count)
                    .step_by(3)
                    .map(move |ix| (one, ix))
            })
        };
        let mut all: Vec<(u32, u32)> = draws.iter().flat_map(of_draw).collect();
        all.sort_unstable();
        all
    }

    #[test]
    fn all_pieces_draw_every_triangle_once_in_as_few_draws_as_before() {
        for (count, instances) in [(1, 3), (256, 2), (700, 1), (700, 3)] {
            let mesh = strip(count);
            let whole = draw(3 * count, instances);
            let pieces: Vec<Piece> = (4..4 + instances)
                .flat_map(|instance| Piece::of_instance(0, &mesh, 30, instance, Mat4::IDENTITY))
                .collect();
            let all = seen_draws(&[whole], &pieces, |_| true);
            assert_eq!(triangles(&all), triangles(&[whole]), "{count} {instances}");
            let expected = if count <= 256 { 1 } else { instances as usize };
            assert_eq!(all.len(), expected, "{count} {instances}: {all:?}");
            assert!(seen_draws(&[whole], &pieces, |_| false).is_empty());
        }
    }

    #[test]
    fn a_part_of_a_mesh_is_drawn_alone() {
        let mesh = strip(700);
        let moved = Mat4::from_translation(Vec3::new(0.0, 5.0, 0.0));
        let pieces: Vec<Piece> = Piece::of_instance(0, &mesh, 30, 4, moved).collect();
        assert_eq!(pieces.len(), 3);
        assert_eq!(pieces[1].bounds, [Vec3::new(256.0, 5.0, 0.0), Vec3::new(513.0, 6.0, 0.0)]);
        let seen = seen_draws(&[draw(2100, 1)], &pieces, |[low, _]| low.x >= 256.0);
        let found: Vec<(u32, u32)> = seen.iter().map(|d| (d.first_index, d.index_count)).collect();
        assert_eq!(found, [(30 + 768, 2100 - 768)]);
    }
}
