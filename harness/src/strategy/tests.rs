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
    record.indirect = None;
    results.records.push(record);
    results
}

/// A page without its style sheets, which name every family.
fn without_styles(page: &str) -> String {
    page.split("<style")
        .map(|part| part.split_once("</style>").map_or(part, |(_, rest)| rest))
        .collect()
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
    let with = results();
    let page = render_html(&with, &[]);
    let row = "<i class=\"dot strategy-made-up\"></i>Made-Up/7";
    assert!(page.contains(row), "its row of the table has its colour");
    let marks = |page: &str| without_styles(page).matches("strategy-made-up").count();
    assert!(marks(&page) > page.matches(row).count(), "a mark of a chart has its colour");
    let mut without = with;
    without.records.pop();
    assert_eq!(marks(&render_html(&without, &[])), 0, "only its record brings its class");
    let rule = ".strategy-made-up { --colour: light-dark(#00594f, #d4ff5c); }";
    assert!(page.contains(rule) && page_colours().contains(rule), "the style colours it");
    let same = rows().filter(|row| row.colour.light == "#00594f");
    assert_eq!(same.count(), 1, "no other family has its colour");
}

#[test]
fn it_is_not_counted_among_the_comparison_papers() {
    let mut record = results().records.pop().expect("its record");
    assert!(record.strategy.has_groups() && !record.strategy.is_of_the_paper());
    record.strategy = "SC-E".into();
    assert!(record.strategy.is_of_the_paper());
}

/// A depth buffer that ends before the viewport does would hold zeros there: lights would be lost, or a driver would
/// refuse it.
#[test]
fn every_strategy_that_reads_depth_refuses_one_that_is_too_small() {
    let gpu = assign::Gpu::noop().expect("a device");
    let lights = assign::LightBuffer::new(&gpu, &[]).expect("no lights");
    let view = assign::View::look_at(glam::Vec3::ONE, glam::Vec3::ZERO, 1.0, 0.1, [64, 48]);
    let depth = assign::conformance::flat_depth(&gpu, [64, 47], 0.5);
    let frame = assign::Frame::new(&view, &lights).with_depth(&depth).with_normals(&depth);
    let mut refused = 0;
    for row in rows().filter(|row| row.needs.depth) {
        let made = crate::choice::Choice::parse(&row.default_id()).expect("an id").make(&gpu);
        let Ok(Method::Lists { mut strategy, .. }) = made else { continue };
        match strategy.prepare(&gpu, &frame) {
            Err(assign::AssignError::Image { image: "depth", field: "size", .. }) => refused += 1,
            other => panic!("{}: {other:?}", row.default_id()),
        }
    }
    assert!(refused >= 12, "{refused} were refused");
}
