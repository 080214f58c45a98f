//! The view of a reflective shadow map: the scene as a spot light sees it.

use assign::{AssignError, DepthMapping, Light, LightShape, Projection, View};
use glam::{Vec2, Vec3};

/// The widest cone for which a map is drawn, radians from the axis: 80 degrees.
pub const MAX_RSM_ANGLE: f32 = 1.396;

/// The near plane of a light inside the scene's box, as a share of the box's diagonal.
const NEAR_SHARE: f32 = 1e-4;

/// The view from a spot light of the part of its cone that contains `scene_bounds`, on `size_px` by
/// `size_px` pixels. `scene_bounds` are the scene's smallest and largest corner in world space.
///
/// Near and far plane lie just outside the box. If the light stands in the box or beside it, the
/// near plane is a ten-thousandth of the box's diagonal away. The window is the intersection of the
/// cone's and the box's. So pixels need not be square in space; the light of a pixel follows from
/// its own solid angle.
///
/// # Errors
///
/// [`AssignError::Parameter`] if the light is not a spot, its cone is wider than [`MAX_RSM_ANGLE`],
/// the box is empty or not finite, or none of it lies in the cone's window. [`AssignError::View`]
/// if the view does not fit f32.
pub fn rsm_view(
    light: &Light,
    size_px: u32,
    scene_bounds: (Vec3, Vec3),
) -> Result<View, AssignError> {
    let refuse = |field: &str, value: String, accepted: String| {
        Err(AssignError::Parameter { field: field.into(), value, accepted })
    };
    if let Err(fault) = light.check() {
        return refuse("primary light", fault.to_string(), "a light without faults".into());
    }
    let LightShape::Spot { direction, outer_angle, .. } = light.shape else {
        return refuse("primary light", format!("{:?}", light.kind()), "a spot".into());
    };
    if outer_angle > MAX_RSM_ANGLE {
        let accepted = format!("at most {MAX_RSM_ANGLE} radians");
        return refuse("outer angle of the primary light", outer_angle.to_string(), accepted);
    }
    let (min, max) = scene_bounds;
    if !(min.is_finite() && max.is_finite() && min.cmple(max).all()) {
        let accepted = "finite, the first corner not above the second".into();
        return refuse("scene bounds", format!("{min} to {max}"), accepted);
    }
    let mut view =
        View::look_at(light.position, light.position + direction, 1.0, 1.0, [size_px; 2]);
    let seen = Seen::new(&view, min, max);
    let cone = Vec2::splat(outer_angle.tan());
    let (low, high) = seen.window.map_or((-cone, cone), |(low, high)| {
        // A box seen from its edge has no width. A margin of one pixel keeps points on its faces
        // inside.
        let margin =
            (high - low) / size_px.max(1) as f32 + 1e-5 * (1.0 + high.abs().max(low.abs()));
        ((low - margin).max(-cone), (high + margin).min(cone))
    });
    let far_m = seen.farthest * (1.0 + 1e-5);
    if !low.cmplt(high).all() || far_m <= 0.0 {
        let accepted = "a box of which the primary light sees a part".into();
        return refuse("scene bounds", format!("{min} to {max}"), accepted);
    }
    let diagonal = (max - min).length().max(far_m * 1e-6);
    view.near_m = (seen.nearest * (1.0 - 1e-5)).max(NEAR_SHARE * diagonal);
    view.far_m = Some(far_m.max(view.near_m * 1.001));
    view.projection = Projection::Perspective { min: low, max: high };
    view.depth = DepthMapping::Reversed;
    view.check()?;
    Ok(view)
}

/// A box in the coordinates of a view.
struct Seen {
    nearest: f32,
    farthest: f32,
    /// The window at view depth 1; `None` if a part of the box lies behind the eye.
    window: Option<(Vec2, Vec2)>,
}

