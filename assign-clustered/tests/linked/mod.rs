//! Linked shaders without a GPU: validated, and their structs taken apart.

/// A linked module, validated with what WebGPU has without any optional feature.
pub(crate) fn validated(source: &str, what: &str) -> naga::Module {
    let module = naga::front::wgsl::parse_str(source)
        .unwrap_or_else(|e| panic!("{what}: {}", e.emit_to_string(source)));
    naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        naga::valid::Capabilities::empty(),
    )
    .validate(&module)
    .unwrap_or_else(|e| panic!("{what}: {}", e.emit_to_string(source)));
    module
}

/// Names and offsets of the fields, and the size, of a WESL struct. The linker puts the names of modules
/// before those of structs.
pub(crate) fn members(module: &naga::Module, name: &str) -> (Vec<(String, usize)>, usize) {
    let is_named = |n: &str| n == name || n.ends_with(&format!("_{name}"));
    let found = module.types.iter().find_map(|(_, ty)| match &ty.inner {
        naga::TypeInner::Struct { members, span } if ty.name.as_deref().is_some_and(is_named) => {
            let field = |m: &naga::StructMember| (m.name.clone().unwrap(), m.offset as usize);
            Some((members.iter().map(field).collect(), *span as usize))
        }
        _ => None,
    });
    found.unwrap_or_else(|| panic!("no struct {name}"))
}
