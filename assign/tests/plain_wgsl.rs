//! Look-ups as plain WGSL: every reader validates alone and inside an engine's own module.

use assign::{
    AssignError, Assignment, Everything, FrameBindings, Gpu, LightKinds, LightReader, LightSource,
    Shader, Slots, Storage, StrategyWesl, Team, conformance::LinkedModule,
};

/// A strategy that reads everything a strategy may read, for all readers.
const STRATEGY: &str = "
import package::sample::ViewSample;
import package::slots::LISTS_GROUP;
import package::view::view;
import package::lights::LightNode;
struct Cull { light_count: u32, first_parent: u32, first_grandparent: u32, pad: u32 }
@group(LISTS_GROUP) @binding(4) var<uniform> lights: Cull;
@group(LISTS_GROUP) @binding(5) var<storage, read> light_nodes: array<LightNode>;
fn group_of(sample: ViewSample) -> u32 { return u32(sample.depth_view / view.near_m); }
fn second_group_of(sample: ViewSample) -> u32 { return lights.light_count; }
";

/// An engine's module, whose names are those of the look-up without its prefix.
const ENGINE: &str = "
struct View { world_to_clip: mat4x4f }
struct LightCursor { place: u32 }
@group(0) @binding(0) var<uniform> view: View;
@group(1) @binding(0) var<storage, read> light_spheres: array<vec4f>;
fn world_of_view(position: vec3f) -> vec3f { return position; }
fn open_lights() -> LightCursor { return LightCursor(u32(view.world_to_clip[0].x)); }
@fragment
fn shade(@builtin(position) at: vec4f) -> @location(0) vec4f {
  let sample = lb_sample_at(at.xy, at.z, vec3f(0.0, 1.0, 0.0), 0u);
  var sum = light_spheres[open_lights().place].xyz + world_of_view(lb_eye_world());
  var cursor = lb_open_lights(sample);
  while lb_next_light(&cursor) {
    let light = cursor.entry & lb_ENTRY_LIGHT;
    let sphere = lb_light_spheres[light];
    let to_light = sphere.position_world - sample.position_world;
    let fall_off = lb_fall_off(dot(to_light, to_light), sphere.radius_m, lb_MIN_DISTANCE_2);
    sum += lb_light_emissions[light].intensity * fall_off;
  }
  return vec4f(sum, lb_view.near_m);
}
";

const SLOTS: Slots<'_> = Slots { view: (0, 1), lists_group: 0, first_binding: 5, prefix: "lb_" };

/// All ways to read lights that `assign` has.
fn readers() -> Vec<LightReader<'static>> {
    let storages = Storage::NAMED.into_iter().chain([Storage::Lists]);
    let mut readers: Vec<_> = storages.map(LightReader::Stored).collect();
    readers.push(LightReader::BothMasks);
    for team in [Team::Lane, Team::Subgroup] {
        for source in [LightSource::Linear, LightSource::Hierarchy] {
            readers.push(LightReader::Walk { team, source });
        }
    }
    readers
}

fn shader(reader: LightReader<'static>, kinds: LightKinds) -> Shader<'static> {
    Shader::new(1).strategy(StrategyWesl { reader, ..STRATEGY.into() }).light_kinds(kinds)
}

/// Names of everything that a module declares.
fn declared(module: &LinkedModule) -> Vec<String> {
    let module = module.module();
    let functions = module.functions.iter().map(|(_, f)| f.name.clone());
    let variables = module.global_variables.iter().map(|(_, v)| v.name.clone());
    let constants = module.constants.iter().map(|(_, c)| c.name.clone());
    let structs = module.types.iter().map(|(_, t)| t.name.clone());
    functions.chain(variables).chain(constants).chain(structs).flatten().collect()
}

#[test]
fn every_reader_validates_under_every_prefix_and_in_an_engine() {
    for reader in readers() {
        for kinds in LightKinds::ALL {
            for prefix in ["lb_", "a", "Lights2__"] {
                let what = format!("{reader:?}, {kinds:?}, {prefix}");
                let shader = shader(reader, kinds);
                let slots = Slots { prefix, ..SLOTS };
                let text = shader.clone().without_subgroups().wgsl(&slots).expect(&what);
                let module = LinkedModule::new(&what, &text);
                assert!(module.module().entry_points.is_empty(), "{what}");
                for name in declared(&module) {
                    assert!(name.starts_with(prefix), "{what}: {name}");
                }
                let shapes = declared(&module).contains(&format!("{prefix}light_shapes"));
                assert_eq!(shapes, kinds.spots || kinds.areas, "{what}");
                if prefix == "lb_" {
                    LinkedModule::new(&what, &(ENGINE.to_owned() + &text));
                }
                if reader.needs_subgroups() {
                    let entry = format!(
                        "@compute @workgroup_size(64) fn run() {{
                          var cursor = {prefix}open_lights({prefix}ViewSample());
                          while {prefix}next_light(&cursor) {{}}
                        }}"
                    );
                    let text = shader.wgsl(&slots).expect(&what);
                    LinkedModule::with_subgroups(&what, &(text + &entry));
                }
            }
        }
    }
}

