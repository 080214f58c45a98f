//! The joints that move a vertex of a skinned mesh.

/// The joints that move one vertex, and their weights. The weights sum to 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Influence {
    pub(super) joints: [u32; 4],
    pub(super) weights: [f32; 4],
}

impl Influence {
    /// The influence that JOINTS_0 and WEIGHTS_0 describe. Without a usable weight, the vertex
    /// follows its first joint.
    pub(super) fn new(joints: [f32; 4], weights: [f32; 4]) -> Self {
        let sum: f32 = weights.iter().sum();
        let is_sound = sum > 0.0 && sum.is_finite();
        let weights = if is_sound { weights.map(|w| w / sum) } else { [1.0, 0.0, 0.0, 0.0] };
        Self { joints: joints.map(|joint| joint as u32), weights }
    }
}
