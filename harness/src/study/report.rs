//! The report of a study: one page, each chart as a file beside it, and the data.
//!
//! A study may be half done, or one shard of several. The page then names the jobs that are missing and
//! leaves out what was not measured. It shows, in this order: findings and notices, the claims of the
//! paper, and per scene the parts that the study makes.

use std::path::Path;

use super::claims;
use super::list;
use super::manifest::Done;
use super::page::frame;
use crate::error::HarnessError;
use crate::report::terminal::push_wrapped;
use crate::results::{ResultsError, write_atomically};

/// Writes the report of a study into a folder: `index.html`, `charts/*.svg` and `study-data.json`. Returns
/// what to print: findings, verdicts on the paper's claims, notices, and where the report is.
///
/// # Errors
///
/// Names the study where there is none of that name, or the path that cannot be written.
pub fn write_study(done: &Done, out: &Path) -> Result<String, HarnessError> {
    let page = frame::page(list::named(&done.manifest.study)?, done);
    let charts = out.join("charts");
    for (name, svg) in &page.charts.files {
        write_atomically(&charts.join(name), svg.as_bytes())?;
    }
    let data = out.join(frame::DATA);
    write_atomically(&data, page.data.as_bytes())?;
    let index = out.join("index.html");
    write_atomically(&index, page.html.as_bytes())?;
    let mut text = String::new();
    for words in &page.words {
        push_wrapped(&mut text, words);
    }
    text += &format!(
        "report   {}\ncharts   {}\ndata     {}\n",
        index.display(),
        charts.display(),
        data.display()
    );
    Ok(text)
}

/// Checks that this program has the study of a folder.
///
/// # Errors
///
/// Names the file, the study and the studies that there are.
pub fn check_study(done: &Done, folder: &Path) -> Result<(), ResultsError> {
    list::named(&done.manifest.study).map(|_| ()).map_err(|_| {
        let known: Vec<&str> = list::studies().map(|(name, _)| name).collect();
        let study = &done.manifest.study;
        let reason = format!("study is {study:?}: it must be one of {}", known.join(", "));
        ResultsError::Study { path: folder.join("study.json"), reason }
    })
}

/// Computes the errors that a study takes from the images of several jobs.
///
/// # Errors
///
/// Names the study where there is none of that name, or the image that cannot be read.
pub fn complete(done: &mut Done) -> Result<(), HarnessError> {
    (list::named(&done.manifest.study)?.after_run)(done)
}

/// The verdict on each claim of the paper that a study is held against, as a Markdown table; empty where
/// there is no such study.
pub fn claims_markdown(done: &Done) -> String {
    let Ok(study) = list::named(&done.manifest.study) else { return String::new() };
    claims::markdown(study.paper, &claims::judge(done, study.paper))
}
