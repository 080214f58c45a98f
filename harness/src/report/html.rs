//! The page: one file with everything in it, opened from anywhere.

use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::json;

use super::comparison::comparisons;
use super::format::{number, short_adapter};
use super::markup::Html;
use super::page;
use super::{finding, frames, notices};
use crate::chart::page_colours;
use crate::results::{Results, ResultsError, write_atomically};

pub(super) const PAGE: &str = include_str!("report.html");
pub(super) const STYLE: &str = include_str!("report.css");

/// The page's programs, in the order in which they are read.
const SCRIPTS: [&str; 5] = [
    include_str!("report.js"),
    include_str!("bars.js"),
    include_str!("samples.js"),
    include_str!("lists.js"),
    include_str!("pictures.js"),
];

/// Writes `out_dir/index.html` and returns its path. `images` holds the pictures that records
/// name, as PNG files with their names; a record's picture that is not among them is said to be
/// missing.
///
/// # Errors
///
/// [`ResultsError::Write`] names the path that refused.
pub fn write_html(
    results: &Results,
    images: &[(String, Vec<u8>)],
    out_dir: &Path,
) -> Result<PathBuf, ResultsError> {
    let path = out_dir.join("index.html");
    write_atomically(&path, render_html(results, images).as_bytes())?;
    Ok(path)
}

/// The page as text: see [`write_html`].
pub fn render_html(results: &Results, images: &[(String, Vec<u8>)]) -> String {
    let findings = finding(results);
    let (headline, others) =
        findings.split_first().map_or_else(Default::default, |(first, others)| {
            (page::with_names_whole(first), page::paragraphs("finding", others))
        });
    fill(
        PAGE,
        &[
            ("title", title(results).into()),
            ("style", Html::trusted(STYLE.to_owned() + &page_colours())),
            ("headline", headline),
            ("findings", others),
            ("notices", page::notices(&notices(results))),
            ("comparisons", page::comparisons_html(results) + frames::sections(results)),
            ("columns", page::columns()),
            ("reading", Html::default()),
            ("file", "results.json".into()),
            ("link", "#from".into()),
            ("provenance", page::provenance(results)),
            ("data", in_script(&results.to_json())),
            ("view", in_script(&view(results, images).to_string())),
            ("script", Html::trusted(SCRIPTS.join("\n"))),
        ],
    )
}

fn title(results: &Results) -> String {
    let adapter = short_adapter(&results.machine.adapter);
    match results.records.first() {
        Some(first) => {
            format!(
                "{}, {} lights, {adapter} \u{b7} lightbench",
                first.setting.scene,
                number(first.setting.lights as f64)
            )
        }
        None => format!("{adapter} \u{b7} lightbench"),
    }
}

/// What the programs need beside the results: which records belong together, which colour each
/// strategy and pass has, and the pictures, each stored once.
fn view(results: &Results, images: &[(String, Vec<u8>)]) -> serde_json::Value {
    let comparisons: Vec<_> = comparisons(results)
        .iter()
        .map(|comparison| {
            let records: Vec<usize> = comparison.records.iter().map(|(ix, _)| *ix).collect();
            json!({ "records": records, "baseline": comparison.baseline_index() })
        })
        .collect();
    let mut kept: Vec<&[u8]> = Vec::new();
    let mut pictures = serde_json::Map::new();
    for (name, png) in images {
        let ix = kept.iter().position(|known| known == png).unwrap_or_else(|| {
            kept.push(png);
            kept.len() - 1
        });
        pictures.insert(name.clone(), ix.into());
    }
    let uris: Vec<_> =
        kept.iter().map(|png| format!("data:image/png;base64,{}", STANDARD.encode(png))).collect();
    json!({
        "comparisons": comparisons,
        "strategies": page::strategy_classes(results),
        "passes": page::pass_classes(results),
        "pictures": pictures,
        "uris": uris,
    })
}

/// JSON that no HTML parser takes for the end of its script element. `<` stands only in strings.
pub(super) fn in_script(json: &str) -> Html {
    Html::trusted(json.replace('<', "\\u003c"))
}

/// Replaces each `{{name}}` of a template; what is put in is not looked at again.
pub(super) fn fill(template: &str, values: &[(&str, Html)]) -> String {
    let mut filled = String::new();
    let mut parts = template.split("{{");
    filled.push_str(parts.next().unwrap_or_default());
    for part in parts {
        let (name, rest) = part.split_once("}}").unwrap_or((part, ""));
        let value = values.iter().find(|(known, _)| *known == name);
        debug_assert!(value.is_some(), "the template names {name}");
        filled.push_str(value.map_or("", |(_, value)| value.as_str()));
        filled.push_str(rest);
    }
    filled
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_put_in_is_not_looked_at_again() {
        let values = [("x", Html::from("{{y}}")), ("y", "1".into())];
        assert_eq!(fill("a {{x}} {{y}} b", &values), "a {{y}} 1 b");
    }

    #[test]
    fn data_cannot_end_its_script() {
        let json = serde_json::to_string("</script><!--").expect("JSON");
        let safe = in_script(&json);
        assert!(!safe.as_str().contains('<'));
        let back: String = serde_json::from_str(safe.as_str()).expect("JSON");
        assert_eq!(back, "</script><!--");
    }

    #[test]
    fn nothing_is_loaded_from_elsewhere() {
        for part in [PAGE, STYLE].iter().chain(&SCRIPTS) {
            for loader in ["http://", "https://", "@import", "url(", "fetch("] {
                let allowed = part.replace("http://www.w3.org/2000/svg", "");
                assert!(!allowed.contains(loader), "{loader}");
            }
        }
    }
}
