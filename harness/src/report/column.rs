//! Columns of a table. A column is a row of data: its name, its unit, which way is better, and the function
//! that computes a cell.
//!
//! ```text
//! Column::figure("listed", "/sample", Better::Less, |row: &Row| row.listed, number)
//! Column::ms("shade", |row: &Row| Some(row.shade_ms))
//! Column::words("size", "px", |row: &Row| row.size.clone())
//! ```

use super::format::{ABSENT, significant};
use super::markup::{Html, html};

/// Which way a figure is better.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Better {
    Less,
    More,
    /// Anything but 0 is a fault.
    Zero,
    Neither,
}

type Value<'a, T> = Box<dyn Fn(&T) -> Option<f64> + 'a>;
type Text<'a, T> = Box<dyn Fn(&T) -> String + 'a>;
type Note<'a, T> = Box<dyn Fn(&T) -> Html + 'a>;
type Test<'a, T> = Box<dyn Fn(&T) -> bool + 'a>;

/// What the cells of a column show.
enum Cells<'a, T> {
    /// A figure, `None` where it was not measured, and how to write it.
    Figure(Value<'a, T>, fn(f64) -> String),
    Words(Text<'a, T>),
}

/// One column of a table whose rows are of type `T`.
pub(crate) struct Column<'a, T> {
    /// Names the column in the page's markup; empty where nothing asks for it.
    pub(crate) id: &'static str,
    /// Its heading, without the unit.
    pub(crate) head: String,
    /// The class that gives `--colour` to the dot before its heading on a page; empty draws no dot.
    pub(crate) class: String,
    /// Its unit, may be empty. The terminal's table puts it on a line of its own.
    pub(crate) unit: String,
    /// Its heading in the terminal's table, which leaves out a column without one.
    pub(crate) terminal: Option<String>,
    /// What it means, one or a few sentences; may be empty.
    pub(crate) about: String,
    /// Which way its figures are better.
    pub(crate) better: Better,
    /// Whether a table leaves it out where no row has a figure.
    pub(crate) is_optional: bool,
    cells: Cells<'a, T>,
    note: Option<Note<'a, T>>,
    best: Option<Test<'a, T>>,
}

impl<'a, T> Column<'a, T> {
    /// A column of figures.
    pub(crate) fn figure(
        head: impl Into<String>,
        unit: impl Into<String>,
        better: Better,
        value: impl Fn(&T) -> Option<f64> + 'a,
        show: fn(f64) -> String,
    ) -> Self {
        let cells = Cells::Figure(Box::new(value), show);
        Self { unit: unit.into(), better, ..Self::new(head.into(), cells) }
    }

    /// A column of times, ms.
    pub(crate) fn ms(head: impl Into<String>, value: impl Fn(&T) -> Option<f64> + 'a) -> Self {
        Self::figure(head, "ms", Better::Less, value, significant)
    }

    /// A column of words.
    pub(crate) fn words(
        head: impl Into<String>,
        unit: impl Into<String>,
        text: impl Fn(&T) -> String + 'a,
    ) -> Self {
        Self { unit: unit.into(), ..Self::new(head.into(), Cells::Words(Box::new(text))) }
    }

    /// A column of markup, which only pages show.
    pub(crate) fn markup(
        head: impl Into<String>,
        unit: impl Into<String>,
        cell: impl Fn(&T) -> Html + 'a,
    ) -> Self {
        Self::words(head, unit, |_| String::new()).note(cell)
    }

    /// A column of sentences, which is wider than a column of figures. Only pages show it.
    pub(crate) fn prose(head: &str, text: impl Fn(&T) -> String + 'a) -> Self {
        Self::markup(head, "", move |row| html!("<span class=\"words\">{}</span>", text(row)))
    }

    fn new(head: String, cells: Cells<'a, T>) -> Self {
        Self {
            id: "",
            head,
            class: String::new(),
            unit: String::new(),
            terminal: None,
            about: String::new(),
            better: Better::Neither,
            is_optional: false,
            cells,
            note: None,
            best: None,
        }
    }

    /// Names the column in the page's markup.
    pub(crate) fn id(self, id: &'static str) -> Self {
        Self { id, ..self }
    }

    /// Draws a dot before the heading on a page, in the colour that a class gives.
    pub(crate) fn dotted(self, class: String) -> Self {
        Self { class, ..self }
    }

    /// Shows the column in the terminal too, under this heading.
    pub(crate) fn terminal(self, head: impl Into<String>) -> Self {
        Self { terminal: Some(head.into()), ..self }
    }

    /// Says what the column means.
    pub(crate) fn about(self, about: impl Into<String>) -> Self {
        Self { about: about.into(), ..self }
    }

    /// Leaves the column out where no row has a figure.
    pub(crate) fn optional(self) -> Self {
        Self { is_optional: true, ..self }
    }

    /// Adds markup after the text of each cell, on pages only: an interval in small, a mark.
    pub(crate) fn note(self, note: impl Fn(&T) -> Html + 'a) -> Self {
        Self { note: Some(Box::new(note)), ..self }
    }

    /// Decides which cells are best, instead of comparing their figures.
    pub(crate) fn best(self, is_best: impl Fn(&T) -> bool + 'a) -> Self {
        Self { best: Some(Box::new(is_best)), ..self }
    }

    /// A row's figure; `None` where it was not measured or the column holds words.
    pub(crate) fn value(&self, row: &T) -> Option<f64> {
        match &self.cells {
            Cells::Figure(value, _) => value(row),
            Cells::Words(_) => None,
        }
    }

    /// A row's cell as text; a dash where its figure was not measured.
    pub(crate) fn text(&self, row: &T) -> String {
        match &self.cells {
            Cells::Figure(value, show) => value(row).map_or_else(|| ABSENT.to_owned(), show),
            Cells::Words(text) => text(row),
        }
    }

    /// A row's cell on a page: its text, then its note.
    pub(crate) fn html(&self, row: &T) -> Html {
        let text = Html::from(self.text(row));
        self.note.as_ref().map_or_else(|| text.clone(), |note| text.clone() + note(row))
    }

    /// Whether a row's figure is a fault.
    pub(crate) fn is_fault(&self, row: &T) -> bool {
        self.better == Better::Zero && self.value(row).is_some_and(|value| value != 0.0)
    }

    /// Whether a row's figure is the best: no competitor's is better and at least one is worse. Figures
    /// count as equal up to a factor of `1 + alike`.
    pub(crate) fn is_best(&self, row: &T, competitors: &[&T], alike: f64) -> bool {
        if !competitors.iter().any(|other| std::ptr::eq(*other, row)) {
            return false;
        }
        if let Some(is_best) = &self.best {
            return is_best(row);
        }
        let is_better = |a: f64, b: f64| match self.better {
            Better::More => a > b * (1.0 + alike),
            Better::Less => a < b / (1.0 + alike),
            Better::Zero | Better::Neither => false,
        };
        let Some(value) = self.value(row) else { return false };
        let others = || competitors.iter().filter_map(|other| self.value(other));
        others().all(|other| !is_better(other, value))
            && others().any(|other| is_better(value, other))
    }
}
