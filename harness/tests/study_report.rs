//! The report of a study, from made-up records: its words, its files, and the page in a browser.

mod browser;
mod report_data;

use std::collections::BTreeMap;
use std::path::Path;

use browser::{USE_EVERYTHING, body, dump, html_tag};
use harness::report::write_study;
use harness::results::{Mode, PassKind, PassTimes, Record, Results};
use harness::study::{Done, Job, Manifest};
use report_data::{empty, pictures, record};

/// The claims of the comparison paper, by their ids.
const CLAIMS: [&str; 7] = ["linear", "bounds", "many", "few", "tests", "steady", "models"];

const FAMILIES: [&str; 9] = [
    "T-I/28x28",
    "T-E/28x28",
    "DC-I/128x128x64",
    "DC-E/64x64x40",
    "SC-I/48x48x40",
    "SC-E/48x48x40",
    "G/20x20x20",
    "M",
    "M/2",
];

/// Offset and slope of a strategy, ms and ms per light: as the paper has it.
fn line(strategy: &str) -> (f64, f64) {
    match strategy.split('/').next().expect("it is there") {
        "T-I" => (3.0, 4.0e-3),
        "T-E" => (5.0, 2.0e-3),
        "DC-I" => (1.0, 3.0e-3),
        "DC-E" => (4.0, 1.0e-3),
        "SC-I" => (4.5, 1.6e-3),
        "SC-E" => (6.0, 0.4e-3),
        "G" => (2.5, 2.5e-3),
        _ if strategy == "M" => (20.0, 0.2),
        _ => (8.0, 5.0e-3),
    }
}

/// A made-up study in which every claim holds but the one that is turned round.
struct Maker {
    turned: &'static str,
    done: Done,
}

impl Maker {
    fn new(turned: &'static str) -> Self {
        let identity = ["lightbench", "study", "comparison"].map(str::to_owned).to_vec();
        let manifest = Manifest { identity, study: "comparison".into(), jobs: Vec::new() };
        let done = Done { manifest, results: BTreeMap::new(), folders: BTreeMap::new() };
        Self { turned, done }
    }

    fn add(&mut self, section: &str, variant: &str, records: Vec<Record>) {
        let name = format!("atrium-{section}-{variant}");
        self.done.manifest.jobs.push(Job {
            name: name.clone(),
            scene: "atrium".into(),
            section: section.into(),
            command: vec!["lightbench".into(), "compare".into()],
        });
        let results = Results { records, ..empty() };
        self.done.results.insert(name, results);
    }

    /// Every strategy at a count of lights.
    fn all(&self, lights: u64) -> Vec<Record> {
        let make = |id: &&str| {
            let (offset, slope) = line(id);
            let count = lights as f64;
            let mut times = [offset * 0.5, offset * 0.5 + slope * count];
            if self.turned == "linear" {
                times[1] = offset + (count / 3_000.0 - 1.0).powi(2) * 50.0;
            }
            let slow = match self.turned {
                "many" => lights == 10_000 && id.starts_with("SC-E"),
                "few" => lights == 100 && (id.starts_with("DC-I") || id.starts_with('G')),
                "models" => *id == "M/2",
                _ => false,
            };
            if slow {
                times[1] += 5_000.0;
            }
            let mut record = record(id, Mode::Deferred, times[0], times[1]);
            record.lights = lights;
            record.listed_per_sample = Some(match (*id, self.turned) {
                ("M", _) => 100.0,
                ("M/2", "models") => 200.0,
                _ => 5.0,
            });
            record
        };
        FAMILIES.iter().map(make).collect()
    }

    fn scaling(&self, lights: u64) -> Vec<Record> {
        let mut records = self.all(lights);
        if self.turned == "bounds" {
            for record in &mut records {
                let id = &record.strategy;
                record.strategy = if id.contains("-I") {
                    id.replacen("-I", "-E", 1)
                } else {
                    id.replacen("-E", "-I", 1)
                };
                // Even the depth pre-pass does not raise their offset then.
                record.passes.insert("depth", PassTimes::new(PassKind::Scene, vec![0.01; 8]));
            }
        }
        records
    }

