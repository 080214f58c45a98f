//! A look-up as plain WGSL text, for renderers with a shader system of their own.
//!
//! [`Shader`](crate::Shader) links the modules that read lights. Every global name then gets a prefix, and every
//! variable the bind group and the binding that the renderer chose. The text has no entry point and no import. A
//! renderer adds it to its own WGSL.
//!
//! # Phases
//!
//! 1. A root module names each item of [`PUBLIC`] in a function, so that the linker keeps these items and what they use.
//! 2. [`PrefixMangler`] names the declarations while the modules are linked.
//! 3. [`place`] replaces the attributes `@group` and `@binding`, and the function of phase 1 is dropped.

use wesl::{
    EscapeMangler, Mangler, ModulePath,
    syntax::{
        Attribute, Expression, GlobalDeclaration, Ident, LiteralExpression, PathOrigin,
        TranslationUnit,
    },
};

use crate::AssignError;

/// Bindings of [`FrameBindings`](crate::FrameBindings): the view and three buffers of lights.
pub(crate) const FRAME_BINDINGS: u32 = 4;

/// Where a look-up stands in a renderer's own shaders ([`Lookup::wgsl`](crate::Lookup::wgsl)).
///
/// All of it fits into one of the renderer's bind groups: give `view` and `lists_group` the same group, and other
/// bindings.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Slots<'a> {
    /// Bind group and binding of the view. The three buffers of lights have the next three bindings. See
    /// [`FrameBindings::layout_entries`](crate::FrameBindings::layout_entries).
    pub view: (u32, u32),
    /// Bind group of the lists.
    pub lists_group: u32,
    /// First binding in that group. See [`Lookup::layout_entries`](crate::Lookup::layout_entries).
    pub first_binding: u32,
    /// What every global name begins with, such as `lb_`: ASCII letters, digits and underscores, and a letter first.
    pub prefix: &'a str,
}

/// What a renderer may use: module and item. In the text, an item has the prefix in front of its name.
pub(crate) const PUBLIC: [(&str, &[&str]); 7] = [
    ("look_up", &["open_lights", "next_light", "LightCursor"]),
    ("sample", &["ViewSample", "sample_at"]),
    (
        "view",
        &[
            "View",
            "view",
            "ndc_of_pixel",
            "depth_view_of_clip",
            "position_view_at",
            "world_of_view",
            "eye_world",
        ],
    ),
    (
        "lights",
        &[
            "LightSphere",
            "LightEmission",
            "light_spheres",
            "light_emissions",
            "kind_of",
            "shape_of",
            "KIND_POINT",
            "KIND_SPOT",
            "KIND_RECTANGLE",
            "KIND_POLYGON",
            "KIND_VPL",
            "KIND_DISC",
            "KIND_SPHERE",
            "KIND_LINE",
        ],
    ),
    ("lists", &["ENTRY_LIGHT", "ENTRY_DIFFUSE", "ENTRY_SPECULAR"]),
    ("window", &["fall_off", "range_window", "MIN_DISTANCE_2"]),
    ("stochastic", &["random_of", "stochastic_fall_off"]),
];

/// What a renderer may use if some lights are no points.
const LIGHT_SHAPES: (&str, &str) = ("lights", "light_shapes");

/// The function of the root module that names all of [`PUBLIC`].
pub(crate) const KEPT: &str = "kept";

/// The root module. Without `shapes`, no variable holds the shapes of lights.
pub(crate) fn root_module(shapes: bool) -> String {
    let items = PUBLIC.iter().flat_map(|(module, items)| items.iter().map(move |i| (*module, *i)));
    let items = items.chain(shapes.then_some(LIGHT_SHAPES));
    let uses = items.map(|(module, item)| format!("  _ = package::{module}::{item};\n"));
    format!("fn {KEPT}() {{\n{}}}\n", uses.collect::<String>())
}

/// Names declarations of a linked text: `lb_open_lights` for what [`PUBLIC`] lists, `lb_package_strategy__1group_of`
/// for the rest.
#[derive(Clone, Debug)]
pub(crate) struct PrefixMangler(pub(crate) String);

impl Mangler for PrefixMangler {
    fn mangle(&self, path: &ModulePath, item: &str) -> String {
        let is_public = |module: &str, items: &[&str]| {
            (items.contains(&item) || (module, item) == LIGHT_SHAPES)
                && path.origin == PathOrigin::Absolute
                && path.components == [module]
        };
        if PUBLIC.iter().any(|(module, items)| is_public(module, items)) {
            return format!("{}{item}", self.0);
        }
        format!("{}{}", self.0, EscapeMangler.mangle(path, item))
    }
}

