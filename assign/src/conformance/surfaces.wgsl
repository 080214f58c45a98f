// Draws the surfaces that the CPU traced: depth, shading normal and a roughness of every texel.

// Shading normal in world space and clip depth; a negative depth is background.
@group(0) @binding(0) var<storage, read> texels: array<vec4f>;
// Width of the target, pixels.
@group(0) @binding(1) var<uniform> width: u32;

struct Surface {
  @location(0) normal_world: vec4f,
  @builtin(frag_depth) depth_clip: f32,
}

@vertex
fn cover(@builtin(vertex_index) corner: u32) -> @builtin(position) vec4f {
  let x = f32(corner & 1u) * 4.0 - 1.0;
  let y = f32(corner >> 1u) * 4.0 - 1.0;
  return vec4f(x, y, 0.5, 1.0);
}

@fragment
fn draw(@builtin(position) position: vec4f) -> Surface {
  let texel = texels[u32(position.x) + u32(position.y) * width];
  if texel.w < 0.0 {
    discard;
  }
  return Surface(vec4f(texel.xyz, 0.5), texel.w);
}
