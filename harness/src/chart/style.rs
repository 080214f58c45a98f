//! How charts look.

/// The rules that a page needs for the charts; they use its `--ink`, `--soft`, `--line` and
/// `--paper`, and the `--colour` that a series' class gives.
pub const CHART_CSS: &str = include_str!("chart.css");
