//! Uploads all triangles of a scene in world space, in one buffer.

use assign::{AssignError, Gpu};
use bytemuck::cast_slice;
use glam::Vec3;
use scenes::Scene;

/// The number of triangles uploaded at once: 1.1 MiB.
const CHUNK: usize = 1 << 15;

/// Every triangle of the scene on the GPU, for passes that cast rays or voxelise.
#[derive(Debug)]
pub struct WorldTriangles {
    /// `array<f32>` with nine numbers per triangle: three corners, world space, metres,
    /// counter-clockwise seen from the front.
    pub positions: wgpu::Buffer,
    /// Number of triangles.
    pub count: u32,
    /// Smallest and largest corner of the box around them; zeros if there are none.
    pub bounds_world: (Vec3, Vec3),
}

impl WorldTriangles {
    /// Transforms and uploads every triangle, a chunk at a time.
    ///
    /// # Errors
    ///
    /// [`AssignError::TooLarge`] if the device binds no buffer of 36 bytes per triangle, or there
    /// are 2^32 triangles or more; [`AssignError::OutOfMemory`], [`AssignError::Device`].
    pub fn new(gpu: &Gpu, scene: &Scene) -> Result<Self, AssignError> {
        let total = scene.triangle_count();
        let count = u32::try_from(total).map_err(|_| AssignError::TooLarge {
            what: "world triangles".into(),
            bytes: total.saturating_mul(36),
            limit: gpu.max_storage_bytes(),
        })?;
        let positions = gpu.storage("world triangles", total * 36)?;
        let (mut low, mut high) = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let mut chunk: Vec<[Vec3; 3]> = Vec::with_capacity(CHUNK.min(total as usize));
        let mut offset = 0;
        let mut triangles = scene.world_triangles().peekable();
        while let Some(triangle) = triangles.next() {
            for corner in triangle {
                (low, high) = (low.min(corner), high.max(corner));
            }
            chunk.push(triangle);
            if chunk.len() == CHUNK || triangles.peek().is_none() {
                gpu.queue.write_buffer(&positions, offset, cast_slice(&chunk));
                offset += 36 * chunk.len() as u64;
                chunk.clear();
                // This frees the queue's copy before the next one.
                gpu.queue.submit([]);
                gpu.wait()?;
            }
        }
        let bounds_world = if count == 0 { (Vec3::ZERO, Vec3::ZERO) } else { (low, high) };
        Ok(Self { positions, count, bounds_world })
    }
}