/// The engine's names clash with those of a look-up that has no prefix.
#[test]
fn names_without_a_prefix_clash() {
    let shader = shader(LightReader::Stored(Storage::Lists), LightKinds::default());
    let text = shader.wgsl(&SLOTS).expect("links");
    for name in ["View", "view", "LightCursor", "light_spheres", "world_of_view", "open_lights"] {
        let clash = text.replace(&format!("lb_{name}"), name);
        let reason = LinkedModule::validate("a clash", &(ENGINE.to_owned() + &clash)).err();
        assert!(reason.is_some_and(|reason| reason.contains("redefinition")), "{name}");
    }
}

#[test]
fn bindings_stand_where_the_renderer_wants_them() {
    let places = |slots: &Slots<'_>| -> Vec<(String, (u32, u32))> {
        let reader = LightReader::Walk { team: Team::Lane, source: LightSource::Hierarchy };
        let kinds = LightKinds::EVERY;
        let text = shader(reader, kinds).wgsl(slots).expect("links");
        let module = LinkedModule::new("the look-up", &text);
        let variables = module.module().global_variables.iter();
        let mut places: Vec<_> = variables
            .filter_map(|(_, v)| {
                Some((v.name.clone()?, v.binding.map(|at| (at.group, at.binding))?))
            })
            .collect();
        places.sort_by_key(|(_, place)| *place);
        places
    };
    let names = [
        "lb_view",
        "lb_light_spheres",
        "lb_light_emissions",
        "lb_light_shapes",
        "lb_package_strategy_lights",
        "lb_package_strategy__1light_nodes",
    ];
    let expect = |at: [(u32, u32); 6]| -> Vec<_> {
        names.iter().map(|name| (*name).to_owned()).zip(at).collect()
    };
    assert_eq!(places(&SLOTS), expect([(0, 1), (0, 2), (0, 3), (0, 4), (0, 9), (0, 10)]));
    let apart = Slots { view: (2, 7), lists_group: 3, first_binding: 0, ..SLOTS };
    assert_eq!(places(&apart), expect([(2, 7), (2, 8), (2, 9), (2, 10), (3, 4), (3, 5)]));
}

/// The reason why slots are refused.
fn refused(slots: &Slots<'_>, wesl: StrategyWesl<'_>) -> String {
    Shader::new(1).strategy(wesl).wgsl(slots).expect_err("refused").to_string()
}

#[test]
fn faulty_slots_are_refused() {
    let list = || StrategyWesl::from(STRATEGY);
    for prefix in ["", "_", "__lb", "2d", "lb-", "lä", "lb::", "l b", "\u{1b}[0m"] {
        let reason = refused(&Slots { prefix, ..SLOTS }, list());
        let says = ["prefix of a look-up's WGSL is", "it must be ASCII letters"];
        assert!(says.iter().all(|part| reason.contains(part)), "{prefix:?}: {reason}");
    }
    let clash = refused(&Slots { first_binding: 2, ..SLOTS }, list());
    assert!(clash.contains("would both stand at binding 2 of bind group 0"), "{clash}");
    assert!(clash.contains("change `view` or `first_binding`"), "{clash}");
    for slots in
        [Slots { first_binding: u32::MAX, ..SLOTS }, Slots { view: (0, u32::MAX), ..SLOTS }]
    {
        let reason = refused(&slots, list());
        assert!(reason.contains("is greater than 4294967295"), "{reason}");
    }
}

