//! Files may come from anywhere: no number in them makes a page panic.

use serde_json::Value;

use super::Results;
use crate::report::{render_html, render_table};

/// Calls a function for each integer in a file, with its place.
fn integers(value: &Value, place: &str, found: &mut Vec<String>) {
    match value {
        Value::Number(number) if number.is_u64() => found.push(place.to_owned()),
        Value::Array(items) => {
            for (ix, item) in items.iter().enumerate() {
                integers(item, &format!("{place}/{ix}"), found);
            }
        }
        Value::Object(fields) => {
            for (name, item) in fields {
                integers(item, &format!("{place}/{name}"), found);
            }
        }
        _ => {}
    }
}

#[test]
fn pages_show_the_largest_integer_of_every_field() {
    let mut file: Value = serde_json::from_str(include_str!("example.json")).expect("the example");
    let mut places = Vec::new();
    integers(&file, "", &mut places);
    // The parameters of an id say what the id says.
    places.retain(|place| !place.contains("/parameters/"));
    let mut changed = 0;
    for place in &places {
        for largest in [u64::MAX, u64::from(u32::MAX)] {
            let field = file.pointer_mut(place).expect("a field");
            let before = std::mem::replace(field, largest.into());
            if serde_json::from_value::<Results>(file.clone()).is_ok() {
                changed += 1;
                break;
            }
            *file.pointer_mut(place).expect("a field") = before;
        }
    }
    assert!(changed + 1 >= places.len(), "all but the version: {changed} of {}", places.len());
    let results: Results = serde_json::from_value(file).expect("results");
    let deep = &results.deep_images.as_ref().expect("deep images").deep;
    assert_eq!(deep.directions(), u32::MAX);
    let page = render_html(&results, &[]);
    assert!(page.contains("18,446,744,073,709,551,615") || page.contains("4,294,967,295"));
    assert!(!render_table(&results).is_empty());
}
