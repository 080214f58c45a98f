//! Draws points on emitting triangles, about in proportion to the light that they emit.
//!
//! A triangle's weight is its area times the luminance of its material's emission. An emissive
//! texture counts by its mean. Points are uniform on the triangle.

use glam::DVec3;

use crate::luminance;

/// The number of coordinates of one draw: for the triangle, and for the point on it.
pub(super) const DRAW_DIMENSIONS: u32 = 3;

/// The least weight of a texture's luminance. A texture that is dark on average may have bright
/// spots.
const LEAST_TEXEL: f64 = 0.01;

/// Emitted light that reaches a sample from a drawn point.
#[derive(Clone, Copy, Debug)]
pub(super) struct Emission {
    /// World space, metres.
    pub(super) point: DVec3,
    /// Unit vector to it.
    pub(super) direction: DVec3,
    /// Linear RGB.
    pub(super) radiance: DVec3,
    /// The density with which the direction is drawn, per steradian.
    pub(super) density: f64,
}

/// The triangles of a scene that emit.
#[derive(Clone, Debug, Default)]
pub(super) struct EmissiveTriangles {
    /// Ascending.
    triangles: Vec<u32>,
    /// For each triangle, the sum of the weights up to and including it.
    sums: Vec<f64>,
    /// For each triangle, the density of its points, per square metre.
    densities: Vec<f64>,
}

impl EmissiveTriangles {
    /// Adds a triangle of the scene, in ascending order, if it emits.
    pub(super) fn add(&mut self, triangle: u32, corners: [DVec3; 3], emitted: DVec3, texel: DVec3) {
        let [a, b, c] = corners;
        let area_m2 = 0.5 * (b - a).cross(c - a).length();
        let brightness_of = |color: DVec3| luminance(&color.as_vec3().to_array());
        let brightness = brightness_of(emitted) * brightness_of(texel).max(LEAST_TEXEL);
        let weight = area_m2 * brightness;
        if weight > 0.0 && weight.is_finite() {
            self.triangles.push(triangle);
            self.sums.push(self.sums.last().copied().unwrap_or(0.0) + weight);
            self.densities.push(brightness);
        }
    }

    /// Turns weights into densities after all triangles are added.
    pub(super) fn finish(&mut self) {
        let Some(sum) = self.sums.last().copied() else { return };
        self.densities.iter_mut().for_each(|density| *density /= sum);
    }

    /// How many there are.
    pub(super) fn count(&self) -> usize {
        self.triangles.len()
    }

    /// A triangle and the weights of its second and third corner, from coordinates in 0..1; `None`
    /// if nothing emits.
    pub(super) fn draw(&self, [choice, u, v]: [f64; 3]) -> Option<(u32, [f64; 2])> {
        let sum = self.sums.last()?;
        let ix = self.sums.partition_point(|below| *below <= choice * sum);
        let triangle = *self.triangles.get(ix.min(self.triangles.len() - 1))?;
        // Uniform on the triangle (Shirley and Chiu 1997).
        let root = u.sqrt();
        Some((triangle, [root * (1.0 - v), root * v]))
    }

    /// The density of points on a triangle, per square metre; 0 if it does not emit.
    pub(super) fn density(&self, triangle: u32) -> f64 {
        self.triangles.binary_search(&triangle).map_or(0.0, |ix| self.densities[ix])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn draw_counts_match_densities() {
        let mut emissive = EmissiveTriangles::default();
        let corners = |size: f64| [DVec3::ZERO, DVec3::X * size, DVec3::Y * size];
        // The areas are 2 and 8 square metres, and the brightnesses 1, 0 and 3.
        emissive.add(4, corners(2.0), DVec3::ONE, DVec3::ONE);
        emissive.add(5, corners(2.0), DVec3::ZERO, DVec3::ONE);
        emissive.add(9, corners(4.0), DVec3::ONE, DVec3::splat(3.0));
        emissive.add(11, corners(0.0), DVec3::ONE, DVec3::ONE);
        emissive.finish();
        assert_eq!(emissive.count(), 2);
        let count = 2600;
        let drawn = |triangle: u32| {
            let choices = (0..count).map(|ix| (f64::from(ix) + 0.5) / f64::from(count));
            choices.filter(|c| emissive.draw([*c, 0.3, 0.6]).unwrap().0 == triangle).count()
        };
        assert_eq!([drawn(4), drawn(5), drawn(9)], [200, 0, 2400]);
        assert!((emissive.density(4) * 2.0 - 200.0 / 2600.0).abs() < 1e-9);
        assert!((emissive.density(9) * 8.0 - 2400.0 / 2600.0).abs() < 1e-9);
        assert_eq!(emissive.density(5), 0.0);
        assert!(EmissiveTriangles::default().draw([0.5; 3]).is_none());
    }
}
