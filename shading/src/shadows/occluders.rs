//! What hides lights from whole groups of samples: a pyramid of the farthest depths of all shadow maps, and the test that
//! reads it.
//!
//! # The idea
//!
//! A light is left out of a group's list if every look-up of `shadow.wesl` from the group finds only shadow. The test
//! (`occlusion.wesl`) bounds the group by a box along the light's axes. For each face of a map, it finds the least depth
//! at which a sample may lie and the rectangle of texels that look-ups may read. If even the farthest depth in the
//! rectangle is nearer than this, all samples lie behind (hierarchical depth, Greene, Kass and Miller 1993, seen from the
//! light). A light with several maps is hidden if all of them hide the group.
//!
//! Level `n` of the pyramid holds the farthest depth of blocks of `2^(n+1)` texels. So a rectangle of any size takes at
//! most 4 x 4 texels of one level.
//!
//! # The bounds of a look-up
//!
//! A look-up moves the sample along its normal before it projects it ([offsets](super)). Let `d` be the sample's depth along
//! the face's axis, `t` its tangents across it, `r` the distance from a sample to the farthest texel centre that is read, as
//! a tangent, and `a` and `s` the cosine and the sine between normal and axis. The offset `d r s / (1 - r s a)` gives
//!
//! ```text
//! depth'    = d / (1 - r s a)                        >= d / (1 + r / 2)      because |s a| <= 1/2
//! tangents' = t + r s (n - a t)                      within r (1 + sqrt(1 + T^2)) / 2 of t, per axis, for |t| <= T
//! ```
//!
//! with `n <= s` the normal's part across the axis: `s^2 + s |a| T` has this maximum. `T` is 1 for faces of a cube, and the
//! tangent of the half angle for a cone. So the rectangle grows by `0.85 (taps + 0.01)` texels on each side (1.06 at the
//! widest cone) plus the filter, and the compared depth shrinks by `r / 2`: 0.6 % at 128 texels without a filter.
//!
//! Samples on a face are those for which its axis is the longest. So a box that spans several faces is cut at their common
//! planes, and all faces that it touches must hide it. Samples outside the light's ball add nothing, so the box is also cut
//! at the ball's sides. A box that holds the light's point is never hidden.
//!
//! # Where it fails
//!
//! A map sees only texel centres. A gap that no centre falls into is seen by a ray, but the map shows shadow, with lists of
//! all lights too. And a long group, such as a tile from the near plane to the far one, reaches around what hides it.

use assign::{
    Gpu, Occluders, OcclusionTest, Passes, Shader, entry, texture, texture_entry, uniform_entry,
};

use crate::ShadingError;

/// The test of whether shadow maps hide a light from a group: [`CullSettings::occlusion`](assign::CullSettings) of strategies
/// whose frames come from [`Renderer::frame`](crate::Renderer::frame), after
/// [`Renderer::find_occluders`](crate::Renderer::find_occluders).
pub const OCCLUSION_TEST: OcclusionTest = {
    // SAFETY: loops count up to the number of maps of a light, and over at most 4 x 4 texels.
    #[allow(unsafe_code, reason = "its loops end")]
    unsafe {
        OcclusionTest::new(include_str!("../shaders/occlusion.wesl"), &[PYRAMID])
    }
};

/// Path and source of the module that says where levels lie.
const PYRAMID: (&str, &str) = ("package::pyramid", include_str!("../shaders/pyramid.wesl"));

/// Which depth of a block of texels stands for it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OccluderDepth {
    /// The farthest one. Lists lose no light.
    #[default]
    Farthest,
    /// **A flaw that loses lights**, to show that tests find it: the nearest one.
    Nearest,
}

/// The pyramid over an atlas: all levels in one texture.
#[derive(Debug)]
pub(crate) struct Pyramid {
    depths: wgpu::TextureView,
    pipeline: wgpu::ComputePipeline,
    /// For each level, what its kernel reads and writes, and its size, texels.
    levels: Vec<(wgpu::BindGroup, [u32; 2])>,
    bytes: u64,
}

/// Format of depths.
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::R32Float;
/// Texels on a side of a workgroup of `farthest.wesl`.
const SIDE: u32 = 8;

