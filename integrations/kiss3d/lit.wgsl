struct Camera { world_to_clip: mat4x4f, light_count: u32 }
struct Object { to_world: mat4x4f, normal_to_world: mat4x4f, color: vec4f }
@group(0) @binding(0) var<uniform> camera: Camera;
@group(1) @binding(0) var<uniform> object: Object;

struct Vertex {
  @builtin(position) @invariant position: vec4f,
  @location(0) position_world: vec3f,
  @location(1) normal: vec3f,
}

@vertex
fn vertex(@location(0) position: vec3f, @location(1) normal: vec3f) -> Vertex {
  let position_world = object.to_world * vec4f(position, 1.0);
  let normal_world = object.normal_to_world * vec4f(normal, 0.0);
  return Vertex(camera.world_to_clip * position_world, position_world.xyz, normal_world.xyz);
}

// What one light adds, with kiss3d's own attenuation, which ends at the light's radius.
fn light_at(light: u32, position: vec3f, normal: vec3f) -> vec3f {
  let sphere = lb_light_spheres[light];
  let to_light = sphere.position_world - position;
  let distance = length(to_light);
  let share = min(distance / sphere.radius_m, 1.0);
  let attenuation = 1.0 - share * share;
  let cosine = max(dot(normal, to_light) / max(distance, 1e-4), 0.0);
  return lb_light_emissions[light].intensity * (cosine * attenuation * attenuation);
}

@fragment
fn listed_lights(in: Vertex) -> @location(0) vec4f {
  let normal = normalize(in.normal);
  var sum = vec3f(0.02);
  var cursor = lb_open_lights(lb_sample_at(in.position.xy, in.position.z, normal, 0u));
  while lb_next_light(&cursor) {
    sum += light_at(cursor.entry & lb_ENTRY_LIGHT, in.position_world, normal);
  }
  return vec4f(object.color.rgb * sum, 1.0);
}

// The loop that the image is compared with.
@fragment
fn all_lights(in: Vertex) -> @location(0) vec4f {
  let normal = normalize(in.normal);
  var sum = vec3f(0.02);
  for (var light = 0u; light < camera.light_count; light++) {
    sum += light_at(light, in.position_world, normal);
  }
  return vec4f(object.color.rgb * sum, 1.0);
}
