//! What a face of a shadow map may show: the pieces of a scene inside its frustum and near enough to hide a sample.

use glam::{DMat4, DVec3, DVec4, Vec3};

use super::face::Face;

/// What rounding may move a piece by, as a share of its coordinates.
const ROUNDING: f64 = 1e-5;

/// The bounds of what a face may show.
pub(super) struct Sight {
    /// The frustum's sides and the plane through the eye. They face inwards.
    planes: [DVec4; 5],
    eye: DVec3,
    /// Distance from the eye beyond which nothing hides a sample, metres.
    reach_m: f64,
}

impl Sight {
    /// `ranges` is how far samples may lie that the light reaches, in ranges of the light; infinite if they end nowhere.
    pub(super) fn new(face: &Face, ranges: f32) -> Self {
        let clip: DMat4 = face.view_to_clip.as_dmat4() * face.world_to_view.as_dmat4();
        let [x, y, w] = [clip.row(0), clip.row(1), clip.row(3)];
        let eye = face.eye.as_dvec3();
        let reach_m = f64::from(face.reach_m) * f64::from(ranges.max(1.0));
        // A paraboloid sees half the space, and what reaches into it.
        let planes = if face.is_curved { [DVec4::W; 5] } else { [w + x, w - x, w + y, w - y, w] };
        Self { planes, eye, reach_m }
    }

    /// Whether a box may be seen, world space.
    pub(super) fn may_see(&self, [low, high]: [Vec3; 2]) -> bool {
        let (low, high) = (low.as_dvec3(), high.as_dvec3());
        let extent = low.abs().max(high.abs()).max(self.eye.abs());
        let slack_m = ROUNDING * (extent.x + extent.y + extent.z);
        let nearest = self.eye.clamp(low, high.max(low));
        if self.eye.distance(nearest) > self.reach_m + slack_m {
            return false;
        }
        self.planes.iter().all(|plane| {
            let normal = plane.truncate();
            let farthest = DVec3::select(normal.cmpgt(DVec3::ZERO), high, low);
            normal.dot(farthest) + plane.w >= -slack_m * normal.length()
        })
    }
}

#[cfg(test)]
mod tests {
    use assign::Light;
    use glam::Mat4;

    use super::*;
    use crate::{
        ShadowModel,
        shadows::{SunnyScene, plan::Plan},
    };

    fn faces() -> Vec<Face> {
        let light = Light::point(Vec3::new(1.0, 2.0, 3.0), 4.0, Vec3::ONE);
        let model = ShadowModel::Maps { maps: 1, px: 128, taps: 1 };
        Plan::new(&[light], SunnyScene::default(), model, 4096).expect("a plan").faces
    }

    /// The faces that may see a box of 2 cm at a place relative to the light.
    fn seen_by(at: Vec3, ranges: f32) -> Vec<usize> {
        let center = Vec3::new(1.0, 2.0, 3.0) + at;
        let bounds = [center - 0.01, center + 0.01];
        let all = faces();
        let sees = |face: &Face| Sight::new(face, ranges).may_see(bounds);
        (0..all.len()).filter(|ix| sees(&all[*ix])).collect()
    }

    #[test]
    fn a_box_is_seen_by_the_faces_whose_frustum_it_touches() {
        // Faces look along z, x, -x, y, -y and -z.
        for (at, expected) in [
            (Vec3::Z, &[0][..]),
            (Vec3::X, &[1]),
            (Vec3::NEG_X, &[2]),
            (Vec3::Y, &[3]),
            (Vec3::NEG_Y, &[4]),
            (Vec3::NEG_Z, &[5]),
            (Vec3::new(1.0, 0.0, 1.0), &[0, 1]),
            (Vec3::new(-1.0, -1.0, -1.0), &[2, 4, 5]),
            (Vec3::ZERO, &[0, 1, 2, 3, 4, 5]),
        ] {
            assert_eq!(seen_by(at, 1.0), expected, "{at}");
        }
    }

    #[test]
    fn what_lies_beyond_the_range_hides_nothing() {
        assert_eq!(seen_by(Vec3::Z * 4.0, 1.0), [0]);
        assert!(seen_by(Vec3::Z * 5.0, 1.0).is_empty());
        assert_eq!(seen_by(Vec3::Z * 5.0, 2.0), [0]);
        assert_eq!(seen_by(Vec3::Z * 5e4, f32::INFINITY), [0]);
        // A box around the light.
        let sight = Sight::new(&faces()[0], 1.0);
        assert!(sight.may_see([Vec3::splat(-9e6), Vec3::splat(9e6)]));
        assert_eq!(faces()[0].world_to_view.transform_point3(faces()[0].eye), Vec3::ZERO);
        assert_ne!(faces()[0].world_to_view, Mat4::IDENTITY);
    }
}
