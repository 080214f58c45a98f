//! The scene's models, or parts of them (`assign-model`).

use assign::{AssignError, Needs};
use assign_model::PerModel;

use super::super::{Axis, Colour, Method, Role, Row, Sizes, row::NEEDS_NOTHING};

pub(super) const ROWS: &[Row] = &[Row {
    family: "M",
    name: "models",
    about: "every model has a list of the lights that reach it. M/2 cuts models into parts of at most 2 m, \
            and every part has a list",
    role: Role::ComparisonPaper,
    source: "Enhuber 2019, section 3.4",
    krate: "assign-model",
    parameters: &["part_size_m"],
    variants: &["2"],
    axes: &[
        Axis::Source,
        Axis::AreaBounds,
        Axis::Storage,
        Axis::Occlusion,
        Axis::Order,
        Axis::Cap,
        Axis::Reuse,
        Axis::Keep,
        Axis::Touched,
        Axis::Exit,
    ],
    sizes: Sizes { few: &["1", "3", "4", "8"], many: &["1", "2", "4"] },
    has_groups: true,
    needs: Needs { models: true, ..NEEDS_NOTHING },
    colour: Colour { light: "#5b8fa8", dark: "#9ccbe0" },
    make: |gpu, options| {
        let part_size = part_size(&options.parameters)?;
        Ok(Method::lists(PerModel::new(gpu, part_size, options.settings())?))
    },
    ..Row::PLAIN
}];

/// The largest size of a part, metres; `None` leaves models whole.
fn part_size(text: &str) -> Result<Option<f32>, AssignError> {
    if text.is_empty() {
        return Ok(None);
    }
    text.parse().map(Some).map_err(|_| AssignError::Parameter {
        field: "size of a part".into(),
        value: text.into(),
        accepted: "a number of metres, such as 2".into(),
    })
}
