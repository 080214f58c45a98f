//! The models' module, linked without a GPU: it validates, and its record has the same size and the
//! same offsets in Rust and in WESL.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use std::mem::offset_of;

use assign::{CullSettings, Culler, GroupShape, LightKinds, LightSource};
use assign_model::{MODELS_WESL, ModelRecord};

fn validated(what: &str, source: &str) -> naga::Module {
    let module = naga::front::wgsl::parse_str(source)
        .unwrap_or_else(|e| panic!("{what}: {}", e.emit_to_string(source)));
    // What WebGPU has without any optional feature.
    naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        naga::valid::Capabilities::empty(),
    )
    .validate(&module)
    .unwrap_or_else(|e| panic!("{what}: {}", e.emit_to_string(source)));
    module
}

/// Fields and offsets, and the size, of a struct of the shader.
fn layout(module: &naga::Module, name: &str) -> (Vec<(String, usize)>, usize) {
    // The linker may put the module before a name.
    let is_named = |n: &str| n == name || n.ends_with(&format!("_{name}"));
    let named = |(_, ty): &(_, &naga::Type)| ty.name.as_deref().is_some_and(is_named);
    let (_, ty) = module.types.iter().find(named).unwrap_or_else(|| panic!("{name}: not there"));
    let naga::TypeInner::Struct { members, span } = &ty.inner else {
        panic!("{name}: not a struct");
    };
    let field = |m: &naga::StructMember| (m.name.clone().unwrap_or_default(), m.offset as usize);
    (members.iter().map(field).collect(), *span as usize)
}

/// Name and offset of fields of a Rust struct; those that pad are not told in WESL.
macro_rules! fields {
    ($name:ty: $($field:ident),+) => {
        vec![$((stringify!($field).to_owned(), offset_of!($name, $field))),+]
    };
}

#[test]
fn models() {
    for source in [LightSource::Linear, LightSource::Hierarchy] {
        for kinds in LightKinds::ALL {
            let settings = CullSettings { source, ..CullSettings::default() };
            let shape = GroupShape::OrientedBox;
            let source = Culler::kernel_source(shape, settings, false, MODELS_WESL, kinds);
            let module = validated("cull", &source.unwrap());
            let (fields, bytes) = layout(&module, "Model");
            let rust = fields!(ModelRecord: center_world, first_group, axis_x, parts_x, axis_y,
                parts_y, axis_z, parts_z, half_extents_m, slack_m);
            assert_eq!(fields, rust, "fields of WESL, then of Rust");
            assert_eq!(bytes, size_of::<ModelRecord>());
        }
    }
}
