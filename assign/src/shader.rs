//! Linking WESL modules to WGSL.

use std::borrow::Cow;

use wesl::{
    CompileOptions, CompileResult, Feature, ManglerKind, SyntaxUtil, VirtualResolver, Wesl,
};

use crate::{
    AssignError, Gpu, GroupShape, LightKinds, LightReader, Slots, Storage, StrategyWesl,
    compiled::ModuleKey,
    hitches::Counted,
    light_reader::BOUNDS_BOX_WESL,
    link_errors,
    plain_wgsl::{self, PrefixMangler},
};

/// The root module of a look-up's plain text.
const PLAIN_ROOT: &str = "package::plain";

/// A set of WESL modules and flags, and the bind group from which shaders read lists. It is linked
/// to WGSL.
///
/// It starts with the contract's modules: `package::view`, `package::sample`, `package::lights`,
/// `package::volume`, `package::window`, `package::specular_reach`, `package::lists`, `package::look_up` and, for kernels that make
/// lists, `package::keys` and `package::reserve`.
#[derive(Clone, Debug)]
pub struct Shader<'a> {
    modules: Vec<(String, Cow<'a, str>)>,
    flags: Vec<(String, bool)>,
    /// The flags of the mounted strategy.
    strategy_flags: &'a [(&'a str, bool)],
}

impl<'a> Shader<'a> {
    /// The contract's modules, which read lists from bind group `lists_group`. These flags start
    /// off:
    ///
    /// - `lanes_reserve`: with it, every lane of workgroups of 256 may reserve a list at once
    ///   (`package::reserve`); without it, one lane per workgroup.
    /// - `hard_cut`: with it, lights end at their range without a window (`package::window`).
    /// - `no_cut`: with it, lights do not end, though lists do: every strategy that culls loses light.
    /// - `specular_reach`: with it, specular terms reach beyond a light's range (`package::specular_reach`), and lists
    ///   must too.
    /// - `anywhere`: [`looks_up_anywhere`](Self::looks_up_anywhere) sets it.
    /// - `multisampled`: with it, kernels that find groups read a depth buffer of several samples per pixel.
    pub fn new(lists_group: u32) -> Self {
        let slots = format!("const LISTS_GROUP: u32 = {lists_group}u;\n");
        let empty = Self { modules: Vec::new(), flags: Vec::new(), strategy_flags: &[] };
        empty
            .reader(LightReader::Stored(Storage::Lists))
            .module("package::slots", slots)
            .module("package::view", include_str!("shaders/view.wesl"))
            .module("package::sample", include_str!("shaders/sample.wesl"))
            .module("package::lights", include_str!("shaders/lights.wesl"))
            .module("package::volume", include_str!("shaders/volume.wesl"))
            .module("package::stochastic", include_str!("shaders/stochastic.wesl"))
            .module("package::window", include_str!("shaders/window.wesl"))
            .module("package::specular_reach", include_str!("shaders/specular_reach.wesl"))
            .module("package::keys", include_str!("shaders/keys.wesl"))
            .module("package::lists", include_str!("shaders/lists.wesl"))
            .module("package::depth_slices", include_str!("shaders/depth_slices.wesl"))
            .module("package::tree_depths", include_str!("shaders/tree_depths.wesl"))
            .module("package::reserve", include_str!("shaders/reserve.wesl"))
            .flag("lanes_reserve", false)
            .flag("hard_cut", false)
            .flag("no_cut", false)
            .flag("specular_reach", false)
            .flag("anywhere", false)
            .flag("multisampled", false)
            .light_kinds(LightKinds::default())
    }

    /// Compiles the code for lights of these kinds.
    pub fn light_kinds(self, kinds: LightKinds) -> Self {
        let shader = self.flag("spots", kinds.spots).flag("areas", kinds.areas);
        shader.flag("curved", kinds.areas && kinds.curved)
    }

    /// Adds or replaces a module.
    pub fn module(mut self, path: &str, source: impl Into<Cow<'a, str>>) -> Self {
        self.modules.retain(|(known, _)| known != path);
        self.modules.push((path.to_owned(), source.into()));
        self
    }

