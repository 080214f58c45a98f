//! What stands on a page, as lines that can be compared.

/// The text of an element's content: everything outside of tags.
fn text_of(html: &str) -> String {
    let mut text = String::new();
    let mut is_tag = false;
    for c in html.chars() {
        match c {
            '<' => is_tag = true,
            // A tag parts what stands before it from what stands after it.
            '>' if is_tag => (is_tag, text) = (false, text + " "),
            c if !is_tag => text.push(c),
            _ => {}
        }
    }
    text
}

/// The numbers in a text, as written: `0.185`, `1,024`, `-3`.
fn figures(text: &str) -> Vec<String> {
    let mut figures = Vec::new();
    let mut before = ' ';
    let mut rest = text;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let (words, number) = rest.split_at(start);
        let mut tail = words.chars().rev();
        let sign = tail.next().unwrap_or(before);
        let is_negative = sign == '-' && !tail.next().is_some_and(char::is_alphanumeric);
        let is_part = |c: char| c.is_ascii_digit() || c == '.' || c == ',';
        let end = number.find(|c| !is_part(c)).unwrap_or(number.len());
        let (number, behind) = number.split_at(end);
        let number = number.trim_end_matches(['.', ',']);
        figures.push(if is_negative { format!("-{number}") } else { number.to_owned() });
        (before, rest) = (' ', behind);
    }
    figures
}

/// What stands between a start and an end, each time.
fn between<'a>(text: &'a str, start: &'a str, end: &'a str) -> impl Iterator<Item = &'a str> {
    text.split(start).skip(1).map(move |part| part.split(end).next().unwrap_or_default())
}

/// The cells of each table of a page, as text.
fn tables(page: &str) -> Vec<Vec<String>> {
    let cells = |table| between(table, "<td", "</td>").map(|cell| text_of(&format!("<td{cell}")));
    between(page, "<table", "</table>").map(|table| cells(table).collect()).collect()
}

fn digest(words: &[String]) -> String {
    blake3::hash(words.join(" ").as_bytes()).to_hex()[..16].to_owned()
}

/// The sentences at the top of a page: its headline and its findings, without markup.
fn sentences(page: &str) -> Vec<String> {
    let starts = ["<h1", "<p class=\"finding", "<p class=\"said"];
    let ends = ["</h1>", "</p>", "</p>"];
    let found = starts.iter().zip(ends).flat_map(|(start, end)| {
        between(page, start, end).map(move |content| text_of(&format!("{start}{content}")))
    });
    found.map(|text| text.split_whitespace().collect::<Vec<_>>().join(" ")).collect()
}

/// The row and column names of each table.
fn row_names(page: &str) -> Vec<Vec<String>> {
    let name = |cell: &str| {
        let text = text_of(&format!("<th{cell}"));
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    // `<thead` begins like `<th`.
    let is_cell = |cell: &&str| !cell.starts_with("ead");
    let names = |table| between(table, "<th", "</th>").filter(is_cell).map(name).collect();
    between(page, "<table", "</table>").map(names).collect()
}

/// The titles of the marks of each chart.
fn charts(page: &str) -> Vec<Vec<&str>> {
    let titles = |chart| between(chart, "<title>", "</title>").collect::<Vec<_>>();
    let charts = between(page, "<svg", "</svg>").map(titles);
    charts.filter(|titles| !titles.is_empty()).collect()
}

/// The lines of a page.
pub(crate) fn lines(name: &str, page: &str) -> Vec<String> {
    let mut lines = Vec::new();
    for (ix, sentence) in sentences(page).iter().enumerate() {
        lines.push(format!("{name} says {ix}: {sentence}"));
    }
    for (ix, cells) in tables(page).iter().enumerate() {
        let figures: Vec<String> = cells.iter().flat_map(|cell| figures(cell)).collect();
        let (count, known) = (cells.len(), figures.len());
        lines.push(format!(
            "{name} table {ix}: {count} cells, {known} figures, {}",
            digest(&figures)
        ));
    }
    for (ix, names) in row_names(page).iter().enumerate() {
        let count = names.len();
        lines.push(format!("{name} rows of table {ix}: {count} names, {}", digest(names)));
    }
    let charts = charts(page);
    // A line break in a title is written as a character code, which is no figure.
    let texts = charts.iter().flatten().map(|title| title.replace("&#10;", " "));
    let figures: Vec<String> = texts.flat_map(|text| figures(&text)).collect();
    if !charts.is_empty() {
        let (count, marks) = (charts.len(), charts.iter().map(Vec::len).sum::<usize>());
        let known = figures.len();
        lines.push(format!(
            "{name} marks: {count} charts, {marks} marks, {known} figures, {}",
            digest(&figures)
        ));
    }
    let verdicts: Vec<String> = between(page, "data-claim=\"", "\">").map(str::to_owned).collect();
    if !verdicts.is_empty() {
        lines.push(format!("{name}: {} verdicts, {}", verdicts.len(), digest(&verdicts)));
    }
    lines
}

#[test]
fn figures_are_numbers_of_cells() {
    let page = "<table><tr><th>1</th><td>a 1,024.5 <b>-3</b></td><td>28x28, T-2.</td></tr></table>";
    let cells = tables(page);
    assert_eq!(cells.len(), 1);
    let all: Vec<String> = cells[0].iter().flat_map(|cell| figures(cell)).collect();
    assert_eq!(all, ["1,024.5", "-3", "28", "28", "2"]);
}

#[test]
fn a_changed_row_sentence_or_mark_changes_a_line() {
    let page = "<h1>A study</h1><p class=\"finding\">SC-E is <b>fastest</b>.</p>\
        <table><thead><tr><th>id</th></tr></thead><tr><th>SC-E</th><td>1</td></tr></table>\
        <svg><title>SC-E&#10;2 ms</title></svg><svg><path/></svg>";
    let known = lines("p", page);
    assert_eq!(known[1], "p says 1: SC-E is fastest .");
    assert_eq!(known.len(), 5, "two sentences, a table, its rows, a chart: {known:?}");
    for (old, new) in
        [("A study", "B"), ("fastest", "slow"), ("<th>SC-E", "<th>G"), ("2 ms", "3 ms")]
    {
        let changed = lines("p", &page.replace(old, new));
        let count = known.iter().zip(&changed).filter(|(old, new)| old != new).count();
        assert_eq!(count, 1, "{old} to {new}");
    }
}
