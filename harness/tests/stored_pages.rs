//! The pages of all stored results show the figures that they showed before.
//!
//! `stored_pages.txt` holds one line per table: its page, its place on the page, its cells and figures,
//! and a digest of the figures. A figure is a number in a cell; words around it may change.
//! `LIGHTBENCH_REFRESH=1 cargo test -p harness --test stored_pages` writes the file anew, where a change of
//! figures is meant.

use std::path::{Path, PathBuf};

use harness::{
    report::render_html,
    results::Results,
    study::{Done, Manifest, write_study},
};

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

/// One line per table of a page, and one for the verdicts of its claims.
fn lines(name: &str, page: &str) -> Vec<String> {
    let mut lines = Vec::new();
    for (ix, cells) in tables(page).iter().enumerate() {
        let figures: Vec<String> = cells.iter().flat_map(|cell| figures(cell)).collect();
        let (count, known) = (cells.len(), figures.len());
        lines.push(format!(
            "{name} table {ix}: {count} cells, {known} figures, {}",
            digest(&figures)
        ));
    }
    let verdicts: Vec<String> = between(page, "data-claim=\"", "\">").map(str::to_owned).collect();
    if !verdicts.is_empty() {
        lines.push(format!("{name}: {} verdicts, {}", verdicts.len(), digest(&verdicts)));
    }
    lines
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The stored results in a folder: studies, and files of results.
fn sources() -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![root().join("results")];
    while let Some(folder) = open.pop() {
        let is_study = Manifest::find(&folder).expect("reads").is_some();
        if is_study {
            found.push(folder.clone());
        }
        for entry in std::fs::read_dir(&folder).expect("a folder").flatten() {
            let path = entry.path();
            let is_data = path.extension().is_some_and(|extension| extension == "json");
            match path.is_dir() {
                true if !is_study => open.push(path),
                false if is_data && !path.ends_with("study.json") => found.push(path),
                _ => {}
            }
        }
    }
    found.sort();
    found
}

/// The page of stored results.
fn page(source: &Path) -> String {
    if source.is_file() {
        // Answers of `advise` are no results.
        return match Results::read(source) {
            Ok(results) => render_html(&results, &[]),
            Err(_) => String::new(),
        };
    }
    let done = Done::read(&[source.to_owned()]).expect("a study");
    let out = tempfile::tempdir().expect("a folder");
    write_study(&done, out.path()).expect("writes");
    std::fs::read_to_string(out.path().join("index.html")).expect("a page")
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
fn stored_results_give_the_same_figures() {
    let file = root().join("harness/tests/stored_pages.txt");
    let mut fresh = String::new();
    for source in sources() {
        let name =
            source.strip_prefix(root().join("results")).expect("inside").display().to_string();
        for line in lines(&name, &page(&source)) {
            fresh += &format!("{line}\n");
        }
    }
    assert!(fresh.lines().count() > 100, "few tables were found:\n{fresh}");
    if std::env::var_os("LIGHTBENCH_REFRESH").is_some() {
        std::fs::write(&file, &fresh).expect("writes");
        return;
    }
    let known = std::fs::read_to_string(&file).expect("reads");
    let lines_only_in = |one: &str, other: &str| -> Vec<String> {
        let others: Vec<&str> = other.lines().collect();
        one.lines().filter(|line| !others.contains(line)).map(str::to_owned).collect()
    };
    let (gone, new) = (lines_only_in(&known, &fresh), lines_only_in(&fresh, &known));
    assert!(
        gone.is_empty() && new.is_empty(),
        "figures changed; gone:\n{}\nnew:\n{}",
        gone.join("\n"),
        new.join("\n")
    );
}
