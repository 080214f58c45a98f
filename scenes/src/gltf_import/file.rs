//! Opens the container: JSON, binary chunk, buffers and URIs. Every range is checked.

use std::{
    collections::HashMap,
    path::{Path, PathBuf},
    sync::Mutex,
};

use base64::{
    Engine,
    engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig},
};
use gltf::json::{
    Root,
    mesh::Semantic,
    validation::{Checked, Error as Fault, Validate},
};

use super::{
    Warnings, adapt, extensions,
    invalid::invalid,
    json_path::as_in_file,
    limits,
    meshopt::is_fallback,
    parts::{is_absolute, read_part, read_regular},
};
use crate::SceneError;

/// A parsed and validated file with its buffers.
pub(super) struct File {
    pub(super) path: PathBuf,
    pub(super) root: Root,
    buffers: Vec<Vec<u8>>,
    /// The bytes of compressed buffer views.
    decoded: HashMap<usize, Vec<u8>>,
    /// Warnings from reading the JSON and the parts. Images are read in parallel.
    notes: Mutex<Warnings>,
}

impl File {
    /// Reads a `.gltf` or `.glb` file and all its buffers. The content decides which of the two it
    /// is.
    pub(super) fn open(path: &Path) -> Result<Self, SceneError> {
        let bytes = read(path)?;
        let (json, binary) = split(path, &bytes)?;
        let mut warnings = Warnings::default();
        let root = parse(path, json, &mut warnings)?;
        let (buffers, decoded) = (Vec::new(), HashMap::new());
        let notes = Mutex::new(warnings);
        let mut file = Self { path: path.into(), root, buffers, decoded, notes };
        let (mut together, most) = (0_u64, limits::budget_bytes());
        for (ix, buffer) in file.root.buffers.iter().enumerate() {
            let field = format!("buffers[{ix}]");
            let wanted = buffer.byte_length.0;
            let mut data = match (&buffer.uri, binary) {
                (Some(uri), _) => {
                    let most_left = most.saturating_sub(together).saturating_add(1);
                    file.fetch(uri, &format!("{field}.uri"), wanted.min(most_left))?
                }
                (None, Some(binary)) if ix == 0 => binary
                    [..binary.len().min(usize::try_from(wanted).unwrap_or(usize::MAX))]
                    .to_vec(),
                // Only views that are compressed in another buffer refer to it.
                (None, _) if is_fallback(buffer) => {
                    file.buffers.push(Vec::new());
                    continue;
                }
                (None, _) => {
                    return Err(file.invalid(field, "without uri", "a uri or the GLB's BIN chunk"));
                }
            };
            together = together.saturating_add(data.len() as u64);
            if together > most {
                let accepted = format!("at most {most} bytes together with the buffers before it");
                return Err(file.invalid(format!("{field}.byteLength"), wanted, accepted));
            }
            if (data.len() as u64) < wanted {
                let accepted = format!("at most {}, the number of bytes present", data.len());
                return Err(file.invalid(format!("{field}.byteLength"), wanted, accepted));
            }
            data.truncate(wanted as usize);
            file.buffers.push(data);
        }
        Ok(file)
    }

    /// Keeps the decoded bytes of compressed buffer views; [`view`](Self::view) returns them.
    pub(super) fn set_decoded(&mut self, decoded: HashMap<usize, Vec<u8>>) {
        self.decoded = decoded;
    }

    /// Adds a warning while parts are read.
    pub(super) fn note(&self, warning: String) {
        if let Ok(mut notes) = self.notes.lock() {
            notes.add(warning);
        }
    }

    /// Takes the warnings that were added while parts were read.
    pub(super) fn take_notes(&self) -> Warnings {
        self.notes.lock().map(|mut notes| std::mem::take(&mut *notes)).unwrap_or_default()
    }

    /// The error for a field with a value that is not accepted.
    pub(super) fn invalid(
        &self,
        field: impl Into<String>,
        value: impl ToString,
        accepted: impl Into<String>,
    ) -> SceneError {
        invalid(&self.path, field, value, accepted)
    }

    /// The bytes of a buffer view, decoded where they are compressed.
    pub(super) fn view(&self, ix: usize) -> Result<&[u8], SceneError> {
        if let Some(bytes) = self.decoded.get(&ix) {
            return Ok(bytes);
        }
        let views = &self.root.buffer_views;
        let view = views
            .get(ix)
            .ok_or_else(|| self.invalid("bufferView", ix, format!("below {}", views.len())))?;
        let start = view.byte_offset.map_or(0, |offset| offset.0);
        let field = format!("bufferViews[{ix}]");
        self.part(&field, view.buffer.value(), start, view.byte_length.0)
    }

