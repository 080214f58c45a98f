//! The buffers that rays read, for a renderer that binds them inside its own bind group.

use assign::{AssignError, Shader, entry, storage_entry, uniform_entry};

use crate::{DeepImageSettings, DeepImages, RAY_CAST_WESL, Storage};

/// What rays through finished deep images read. Clones share the buffers.
#[derive(Clone, Debug)]
pub struct RayBuffers {
    settings: DeepImageSettings,
    images: wgpu::Buffer,
    frames: wgpu::Buffer,
    starts: wgpu::Buffer,
    depths: wgpu::Buffer,
}

/// Bindings of `ray_cast.wesl` after the first. Between them lie the counters, which `segment.wesl` does not read.
const FRAMES: u32 = 1;
const STARTS: u32 = 3;
const DEPTHS: u32 = 4;

impl RayBuffers {
    /// The settings of the images.
    pub fn settings(&self) -> &DeepImageSettings {
        &self.settings
    }

    /// Layout entries from the binding `first`: a uniform and three storage buffers.
    pub fn layout(first: u32, stages: wgpu::ShaderStages) -> [wgpu::BindGroupLayoutEntry; 4] {
        let storage = |at| storage_entry(first + at, stages, true);
        [uniform_entry(first, stages), storage(FRAMES), storage(STARTS), storage(DEPTHS)]
    }

    /// Bind group entries from the binding `first`.
    pub fn entries(&self, first: u32) -> [wgpu::BindGroupEntry<'_>; 4] {
        [
            entry(first, &self.images),
            entry(first + FRAMES, &self.frames),
            entry(first + STARTS, &self.starts),
            entry(first + DEPTHS, &self.depths),
        ]
    }
}

impl DeepImages {
    /// What rays read, for [`mount_at`](Self::mount_at). It holds until the next [`prepare`](Self::prepare).
    ///
    /// # Errors
    ///
    /// [`AssignError::Missing`] if the counters of the newest build have not come back, or say that something did not
    /// fit: [`settle`](Self::settle) them. [`AssignError::Parameter`] for [`Storage::LinkedLists`].
    pub fn ray_buffers(&self) -> Result<RayBuffers, AssignError> {
        if self.settings.storage != Storage::Arrays {
            return Err(AssignError::Parameter {
                field: "storage of deep images".into(),
                value: format!("{:?}", self.settings.storage),
                accepted: format!("{:?}: rays search sorted lists", Storage::Arrays),
            });
        }
        if self.is_complete() != Some(true) {
            return Err(AssignError::Missing {
                strategy: "rays through deep images".into(),
                missing: "deep images that are settled",
            });
        }
        let Self { settings, uniform, buffers, .. } = self;
        Ok(RayBuffers {
            settings: *settings,
            images: uniform.clone(),
            frames: buffers.frames.clone(),
            starts: buffers.offsets.clone(),
            depths: buffers.fragments.clone(),
        })
    }

    /// [`mount`](Self::mount), for bindings from `first` on in a bind group of the renderer.
    pub fn mount_at<'a>(
        settings: &DeepImageSettings,
        shader: Shader<'a>,
        (group, first): (u32, u32),
    ) -> Shader<'a> {
        let slots = format!("const RAY_GROUP: u32 = {group}u;\nconst RAY_FIRST: u32 = {first}u;\n");
        let shader = shader
            .module("package::ray_slots", slots)
            .module("package::deep_images", include_str!("../shaders/deep_images.wesl"))
            .module("package::ray_cast", RAY_CAST_WESL)
            .module("package::segment", include_str!("../shaders/segment.wesl"))
            .flag("linked", settings.storage == Storage::LinkedLists);
        settings.directions.mount(shader)
    }
}
