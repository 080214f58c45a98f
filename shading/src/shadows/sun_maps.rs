//! Maps of suns: one orthographic map each, of the whole scene.
//!
//! # The idea
//!
//! A sun lights the whole scene along one direction. Its map is a square across that direction that holds all of the scene's
//! bounds, with PX texels on a side. Depth is even along the direction: 1 where the scene begins and 0 where it ends.
//! Lights have maps that move with them. Suns stand still, so their maps come first in the atlas and keep their places.
//!
//! # Offsets
//!
//! They are those of other maps ([`super`]) seen from infinitely far. A texel whose centre is read lies at most `r` metres
//! beside the sample. Along the sun's rays, the sample's plane rises there by at most `r s / a`, with `s` and `a` the sine and
//! the cosine between the normal and the direction to the sun. Moved along its normal by `r s`, the sample is as much nearer
//! to the sun. The rasteriser moves each triangle away by what its plane changes over `r`. What it rounds is a share of the
//! map's depth, [`SLACK`], because no triangle is larger than the map.
//!
//! # Where it fails
//!
//! Texels are `scene / PX` wide everywhere, however near the camera is: a hall of 40 m at 512 texels has shadows of 8 cm.
//! The suns' discs have no size here, so their shadows are hard, as they are in the [truth](crate::traced).

use assign::{MAX_SUNS, Suns};
use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Mat4, Vec3, Vec4};

use super::face::{Face, across, world_to_view};

/// The share of a map's depth by which what it shows may lie in front of the surface, because the rasteriser rounds: a
/// millimetre in 4 metres. It is no more than a texel of the largest map.
const SLACK: f32 = 1.0 / (1 << 12) as f32;

/// `sun_shadow.wesl`, `struct SunMap`. 64 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SunMapRecord {
    /// From world space to metres right of the map's middle.
    pub right: [f32; 4],
    /// From world space to metres below it.
    pub down: [f32; 4],
    /// From world space to depth, 0 to 1.
    pub away: [f32; 4],
    /// Corner in the atlas, texels.
    pub origin: [u32; 2],
    /// Metres per texel.
    pub texel_m: f32,
    /// How far a sample is moved along its normal, metres, per sine of its angle.
    pub offset_m: f32,
}

/// `sun_shadow.wesl`, `struct SunMaps`. 528 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct SunMapsRecord {
    /// The maps of the suns, in their order.
    pub maps: [SunMapRecord; MAX_SUNS],
    /// Texels on a side of the filter.
    pub taps: u32,
    /// Texels on a side of a map.
    pub px: u32,
    /// Depth by which a map may lie in front of what it shows.
    pub slack: f32,
    /// Pads to 16 bytes.
    pub padding: u32,
}

/// The suns of a scene, and the box around its surfaces.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct SunnyScene {
    pub(crate) suns: Suns,
    /// Lowest and highest corner, world space, metres.
    pub(crate) bounds: (Vec3, Vec3),
}

impl SunnyScene {
    /// The number of squares that its maps take.
    pub(super) fn squares(&self) -> u32 {
        self.suns.as_slice().len() as u32
    }