impl Pyramid {
    /// Allocates it for an atlas of even width and height, texels.
    ///
    /// # Errors
    ///
    /// [`AssignError::OutOfMemory`].
    pub(super) fn new(
        gpu: &Gpu,
        atlas: &wgpu::TextureView,
        atlas_px: [u32; 2],
        kept: OccluderDepth,
    ) -> Result<Self, ShadingError> {
        let base = atlas_px.map(|side| side / 2);
        let [width, height] = texture_size(base);
        let bytes = 4 * u64::from(width) * u64::from(height);
        let made = gpu.allocate("farthest depths of shadow maps", bytes, || {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("farthest depths of shadow maps"),
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format: FORMAT,
                usage: wgpu::TextureUsages::STORAGE_BINDING | wgpu::TextureUsages::TEXTURE_BINDING,
                view_formats: &[],
            })
        })?;
        let depths = made.create_view(&wgpu::TextureViewDescriptor::default());
        let stages = wgpu::ShaderStages::COMPUTE;
        let written = wgpu::BindGroupLayoutEntry {
            binding: 1,
            visibility: stages,
            ty: wgpu::BindingType::StorageTexture {
                access: wgpu::StorageTextureAccess::ReadWrite,
                format: FORMAT,
                view_dimension: wgpu::TextureViewDimension::D2,
            },
            count: None,
        };
        let read = texture_entry(0, stages, wgpu::TextureSampleType::Depth);
        let entries = [read, written, uniform_entry(2, stages)];
        let layout = gpu.bind_group_layout("farthest depths", &entries);
        let module = shader(kept).create(gpu, "package::farthest")?;
        let pipeline = gpu.compute_pipeline(&module, "halve", &[Some(&layout)], false);
        let levels = (0..).zip(level_sizes(base)).map(|(level, size)| {
            let uniform = gpu.uniform("level of farthest depths", 16);
            gpu.queue.write_buffer(&uniform, 0, bytemuck::bytes_of(&[level, 0_u32, 0, 0]));
            let entries = [texture(0, atlas), texture(1, &depths), entry(2, &uniform)];
            (gpu.bind_group("farthest depths", &layout, &entries), size)
        });
        let levels = levels.collect();
        Ok(Self { pipeline, levels, bytes, depths })
    }

    /// Records the pass `occluders`, which fills it from the atlas.
    pub(super) fn record(&self, passes: &mut dyn Passes) {
        passes.compute("occluders", &mut |pass| {
            pass.set_pipeline(&self.pipeline);
            for (group, [width, height]) in &self.levels {
                pass.set_bind_group(0, group, &[]);
                pass.dispatch_workgroups(width.div_ceil(SIDE), height.div_ceil(SIDE), 1);
            }
        });
    }

    /// What frames hand to strategies.
    pub(super) fn occluders<'a>(&'a self, records: &'a wgpu::Buffer) -> Occluders<'a> {
        Occluders { depths: &self.depths, records }
    }

    /// Bytes on the GPU.
    pub(super) fn bytes(&self) -> u64 {
        self.bytes
    }
}

/// Width and height of each level, texels, down to one row or column. A rectangle in a face of `px` texels needs at most
/// floor(log2 px) levels, and the atlas is at least as long as a face.
fn level_sizes(base: [u32; 2]) -> impl Iterator<Item = [u32; 2]> {
    let halve = |size: &[u32; 2]| Some(size.map(|side| side / 2));
    std::iter::successors(Some(base), halve).take_while(|size| !size.contains(&0))
}

/// Width and height of the texture that holds all levels (`pyramid.wesl`).
fn texture_size([width, height]: [u32; 2]) -> [u32; 2] {
    [width + width / 2, height]
}

fn shader(kept: OccluderDepth) -> Shader<'static> {
    Shader::new(1)
        .module("package::farthest", include_str!("../shaders/farthest.wesl"))
        .module(PYRAMID.0, PYRAMID.1)
        .flag("keeps_nearest", kept == OccluderDepth::Nearest)
}

#[cfg(test)]
mod tests;
