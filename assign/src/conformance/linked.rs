//! Linked shaders without a GPU: they validate, and their structs are laid out as in Rust.
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
    /// Where the source is not valid.
    #[track_caller]
    pub fn new(what: &str, source: &str) -> Self {
        match Self::validate(what, source) {
            Ok(module) => module,
            Err(reason) => panic!("{what}: {reason}"),
        }
    }

    /// As [`new`](Self::new), or why the source is not valid.
    pub fn validate(what: &str, source: &str) -> Result<Self, String> {
        let module = naga::front::wgsl::parse_str(source).map_err(|e| e.emit_to_string(source))?;
        let info = Validator::new(ValidationFlags::all(), Capabilities::empty())
            .validate(&module)
            .map_err(|e| e.emit_to_string(source))?;
        Ok(Self { what: what.to_owned(), module, info })
    }

    /// The parsed module.
    pub fn module(&self) -> &Module {
        &self.module
    }

    /// What validation found out about the module: the variables that each entry point uses, and more.
    pub fn info(&self) -> &ModuleInfo {
        &self.info
    }

    /// The layout of a struct.
    ///
    /// # Panics
    ///
    /// Where there is no struct of that name.
    #[track_caller]
    pub fn layout_of(&self, name: &str) -> StructLayout {
        self.layout(self.type_of(name))
    }

    /// The layout of the uniform at `binding` of any group.
    ///
    /// # Panics
    ///
    /// Where there is none, or it is no struct.
    #[track_caller]
    pub fn uniform_at(&self, binding: u32) -> StructLayout {
        let is_it = |v: &naga::GlobalVariable| {
            v.space == naga::AddressSpace::Uniform
                && v.binding.is_some_and(|at| at.binding == binding)
        };
        let Some((_, found)) = self.module.global_variables.iter().find(|(_, v)| is_it(v)) else {
            panic!("{}: no uniform at binding {binding}", self.what);
        };
        self.layout(found.ty)
    }

    /// The strides of all arrays of a struct, bytes.
    ///
    /// # Panics
    ///
    /// Where there is no struct of that name.
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
    /// Where there is no such constant, or it is no `u32` literal.
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
            panic!("{}: {:?} is no struct", self.what, self.module.types[ty].name);
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
