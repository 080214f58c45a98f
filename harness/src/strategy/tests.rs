//! One row is enough: what a family that only tests know shows up in.

use super::*;
use crate::{
    chart::page_colours, report::render_html, results::Results, strategy::made_up::FAMILY,
};

/// Results that hold a record of the made-up family.
fn results() -> Results {
    let example = include_str!("../results/example.json");
    let mut results: Results = serde_json::from_str(example).expect("the example");
    let mut record = results.records[0].clone();
    record.strategy = FAMILY.into();
    record.setting.vpls = None;
    results.records.push(record);
    results
}

#[test]
fn the_command_line_lists_it() {
    assert!(
        list().contains("Made-Up/7        made-up boxes: a family of the tests\n"),
        "{}",
        list()
    );
    assert!(markdown().contains("| `Made-Up/7` |"), "{}", markdown());
}

#[test]
fn the_command_line_runs_it() {
    let id = StrategyId::parse("made-up/12").expect("an id");
    assert_eq!((id.as_str(), id.size()), ("Made-Up/12", "12"));
    assert_eq!(id.parameters()["boxes"], 12);
    let refused = StrategyId::parse("Made-Up/bvh").expect_err("it has no source").to_string();
    assert!(refused.contains("boxes"), "{refused}");
}

#[test]
fn a_page_shows_it_in_a_colour_of_its_own() {
    let page = render_html(&results(), &[]);
    assert!(page.contains("strategy-made-up"), "a row of the table has its class");
    let rule = ".strategy-made-up { --colour: light-dark(#00594f, #d4ff5c); }";
    assert!(page.contains(rule) && page_colours().contains(rule), "the style colours it");
    let same = rows().filter(|row| row.colour.light == "#00594f");
    assert_eq!(same.count(), 1, "no other family has its colour");
}

#[test]
fn it_is_not_counted_among_the_comparison_papers() {
    let id = StrategyId::read(FAMILY);
    assert!(id.has_groups() && !id.is_of_the_paper());
    assert!(StrategyId::read("SC-E").is_of_the_paper());
}