    /// Mounts a strategy: its modules, the main one as `package::strategy`; `package::look_up`, which reads
    /// a sample's lights; and its flags. Linking fails
    /// if [`flag`](Self::flag) sets one of these flags too, before or after.
    pub fn strategy(self, wesl: impl Into<StrategyWesl<'a>>) -> Self {
        let StrategyWesl { main, imports, flags, reader } = wesl.into();
        let shader = self.module("package::strategy", main).reader(reader);
        let shader = Self { strategy_flags: flags, ..shader };
        imports.iter().fold(shader, |shader, (path, source)| shader.module(path, *source))
    }

    /// Mounts what reads the lights of a sample.
    fn reader(self, reader: LightReader<'a>) -> Self {
        let modules = reader.modules().into_iter();
        let shader = modules.fold(self, |shader, (path, source)| shader.module(path, source));
        reader.flags().into_iter().fold(shader, |shader, (name, value)| shader.flag(name, value))
    }

    /// Mounts `package::bounds` for groups of a shape, so that the shader can call `group_bounds` of a strategy's
    /// module ([`Lookup::shape`](crate::Lookup::shape)). No test of lights against bounds is compiled. Call it
    /// after [`strategy`](Self::strategy).
    pub fn group_bounds(self, shape: GroupShape) -> Self {
        let bounds = match shape {
            GroupShape::Frustum | GroupShape::MaskedFrustum => {
                include_str!("shaders/bounds_frustum.wesl")
            }
            GroupShape::Box => BOUNDS_BOX_WESL,
            GroupShape::OrientedBox => include_str!("shaders/bounds_oriented_box.wesl"),
        };
        let tests = ["hs", "sat_e", "sat_n", "sat_p", "sat_v", "rect"];
        let shader = self
            .module("package::bounds", bounds)
            .flag("lane_bounds", false)
            .flag("depth_mask", shape == GroupShape::MaskedFrustum);
        tests.into_iter().fold(shader, |shader, test| shader.flag(test, false))
    }

    /// Has each lane look lights up for itself. Call it after [`strategy`](Self::strategy) for fragment shaders:
    /// some of their lanes are helpers, which may run without taking part in subgroup operations.
    pub fn without_subgroups(self) -> Self {
        self.flag("subgroups", false)
    }

    /// Has look-ups ask whether their group's list serves them, and read all lights if not. Shaders need it that look
    /// lists up at other samples than those in the depth buffer ([`SampleDomain`](crate::SampleDomain)). Without it,
    /// look-ups cost nothing more; one in a group without samples still reads all lights.
    pub fn looks_up_anywhere(self) -> Self {
        self.flag("anywhere", true)
    }

    /// Sets a flag that `@if` reads. Linking fails if a module reads a flag that is not set.
    pub fn flag(mut self, name: &str, value: bool) -> Self {
        self.flags.retain(|(known, _)| known != name);
        self.flags.push((name.to_owned(), value));
        self
    }

    /// The flags of the renderer and of the strategy.
    fn all_flags(&self) -> Vec<(String, bool)> {
        let strategy = self.strategy_flags.iter().map(|&(name, value)| (name.to_owned(), value));
        self.flags.iter().cloned().chain(strategy).collect()
    }

    /// Links `root` and everything that it imports. Keeps all its entry points.
    ///
    /// # Errors
    ///
    /// [`AssignError::Shader`] if a module does not parse, lacks something or has no entry point.
    pub fn link(&self, root: &str) -> Result<String, AssignError> {
        let linked = self.compile(root, None, None)?;
        if linked.syntax.entry_points().next().is_none() {
            return Err(AssignError::Shader {
                module: root.to_owned(),
                reason: "it has no entry point, so nothing of it is kept: add one, or take a look-up's text from Lookup::wgsl".into(),
            });
        }
        Ok(linked.to_string())
    }

    /// The mounted strategy's look-up as plain WGSL, as [`Lookup::wgsl`](crate::Lookup::wgsl) returns it, compiled for the
    /// [kinds of lights](Self::light_kinds) of this shader. It uses subgroup operations if the look-up has any, unless
    /// [`without_subgroups`](Self::without_subgroups) was called.
    ///
    /// # Errors
    ///
    /// As [`Lookup::wgsl`](crate::Lookup::wgsl). [`AssignError::Shader`] also if no strategy is mounted.
    pub fn wgsl(&self, slots: &Slots<'_>) -> Result<String, AssignError> {
        slots.check()?;
        let is_on = |name: &str| self.flags.iter().any(|(known, value)| known == name && *value);
        let root = plain_wgsl::root_module(is_on("spots") || is_on("areas"));
        let shader = self.clone().module(PLAIN_ROOT, root);
        let keep = Some(vec![plain_wgsl::KEPT.to_owned()]);
        let mut linked = shader.compile(PLAIN_ROOT, keep, Some(slots.prefix))?;
        plain_wgsl::place(&mut linked.syntax, slots)
            .map_err(|reason| AssignError::Shader { module: "package::look_up".into(), reason })?;
        Ok(linked.to_string())
    }

