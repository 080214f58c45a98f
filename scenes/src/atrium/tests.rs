use std::time::Instant;

use super::*;
use crate::{Vertex, bvh::TriangleBvh};

#[test]
fn it_is_built_fast_and_has_enough_triangles() {
    let start = Instant::now();
    let scene = atrium(1);
    let seconds = start.elapsed().as_secs_f64();
    // It takes a second on an idle machine; tests run in parallel.
    assert!(seconds < 3.0, "{seconds} s");
    let triangles = scene.triangle_count();
    assert!((200_000..600_000).contains(&triangles), "{triangles} triangles");
    assert!(scene.models.len() > 200, "{} models", scene.models.len());
}

#[test]
fn the_seed_decides_everything() {
    let hash = atrium(1).hash();
    assert_eq!(hash, atrium(1).hash());
    assert_ne!(hash, atrium(2).hash());
}

#[test]
fn normals_and_tangents_are_unit_and_perpendicular() {
    for mesh in atrium(1).meshes {
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
    for mesh in atrium(1).meshes {
        for corners in mesh.indices.chunks_exact(3) {
            let [a, b, c] = [0, 1, 2].map(|i| mesh.vertices[corners[i] as usize]);
            let position = |v: Vertex| Vec3::from(v.position);
            let face = (position(b) - position(a)).cross(position(c) - position(a));
            let normal = Vec3::from(a.normal) + Vec3::from(b.normal) + Vec3::from(c.normal);
            assert!(face.dot(normal) >= 0.0, "{}: {a:?} {b:?} {c:?}", mesh.name);
        }
    }
}

/// Closed solids face outwards: along the path, no ray first meets the back of a single-sided
/// triangle.
#[test]
fn the_camera_keeps_clear_and_sees_no_back_faces() {
    let scene = atrium(1);
    let bvh = TriangleBvh::new(&scene, scene.bounds);
    let (mut rays, mut backs) = (0, 0);
    for frame in 0..1200 {
        let eye = scene.path.pose(frame, 1200).eye;
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
    // The cloths are double-sided sheets and fill part of the view.
    assert!(backs * 50 < rays, "{backs} of {rays}");
}

#[test]
fn the_first_frame_looks_across_the_court() {
    let scene = atrium(1);
    let pose = scene.path.pose(0, 1200);
    let bvh = TriangleBvh::new(&scene, scene.bounds);
    let hit = bvh.cast(pose.eye, pose.forward(), 100.0).expect("walls enclose the court");
    assert!(hit.distance_m > 8.0, "{} m", hit.distance_m);
}
