//! What linking returns: WGSL with an entry point, or an error in plain text that says what to do.

use assign::{Shader, conformance::LinkedModule};

/// The reason why a module does not link.
fn reason(source: &str) -> String {
    let shader = Shader::new(1).module("package::mine", source);
    shader.link("package::mine").expect_err("a fault").to_string()
}

#[test]
fn messages_are_plain_and_say_what_to_do() {
    let unread = "@compute @workgroup_size(1) fn run() { let = 1; }";
    let unknown = "@compute @workgroup_size(1) fn run() { let x = newest_builtin; }";
    for source in [unread, unknown] {
        let reason = reason(source);
        assert!(!reason.contains('\u{1b}'), "{reason:?}");
        assert!(reason.contains("add the text of Lookup::wgsl"), "{reason}");
    }
    let missing = reason(
        "import package::nothing::at_all;
        @compute @workgroup_size(1) fn run() { at_all(); }",
    );
    assert!(missing.contains("nothing") && !missing.contains("Lookup::wgsl"), "{missing}");
}

#[test]
fn a_module_without_entry_point_is_an_error() {
    for source in ["", "fn helper() -> u32 { return 1u; }"] {
        let reason = reason(source);
        assert!(reason.contains("package::mine: it has no entry point"), "{reason}");
    }
}

/// An engine's module may have names of the contract's modules.
#[test]
fn names_of_two_modules_may_be_equal() {
    let source = "import package::view::{view as lit_view, world_of_view as world};
        struct View { tint: vec4f }
        @group(2) @binding(0) var<uniform> view: View;
        @group(2) @binding(1) var<storage, read_write> out: vec4f;
        fn world_of_view(position: vec3f) -> vec3f { return position; }
        @compute @workgroup_size(1) fn run() {
          let at = world(world_of_view(view.tint.xyz));
          out = vec4f(at, lit_view.near_m);
        }";
    let linked = Shader::new(1).module("package::mine", source).link("package::mine");
    LinkedModule::new("two views", &linked.expect("links"));
    let twice = reason(
        "const ONE: u32 = 1u; const ONE: u32 = 1u;
        @compute @workgroup_size(ONE) fn run() {}",
    );
    assert!(twice.contains("duplicate declaration of `ONE`"), "{twice}");
}

/// WGSL that engines use beside the look-up.
#[test]
fn directives_binding_arrays_and_immediates_link() {
    let source = "enable f16;
        struct Push { offset: u32 }
        var<immediate> push: Push;
        @group(0) @binding(9) var textures: binding_array<texture_2d<f32>, 4>;
        @group(0) @binding(8) var<storage, read_write> out: array<vec4f>;
        @compute @workgroup_size(1) fn run() {
          let half = f16(1.0);
          out[push.offset] = f32(half) * textureLoad(textures[push.offset], vec2i(0), 0);
        }";
    let linked = Shader::new(1).module("package::mine", source).link("package::mine");
    let linked = linked.expect("links");
    for kept in ["enable f16;", "var<immediate> push", "binding_array<texture_2d<f32>, 4>"] {
        assert!(linked.contains(kept), "{kept} in {linked}");
    }
}