impl Seen {
    fn new(view: &View, min: Vec3, max: Vec3) -> Self {
        let corners: [Vec3; 8] = std::array::from_fn(|ix| {
            let pick = |axis: usize| if ix >> axis & 1 == 0 { min[axis] } else { max[axis] };
            view.world_to_view.transform_point3(Vec3::new(pick(0), pick(1), pick(2)))
        });
        let depths = corners.map(|corner| -corner.z);
        let nearest = depths.into_iter().fold(f32::INFINITY, f32::min);
        let farthest = depths.into_iter().fold(f32::NEG_INFINITY, f32::max);
        let window = (nearest > NEAR_SHARE * (max - min).length()).then(|| {
            let at = corners.map(|corner| corner.truncate() / -corner.z);
            let low = at.into_iter().fold(Vec2::INFINITY, Vec2::min);
            (low, at.into_iter().fold(Vec2::NEG_INFINITY, Vec2::max))
        });
        Self { nearest, farthest, window }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn spot(position: Vec3, direction: Vec3, outer_angle: f32) -> Light {
        Light {
            shape: LightShape::Spot { direction, inner_angle: 0.0, outer_angle },
            ..Light::point(position, 1e4, Vec3::ONE)
        }
    }

    /// Every point of the box inside the cone lands in the image, between near and far.
    #[test]
    fn the_view_contains_everything_the_light_reaches() {
        let (min, max) = (Vec3::new(-3.0, 0.0, -2.0), Vec3::new(4.0, 5.0, 6.0));
        let toward = |eye: Vec3| (Vec3::new(0.5, 2.5, 2.0) - eye).normalize();
        let far = Vec3::new(-200.0, 340.0, 110.0);
        let beside = Vec3::new(-9.0, 6.0, 1.0);
        let mut inside_cone = 0;
        for light in [
            spot(far, toward(far), 0.05),
            spot(far, toward(far), 1.3),
            spot(beside, toward(beside), 0.4),
            spot(Vec3::new(0.0, 4.0, 0.0), Vec3::NEG_Y, 1.2),
            spot(Vec3::new(0.0, 4.0, 0.0), Vec3::X, 0.6),
        ] {
            let view = rsm_view(&light, 64, (min, max)).unwrap();
            for i in 0..4096 {
                let share = [i % 16, i / 16 % 16, i / 256].map(|x| x as f32 / 15.0);
                let point = min + (max - min) * Vec3::from(share);
                let clip = view.world_to_clip() * point.extend(1.0);
                let ndc = clip.truncate() / clip.w;
                let is_near = -view.world_to_view.transform_point3(point).z < view.near_m;
                if light.reach(point.as_dvec3()) <= 0.0 || is_near {
                    continue;
                }
                inside_cone += 1;
                let held =
                    ndc.truncate().abs().max_element() <= 1.0 && (0.0..=1.0).contains(&ndc.z);
                assert!(held, "{light:?} {point} {ndc}");
            }
        }
        assert!(inside_cone > 8000, "{inside_cone}");
    }

    #[test]
    fn lights_without_a_map_are_refused() {
        let bounds = (Vec3::ZERO, Vec3::ONE);
        let message = |light: Light, bounds| rsm_view(&light, 64, bounds).unwrap_err().to_string();
        let lamp = Light::point(Vec3::ONE, 1.0, Vec3::ONE);
        assert_eq!(message(lamp, bounds), "primary light is Point: it must be a spot");
        let wide = spot(Vec3::Y, Vec3::NEG_Y, 1.5);
        assert!(message(wide, bounds).contains("at most 1.396 radians"));
        let away = spot(Vec3::splat(9.0), Vec3::Y, 0.5);
        assert!(message(away, bounds).contains("sees a part"));
        let good = spot(Vec3::Y * 9.0, Vec3::NEG_Y, 0.5);
        assert!(message(good, (Vec3::ONE, Vec3::ZERO)).starts_with("scene bounds is"));
        assert!(message(good, (Vec3::NAN, Vec3::ONE)).starts_with("scene bounds is"));
        assert!(rsm_view(&good, 0, bounds).is_err());
        let flat = (Vec3::new(0.0, 1.0, 0.0), Vec3::new(1.0, 1.0, 0.0));
        assert!(rsm_view(&good, 64, flat).is_ok());
    }
}
