//! What the WESL linker says of a fault, as plain text.

use wesl::{Error, ValidateError};

/// The message, without the codes that colour it in a terminal. If the module may be WGSL that the linker does not
/// know, it says what to do.
pub(crate) fn words(error: &Error) -> String {
    let mut words = without_colours(&error.to_string());
    if is_unknown_to_linker(error) {
        words.push_str(
            "\nIf this is WGSL that the linker does not know, leave it out of linking: add the text of Lookup::wgsl to it",
        );
    }
    words
}

/// Whether the linker cannot read a module, or misses a declaration that may be built in.
fn is_unknown_to_linker(error: &Error) -> bool {
    match error {
        Error::Error(diagnostic) => is_unknown_to_linker(&diagnostic.error),
        Error::ParseError(_) | Error::ValidateError(ValidateError::UndefinedSymbol(_)) => true,
        _ => false,
    }
}

/// Whether one name is declared twice.
pub(crate) fn is_clash(error: &Error) -> bool {
    match error {
        Error::Error(diagnostic) => is_clash(&diagnostic.error),
        error => matches!(error, Error::ValidateError(ValidateError::Duplicate(_))),
    }
}

/// Leaves out the sequences from an escape character to the letter `m`.
fn without_colours(text: &str) -> String {
    let mut parts = text.split('\u{1b}');
    let plain = parts.next().unwrap_or_default().to_owned();
    let after = |part: &str| part.split_once('m').map_or("", |(_, rest)| rest).to_owned();
    parts.map(after).fold(plain, |all, part| all + &part)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Shader;

    #[test]
    fn colours_are_left_out_and_text_stays() {
        let coloured = "\u{1b}[1m\u{1b}[91merror\u{1b}[0m: mine";
        assert_eq!(without_colours(coloured), "error: mine");
        assert_eq!(without_colours("plain text, mine"), "plain text, mine");
    }

    /// The reason why a module does not link.
    fn reason(source: &str) -> String {
        let shader = Shader::new(1).module("package::mine", source);
        shader.link("package::mine").expect_err("a fault").to_string()
    }

    #[test]
    fn messages_are_plain_and_say_what_to_do() {
        let unread = "@compute @workgroup_size(1) fn run() { let = 1; }";
        let unknown = "@compute @workgroup_size(1) fn run() { newest_builtin(1u); }";
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
        crate::conformance::LinkedModule::new("two views", &linked.expect("links"));
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
}
