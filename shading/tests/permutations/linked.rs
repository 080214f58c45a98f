//! Links and validates one permutation.

use std::collections::BTreeSet;

use assign::{Shader, conformance::LinkedModule};

use super::{Flags, LookUp};

/// The properties of a linked and validated shader.
#[derive(Debug, PartialEq)]
pub(crate) struct Linked {
    pub(crate) what: String,
    pub(crate) entry_points: BTreeSet<String>,
    /// Group and binding of the resources that the entry points use.
    pub(crate) bindings: BTreeSet<(u32, u32)>,
    pub(crate) source: String,
}

/// Links and validates a root with some flags on.
pub(crate) fn link(root: &str, flags: &Flags, look_up: Option<LookUp>) -> Linked {
    link_with(root, flags, look_up, |shader| shader)
}

/// As [`link`], with the modules that `mount` adds.
pub(crate) fn link_with(
    root: &str,
    flags: &Flags,
    look_up: Option<LookUp>,
    mount: impl Fn(Shader<'static>) -> Shader<'static>,
) -> Linked {
    let what = format!("{root}, {flags:?}, {:?}", look_up.map(|(name, ..)| name));
    let mut shader = mount(shading::lighting_shader());
    for flag in flags {
        shader = shader.flag(flag, true);
    }
    if let Some((_, wesl, _)) = look_up {
        shader = shader.strategy(wesl);
    }
    let source = shader.link(root).unwrap_or_else(|e| panic!("{what}: {e}"));
    let linked = LinkedModule::new(&what, &source);
    let bindings = linked.used_bindings();
    let entry_points = linked.module().entry_points.iter().map(|e| e.name.clone()).collect();
    Linked { what, entry_points, bindings, source }
}

impl Linked {
    /// The bindings that are used in a group.
    pub(crate) fn used(&self, group: u32) -> Vec<u32> {
        self.bindings.iter().filter(|b| b.0 == group).map(|b| b.1).collect()
    }

    /// Checks a pass over pixels that reads no list: group 1 is unused, and group 2 has `always` and those of
    /// `more` that are on.
    pub(crate) fn check_pixels(&self, always: &[u32], more: &[(u32, bool)]) {
        let more = more.iter().filter(|(_, is_used)| *is_used).map(|&(binding, _)| binding);
        let mut expected: Vec<u32> = always.iter().copied().chain(more).collect();
        expected.sort_unstable();
        assert_eq!(self.used(2), expected, "{}: bindings of group 2", self.what);
        assert_eq!(self.used(1), [0; 0], "{}: group 1 is not bound", self.what);
    }
}
