//! Claims of papers: what a claim is, how figures decide it, and how the page and the documents show it.
//!
//! A claim is one row of its study's `claims` folder: where the paper makes it, its words, the paper's
//! figures, how this study departs from the paper, and the function that decides it from the figures of one
//! scene. The paper's own statistic decides where the paper states one. Where it does not, `departure`
//! states our statistic and its limits.

mod claim;
mod markdown;
pub(crate) mod order;
mod table;
mod tally;
mod verdict;

pub(crate) use claim::{Check, Claim, Paper, capitalised, judge, on_another_gpu};
pub(crate) use markdown::markdown;
pub(crate) use table::claims_html;
pub(crate) use tally::{Outcome, Tally};
pub(crate) use verdict::{Answer, Verdict};
