//! Views of the results: a table for the terminal and a page for the browser.
//!
//! Both show the same columns (`metrics`), computed from the same comparisons: the
//! records that differ in nothing but the strategy.

pub(crate) mod bill;
pub(crate) mod colours;
pub(crate) mod column;
pub(crate) mod comparison;
pub(crate) mod explained;
mod families;
pub(crate) mod finding;
pub(crate) mod fit;
pub(crate) mod format;
pub(crate) mod frames;
pub(crate) mod frontier;
pub(crate) mod html;
pub(crate) mod lead;
pub(crate) mod living;
mod looks;
mod loss;
mod markdown;
pub(crate) mod markup;
pub(crate) mod metrics;
pub(crate) mod page;
pub(crate) mod panels;
pub(crate) mod pass_bars;
pub(crate) mod picture_pair;
pub(crate) mod rank;
pub(crate) mod raster;
mod samples;
pub(crate) mod section;
pub(crate) mod table;
pub(crate) mod terminal;
pub(crate) mod terms;

pub use families::{best_sizes_markdown, chosen_sizes_markdown};
pub use finding::{finding, lights, notices};
pub use format::significant;
pub use frontier::memory_chart;
pub use html::{render_html, write_html};
pub use lead::needs_built_hierarchy;
pub use loss::error_words;
pub use markdown::render_markdown;
pub use rank::{indistinguishable, is_surely_faster, listed};
pub use table::TABLE_WIDTH;
pub use terminal::render_table;
