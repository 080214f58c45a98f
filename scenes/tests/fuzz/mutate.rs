//! Makes inputs: seeds with a few changes in places that readers use.

use std::{
    fs,
    path::{Path, PathBuf},
};

use rand::RngExt;
use rand_pcg::Pcg64Mcg;
use serde_json::{Value, json};

use crate::{
    made_up::{MadeUp, crc32},
    odd,
};

/// A file to be read, and the parts beside it.
pub(crate) struct Input {
    name: &'static str,
    bytes: Vec<u8>,
    part: Vec<u8>,
}

impl Input {
    /// Writes it and its parts. Returns the path of the file.
    pub(crate) fn write(&self, folder: &Path) -> PathBuf {
        let write = |name: &str, bytes: &[u8]| fs::write(folder.join(name), bytes).expect("writes");
        write(self.name, &self.bytes);
        write("part.bin", &self.part);
        write("part.png", &crate::made_up::png());
        #[cfg(unix)]
        std::os::unix::fs::symlink("/dev/zero", folder.join("link.bin")).expect("links");
        folder.join(self.name)
    }
}

/// A seed with a few changes, as GLB or as glTF with its buffer inside or beside it.
pub(crate) fn input(seeds: &[MadeUp], rng: &mut Pcg64Mcg) -> Input {
    let mut file = seeds[rng.random_range(0..seeds.len())].clone();
    // Mostly few changes, because the first one that is refused hides the others.
    let changes = [1, 1, 1, 1, 2, 2, 2, 3, 4, 6];
    for _ in 0..changes[rng.random_range(0..changes.len())] {
        match rng.random_range(0..20) {
            0..12 => change_json(&mut file.json, rng),
            12..14 => repeat(&mut file.json, rng),
            14..18 => change_binary(&mut file.binary, rng),
            _ => change_image_header(&mut file.binary, rng),
        }
    }
    let part = file.binary.clone();
    match rng.random_range(0..10) {
        0..6 => {
            let mut bytes = file.glb();
            if rng.random_bool(0.3) {
                change_container(&mut bytes, rng);
            }
            Input { name: "input.glb", bytes, part }
        }
        way => {
            let base64 = base64::Engine::encode(&base64::prelude::BASE64_STANDARD, &part);
            let inside = format!("data:application/octet-stream;base64,{base64}");
            if let Some(buffer) = file.json.pointer_mut("/buffers/0")
                && buffer.is_object()
            {
                buffer["uri"] = if way < 8 { "part.bin".into() } else { inside.into() };
            }
            let mut bytes = file.json.to_string().into_bytes();
            if rng.random_bool(0.1) {
                change_binary(&mut bytes, rng);
            }
            Input { name: "input.gltf", bytes, part }
        }
    }
}

/// The paths of all values of the JSON.
fn paths(json: &Value, at: String, out: &mut Vec<String>) {
    match json {
        Value::Object(map) => {
            for (key, value) in map {
                let key = key.replace('~', "~0").replace('/', "~1");
                paths(value, format!("{at}/{key}"), out);
            }
        }
        Value::Array(list) => {
            for (ix, value) in list.iter().enumerate().take(50) {
                paths(value, format!("{at}/{ix}"), out);
            }
        }
        _ => {}
    }
    out.push(at);
}

fn any_path(json: &Value, rng: &mut Pcg64Mcg) -> String {
    let mut all = Vec::new();
    paths(json, String::new(), &mut all);
    all.swap_remove(rng.random_range(0..all.len()))
}

fn change_json(json: &mut Value, rng: &mut Pcg64Mcg) {
    let path = any_path(json, rng);
    let other = any_path(json, rng);
    let copy = json.pointer(&other).cloned().unwrap_or_default();
    let Some(value) = json.pointer_mut(&path) else { return };
    match rng.random_range(0..8) {
        // Replace a number by another one near it.
        0..2 if value.is_number() => {
            let factor = [-1.0, 0.0, 0.5, 2.0, 1000.0, 1e10][rng.random_range(0..6)];
            let number = value.as_f64().unwrap_or(1.0) * factor;
            *value = if number.fract() == 0.0 && number.abs() < 1e15 {
                json!(number as i64)
            } else {
                json!(number)
            };
        }
        0..5 => *value = odd::value(rng),
        5 => *value = copy,
        _ => match path.rsplit_once('/') {
            Some((parent, key)) => match json.pointer_mut(parent) {
                Some(Value::Object(map)) => drop(map.remove(key)),
                Some(Value::Array(list)) => {
                    list.pop();
                }
                _ => {}
            },
            None => *value = odd::value(rng),
        },
    }
}

