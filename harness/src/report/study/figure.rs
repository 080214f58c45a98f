//! Charts with their files, choices between panels, and tables.

use std::fmt::Write;

use super::super::format::escape;
use crate::chart::{BarChart, Histogram, XyChart, histograms_svg, histograms_svg_file};

/// The charts of a page: each is drawn twice, for the page and for a file of its own.
#[derive(Default)]
pub(super) struct Charts {
    /// Names and contents of the files.
    pub(super) files: Vec<(String, String)>,
}

impl Charts {
    /// A chart of points and lines as a figure.
    pub(super) fn xy(&mut self, slug: &str, chart: &XyChart) -> String {
        self.figure(slug, &chart.title, &chart.to_svg(), chart.to_svg_file())
    }

    /// A chart of bars as a figure.
    pub(super) fn bars(&mut self, slug: &str, chart: &BarChart) -> String {
        self.figure(slug, &chart.title, &chart.to_svg(), chart.to_svg_file())
    }

    /// Histograms side by side as a figure.
    pub(super) fn histograms(&mut self, slug: &str, title: &str, all: &[Histogram]) -> String {
        let (page, file) = (histograms_svg(title, all), histograms_svg_file(title, all));
        self.figure(slug, title, &page, file)
    }

    fn figure(&mut self, slug: &str, title: &str, page: &str, file: String) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
        let name: String = slug.chars().map(plain).collect();
        let name = format!("{name}.svg");
        let html = format!(
            "<figure class=\"drawn\" data-chart=\"{0}\"><figcaption>{1} \
             <a class=\"file\" href=\"charts/{2}\">SVG</a></figcaption>\n\
             <div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{1}\">{page}</div></figure>\n",
            escape(slug),
            escape(title),
            escape(&name),
        );
        self.files.push((name, file));
        html
    }
}

/// Panels of which one is shown, and the buttons that choose. A single panel needs no button.
pub(super) fn panels(label: &str, panels: &[(String, String)]) -> String {
    if let [(_, only)] = panels {
        return only.clone();
    }
    let (mut buttons, mut bodies) = (String::new(), String::new());
    for (ix, (name, body)) in panels.iter().enumerate() {
        let (name, first) = (escape(name), ix == 0);
        let _ = write!(
            buttons,
            "<button type=\"button\" data-choose=\"{ix}\" aria-pressed=\"{first}\">{name}</button>"
        );
        let hidden = if first { "" } else { " hidden" };
        let _ = write!(bodies, "<div data-panel=\"{ix}\"{hidden}>\n{body}</div>\n");
    }
    if panels.is_empty() {
        return String::new();
    }
    format!(
        "<div class=\"panels\"><div class=\"choice\" role=\"group\" aria-label=\"{}\">{buttons}</div>\n{bodies}</div>\n",
        escape(label)
    )
}

/// A table whose cells are HTML: the first of a row is its heading, the others are figures.
pub(super) fn table(label: &str, heads: &[&str], rows: &[Vec<String>]) -> String {
    let heads: String = heads.iter().map(|head| format!("<th scope=\"col\">{head}</th>")).collect();
    let mut body = String::new();
    for row in rows {
        let Some((name, cells)) = row.split_first() else { continue };
        let cells: String = cells.iter().map(|cell| format!("<td>{cell}</td>")).collect();
        let _ = writeln!(body, "<tr><th scope=\"row\">{name}</th>{cells}</tr>");
    }
    format!(
        "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{0}\">\
         <table class=\"figures\"><thead><tr>{heads}</tr></thead>\n<tbody>\n{body}</tbody></table></div>\n",
        escape(label)
    )
}

/// A part of a scene's section, or nothing where it is empty.
pub(super) fn part(scene: &str, id: &str, title: &str, text: &str, body: &str) -> String {
    if body.is_empty() {
        return String::new();
    }
    format!(
        "<div class=\"part\" id=\"{}-{id}\" data-part=\"{id}\"><h3>{}</h3>\n<p class=\"note\">{text}</p>\n{body}</div>\n",
        escape(scene),
        escape(title)
    )
}

/// A strategy's name with the dot of its colour.
pub(super) fn name(id: &str) -> String {
    format!(
        "<i class=\"dot {}\"></i>{}",
        super::data::class(id),
        super::super::page::with_names_whole(id)
    )
}
