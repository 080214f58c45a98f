//! Where a light shines: which faces its maps have, and how they are turned.

use assign::{Light, LightShape, Outline};
use glam::{DMat3, DVec3};

use super::face::FACES;

/// Outer half angles of spots up to this one, radians, get one face. A wider one would waste more texels at its edge
/// than a hemisphere's five faces do.
const WIDEST_FACE: f32 = std::f32::consts::FRAC_PI_3;

/// The directions in which a light shines, as faces of maps.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Reach {
    /// A cone around z: one face, with the tangent of the half angle.
    Cone(f64),
    /// The half space around +z: one whole face, and the upper halves of four more.
    Half,
    /// All directions: six faces.
    All,
}

impl Reach {
    pub(super) fn of_light(light: &Light) -> Self {
        match &light.shape {
            LightShape::Point => Self::All,
            LightShape::Spot { outer_angle, .. } if *outer_angle <= WIDEST_FACE => {
                Self::Cone(f64::from(*outer_angle).tan())
            }
            LightShape::Spot { outer_angle, .. } if *outer_angle <= std::f32::consts::FRAC_PI_2 => {
                Self::Half
            }
            LightShape::Spot { .. } => Self::All,
            LightShape::Area(emitter) if emitter.shines_all_around() => Self::All,
            LightShape::Area(_) | LightShape::Vpl { .. } => Self::Half,
        }
    }

    /// Faces of a map: paraboloids, or faces of a cube.
    pub(super) fn face_count(self, are_curved: bool) -> usize {
        match self {
            Self::Half if are_curved => 1,
            Self::All if are_curved => 2,
            Self::Cone(_) => 1,
            Self::Half => FACES - 1,
            Self::All => FACES,
        }
    }

    /// Squares of the atlas that a map takes. Two halves share one.
    pub(super) fn squares(self, are_curved: bool) -> u64 {
        match self {
            Self::Half | Self::All if are_curved => self.face_count(true) as u64,
            Self::Cone(_) => 1,
            Self::Half => 3,
            Self::All => FACES as u64,
        }
    }
}

/// What `shadow.wesl` calls `SPHERE` and `LINE`; 0 for other lights.
pub(super) fn round_spread(light: &Light) -> f64 {
    let LightShape::Area(emitter) = &light.shape else { return 0.0 };
    match emitter.outline() {
        Outline::Sphere => -1.0,
        Outline::Line => -2.0,
        Outline::Rectangle | Outline::Polygon | Outline::Disc => 0.0,
    }
}

/// Unit axes of a light, world space. z is its direction or normal, if it has one.
pub(super) fn axes_of(light: &Light) -> DMat3 {
    let around = |z: DVec3| {
        let z = z.normalize_or(DVec3::Z);
        let x = z.any_orthonormal_vector();
        DMat3::from_cols(x, z.cross(x), z)
    };
    match &light.shape {
        LightShape::Point => DMat3::IDENTITY,
        LightShape::Spot { direction, .. } => around(direction.as_dvec3()),
        LightShape::Vpl { normal, .. } => around(normal.as_dvec3()),
        LightShape::Area(emitter) if emitter.outline() == Outline::Line => {
            around(emitter.half_axes()[0].as_dvec3())
        }
        LightShape::Area(emitter) => around(emitter.normal().as_dvec3()),
    }
}
