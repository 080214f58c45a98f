//! The user's settings of the culling driver: the tests, and where lights come from.

use std::{fmt, str::FromStr};

use crate::{AssignError, GroupShape, OcclusionTest, Storage};

/// Tests of a light against a frustum. A light is a hit unless a test separates it from the
/// frustum.
///
/// HS tests the half spaces of the planes. The other tests try separating axes (Enhuber 2019,
/// section 3.5.2): SAT-E the frustum's edges, SAT-N the axis from the light's centre to the nearest
/// corner, SAT-P the planes' normals, SAT-V the axes from the light's centre to every corner.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(clippy::struct_excessive_bools, reason = "a set of tests")]
pub struct FrustumTests {
    /// The half spaces of the six planes.
    pub hs: bool,
    /// Axes along the edges.
    pub sat_e: bool,
    /// The axis between the nearest corner and the light.
    pub sat_n: bool,
    /// The normals of the planes, in both directions.
    pub sat_p: bool,
    /// The axes between all corners and the light.
    pub sat_v: bool,
}

impl FrustumTests {
    /// No test at all. Parsing starts from it.
    const NONE: Self = Self { hs: false, sat_e: false, sat_n: false, sat_p: false, sat_v: false };

    /// Names of the tests and whether each is on, in the order in which they run.
    pub fn named(self) -> [(&'static str, bool); 5] {
        [
            ("hs", self.hs),
            ("sat-e", self.sat_e),
            ("sat-n", self.sat_n),
            ("sat-p", self.sat_p),
            ("sat-v", self.sat_v),
        ]
    }
}

impl Default for FrustumTests {
    /// HS+SAT-N: the comparison paper's choice (Enhuber 2019, section 4.3.2), and the fastest union
    /// on an H200: T-E/28x28 culls and shades Sponza in 0.280 ms with it, 0.334 with HS, 0.303 with
    /// HS+SAT-V and 0.322 with all but SAT-N (`results/h200-all/tests.json`).
    fn default() -> Self {
        Self { hs: true, sat_n: true, ..Self::NONE }
    }
}

impl fmt::Display for FrustumTests {
    /// As [`FromStr`] reads it: `hs+sat-n`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let on: Vec<&str> =
            self.named().into_iter().filter_map(|(name, on)| on.then_some(name)).collect();
        f.write_str(&on.join("+"))
    }
}

impl FromStr for FrustumTests {
    type Err = AssignError;

    /// Reads a union such as `hs+sat-n`, in any case.
    fn from_str(text: &str) -> Result<Self, AssignError> {
        let mut tests = Self::NONE;
        for name in text.to_lowercase().split('+') {
            let test = match name {
                "hs" => &mut tests.hs,
                "sat-e" => &mut tests.sat_e,
                "sat-n" => &mut tests.sat_n,
                "sat-p" => &mut tests.sat_p,
                "sat-v" => &mut tests.sat_v,
                _ => {
                    return Err(AssignError::Parameter {
                        field: "intersection test".into(),
                        value: text.into(),
                        accepted: "a union of hs, sat-e, sat-n, sat-p and sat-v, such as hs+sat-n"
                            .into(),
                    });
                }
            };
            *test = true;
        }
        Ok(tests)
    }
}

/// The volume that stands for a group in light tests.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Bounds {
    /// The whole volume of the group.
    Implicit,
    /// A volume around the samples in the group.
    Explicit,
}

/// Which lights a group's workgroup tests.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum LightSource {
    /// All lights.
    #[default]
    Linear,
    /// The lights below those nodes of the light hierarchy that reach the group; see
    /// [`LightBuffer`](crate::LightBuffer).
    Hierarchy,
}

/// The volume that stands for an area light.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum AreaBounds {
    /// The emitter's outline extended by the range, cut by the emitter's plane if it is one-sided.
    /// For a rectangle this is the exact support.
    #[default]
    Outline,
    /// The ball around the support: range plus half the diagonal (Dobetsberger 2025, equation 5.1).
    /// A baseline: its lists are complete too, but longer.
    Ball,
}

/// The user's settings of the culling driver. Lists are complete under any settings but `screen_rectangle`; with
/// `occlusion`, except for lights that add nothing because they are hidden.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct CullSettings {
    /// Tests of groups that are frusta. Boxes use the nearest point (NP, NPT), which is exact for
    /// balls.
    pub tests: FrustumTests,
    /// Which lights a group tests.
    pub source: LightSource,
    /// The volume that stands for an area light.
    pub area_bounds: AreaBounds,
    /// Where the lights that reach a group are kept.
    pub storage: Storage,
    /// **A flaw that loses lights**, to show what it does: a light must also touch the group inside a rectangle on
    /// the screen, its centre ± radius / depth. The projection of a ball is an ellipse, which reaches farther towards
    /// the border of a wide view (Mara and McGuire 2013, "2D Polyhedral Bounds of a Clipped, Perspective-Projected 3D
    /// Sphere"). Groups that are boxes ignore it.
    pub screen_rectangle: bool,
    /// The renderer's test of whether surfaces hide a light from a group. Lists then leave out hidden lights, and each
    /// frame must have [`occluders`](crate::Frame::occluders). `None` keeps every light in range.
    pub occlusion: Option<OcclusionTest>,
}

impl CullSettings {
    /// The part of an id that names these settings: `/hs`, `/bvh`, `/hs/bvh`, `/ball`, `/occ`, and the storage's
    /// name: `/mask`, `/tree`. Defaults add nothing, and tests appear only if groups are frusta.
    pub fn suffix(&self, shape: GroupShape) -> String {
        let mut suffix = String::new();
        let is_frustum = matches!(shape, GroupShape::Frustum | GroupShape::MaskedFrustum);
        if is_frustum && self.tests != FrustumTests::default() {
            suffix = format!("/{}", self.tests);
        }
        if self.source == LightSource::Hierarchy {
            suffix += "/bvh";
        }
        if self.area_bounds == AreaBounds::Ball {
            suffix += "/ball";
        }
        if let Some(name) = self.storage.name() {
            suffix += "/";
            suffix += name;
        }
        if self.occlusion.is_some() {
            suffix += "/occ";
        }
        if is_frustum && self.screen_rectangle {
            suffix += "/rect";
        }
        suffix
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unions_print_as_they_parse() {
        for text in ["hs", "hs+sat-n", "sat-e+sat-n+sat-p", "hs+sat-e+sat-p+sat-v"] {
            assert_eq!(text.parse::<FrustumTests>().unwrap().to_string(), text);
        }
        assert_eq!("SAT-N+HS".parse::<FrustumTests>().unwrap(), FrustumTests::default());
        for bad in ["", "sat", "hs,sat-n", "hs+"] {
            let error = bad.parse::<FrustumTests>().unwrap_err().to_string();
            assert!(error.contains("hs+sat-n"), "{bad}: {error}");
        }
    }
}