    /// Some bytes of a buffer.
    pub(super) fn part(
        &self,
        field: &str,
        buffer: usize,
        start: u64,
        length: u64,
    ) -> Result<&[u8], SceneError> {
        let bytes = self.buffers.get(buffer).ok_or_else(|| {
            let accepted = format!("below {}", self.buffers.len());
            self.invalid(format!("{field}.buffer"), buffer, accepted)
        })?;
        let end = start.checked_add(length);
        end.and_then(|end| bytes.get(usize::try_from(start).ok()?..usize::try_from(end).ok()?))
            .ok_or_else(|| {
                let accepted = format!("inside its buffer of {} bytes", bytes.len());
                self.invalid(field, format!("{length} bytes from {start}"), accepted)
            })
    }

    /// The bytes that a URI names: those of a data URI, or the first `most` of a file beside the
    /// scene.
    pub(super) fn fetch(&self, uri: &str, field: &str, most: u64) -> Result<Vec<u8>, SceneError> {
        let shown: String = uri.chars().take(60).collect();
        if let Some(data) = uri.strip_prefix("data:") {
            let (head, body) = data.split_once(',').ok_or_else(|| {
                self.invalid(field, &shown, "a data URI with a comma before its data")
            })?;
            let bytes: Vec<u8> = percent_encoding::percent_decode_str(body).collect();
            if head.ends_with(";base64") {
                let digits: Vec<u8> =
                    bytes.into_iter().filter(|byte| !byte.is_ascii_whitespace()).collect();
                return BASE64
                    .decode(digits)
                    .map_err(|_| self.invalid(field, &shown, "valid base64"));
            }
            return Ok(bytes);
        }
        if uri.is_empty() || uri.contains("://") {
            let shown = format!("{shown:?}");
            return Err(self.invalid(field, &shown, "a data URI or a relative path"));
        }
        let name = percent_encoding::percent_decode_str(uri)
            .decode_utf8()
            .map_err(|_| self.invalid(field, &shown, "UTF-8 when percent-decoded"))?;
        let name = Path::new(name.as_ref());
        if is_absolute(name) {
            let shown = format!("{shown:?}");
            return Err(self.invalid(field, &shown, "a data URI or a relative path"));
        }
        let folder = self.path.parent().unwrap_or(Path::new(""));
        let part = read_part(folder, name, most).map_err(|source| SceneError::ReadPart {
            file: self.path.clone(),
            field: field.into(),
            part: folder.join(name),
            source,
        })?;
        if let Some(outside) = part.outside {
            self.note(format!("{field} {shown:?} lies outside the scene's folder: {outside:?}"));
        }
        Ok(part.bytes)
    }
}

/// Data URIs may omit the padding at their end, and may contain line breaks.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

fn read(path: &Path) -> Result<Vec<u8>, SceneError> {
    read_regular(path, limits::MAX_FILE_BYTES)
        .map_err(|source| SceneError::Read { file: path.into(), source })
}

/// Splits a file into its JSON and the binary chunk of a GLB.
fn split<'a>(path: &Path, bytes: &'a [u8]) -> Result<(&'a [u8], Option<&'a [u8]>), SceneError> {
    let Some(rest) = bytes.strip_prefix(b"glTF") else {
        let is_named_glb = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("glb"));
        // A `.glb` may hold the JSON of a `.gltf` by mistake, and is read as such.
        let is_json = bytes.iter().find(|b| !b.is_ascii_whitespace()) == Some(&b'{');
        if is_named_glb && !is_json {
            let magic = format!("{:?}", String::from_utf8_lossy(&bytes[..bytes.len().min(4)]));
            return Err(invalid(path, "GLB magic", magic, "\"glTF\""));
        }
        return Ok((bytes, None));
    };
    let number = |bytes: &[u8], at: usize| {
        let four = bytes.get(at..at + 4)?;
        Some(u32::from_le_bytes(four.try_into().ok()?))
    };
    let truncated = |field: &str| invalid(path, field, "truncated", "complete");
    let version = number(rest, 0).ok_or_else(|| truncated("GLB header"))?;
    if version != 2 {
        return Err(invalid(path, "GLB version", version, "2"));
    }
    let length = number(rest, 4).ok_or_else(|| truncated("GLB header"))? as usize;
    if length > bytes.len() || length < 12 {
        let accepted = format!("between 12 and {}, the file's bytes", bytes.len());
        return Err(invalid(path, "GLB length", length, accepted));
    }
    let mut rest = &bytes[12..length];
    let mut chunk = |field: &str| -> Result<([u8; 4], &'a [u8]), SceneError> {
        let size = number(rest, 0).ok_or_else(|| truncated(field))? as usize;
        let kind = rest.get(4..8).and_then(|kind| kind.try_into().ok());
        let kind: [u8; 4] = kind.ok_or_else(|| truncated(field))?;
        let accepted = || format!("at most {}, the bytes left", rest.len() - 8);
        let data = rest
            .get(8..8usize.saturating_add(size))
            .ok_or_else(|| invalid(path, format!("{field} length"), size, accepted()))?;
        rest = &rest[8 + size..];
        Ok((kind, data))
    };
    let (kind, json) = chunk("GLB chunk 0")?;
    if kind != *b"JSON" {
        let kind = format!("{:?}", String::from_utf8_lossy(&kind));
        return Err(invalid(path, "GLB chunk 0 type", kind, "JSON"));
    }
    // Chunks of other types belong to extensions, and glTF requires readers to ignore them.
    let (mut at, mut binary) = (20 + json.len(), None);
    for ix in 1_u64.. {
        if at >= length {
            break;
        }
        let (kind, data) = chunk(&format!("GLB chunk {ix}"))?;
        at += 8 + data.len();
        if kind == *b"BIN\0" && binary.is_none() {
            binary = Some(data);
        }
    }
    Ok((json, binary))
}

