//! The window that bounds a light's reach, and inverse-square fall-off inside it, in f64.
//!
//! `window.wesl` has the same functions in f32. A plugged-in renderer imports them from
//! `package::window`; with the flag `hard_cut`, lights end at their range without a window. With the flag
//! `no_cut` they do not end at all, which only a test of what culling then loses should use.

/// The least squared distance of inverse-square fall-off, square metres.
pub const MIN_DISTANCE_2: f64 = 1e-4;

/// The window `(1 - (d / range)^4)^2`, clamped at 0, of the squared distance `d^2` to the closest point
/// of the emitter, square metres.
pub fn range_window(distance_2: f64, range_m: f64) -> f64 {
    (1.0 - (distance_2 / (range_m * range_m)).powi(2)).max(0.0).powi(2)
}

/// Inverse-square fall-off times [`range_window`], per square metre. It stops growing where
/// `distance_2` is below `least_2`, square metres: [`MIN_DISTANCE_2`] or more.
pub fn fall_off(distance_2: f64, range_m: f64, least_2: f64) -> f64 {
    range_window(distance_2, range_m) / distance_2.max(least_2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fall_off_ends_at_the_range() {
        assert_eq!(fall_off(4.0, 2.0, MIN_DISTANCE_2), 0.0);
        assert!(fall_off(3.999, 2.0, MIN_DISTANCE_2) > 0.0);
        assert_eq!(fall_off(0.0, 2.0, MIN_DISTANCE_2), 1e4);
    }
}
