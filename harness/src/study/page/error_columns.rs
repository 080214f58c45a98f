//! Columns of errors: one per metric.

use crate::image_errors::ERROR_METRICS;
use crate::report::column::{Better, Column};
use crate::report::format::difference;
use crate::results::Errors;

/// One column per metric of error, for rows that have errors.
pub(crate) fn error_columns<'a, T: 'a>(
    errors: fn(&T) -> &Errors,
) -> impl Iterator<Item = Column<'a, T>> {
    ERROR_METRICS.iter().map(move |metric| {
        let (id, head) = (metric.id, metric.head);
        let value = move |row: &T| errors(row).get(id).copied().flatten();
        Column::figure(head, "", Better::Less, value, difference)
    })
}
