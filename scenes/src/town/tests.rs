use std::time::Instant;

use super::*;
use crate::{Vertex, bvh::TriangleBvh};
use glam::Vec3;

const SMALL: TownSize = TownSize::Small;

#[test]
fn it_is_built_fast_from_few_meshes_and_draws_many() {
    let start = Instant::now();
    let scene = town(1, TownSize::Full);
    let seconds = start.elapsed().as_secs_f64();
    let triangles = scene.triangle_count();
    let bytes: usize =
        scene.meshes.iter().map(|m| 48 * m.vertices.len() + 4 * m.indices.len()).sum();
    // It takes a second on an idle machine; tests run in parallel.
    assert!(seconds < 4.0, "{seconds} s");
    assert!((6_500_000..7_500_000).contains(&triangles), "{triangles} triangles");
    assert!(bytes < 60_000_000, "{bytes} bytes");
    let small = town(1, SMALL).triangle_count();
    assert!((40_000..100_000).contains(&small), "{small} triangles");
}

#[test]
fn the_seed_decides_everything() {
    let hash = town(1, SMALL).hash();
    assert_eq!(hash, town(1, SMALL).hash());
    assert_ne!(hash, town(2, SMALL).hash());
}

#[test]
fn bounds_are_finite_and_contain_every_triangle() {
    let scene = town(1, SMALL);
    assert!(scene.bounds.min.is_finite() && scene.bounds.max.is_finite());
    let held = scene.bounds.grown(1e-3);
    for corner in scene.world_triangles().flatten() {
        assert!(held.contains(corner), "{corner}");
    }
}

#[test]
fn normals_and_tangents_are_unit_and_perpendicular() {
    for mesh in [SMALL, TownSize::Full].into_iter().flat_map(|size| town(1, size).meshes) {
        for vertex in &mesh.vertices {
            let normal = Vec3::from(vertex.normal);
            let tangent = Vec3::from_slice(&vertex.tangent[..3]);
            let ok = Vec3::from(vertex.position).is_finite()
                && vertex.uv.iter().all(|x| x.is_finite())
                && (normal.length() - 1.0).abs() < 1e-4
                && (tangent.length() - 1.0).abs() < 1e-4
                && normal.dot(tangent).abs() < 1e-3
                && vertex.tangent[3].abs() == 1.0;
            assert!(ok, "{}: {vertex:?}", mesh.name);
        }
    }
}

#[test]
fn winding_agrees_with_normals() {
    for mesh in town(1, TownSize::Full).meshes {
        for corners in mesh.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|i| mesh.vertices[corners[i] as usize]);
            let position = |v: Vertex| Vec3::from(v.position);
            let face = (position(b) - position(a)).cross(position(c) - position(a));
            let normal = Vec3::from(a.normal) + Vec3::from(b.normal) + Vec3::from(c.normal);
            assert!(face.dot(normal) >= 0.0, "{}: {a:?} {b:?} {c:?}", mesh.name);
        }
    }
}

/// Closed solids face outwards: along the path, hardly any ray first meets the back of a
/// single-sided triangle.
#[test]
fn the_camera_keeps_clear_and_sees_no_back_faces() {
    let scene = town(1, SMALL);
    let bvh = TriangleBvh::new(&scene, scene.bounds);
    let (mut rays, mut backs) = (0, 0);
    for frame in 0..600 {
        let eye = scene.path.pose(frame, 600).eye;
        let clear = bvh.clearance(eye, 0.5);
        assert!(clear >= 0.3, "frame {frame}: {clear} m at {eye}");
        if frame % 20 == 0 {
            for i in 0..400 {
                let y = 1.0 - (i as f32 + 0.5) / 200.0;
                let (sin, cos) = (i as f32 * 2.399_963).sin_cos();
                let around = Vec3::new(cos, 0.0, sin) * (1.0 - y * y).sqrt();
                if let Some(hit) = bvh.cast(eye, around + Vec3::Y * y, 100.0) {
                    rays += 1;
                    backs += usize::from(hit.is_back);
                }
            }
        }
    }
    // Leaves are double-sided sheets.
    assert!(backs * 40 < rays, "{backs} of {rays}");
}

/// Surfaces up to 120 m away fill the first frame's picture, not sky or a near wall.
#[test]
fn the_first_frame_looks_down_a_street() {
    for size in [SMALL, TownSize::Full] {
        let scene = town(1, size);
        let pose = scene.path.pose(0, 1200);
        let bvh = TriangleBvh::new(&scene, scene.bounds);
        let hit = bvh.cast(pose.eye, pose.forward(), 300.0).expect("the street rises");
        assert!(hit.distance_m > 20.0, "{size:?}: {} m", hit.distance_m);
        let to_world = pose.world_to_view().inverse();
        let seen = (0..20 * 12).filter(|ix| {
            let share = Vec3::new((ix % 20) as f32 / 19.0, (ix / 20) as f32 / 11.0, 0.0);
            // A picture 60 degrees high, 16 to 9.
            let ray = Vec3::new(2.05 * share.x - 1.025, 1.154 * share.y - 0.577, -1.0).normalize();
            let hit = bvh.cast(pose.eye, to_world.transform_vector3(ray), 120.0);
            hit.is_some_and(|hit| hit.distance_m > 3.0)
        });
        let seen = seen.count();
        assert!(seen * 4 > 20 * 12 * 3, "{size:?}: {seen} of 240 rays");
    }
}
