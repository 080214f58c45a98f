//! The page in a real browser: headless Chromium, where one is installed.

mod browser;
mod report_data;

use browser::{USE_EVERYTHING, body, dump, html_tag};
use harness::report::render_html;
use harness::results::{Mode, Results};
use report_data::{empty, pictures, record, spoil, typical};

/// Renders, opens, and asserts that no script failed, before use and after.
fn check(what: &str, results: &Results, images: &[(String, Vec<u8>)]) -> Option<String> {
    let page = render_html(results, images);
    let dom = dump(&page, 1200)?;
    let tag = html_tag(&dom);
    assert!(tag.contains("data-ready=\"1\"") && !tag.contains("data-error"), "{what}: {tag}");

    let used = dump(&page.replace("</body>", USE_EVERYTHING), 390)?;
    let tag = html_tag(&used);
    assert!(tag.contains("data-used=\"1\"") && !tag.contains("data-error"), "{what}, used: {tag}");
    Some(dom)
}

/// The `data-value` and the text of all cells of a column, from top to bottom.
fn cells(dom: &str, metric: &str) -> Vec<(String, String)> {
    let start = format!("<td data-metric=\"{metric}\" data-value=\"");
    dom.split(&start)
        .skip(1)
        .map(|rest| {
            let (value, rest) = rest.split_once('"').expect("a value");
            let text = rest.split_once('>').expect("a cell").1;
            (value.to_owned(), text.split_once('<').expect("a cell").0.to_owned())
        })
        .collect()
}

#[test]
fn the_table_shows_the_data() {
    let mut results = typical();
    spoil(&mut results.records[5]);
    let Some(dom) = check("typical", &results, &pictures(&results)) else { return };
    let column = |metric| cells(&dom, metric);
    for (ix, record) in results.records.iter().enumerate() {
        let values = [
            ("both_ms", record.assign_and_shade_ms()),
            ("assign_ms", record.times.assign_ms),
            ("shade_ms", record.times.shade_ms),
            ("frame_ms", record.times.frame_ms),
            ("listed", record.lists.listed_per_sample.expect("measured")),
            ("contributing", record.lists.contributing_per_sample.expect("measured")),
            ("missed", record.lists.missed_pairs.expect("measured") as f64),
            ("max_diff", record.image.max_abs_diff.expect("measured")),
            ("lists_bytes", record.lists.list_bytes as f64),
            ("overflow", record.lists.overflowed_groups as f64),
        ];
        for (metric, expected) in values {
            let shown: f64 = column(metric)[ix].0.parse().expect("a number");
            assert_eq!(shown, expected, "{metric} of record {ix}");
        }
    }
    let texts = |metric| column(metric).into_iter().map(|(_, text)| text).collect::<Vec<_>>();
    assert_eq!(texts("missed"), ["0", "0", "0", "0", "0", "1,234"]);
    assert_eq!(texts("max_diff"), ["0", "0", "0", "0", "0", "0.0313"]);
    assert_eq!(texts("lists_bytes")[1], "1.25");
    let fault = dom.matches("class=\"fault\"").count();
    assert_eq!(fault, 3, "the missed pairs and the difference stand out");
    let rows = dom.matches("<g class=\"row\">").count();
    assert_eq!(rows, 2 * results.records.len(), "a bar per record on each of two axes");
    let strips = dom.matches("<svg class=\"strip\"").count();
    let passes: usize = results.records.iter().map(|r| r.times.passes.iter().count()).sum();
    assert_eq!(strips, passes, "a strip of samples per pass");
    assert_eq!(dom.matches("type=\"range\"").count(), 4, "a slider per strategy that culls");
    let pictures = dom.matches("<img data-picture=").count();
    let sources = dom.matches("src=\"data:image/png;base64,").count();
    assert!(pictures > 0 && pictures == sources, "{sources} of {pictures} pictures have a source");
}

/// The names in the first table, from top to bottom.
fn order(dom: &str) -> Vec<String> {
    let table = dom.split("<tbody>").nth(1).expect("a table");
    let table = table.split("</tbody>").next().expect("a table");
    let name = |row: &str| {
        let cell = row.split("</i>").nth(1)?.split("</th>").next()?;
        Some(
            cell.trim_start_matches("<span class=\"whole\">")
                .trim_end_matches("</span>")
                .to_owned(),
        )
    };
    table.split("<tr>").skip(1).filter_map(name).collect()
}

