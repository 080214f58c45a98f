//! A table, drawn from its columns and rows for a page, for the terminal or for Markdown.

use std::fmt::Write;

use super::column::Column;
use super::markup::{Html, html, with_names_whole};

use super::rank::ALIKE;

/// No line of a table for the terminal is wider, in characters, but for a name that is wider by itself.
pub const TABLE_WIDTH: usize = 100;

/// A row: its name, and what its cells are computed from.
pub(crate) struct Row<T> {
    name: String,
    /// The class that gives `--colour` to the dot before the name; empty draws no dot.
    class: String,
    /// What a page shows after the name.
    note: Html,
    data: T,
}

impl<T> Row<T> {
    pub(crate) fn new(name: impl Into<String>, data: T) -> Self {
        Self { name: name.into(), class: String::new(), note: Html::default(), data }
    }
}

/// How a page shows a table.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Look {
    /// Over the whole width; a heading sorts by its column.
    Sortable,
    /// As wide as its figures.
    Plain,
}

/// A table of rows under columns.
pub(crate) struct Table<'a, T> {
    /// What the rows are: `strategy`.
    head: &'static str,
    columns: Vec<Column<'a, T>>,
    rows: Vec<Row<T>>,
    /// Whether a row's figures may be marked as the best.
    competes: fn(&T) -> bool,
}

impl<'a, T> Table<'a, T> {
    /// A table without the optional columns in which no row has a figure. All rows compete.
    pub(crate) fn new(
        head: &'static str,
        columns: impl IntoIterator<Item = Column<'a, T>>,
        rows: Vec<Row<T>>,
    ) -> Self {
        let has_figure =
            |column: &Column<'a, T>| rows.iter().any(|row| column.value(&row.data).is_some());
        let columns = columns
            .into_iter()
            .filter(|column| !column.is_optional || has_figure(column))
            .collect();
        Self { head, columns, rows, competes: |_| true }
    }

    /// Marks the best figures among these rows only.
    pub(crate) fn competing(self, competes: fn(&T) -> bool) -> Self {
        Self { competes, ..self }
    }

    /// Draws a dot before each name, in the colour that the class of its row gives.
    pub(crate) fn dotted(mut self, class: impl Fn(&T) -> String) -> Self {
        for row in &mut self.rows {
            row.class = class(&row.data);
        }
        self
    }

    /// Adds markup after each name, on pages only.
    pub(crate) fn noted(mut self, note: impl Fn(&T) -> Html) -> Self {
        for row in &mut self.rows {
            row.note = note(&row.data);
        }
        self
    }

    /// The table for a page; empty where it has no rows.
    pub(crate) fn html(&self, label: &str, look: Look) -> Html {
        if self.rows.is_empty() {
            return Html::default();
        }
        let is_sortable = look == Look::Sortable;
        let head = |text: Html| match is_sortable {
            true => html!("<button type=\"button\">{}</button>", text),
            false => text,
        };
        let heads: Html = self.columns.iter().map(|column| self.head_html(column, head)).collect();
        let competitors: Vec<&T> =
            self.rows.iter().map(|row| &row.data).filter(|data| (self.competes)(data)).collect();
        let row = |row: &Row<T>| {
            let cell = |column: &Column<'a, T>| cell_html(column, &row.data, &competitors);
            let cells: Html = self.columns.iter().map(cell).collect();
            let name = dot(&row.class) + with_names_whole(&row.name) + row.note.clone();
            html!("<tr><th scope=\"row\">{}</th>{}</tr>\n", name, cells)
        };
        let rows: Html = self.rows.iter().map(row).collect();
        let (class, caption) = match look {
            Look::Sortable => {
                ("results", html!("<caption>{}. A heading sorts by its column.</caption>", label))
            }
            Look::Plain => ("figures", Html::default()),
        };
        html!(
            "<div class=\"scroll\" role=\"region\" tabindex=\"0\" aria-label=\"{0}\">\n\
             <table class=\"{1}\">{2}\n<thead><tr><th scope=\"col\">{3}</th>{4}</tr></thead>\n\
             <tbody>\n{5}</tbody></table></div>\n",
            label,
            class,
            caption,
            head(self.head.into()),
            heads,
            rows
        )
    }