    fn tests(&self, family: &str) -> Vec<Record> {
        let time = |union: &str| match (union, self.turned) {
            ("hs+sat-n", "tests") => 30.0,
            ("hs+sat-n", _) => 5.0,
            _ => 10.0,
        };
        let make = |union: &&str| {
            let mut record = record(&format!("{family}/{union}"), Mode::Deferred, 5.0, time(union));
            record.strategy_parameters.insert("tests".into(), (*union).into());
            record
        };
        ["hs", "hs+sat-n", "hs+sat-v"].iter().map(make).collect()
    }

    fn path(&self) -> Vec<Record> {
        let mut records = self.all(10_000);
        for record in &mut records {
            let steady = record.strategy.starts_with("SC-E") != (self.turned == "steady");
            let swing = if steady { 0.02 } else { 0.4 };
            let frames = (0..40).map(|f| 10.0 * (1.0 + swing * (f64::from(f) / 6.0).sin()));
            record.passes.insert("shade", PassTimes::new(PassKind::Shade, frames.collect()));
            record.passes.insert("cull", PassTimes::new(PassKind::Assign, vec![1.0; 40]));
            record.passes.insert("bounds", PassTimes::new(PassKind::Assign, vec![1.0; 40]));
            (record.frames, record.rounds, record.along_path) = (40, 40, true);
            record.set_times();
        }
        records
    }

    /// Exact and capped lists, with pictures in a folder.
    fn caps(&self, folder: &Path) -> Vec<Record> {
        let mut records = Vec::new();
        for (family, time) in [("T-E/28x28/bvh", 12.0), ("SC-E/48x48x40/bvh", 8.0)] {
            for (knob, share, error) in
                [("", 1.0, 0.0), ("/cap4", 0.5, 0.2), ("/cap16", 0.8, 0.005)]
            {
                let id = format!("{family}{knob}");
                let mut record = record(&id, Mode::Deferred, 2.0, time * share);
                record.is_lossy = !knob.is_empty();
                (record.max_abs_diff, record.differing_channels) =
                    (Some(error), Some(u64::from(record.is_lossy) * 9));
                let errors = [("rel_mse", error), ("flip", error * 0.5), ("bias", f64::NAN)];
                record.errors = errors
                    .map(|(id, e)| (id.to_owned(), e.is_finite().then_some(e)))
                    .into_iter()
                    .collect();
                record.images.baseline = Some("None.png".into());
                records.push(record);
            }
        }
        let results = Results { records, ..empty() };
        for (name, png) in pictures(&results) {
            std::fs::write(folder.join(name), png).expect("writes");
        }
        results.records
    }
}

/// A whole study; pictures are kept in a folder.
fn study(turned: &'static str, folder: &Path) -> Done {
    let mut maker = Maker::new(turned);
    for lights in [100, 10_000] {
        let mut records = maker.all(lights);
        let mut none = record("None", Mode::Deferred, 0.0, 0.2 * lights as f64);
        none.lights = lights;
        records.insert(0, none);
        maker.add("main", &lights.to_string(), records);
    }
    for lights in [100, 1_000, 3_000, 10_000] {
        maker.add("scaling", &lights.to_string(), maker.scaling(lights));
    }
    for family in ["T-I/28x28", "SC-I/48x48x40"] {
        maker.add("tests", &family[..3], maker.tests(family));
    }
    for family in ["T-E", "SC-E"] {
        let sizes = ["16x16", "32x32"].map(|size| {
            record(&format!("{family}/{size}/bvh"), Mode::Deferred, 3.0, size.len() as f64)
        });
        maker.add("sizes", family, sizes.to_vec());
    }
    maker.add("path", "10000", maker.path());
    for view in ["low", "high"] {
        maker.add("views", view, maker.all(10_000));
    }
    for (section, lights) in [("growing", 30_000), ("constant", 30_000)] {
        let mut records = maker.all(lights);
        for record in &mut records {
            record.strategy += "/bvh";
        }
        maker.add(section, "30000", records);
    }
    for radii in ["gamma", "equal"] {
        let mut records = maker.all(10_000);
        for record in &mut records {
            record.radii = Some(radii.into());
        }
        maker.add("radii", radii, records);
    }
    maker.add("caps", "all", maker.caps(folder));
    let mut reuse = maker.path();
    for (record, error) in reuse.iter_mut().zip([0.1, 0.2, 0.3]) {
        record.strategy += "/reuse2";
        record.is_lossy = true;
        record.errors.insert("rel_mse".into(), Some(error));
    }
    maker.add("reuse", "all", reuse);
    for cut in ["windowed", "hard"] {
        let mut records = maker.all(10_000);
        for record in &mut records {
            (record.cut, record.threshold) = (Some(cut.into()), Some(0.01));
            record.unbounded_errors.insert("rel_mse".into(), Some(0.3));
        }
        maker.add("ranges", cut, records);
    }
    let mut done = maker.done;
    for name in ["atrium-caps-all", "atrium-views-low", "atrium-views-high"] {
        done.folders.insert(name.into(), folder.to_owned());
    }
    let heat: Vec<_> = done.results["atrium-views-low"].records.to_vec();
    for (name, png) in pictures(&Results { records: heat, ..empty() }) {
        std::fs::write(folder.join(name), png).expect("writes");
    }
    done
}

