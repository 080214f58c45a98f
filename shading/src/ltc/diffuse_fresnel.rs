//! The share of light that Schlick's term takes away from diffuse reflection.

/// C as a polynomial of the cosine of the view, lowest power first, interpolated at Chebyshev's
/// points.
pub const DIFFUSE_FRESNEL: [f64; 5] =
    [0.028_163_140, -0.079_932_239, 0.086_807_128, -0.044_172_812, 0.009_218_425];

/// C, the integral of `cos (1 - v.h)^5 / pi` over the hemisphere, for a cosine of the view of 0 to
/// 1. It ranges from 0.028 to 0.0001, and the error is within 1.2e-5.
pub fn diffuse_fresnel(cos_view: f64) -> f64 {
    DIFFUSE_FRESNEL.iter().rev().fold(0.0, |sum, coefficient| sum * cos_view + coefficient)
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;
    use crate::ltc::integrate;

    #[test]
    fn c_matches_the_integral_over_the_hemisphere() {
        let sky = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]]
            .map(|[x, y]| DVec3::new(x, y, 1e-9));
        for step in 0..=10 {
            let cos = f64::from(step) * 0.1;
            let to_eye = DVec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos);
            let truth = integrate(&sky, to_eye, 1.0, 1e-4).value.diffuse_fresnel;
            let off = diffuse_fresnel(cos) - truth;
            assert!(off.abs() < 1.2e-5 && truth > 1e-5, "cosine {cos}: error {off}");
        }
    }
}
