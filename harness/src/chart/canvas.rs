//! A drawing as it grows: elements with classes, tips and keys.

use super::number::length;
use super::occupancy::Area;
use super::palette;
use super::style::CHART_CSS;
use super::text::{SIZE, escape, wrap};

/// The width of every chart, in its own units.
pub(super) const WIDTH: f64 = 640.0;
/// From one line of text to the next.
pub(super) const LINE: f64 = 21.0;
/// The width of a standalone file, in CSS pixels.
const FILE_WIDTH: f64 = 760.0;
const FILE_MARGIN: f64 = 18.0;

/// What a drawing is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Target {
    /// A page, which has the colours and a heading.
    Page,
    /// A file of its own, which brings its style and its heading.
    File,
}

/// Which point of a text is at its position.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Anchor {
    Start,
    Middle,
    End,
}

pub(super) struct Canvas {
    target: Target,
    body: String,
}

impl Canvas {
    pub(super) fn new(target: Target) -> Self {
        Self { target, body: String::new() }
    }

    /// Begins a group that a tip explains and, on a page, a key names; both may be empty.
    pub(super) fn open(&mut self, class: &str, tip: &str, key: &str) {
        self.body.push_str("<g");
        if !class.is_empty() {
            self.attribute("class", class);
        }
        if !key.is_empty() && self.target == Target::Page {
            self.attribute("data-key", key);
            self.attribute("tabindex", "0");
            if !tip.is_empty() {
                self.attribute("role", "button");
                self.attribute("aria-label", &tip.replace('\n', ", "));
            }
        }
        self.body.push('>');
        if !tip.is_empty() {
            self.body.push_str(&format!("<title>{}</title>", escape(tip.trim())));
        }
    }

    pub(super) fn close(&mut self) {
        self.body.push_str("</g>");
    }

    fn attribute(&mut self, name: &str, value: &str) {
        self.body.push_str(&format!(" {name}=\"{}\"", escape(value.trim())));
    }

    pub(super) fn line(&mut self, class: &str, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2]) {
        self.path(class, &format!("M{} {}L{} {}", length(x1), length(y1), length(x2), length(y2)));
    }

    pub(super) fn path(&mut self, class: &str, d: &str) {
        self.body.push_str("<path");
        if !class.is_empty() {
            self.attribute("class", class);
        }
        self.body.push_str(&format!(" d=\"{d}\"/>"));
    }

    pub(super) fn area(&mut self, class: &str, area: &Area) {
        self.body.push_str("<rect");
        self.attribute("class", class);
        self.body.push_str(&format!(
            " x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>",
            length(area.left),
            length(area.top),
            length(area.width().max(0.0)),
            length(area.height().max(0.0))
        ));
    }

    pub(super) fn circle(&mut self, class: &str, [x, y]: [f64; 2], radius: f64) {
        self.body.push_str("<circle");
        self.attribute("class", class);
        self.body.push_str(&format!(
            " cx=\"{}\" cy=\"{}\" r=\"{}\"/>",
            length(x),
            length(y),
            length(radius)
        ));
    }

    pub(super) fn text(&mut self, class: &str, [x, y]: [f64; 2], anchor: Anchor, text: &str) {
        self.body.push_str(&format!("<text x=\"{}\" y=\"{}\"", length(x), length(y)));
        if !class.is_empty() {
            self.attribute("class", class);
        }
        match anchor {
            Anchor::Start => {}
            Anchor::Middle => self.attribute("text-anchor", "middle"),
            Anchor::End => self.attribute("text-anchor", "end"),
        }
        self.body.push_str(&format!(">{}</text>", escape(text)));
    }

    /// A text in a colour that only the style sheet of a page gives. Files leave it out.
    pub(super) fn page_text(&mut self, class: &str, at: [f64; 2], anchor: Anchor, text: &str) {
        if self.target == Target::Page {
            self.text(class, at, anchor, text);
        }
    }

    /// A text that may have been cut. If so, its tip shows the whole text.
    pub(super) fn cut_text(
        &mut self,
        class: &str,
        at: [f64; 2],
        anchor: Anchor,
        cut: &str,
        whole: &str,
    ) {
        if cut == whole {
            self.text(class, at, anchor, cut);
        } else {
            self.open("cut", whole, "");
            self.text(class, at, anchor, cut);
            self.close();
        }
    }

    /// Writes notes below everything else. Returns where they end.
    pub(super) fn notes(&mut self, notes: &[String], top: f64) -> f64 {
        let mut y = top;
        for note in notes {
            for line in wrap(note, WIDTH) {
                y += LINE;
                self.text("soft", [0.0, y - 5.0], Anchor::Start, &line);
            }
        }
        y
    }

    /// The whole drawing, with a title for screen readers.
    pub(super) fn finish(self, title: &str, height: f64) -> String {
        match self.target {
            Target::Page => format!(
                "<svg class=\"chart\" xmlns=\"http://www.w3.org/2000/svg\" \
                 viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">{}</svg>",
                length(WIDTH),
                length(height),
                escape(title),
                self.body
            ),
            Target::File => self.file(title, height),
        }
    }

    fn file(self, title: &str, height: f64) -> String {
        const HEADING: f64 = 1.25;
        let mut heading = Self::new(Target::File);
        let mut top = 0.0;
        for line in wrap(title, (WIDTH) / HEADING) {
            top += LINE * HEADING;
            heading.text("heading", [0.0, top - 8.0], Anchor::Start, &line);
        }
        let top = if top > 0.0 { top + 6.0 } else { top };
        let (wide, high) = (WIDTH + 2.0 * FILE_MARGIN, height + top + 2.0 * FILE_MARGIN);
        format!(
            "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n\
             <svg class=\"chart\" xmlns=\"http://www.w3.org/2000/svg\" \
             width=\"{}\" height=\"{}\" viewBox=\"-{m} -{m} {} {}\" role=\"img\" \
             aria-label=\"{title}\" font-size=\"{SIZE}\"><title>{title}</title><style>{}</style>\
             <rect class=\"paper\" x=\"-{m}\" y=\"-{m}\" width=\"100%\" height=\"100%\"/>\
             {}<g transform=\"translate(0 {})\">{}</g></svg>\n",
            length(FILE_WIDTH),
            length(FILE_WIDTH * high / wide),
            length(wide),
            length(high),
            palette::file_style(CHART_CSS, &self.body),
            heading.body,
            length(top),
            self.body,
            m = length(FILE_MARGIN),
            title = escape(title),
        )
    }
}