#[test]
fn a_strategy_that_reads_elsewhere_is_refused() {
    let strategy = |attributes: &str| {
        format!(
            "import package::sample::ViewSample;
            import package::slots::LISTS_GROUP;
            {attributes} var<uniform> mine: vec4u;
            fn group_of(sample: ViewSample) -> u32 {{ return mine.x; }}"
        )
    };
    for attributes in ["@group(2) @binding(0)", "@group(0) @binding(4)"] {
        let reason = refused(&SLOTS, strategy(attributes).as_str().into());
        assert!(reason.contains("a look-up may read bindings 0 to 3 of group 0"), "{reason}");
    }
    let reason = refused(&SLOTS, strategy("@group(LISTS_GROUP) @binding(2 + 2)").as_str().into());
    assert!(reason.contains("is no number from 0 to 4294967295"), "{reason}");
    let nothing = Shader::new(1).wgsl(&SLOTS).expect_err("no strategy is mounted");
    assert!(matches!(nothing, AssignError::Shader { .. }), "{nothing}");
}

#[test]
fn look_ups_of_other_authors_validate() {
    const LOOK_UP: &str = "
        import package::sample::ViewSample;
        import package::strategy::group_of;
        import package::lists::{entries, list_of};
        const View: u32 = 1u;
        struct LightCursor { entry: u32, left: u32 }
        fn open_lights(sample: ViewSample) -> LightCursor {
          return LightCursor(0u, list_of(group_of(sample)).count * View);
        }
        fn next_light(cursor: ptr<function, LightCursor>) -> bool {
          (*cursor).left -= 1u;
          (*cursor).entry = entries[(*cursor).left];
          return (*cursor).left > 0u;
        }";
    let shader = shader(LightReader::Own(LOOK_UP), LightKinds::default());
    LinkedModule::new("another look-up", &shader.wgsl(&SLOTS).expect("links"));
}

#[test]
fn layouts_and_bind_groups_match_the_text() {
    let gpu = Gpu::noop().expect("a noop device");
    let mut strategy = Everything::new(&gpu).expect("a strategy");
    let mut frame = FrameBindings::new(&gpu);
    assert!(strategy.lookup().bind_entries(5).is_empty() && frame.bind_entries(1).is_empty());
    let stages = wgpu::ShaderStages::FRAGMENT;
    let mut layout = FrameBindings::layout_entries(1, stages);
    layout.extend(strategy.lookup().layout_entries(5, stages));
    assert!(layout.iter().all(|entry| entry.visibility == stages));
    let bindings = |entries: &[wgpu::BindGroupLayoutEntry]| -> Vec<u32> {
        entries.iter().map(|entry| entry.binding).collect()
    };
    assert_eq!(bindings(&layout), [1, 2, 3, 4, 5, 6]);

    let lights = assign::LightBuffer::new(&gpu, &[]).expect("lights");
    let view = assign::View::look_at(glam::Vec3::ZERO, glam::Vec3::X, 1.0, 0.1, [8, 8]);
    let inputs = assign::Frame::new(&view, &lights);
    frame.update(&gpu, &inputs).expect("updates");
    strategy.prepare(&gpu, &inputs).expect("prepares");
    let mut entries = frame.bind_entries(1);
    entries.extend(strategy.lookup().bind_entries(5));
    let scope = gpu.device.push_error_scope(wgpu::ErrorFilter::Validation);
    let layout = gpu.bind_group_layout("mine", &layout);
    assign::kernel::bind_entries(&gpu, &layout, &entries);
    assert!(pollster::block_on(scope.pop()).is_none());

    let text = strategy.lookup().wgsl(&SLOTS).expect("links");
    let module = LinkedModule::new("the look-up", &text);
    let variables = module.module().global_variables.iter();
    let mut places: Vec<_> =
        variables.filter_map(|(_, v)| v.binding.map(|at| at.binding)).collect();
    places.sort_unstable();
    assert_eq!(places, [1, 2, 3, 4, 5, 6]);
}