/// Makes a list long, or a tree deep.
fn repeat(json: &mut Value, rng: &mut Pcg64Mcg) {
    let count = 1_usize << rng.random_range(1..13);
    if rng.random_bool(0.2) {
        // A chain of nodes below node 0.
        let Some(nodes) = json.pointer_mut("/nodes").and_then(Value::as_array_mut) else { return };
        let first = nodes.len();
        let template = nodes.first().cloned().unwrap_or_default();
        for ix in 0..count {
            let mut node = template.clone();
            if node.is_object() {
                let next = if rng.random_range(0..count) == 0 { 0 } else { first + ix + 1 };
                node["children"] = json!([next.min(first + count - 1)]);
            }
            nodes.push(node);
        }
        if let Some(last) = nodes.last_mut().and_then(Value::as_object_mut) {
            last.remove("children");
        }
        if let Some(root) = nodes.first_mut().filter(|node| node.is_object()) {
            root["children"] = json!([first]);
        }
        return;
    }
    let mut all = Vec::new();
    paths(json, String::new(), &mut all);
    all.retain(|path| json.pointer(path).is_some_and(Value::is_array));
    if all.is_empty() {
        return;
    }
    let path = all.swap_remove(rng.random_range(0..all.len()));
    if let Some(list) = json.pointer_mut(&path).and_then(Value::as_array_mut)
        && !list.is_empty()
    {
        let element = list[rng.random_range(0..list.len())].clone();
        list.extend(std::iter::repeat_n(element, count));
    }
}

fn change_binary(bytes: &mut Vec<u8>, rng: &mut Pcg64Mcg) {
    if bytes.is_empty() {
        return;
    }
    let at = rng.random_range(0..bytes.len());
    match rng.random_range(0..6) {
        0 => bytes.truncate(at),
        1 => bytes[at] = rng.random(),
        2 => {
            let end = bytes.len().min(at + rng.random_range(1..64));
            bytes[at..end].fill([0, 0xff, b' '][rng.random_range(0..3)]);
        }
        3..5 => {
            let at = at / 4 * 4;
            let value = odd::float(rng).to_le_bytes();
            if let Some(slot) = bytes.get_mut(at..at + 4) {
                slot.copy_from_slice(&value);
            }
        }
        _ => {
            let piece = bytes[at..bytes.len().min(at + 256)].to_vec();
            bytes.splice(at..at, piece);
        }
    }
}

/// Gives a PNG another size or format with the right checksum, or a JPEG another size.
fn change_image_header(bytes: &mut [u8], rng: &mut Pcg64Mcg) {
    let size = |rng: &mut Pcg64Mcg| {
        let sizes = [0_u32, 1, 2, 3, 4096, 16_384, 16_385, 1 << 20, u32::MAX >> 1, u32::MAX];
        sizes[rng.random_range(0..sizes.len())]
    };
    let starts = |mark: &[u8]| -> Vec<usize> {
        let all = bytes.windows(mark.len()).enumerate();
        all.filter(|(_, window)| *window == mark).map(|(at, _)| at).collect()
    };
    let (png, jpeg) = (starts(b"IHDR"), starts(&[0xff, 0xc0]));
    if !png.is_empty() && rng.random_bool(0.7) {
        let at = png[rng.random_range(0..png.len())];
        let Some(header) = bytes.get_mut(at..at + 21) else { return };
        match rng.random_range(0..3) {
            0 => header[4..8].copy_from_slice(&size(rng).to_be_bytes()),
            1 => header[8..12].copy_from_slice(&size(rng).to_be_bytes()),
            _ => header[12 + rng.random_range(0..5)] = rng.random_range(0..20),
        }
        let sum = crc32(&header[..17]).to_be_bytes();
        header[17..].copy_from_slice(&sum);
    } else if !jpeg.is_empty() {
        let at = jpeg[rng.random_range(0..jpeg.len())];
        let Some(header) = bytes.get_mut(at + 4..at + 10) else { return };
        header[rng.random_range(0..6)] = rng.random();
    }
}

/// Damages a GLB's header or chunks.
fn change_container(bytes: &mut Vec<u8>, rng: &mut Pcg64Mcg) {
    match rng.random_range(0..4) {
        0 => {
            let at = rng.random_range(0..bytes.len().min(20));
            bytes[at] = rng.random();
        }
        1 => bytes.truncate(rng.random_range(0..bytes.len())),
        2 => bytes.extend([4, 0, 0, 0, b'O', b'D', b'D', 0, 1, 2, 3, 4]),
        _ => {
            let at = [4, 8, 12, 16][rng.random_range(0..4)];
            let value = [0_u32, 1, 2, 12, 20, u32::MAX, bytes.len() as u32][rng.random_range(0..7)];
            if let Some(slot) = bytes.get_mut(at..at + 4) {
                slot.copy_from_slice(&value.to_le_bytes());
            }
        }
    }
}