    fn head_html(&self, column: &Column<'a, T>, head: impl Fn(Html) -> Html) -> Html {
        let unit = match column.unit.is_empty() {
            true => Html::default(),
            false => html!(" <span class=\"unit\">{}</span>", column.unit),
        };
        let title = match column.about.is_empty() {
            true => Html::default(),
            false => html!(" title=\"{}\"", column.about),
        };
        let name = match column.class.is_empty() {
            true => Html::from(&column.head),
            false => dot(&column.class) + with_names_whole(&column.head),
        };
        let text = head(name + unit);
        html!("<th scope=\"col\"{}>{}</th>", title, text)
    }

    /// The table for the terminal: the columns with a heading there, two lines of headings. A table that is too
    /// wide goes on below.
    pub(crate) fn text(&self) -> String {
        let columns: Vec<Vec<String>> =
            self.columns.iter().filter_map(|column| self.cells_for_terminal(column)).collect();
        self.blocks(&columns).join("\n")
    }

    /// One block of lines, or several below each other if a line would be too wide.
    fn blocks(&self, columns: &[Vec<String>]) -> Vec<String> {
        let mut used = 0;
        let fits = |cells: &&Vec<String>| {
            used += widest(cells) + 1;
            used <= TABLE_WIDTH
        };
        let count = columns.iter().take_while(fits).count().max(1).min(columns.len());
        let (first, rest) = columns.split_at(count);
        let mut blocks = vec![self.block(first)];
        if !rest.is_empty() {
            blocks.extend(self.blocks(rest));
        }
        blocks
    }

    fn block(&self, columns: &[Vec<String>]) -> String {
        let widths: Vec<usize> = columns.iter().map(|cells| widest(cells)).collect();
        let names: Vec<&str> = [self.head, ""]
            .into_iter()
            .chain(self.rows.iter().map(|row| row.name.as_str()))
            .collect();
        let figures: usize = widths.iter().sum();
        let gap = if widest(&names) + figures + 2 * widths.len() <= TABLE_WIDTH { 2 } else { 1 };
        let room = TABLE_WIDTH.saturating_sub(figures + gap * widths.len());
        let name_width = widest(&names).min(room);
        let mut text = String::new();
        for (ix, name) in names.iter().enumerate() {
            let mut line = format!("{name:name_width$}");
            // A name that is too long stands on a line of its own.
            if name.chars().count() > name_width {
                let _ = writeln!(text, "{name}");
                line = " ".repeat(name_width);
            }
            for (cells, width) in columns.iter().zip(&widths) {
                let _ = write!(line, "{:gap$}{:>width$}", "", cells[ix]);
            }
            let _ = writeln!(text, "{}", line.trim_end());
        }
        text
    }

    /// A column's two lines of heading and its cells; `None` where the terminal leaves it out.
    fn cells_for_terminal(&self, column: &Column<'a, T>) -> Option<Vec<String>> {
        let heads = [column.terminal.clone()?, column.unit.clone()];
        Some(heads.into_iter().chain(self.rows.iter().map(|row| column.text(&row.data))).collect())
    }

    /// The table as GitHub-flavoured Markdown.
    pub(crate) fn markdown(&self) -> String {
        let head = |column: &Column<'a, T>| format!(" {} {} |", column.head, column.unit);
        let heads: String = self.columns.iter().map(head).collect();
        let mut text =
            format!("| {} |{heads}\n|---|{}\n", self.head, "---|".repeat(self.columns.len()));
        for row in &self.rows {
            let cell = |column: &Column<'a, T>| format!(" {} |", column.text(&row.data));
            let cells: String = self.columns.iter().map(cell).collect();
            let _ = writeln!(text, "| {} |{cells}", row.name);
        }
        text
    }
}

