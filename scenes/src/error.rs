//! Errors of scenes. Each is one line that names the file, the field, the value, and what is
//! accepted.

use std::{fmt::Display, path::PathBuf};

use thiserror::Error;

/// Why a scene or a set of lights could not be made.
#[derive(Debug, Error)]
pub enum SceneError {
    /// A file that the scene needs cannot be read.
    #[error("{}: cannot be read: {}", one_line(file.display()), one_line(source))]
    Read {
        /// The file that could not be read.
        file: PathBuf,
        /// The system's message.
        source: std::io::Error,
    },
    /// A file that the scene's file names cannot be read.
    #[error(
        "{}: {} names {}, which cannot be read: {}",
        one_line(file.display()), quoted(field), quoted(&part.display().to_string()), one_line(source)
    )]
    ReadPart {
        /// The scene's file.
        file: PathBuf,
        /// The field that names the other file.
        field: String,
        /// The file that could not be read.
        part: PathBuf,
        /// The system's message.
        source: std::io::Error,
    },
    /// A file does not follow glTF 2.0, or asks for more than is accepted.
    #[error(
        "{}: {} is {}: it must be {}",
        one_line(file.display()), quoted(field), quoted(value), quoted(accepted)
    )]
    Invalid {
        /// The scene's file.
        file: PathBuf,
        /// The offending field, as a JSON path where it has one.
        field: String,
        /// Its value.
        value: String,
        /// What would be accepted.
        accepted: String,
    },
    /// The file requires a glTF extension that this importer does not support.
    #[error(
        "{}: extensionsRequired is {}: it must be one of {supported}",
        one_line(file.display()), quoted(extension)
    )]
    Extension {
        /// The scene's file.
        file: PathBuf,
        /// The extension's name.
        extension: String,
        /// The extensions that would be accepted.
        supported: String,
    },
    /// An image does not decode.
    #[error(
        "{}: {} does not decode as PNG, JPEG or WebP: {}",
        one_line(file.display()), quoted(image), quoted(reason)
    )]
    Image {
        /// The scene's file.
        file: PathBuf,
        /// Which image.
        image: String,
        /// The decoder's message.
        reason: String,
    },
    /// The scene has no triangles.
    #[error("{}: scene has 0 triangles: it must have at least 1", one_line(name))]
    Empty {
        /// The scene's name or file.
        name: String,
    },
    /// A parameter lies outside its range.
    #[error("{field} is {value}: it must be {accepted}")]
    OutOfRange {
        /// The parameter.
        field: &'static str,
        /// Its value.
        value: String,
        /// What would be accepted.
        accepted: &'static str,
    },
    /// A scenario whose camera does not move as its id asks.
    #[error("move of {id} is \"{}\": it must be {accepted}", quoted(asked))]
    Move {
        /// The id of the scenario's scene.
        id: String,
        /// The move that the id asks for.
        asked: String,
        /// What would be accepted.
        accepted: String,
    },
    /// A name that is neither the id of a scene nor the path of a glTF file.
    #[error(
        "scene is \"{}\": it must be a path that ends in .gltf or .glb, or one of {known}{nearest}",
        quoted(name)
    )]
    Unknown {
        /// The name.
        name: String,
        /// The ids of all procedural scenes.
        known: String,
        /// The nearest ids, as "; nearest: a, b", or nothing.
        nearest: String,
    },
}

/// The most characters that a message quotes from a file or a person.
const MAX_QUOTED: usize = 300;

/// Line separators, and marks that change the direction of the text around them.
const UNSEEN: [std::ops::RangeInclusive<char>; 3] =
    ['\u{200e}'..='\u{200f}', '\u{2028}'..='\u{202e}', '\u{2066}'..='\u{2069}'];

/// The text with its control characters, line separators and marks of direction escaped.
pub(crate) fn one_line(text: impl Display) -> String {
    let mut line = String::new();
    for c in text.to_string().chars() {
        if c.is_control() || UNSEEN.iter().any(|range| range.contains(&c)) {
            line.extend(c.escape_default());
        } else {
            line.push(c);
        }
    }
    line
}

/// The same, cut after [`MAX_QUOTED`] characters.
fn quoted(text: &str) -> String {
    match text.char_indices().nth(MAX_QUOTED) {
        Some((end, _)) => one_line(format_args!("{}...", &text[..end])),
        None => one_line(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_are_one_line_of_bounded_length() {
        let odd = "a\nb\r\u{1b}[31m\u{2028}c";
        let escaped = "a\\nb\\r\\u{1b}[31m\\u{2028}c";
        let source = || std::io::Error::other(odd);
        let (file, text) = (PathBuf::from(odd), || odd.to_owned());
        let errors = [
            SceneError::Read { file: file.clone(), source: source() },
            SceneError::ReadPart {
                file: file.clone(),
                field: text(),
                part: odd.into(),
                source: source(),
            },
            SceneError::Invalid {
                file: file.clone(),
                field: text(),
                value: text(),
                accepted: text(),
            },
            SceneError::Extension {
                file: file.clone(),
                extension: text(),
                supported: String::new(),
            },
            SceneError::Image { file: file.clone(), image: text(), reason: text() },
            SceneError::Empty { name: text() },
            SceneError::Unknown { name: text(), known: String::new(), nearest: String::new() },
            SceneError::Move { id: String::new(), asked: text(), accepted: String::new() },
        ];
        for error in errors {
            let line = error.to_string();
            assert!(line.contains(escaped) && !line.contains(char::is_control), "{line:?}");
            assert!(!line.contains('\u{2028}'), "{line:?}");
        }
        let long = || "ä".repeat(100_000);
        let errors = [
            SceneError::Extension {
                file: file.clone(),
                extension: long(),
                supported: String::new(),
            },
            SceneError::Invalid {
                file: file.clone(),
                field: long(),
                value: long(),
                accepted: long(),
            },
            SceneError::Image { file: file.clone(), image: long(), reason: long() },
            SceneError::ReadPart { file, field: long(), part: long().into(), source: source() },
            SceneError::Move { id: String::new(), asked: long(), accepted: String::new() },
        ];
        for error in errors {
            assert!(error.to_string().chars().count() < 1200, "{error}");
        }
    }
}
