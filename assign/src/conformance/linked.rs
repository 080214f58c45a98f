//! Checks linked shaders without a GPU: they validate, and their structs are laid out as in Rust.
//!
//! A layout test links a shader, takes a WESL struct apart, and compares it with the Rust struct:
//!
//! ```no_run
//! # use assign::{LightSphere, conformance::LinkedModule, struct_layout};
//! # let source = "";
//! let module = LinkedModule::new("the lights", source);
//! let rust = struct_layout!(LightSphere: position_world, radius_m);
//! assert_eq!(module.layout_of("LightSphere"), rust, "WESL, then Rust");
//! ```

use std::collections::BTreeSet;

use naga::{
    Handle, Module, Type, TypeInner,
    valid::{Capabilities, ModuleInfo, ValidationFlags, Validator},
};

/// Field names with their offsets, and the size of a struct: in bytes, in the order of the fields.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct StructLayout {
    /// Name and offset of every field.
    pub fields: Vec<(String, usize)>,
    /// The size of the struct.
    pub bytes: usize,
}

/// The [`StructLayout`](crate::conformance::StructLayout) of a Rust struct, from the fields that WESL
/// has too: `struct_layout!(LightSphere: position_world, radius_m)`. Leave out fields that only pad.
#[macro_export]
macro_rules! struct_layout {
    ($name:ty: $($field:ident),+ $(,)?) => {
        $crate::conformance::StructLayout {
            fields: vec![
                $((stringify!($field).to_owned(), ::std::mem::offset_of!($name, $field))),+
            ],
            bytes: ::std::mem::size_of::<$name>(),
        }
    };
}

/// A linked shader that is valid under what WebGPU has without any optional feature.
///
/// Its functions are assertions: they panic and say what they looked for.
#[derive(Debug)]
pub struct LinkedModule {
    what: String,
    module: Module,
    info: ModuleInfo,
}

impl LinkedModule {
    /// Parses and validates WGSL. `what` names it in messages.
    ///
    /// # Panics
    ///
    /// Panics if the source is not valid.
    #[track_caller]
    pub fn new(what: &str, source: &str) -> Self {
        match Self::validate(what, source) {
            Ok(module) => module,
            Err(reason) => panic!("{what}: {reason}"),
        }
    }

    /// As [`new`](Self::new), or why the source is not valid.
    pub fn validate(what: &str, source: &str) -> Result<Self, String> {
        let validator = Validator::new(ValidationFlags::all(), Capabilities::empty());
        Self::validate_by(validator, what, source)
    }

    /// As [`new`](Self::new), for a source that also uses subgroup operations.
    ///
    /// # Panics
    ///
    /// Panics if the source is not valid, or if it uses no subgroup operation.
    #[track_caller]
    pub fn with_subgroups(what: &str, source: &str) -> Self {
        assert!(Self::validate(what, source).is_err(), "{what} uses no subgroup operation");
        let mut validator = Validator::new(ValidationFlags::all(), Capabilities::SUBGROUP);
        validator
            .subgroup_stages(naga::valid::ShaderStages::COMPUTE)
            .subgroup_operations(naga::valid::SubgroupOperationSet::all());
        match Self::validate_by(validator, what, source) {
            Ok(module) => module,
            Err(reason) => panic!("{what}: {reason}"),
        }
    }

    fn validate_by(mut validator: Validator, what: &str, source: &str) -> Result<Self, String> {
        let module = naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?;
        let info = validator.validate(&module).map_err(|e| e.emit_to_string(source))?;
        Ok(Self { what: what.to_owned(), module, info })
    }

    /// The parsed module.
    pub fn module(&self) -> &Module {
        &self.module
    }

    /// Group and binding of every variable that an entry point uses.
    pub fn used_bindings(&self) -> BTreeSet<(u32, u32)> {
        let is_used = |handle: Handle<naga::GlobalVariable>| {
            let entry_points = 0..self.module.entry_points.len();
            entry_points.into_iter().any(|ix| !self.info.get_entry_point(ix)[handle].is_empty())
        };
        let variables = self.module.global_variables.iter();
        variables
            .filter(|&(handle, _)| is_used(handle))
            .filter_map(|(_, variable)| variable.binding.map(|at| (at.group, at.binding)))
            .collect()
    }

    /// Size of all workgroup memory together, bytes.
    pub fn workgroup_bytes(&self) -> u32 {
        let mut layouter = naga::proc::Layouter::default();
        // Validation has laid out every type already.
        let _ = layouter.update(self.module.to_ctx());
        let variables = self.module.global_variables.iter();
        variables
            .filter(|(_, variable)| variable.space == naga::AddressSpace::WorkGroup)
            .map(|(_, variable)| layouter[variable.ty].size)
            .sum()
    }

    /// The layout of a struct.
    ///
    /// # Panics
    ///
    /// Panics if the module has no struct of that name.
    #[track_caller]
    pub fn layout_of(&self, name: &str) -> StructLayout {
        self.layout(self.type_of(name))
    }

