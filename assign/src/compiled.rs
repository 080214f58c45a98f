//! What a device has compiled: one layout, shader module and compute pipeline per distinct input.
//!
//! A search over sizes, or a suite of cases, makes the same strategy many times. Its kernels differ
//! only in uniforms, so the first instance compiles them and the others share them.

use std::{
    collections::HashMap,
    hash::Hash,
    sync::{Mutex, MutexGuard, PoisonError},
};

use crate::{AssignError, Shader};

/// What a compute pipeline is made from. Layouts and modules are equal where they are the same object,
/// so both must come from this store to be found again.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
struct PipelineKey {
    module: wgpu::ShaderModule,
    entry_point: String,
    layouts: Vec<Option<wgpu::BindGroupLayout>>,
    zero_memory: bool,
}

/// What a shader module is made from.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct ModuleKey {
    pub(crate) shader: Shader<'static>,
    pub(crate) root: String,
    pub(crate) counted: bool,
}

/// The store of one device.
#[derive(Debug, Default)]
pub(crate) struct Compiled {
    layouts: Mutex<HashMap<Vec<wgpu::BindGroupLayoutEntry>, wgpu::BindGroupLayout>>,
    modules: Mutex<HashMap<ModuleKey, wgpu::ShaderModule>>,
    pipelines: Mutex<HashMap<PipelineKey, wgpu::ComputePipeline>>,
}

impl Compiled {
    /// The layout of `entries`.
    pub(crate) fn layout(
        &self,
        device: &wgpu::Device,
        label: &str,
        entries: &[wgpu::BindGroupLayoutEntry],
    ) -> wgpu::BindGroupLayout {
        find_or_make(&self.layouts, entries.to_vec(), || {
            device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
                label: Some(label),
                entries,
            })
        })
    }

    /// The module of `key`, which `make` makes where it is new.
    pub(crate) fn module(
        &self,
        key: ModuleKey,
        make: impl FnOnce() -> Result<wgpu::ShaderModule, AssignError>,
    ) -> Result<wgpu::ShaderModule, AssignError> {
        if let Some(known) = lock(&self.modules).get(&key) {
            return Ok(known.clone());
        }
        let made = make()?;
        Ok(find_or_make(&self.modules, key, || made))
    }

    /// The compute pipeline of `entry_point` over bind groups 0, 1, ….
    pub(crate) fn pipeline(
        &self,
        device: &wgpu::Device,
        module: &wgpu::ShaderModule,
        entry_point: &str,
        layouts: &[Option<&wgpu::BindGroupLayout>],
        zero_memory: bool,
    ) -> wgpu::ComputePipeline {
        let make = || {
            let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                label: Some(entry_point),
                bind_group_layouts: layouts,
                immediate_size: 0,
            });
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(entry_point),
                layout: Some(&layout),
                module,
                entry_point: Some(entry_point),
                compilation_options: wgpu::PipelineCompilationOptions {
                    zero_initialize_workgroup_memory: zero_memory,
                    ..Default::default()
                },
                cache: None,
            })
        };
        // Objects from elsewhere would never be found again, and their pipelines never be released.
        let is_known = lock(&self.modules).values().any(|known| known == module) && {
            let known = lock(&self.layouts);
            layouts.iter().flatten().all(|layout| known.values().any(|own| own == *layout))
        };
        if !is_known {
            return make();
        }
        let key = PipelineKey {
            module: module.clone(),
            entry_point: entry_point.to_owned(),
            layouts: layouts.iter().map(|layout| layout.cloned()).collect(),
            zero_memory,
        };
        find_or_make(&self.pipelines, key, make)
    }
}

/// The value of `key`; two threads that make it at once get the same one.
fn find_or_make<K: Eq + Hash, V: Clone>(
    known: &Mutex<HashMap<K, V>>,
    key: K,
    make: impl FnOnce() -> V,
) -> V {
    if let Some(found) = lock(known).get(&key) {
        return found.clone();
    }
    // Compiling takes long: others may look things up meanwhile.
    let made = make();
    lock(known).entry(key).or_insert(made).clone()
}

/// Every value in the store is whole, even where another thread has panicked.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use crate::{Gpu, Shader, storage_entry, uniform_entry};

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
    fn what_is_the_same_is_compiled_once_and_what_differs_is_not_shared() {
        let gpu = Gpu::noop().expect("a noop device");
        let stages = wgpu::ShaderStages::COMPUTE;
        let layout = gpu.bind_group_layout("out", &[storage_entry(0, stages, false)]);
        assert_eq!(layout, gpu.bind_group_layout("again", &[storage_entry(0, stages, false)]));
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
}
