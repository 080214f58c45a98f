//! Charts as SVG, for a page (colours by class) or as a file of their own.

mod axis;
mod bars;
mod canvas;
mod direct;
mod domain;
mod histogram;
mod legend;
mod marks;
mod model;
mod number;
mod occupancy;
mod palette;
mod reduce;
mod strip;
mod style;
mod text;
mod ticks;
mod xy;

#[cfg(test)]
mod tests;

pub use bars::{BarChart, BarRow, Segment};
pub use histogram::{Histogram, histograms_svg, histograms_svg_file};
pub use model::{Axis, Marks, Point, Scale, Series, XyChart};
pub use palette::page_colours;
pub use strip::{Strip, half_width};
pub use style::CHART_CSS;
