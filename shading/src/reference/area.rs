//! Area lights in f64 on the CPU: the true integral, and its approximation by linearly transformed
//! cosines.

use assign::{Emitter, Light, range_window};
use glam::{DMat3, DVec3};

use super::{
    brdf::{Surface, f0_of, f90_of},
    outline::SeenOutline,
};
use crate::ltc;

/// Relative error at which the quadrature of the truth stops.
const TOLERANCE: f64 = 1e-4;

/// An area light seen from a surface.
pub(crate) struct SeenArea {
    outline: SeenOutline,
    to_eye: DVec3,
    /// Radiance of the emitter times the window of each term.
    diffuse: DVec3,
    specular: DVec3,
    albedo: DVec3,
    f0: DVec3,
    f90: f64,
    roughness: f64,
}

impl SeenArea {
    /// `None` if the light does not reach the position.
    pub(crate) fn new(
        light: &Light,
        emitter: &Emitter,
        position: DVec3,
        surface: &Surface,
        to_eye: DVec3,
    ) -> Option<Self> {
        let to_position = position - light.position.as_dvec3();
        if emitter.in_front(to_position) <= 0.0 {
            return None;
        }
        let distance_2 = to_position.distance_squared(emitter.closest(to_position));
        let window = |range_m: f32| range_window(distance_2, f64::from(range_m));
        let radiance = light.intensity.as_dvec3() / f64::from(emitter.area());
        let frame = shading_frame(surface.normal, to_eye);
        Some(Self {
            outline: SeenOutline::new(emitter, to_position, &frame),
            to_eye: frame * to_eye,
            diffuse: radiance * window(light.diffuse_range_m()),
            specular: radiance * window(light.range_m),
            albedo: (1.0 - surface.metallic) * surface.base_color,
            f0: f0_of(surface),
            f90: f90_of(surface),
            roughness: surface.roughness,
        })
    }

    /// Radiance to the eye: the integral of the BRDF itself.
    pub(crate) fn truth(&self) -> DVec3 {
        if self.specular == DVec3::ZERO && self.diffuse == DVec3::ZERO {
            return DVec3::ZERO;
        }
        let vertices = self.outline.polygon();
        let found = ltc::integrate(&vertices, self.to_eye, self.roughness, TOLERANCE).value;
        let channel = |c: usize| {
            let (albedo, f0) = (self.albedo[c], self.f0[c]);
            // With f90 below 1, less light is reflected at grazing incidence than in the integrals,
            // and more is left for diffuse reflection.
            let less = 1.0 - self.f90;
            let diffuse =
                found.diffuse_reflected(albedo, f0) + less * albedo * found.diffuse_fresnel;
            let specular = found.specular_reflected(f0) - less * found.specular_fresnel;
            self.diffuse[c] * diffuse + self.specular[c] * specular
        };
        DVec3::new(channel(0), channel(1), channel(2))
    }

    /// Radiance to the eye by linearly transformed cosines: `area_ltc.wesl`.
    pub(crate) fn ltc(&self, entry: &ltc::Entry) -> DVec3 {
        let cosine = self.outline.form_factor();
        let lobe = self.outline.lobe_share(&entry.inverse());
        let kept = 1.0 - ltc::diffuse_fresnel(self.to_eye.z.abs());
        let channel = |c: usize| {
            let f0 = self.f0[c];
            let less = 1.0 - self.f90;
            let diffuse = self.albedo[c] * ((1.0 - f0) * kept + less * (1.0 - kept));
            let specular = entry.specular_albedo(f0) - less * entry.specular_albedo(0.0);
            self.diffuse[c] * diffuse * cosine + self.specular[c] * specular * lobe
        };
        DVec3::new(channel(0), channel(1), channel(2))
    }
}

/// World to shading frame: x is the view's projection onto the surface, z is the normal.
fn shading_frame(normal: DVec3, to_eye: DVec3) -> DMat3 {
    let x = to_eye.reject_from_normalized(normal).try_normalize();
    let x = x.unwrap_or_else(|| normal.any_orthonormal_vector());
    DMat3::from_cols(x, normal.cross(x), normal).transpose()
}