struct Written {
    text: String,
    page: String,
    charts: Vec<String>,
}

fn write(done: &Done) -> Written {
    let out = tempfile::tempdir().expect("a temporary folder");
    let text = write_study(done, out.path()).expect("it is there");
    let page = std::fs::read_to_string(out.path().join("index.html")).expect("it is there");
    let data = std::fs::read_to_string(out.path().join("study-data.json")).expect("it is there");
    serde_json::from_str::<serde_json::Value>(&data).expect("it is there");
    let mut charts = Vec::new();
    if let Ok(files) = std::fs::read_dir(out.path().join("charts")) {
        for file in files {
            let path = file.expect("it is there").path();
            assert!(std::fs::read_to_string(&path).expect("it is there").contains("<svg"));
            charts.push(path.file_name().expect("it is there").to_string_lossy().into_owned());
        }
    }
    Written { text, page, charts }
}

fn whole(turned: &'static str) -> Written {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&study(turned, folder.path()))
}

fn verdict<'a>(page: &'a str, claim: &str) -> &'a str {
    let start = format!("data-claim=\"{claim}\" data-verdict=\"");
    page.split_once(&start).expect("the claim").1.split('"').next().expect("it is there")
}

#[test]
fn every_claim_holds_where_the_figures_say_so_and_fails_where_they_are_turned_round() {
    let page = whole("").page;
    for claim in CLAIMS {
        assert_eq!(verdict(&page, claim), "holds", "{claim}");
    }
    for turned in CLAIMS {
        let page = whole(turned).page;
        assert_eq!(verdict(&page, turned), "fails", "{turned}, turned round");
    }
}

/// T-E pays for the depth pre-pass of 21.4 ms, T-I does not, and a renderer that draws one anyway bills
/// neither.
#[test]
fn both_bills_of_explicit_bounds_are_shown() {
    let Written { text, .. } = whole("");
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let (_, of_tiles) = text.split_once("; T: slope").or(text.split_once(": T: slope")).expect("T");
    let of_tiles = of_tiles.split(';').next().expect("T");
    let numbers: Vec<f64> = of_tiles
        .split(|c: char| !c.is_ascii_digit() && c != '.')
        .filter_map(|number| number.parse().ok())
        .collect();
    let [_, implicit, explicit, implicit_without, explicit_without] = numbers[..] else {
        panic!("{of_tiles}");
    };
    assert!((implicit - implicit_without).abs() < 0.1, "{of_tiles}");
    assert!((explicit - explicit_without - 21.4).abs() < 1.0, "{of_tiles}");
    assert!((2.5..3.5).contains(&implicit) && (4.5..5.5).contains(&explicit_without), "{of_tiles}");
    assert!(of_tiles.contains("with the depth pre-pass on the bill"), "{of_tiles}");
}

