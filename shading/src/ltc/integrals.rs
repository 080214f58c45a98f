//! The four integrals of a BRDF over a polygon, and the radiance that they give.

/// Integrals over a polygon of unit radiance, each times the cosine of incidence.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Integrals {
    /// D V, the specular lobe at a Fresnel term of 1.
    pub specular: f64,
    /// D V times Schlick's `(1 - v.h)^5`.
    pub specular_fresnel: f64,
    /// 1 / pi: the form factor.
    pub diffuse: f64,
    /// `(1 - v.h)^5 / pi`.
    pub diffuse_fresnel: f64,
}

impl Integrals {
    /// Radiance that the specular lobe reflects, for a reflectance at normal incidence.
    pub fn specular_reflected(&self, f0: f64) -> f64 {
        f0 * (self.specular - self.specular_fresnel) + self.specular_fresnel
    }

    /// Radiance that is reflected diffusely, for an albedo and a reflectance at normal incidence.
    pub fn diffuse_reflected(&self, albedo: f64, f0: f64) -> f64 {
        albedo * (1.0 - f0) * (self.diffuse - self.diffuse_fresnel)
    }

    pub(super) fn map(self, other: Self, f: impl Fn(f64, f64) -> f64) -> Self {
        Self {
            specular: f(self.specular, other.specular),
            specular_fresnel: f(self.specular_fresnel, other.specular_fresnel),
            diffuse: f(self.diffuse, other.diffuse),
            diffuse_fresnel: f(self.diffuse_fresnel, other.diffuse_fresnel),
        }
    }

    pub(super) fn plus(self, other: Self) -> Self {
        self.map(other, |a, b| a + b)
    }

    pub(super) fn largest(self) -> f64 {
        self.specular.max(self.specular_fresnel).max(self.diffuse).max(self.diffuse_fresnel)
    }
}
