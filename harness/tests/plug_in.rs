//! Every strategy's look-up is plain WGSL that validates, in any place of a renderer's bind groups.

use assign::{LightKinds, LightReader, Shader, Slots, conformance::LinkedModule};
use harness::{
    choice::Choice,
    strategy::{Method, rows},
};

/// Ids that read lights in another way than the default of their family.
const MORE: [&str; 18] = [
    "T-I/mask",
    "T-I/tree",
    "T-I/prune",
    "T-I/scalar",
    "T-E/tree",
    "T-25D/mask",
    "DC-I/even",
    "DC-E/mask",
    "SC-E/near5/n6/bvh/mask",
    "SC-E/n24/s0.001/bvh",
    "SC-E/n54",
    "SC-E/bvh/scalar",
    "SC-E/96x96x16/bvh/prune",
    "G/visible/mask",
    "G/surfaces",
    "G/8x8x8/frustum/bvh",
    "W/bvh",
    "M/2/bvh",
];

/// A renderer's shader, with names that look-ups have too.
const RENDERER: &str = "
struct View { tint: vec4f }
@group(0) @binding(0) var<uniform> view: View;
fn group_of(pixel: vec2f) -> u32 { return u32(pixel.x); }
@fragment
fn shade(@builtin(position) at: vec4f) -> @location(0) vec4f {
  var cursor = lb_open_lights(lb_sample_at(at.xy, at.z, vec3f(0.0, 1.0, 0.0), group_of(at.xy)));
  var sum = view.tint.rgb;
  while lb_next_light(&cursor) {
    sum += lb_light_emissions[cursor.entry & lb_ENTRY_LIGHT].intensity;
  }
  return vec4f(sum, 1.0);
}
";

#[test]
fn every_look_up_validates_inside_a_renderer() {
    let gpu = assign::Gpu::noop().expect("a device");
    let families = rows().map(|row| row.family);
    let mut count = 0;
    for id in families.chain(MORE) {
        let method = Choice::parse(id).expect(id).make(&gpu).expect(id);
        let Method::Lists { strategy, .. } = method else { continue };
        let lookup = strategy.lookup();
        let last =
            lookup.layout_entries(5, wgpu::ShaderStages::FRAGMENT).iter().map(|e| e.binding).max();
        let apart = last.expect(id) + 1;
        for (view, prefix) in [((0, 1), "lb_"), ((0, apart), "lb_"), ((3, 0), "clustered_lights_")]
        {
            let slots = Slots { view, lists_group: 0, first_binding: 5, prefix };
            let text = lookup.wgsl_at_surfaces(&slots).expect(id);
            for text in [&text, &lookup.wgsl(&slots).expect(id)] {
                let module = LinkedModule::new(id, text);
                let variables = module.module().global_variables.iter();
                let bound: Vec<(u32, u32)> = variables
                    .filter_map(|(_, v)| Some((v.binding?.group, v.binding?.binding)))
                    .collect();
                let is_placed = |(group, binding): (u32, u32)| {
                    (group == view.0 && (view.1..view.1 + 4).contains(&binding))
                        || (group == 0 && (5..apart).contains(&binding))
                };
                assert!(bound.iter().copied().all(is_placed), "{id}: {bound:?}");
            }
            if prefix == "lb_" {
                // Look-ups of opaque surfaces and of other samples in one module.
                let anywhere = Slots { prefix: "glass_", ..slots };
                let anywhere = lookup.wgsl(&anywhere).expect(id);
                LinkedModule::new(id, &(text + RENDERER + &anywhere));
            }
            for kinds in LightKinds::ALL {
                let reader = lookup.module.wesl().reader;
                let shader = Shader::new(0).strategy(lookup.module).light_kinds(kinds);
                let text = shader.without_subgroups().wgsl(&slots).expect(id);
                LinkedModule::new(id, &text);
                assert!(
                    !matches!(reader, LightReader::Own(_)),
                    "{id} has a reader of the contract's"
                );
                count += 1;
            }
        }
    }
    assert!(count > 300, "only {count} texts");
}
