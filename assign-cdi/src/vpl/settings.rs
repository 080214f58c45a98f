//! Settings: which blocks become VPLs, and which VPLs become lights.

use assign::{AssignError, MAX_RANGE_M, MIN_RANGE_M};

/// What happens to VPLs whose range is unknown or exceeds the largest.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Large {
    /// They are dropped: light that leaves the scene reaches no surface.
    Discard,
    /// They get the largest range.
    #[default]
    Clamp,
}

/// How VPLs are chosen and kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VplSettings {
    /// The largest width on the surface of a block of several texels that becomes one VPL, metres, 0 to
    /// [`MAX_RANGE_M`]. 0 makes one VPL per texel.
    pub spacing_m: f32,
    /// The most VPLs that fit, at least 1. `None` makes room for all texels. If more are chosen, the counts say how
    /// many, and [`VplBuffer::read`](crate::VplBuffer::read) fails.
    pub limit: Option<u32>,
    /// The light's range = this factor times the distance found. It is above 0 and at most 1e6. With 1, the light's
    /// window `(1 - (d / range)^4)^2` is 0 at the surface found; with 2 it is 0.88 there.
    pub range_scale: f32,
    /// Lights of smaller range are dropped, metres, [`MIN_RANGE_M`] to `max_range_m`.
    pub min_range_m: f32,
    /// The largest range of a light, metres, up to [`MAX_RANGE_M`].
    pub max_range_m: f32,
    /// What happens to larger or unknown ranges.
    pub large: Large,
    /// Closer than this distance, the inverse-square fall-off stays constant, metres, 0 to [`MAX_RANGE_M`].
    pub min_distance_m: f32,
}

impl Default for VplSettings {
    /// One VPL per texel; every VPL becomes a light.
    fn default() -> Self {
        Self {
            spacing_m: 0.0,
            limit: None,
            range_scale: 2.0,
            min_range_m: MIN_RANGE_M,
            max_range_m: MAX_RANGE_M,
            large: Large::Clamp,
            min_distance_m: 0.0,
        }
    }
}

impl VplSettings {
    /// Checks every field.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`], which names the first field out of its range.
    pub fn check(&self) -> Result<(), AssignError> {
        let length = format!("between 0 and {MAX_RANGE_M} metres");
        in_range("spacing_m", self.spacing_m, 0.0, MAX_RANGE_M, &length)?;
        if self.limit == Some(0) {
            return Err(AssignError::Parameter {
                field: "limit of VPLs".into(),
                value: "0".into(),
                accepted: "at least 1".into(),
            });
        }
        let scale = "above 0 and at most 1000000";
        in_range("range_scale", self.range_scale, f32::MIN_POSITIVE, 1e6, scale)?;
        let ranges = format!("between {MIN_RANGE_M} and {MAX_RANGE_M} metres");
        in_range("max_range_m", self.max_range_m, MIN_RANGE_M, MAX_RANGE_M, &ranges)?;
        let most = format!("between {MIN_RANGE_M} metres and max_range_m, {}", self.max_range_m);
        in_range("min_range_m", self.min_range_m, MIN_RANGE_M, self.max_range_m, &most)?;
        in_range("min_distance_m", self.min_distance_m, 0.0, MAX_RANGE_M, &length)
    }
}

fn in_range(
    field: &str,
    value: f32,
    least: f32,
    most: f32,
    accepted: &str,
) -> Result<(), AssignError> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(AssignError::Parameter {
        field: field.into(),
        value: value.to_string(),
        accepted: accepted.into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn errors_name_the_first_field_out_of_range() {
        let good = VplSettings::default();
        assert!(good.check().is_ok());
        for (bad, field) in [
            (VplSettings { spacing_m: -1.0, ..good }, "spacing_m is -1: it must be between 0"),
            (VplSettings { spacing_m: f32::NAN, ..good }, "spacing_m is NaN"),
            (VplSettings { limit: Some(0), ..good }, "limit of VPLs is 0: it must be at least 1"),
            (VplSettings { range_scale: 0.0, ..good }, "range_scale is 0"),
            (VplSettings { max_range_m: 2e9, ..good }, "max_range_m is 2000000000"),
            (VplSettings { min_range_m: 0.0, ..good }, "min_range_m is 0"),
            (VplSettings { min_range_m: 3.0, max_range_m: 2.0, ..good }, "min_range_m is 3"),
            (VplSettings { min_distance_m: f32::INFINITY, ..good }, "min_distance_m is inf"),
        ] {
            let error = bad.check().unwrap_err().to_string();
            assert!(error.starts_with(field), "{error}");
        }
    }
}
