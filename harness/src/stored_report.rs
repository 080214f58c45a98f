//! `lightbench report`: computes metrics and draws charts from what earlier runs stored.

use std::path::{Path, PathBuf};

use shading::HdrImage;

use crate::{
    cli::{CliError, ReportArgs},
    error::HarnessError,
    image_errors::{ImagePair, errors, stored},
    pictures::Pictures,
    report,
    results::{Record, Results},
    stored::{Store, is_plain},
    study::{Done, Manifest, check_study, complete, write_study},
};

/// The file of results in a folder.
const FILE: &str = "results.json";

/// Makes the report of a stored comparison or study. Returns what to print.
pub fn report_stored(args: &ReportArgs) -> Result<String, HarnessError> {
    let Some(first) = args.folders.first() else {
        return Ok(String::new());
    };
    let out = args.out.as_ref().unwrap_or(first);
    if first.is_dir() && Manifest::find(first)?.is_some() {
        let mut done = Done::read(&args.folders)?;
        check_study(&done, first)?;
        for (job, results) in &mut done.results {
            if let Some(folder) = done.folders.get(job) {
                refresh(results, folder)?;
            }
        }
        complete(&mut done)?;
        if args.out.is_none() {
            done.write_metrics()?;
        }
        return write_study(&done, out);
    }
    if args.out.is_some() && args.folders.len() > 1 {
        let value = out.display().to_string();
        let accepted = "left out for several comparisons, because each has its own report";
        return Err(CliError::out_of_range("--out", &value, accepted).into());
    }
    let mut text = String::new();
    for given in &args.folders {
        let Source { file, folder, report: default_out } = Source::find(given)?;
        let (mut results, lack) = Results::read_checked(&file)?;
        refresh(&mut results, &folder)?;
        if args.out.is_none() {
            results.write_metrics(&file)?;
        }
        if let Some(lack) = lack {
            // Only this report says so, not the metrics file.
            results.warnings.push(format!("{}: {lack}", file.display()));
        }
        let out = args.out.as_ref().unwrap_or(&default_out);
        let page = report::write_html(&results, &pictures(&results, &folder), out)?;
        text += &format!("{}\nreport   {}\n", report::render_table(&results), page.display());
    }
    Ok(text)
}

/// Where the results of a comparison are, and where their report goes.
struct Source {
    /// The file of results.
    file: PathBuf,
    /// The folder that holds it and its images.
    folder: PathBuf,
    /// The folder of its report if the command line names none.
    report: PathBuf,
}

impl Source {
    /// Finds the results in a folder that holds `results.json`, or in a file of results under any name.
    fn find(given: &Path) -> Result<Self, HarnessError> {
        if given.is_file() {
            let parent = given.parent().filter(|parent| !parent.as_os_str().is_empty());
            let folder = parent.unwrap_or(Path::new(".")).to_owned();
            let is_usual = given.file_name().is_some_and(|name| name == FILE);
            let report = if is_usual { folder.clone() } else { given.with_extension("") };
            if report == given {
                let value = given.display().to_string();
                let accepted = "a folder or a file that ends in .json";
                return Err(CliError::out_of_range("DIR", &value, accepted).into());
            }
            return Ok(Self { file: given.to_owned(), folder, report });
        }
        let file = given.join(FILE);
        let others = match file.is_file() {
            true => Vec::new(),
            false => json_files(given),
        };
        if let Some(first) = others.first() {
            let value = given.display().to_string();
            let accepted = format!(
                "a folder with {FILE} or a study, or a file of results; it holds {} .json files, \
                 such as {first}: give one of those",
                others.len()
            );
            return Err(CliError::out_of_range("DIR", &value, &accepted).into());
        }
        Ok(Self { file, folder: given.to_owned(), report: given.to_owned() })
    }
}

/// The paths of the .json files in a folder, in order; none if the folder cannot be read.
fn json_files(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut files: Vec<String> = entries
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "json"))
        .map(|path| path.display().to_string())
        .collect();
    files.sort();
    files
}

/// The pictures that records name, as far as their files exist.
pub fn pictures(results: &Results, folder: &Path) -> Pictures {
    let mut pictures = Pictures::new();
    for record in &results.records {
        let images = &record.image.files;
        let names = [&images.tone_mapped, &images.baseline, &images.difference, &images.heat_map];
        for name in names.into_iter().flatten() {
            if pictures.iter().all(|(known, _)| known != name)
                && is_plain(name)
                && let Ok(png) = std::fs::read(folder.join(name))
            {
                pictures.push((name.clone(), png));
            }
        }
    }
    pictures
}

/// Computes the times of every record, and its errors where the linear images exist.
fn refresh(results: &mut Results, folder: &Path) -> Result<(), HarnessError> {
    let mut store = Store::new(folder);
    for record in &mut results.records {
        record.set_times();
        let images = &record.image.files;
        let raw = images.raw.as_deref();
        let Some(image) = store.image(raw)? else { continue };
        let exposure = images.exposure.unwrap_or(1.0) as f32;
        let mut reference = |name: &Option<String>| {
            store.image_like(name.as_deref(), &image, raw.unwrap_or_default())
        };
        let baseline = reference(&images.raw_baseline)?;
        let unbounded = reference(&images.raw_unbounded)?;
        let against = |reference: &HdrImage| {
            stored(errors(&ImagePair { image: &image, reference, exposure }))
        };
        if let Some(baseline) = baseline.filter(|_| !keeps_errors(record)) {
            record.image.errors = against(&baseline);
        }
        if let Some(unbounded) = unbounded {
            record.image.unbounded_errors = against(&unbounded);
        }
    }
    Ok(())
}

/// Whether the stored errors stay: they come from images that were not kept, or from none.
fn keeps_errors(record: &Record) -> bool {
    record.setting.along_path || record.is_control()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::results::ResultsError;

    fn report_args(folder: &Path) -> ReportArgs {
        ReportArgs { folders: vec![folder.to_owned()], out: None }
    }

    #[test]
    fn an_error_names_the_folder_without_results() {
        let folder = tempfile::tempdir().unwrap();
        let error = report_stored(&report_args(folder.path())).unwrap_err().to_string();
        assert!(error.contains("results.json"), "{error}");
        let is_read = |error: &HarnessError| {
            matches!(error, HarnessError::Results(ResultsError::Read { .. }))
        };
        assert!(is_read(&report_stored(&report_args(&folder.path().join("gone"))).unwrap_err()));
    }

    #[test]
    fn a_single_file_is_read_and_a_folder_of_several_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("atrium.json");
        std::fs::write(&file, include_str!("results/example.json")).unwrap();
        let error = report_stored(&report_args(folder.path())).unwrap_err().to_string();
        assert!(error.contains("atrium.json") && error.contains("a file of results"), "{error}");
        report_stored(&report_args(&file)).unwrap();
        assert!(folder.path().join("atrium/index.html").is_file());
        assert!(!folder.path().join("index.html").exists());
        let out = folder.path().join("elsewhere");
        let args = ReportArgs { out: Some(out.clone()), ..report_args(&file) };
        report_stored(&args).unwrap();
        assert!(out.join("index.html").is_file(), "--out names the folder of the page");
    }
}