/// A dot in the colour that a class gives; nothing without a class.
fn dot(class: &str) -> Html {
    match class.is_empty() {
        true => Html::default(),
        false => html!("<i class=\"dot {}\"></i>", class),
    }
}

fn cell_html<T>(column: &Column<'_, T>, data: &T, competitors: &[&T]) -> Html {
    let class = match () {
        () if column.is_fault(data) => html!(" class=\"fault\""),
        () if column.is_best(data, competitors, ALIKE) => html!(" class=\"best\""),
        () => Html::default(),
    };
    let figure = match column.id {
        "" => Html::default(),
        id => {
            let value = column.value(data).map_or_else(String::new, |value| value.to_string());
            html!(" data-metric=\"{}\" data-value=\"{}\"", id, value)
        }
    };
    html!("<td{}{}>{}</td>", figure, class, column.html(data))
}

fn widest<S: AsRef<str>>(cells: &[S]) -> usize {
    cells.iter().map(|cell| cell.as_ref().chars().count()).max().unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::super::column::Better;
    use super::super::format::number;
    use super::*;

    /// A family with its time and its missed pairs.
    type Family = (&'static str, Option<f64>, f64);

    fn table(rows: &[Family]) -> Table<'static, Family> {
        let columns = [
            Column::figure("time", "ms", Better::Less, |row: &Family| row.1, number)
                .id("time")
                .terminal("time")
                .note(|row| html!("<small>{}</small>", row.0)),
            Column::figure("missed", "pairs", Better::Zero, |row: &Family| Some(row.2), number)
                .terminal("missed"),
            Column::figure("memory", "MiB", Better::Less, |_: &Family| None, number).optional(),
            Column::words("first letter", "", |row: &Family| row.0[..1].to_owned()),
        ];
        Table::new("family", columns, rows.iter().map(|row| Row::new(row.0, *row)).collect())
    }

    const ROWS: [Family; 3] =
        [("<tiled>", Some(3.0), 0.0), ("grid", Some(2.0), 7.0), ("none", None, 0.0)];

    #[test]
    fn one_list_of_columns_makes_all_three_tables() {
        let table = table(&ROWS);
        let markdown = "| family | time ms | missed pairs | first letter  |\n|---|---|---|---|\n\
                        | <tiled> | 3 | 0 | < |\n| grid | 2 | 7 | g |\n| none | \u{2013} | 0 | n |\n";
        assert_eq!(table.markdown(), markdown);
        let text = "family   time  missed\n           ms   pairs\n<tiled>     3       0\n\
                    grid        2       7\nnone        \u{2013}       0\n";
        assert_eq!(table.text(), text);
        let html = table.html("Families", Look::Sortable);
        for part in [
            "&lt;tiled&gt;</th><td data-metric=\"time\" data-value=\"3\">3<small>&lt;tiled&gt;</small></td>",
            "<td data-metric=\"time\" data-value=\"2\" class=\"best\">2<",
            "<td data-metric=\"time\" data-value=\"\">\u{2013}<",
            "<td class=\"fault\">7</td><td>g</td>",
        ] {
            assert!(html.as_str().contains(part), "{part} is missing from {}", html.as_str());
        }
        assert!(!html.as_str().contains("memory"), "a column without a figure is left out");
    }

    #[test]
    fn only_competitors_are_best_and_only_where_one_is_worse() {
        let best = |rows: &[Family], competes| {
            let html = table(rows).competing(competes).html("", Look::Plain);
            html.as_str().matches("class=\"best\"").count()
        };
        let lossless = |row: &Family| row.2 == 0.0;
        assert_eq!(best(&ROWS, |_| true), 1);
        assert_eq!(best(&ROWS, lossless), 0, "one competitor alone is not the best");
        let alike = [("a", Some(1.0), 0.0), ("b", Some(1.001), 0.0), ("c", Some(2.0), 0.0)];
        assert_eq!(best(&alike, lossless), 2, "times within half a per cent are alike");
        assert_eq!(best(&alike[..2], lossless), 0);
    }
}