#[test]
fn the_words_name_the_best_with_its_interval_and_every_chart_is_a_file() {
    let Written { text, page, charts } = whole("");
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains("On llvmpipe at 10,000 lights, SC-E/48x48x40 is fastest"), "{text}");
    assert!(text.contains("In atrium at 100 lights, DC-I/128x128x64 is fastest with 1."), "{text}");
    assert!(text.contains("next is G/20x20x20 with"), "{text}");
    assert!(text.contains("A relMSE of"), "{text}");
    assert!(text.contains("not GPU figures") && page.contains("not a GPU\u{2019}s"));
    for part in [
        "accuracy", "ranges", "scaling", "density", "radii", "path", "frames", "views", "sizes",
        "tests", "main",
    ] {
        assert!(page.contains(&format!("data-part=\"{part}\"")), "{part}");
    }
    for chart in [
        "caps-rel-mse",
        "caps-flip",
        "reuse-rel-mse",
        "ranges-rel-mse",
        "scaling-linear",
        "growing",
        "constant",
        "path-10000",
        "views-sc-e",
        "sizes-t-e",
        "passes-100",
    ] {
        let name = format!("atrium-{chart}.svg");
        assert!(charts.contains(&name), "{name} of {charts:?}");
        assert!(page.contains(&format!("href=\"charts/{name}\"")), "{name} is linked");
    }
    // An error that is not finite has no chart.
    assert!(!charts.iter().any(|name| name.contains("bias")), "{charts:?}");
}

#[test]
fn a_tie_is_said() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut done = study("", folder.path());
    let results = done.results.get_mut("atrium-main-10000").expect("it is there");
    let best = results
        .records
        .iter()
        .find(|r| r.strategy.starts_with("SC-E"))
        .expect("it is there")
        .clone();
    for record in results.records.iter_mut().filter(|r| r.strategy.starts_with("DC-E")) {
        record.passes = best.passes.clone();
        record.set_times();
    }
    let Written { text, page, .. } = write(&done);
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    let tie = "DC-E/64x64x40 and SC-E/48x48x40 tie for fastest";
    assert!(text.contains(&format!("On llvmpipe at 10,000 lights, {tie} in atrium")), "{text}");
    assert!(text.contains(&format!("In atrium at 10,000 lights, {tie} with")), "{text}");
    assert!(!text.contains("E/48x48x40 is fastest"), "a tie has no winner: {text}");
    assert!(text.contains("DC-E/64x64x40 and SC-E/48x48x40 cannot be told apart"), "{text}");
    assert_eq!(verdict(&page, "many"), "differs");
}

#[test]
fn half_a_study_names_what_is_missing() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut done = study("", folder.path());
    let total = done.manifest.jobs.len();
    for name in ["atrium-main-10000", "atrium-path-10000", "atrium-caps-all"] {
        done.results.remove(name);
    }
    let Written { text, page, charts } = write(&done);
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains(&format!("{} of {total} jobs are done; missing: atrium-main-10000, atrium-path-10000 and atrium-caps-all.", total - 3)), "{text}");
    assert!(page.contains("missing: atrium-main-10000"));
    assert!(
        !charts.iter().any(|name| name.contains("caps") || name.contains("path")),
        "{charts:?}"
    );
    assert_eq!(verdict(&page, "steady"), "unknown");

    done.results.clear();
    let nothing = write(&done);
    assert!(
        nothing.charts.is_empty() && nothing.page.contains(&format!("0 of {total} jobs are done"))
    );
    done.manifest.jobs.clear();
    write(&done);
    done.manifest.study = "culling".into();
    write(&done);
}

#[test]
fn the_culling_survey_has_a_chart_and_fits_per_mode() {
    let mut maker = Maker::new("");
    maker.done.manifest.study = "culling".into();
    for (mode, kind) in [("deferred", Mode::Deferred), ("forward", Mode::Forward)] {
        for lights in [0, 250, 500] {
            let records = ["Clay", "None", "Sphere", "SC-E/48x48x40/bvh"].map(|id| {
                let mut record = record(id, kind, 0.0, 3.0 + lights as f64 * 0.1 / id.len() as f64);
                record.lights = lights;
                record
            });
            maker.add(mode, &lights.to_string(), records.to_vec());
        }
    }
    let Written { text, page, charts } = write(&maker.done);
    assert_eq!(charts.len(), 2, "{charts:?}");
    assert!(
        text.contains(
            "By the mean frame time in atrium at 500 lights, deferred SC-E/48x48x40/bvh leads ("
        ),
        "{text}"
    );
    // Means that are alike have no winner.
    let results = maker.done.results.get_mut("atrium-deferred-500").expect("it is there");
    let best = results.records[3].passes.clone();
    results.records[2].passes = best;
    results.records[2].set_times();
    let Written { text, .. } = write(&maker.done);
    assert!(text.contains("deferred Sphere and SC-E/48x48x40/bvh tie ("), "{text}");
    assert!(page.contains("data-part=\"deferred\"") && page.contains("data-part=\"forward\""));
}

