//! Options whose values are named by their own type, such as `Radii::name`.

use clap::{
    ValueEnum,
    builder::{PossibleValue, PossibleValuesParser, TypedValueParser},
};

/// Accepts the names of these values. `--help` shows the line beside each value, and where all lines are empty, only the
/// names.
pub(super) fn named<T>(
    values: impl IntoIterator<Item = (T, &'static str)>,
    name: fn(T) -> &'static str,
) -> impl TypedValueParser<Value = T>
where
    T: Copy + Send + Sync + 'static,
{
    let values: Vec<(T, &'static str)> = values.into_iter().collect();
    let shown = values.iter().map(|(value, help)| {
        let shown = PossibleValue::new(name(*value));
        if help.is_empty() { shown } else { shown.help(*help) }
    });
    PossibleValuesParser::new(shown.collect::<Vec<_>>()).try_map(move |text| {
        let known = values.iter().find(|(value, _)| name(*value) == text);
        known.map(|(value, _)| *value).ok_or("one of the listed names")
    })
}

/// The name of a value on the command line.
pub fn name_of(value: &impl ValueEnum) -> String {
    value.to_possible_value().map_or_else(String::new, |value| value.get_name().to_owned())
}
