//! Which specular terms of area lights lists leave out on purpose.

use assign::{AssignError, Facing};

use crate::Normals;

/// Which specular terms of area lights a list leaves out beyond those that cannot reach its group. All but
/// [`None`](Self::None) are **lossy**.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum SpecularCut {
    /// None.
    #[default]
    None,
    /// Those whose upper bound over the group stays below this radiance: `gloss.wesl`. It takes normals.
    Below(f32),
    /// Beyond the reach of the light's diffuse term, those that the group's normals do not mirror to the
    /// eye, as Swarbrick 2025 tests it: middles only, and a lobe of this half angle, degrees
    /// (`reflected.wesl`). It takes 6, 24 or 54 bins of normals, and nothing else is left out by them.
    ReflectedCone(f32),
    /// All beyond the reach of the light's diffuse term: the paper's rows `dif`. It takes no normals.
    WhereDiffuse,
}

/// The half angle of a lobe in the paper (section 3.4.1), degrees.
pub const PAPERS_LOBE_DEGREES: f32 = 45.0;

/// How far the cut below a radiance goes.
const THRESHOLDS: std::ops::RangeInclusive<f32> = 0.0..=1e18;

impl SpecularCut {
    /// Checks the number, and that the normals are those that it takes.
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
                fail("specular threshold", threshold.to_string(), "0 without bins of normals")
            }
            Self::ReflectedCone(degrees) if !(0.0..=180.0).contains(&degrees) => {
                fail("half angle of the lobe", degrees.to_string(), "0 to 180 degrees")
            }
            Self::ReflectedCone(_) if normals.bins() == 1 => {
                fail("normals of the cone test", bins(), "6, 24 or 54 bins")
            }
            Self::WhereDiffuse if normals.is_some() => {
                fail("normals where specular light ends with diffuse light", bins(), "no bins")
            }
            Self::Below(_) | Self::ReflectedCone(_) | Self::WhereDiffuse => Ok(()),
        }
    }

    /// What an id says of it: `/s0.001`, `/cone45`, `/dif`, or nothing.
    pub(crate) fn segment(self) -> String {
        match self {
            Self::None => String::new(),
            Self::Below(threshold) => format!("/s{threshold}"),
            Self::ReflectedCone(degrees) => format!("/cone{degrees}"),
            Self::WhereDiffuse => "/dif".to_owned(),
        }
    }

    /// The number that the shaders get: a radiance, or a half angle in radians.
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

    /// What the kernel has to know of the groups.
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
    fn what_does_not_go_together_is_refused() {
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
        assert!(refused(SpecularCut::Below(0.01), Normals::None).contains("without bins"));
        assert!(refused(SpecularCut::Below(-1.0), bins(6)).contains("above 0"));
        assert!(refused(SpecularCut::Below(f32::NAN), bins(6)).contains("NaN"));
        let cone = SpecularCut::ReflectedCone(45.0);
        assert!(refused(cone, bins(1)).contains("is 1 bins: it must be 6, 24 or 54 bins"));
        assert!(refused(cone, Normals::None).contains("no bins"));
        assert!(refused(SpecularCut::ReflectedCone(181.0), bins(6)).contains("180 degrees"));
        assert!(refused(SpecularCut::WhereDiffuse, bins(6)).contains("6 bins"));
    }
}
