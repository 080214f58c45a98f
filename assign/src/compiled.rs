//! A store of what a device has compiled: one layout, shader module and compute pipeline per
//! distinct input.
//!
//! A search over sizes, or a suite of cases, makes the same strategy many times. The instances'
//! kernels differ only in uniforms, so the first instance compiles them and the others share them.

use std::{
    collections::HashMap,
    hash::Hash,
    sync::{Mutex, MutexGuard, PoisonError},
};

use crate::{AssignError, hitches::Counted};

/// What a compute pipeline is made from. Two layouts or modules are equal only if they are the same
/// object, so the store finds a pipeline again only if both come from this store.
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
    /// Path and source of every WESL module.
    pub(crate) modules: Vec<(String, String)>,
    /// Name and value of every flag.
    pub(crate) flags: Vec<(String, bool)>,
    /// Path of the module that is linked.
    pub(crate) root: String,
    /// Whether its loops are counted.
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

    /// The module of `key`. `make` makes it if the store does not hold it.
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
        (device, counted): (&wgpu::Device, &Counted),
        module: &wgpu::ShaderModule,
        entry_point: &str,
        layouts: &[Option<&wgpu::BindGroupLayout>],
        zero_memory: bool,
    ) -> wgpu::ComputePipeline {
        let make = || {
            Counted::add(&counted.pipelines, 1);
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
        // The store would never find objects from elsewhere again, and would never release their
        // pipelines.
        let is_known = lock(&self.modules).values().any(|known| known == module) && {
            let known = lock(&self.layouts);
            layouts.iter().flatten().all(|layout| known.values().any(|stored| stored == *layout))
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

/// The value of `key`. Two threads that make it at the same time get the same one.
fn find_or_make<K: Eq + Hash, V: Clone>(
    known: &Mutex<HashMap<K, V>>,
    key: K,
    make: impl FnOnce() -> V,
) -> V {
    if let Some(found) = lock(known).get(&key) {
        return found.clone();
    }
    // Compiling takes long, so the lock stays open for other threads.
    let made = make();
    lock(known).entry(key).or_insert(made).clone()
}

/// Every value in the store is whole, even after a panic of another thread.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
