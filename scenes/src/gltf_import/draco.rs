//! Reads primitives of KHR_draco_mesh_compression.

use std::{
    collections::HashMap,
    panic::{AssertUnwindSafe, catch_unwind},
};

use draco_core::{DecodeLimits, DecoderBuffer, DracoError, Mesh as Decoded, MeshDecoder};
use gltf::json::{accessor::Accessor, mesh::Primitive, validation::Checked};
use serde::Deserialize;

use super::{accessor::largest, file::File};
use crate::SceneError;

/// The extension's name.
const NAME: &str = "KHR_draco_mesh_compression";

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
struct Json {
    buffer_view: usize,
    /// The unique id of each attribute, by its semantic.
    attributes: HashMap<String, u32>,
}

/// A decoded primitive.
pub(super) struct DracoMesh {
    decoded: Decoded,
    ids: HashMap<String, u32>,
}

impl DracoMesh {
    /// The compressed mesh of a primitive, if it has one. `vertices` is the number that its
    /// accessors promise.
    pub(super) fn decode(
        file: &File,
        primitive: &Primitive,
        field: &str,
        vertices: u64,
    ) -> Result<Option<Self>, SceneError> {
        let extensions = primitive.extensions.as_ref().map(|e| &e.others);
        let Some(json) = extensions.and_then(|all| all.get(NAME)) else {
            return Ok(None);
        };
        let field = format!("{field}.extensions.{NAME}");
        let Json { buffer_view, attributes } =
            serde_json::from_value(json.clone()).map_err(|error| {
                file.invalid(&field, json, format!("a valid compressed primitive: {error}"))
            })?;
        let bytes = file.view(buffer_view)?;
        let refuse = |reason: String| file.invalid(&field, "not decodable", reason);
        // A panic of the decoder counts as a fault of the file.
        let decoded = catch_unwind(AssertUnwindSafe(|| decode(bytes, vertices)));
        let decoded = decoded.map_err(|_| refuse("a valid Draco mesh".into()))?;
        let decoded = decoded.map_err(|error| refuse(format!("a valid Draco mesh: {error}")))?;
        for (name, id) in &attributes {
            if decoded.attribute_by_unique_id(*id).is_none() {
                let field = format!("{field}.attributes.{name}");
                return Err(file.invalid(field, id, "the id of an attribute of the Draco mesh"));
            }
        }
        Ok(Some(Self { decoded, ids: attributes }))
    }

    /// The three vertices of each triangle.
    pub(super) fn indices(&self) -> Vec<u32> {
        self.decoded.faces().iter().flat_map(|face| face.map(|point| point.0)).collect()
    }

    /// The values of an attribute, if they are compressed. Integers are normalised where the
    /// accessor asks for it.
    pub(super) fn floats<const N: usize>(
        &self,
        semantic: &str,
        accessor: &Accessor,
    ) -> Option<Vec<[f32; N]>> {
        let attribute = self.decoded.attribute_by_unique_id(*self.ids.get(semantic)?)?;
        let mut values = attribute.read_f32s(self.decoded.num_points(), N);
        if let (true, Checked::Valid(component)) = (accessor.normalized, accessor.component_type)
            && let Some(largest) = largest(component.0)
        {
            values.iter_mut().for_each(|value| *value = (*value / largest).max(-1.0));
        }
        Some(values.as_chunks::<N>().0.to_vec())
    }
}

fn decode(bytes: &[u8], vertices: u64) -> Result<Decoded, DracoError> {
    // Some encoders write more vertices than the accessors promise.
    let mut limits = DecodeLimits::default();
    limits.max_points = vertices.saturating_mul(2).saturating_add(1024);
    limits.max_faces = limits.max_points.saturating_mul(4);
    let mut buffer = DecoderBuffer::new(bytes).with_limits(limits);
    let mut decoded = Decoded::new();
    MeshDecoder::new().decode(&mut buffer, &mut decoded)?;
    Ok(decoded)
}
