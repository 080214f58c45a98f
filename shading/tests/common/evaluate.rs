//! The shaders' lighting function, light by light.

use assign::{
    Frame, FrameBindings, Gpu, LightBuffer,
    conformance::{Bound, download, run_kernel, upload},
    kernel::Slot,
};
use shading::AreaModel;

/// One evaluation: position and light, eye direction and roughness, normal and metallic, colour and
/// the weight at or under which the light is left out.
pub(crate) type Query = [[f32; 4]; 4];

const EVALUATE: &str = "
import package::brdf::{Surface, see};
import package::lighting::light_contribution;
import package::lists::ALL_TERMS;

@group(2) @binding(0) var<storage, read> queries: array<array<vec4f, 4>>;
@group(2) @binding(1) var<storage, read_write> answers: array<vec4f>;

@compute @workgroup_size(64)
fn evaluate(@builtin(global_invocation_id) thread: vec3u) {
  if thread.x >= arrayLength(&queries) {
    return;
  }
  let query = queries[thread.x];
  let surface = Surface(query[3].xyz, query[2].w, query[2].xyz, query[1].w);
  let light = bitcast<u32>(query[0].w);
  let seen = see(surface, query[1].xyz);
  answers[thread.x] = vec4f(light_contribution(light, ALL_TERMS, query[0].xyz, seen, query[3].w), 1.0);
}
";

/// Evaluates the queries on the GPU.
pub(crate) fn evaluate(
    gpu: &Gpu,
    lights: &LightBuffer,
    queries: &[Query],
    area: AreaModel,
) -> Vec<[f32; 4]> {
    evaluate_far(gpu, lights, queries, area, None)
}

/// The same with points for area lights that look smaller than a solid angle.
pub(crate) fn evaluate_far(
    gpu: &Gpu,
    lights: &LightBuffer,
    queries: &[Query],
    area: AreaModel,
    area_lod: Option<f32>,
) -> Vec<[f32; 4]> {
    let view = super::view([8, 8]);
    let mut bindings = FrameBindings::new(gpu);
    bindings.update(gpu, &Frame::new(&view, lights)).unwrap();
    let asked = upload(gpu, "queries", queries).unwrap();
    let answered = upload(gpu, "answers", &vec![[0.0_f32; 4]; queries.len()]).unwrap();
    let lod = area_lod.unwrap_or(0.0).to_bits();
    let numbers = upload(gpu, "lighting", &[0, area.samples(), 0, 0, 0, lod, 0, 0]).unwrap();
    let table = shading::ltc::Table::load(area.table().unwrap_or_default()).unwrap();
    let looked_up = upload(gpu, "table", table.as_bytes()).unwrap();
    let shader = shading::lighting_shader()
        .module("package::evaluate", EVALUATE)
        .module("package::strategy", include_str!("../../../assign/src/shaders/everything.wesl"))
        .light_kinds(lights.kinds())
        .flag("area_lod", area_lod.is_some());
    let flags = area.flags().iter();
    let shader = flags.fold(shader, |shader, flag| shader.flag(flag, lights.kinds().areas));
    let module = shader.create(gpu, "package::evaluate").unwrap();
    let groups = [
        Bound::Group(bindings.layout(), bindings.bind_group().unwrap()),
        Bound::Nothing,
        Bound::Buffers(&[
            (0, Slot::Read, &asked),
            (1, Slot::Write, &answered),
            (6, Slot::Uniform, &numbers),
            (7, Slot::Read, &looked_up),
        ]),
    ];
    run_kernel(gpu, &module, "evaluate", &groups, (queries.len() as u32).div_ceil(64));
    download(gpu, &answered, queries.len()).unwrap()
}
