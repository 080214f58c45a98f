//! How the radii of scattered lights are distributed.

use rand::Rng;
use rand_distr::{Distribution, Gamma, LogNormal};

use crate::SceneError;

/// Shape and scale of the radii's gamma distribution: mode 0.25, mean 1.0 (Enhuber 2019,
/// Eq. 4.3).
const GAMMA: (f64, f64) = (4.0 / 3.0, 0.75);

/// Standard deviation of the logarithm of [`Radii::LogNormal`].
const LOG_SPREAD: f64 = 1.0;

/// How the radii of scattered lights are distributed. Their mean is one metre times a scale.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Radii {
    /// Gamma with mode 0.25 (Enhuber 2019, equation 4.3).
    #[default]
    Gamma,
    /// All equal.
    Equal,
    /// Log-normal with a standard deviation of the logarithm of 1: many small, a few very large.
    LogNormal,
}

impl Radii {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Gamma, Self::Equal, Self::LogNormal];

    /// `gamma`, `equal` or `log-normal`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gamma => "gamma",
            Self::Equal => "equal",
            Self::LogNormal => "log-normal",
        }
    }
}

/// A distribution that radii are drawn from.
pub(crate) enum RadiusSource {
    Gamma(Gamma<f64>),
    Equal,
    LogNormal(LogNormal<f64>),
}

impl RadiusSource {
    pub(crate) fn new(radii: Radii) -> Result<Self, SceneError> {
        let fail = |value: String| SceneError::OutOfRange {
            field: "distribution of radii",
            value,
            accepted: "positive",
        };
        Ok(match radii {
            Radii::Gamma => {
                let gamma = Gamma::new(GAMMA.0, GAMMA.1);
                Self::Gamma(gamma.map_err(|_| fail(format!("{GAMMA:?}")))?)
            }
            Radii::Equal => Self::Equal,
            Radii::LogNormal => {
                let mean_of_log = -0.5 * LOG_SPREAD * LOG_SPREAD;
                let spread = LogNormal::new(mean_of_log, LOG_SPREAD);
                Self::LogNormal(spread.map_err(|_| fail(LOG_SPREAD.to_string()))?)
            }
        })
    }

    /// A radius, metres.
    pub(crate) fn sample(&self, rng: &mut impl Rng) -> f64 {
        match self {
            Self::Gamma(gamma) => gamma.sample(rng),
            Self::Equal => 1.0,
            Self::LogNormal(spread) => spread.sample(rng),
        }
    }
}