    /// Links `root` and what it imports. `keep` names the declarations to keep; `None` keeps all entry points. All but
    /// those of `root` get the prefix.
    fn compile(
        &self,
        root: &str,
        keep: Option<Vec<String>>,
        prefix: Option<&str>,
    ) -> Result<CompileResult, AssignError> {
        let fail = |reason: String| AssignError::Shader { module: root.to_owned(), reason };
        let is_taken = |name: &str| self.flags.iter().any(|(known, _)| known == name);
        if let Some((name, _)) = self.strategy_flags.iter().find(|(name, _)| is_taken(name)) {
            return Err(fail(format!(
                "flag {name:?} is set by the strategy and by the renderer: give the renderer's another name"
            )));
        }
        let mut resolver = VirtualResolver::new();
        for (path, source) in &self.modules {
            let path = path.parse().map_err(|e| fail(format!("module path {path}: {e:?}")))?;
            resolver.add_module(path, Cow::Borrowed(source.as_ref()));
        }
        let mut compiler = Wesl::new_barebones().set_custom_resolver(resolver);
        let mut options = CompileOptions { keep, ..CompileOptions::default() };
        options.features.default = Feature::Error;
        compiler.set_options(options);
        for (name, value) in self.all_flags() {
            compiler.set_feature(&name, value);
        }
        if let Some(prefix) = prefix {
            compiler.set_custom_mangler(PrefixMangler(prefix.to_owned()));
        }
        compiler.use_sourcemap(true);
        let root = root.parse().map_err(|e| fail(format!("module path: {e:?}")))?;
        let mut linked = compiler.compile(&root);
        // If two modules declare one name, all names get the path of their module.
        if prefix.is_none() && linked.as_ref().is_err_and(link_errors::is_clash) {
            linked = compiler.set_mangler(ManglerKind::Escape).compile(&root);
        }
        linked.map_err(|e| fail(link_errors::words(&e)))
    }

    /// Links `root` and makes a shader module from it, once per device. The GPU checks every index.
    /// On Vulkan, Metal and DX12 it also counts loop rounds, so that no loop is endless.
    pub fn create(&self, gpu: &Gpu, root: &str) -> Result<wgpu::ShaderModule, AssignError> {
        self.make_module(gpu, root, true, |descriptor| gpu.device.create_shader_module(descriptor))
    }

    /// As [`create`](Self::create), but without loop counters. Counters prevent unrolling: on an
    /// H200 they made the passes `bounds` and `shade` of SC-E/48x48x40 27 % and 9 % slower, and
    /// `cull` of SC-E/48x48x40/bvh 19 %.
    ///
    /// # Safety
    ///
    /// Every loop of `root` and of its imports must end by itself, whatever the buffers hold. An
    /// endless loop is undefined behaviour in the driver.
    #[allow(unsafe_code, reason = "the one way to a module without loop counters")]
    pub unsafe fn create_uncounted(
        &self,
        gpu: &Gpu,
        root: &str,
    ) -> Result<wgpu::ShaderModule, AssignError> {
        let checks = wgpu::ShaderRuntimeChecks {
            force_loop_bounding: false,
            ..wgpu::ShaderRuntimeChecks::checked()
        };
        self.make_module(gpu, root, false, |descriptor| {
            // SAFETY: only loop counters are omitted, and the caller guarantees that the loops end.
            unsafe { gpu.device.create_shader_module_trusted(descriptor, checks) }
        })
    }

