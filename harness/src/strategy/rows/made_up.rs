//! A family that only tests know: it shows what one row is enough for.

use assign::Everything;

use super::super::{Colour, Method, Role, Row, Sizes};

/// The family's name.
pub(crate) const FAMILY: &str = "Made-Up";

pub(super) const ROWS: &[Row] = &[Row {
    family: FAMILY,
    name: "made-up boxes",
    about: "a family of the tests",
    role: Role::Engine,
    source: "no paper",
    krate: "assign",
    parameters: &["boxes"],
    default: "7",
    sizes: Sizes { few: &["5", "9"], many: &["5", "7", "9"] },
    has_groups: true,
    colour: Colour { light: "#00594f", dark: "#d4ff5c" },
    make: |gpu, _| Ok(Method::lists(Everything::new(gpu)?)),
    ..Row::PLAIN
}];
