//! Names the field at which a file of results cannot be read. The parser does not know the place of flattened
//! fields, and gives that of others as a line and a column.

use serde::de::DeserializeOwned;
use serde_json::Value;

use super::{ImageFigures, ListFigures, Record, Results, Setting, Times, Vpls, flat::FlatRecord};

/// The field of a file of schema 1, whose records are flat.
pub(super) fn flat_fault(file: &Value) -> Option<String> {
    record_fault::<FlatRecord>(file, |record, at| {
        field_fault::<Setting>(record, at)
            .or_else(|| field_fault::<Times>(record, at))
            .or_else(|| field_fault::<ListFigures>(record, at))
            .or_else(|| field_fault::<ImageFigures>(record, at))
    })
}

/// The field of a file of today's schema.
pub(super) fn nested_fault(file: &Value) -> Option<String> {
    let in_record = record_fault::<Record>(file, |record, at| {
        section_fault::<Setting>(record, at, "setting")
            .or_else(|| section_fault::<Times>(record, at, "times"))
            .or_else(|| section_fault::<ListFigures>(record, at, "lists"))
            .or_else(|| section_fault::<ImageFigures>(record, at, "image"))
            .or_else(|| section_fault::<Vpls>(record, at, "indirect"))
            .or_else(|| field_fault::<Record>(record, at))
    });
    in_record.or_else(|| field_fault::<Results>(file, ""))
}

/// The first record that cannot be read, with the field that `find` names.
fn record_fault<R: DeserializeOwned>(
    file: &Value,
    find: impl Fn(&Value, &str) -> Option<String>,
) -> Option<String> {
    let records = file.get("records")?.as_array()?;
    records.iter().enumerate().find_map(|(ix, record)| {
        let error = R::deserialize(record).err()?;
        let at = format!("records[{ix}]");
        Some(find(record, &format!("{at}.")).unwrap_or_else(|| format!("{at}: {error}")))
    })
}

fn section_fault<T: DeserializeOwned>(record: &Value, at: &str, section: &str) -> Option<String> {
    field_fault::<T>(record.get(section)?, &format!("{at}{section}."))
}

/// The first field that cannot be read by itself, and why.
fn field_fault<T: DeserializeOwned>(fields: &Value, at: &str) -> Option<String> {
    fields.as_object()?.iter().find_map(|(name, value)| {
        let field = Value::Object([(name.clone(), value.clone())].into_iter().collect());
        let error = T::deserialize(field).err()?.to_string();
        // The other fields are missing.
        (!error.starts_with("missing field")).then(|| format!("{at}{name}: {error}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_names_the_record_and_the_field() {
        let flat = include_str!("example_schema_1.json");
        let nested = include_str!("example.json");
        for (section, name, wrong, reason) in [
            ("setting", "triangles", Value::from("many"), "expected u64"),
            ("times", "clock", Value::from("sundial"), "unknown variant `sundial`"),
            ("lists", "longest_list", Value::from(-1), "expected u64"),
            ("image", "max_abs_diff", Value::from("x"), "expected f64"),
        ] {
            let mut file: Value = serde_json::from_str(flat).unwrap();
            file["records"][0][name] = wrong.clone();
            let fault = flat_fault(&file).expect("a fault");
            assert!(fault.starts_with(&format!("records[0].{name}: ")), "{fault}");
            assert!(fault.contains(reason), "{fault}");
            let name = name.replace("longest_list", "longest");
            let mut file: Value = serde_json::from_str(nested).unwrap();
            file["records"][0][section][&name] = wrong;
            let fault = nested_fault(&file).expect("a fault");
            assert!(fault.starts_with(&format!("records[0].{section}.{name}: ")), "{fault}");
            assert!(fault.contains(reason), "{fault}");
        }
        let mut file: Value = serde_json::from_str(nested).unwrap();
        assert_eq!(nested_fault(&file), None);
        file["command"] = Value::from(7);
        let fault = nested_fault(&file).expect("a fault");
        assert!(fault.starts_with("command: invalid type: integer `7`"), "{fault}");
    }
}