/// The mangled name of the constant that stands for the bind group of lists.
fn lists_group_name(prefix: &str) -> String {
    let slots = ModulePath::new(PathOrigin::Absolute, vec!["slots".to_owned()]);
    PrefixMangler(prefix.to_owned()).mangle(&slots, "LISTS_GROUP")
}

impl Slots<'_> {
    /// Checks the prefix.
    pub(crate) fn check(&self) -> Result<(), AssignError> {
        let is_letter = self.prefix.starts_with(|c: char| c.is_ascii_alphabetic());
        if is_letter && self.prefix.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
            return Ok(());
        }
        Err(AssignError::Parameter {
            field: "prefix of a look-up's WGSL".into(),
            value: format!("{:?}", self.prefix),
            accepted: "ASCII letters, digits and underscores, with a letter first, such as \"lb_\""
                .into(),
        })
    }
}

/// Gives every variable its place, and drops what only linking needed.
pub(crate) fn place(text: &mut TranslationUnit, slots: &Slots<'_>) -> Result<(), String> {
    let lists_group = lists_group_name(slots.prefix);
    text.global_declarations.retain(|declaration| {
        let name = name_of(declaration).map(|ident| ident.name().clone());
        !name.is_some_and(|name| name == KEPT || name == lists_group)
    });
    let mut places: Vec<((u32, u32), String)> = Vec::new();
    for declaration in &mut text.global_declarations {
        let GlobalDeclaration::Declaration(variable) = declaration.node_mut() else { continue };
        let name = variable.ident.name().clone();
        let mut group = None;
        let mut binding = None;
        for attribute in &mut variable.attributes {
            match attribute.node_mut() {
                Attribute::Group(at) => group = Some(at),
                Attribute::Binding(at) => binding = Some(at),
                _ => {}
            }
        }
        let (Some(group), Some(binding)) = (group, binding) else { continue };
        let offset = literal(binding).ok_or_else(|| {
            format!("binding {binding} of {name} is no number from 0 to 4294967295")
        })?;
        let is_lists = group.to_string() == lists_group;
        let (in_group, first) = match (literal(group), is_lists) {
            (_, true) => (slots.lists_group, slots.first_binding),
            (Some(0), _) if offset < FRAME_BINDINGS => slots.view,
            _ => {
                return Err(format!(
                    "{name} stands at binding {offset} of bind group {group}: a look-up may read bindings 0 to {} of group 0, and group LISTS_GROUP",
                    FRAME_BINDINGS - 1
                ));
            }
        };
        let at = first.checked_add(offset).ok_or_else(|| {
            format!("binding {first} + {offset} of {name} is greater than 4294967295")
        })?;
        if let Some((_, other)) = places.iter().find(|(place, _)| *place == (in_group, at)) {
            return Err(format!(
                "{other} and {name} would both stand at binding {at} of bind group {in_group}: change `view` or `first_binding`"
            ));
        }
        places.push(((in_group, at), name));
        **group = number(in_group);
        **binding = number(at);
    }
    Ok(())
}

/// The name that a declaration makes.
fn name_of(declaration: &GlobalDeclaration) -> Option<&Ident> {
    match declaration {
        GlobalDeclaration::Declaration(variable) => Some(&variable.ident),
        GlobalDeclaration::TypeAlias(alias) => Some(&alias.ident),
        GlobalDeclaration::Struct(record) => Some(&record.ident),
        GlobalDeclaration::Function(function) => Some(&function.ident),
        // Later releases of the linker have more kinds.
        _ => None,
    }
}

/// The value of a number.
fn literal(expression: &Expression) -> Option<u32> {
    match expression {
        Expression::Literal(LiteralExpression::AbstractInt(value)) => u32::try_from(*value).ok(),
        Expression::Literal(LiteralExpression::I32(value)) => u32::try_from(*value).ok(),
        Expression::Literal(LiteralExpression::U32(value)) => Some(*value),
        _ => None,
    }
}

fn number(value: u32) -> Expression {
    Expression::Literal(LiteralExpression::AbstractInt(value.into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn public_names_differ_from_each_other_and_from_all_others() {
        let items = PUBLIC.iter().flat_map(|(_, items)| *items);
        let mut names: Vec<&str> = items.copied().chain([LIGHT_SHAPES.1]).collect();
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count);
        // The other names begin with the path of their module.
        assert!(names.iter().all(|name| !name.starts_with("package_") && *name != KEPT));
    }
}
