//! The fog of a view: its grid of froxels, and the images that hold it.

use assign::{Gpu, View, uniform_entry};
use bytemuck::{Pod, Zeroable, bytes_of};
use glam::Vec3;

use crate::ShadingError;

/// Bindings of `layer_fog.wesl` in group 2.
const FOG_BINDING: u32 = 17;
const SUMS_BINDING: u32 = 18;

/// Side of a froxel, pixels.
const FROXEL_PX: u32 = 8;

/// Slices of depth.
const SLICES: u32 = 64;

/// Scattered light, and the share that comes through, in single precision so that images compare bit for bit.
pub(super) const FOG_FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// `layer_fog.wesl`, `struct Fog`. 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct FogRecord {
    /// Froxels along x and y, and slices of depth.
    pub counts: [u32; 3],
    /// The rate at which light decays, per metre.
    pub density: f32,
    /// View depth at which the fog begins, metres.
    pub near_m: f32,
    /// View depth at which it ends, metres.
    pub far_m: f32,
    /// Side of a froxel, pixels.
    pub froxel_px: f32,
    /// Pads to 32 bytes.
    pub unused: u32,
}

impl FogRecord {
    /// The fog of a view, from the near plane to the farthest corner of the scene's box (or the far plane, if that
    /// is nearer).
    pub(super) fn new(density: f32, view: &View, (min, max): (Vec3, Vec3)) -> Self {
        let near_m = view.near_m;
        let scene_m = view.farthest_m(min, max);
        let scene_m = if scene_m.is_finite() { scene_m } else { near_m };
        let end_m = scene_m.min(view.far_m.unwrap_or(f32::INFINITY));
        Self {
            counts: [
                view.viewport.width.div_ceil(FROXEL_PX),
                view.viewport.height.div_ceil(FROXEL_PX),
                SLICES,
            ],
            density,
            near_m,
            far_m: end_m.max(2.0 * near_m).max(near_m + f32::MIN_POSITIVE.sqrt()),
            froxel_px: FROXEL_PX as f32,
            unused: 0,
        }
    }
}

/// A fog with its images.
#[derive(Debug)]
pub(super) struct FogVolume {
    density: f32,
    counts: [u32; 3],
    pub(super) uniform: wgpu::Buffer,
    /// The light that each froxel scatters.
    pub(super) scattered: wgpu::TextureView,
    /// The fog between the eye and each froxel's far end.
    pub(super) sums: wgpu::TextureView,
}

impl FogVolume {
    pub(super) fn new(gpu: &Gpu, density: f32) -> Result<Self, ShadingError> {
        let counts = [1; 3];
        let [scattered, sums] = images(gpu, counts)?;
        let uniform = gpu.uniform("fog", size_of::<FogRecord>() as u64);
        Ok(Self { density, counts, uniform, scattered, sums })
    }

    /// Sizes the images for a view, and uploads the grid.
    pub(super) fn prepare(
        &mut self,
        gpu: &Gpu,
        view: &View,
        surface_bounds: (Vec3, Vec3),
    ) -> Result<(), ShadingError> {
        let record = FogRecord::new(self.density, view, surface_bounds);
        if record.counts != self.counts {
            [self.scattered, self.sums] = images(gpu, record.counts)?;
            self.counts = record.counts;
        }
        gpu.queue.write_buffer(&self.uniform, 0, bytes_of(&record));
        Ok(())
    }

    /// Froxels along x and y, and slices.
    pub(super) fn counts(&self) -> [u32; 3] {
        self.counts
    }

    /// Layout entry of the grid.
    pub(super) fn grid_layout(stages: wgpu::ShaderStages) -> wgpu::BindGroupLayoutEntry {
        uniform_entry(FOG_BINDING, stages)
    }

    /// Bind group entry of the grid.
    pub(super) fn grid_entry(&self) -> wgpu::BindGroupEntry<'_> {
        assign::entry(FOG_BINDING, &self.uniform)
    }

    /// Layout entries of passes that read the sums.
    pub(super) fn layout(stages: wgpu::ShaderStages) -> [wgpu::BindGroupLayoutEntry; 2] {
        [Self::grid_layout(stages), volume_layout(SUMS_BINDING, stages)]
    }

    /// Bind group entries of passes that read the sums.
    pub(super) fn entries(&self) -> [wgpu::BindGroupEntry<'_>; 2] {
        [self.grid_entry(), assign::texture(SUMS_BINDING, &self.sums)]
    }
}

/// Layout entry of a volume that a pass reads.
pub(super) fn volume_layout(
    binding: u32,
    visibility: wgpu::ShaderStages,
) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility,
        ty: wgpu::BindingType::Texture {
            sample_type: assign::UNFILTERED,
            view_dimension: wgpu::TextureViewDimension::D3,
            multisampled: false,
        },
        count: None,
    }
}

/// Layout entry of a volume that a compute pass writes.
pub(super) fn written_volume_layout(binding: u32) -> wgpu::BindGroupLayoutEntry {
    wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::StorageTexture {
            access: wgpu::StorageTextureAccess::WriteOnly,
            format: FOG_FORMAT,
            view_dimension: wgpu::TextureViewDimension::D3,
        },
        count: None,
    }
}

fn images(gpu: &Gpu, counts: [u32; 3]) -> Result<[wgpu::TextureView; 2], ShadingError> {
    let [width, height, depth_or_array_layers] = counts;
    let make = |label| {
        let texture = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: Some(label),
            size: wgpu::Extent3d { width, height, depth_or_array_layers },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D3,
            format: FOG_FORMAT,
            usage: wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::TEXTURE_BINDING,
            view_formats: &[],
        });
        texture.create_view(&wgpu::TextureViewDescriptor::default())
    };
    let limit = gpu.device.limits().max_texture_dimension_3d;
    if width.max(height) > limit {
        let [width, height, limit] = [width, height, limit].map(|side| side * FROXEL_PX);
        return Err(ShadingError::Size { width, height, limit });
    }
    let bytes = counts.iter().map(|count| u64::from(*count)).product::<u64>() * 2 * 16;
    let what = format!("fog of {width}x{height}x{depth_or_array_layers} froxels");
    Ok(gpu.allocate(&what, bytes, || ["scattered fog", "fog sums"].map(make))?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fog_ends_at_the_scene_or_at_the_far_plane() {
        let mut view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 0.1, [65, 48]);
        let bounds = (Vec3::ZERO, Vec3::new(2.0, 3.0, 6.0));
        let fog = FogRecord::new(0.1, &view, bounds);
        assert_eq!((fog.counts, fog.near_m, fog.far_m), ([9, 6, SLICES], 0.1, 7.0));
        view.far_m = Some(5.0);
        assert_eq!(FogRecord::new(0.1, &view, bounds).far_m, 5.0);
        // A scene without surfaces.
        view.far_m = None;
        let nothing = (Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY));
        let fog = FogRecord::new(0.1, &view, nothing);
        assert!(fog.far_m.is_finite() && fog.far_m > fog.near_m, "{fog:?}");
    }
}
