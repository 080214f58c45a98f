//! A checksum in a file of JSON, so that damage after a run shows.
//!
//! The checksum is of the values, whatever their order or layout: a file that was only formatted anew is
//! the same. Files of earlier versions have none, and are read as they are.

use serde::Serialize;
use serde_json::Value;

/// The field that holds the checksum: the last of the file.
const FIELD: &str = "checksum";

/// Digits of a checksum.
const DIGITS: usize = 32;

/// A value as the text of a file, its checksum in it.
pub(crate) fn sealed(value: &impl Serialize) -> Result<String, serde_json::Error> {
    let text = serde_json::to_string_pretty(value)?;
    // Of what a reader will read: f32 are written shorter than they are.
    let sum = checksum(&serde_json::from_str(&text)?);
    Ok(match text.strip_suffix("\n}") {
        Some(open) => format!("{open},\n  \"{FIELD}\": \"{sum}\"\n}}\n"),
        None => text + "\n",
    })
}

/// What a file holds, without the order of its fields, and its checksum.
///
/// # Errors
///
/// Says what is wrong: where the text ends too early, is no JSON, or is not what was sealed.
pub(crate) fn unsealed(bytes: &[u8]) -> Result<(Value, String), String> {
    let mut value: Value = serde_json::from_slice(bytes).map_err(|error| {
        if error.is_eof() { format!("it is cut short ({error})") } else { error.to_string() }
    })?;
    let stated = value.as_object_mut().and_then(|object| object.remove(FIELD));
    let sum = checksum(&value);
    match stated {
        Some(stated) if stated.as_str() != Some(&sum) => Err(format!(
            "checksum is {stated}: its contents come to {sum}, so it was changed after it was written"
        )),
        _ => Ok((value, sum)),
    }
}

fn checksum(value: &Value) -> String {
    let mut hasher = blake3::Hasher::new();
    hash(value, &mut hasher);
    hasher.finalize().to_hex().as_str()[..DIGITS].to_owned()
}

/// Each value with a mark of its kind and its length, so that no two values hash alike.
fn hash(value: &Value, hasher: &mut blake3::Hasher) {
    let mut text = |kind: u8, text: &str| {
        hasher.update(&[kind]).update(&(text.len() as u64).to_le_bytes()).update(text.as_bytes());
    };
    match value {
        Value::Null => text(b'n', ""),
        Value::Bool(is_true) => text(b'b', if *is_true { "t" } else { "f" }),
        Value::Number(number) => text(b'd', &number.to_string()),
        Value::String(string) => text(b's', string),
        Value::Array(values) => {
            text(b'a', &values.len().to_string());
            values.iter().for_each(|value| hash(value, hasher));
        }
        Value::Object(fields) => {
            text(b'o', &fields.len().to_string());
            let mut fields: Vec<_> = fields.iter().collect();
            fields.sort_by_key(|(name, _)| *name);
            for (name, value) in fields {
                hash(&Value::String(name.clone()), hasher);
                hash(value, hasher);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn whatever_is_changed_shows_and_layout_does_not() {
        let value =
            json!({"times": [0.1, 2.0, 1e-9], "name": "a", "none": null, "command": ["\u{7}"]});
        let text = sealed(&value).unwrap();
        assert_eq!(unsealed(text.as_bytes()).unwrap().0, value);
        let compact: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(unsealed(compact.to_string().as_bytes()).unwrap().0, value);
        for (was, is) in
            [("0.1", "0.2"), ("\"a\"", "\"b\""), ("null", "0"), ("2.0,", ""), ("2.0", "2.1")]
        {
            let changed = text.replacen(was, is, 1);
            assert_ne!(changed, text);
            let error = unsealed(changed.as_bytes()).expect_err(was);
            assert!(error.contains("changed after it was written"), "{error}");
        }
        // Every text that is cut short is refused.
        for end in 1..text.trim_end().len() {
            assert!(unsealed(&text.as_bytes()[..end]).is_err(), "{end}");
        }
        assert!(unsealed(&text.as_bytes()[..40]).unwrap_err().contains("cut short"));
        // Files of earlier versions have no checksum.
        assert_eq!(unsealed(value.to_string().as_bytes()).unwrap().0, value);
    }

    #[test]
    fn every_digit_survives() {
        for number in [0.1 + 0.2, 1.0 / 3.0, 5e-324, f64::MAX, 123_456_789.123_456_79] {
            let text = sealed(&json!({ "x": number })).unwrap();
            let (value, _) = unsealed(text.as_bytes()).unwrap();
            assert_eq!(value["x"].as_f64().map(f64::to_bits), Some(number.to_bits()), "{text}");
        }
    }
}
