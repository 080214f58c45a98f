//! What the engine paper (Dobetsberger 2025) claims of models of area lights, and what decides each claim
//! in one scene.

mod absent;
mod cost;
mod errors;
mod ltc;

use self::absent::{CPU, LPIPS, MANY_SAMPLES};
use self::cost::{FASTER, LIGHTS_OR_SAMPLES, MRP_GAIN, ONE_LIGHT, ONE_SAMPLE, SPOTS_RATIO};
use self::errors::{BALLS, FRESNEL, MORE_SAMPLES, MRP_FLIP, REGION_BIAS, REGION_NOISE};
use self::ltc::{
    LEAST, POLYNOMIAL_FIT, POLYNOMIAL_IMAGE, SPLITTING, SPLITTING_COST, TABLE_OR_POLYNOMIAL, TABLES,
};
use crate::study::claims::{Check, Paper};

/// Dobetsberger 2025.
pub(crate) const PAPER: Paper = Paper {
    name: "the engine paper",
    about: "Dobetsberger 2025 added rectangle lights to the Godot engine and timed whole frames on \
            its own GPU. Its truth is a path tracer\u{2019}s image with another BRDF, and it \
            fitted light intensities per model until FLIP was least. Here the truth integrates \
            the shader\u{2019}s own BRDF, and no intensity is fitted. Scenes, views and lights \
            differ.",
    checks: &CHECKS,
};

const CHECKS: [Check; 22] = [
    BALLS,
    REGION_NOISE,
    MORE_SAMPLES,
    REGION_BIAS,
    FRESNEL,
    TABLES,
    POLYNOMIAL_FIT,
    POLYNOMIAL_IMAGE,
    TABLE_OR_POLYNOMIAL,
    SPLITTING,
    SPLITTING_COST,
    LEAST,
    MRP_FLIP,
    LPIPS,
    ONE_LIGHT,
    MRP_GAIN,
    ONE_SAMPLE,
    LIGHTS_OR_SAMPLES,
    MANY_SAMPLES,
    CPU,
    SPOTS_RATIO,
    FASTER,
];
