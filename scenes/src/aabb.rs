//! Axis-aligned boxes.

use glam::{Mat4, Vec3};

/// An axis-aligned box. Empty while `min > max` in some axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Aabb {
    /// Smallest corner, metres.
    pub min: Vec3,
    /// Largest corner, metres.
    pub max: Vec3,
}

impl Aabb {
    /// The box of no points: the neutral element of [`Aabb::union`].
    pub const EMPTY: Self = Self { min: Vec3::INFINITY, max: Vec3::NEG_INFINITY };

    /// The box between two corners.
    pub const fn new(min: Vec3, max: Vec3) -> Self {
        Self { min, max }
    }

    /// The smallest box around `points`.
    pub fn from_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        points.into_iter().fold(Self::EMPTY, Self::extended)
    }

    /// Whether it contains no point.
    pub fn is_empty(&self) -> bool {
        !self.min.cmple(self.max).all()
    }

    /// Its middle.
    pub fn center(&self) -> Vec3 {
        0.5 * (self.min + self.max)
    }

    /// Its extents, metres; zero when empty.
    pub fn size(&self) -> Vec3 {
        (self.max - self.min).max(Vec3::ZERO)
    }

    /// Length of its diagonal, metres; zero when empty.
    pub fn diagonal(&self) -> f32 {
        self.size().length()
    }

    /// The smallest box around both.
    pub fn union(self, other: Self) -> Self {
        Self::new(self.min.min(other.min), self.max.max(other.max))
    }

    /// The box that both share; it may be empty.
    pub fn intersection(self, other: Self) -> Self {
        Self::new(self.min.max(other.min), self.max.min(other.max))
    }

    /// The smallest box around it and `point`.
    pub fn extended(self, point: Vec3) -> Self {
        Self::new(self.min.min(point), self.max.max(point))
    }

    /// Grown by `margin` metres on every side.
    pub fn grown(self, margin: f32) -> Self {
        Self::new(self.min - margin, self.max + margin)
    }

    /// Whether `point` lies inside or on the boundary.
    pub fn contains(&self, point: Vec3) -> bool {
        self.min.cmple(point).all() && point.cmple(self.max).all()
    }

    /// Its eight corners.
    pub fn corners(&self) -> [Vec3; 8] {
        std::array::from_fn(|ix| {
            let pick = |axis: usize| {
                if ix >> axis & 1 == 0 { self.min[axis] } else { self.max[axis] }
            };
            Vec3::new(pick(0), pick(1), pick(2))
        })
    }

    /// The smallest axis-aligned box around its image under an affine `transform`.
    pub fn transformed(&self, transform: &Mat4) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        Self::from_points(self.corners().map(|corner| transform.transform_point3(corner)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn transforms_and_unions() {
        let unit = Aabb::new(Vec3::ZERO, Vec3::ONE);
        let mirrored = unit.transformed(&Mat4::from_scale(Vec3::new(-2.0, 1.0, 1.0)));
        assert_eq!(mirrored, Aabb::new(Vec3::new(-2.0, 0.0, 0.0), Vec3::new(0.0, 1.0, 1.0)));
        assert_eq!(Aabb::EMPTY.union(unit), unit);
        assert!(Aabb::EMPTY.is_empty() && Aabb::EMPTY.diagonal() == 0.0);
        assert!(Aabb::EMPTY.transformed(&Mat4::IDENTITY).is_empty());
        assert!(unit.contains(Vec3::ONE) && !unit.contains(Vec3::splat(1.1)));
    }
}
