//! The report of a study, from made-up records: its words, its files, and the page in a browser.

mod browser;
mod made_study;
mod made_up;
mod report_data;

use browser::{USE_EVERYTHING, body, dump, html_tag};
use harness::results::Mode;
use made_up::{Maker, Written, study, verdict, whole, write};
use report_data::record;

#[test]
fn the_words_name_the_best_with_its_interval_and_every_chart_is_a_file() {
    let Written { text, page, charts } = whole("");
    let headline = "On llvmpipe at 10,000 lights, DC-E/64x64x40 is fastest in atrium";
    assert!(text.contains(headline), "{text}");
    assert!(text.contains("DC-E means \u{201c}dense clusters, explicit bounds\u{201d}."), "{text}");
    let finding = "In atrium at 100 lights, DC-I/128x128x64 is fastest. It takes 1.";
    assert!(text.contains(finding), "{text}");
    assert!(text.contains("The next fastest is G/20x20x20 with"), "{text}");
    assert!(text.contains("A relMSE of"), "{text}");
    assert!(text.contains("not GPU figures") && page.contains("do not apply to a GPU"));
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
        "sizes-t-e-bvh",
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
    let results = done.results.get_mut("atrium-path-10000").expect("it is there");
    let best = results
        .records
        .iter()
        .find(|r| r.strategy.family() == "SC-E")
        .expect("it is there")
        .clone();
    for record in results.records.iter_mut().filter(|r| r.strategy.family() == "DC-E") {
        record.times.passes = best.times.passes.clone();
        record.set_times();
    }
    let Written { text, page, .. } = write(&done);
    let tie = "DC-E/64x64x40 and SC-E/48x48x40 tie for fastest";
    assert!(text.contains(&format!("On llvmpipe at 10,000 lights, {tie} in atrium")), "{text}");
    assert!(text.contains(&format!("In atrium at 10,000 lights, {tie}. They take")), "{text}");
    assert!(!text.contains("E/48x48x40 is fastest"), "a tie has no winner: {text}");
    assert!(text.contains("DC-E/64x64x40 and SC-E/48x48x40 tie: "), "{text}");
    assert_eq!(verdict(&page, "dense"), "differs");
    assert_eq!(verdict(&page, "many"), "holds");
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
                record.setting.lights = lights;
                record
            });
            maker.add(mode, &lights.to_string(), records.to_vec());
        }
    }
    let Written { text, page, charts } = write(&maker.done);
    assert_eq!(charts.len(), 2, "{charts:?}");
    assert!(
        text.contains(
            "In atrium at 500 lights, without a loss: SC-E/48x48x40/bvh is fastest with deferred lighting ("
        ),
        "{text}"
    );
    // Means that are alike have no winner.
    let results = maker.done.results.get_mut("atrium-deferred-500").expect("it is there");
    let best = results.records[3].times.passes.clone();
    results.records[2].times.passes = best;
    results.records[2].set_times();
    let Written { text, .. } = write(&maker.done);
    assert!(text.contains("Sphere and SC-E/48x48x40/bvh tie with deferred lighting ("), "{text}");
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
                    record.times.passes = Default::default();
                    record.set_times();
                    record.setting.lights = 0;
                }
            }
            2 => {
                for record in &mut results.records {
                    (record.times.assign_ms, record.times.shade_ms) = (f64::NAN, f64::INFINITY);
                    record.strategy = "</script><script>throw 1</script>/\u{1f4a1}".into();
                    record.image.files.tone_mapped = Some("../../etc/passwd".into());
                }
            }
            _ => {}
        }
    }
    let page = write(&done).page;
    let Some(dom) = dump(&page, 1200) else { return };
    assert!(html_tag(&dom).contains("data-ready=\"1\"") && !html_tag(&dom).contains("data-error"));
}

/// A foreign file may hold anything in its names: pages show it and run none of it.
#[test]
fn names_of_foreign_results_are_text() {
    const ODD: &str = "<img src=x onerror=alert(1)>\"'\u{1b}[2J\u{202e}";
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (kind, _) in harness::study::studies() {
        let mut done = study("", folder.path());
        done.manifest.study = kind.into();
        for (ix, job) in done.manifest.jobs.iter_mut().enumerate() {
            job.scene = format!("atrium{ODD}");
            // The sections of the other studies.
            job.section = match (kind, ix % 5) {
                ("comparison", _) => job.section.clone(),
                ("culling", 0) => "deferred".into(),
                ("endless", 0) => "a".into(),
                ("engines", 0) => "path".into(),
                ("engines", 1) => "view".into(),
                ("area" | "cdi", 0) => "models".into(),
                ("area", 1) => "cost".into(),
                ("cdi", 1) => "steps".into(),
                ("cdi", 2) => "strategies".into(),
                _ => format!("{}{ODD}", job.section),
            };
        }
        for results in done.results.values_mut() {
            results.machine.adapter = ODD.into();
            results.machine.commit += ODD;
            results.command.push(ODD.into());
            results.warnings.push(ODD.into());
            for (ix, record) in results.records.iter_mut().enumerate() {
                record.setting.scene = ODD.into();
                record.strategy = match ix % 3 {
                    0 => format!("{}/{ODD}", record.strategy).into(),
                    1 => format!("{ODD}/{}", record.strategy).into(),
                    _ => record.strategy.clone(),
                };
                let odd = || Some(ODD.to_owned());
                (record.setting.radii, record.setting.cut, record.setting.area_model) =
                    (odd(), odd(), odd());
                record.image.truth_errors = record.image.errors.clone();
                record.setting.light_kinds.insert(ODD.into(), 1);
            }
        }
        let page = write(&done).page;
        assert!(page.contains("&lt;img src=x onerror"), "{kind}: it is shown");
        assert!(!page.contains("<img src=x"), "{kind}: it is markup");
        let escape = ["\u{1b}", "\u{202e}"].map(|odd| page.contains(odd));
        assert!(!escape[0], "{kind}: a terminal's escape");
    }
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