    /// The layout of the uniform at `binding` of any group.
    ///
    /// # Panics
    ///
    /// Panics if no uniform has that binding, or if its type is not a struct.
    #[track_caller]
    pub fn uniform_at(&self, binding: u32) -> StructLayout {
        let is_at_binding = |v: &naga::GlobalVariable| {
            v.space == naga::AddressSpace::Uniform
                && v.binding.is_some_and(|at| at.binding == binding)
        };
        let Some((_, found)) = self.module.global_variables.iter().find(|(_, v)| is_at_binding(v))
        else {
            panic!("{}: no uniform at binding {binding}", self.what);
        };
        self.layout(found.ty)
    }

    /// The strides of all arrays of a struct, bytes.
    ///
    /// # Panics
    ///
    /// Panics if the module has no struct of that name.
    #[track_caller]
    pub fn strides_of(&self, name: &str) -> Vec<usize> {
        let element = self.type_of(name);
        let stride = |ty: &Type| match ty.inner {
            TypeInner::Array { base, stride, .. } if base == element => Some(stride as usize),
            _ => None,
        };
        self.module.types.iter().filter_map(|(_, ty)| stride(ty)).collect()
    }

    /// The value of a `u32` constant.
    ///
    /// # Panics
    ///
    /// Panics if the module has no such constant, or if it is not a `u32` literal.
    #[track_caller]
    pub fn constant(&self, name: &str) -> u32 {
        let constants = &mut self.module.constants.iter();
        let found = constants.find(|(_, constant)| is_named(constant.name.as_deref(), name));
        let value = found.map(|(_, constant)| &self.module.global_expressions[constant.init]);
        let Some(naga::Expression::Literal(naga::Literal::U32(value))) = value else {
            panic!("{}: {name} is {value:?}: it must be a u32 literal", self.what);
        };
        *value
    }

    #[track_caller]
    fn type_of(&self, name: &str) -> Handle<Type> {
        let found = self.module.types.iter().find(|(_, ty)| is_named(ty.name.as_deref(), name));
        let Some((handle, _)) = found else {
            panic!("{}: no struct {name}", self.what);
        };
        handle
    }

    #[track_caller]
    fn layout(&self, ty: Handle<Type>) -> StructLayout {
        let TypeInner::Struct { members, span } = &self.module.types[ty].inner else {
            panic!("{}: {:?} is not a struct", self.what, self.module.types[ty].name);
        };
        let field =
            |m: &naga::StructMember| (m.name.clone().unwrap_or_default(), m.offset as usize);
        StructLayout { fields: members.iter().map(field).collect(), bytes: *span as usize }
    }
}

/// The linker may put the name of the module in front of a name.
fn is_named(linked: Option<&str>, name: &str) -> bool {
    linked.is_some_and(|linked| linked == name || linked.ends_with(&format!("_{name}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    const SOURCE: &str = "
        struct package_test_Item { position: vec3f, radius: f32 }
        const package_test_LIMIT: u32 = 7u;
        @group(2) @binding(4) var<uniform> item: package_test_Item;
        @group(0) @binding(1) var<storage, read_write> items: array<package_test_Item>;
        @group(0) @binding(3) var<storage, read> unused: array<u32>;
        var<workgroup> sh_items: array<vec4f, 3>;
        @compute @workgroup_size(1) fn main() {
            sh_items[0] = vec4f(item.position, 0.0);
            items[package_test_LIMIT] = item;
        }";

    #[repr(C)]
    #[allow(dead_code, reason = "only its layout is read")]
    struct Item {
        position: [f32; 3],
        radius: f32,
    }

    #[repr(C)]
    #[allow(dead_code, reason = "only its layout is read")]
    struct Swapped {
        radius: f32,
        position: [f32; 3],
    }

    #[test]
    fn equal_layouts_are_equal_and_others_differ() {
        let module = LinkedModule::new("test", SOURCE);
        let wesl = module.layout_of("Item");
        assert_eq!(wesl, crate::struct_layout!(Item: position, radius));
        assert_eq!(wesl, module.uniform_at(4));
        assert_ne!(wesl, crate::struct_layout!(Swapped: radius, position));
    }

    #[test]
    fn bindings_strides_constants_and_workgroup_memory_are_found() {
        let module = LinkedModule::new("test", SOURCE);
        assert_eq!(module.used_bindings(), [(0, 1), (2, 4)].into());
        assert_eq!(module.strides_of("Item"), [16]);
        assert_eq!(module.constant("LIMIT"), 7);
        assert_eq!(module.workgroup_bytes(), 48);
    }

    #[test]
    fn invalid_sources_are_rejected() {
        let f16 = "enable f16; var<private> half: f16;";
        for source in ["fn f( {}", "fn f() -> u32 {}", f16] {
            assert!(LinkedModule::validate("test", source).is_err(), "{source}");
        }
    }
}
