//! How much a file may make of itself, checked before memory is asked for.
//!
//! A few bytes can stand for a lot: `{},` is a node, an image's header names its pixels, an accessor
//! without data is as long as it says, and many primitives may share one accessor. Each such
//! kind has a fixed limit, and what takes memory is held against the machine's.

use std::fmt;

use gltf::json::{
    Index,
    accessor::Accessor,
    mesh::{Mode, Primitive, Semantic},
    validation::Checked,
};
use serde::{
    Deserialize,
    de::{Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor},
};

use super::file::{File, invalid};
use crate::{SceneError, memory::machine_bytes};

/// The share of the machine's memory that any one kind of data may take: buffers, meshes, images.
/// What is made of them (hierarchies, copies on their way to the GPU) takes more.
const SHARE: u64 = 4;

/// The most bytes of a scene's file: what the length in a GLB's header can say.
pub(super) const MAX_FILE_BYTES: u64 = u32::MAX as u64;

/// The most bytes of an encoded image.
pub(super) const MAX_IMAGE_BYTES: u64 = 1 << 30;

/// The most pixels of all images in use together: 8 GiB once decoded.
const MAX_PIXELS: u64 = 1 << 31;

/// The most vertices and indices, every primitive counting its own: many primitives of a small
/// file can share one large accessor, and each becomes a mesh of its own.
const MAX_ELEMENTS: u64 = 1 << 27;

/// The most elements of all accessors that have no buffer view, every primitive counting its own.
/// They cost a file nothing.
const MAX_ZEROED: u64 = 1 << 22;

/// The most elements of the lists at a file's root.
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

/// Checks the lengths of the lists in a file's JSON without building them. JSON that is malformed
/// passes: the parser says more about it.
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

/// Checks what the file's meshes will take.
pub(super) fn check_meshes(file: &File) -> Result<(), SceneError> {
    let mut need = Need::default();
    for primitive in file.root.meshes.iter().flat_map(|mesh| &mesh.primitives) {
        need.add(file, primitive);
    }
    let each = "(each primitive counts its own)";
    let checks = [
        ("vertices and indices", need.elements, MAX_ELEMENTS),
        ("elements of accessors without bufferView", need.zeroed, MAX_ZEROED),
        ("bytes of memory", need.bytes, budget_bytes()),
    ];
    for (what, count, most) in checks {
        if count > most {
            let field = format!("meshes' {what} {each}");
            return Err(file.invalid(field, count, format!("at most {most}")));
        }
    }
    Ok(())
}

/// What meshes take.
#[derive(Default)]
struct Need {
    elements: u64,
    zeroed: u64,
    bytes: u64,
}

impl Need {
    fn add(&mut self, file: &File, primitive: &Primitive) {
        const VERTEX: u64 = size_of::<crate::Vertex>() as u64;
        let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let positions = attribute(Semantic::Positions).map_or(0, |ix| count(file, ix));
        let corners = primitive.indices.map_or(positions, |ix| count(file, ix));
        let strip =
            matches!(primitive.mode, Checked::Valid(Mode::TriangleStrip | Mode::TriangleFan));
        let indices = if strip { corners.saturating_mul(3) } else { corners };
        let mut bytes = positions.saturating_mul(VERTEX + 12);
        bytes = bytes.saturating_add(indices.saturating_mul(4));
        if attribute(Semantic::Normals).is_none() {
            // Every corner becomes a vertex.
            bytes = bytes.saturating_add(indices.saturating_mul(VERTEX + 4));
        }
        self.bytes = self.bytes.saturating_add(bytes);
        let own = primitive.indices.map_or(0, |_| corners);
        self.elements = self.elements.saturating_add(positions).saturating_add(own);
        let accessors = primitive.attributes.values().copied().chain(primitive.indices);
        for accessor in accessors {
            let is_zeroed = |a: &Accessor| a.buffer_view.is_none();
            if file.root.get(accessor).is_some_and(is_zeroed) {
                self.zeroed = self.zeroed.saturating_add(count(file, accessor));
            }
        }
    }
}

/// An accessor's count; 0 where it is beyond 32 bits, which the reader of accessors refuses.
fn count(file: &File, accessor: Index<Accessor>) -> u64 {
    let count = file.root.get(accessor).map_or(0, |accessor| accessor.count.0);
    if count <= u64::from(u32::MAX) { count } else { 0 }
}
