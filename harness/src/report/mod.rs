//! Views of the results: a table for the terminal and a page for the browser.
//!
//! Both show the same columns (`metrics`), computed from the same comparisons: the
//! records that differ in nothing but the strategy.

mod colours;
mod column;
mod comparison;
mod finding;
mod fit;
mod format;
mod frames;
mod html;
mod lead;
mod looks;
mod loss;
mod markdown;
mod markup;
mod metrics;
mod page;
mod panels;
mod pass_bars;
mod picture_pair;
mod rank;
mod raster;
mod samples;
mod section;
mod study;
mod table;
mod terminal;
mod terms;

pub use finding::{finding, lights, notices};
pub use format::significant;
pub use html::{render_html, write_html};
pub use lead::needs_built_hierarchy;
pub use loss::error_words;
pub use markdown::render_markdown;
pub use rank::{indistinguishable, is_surely_faster, listed};
pub use study::{claims_markdown, write_study};
pub use table::TABLE_WIDTH;
pub use terminal::render_table;