    /// The maps, with sides of `px` texels of which `guard` on each side show nothing, in a row of `columns` squares and those
    /// below it. `taps` is the side of the filter.
    pub(super) fn maps(
        &self,
        columns: u32,
        px: u32,
        (guard, taps): (u32, u32),
    ) -> (Vec<Face>, SunMapsRecord) {
        let mut record = SunMapsRecord { taps, px, slack: SLACK, ..Default::default() };
        let mut faces = Vec::new();
        let (low, high) = (self.bounds.0.as_dvec3(), self.bounds.1.as_dvec3());
        let (middle, half) = (0.5 * (low + high), (0.5 * (high - low)).max(DVec3::ZERO));
        let reach = across(f64::from(taps)) * std::f64::consts::SQRT_2;
        for ((square, sun), slot) in (0..).zip(self.suns.as_slice()).zip(&mut record.maps) {
            let away = sun.direction.as_dvec3().normalize();
            let right = away.any_orthonormal_vector();
            let down = away.cross(right);
            let extent = |axis: DVec3| half.dot(axis.abs());
            // A scene without extent has room, too.
            let side_m = extent(right).max(extent(down)).max(f64::from(f32::MIN_POSITIVE).sqrt());
            let texel_m = 2.0 * side_m / f64::from(px - 2 * guard);
            // A texel more, so that nothing is cut away at both ends.
            let depth_m = 2.0 * (extent(away) + texel_m);
            let eye = middle - away * (0.5 * depth_m);
            let face = Face {
                world_to_view: world_to_view(right, down, -away, eye),
                view_to_clip: orthographic(0.5 * f64::from(px) * texel_m, depth_m),
                origin: [square % columns * px, square / columns * px],
                size: [px, px],
                eye: middle.as_vec3(),
                reach_m: f32::INFINITY,
                is_curved: false,
            };
            let row = |axis: DVec3, from: DVec3, scale: f64| {
                (axis * scale).extend(-axis.dot(from) * scale).as_vec4().to_array()
            };
            *slot = SunMapRecord {
                right: row(right, eye, 1.0),
                down: row(down, eye, 1.0),
                away: row(away, eye, 1.0 / depth_m),
                origin: face.origin,
                texel_m: texel_m as f32,
                offset_m: (reach * texel_m) as f32,
            };
            faces.push(face);
        }
        (faces, record)
    }
}

/// Clip x and y run from -`side_m` to `side_m`, y downwards. Clip depth is 1 at the eye and 0 at `depth_m`.
fn orthographic(side_m: f64, depth_m: f64) -> Mat4 {
    Mat4::from_cols(
        Vec4::X * (1.0 / side_m) as f32,
        Vec4::Y * (-1.0 / side_m) as f32,
        Vec4::Z * (1.0 / depth_m) as f32,
        Vec4::new(0.0, 0.0, 1.0, 1.0),
    )
}

#[cfg(test)]
mod tests {
    use assign::Sun;

    use super::*;

    #[test]
    fn a_map_holds_the_scene_and_look_ups_find_its_places() {
        let directions = [Vec3::new(-0.3, -1.0, -0.6), Vec3::NEG_Y, Vec3::X];
        let suns = directions.map(|d| Sun { direction: d.normalize(), irradiance: Vec3::ONE });
        let bounds = (Vec3::new(-3.0, 0.0, -20.0), Vec3::new(3.0, 9.0, 30.0));
        let scene = SunnyScene { suns: Suns::new(&suns).unwrap(), bounds };
        let (faces, record) = scene.maps(2, 256, (2, 1));
        assert_eq!(faces.len(), 3);
        assert_eq!(faces[2].origin, [0, 256]);
        for (face, map) in faces.iter().zip(&record.maps) {
            for corner in 0..8 {
                let pick = |axis: usize| {
                    if corner >> axis & 1 == 0 { bounds.0[axis] } else { bounds.1[axis] }
                };
                let at = Vec3::new(pick(0), pick(1), pick(2)).extend(1.0);
                let clip = face.view_to_clip * (face.world_to_view * at);
                assert!(clip.x.abs() < 1.0 && clip.y.abs() < 1.0, "{clip}");
                assert!((0.0..1.0).contains(&clip.z), "{clip}");
                // The shader's rows: texels, and depth.
                let row = |of: [f32; 4]| Vec4::from(of).dot(at);
                let [x, y] = [map.right, map.down].map(|axis| row(axis) / map.texel_m / 128.0);
                assert!((x - clip.x).abs() < 1e-4 && (y + clip.y).abs() < 1e-4, "{x} {y} {clip}");
                assert!((1.0 - row(map.away) - clip.z).abs() < 1e-5, "{clip}");
            }
        }
        assert_eq!(SunnyScene::default().maps(1, 64, (2, 1)).0, []);
    }
}
