//! Limits on what the meshes of a file can expand to, checked before memory is allocated.

use gltf::json::{
    Index,
    accessor::Accessor,
    mesh::{Mode, Primitive, Semantic},
    validation::Checked,
};

use super::{file::File, limits::budget_bytes};
use crate::{SceneError, Vertex};

/// The most vertices and indices. Each primitive counts its own, because many primitives of a small
/// file can share one large accessor and each becomes a mesh of its own.
const MAX_ELEMENTS: u64 = 1 << 27;

/// The most elements of all accessors without a buffer view. Each primitive counts its own. They
/// cost a file nothing.
const MAX_ZEROED: u64 = 1 << 22;

/// Checks how much the file's meshes will take.
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

/// How much meshes take.
#[derive(Default)]
struct Need {
    elements: u64,
    zeroed: u64,
    bytes: u64,
}

impl Need {
    fn add(&mut self, file: &File, primitive: &Primitive) {
        const VERTEX: u64 = size_of::<Vertex>() as u64;
        let attribute = |semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let positions = attribute(Semantic::Positions).map_or(0, |ix| count(file, ix));
        let corners = primitive.indices.map_or(positions, |ix| count(file, ix));
        let strip =
            matches!(primitive.mode, Checked::Valid(Mode::TriangleStrip | Mode::TriangleFan));
        let indices = if strip { corners.saturating_mul(3) } else { corners };
        let mut bytes = positions.saturating_mul(VERTEX + 12);
        bytes = bytes.saturating_add(indices.saturating_mul(4));
        if attribute(Semantic::Normals).is_none() {
            // Flat normals give every corner a vertex of its own.
            bytes = bytes.saturating_add(indices.saturating_mul(VERTEX + 4));
        }
        self.bytes = self.bytes.saturating_add(bytes);
        let indices = primitive.indices.map_or(0, |_| corners);
        self.elements = self.elements.saturating_add(positions).saturating_add(indices);
        let accessors = primitive.attributes.values().copied().chain(primitive.indices);
        for accessor in accessors {
            let is_zeroed = |a: &Accessor| a.buffer_view.is_none();
            if file.root.get(accessor).is_some_and(is_zeroed) {
                self.zeroed = self.zeroed.saturating_add(count(file, accessor));
            }
        }
    }
}

/// An accessor's count, or 0 where it exceeds 32 bits: the reader of accessors refuses those.
fn count(file: &File, accessor: Index<Accessor>) -> u64 {
    let count = file.root.get(accessor).map_or(0, |accessor| accessor.count.0);
    if count <= u64::from(u32::MAX) { count } else { 0 }
}
