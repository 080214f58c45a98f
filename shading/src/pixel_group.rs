//! Reads the groups of one pixel from the GPU, with the bounds that lights were tested against.

use assign::{
    ALL_LIGHTS, Assignment, Frame, GroupShape, LightReader, Shader, entry, storage_entry,
    uniform_entry,
};
use bytemuck::{Pod, Zeroable, bytes_of, pod_read_unaligned};

use crate::{
    Renderer, ShadingError,
    gbuffer_inputs::GBufferInputs,
    pixel_pass::PixelPass,
    shaders::{LISTS_GROUP, lighting_modules},
};

/// Bindings of `pixel_group.wesl`.
const TEXEL_BINDING: u32 = 8;
const SEEN_BINDING: u32 = 9;

/// A group of a pixel's sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PixelGroup {
    /// The group; [`ALL_LIGHTS`] outside all groups.
    pub group: u32,
    /// What lights were tested against; `None` if the strategy keeps no bounds ([`Lookup::shape`](assign::Lookup::shape)), and for
    /// [`ALL_LIGHTS`].
    pub bounds: Option<GroupVolume>,
}

/// The volume against which lights were tested, before the driver widens it by what rounding moves a sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GroupVolume {
    /// A pixel rectangle and a range of view depths.
    Frustum {
        /// Lower left corner, normalised device coordinates: x right, y up.
        ndc_min: [f32; 2],
        /// Upper right corner.
        ndc_max: [f32; 2],
        /// View depth range, metres; 3.4e38 has no far plane.
        depth_m: [f32; 2],
        /// A bit for each of the 32 slices of that range that holds samples, if the strategy has such.
        slices: Option<u32>,
    },
    /// A box along the world's axes.
    Box {
        /// Lower corner, world space, metres. In a box without samples it lies above the upper one.
        min_world: [f32; 3],
        /// Upper corner, world space, metres.
        max_world: [f32; 3],
    },
    /// A box along axes of its own.
    OrientedBox {
        /// Centre, world space, metres.
        center_world: [f32; 3],
        /// Orthonormal axes, world space.
        axes: [[f32; 3]; 3],
        /// Half the size along each axis, metres.
        half_extents_m: [f32; 3],
    },
}

/// `struct PixelGroups` of `pixel_group.wesl`. 176 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct PixelGroupsRecord {
    /// 1 if the pixel shows a surface.
    pub is_surface: u32,
    /// The sample's group.
    pub group: u32,
    /// Its other group.
    pub second: u32,
    /// The slices of the first group's bounds that hold samples.
    pub depth_mask: u32,
    /// The bounds of both groups, five vectors each.
    pub bounds: [[f32; 4]; 10],
}

/// The groups of a pixel's sample: one, or two if the strategy intersects two
/// ([`LightReader::BothMasks`]); empty if the pixel shows no surface. Blocks.
///
/// `pixel` counts from the upper left corner of the viewport. Depth, normals and model ids are those of the last
/// recorded geometry passes: see [`record_for_probe`](crate::record_for_probe).
pub fn groups_of_pixel(
    renderer: &Renderer,
    strategy: &dyn Assignment,
    frame: &Frame<'_>,
    pixel: [u32; 2],
) -> Result<Vec<PixelGroup>, ShadingError> {
    let gpu = &renderer.gpu;
    let viewport = frame.view.viewport;
    let lookup = strategy.lookup();
    let has_second = lookup.module.wesl().reader == LightReader::BothMasks;
    let texel = gpu.uniform("asked texel", 16);
    let asked = [viewport.x + pixel[0], viewport.y + pixel[1], pixel[0], pixel[1]];
    gpu.queue.write_buffer(&texel, 0, bytes_of(&asked));
    let bytes = size_of::<PixelGroupsRecord>() as u64;
    let seen = gpu.storage("groups of a pixel", bytes)?;
    let stages = wgpu::ShaderStages::COMPUTE;
    let pass = PixelPass {
        name: "pixel_group",
        entry_point: "find_groups",
        shader: bounds_flags(lighting_modules(LISTS_GROUP), lookup.shape)
            .flag("second_group", has_second),
        images: GBufferInputs::of_sample(strategy.needs().models),
        layout: vec![
            uniform_entry(TEXEL_BINDING, stages),
            storage_entry(SEEN_BINDING, stages, false),
        ],
        resources: vec![entry(TEXEL_BINDING, &texel), entry(SEEN_BINDING, &seen)],
        strategy: Some(strategy),
        is_alone: false,
        bounds: lookup.shape,
    };
    pass.submit(renderer, viewport)?;
    let record: PixelGroupsRecord = pod_read_unaligned(&gpu.read(&seen, bytes)?);
    if record.is_surface == 0 {
        return Ok(Vec::new());
    }
    let groups = [record.group, record.second];
    let found = groups.iter().zip(record.bounds.chunks(5)).map(|(&group, bounds)| PixelGroup {
        group,
        bounds: lookup
            .shape
            .filter(|_| group != ALL_LIGHTS)
            .map(|shape| volume_of(shape, bounds, record.depth_mask)),
    });
    Ok(found.take(if has_second { 2 } else { 1 }).collect())
}

/// Sets the flags that compile the reading of bounds.
fn bounds_flags<'a>(shader: Shader<'a>, shape: Option<GroupShape>) -> Shader<'a> {
    let is_frustum = matches!(shape, Some(GroupShape::Frustum | GroupShape::MaskedFrustum));
    shader
        .flag("frustum_bounds", is_frustum)
        .flag("box_bounds", shape == Some(GroupShape::Box))
        .flag("oriented_bounds", shape == Some(GroupShape::OrientedBox))
        .flag("masked_bounds", shape == Some(GroupShape::MaskedFrustum))
}

/// The bounds that the shader wrote as vectors.
fn volume_of(shape: GroupShape, words: &[[f32; 4]], depth_mask: u32) -> GroupVolume {
    let vector = |ix: usize| [words[ix][0], words[ix][1], words[ix][2]];
    match shape {
        GroupShape::Frustum | GroupShape::MaskedFrustum => GroupVolume::Frustum {
            ndc_min: [words[0][0], words[0][1]],
            ndc_max: [words[0][2], words[0][3]],
            depth_m: [words[1][0], words[1][1]],
            slices: (shape == GroupShape::MaskedFrustum).then_some(depth_mask),
        },
        GroupShape::Box => GroupVolume::Box { min_world: vector(0), max_world: vector(1) },
        GroupShape::OrientedBox => GroupVolume::OrientedBox {
            center_world: vector(0),
            axes: [vector(1), vector(2), vector(3)],
            half_extents_m: vector(4),
        },
    }
}
