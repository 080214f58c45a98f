//! Textures on the CPU, filtered as by the GPU's samplers without anisotropy.
//!
//! The mip level follows from the distance of neighbouring pixels in texels. The finest level uses
//! the filter for magnification; coarser levels use that for minification.

use glam::{DVec3, Vec2, Vec4};
use scenes::{Encoding, Filter, Image, TextureRef, Wrap};

use crate::mips::{TO_LINEAR, mip_chain};

/// One level of an image, linear; rows from the top.
struct Level {
    size: [u32; 2],
    first_byte: usize,
}

/// An image with its mip chain, with the same bytes as on the GPU.
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

    /// Its mean colour: that of the coarsest level.
    pub(super) fn mean(&self) -> DVec3 {
        self.levels.last().map_or(DVec3::ONE, |last| self.texel(last, 0, 0).truncate().as_dvec3())
    }

    /// The mip level of a pixel whose neighbours are these steps of uv away. 0 is the finest level;
    /// at a negative level one texel covers several pixels.
    pub(super) fn level(&self, texture: &TextureRef, steps: [Vec2; 2]) -> f32 {
        let [width, height] = self.levels[0].size;
        let texels = |step: Vec2| {
            texture.uv_transform.transform_vector2(step) * Vec2::new(width as f32, height as f32)
        };
        let longest = steps.map(texels).map(Vec2::length);
        longest[0].max(longest[1]).max(f32::MIN_POSITIVE).log2()
    }

    /// Its colour at a vertex's uv, `level` levels above the finest.
    pub(super) fn sample(&self, texture: &TextureRef, uv: Vec2, level: f32) -> Vec4 {
        let sampler = texture.sampler;
        let last = (self.levels.len() - 1) as f32;
        let level = if sampler.mip.is_some() { level.clamp(0.0, last) } else { 0.0 };
        let filtered = |level: f32, filter| self.filtered(texture, uv, level as usize, filter);
        if level <= 0.0 {
            return filtered(0.0, sampler.mag);
        }
        match sampler.mip {
            Some(Filter::Linear) => {
                let finer = level.floor();
                let coarser = filtered((finer + 1.0).min(last), sampler.min);
                filtered(finer, sampler.min).lerp(coarser, level - finer)
            }
            _ => filtered(level.round(), sampler.min),
        }
    }

    /// Its colour at one level.
    fn filtered(&self, texture: &TextureRef, uv: Vec2, level: usize, filter: Filter) -> Vec4 {
        let level = &self.levels[level];
        let [width, height] = level.size;
        let at = texture.uv_transform.transform_point2(uv) * Vec2::new(width as f32, height as f32);
        let texel = |x: f32, y: f32| {
            let x = wrap(x, width, texture.sampler.wrap_s);
            let y = wrap(y, height, texture.sampler.wrap_t);
            self.texel(level, x, y)
        };
        if filter == Filter::Nearest {
            return texel(at.x.floor(), at.y.floor());
        }
        // Texel centres lie at halves.
        let low = (at - 0.5).floor();
        let share = at - 0.5 - low;
        let upper = texel(low.x, low.y).lerp(texel(low.x + 1.0, low.y), share.x);
        let lower = texel(low.x, low.y + 1.0).lerp(texel(low.x + 1.0, low.y + 1.0), share.x);
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

/// The texel at a coordinate in texels.
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
    // NaN becomes 0.
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
    fn coarser_levels_average_and_blend() {
        near(at(0.25, 1.0, Wrap::Repeat), 26.0 / 255.0);
        near(at(0.9, 99.0, Wrap::Repeat), 90.0 / 255.0);
        // A quarter of the way from 0.1 to the level above.
        near(at(0.25, 0.25, Wrap::Repeat), 0.1 + 0.25 * (26.0 / 255.0 - 0.1));
        near(at(0.25, -3.0, Wrap::Repeat), 0.1);
        let close = |a: f64, b: f64| assert!((a - b).abs() < 1e-6, "{a} {b}");
        close(ramp().mean().x, 90.0 / 255.0);
    }

    #[test]
    fn filters_follow_the_sampler() {
        let mut texture = TextureRef::new(0);
        texture.sampler.mag = Filter::Nearest;
        let at = |texture: &TextureRef, u: f32, level: f32| {
            ramp().sample(texture, Vec2::new(u, 0.3), level).x
        };
        near(at(&texture, 0.26, -1.0), 0.2);
        near(at(&texture, 0.26, 1.0), (26.0 + 0.02 * 127.0) / 255.0);
        texture.sampler.min = Filter::Nearest;
        near(at(&texture, 0.26, 1.0), 26.0 / 255.0);
        texture.sampler.mip = Some(Filter::Nearest);
        near(at(&texture, 0.26, 0.6), 26.0 / 255.0);
        texture.sampler.mip = None;
        near(at(&texture, 0.26, 5.0), 0.2);
    }

    #[test]
    fn the_longest_step_decides_the_level() {
        let mut texture = TextureRef::new(0);
        let level = |texture: &TextureRef, x: f32, y: f32| {
            ramp().level(texture, [Vec2::new(x, 0.0), Vec2::new(0.0, y)])
        };
        // Four texels wide, one high.
        near(level(&texture, 0.5, 0.5), 1.0);
        near(level(&texture, 0.5, 8.0), 3.0);
        texture.uv_transform.matrix2 *= 2.0;
        near(level(&texture, 0.5, 0.5), 2.0);
        assert!(level(&texture, 0.0, 0.0) < -100.0 && level(&texture, f32::NAN, 0.5) == 0.0);
    }
}
