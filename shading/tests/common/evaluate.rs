//! The shaders' lighting function, light by light.

use assign::{
    EncoderPasses, Frame, FrameBindings, Gpu, LightBuffer, Passes, entry, storage_entry,
    uniform_entry,
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
    let view = super::view([8, 8]);
    let mut bindings = FrameBindings::new(gpu);
    bindings.update(gpu, &Frame::new(&view, lights)).unwrap();
    let asked = gpu.storage("queries", size_of_val(queries) as u64).unwrap();
    gpu.queue.write_buffer(&asked, 0, bytemuck::cast_slice(queries));
    let answered = gpu.storage("answers", queries.len() as u64 * 16).unwrap();
    let stages = wgpu::ShaderStages::COMPUTE;
    let layout = gpu.device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[
            storage_entry(0, stages, true),
            storage_entry(1, stages, false),
            uniform_entry(6, stages),
            storage_entry(7, stages, true),
        ],
    });
    let samples = area.samples();
    let numbers = gpu.uniform("lighting", 16);
    gpu.queue.write_buffer(&numbers, 0, bytemuck::bytes_of(&[0, samples, 0, 0]));
    let table = shading::ltc::Table::load(area.table().unwrap_or_default()).unwrap();
    let looked_up = gpu.storage("table", table.as_bytes().len() as u64).unwrap();
    gpu.queue.write_buffer(&looked_up, 0, table.as_bytes());
    let group = gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: None,
        layout: &layout,
        entries: &[entry(0, &asked), entry(1, &answered), entry(6, &numbers), entry(7, &looked_up)],
    });
    let shader = shading::lighting_shader()
        .module("package::evaluate", EVALUATE)
        .module("package::strategy", include_str!("../../../assign/src/shaders/everything.wesl"))
        .light_kinds(lights.kinds());
    let flags = area.flags().iter();
    let shader = flags.fold(shader, |shader, flag| shader.flag(flag, lights.kinds().areas));
    let module = shader.create(gpu, "package::evaluate").unwrap();
    let pipeline_layout = gpu.device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(bindings.layout()), None, Some(&layout)],
        immediate_size: 0,
    });
    let pipeline = gpu.device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: None,
        layout: Some(&pipeline_layout),
        module: &module,
        entry_point: Some("evaluate"),
        compilation_options: Default::default(),
        cache: None,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    EncoderPasses { encoder: &mut encoder }.compute("evaluate", &mut |pass| {
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, bindings.bind_group(), &[]);
        pass.set_bind_group(2, &group, &[]);
        pass.dispatch_workgroups((queries.len() as u32).div_ceil(64), 1, 1);
    });
    gpu.queue.submit([encoder.finish()]);
    bytemuck::pod_collect_to_vec(&gpu.read(&answered, queries.len() as u64 * 16).unwrap())
}
