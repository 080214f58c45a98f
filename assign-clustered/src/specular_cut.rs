//! Which specular terms of area lights a list leaves out on purpose.

use assign::{AssignError, Facing};

use crate::Normals;

/// Which specular terms of area lights a list leaves out although they may reach its group. All variants but
/// [`None`](Self::None) are **lossy**.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum SpecularCut {
    /// No term.
    #[default]
    None,
    /// Terms whose upper bound over the group stays below this radiance (`gloss.wesl`). It needs bins of
    /// normals.
    Below(f32),
    /// Terms of lights whose diffuse term does not reach the group, if the group's normals do not mirror the
    /// light to the eye. Swarbrick 2025 tests only the middles of light and group, with a lobe of this half
    /// angle in degrees (`reflected.wesl`). It needs 6, 24 or 54 bins of normals, which leave out nothing else.
    ReflectedCone(f32),
    /// All terms of lights whose diffuse term does not reach the group: the paper's rows `dif`. It allows no bins
    /// of normals.
    WhereDiffuse,
}

/// Swarbrick's half angle of a lobe (2025, section 3.4.1), degrees.
pub const PAPERS_LOBE_DEGREES: f32 = 45.0;

/// Accepted limits of the cut below a radiance, without 0 itself.
const THRESHOLDS: std::ops::RangeInclusive<f32> = 0.0..=1e18;

impl SpecularCut {
    /// Checks the number, and that the bins of normals are what the cut needs.
    pub fn check(self, normals: Normals) -> Result<(), AssignError> {
        let fail = |field: &str, value: String, accepted: &str| {
            Err(AssignError::Parameter { field: field.into(), value, accepted: accepted.into() })
        };
        let bins = || match normals {
            Normals::None => "no bins".to_owned(),
            Normals::Bins(count) => format!("{count} bins"),
        };
        match self {
            Self::None => Ok(()),
            Self::Below(threshold) if !(THRESHOLDS.contains(&threshold) && threshold > 0.0) => {
                let accepted = "a radiance above 0, up to 1e18";
                fail("specular threshold", threshold.to_string(), accepted)
            }
            Self::Below(threshold) if !normals.is_some() => {
                fail("specular threshold", threshold.to_string(), "0, or come with bins of normals")
            }
            Self::ReflectedCone(degrees) if !(0.0..=180.0).contains(&degrees) => {
                fail("half angle of the lobe", degrees.to_string(), "0 to 180 degrees")
            }
            Self::ReflectedCone(_) if normals.bins() == 1 => {
                fail("number of normal bins of the cone test", bins(), "6, 24 or 54 bins")
            }
            Self::WhereDiffuse if normals.is_some() => {
                fail("number of normal bins of the cut `dif`", bins(), "no bins")
            }
            Self::Below(_) | Self::ReflectedCone(_) | Self::WhereDiffuse => Ok(()),
        }
    }

    /// Its segment of an id: `/s0.001`, `/cone45`, `/dif`, or nothing.
    pub(crate) fn segment(self) -> String {
        match self {
            Self::None => String::new(),
            Self::Below(threshold) => format!("/s{threshold}"),
            Self::ReflectedCone(degrees) => format!("/cone{degrees}"),
            Self::WhereDiffuse => "/dif".to_owned(),
        }
    }

    /// The number that shaders read: a radiance, or a half angle in radians.
    pub(crate) fn limit(self) -> f32 {
        match self {
            Self::None | Self::WhereDiffuse => 0.0,
            Self::Below(threshold) => threshold,
            Self::ReflectedCone(degrees) => degrees.to_radians(),
        }
    }

    /// Whether it needs to know how surfaces reflect.
    pub(crate) fn is_glossy(self) -> bool {
        matches!(self, Self::Below(_))
    }

    /// What the kernel must know about how groups face.
    pub(crate) fn facing(self, normals: Normals) -> Facing {
        match self {
            Self::None if normals.is_some() => Facing::Horizon,
            Self::None => Facing::Unknown,
            Self::Below(_) => Facing::HorizonAndGloss,
            Self::ReflectedCone(_) => Facing::ReflectedCone,
            Self::WhereDiffuse => Facing::WhereDiffuse,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cuts_with_the_wrong_normals_are_refused() {
        let bins = Normals::Bins;
        for (cut, normals) in [
            (SpecularCut::None, Normals::None),
            (SpecularCut::None, bins(1)),
            (SpecularCut::Below(0.01), bins(1)),
            (SpecularCut::ReflectedCone(45.0), bins(6)),
            (SpecularCut::WhereDiffuse, Normals::None),
        ] {
            cut.check(normals).unwrap();
        }
        let refused = |cut: SpecularCut, normals| cut.check(normals).unwrap_err().to_string();
        assert!(
            refused(SpecularCut::Below(0.01), Normals::None).contains("come with bins of normals")
        );
        assert!(refused(SpecularCut::Below(-1.0), bins(6)).contains("above 0"));
        assert!(refused(SpecularCut::Below(f32::NAN), bins(6)).contains("NaN"));
        let cone = SpecularCut::ReflectedCone(45.0);
        assert!(refused(cone, bins(1)).contains("is 1 bins: it must be 6, 24 or 54 bins"));
        assert!(refused(cone, Normals::None).contains("no bins"));
        assert!(refused(SpecularCut::ReflectedCone(181.0), bins(6)).contains("180 degrees"));
        assert!(refused(SpecularCut::WhereDiffuse, bins(6)).contains("6 bins"));
    }
}
