//! Views of the results: a table for the terminal and a page for the browser.
//!
//! Both show the same columns (`metrics`), computed from the same comparisons: the
//! records that differ in nothing but the strategy.

mod comparison;
mod finding;
mod fit;
mod format;
mod frames;
mod html;
mod markdown;
mod metrics;
mod page;
mod rank;
mod raster;
mod study;
mod table;

pub use finding::{finding, notices};
pub use format::significant;
pub use html::{render_html, write_html};
pub use markdown::render_markdown;
pub use rank::indistinguishable;
pub use study::write_study;
pub use table::{TABLE_WIDTH, render_table};
