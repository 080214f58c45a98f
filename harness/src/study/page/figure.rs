//! Charts with their files, choices between panels, and tables.

use crate::chart::{BarChart, Histogram, XyChart, histograms_svg, histograms_svg_file};
use crate::report::markup::{Html, html, with_names_whole};
use crate::report::panels::{self, Panel};
use crate::strategy::StrategyId;

/// The charts of a page. Each is drawn twice: once for the page, and once for a separate file.
#[derive(Default)]
pub(crate) struct Charts {
    /// Names and contents of the files.
    pub(crate) files: Vec<(String, String)>,
}

impl Charts {
    /// A chart of points and lines as a figure.
    pub(crate) fn xy(&mut self, slug: &str, chart: &XyChart) -> Html {
        self.figure(slug, &chart.title, &chart.to_svg(), chart.to_svg_file())
    }

    /// A chart of bars as a figure.
    pub(crate) fn bars(&mut self, slug: &str, chart: &BarChart) -> Html {
        self.figure(slug, &chart.title, &chart.to_svg(), chart.to_svg_file())
    }

    /// Histograms side by side as a figure.
    pub(crate) fn histograms(&mut self, slug: &str, title: &str, all: &[Histogram]) -> Html {
        let (page, file) = (histograms_svg(title, all), histograms_svg_file(title, all));
        self.figure(slug, title, &page, file)
    }

    fn figure(&mut self, slug: &str, title: &str, page: &str, file: String) -> Html {
        let plain = |c: char| if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
        let name: String = slug.chars().map(plain).collect();
        let name = format!("{name}.svg");
        // Charts escape their text themselves.
        let drawing = Html::trusted(page);
        let html = html!(
            "<figure class=\"drawn\" data-chart=\"{0}\"><figcaption>{1} \
             <a class=\"file\" href=\"charts/{2}\">SVG</a></figcaption>\n\
             <div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{1}\">{3}</div></figure>\n",
            slug,
            title,
            name,
            drawing
        );
        self.files.push((name, file));
        html
    }
}

/// Panels, one of which is shown, with buttons that choose. A single panel gets no button.
pub(crate) fn panels(label: &str, panels: &[(String, Html)]) -> Html {
    match panels {
        [] => return Html::default(),
        [(_, only)] => return only.clone(),
        _ => {}
    }
    let panel = |(name, body): &(String, Html)| Panel {
        name: name.clone(),
        class: String::new(),
        body: body.clone(),
    };
    let panels: Vec<Panel> = panels.iter().map(panel).collect();
    panels::panels(label, &Html::default(), &panels)
}

/// The head of a column with its unit in small.
pub(crate) fn unit(head: &str, unit: &str) -> Html {
    html!("{} <span class=\"unit\">{}</span>", head, unit)
}

/// Words in a separate column, which is wider than a column of figures.
pub(crate) fn words(text: &str) -> Html {
    html!("<span class=\"words\">{}</span>", text)
}

/// A table: the first cell of a row is its heading, the others are figures. Cells are text, or HTML that a
/// trusted builder made.
pub(crate) fn table<H, C>(label: &str, heads: &[H], rows: &[Vec<C>]) -> Html
where
    H: Clone + Into<Html>,
    C: Clone + Into<Html>,
{
    let head = |head: &H| html!("<th scope=\"col\">{}</th>", head.clone().into());
    let heads: Html = heads.iter().map(head).collect();
    let mut body = Html::default();
    for row in rows {
        let Some((name, cells)) = row.split_first() else { continue };
        let cells: Html =
            cells.iter().map(|cell| html!("<td>{}</td>", cell.clone().into())).collect();
        body += html!("<tr><th scope=\"row\">{}</th>{}</tr>\n", name.clone().into(), cells);
    }
    html!(
        "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{0}\">\
         <table class=\"figures\"><thead><tr>{1}</tr></thead>\n<tbody>\n{2}</tbody></table></div>\n",
        label,
        heads,
        body
    )
}

/// A name with the dot of its colour.
pub(crate) fn dotted(class: &str, name: impl Into<Html>) -> Html {
    html!("<i class=\"dot {}\"></i>{}", class, name.into())
}

/// A strategy's name with the dot of its colour.
pub(crate) fn name(id: &str) -> Html {
    dotted(&StrategyId::read(id).class(), with_names_whole(id))
}