#[test]
fn odd_records_do_no_harm() {
    let folder = tempfile::tempdir().expect("a temporary folder");
    let mut done = study("", folder.path());
    for (ix, results) in done.results.values_mut().enumerate() {
        match ix % 4 {
            0 => results.records.clear(),
            1 => {
                for record in &mut results.records {
                    record.passes = Default::default();
                    record.set_times();
                    record.lights = 0;
                }
            }
            2 => {
                for record in &mut results.records {
                    (record.assign_ms, record.shade_ms) = (f64::NAN, f64::INFINITY);
                    record.strategy = "</script><script>throw 1</script>/\u{1f4a1}".into();
                    record.images.image = Some("../../etc/passwd".into());
                }
            }
            _ => {}
        }
    }
    let page = write(&done).page;
    let Some(dom) = dump(&page, 1200) else { return };
    assert!(html_tag(&dom).contains("data-ready=\"1\"") && !html_tag(&dom).contains("data-error"));
}

/// From where a chart of errors begins.
fn caps(dom: &str) -> &str {
    let start = dom.find("data-errors=\"caps\"").expect("the chart of caps");
    let end = dom[start..].find("data-errors=\"reuse\"").expect("the next chart");
    &dom[start..start + end]
}

#[test]
fn points_open_pictures_and_buttons_switch_metrics() {
    let page = whole("").page;
    let Some(dom) = dump(&page, 1200) else { return };
    let tag = html_tag(&dom);
    assert!(tag.contains("data-ready=\"1\"") && !tag.contains("data-error"), "{tag}");
    let before = caps(body(&dom));
    assert!(!before.contains("type=\"range\"") && before.contains("data-panel=\"1\" hidden"));

    let clicks = "<script>
        const plot = document.querySelector('[data-errors=\"caps\"]');
        const lossy = [...plot.querySelectorAll('[data-key]')].find((mark) => mark.dataset.key.endsWith('cap4'));
        lossy.dispatchEvent(new MouseEvent('click', { bubbles: true }));
        plot.querySelectorAll('.choice button')[1].click();
    </script></body>";
    let dom = dump(&page.replace("</body>", clicks), 1200).expect("the browser is there");
    let tag = html_tag(&dom);
    assert!(!tag.contains("data-error"), "{tag}");
    let after = caps(body(&dom));
    assert!(after.contains("type=\"range\""), "the pair has a slider");
    assert_eq!(after.matches("<img").count(), 3, "two pictures and their difference");
    assert_eq!(after.matches("src=\"data:image/png").count(), 3);
    assert!(
        after.contains("data-panel=\"0\" hidden") && !after.contains("data-panel=\"1\" hidden")
    );

    let used = dump(&page.replace("</body>", USE_EVERYTHING), 390).expect("the browser is there");
    let tag = html_tag(&used);
    assert!(tag.contains("data-used=\"1\"") && !tag.contains("data-error"), "{tag}");
}

#[test]
fn no_page_is_wider_than_its_window() {
    let page = whole("").page;
    let measure = "<script>
        const root = document.documentElement;
        root.dataset.wide = String(root.scrollWidth > root.clientWidth);
    </script></body>";
    for width in [500, 1200] {
        let Some(dom) = dump(&page.replace("</body>", measure), width) else { return };
        assert!(html_tag(&dom).contains("data-wide=\"false\""), "{width}: {}", html_tag(&dom));
    }
    let widened = page.replace("</main>", "<div style=\"width:3000px\">x</div></main>");
    let dom = dump(&widened.replace("</body>", measure), 500).expect("the browser is there");
    assert!(html_tag(&dom).contains("data-wide=\"true\""), "the check can fail");
}
