//! Textures on the CPU: bilinear, at one level of their mip chain.
//!
//! The GPU blends two levels, chosen from derivatives between pixels; here the level is the caller's,
//! rounded to a whole one. Filters that are nearest count as linear, but where a sampler has no mips
//! the finest level is read, as there.

use glam::{Vec2, Vec4};
use scenes::{Encoding, Image, TextureRef, Wrap};

use crate::mips::{TO_LINEAR, mip_chain};

/// One level of an image, linear; rows from the top.
struct Level {
    size: [u32; 2],
    first_byte: usize,
}

/// An image with its mip chain: the bytes that the GPU has.
pub(super) struct Texture {
    levels: Vec<Level>,
    bytes: Vec<u8>,
    encoding: Encoding,
}

impl Texture {
    pub(super) fn new(image: &Image) -> Self {
        let (count, bytes) = mip_chain(image);
        let mut size = [image.width, image.height];
        let mut first_byte = 0;
        let levels = (0..count).map(|_| {
            let level = Level { size, first_byte };
            first_byte += (size[0] * size[1]) as usize * 4;
            size = size.map(|s| (s / 2).max(1));
            level
        });
        Self { levels: levels.collect(), bytes, encoding: image.encoding }
    }

    /// Texels of its finest level.
    pub(super) fn texel_count(&self) -> f32 {
        let [width, height] = self.levels[0].size;
        width as f32 * height as f32
    }

    /// Its colour at a vertex's uv, `level` levels above the finest.
    pub(super) fn sample(&self, texture: &TextureRef, uv: Vec2, level: f32) -> Vec4 {
        let last = (self.levels.len() - 1) as f32;
        let level =
            if texture.sampler.mip.is_some() { level.round().clamp(0.0, last) } else { 0.0 };
        let level = &self.levels[level as usize];
        let [width, height] = level.size;
        // Texel centres lie at halves.
        let at = texture.uv_transform.transform_point2(uv) * Vec2::new(width as f32, height as f32);
        let low = (at - 0.5).floor();
        let share = at - 0.5 - low;
        let texel = |dx: f32, dy: f32| {
            let x = wrap(low.x + dx, width, texture.sampler.wrap_s);
            let y = wrap(low.y + dy, height, texture.sampler.wrap_t);
            self.texel(level, x, y)
        };
        let upper = texel(0.0, 0.0).lerp(texel(1.0, 0.0), share.x);
        let lower = texel(0.0, 1.0).lerp(texel(1.0, 1.0), share.x);
        upper.lerp(lower, share.y)
    }

    fn texel(&self, level: &Level, x: u32, y: u32) -> Vec4 {
        let start = level.first_byte + (y * level.size[0] + x) as usize * 4;
        let color = |channel: usize| {
            let byte = self.bytes[start + channel];
            match self.encoding {
                Encoding::Srgb => TO_LINEAR[usize::from(byte)],
                Encoding::Linear => f32::from(byte) / 255.0,
            }
        };
        Vec4::new(color(0), color(1), color(2), f32::from(self.bytes[start + 3]) / 255.0)
    }
}

/// The texel that a coordinate in texels falls on.
fn wrap(at: f32, size: u32, wrap: Wrap) -> u32 {
    let edge = size as f32;
    let wrapped = match wrap {
        Wrap::Repeat => at.rem_euclid(edge),
        Wrap::MirroredRepeat => {
            let twice = at.rem_euclid(2.0 * edge);
            if twice < edge { twice } else { 2.0 * edge - 1.0 - twice }
        }
        Wrap::ClampToEdge => at,
    };
    // What is no number becomes 0.
    (wrapped.max(0.0) as u32).min(size - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ramp() -> Texture {
        let rgba = [0_u8, 51, 102, 204].into_iter().flat_map(|v| [v, v, v, 255]).collect();
        let image =
            Image { name: "ramp".into(), width: 4, height: 1, rgba, encoding: Encoding::Linear };
        Texture::new(&image)
    }

    fn at(u: f32, level: f32, wrap: Wrap) -> f32 {
        let mut texture = TextureRef::new(0);
        texture.sampler.wrap_s = wrap;
        ramp().sample(&texture, Vec2::new(u, 0.3), level).x
    }

    fn near(a: f32, b: f32) {
        assert!((a - b).abs() < 1e-6, "{a} {b}");
    }

    #[test]
    fn texels_blend_between_their_centres_and_wrap() {
        near(at(0.125, 0.0, Wrap::Repeat), 0.0);
        near(at(0.25, 0.0, Wrap::Repeat), 0.1);
        near(at(1.375, 0.0, Wrap::Repeat), 0.2);
        near(at(-0.125, 0.0, Wrap::Repeat), 0.8);
        near(at(-0.125, 0.0, Wrap::MirroredRepeat), 0.0);
        near(at(1.125, 0.0, Wrap::MirroredRepeat), 0.8);
        near(at(7.0, 0.0, Wrap::ClampToEdge), 0.8);
        assert!(at(f32::NAN, 0.0, Wrap::Repeat).is_nan());
    }

    #[test]
    fn coarser_levels_average() {
        near(at(0.25, 1.0, Wrap::Repeat), 26.0 / 255.0);
        near(at(0.9, 99.0, Wrap::Repeat), 90.0 / 255.0);
    }
}
