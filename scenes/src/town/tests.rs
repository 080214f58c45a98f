use std::time::Instant;

use super::*;
use crate::{Vertex, bvh::TriangleBvh};
use glam::Vec3;

const SMALL: TownSize = TownSize::Small;

#[test]
fn it_is_made_quickly_of_little_and_draws_much() {
    let start = Instant::now();
    let scene = town(1, TownSize::Full);
    let seconds = start.elapsed().as_secs_f64();
    let triangles = scene.triangle_count();
    let bytes: usize =
        scene.meshes.iter().map(|m| 48 * m.vertices.len() + 4 * m.indices.len()).sum();
