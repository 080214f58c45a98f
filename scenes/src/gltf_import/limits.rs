//! Limits on what a file can expand to, checked before memory is allocated.
//!
//! A few bytes can ask for a lot: `{},` is a node, an image's header names its pixels, an accessor
//! without data may have any length, and many primitives may share one accessor. Each of these has
//! a fixed limit. Data that takes memory must also fit into a share of the machine's memory.

use std::fmt;

use serde::{
    Deserialize,
    de::{Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor},
};

use super::invalid::invalid;
use crate::{SceneError, memory::machine_bytes};

/// One over the share of the machine's memory that each kind of data may take: buffers, meshes,
/// images. Hierarchies and copies for the GPU take further memory.
const SHARE: u64 = 4;

/// The most bytes of a scene's file, because the length in a GLB's header has 32 bits.
pub(super) const MAX_FILE_BYTES: u64 = u32::MAX as u64;

/// The most bytes of an encoded image.
pub(super) const MAX_IMAGE_BYTES: u64 = 1 << 30;

/// The most pixels of all images in use together; decoded they take 8 GiB.
const MAX_PIXELS: u64 = 1 << 31;

/// The most elements of each list at the root of a file.
const MAX_COUNTS: [(&str, u64); 12] = [
    ("nodes", 1 << 21),
    ("meshes", 1 << 20),
    ("accessors", 1 << 20),
    ("bufferViews", 1 << 20),
    ("buffers", 1 << 16),
    ("materials", 1 << 16),
    ("textures", 1 << 16),
    ("images", 1 << 16),
    ("samplers", 1 << 16),
    ("cameras", 1 << 16),
    ("animations", 1 << 16),
    ("skins", 1 << 16),
];

/// The bytes that one kind of data may take on this machine.
pub(super) fn budget_bytes() -> u64 {
    machine_bytes() / SHARE
}

/// The most pixels that all images in use may have together on this machine.
pub(super) fn max_pixels() -> u64 {
    MAX_PIXELS.min(budget_bytes() / 4)
}

/// Checks the lengths of the lists in a file's JSON without building the lists. Malformed JSON
/// passes, because the parser describes its fault better.
pub(super) fn check_counts(path: &std::path::Path, json: &[u8]) -> Result<(), SceneError> {
    let Ok(Lengths(lengths)) = serde_json::from_slice(json) else {
        return Ok(());
    };
    for (list, count) in lengths {
        let most = MAX_COUNTS.iter().find(|(name, _)| *name == list).map_or(u64::MAX, |m| m.1);
        if count > most {
            return Err(invalid(path, format!("{list} count"), count, format!("at most {most}")));
        }
    }
    Ok(())
}

/// The lengths of the lists of an object.
struct Lengths(Vec<(String, u64)>);

impl<'de> Deserialize<'de> for Lengths {
    fn deserialize<D: Deserializer<'de>>(json: D) -> Result<Self, D::Error> {
        struct Object;
        impl<'de> Visitor<'de> for Object {
            type Value = Lengths;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an object")
            }
            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Lengths, A::Error> {
                let mut lengths = Vec::new();
                while let Some(key) = map.next_key::<String>()? {
                    if MAX_COUNTS.iter().any(|(name, _)| *name == key) {
                        lengths.push((key, map.next_value::<Length>()?.0));
                    } else {
                        map.next_value::<IgnoredAny>()?;
                    }
                }
                Ok(Lengths(lengths))
            }
        }
        json.deserialize_map(Object)
    }
}

/// The length of a list.
struct Length(u64);

impl<'de> Deserialize<'de> for Length {
    fn deserialize<D: Deserializer<'de>>(json: D) -> Result<Self, D::Error> {
        struct List;
        impl<'de> Visitor<'de> for List {
            type Value = Length;
            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("an array")
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Length, A::Error> {
                let mut length = 0;
                while list.next_element::<IgnoredAny>()?.is_some() {
                    length += 1;
                }
                Ok(Length(length))
            }
        }
        json.deserialize_seq(List)
    }
}