#[test]
fn a_heading_sorts() {
    let page = render_html(&typical(), &[]);
    let click = |times: usize| {
        let clicks =
            "document.querySelectorAll('table.results thead button')[6].click();".repeat(times);
        dump(&page.replace("</body>", &format!("<script>{clicks}</script></body>")), 1200)
    };
    let Some(ascending) = click(1) else { return };
    // By the time to shade.
    assert_eq!(order(&ascending), ["DC-I/32x32x32", "DC-I/64x64x24", "None"]);
    assert!(body(&ascending).contains("aria-sort=\"ascending\""));
    let descending = click(2).expect("the browser is there");
    assert_eq!(order(&descending), ["None", "DC-I/64x64x24", "DC-I/32x32x32"]);
    let original = click(3).expect("the browser is there");
    assert_eq!(order(&original), ["None", "DC-I/64x64x24", "DC-I/32x32x32"]);
    assert!(!body(&original).contains("aria-sort=\""));
}

#[test]
fn a_button_chooses_a_panel() {
    let page = render_html(&typical(), &[]);
    let shown = |dom: &str| {
        let panels = dom.split("<div data-panel=\"").skip(1).take(2);
        panels
            .map(|panel| !panel.split('>').next().unwrap_or("").contains("hidden"))
            .collect::<Vec<_>>()
    };
    let Some(before) = dump(&page, 1200) else { return };
    assert_eq!(shown(body(&before)), [true, false]);
    let click = "<script>document.querySelectorAll('[data-choose]')[1].click()</script></body>";
    let after = dump(&page.replace("</body>", click), 1200).expect("the browser is there");
    assert_eq!(shown(body(&after)), [false, true]);
}

#[test]
fn the_pixel_under_the_pointer_is_explained() {
    let results = typical();
    let page = render_html(&results, &pictures(&results));
    let Some(before) = dump(&page, 1200) else { return };
    assert!(body(&before).contains("Point at a pixel of a picture"));
    // To a quarter of the width and three quarters of the height.
    let point = "<script>
for (const picture of document.querySelectorAll('[data-explain]')) {
  const box = picture.getBoundingClientRect();
  const at = { bubbles: true, clientX: box.left + box.width / 4, clientY: box.top + box.height * 3 / 4 };
  picture.dispatchEvent(new PointerEvent('pointermove', at));
}
</script></body>";
    let after = dump(&page.replace("</body>", point), 1200).expect("the browser is there");
    let record = &results.records[1];
    let [x, y] = [record.setting.width / 4, record.setting.height * 3 / 4];
    let expected = format!("--strategies {} --pixel {x},{y}</p>", record.strategy);
    assert!(body(&after).contains(&expected), "{expected}");
    assert!(!html_tag(&after).contains("data-error"), "{}", html_tag(&after));
}

#[test]
fn a_failing_script_is_noticed() {
    let page = render_html(&typical(), &[]);
    let planted = "<script>throw new Error('planted')</script></body>";
    let Some(dom) = dump(&page.replace("</body>", planted), 1200) else { return };
    assert!(html_tag(&dom).contains("planted"), "{}", html_tag(&dom));
}

#[test]
fn odd_results_render() {
    let of = |records: Vec<harness::results::Record>| {
        let mut results = empty();
        results.records = records;
        results
    };
    let mut odd = record("DC-I/64x64x24", Mode::Deferred, 5.0, 20.0);
    odd.strategy = "</script><script>throw 1</script> \u{1f4a1} ".repeat(6).into();
    odd.setting.scene = "a \"scene\" with <b>markup</b> & a long, long name.gltf".to_owned();
    (odd.times.assign_ms, odd.times.frame_ms) = (f64::NAN, f64::NAN);
    odd.lists.listed_per_sample = None;
    odd.lists.contributing_per_sample = Some(f64::NAN);
    (odd.lists.missed_pairs, odd.image.max_abs_diff) = (None, None);
    let mut silent = record("None", Mode::Forward, 0.0, 0.0);
    silent.times.passes = Default::default();
    silent.setting.lights = 0;
    silent.set_times();
    let mut other_scene = record("None", Mode::Deferred, 0.0, 3.0);
    other_scene.setting.scene = "Sponza.gltf".to_owned();

    let several = of(vec![odd, silent, other_scene, record("Clay", Mode::Deferred, 0.0, 1.0)]);
    let Some(dom) = check("several", &several, &[]) else { return };
    assert!(cells(&dom, "assign_ms")[0] == (String::new(), "\u{2013}".to_owned()));
    assert!(dom.contains("No pictures were kept"));
    check("no records", &empty(), &[]);

    let one = of(vec![record("DC-I/64x64x24", Mode::Deferred, 5.0, 20.0)]);
    let dom = check("one record", &one, &pictures(&one)).expect("the browser is there");
    assert!(!dom.contains("type=\"range\""), "there is nothing to slide against");
}
