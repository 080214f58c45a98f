//! The reflective shadow map that VPLs come from.

use assign::{AssignError, Light, LightShape, Projection, SpotRamp, View};
use bytemuck::{Pod, Zeroable};

/// The most texels along a side of a map. 65,535 workgroups then have a thread for every index.
pub const MAX_RSM_SIDE: u32 = 2048;

/// Number of levels of the largest map.
const LEVELS: usize = 12;

/// A scene as a spot sees it: a G-buffer drawn from the light's view.
#[derive(Clone, Copy, Debug)]
pub struct Rsm<'a> {
    /// Depth, mapped as the view says.
    pub depth: &'a wgpu::TextureView,
    /// World-space shading normals of any length; 0 if there is no surface. A texel whose normal faces away from the
    /// light reflects nothing.
    pub normals: &'a wgpu::TextureView,
    /// Base colour, linear when loaded, and metallic in alpha.
    pub base_color: &'a wgpu::TextureView,
    /// The light's view. It is perspective, and its viewport lies in all three textures.
    pub view: &'a View,
    /// The light, a spot at the view's eye.
    pub light: &'a Light,
}

/// The map as kernels read it: `struct Rsm` of `vpl_rsm.wesl`. 272 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct RsmUniform {
    /// Radiant intensity on the cone's axis.
    pub intensity: [f32; 3],
    /// The light's range, metres: its window ends there.
    pub range_m: f32,
    /// Unit vector along the cone's axis.
    pub direction: [f32; 3],
    /// Squared chord of the cone's half angle: [`SpotRamp`].
    pub outer_chord_2: f32,
    /// Position of the light, world space, metres.
    pub light_world: [f32; 3],
    /// 1 over the ramp's width in squared chords.
    pub ramp_scale: f32,
    /// Texels of a row, and rows.
    pub size: [u32; 2],
    /// Number of levels, including that of the texels.
    pub level_count: u32,
    /// The most VPLs that fit.
    pub capacity: u32,
    /// The largest footprint of a block of several texels, metres.
    pub spacing_m: f32,
    /// Number of texels of the smallest square that holds the map and whose side is a power of two.
    pub index_count: u32,
    /// Pads to 16 bytes.
    pub padding: [u32; 2],
    /// First block, columns and rows of each level.
    pub levels: [[u32; 4]; LEVELS],
}

impl Rsm<'_> {
    /// Checks the view and the light, and makes the uniform of the kernels.
    pub(super) fn uniform(&self) -> Result<RsmUniform, AssignError> {
        let refuse = |field: &str, value: String, accepted: &str| {
            let (field, accepted) = (field.into(), accepted.into());
            Err(AssignError::Parameter { field, value, accepted })
        };
        self.view.check()?;
        if !matches!(self.view.projection, Projection::Perspective { .. }) {
            return refuse("view of the RSM", "orthographic".into(), "perspective");
        }
        let viewport = self.view.viewport;
        let size = [viewport.width, viewport.height];
        if size.iter().any(|side| *side > MAX_RSM_SIDE) {
            let value = format!("{}x{}", size[0], size[1]);
            return refuse("size of the RSM", value, "at most 2048x2048 texels");
        }
        self.check_textures()?;
        if let Err(fault) = self.light.check() {
            return refuse("light of the RSM", fault.to_string(), "a valid light");
        }
        let LightShape::Spot { direction, inner_angle, outer_angle } = self.light.shape else {
            return refuse("light of the RSM", format!("{:?}", self.light.kind()), "a spot");
        };
        let ramp = SpotRamp::new(inner_angle, outer_angle);
        let side = size[0].max(size[1]).next_power_of_two();
        let (levels, level_count) = levels(size);
        Ok(RsmUniform {
            intensity: self.light.intensity.to_array(),
            range_m: self.light.range_m,
            direction: direction.normalize().to_array(),
            outer_chord_2: ramp.outer_chord_2,
            light_world: self.light.position.to_array(),
            ramp_scale: ramp.scale,
            size,
            level_count,
            index_count: side * side,
            levels,
            ..RsmUniform::default()
        })
    }

    /// Checks that the viewport lies in every texture.
    fn check_textures(&self) -> Result<(), AssignError> {
        let viewport = self.view.viewport;
        let (right, bottom) =
            (viewport.x.saturating_add(viewport.width), viewport.y.saturating_add(viewport.height));
        for (what, view) in
            [("depth", self.depth), ("normals", self.normals), ("base colour", self.base_color)]
        {
            let texture = view.texture();
            if right > texture.width() || bottom > texture.height() {
                return Err(AssignError::Parameter {
                    field: format!("{what} of the RSM"),
                    value: format!("{}x{} texels", texture.width(), texture.height()),
                    accepted: format!(
                        "at least {right}x{bottom}, so that it holds the view's viewport"
                    ),
                });
            }
        }
        Ok(())
    }
}

impl RsmUniform {
    /// Number of blocks of all levels.
    pub(super) fn block_count(&self) -> u32 {
        self.levels.iter().map(|[_, columns, rows, _]| columns * rows).sum()
    }

    /// Columns and rows of a level's blocks.
    pub(super) fn blocks_of(&self, level: u32) -> [u32; 2] {
        self.levels.get(level as usize).map_or([0, 0], |[_, columns, rows, _]| [*columns, *rows])
    }
}

/// First block, columns and rows of each level, and the number of levels. A level has half the columns and rows of the
/// level below, rounded up. The last level has one block.
fn levels(size: [u32; 2]) -> ([[u32; 4]; LEVELS], u32) {
    let mut levels = [[0; 4]; LEVELS];
    let (mut first, [mut columns, mut rows], mut count) = (0, size, 0);
    for level in &mut levels {
        *level = [first, columns, rows, 0];
        first += columns * rows;
        count += 1;
        if columns <= 1 && rows <= 1 {
            break;
        }
        (columns, rows) = (columns.div_ceil(2), rows.div_ceil(2));
    }
    (levels, count)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_last_level_is_one_block() {
        let (blocks, count) = levels([5, 3]);
        assert_eq!(count, 4);
        assert_eq!(blocks[..4], [[0, 5, 3, 0], [15, 3, 2, 0], [21, 2, 1, 0], [23, 1, 1, 0]]);
        assert_eq!(levels([1, 1]).1, 1);
        let (blocks, count) = levels([MAX_RSM_SIDE; 2]);
        assert_eq!((count as usize, blocks[LEVELS - 1]), (LEVELS, [5_592_404, 1, 1, 0]));
    }
}
