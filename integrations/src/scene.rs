//! What renderers draw: surfaces, lights and cameras.

use assign::{Light, View};
use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3};

/// A corner of a triangle.
#[repr(C)]
#[derive(Clone, Copy, Pod, Zeroable)]
pub struct Vertex {
    /// World space, metres.
    pub position: Vec3,
    /// Unit normal, world space.
    pub normal: Vec3,
    /// Colour and opacity.
    pub color: [f32; 4],
}

impl Vertex {
    /// Its attributes in the order of the fields, at locations 0 to 2.
    pub const LAYOUT: wgpu::VertexBufferLayout<'static> = wgpu::VertexBufferLayout {
        array_stride: size_of::<Self>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes: &wgpu::vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Float32x4],
    };
}

/// A parallelogram of two triangles.
fn quad(corner: Vec3, u: Vec3, v: Vec3, color: [f32; 4]) -> [Vertex; 6] {
    let normal = u.cross(v).normalize();
    [corner, corner + u, corner + v, corner + v, corner + u, corner + u + v]
        .map(|position| Vertex { position, normal, color })
}

/// A floor with pillars, then panes of glass before them; and the number of opaque vertices, which come first.
pub fn scene() -> (Vec<Vertex>, u32) {
    let (x, y, z) = (Vec3::X, Vec3::Y, Vec3::Z);
    let mut opaque =
        quad(Vec3::new(-12.0, 0.0, 12.0), 24.0 * x, -24.0 * z, [0.7, 0.7, 0.7, 1.0]).to_vec();
    let mut glass = Vec::new();
    for i in 0..16 {
        let at = Vec3::new((i % 4) as f32 * 5.0 - 8.0, 0.0, (i / 4) as f32 * 5.0 - 8.0);
        let color = [0.9, 0.5 + 0.1 * (i % 4) as f32, 0.4, 1.0];
        let up = (1.5 + 0.5 * (i % 3) as f32) * y;
        for (corner, side) in [(at, x), (at + x, z), (at + x + z, -x), (at + z, -z)] {
            opaque.extend(quad(corner, side, up, color));
        }
        opaque.extend(quad(at + up, x, z, color));
        glass.extend(quad(
            at + Vec3::new(-0.5, 0.0, 2.0),
            2.0 * x + 0.3 * z,
            2.0 * y,
            [0.4, 0.7, 0.9, 0.4],
        ));
    }
    let opaque_vertices = opaque.len() as u32;
    opaque.extend(glass);
    (opaque, opaque_vertices)
}

/// Lights that wander over the floor. `time` is in seconds.
pub fn lights_at(time: f32, count: u32) -> Vec<Light> {
    let light = |i: u32| {
        let phase = i as f32 * 2.399_963;
        let radius = 12.0 * ((i as f32 + 0.5) / count as f32).sqrt();
        let height = 0.4 + 0.3 * (1.0 + (phase + time).sin());
        let angle = phase + 0.3 * time;
        let position = Vec3::new(radius * angle.cos(), height, radius * angle.sin());
        let hue = Vec3::new(phase.sin(), (phase + 2.0).sin(), (phase + 4.0).sin());
        Light::point(position, 1.5 + (i % 3) as f32, 0.25 * (hue + 1.2))
    };
    (0..count).map(light).collect()
}

/// What a camera shows.
#[derive(Clone, Copy, Debug)]
pub struct Shot {
    /// World to clip space, with which the renderer draws.
    pub world_to_clip: Mat4,
    /// The same camera for light assignment.
    pub view: View,
}

impl From<View> for Shot {
    /// The renderer draws with the view's own matrix.
    fn from(view: View) -> Self {
        Self { world_to_clip: view.world_to_clip(), view }
    }
}

/// Two cameras: the left and the right half of an image.
pub fn split_screen(size: [u32; 2]) -> [Shot; 2] {
    let half = [size[0] / 2, size[1]];
    let look = |eye| View::look_at(eye, Vec3::new(0.0, 0.5, 0.0), 0.9, 0.1, half);
    let mut right = look(Vec3::new(-3.0, 7.0, 12.0));
    right.viewport.x = half[0];
    [look(Vec3::new(9.0, 3.0, 11.0)), right].map(Shot::from)
}
