//! Holds a strategy's shader text, which kernels and renderers mount to look lists up.

use crate::{LightReader, Storage};

/// WESL of a strategy: its main module, the modules that this one imports, and the flags that both read.
///
/// [`Shader::strategy`](crate::Shader::strategy) mounts all of it. These modules import modules of the
/// contract, such as `package::view`, which only [`Shader`](crate::Shader) holds. So link with `Shader`; a
/// renderer that makes its own shader modules takes the WGSL from [`Shader::link`](crate::Shader::link).
#[derive(Clone, Copy, Debug)]
pub struct StrategyWesl<'a> {
    /// The main module. It defines `fn group_of(sample: ViewSample) -> u32`.
    pub main: &'a str,
    /// Path and source of each module that the main one imports, without the contract's own. Paths start
    /// with `package::strategy::`, so that they meet no module of a renderer.
    pub imports: &'a [(&'a str, &'a str)],
    /// Name and value of each flag that these modules read with `@if`, without the contract's own (`spots`,
    /// `areas`, `curved`, `hard_cut`, `no_cut`, `specular_reach`, `anywhere`, `multisampled`, `lanes_reserve`, and those of look-ups: `lane_bounds`, `subgroups`, `walk_nodes`, `listed`,
    /// `both_masks`). The renderer must have no flag of the same name.
    pub flags: &'a [(&'a str, bool)],
    /// How a sample's lights are read.
    pub reader: LightReader<'a>,
}

impl StrategyWesl<'_> {
    /// Whether the lanes that cull a group first find its bounds together, from the depth buffer. Then `imports`
    /// has a module `package::strategy::by_lanes` with `bounds_by_lanes(group: u32, lane: u32, lanes: u32) -> GroupBounds`,
    /// which all lanes of the workgroup call, and which reads the depth buffer at binding 2 of bind group 2.
    pub fn finds_bounds_by_lanes(&self) -> bool {
        self.imports.iter().any(|(path, _)| *path == "package::strategy::by_lanes")
    }
}

impl<'a> From<&'a str> for StrategyWesl<'a> {
    /// A main module that imports nothing of its own and reads no flag; its groups have lists.
    fn from(main: &'a str) -> Self {
        Self { main, imports: &[], flags: &[], reader: LightReader::Stored(Storage::Lists) }
    }
}

/// A strategy's WESL, and a promise by its author that every loop in it ends.
#[derive(Clone, Copy, Debug)]
pub struct StrategyModule(StrategyWesl<'static>);

impl StrategyModule {
    /// # Safety
    ///
    /// Every loop must end by itself, whatever the buffers hold: shaders that mount the module do not count
    /// loops ([`Shader::create_uncounted`](crate::Shader::create_uncounted)).
    #[allow(unsafe_code, reason = "the author promises it")]
    pub unsafe fn new(wesl: impl Into<StrategyWesl<'static>>) -> Self {
        Self(wesl.into())
    }

    /// The same with another reader.
    #[must_use]
    pub const fn read_by(self, reader: LightReader<'static>) -> Self {
        Self(StrategyWesl { reader, ..self.0 })
    }

    /// The WESL.
    pub const fn wesl(self) -> StrategyWesl<'static> {
        self.0
    }
}

impl From<StrategyModule> for StrategyWesl<'_> {
    fn from(module: StrategyModule) -> Self {
        module.0
    }
}