    fn make_module(
        &self,
        gpu: &Gpu,
        root: &str,
        counted: bool,
        make: impl FnOnce(wgpu::ShaderModuleDescriptor<'_>) -> wgpu::ShaderModule,
    ) -> Result<wgpu::ShaderModule, AssignError> {
        let modules = self.modules.iter();
        let key = ModuleKey {
            modules: modules.map(|(path, source)| (path.clone(), source.to_string())).collect(),
            flags: self.all_flags(),
            root: root.to_owned(),
            counted,
        };
        gpu.compiled.module(key, || {
            let source = self.link(root)?;
            Counted::add(&gpu.counted.modules, 1);
            let descriptor = wgpu::ShaderModuleDescriptor {
                label: Some(root),
                source: wgpu::ShaderSource::Wgsl(source.into()),
            };
            match gpu.scoped(wgpu::ErrorFilter::Validation, || make(descriptor)) {
                (module, None) => Ok(module),
                (_, Some(error)) => {
                    Err(AssignError::Shader { module: root.to_owned(), reason: error.to_string() })
                }
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use crate::{Gpu, Shader, StrategyWesl, storage_entry, uniform_entry};

    fn shader(constant: u32) -> Shader<'static> {
        let source = format!(
            "const N: u32 = {constant}u;
             @group(0) @binding(0) var<storage, read_write> out: array<u32>;
             @compute @workgroup_size(64) fn one() {{ out[0] = N; }}
             @compute @workgroup_size(64) fn two() {{ out[1] = N; }}"
        );
        Shader::new(1).module("package::root", source)
    }

    #[test]
    fn equal_inputs_are_compiled_once_and_different_ones_are_not_shared() {
        let gpu = Gpu::noop().expect("a noop device");
        let stages = wgpu::ShaderStages::COMPUTE;
        let layout = gpu.bind_group_layout("out", &[storage_entry(0, stages, false)]);
        assert_eq!(layout, gpu.bind_group_layout("same", &[storage_entry(0, stages, false)]));
        let wider = [storage_entry(0, stages, false), uniform_entry(1, stages)];
        let wider = gpu.bind_group_layout("wider", &wider);
        assert_ne!(layout, wider);

        let make =
            |gpu: &Gpu, constant| shader(constant).create(gpu, "package::root").expect("links");
        let module = make(&gpu, 1);
        assert_eq!(module, make(&gpu, 1));
        assert_ne!(module, make(&gpu, 2));
        assert_ne!(
            module,
            shader(1).flag("other", true).create(&gpu, "package::root").expect("links")
        );
        #[allow(unsafe_code, reason = "it has no loop")]
        // SAFETY: it has no loop.
        let uncounted = unsafe { shader(1).create_uncounted(&gpu, "package::root") };
        assert_ne!(module, uncounted.expect("links"));

        let pipeline = |module: &_, entry_point, layout: &_, zero| {
            gpu.compute_pipeline(module, entry_point, &[Some(layout)], zero)
        };
        let one = pipeline(&module, "one", &layout, true);
        assert_eq!(one, pipeline(&module, "one", &layout, true));
        assert_ne!(one, pipeline(&module, "two", &layout, true));
        assert_ne!(one, pipeline(&module, "one", &wider, true));
        assert_ne!(one, pipeline(&module, "one", &layout, false));
        assert_ne!(one, pipeline(&make(&gpu, 2), "one", &layout, true));
    }

    #[test]
    fn a_flag_of_both_strategy_and_renderer_is_an_error() {
        const ON: &[(&str, bool)] = &[("glossy", true)];
        const OFF: &[(&str, bool)] = &[("glossy", false)];
        const ROOT: &str = "import package::strategy::GLOSSY;
            @compute @workgroup_size(GLOSSY) fn run() {}";
        let main = "@if(glossy) const GLOSSY: u32 = 2u; @if(!glossy) const GLOSSY: u32 = 1u;";
        let strategy = |flags| StrategyWesl { flags, ..main.into() };
        let shader = Shader::new(1).module("package::root", ROOT);
        let link = |shader: Shader<'_>| shader.link("package::root").map_err(|e| e.to_string());
        let [on, off] = [ON, OFF].map(|flags| link(shader.clone().strategy(strategy(flags))));
        assert_ne!(on.expect("links"), off.expect("links"), "the strategy reads its flag");
        let before = shader.clone().flag("glossy", false).strategy(strategy(ON));
        let after = shader.strategy(strategy(ON)).flag("glossy", false);
        for clash in [before, after] {
            let error = link(clash).expect_err("both set a flag");
            assert!(error.contains("flag \"glossy\" is set by the strategy and by"), "{error}");
        }
    }
}
