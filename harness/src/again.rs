//! `lightbench report`: metrics and charts again, from what earlier runs stored.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

use shading::HdrImage;

use crate::{
    cli::{CliError, ReportArgs},
    error::HarnessError,
    errors::{ImagePair, errors, stored},
    pictures::Pictures,
    report,
    results::{Record, Results, ResultsError},
    study::{Done, Manifest},
};

/// Makes the report of a comparison or of a study; returns what to print.
pub fn again(args: &ReportArgs) -> Result<String, HarnessError> {
    let Some(first) = args.folders.first() else {
        return Ok(String::new());
    };
    let out = args.out.as_ref().unwrap_or(first);
    if Manifest::find(first)?.is_some() {
        let mut done = Done::read(&args.folders)?;
        for (job, results) in &mut done.results {
            if let Some(folder) = done.folders.get(job) {
                refresh(results, folder)?;
                if args.out.is_none() {
                    results.write(&folder.join("results.json"))?;
                }
            }
        }
        return report::write_study(&done, out);
    }
    if args.out.is_some() && args.folders.len() > 1 {
        let value = out.display().to_string();
        let accepted = "left out where several comparisons are given: each keeps its own report";
        return Err(CliError::out_of_range("--out", &value, accepted).into());
    }
    let mut text = String::new();
    for folder in &args.folders {
        let mut results = Results::read(&folder.join("results.json"))?;
        refresh(&mut results, folder)?;
        let out = if args.folders.len() == 1 { out } else { folder };
        results.write(&out.join("results.json"))?;
        let page = report::write_html(&results, &pictures(&results, folder), out)?;
        text += &format!("{}\nreport   {}\n", report::render_table(&results), page.display());
    }
    Ok(text)
}

/// The pictures that records name, as far as they are there.
pub fn pictures(results: &Results, folder: &Path) -> Pictures {
    let mut pictures = Pictures::new();
    for record in &results.records {
        let images = &record.images;
        let names = [&images.image, &images.baseline, &images.difference, &images.heat_map];
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

/// Computes the errors of every record whose linear images are there, and its times.
fn refresh(results: &mut Results, folder: &Path) -> Result<(), HarnessError> {
    let mut store = Store { folder, images: HashMap::new() };
    for record in &mut results.records {
        record.set_times();
        let Some(image) = store.image(record.images.raw.as_ref())? else { continue };
        let exposure = record.images.exposure.unwrap_or(1.0) as f32;
        let mut reference = |name: &Option<String>| -> Result<_, HarnessError> {
            let Some(reference) = store.image(name.as_ref())? else { return Ok(None) };
            if (reference.width, reference.height) != (image.width, image.height) {
                let path = folder.join(name.as_deref().unwrap_or_default());
                let reason = format!(
                    "{}x{} pixels: it must be as large as {}, {}x{}",
                    reference.width,
                    reference.height,
                    record.images.raw.as_deref().unwrap_or_default(),
                    image.width,
                    image.height
                );
                return Err(ResultsError::Parse { path, reason }.into());
            }
            Ok(Some(reference))
        };
        let baseline = reference(&record.images.raw_baseline)?;
        let unbounded = reference(&record.images.raw_unbounded)?;
        let against = |reference: &HdrImage| {
            stored(errors(&ImagePair { image: &image, reference, exposure }))
        };
        if let Some(baseline) = baseline.filter(|_| !keeps_errors(record)) {
            record.errors = against(&baseline);
        }
        if let Some(unbounded) = unbounded {
            record.unbounded_errors = against(&unbounded);
        }
    }
    Ok(())
}

/// Whether a record's errors come from images that are not kept, or from none.
fn keeps_errors(record: &Record) -> bool {
    record.along_path || record.is_control()
}

/// Linear images of a folder, each read once.
struct Store<'a> {
    folder: &'a Path,
    images: HashMap<String, Option<Rc<HdrImage>>>,
}

impl Store<'_> {
    /// The image of a name; `None` where none is named or there.
    fn image(&mut self, name: Option<&String>) -> Result<Option<Rc<HdrImage>>, HarnessError> {
        let Some(name) = name.filter(|name| is_plain(name)) else { return Ok(None) };
        if let Some(known) = self.images.get(name) {
            return Ok(known.clone());
        }
        let path: PathBuf = self.folder.join(name);
        let image = match path.is_file() {
            true => Some(Rc::new(HdrImage::read_exr(&path)?)),
            false => None,
        };
        self.images.insert(name.clone(), image.clone());
        Ok(image)
    }
}

/// Whether a name is that of a file in the folder itself: results may come from anywhere.
fn is_plain(name: &str) -> bool {
    Path::new(name).file_name().is_some_and(|file| file == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(folder: &Path) -> ReportArgs {
        ReportArgs { folders: vec![folder.to_owned()], out: None }
    }

    #[test]
    fn names_that_lead_elsewhere_are_not_read() {
        assert!(is_plain("deferred-None.exr"));
        for name in ["../x.exr", "/etc/passwd", "a/b.png", "", ".."] {
            assert!(!is_plain(name), "{name}");
        }
    }

    #[test]
    fn a_folder_without_results_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let error = again(&of(folder.path())).unwrap_err().to_string();
        assert!(error.contains("results.json"), "{error}");
        let is_read = |error: &HarnessError| {
            matches!(error, HarnessError::Results(ResultsError::Read { .. }))
        };
        assert!(is_read(&again(&of(&folder.path().join("gone"))).unwrap_err()));
    }
}