/// Parses and validates the JSON, so that indices between its parts are in range.
fn parse(path: &Path, json: &[u8], warnings: &mut Warnings) -> Result<Root, SceneError> {
    limits::check_counts(path, json)?;
    let malformed = |e| invalid(path, "JSON", format!("malformed ({e})"), "glTF 2.0");
    let mut json: serde_json::Value = serde_json::from_slice(json).map_err(malformed)?;
    let asset = json.get("asset").cloned();
    adapt::adapt(&mut json, warnings);
    let known = extensions::check(path, &json, warnings);
    extensions::strip(&mut json);
    let root: Root = serde_json::from_value(json).map_err(|e| {
        // JSON of another version may differ anywhere. Naming the version helps more than naming a
        // field.
        let wrong = asset.and_then(|asset| check_version_of(path, &asset).err());
        wrong.unwrap_or_else(|| malformed(e))
    })?;
    check_version(path, &root.asset.version, root.asset.min_version.as_deref())?;
    known?;
    check_positions(path, &root)?;
    let mut fault = None;
    root.validate(&root, gltf::json::Path::new, &mut |at, error| {
        // `extensions::check` has checked required extensions, against a longer list.
        if error != Fault::Unsupported && fault.is_none() {
            let field = as_in_file(&at().to_string());
            fault = (!adapt::is_tolerated(&field, error)).then_some((field, error));
        }
    });
    match fault {
        None => Ok(root),
        Some((field, error)) => {
            let (value, accepted) = match error {
                Fault::IndexOutOfBounds => ("an index out of range", "the index of an element"),
                Fault::Missing => ("missing", "present"),
                Fault::Oversize => ("too large", "addressable"),
                _ => ("not valid", "as glTF 2.0 specifies"),
            };
            Err(invalid(path, field, value, accepted))
        }
    }
}

/// Checks the versions of a file whose JSON is not that of glTF 2.0.
fn check_version_of(path: &Path, asset: &serde_json::Value) -> Result<(), SceneError> {
    let text = |field: &str| match asset.get(field) {
        None => Ok(None),
        Some(serde_json::Value::String(text)) => Ok(Some(text.as_str())),
        Some(other) => {
            Err(invalid(path, format!("asset.{field}"), other, "a string such as \"2.0\""))
        }
    };
    check_version(path, text("version")?.unwrap_or("2.0"), text("minVersion")?)
}

/// Accepts every file of glTF 2, unless it requires a later minor version.
fn check_version(path: &Path, version: &str, least: Option<&str>) -> Result<(), SceneError> {
    let parts = |text: &str| -> Option<(u32, u32)> {
        let (major, minor) = text.split_once('.')?;
        let number = |digits: &str| {
            let all_digits = digits.bytes().all(|b| b.is_ascii_digit());
            digits.parse().ok().filter(|_| all_digits)
        };
        Some((number(major)?, number(minor)?))
    };
    if !matches!(parts(version), Some((2, _))) {
        return Err(invalid(
            path,
            "asset.version",
            format!("{version:?}"),
            "\"2.0\" or another 2.x",
        ));
    }
    match least {
        Some(least) if parts(least).is_none_or(|least| least > (2, 0)) => {
            Err(invalid(path, "asset.minVersion", format!("{least:?}"), "at most \"2.0\""))
        }
        _ => Ok(()),
    }
}

/// Checks the accessors of POSITION, because gltf-json uses them before it has validated their
/// indices.
fn check_positions(path: &Path, root: &Root) -> Result<(), SceneError> {
    for (mesh_ix, mesh) in root.meshes.iter().enumerate() {
        for (ix, primitive) in mesh.primitives.iter().enumerate() {
            let position = primitive.attributes.get(&Checked::Valid(Semantic::Positions));
            if let Some(position) = position
                && position.value() >= root.accessors.len()
            {
                return Err(invalid(
                    path,
                    format!("meshes[{mesh_ix}].primitives[{ix}].attributes.POSITION"),
                    position,
                    format!("below {}", root.accessors.len()),
                ));
            }
        }
    }
    Ok(())
}
