//! Puts a checksum into JSON files, to detect later damage.
//!
//! The last field of a file is the checksum of all bytes before it. Files of earlier versions have no checksum
//! and are read without a check.

use serde::Serialize;
use serde_json::Value;

/// The field that holds the checksum.
const FIELD: &str = "checksum";

/// Digits of a checksum.
const DIGITS: usize = 32;

/// The JSON text of a value, with its checksum.
pub(crate) fn sealed(value: &impl Serialize) -> Result<String, serde_json::Error> {
    let text = serde_json::to_string_pretty(value)?;
    Ok(match text.strip_suffix("\n}") {
        Some(body) => body.to_owned() + &seal(&checksum(body.as_bytes())) + "\n",
        None => text + "\n",
    })
}

/// The end of a file, after the bytes that the checksum covers.
fn seal(checksum: &str) -> String {
    format!(",\n  \"{FIELD}\": \"{checksum}\"\n}}")
}

/// The value in a file, and its checksum.
///
/// # Errors
///
/// The text is cut short, is not JSON, or does not match its checksum.
pub(crate) fn unsealed(bytes: &[u8]) -> Result<(Value, String), String> {
    let value: Value = serde_json::from_slice(bytes).map_err(|error| {
        if error.is_eof() { format!("it is cut short ({error})") } else { error.to_string() }
    })?;
    let Some(stated) = value.get(FIELD) else { return Ok((value, checksum(bytes))) };
    let stated = stated.as_str().unwrap_or_default().to_owned();
    let body = bytes.trim_ascii_end().strip_suffix(seal(&stated).as_bytes());
    if body.is_none_or(|body| checksum(body) != stated) {
        return Err(format!(
            "it was changed after it was written: its {FIELD} does not match its contents"
        ));
    }
    Ok((value, stated))
}

fn checksum(bytes: &[u8]) -> String {
    blake3::hash(bytes).to_hex().as_str()[..DIGITS].to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn every_change_to_a_file_is_detected() {
        let value = json!({"times": [0.1, 2.0, 1e-9], "name": "a", "none": null});
        let text = sealed(&value).unwrap();
        assert_eq!(unsealed(text.as_bytes()).unwrap().0["times"], value["times"]);
        for (was, is) in
            [("0.1", "0.2"), ("\"a\"", "\"b\""), ("null", "0"), ("2.0,", ""), (" ", "")]
        {
            let changed = text.replacen(was, is, 1);
            assert_ne!(changed, text);
            let error = unsealed(changed.as_bytes()).expect_err(was);
            assert!(error.contains("changed after it was written"), "{error}");
        }
        // Every truncated text is an error.
        for end in 1..text.trim_end().len() {
            assert!(unsealed(&text.as_bytes()[..end]).is_err(), "{end}");
        }
        assert!(unsealed(&text.as_bytes()[..40]).unwrap_err().contains("cut short"));
        // Files of earlier versions have no checksum.
        assert_eq!(unsealed(value.to_string().as_bytes()).unwrap().0, value);
    }
}
