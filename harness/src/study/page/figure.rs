//! Charts with their files, and choices between panels.

use crate::chart::{
    BarChart, BarRow, Histogram, Segment, XyChart, histograms_svg, histograms_svg_file,
};
use crate::report::format::{self, significant};
use crate::report::markup::{Html, html};
use crate::report::panels::{self, Panel};
use crate::results::Record;

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
        let name = format!("{}.svg", format::slug(slug));
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

/// A bar of the time to assign and to shade, with both parts in its tip.
pub(crate) fn time_bar(name: String, class: String, record: &Record) -> BarRow {
    let part = |name: &str, class: &str, value| Segment {
        name: name.to_owned(),
        class: class.to_owned(),
        value,
    };
    let (assign_ms, shade_ms) = (record.times.assign_ms, record.times.shade_ms);
    BarRow {
        name,
        class,
        segments: vec![
            part("assign", "pass-assign-0", assign_ms),
            part("shade", "pass-shade-0", shade_ms),
        ],
        value_text: format!("{} ms", significant(record.assign_and_shade_ms())),
        tip: format!(
            "{}\nassign {} ms\nshade {} ms",
            record.strategy,
            significant(assign_ms),
            significant(shade_ms)
        ),
    }
}
