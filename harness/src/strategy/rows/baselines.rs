//! No culling, the control, and light volumes: families without groups.

use assign::Everything;
use shading::{Mode, RASTER_SPHERE_TOLERANCE};

use super::super::{Colour, Method, Refusal, Role, Row};

pub(super) const ROWS: &[Row] = &[NONE, CLAY, SPHERE, RASTER_SPHERE];

pub(super) const NONE: Row = Row {
    family: "None",
    name: "no culling",
    about: "every sample evaluates every light; the reference of all images",
    role: Role::Baseline,
    source: "Watrous 2024, Methods (no light culling)",
    krate: "assign",
    in_default: Some("None"),
    make: |gpu, _| Method::everything(gpu),
    ..Row::PLAIN
};

pub(super) const CLAY: Row = Row {
    family: "Clay",
    name: "control",
    about: "draws the surfaces without lights or textures; shows what drawing costs",
    role: Role::Control,
    source: "Watrous 2024, Methods (clay renderer)",
    krate: "shading",
    refuses: &[Refusal {
        modes: &[Mode::ForwardNoPrepass],
        why: "the control draws its surfaces behind a depth pre-pass",
    }],
    make: |_, _| Ok(Method::Clay),
    ..Row::PLAIN
};

pub(super) const SPHERE: Row = Row {
    family: "Sphere",
    name: "no culling with an early exit",
    about: "every sample tests every light and skips those that add nothing to it",
    role: Role::EarlyExit,
    source: "Watrous 2024, Methods (bounding sphere)",
    krate: "assign",
    in_default: Some("Sphere"),
    colour: Colour { light: "#4b67fa", dark: "#5f7bff" },
    make: |gpu, _| Ok(Method::lists(Everything::new(gpu)?)),
    ..Row::PLAIN
};

pub(super) const RASTER_SPHERE: Row = Row {
    family: "RasterSphere",
    name: "rasterised light volumes",
    about: "draws a sphere per light and adds the light up in the pixels that it covers, without lists",
    role: Role::OtherPaper,
    source: "Watrous 2024, Methods (raster sphere)",
    krate: "shading",
    refuses: &[Refusal {
        modes: &[Mode::Forward, Mode::ForwardNoPrepass],
        why: "light volumes read a G-buffer",
    }],
    shade_rasterises: true,
    tolerance: Some(RASTER_SPHERE_TOLERANCE),
    colour: Colour { light: "#a83a00", dark: "#d2691e" },
    make: |_, _| Ok(Method::RasterSphere),
    ..Row::PLAIN
};
