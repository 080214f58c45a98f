//! The page of a comparison: one file that holds everything and opens from anywhere.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use serde_json::json;

use super::finding::findings;
use super::format::{number, short_adapter};
use super::markup::{Html, with_names_whole};
use super::section::sections;
use super::terms::terms;
use super::{frames, notices, page};
use crate::chart::{CHART_CSS, page_colours};
use crate::results::{Results, ResultsError, write_atomically};

pub(crate) const PAGE: &str = include_str!("report.html");
const STYLE: &str = include_str!("report.css");

/// The page's script.
pub(crate) const SCRIPT: &str = include_str!("report.js");

/// The rules of a page: its own, those of charts, the colours of strategies and passes, and some more.
pub(crate) fn style(more: &str) -> String {
    [STYLE, CHART_CSS, &page_colours(), more].join("\n")
}

/// Writes `out_dir/index.html` and returns its path. `images` holds the pictures that records name: the names
/// and the contents of PNG files. The page says which pictures are missing.
///
/// # Errors
///
/// [`ResultsError::Write`] names the path that cannot be written.
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
    let mut found = findings(results).into_iter();
    let (headline, mut others) = found.next().map_or_else(Default::default, |first| {
        (with_names_whole(&first.headline), vec![first.details.join(" ")])
    });
    others.extend(found.map(|other| [vec![other.headline], other.details].concat().join(" ")));
    others.retain(|text| !text.is_empty());
    let kept: BTreeSet<&str> = images.iter().map(|(name, _)| name.as_str()).collect();
    fill(
        PAGE,
        &[
            ("title", title(results).into()),
            ("style", Html::trusted(style(""))),
            ("headline", headline),
            ("findings", page::paragraphs("finding", &others)),
            ("notices", page::notices(&notices(results))),
            ("comparisons", sections(results, &kept) + frames::sections(results)),
            ("columns", page::columns([results])),
            ("terms", terms()),
            ("reading", Html::default()),
            ("file", "report-data.json".into()),
            ("link", "#from".into()),
            ("provenance", page::provenance(results)),
            ("data", in_script(&results.to_json())),
            ("view", in_script(&view(images).to_string())),
            ("script", Html::trusted(SCRIPT)),
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

/// What the script needs: the pictures, each stored once.
fn view(images: &[(String, Vec<u8>)]) -> serde_json::Value {
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
    json!({ "pictures": pictures, "uris": uris })
}

/// JSON in which no HTML parser sees the end of the script element: `<` occurs only in strings.
pub(crate) fn in_script(json: &str) -> Html {
    Html::trusted(json.replace('<', "\\u003c"))
}

/// Replaces each `{{name}}` of a template. Values are not searched for further names.
pub(crate) fn fill(template: &str, values: &[(&str, Html)]) -> String {
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
    fn values_are_not_searched_for_names() {
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
    fn a_page_loads_no_other_file() {
        for part in [PAGE, STYLE, SCRIPT] {
            for loader in ["http://", "https://", "@import", "url(", "fetch("] {
                let allowed = part.replace("http://www.w3.org/2000/svg", "");
                assert!(!allowed.contains(loader), "{loader}");
            }
        }
    }
}
