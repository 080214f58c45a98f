//! Tests of EXT_meshopt_compression and KHR_draco_mesh_compression, on data that crates encode and
//! on damaged data.

use draco_core::{
    DataType, EncoderBuffer, EncoderOptions, FaceIndex, GeometryAttributeType, Mesh, MeshEncoder,
    PointAttribute,
};
use meshopt_rs::{index, vertex};

use super::{valid::add_view, *};

/// A grid of quads, large enough for several blocks: positions as bytes, and indices.
fn grid(side: u32) -> (Vec<[f32; 3]>, Vec<u32>) {
    let at = |ix: u32| {
        let (x, y) = ((ix % side) as f32, (ix / side) as f32);
        [x, y, (0.3 * x).sin() + 0.1 * y * y]
    };
    let quads = (0..side - 1).flat_map(|y| (0..side - 1).map(move |x| y * side + x));
    let indices = quads.flat_map(|a| [a, a + 1, a + side, a + 1, a + side + 1, a + side]);
    ((0..side * side).map(at).collect(), indices.collect())
}

/// Puts compressed bytes in place of a view of `size` bytes, and returns its index.
fn compress(sample: &mut Sample, bytes: &[u8], size: usize, mut extension: Value) -> usize {
    let source = add_view(sample, bytes);
    let views = sample.json["bufferViews"].as_array_mut().expect("views");
    extension["buffer"] = 0.into();
    extension["byteOffset"] = views[source]["byteOffset"].clone();
    extension["byteLength"] = bytes.len().into();
    views.push(json!({"buffer": 1, "byteOffset": 0, "byteLength": size,
        "extensions": {"EXT_meshopt_compression": extension}}));
    views.len() - 1
}

fn meshopt(mode: &str, side: u32) -> Sample {
    let mut sample = sample();
    let (positions, indices) = grid(side);
    let mut bytes = vec![0; vertex::buffer::encode_vertex_buffer_bound(positions.len(), 12)];
    let length = vertex::buffer::encode_vertex_buffer(
        &mut bytes,
        &positions,
        vertex::VertexEncodingVersion::V0,
    );
    bytes.truncate(length.expect("encodes"));
    let size = positions.len() * 12;
    let extension = json!({"byteStride": 12, "count": positions.len(), "mode": "ATTRIBUTES"});
    let position_view = compress(&mut sample, &bytes, size, extension);
    let version = || index::IndexEncodingVersion::V1;
    let mut bytes = vec![0; 16 * indices.len() + 64];
    let length = if mode == "TRIANGLES" {
        index::buffer::encode_index_buffer(&mut bytes, &indices, version()).expect("encodes")
    } else {
        index::sequence::encode_index_sequence(&mut bytes, &indices, version())
    };
    bytes.truncate(length);
    let extension = json!({"byteStride": 2, "count": indices.len(), "mode": mode});
    let index_view = compress(&mut sample, &bytes, 2 * indices.len(), extension);
    let accessors = sample.json["accessors"].as_array_mut().expect("accessors");
    accessors.push(json!({"bufferView": position_view, "componentType": 5126, "type": "VEC3",
        "count": positions.len(), "min": [0, 0, 0], "max": [1, 1, 1]}));
    accessors.push(json!({"bufferView": index_view, "componentType": 5123, "type": "SCALAR",
        "count": indices.len()}));
    let last = accessors.len();
    sample.json["meshes"][0]["primitives"] =
        json!([{"attributes": {"POSITION": last - 2}, "indices": last - 1}]);
    let fallback = json!({"byteLength": size + 2 * indices.len(),
        "extensions": {"EXT_meshopt_compression": {"fallback": true}}});
    sample.json["buffers"].as_array_mut().expect("buffers").push(fallback);
    sample.json["extensionsRequired"] = json!(["EXT_meshopt_compression"]);
    sample
}

/// Corners of all triangles of the first mesh, each triangle from its smallest corner on.
/// Compression may rotate the corners of a triangle, and Draco reorders triangles.
fn triangles(corners: impl Iterator<Item = [f32; 3]>) -> Vec<[[i32; 3]; 3]> {
    let corners: Vec<_> = corners.map(|p| p.map(|x| (x * 100.0).round() as i32)).collect();
    let turned = |triangle: &[[i32; 3]; 3]| {
        let [a, b, c] = *triangle;
        [[a, b, c], [b, c, a], [c, a, b]].into_iter().min().expect("three")
    };
    let mut all: Vec<_> = corners.as_chunks::<3>().0.iter().map(turned).collect();
    all.sort_unstable();
    all
}

fn triangles_of(scene: &Scene) -> Vec<[[i32; 3]; 3]> {
    let mesh = &scene.meshes[0];
    triangles(mesh.indices.iter().map(|ix| mesh.vertices[*ix as usize].position))
}

fn grid_triangles(side: u32) -> Vec<[[i32; 3]; 3]> {
    let (positions, indices) = grid(side);
    triangles(indices.iter().map(|ix| positions[*ix as usize]))
}

#[test]
fn meshopt_views_decode() {
    // 900 vertices fill four blocks, the last of them only in part.
    for (mode, side) in [("TRIANGLES", 30), ("INDICES", 30), ("TRIANGLES", 2)] {
        let scene = load(&meshopt(mode, side)).expect("valid");
        assert_eq!(triangles_of(&scene), grid_triangles(side), "{mode} {side}");
        assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    }
}

#[test]
fn meshopt_filters_decode() {
    use super::super::meshopt::Compressed;
    // Eight elements of eight bytes, stored verbatim as part of a group of 16.
    let decode = |filter: &str, element: [u8; 8]| -> [u8; 8] {
        let mut source = vec![0xa0];
        for byte in element {
            // The first element differs from the zeros of the tail. The others equal the first.
            source.push(3);
            let delta = byte.cast_signed();
            source.push((delta << 1 ^ delta >> 7).cast_unsigned());
            source.extend([0; 15]);
        }
        source.extend([0; 8]);
        let json = json!({"buffer": 0, "byteLength": source.len(), "byteStride": 8, "count": 2,
            "mode": "ATTRIBUTES", "filter": filter});
        let view: Compressed = serde_json::from_value(json).expect("valid");
        let bytes = view.decode(&source).expect("decodes");
        assert_eq!(bytes[..8], bytes[8..]);
        bytes[..8].try_into().expect("eight")
    };
    let shorts = |values: [i16; 4]| -> [u8; 8] {
        values.map(i16::to_le_bytes).as_flattened().try_into().expect("eight")
    };
    assert_eq!(decode("NONE", [1, 2, 3, 250, 5, 6, 7, 128]), [1, 2, 3, 250, 5, 6, 7, 128]);
    // Straight up, and a folded corner.
    assert_eq!(decode("OCTAHEDRAL", shorts([0, 0, 511, 7])), shorts([0, 0, 32767, 7]));
    assert_eq!(decode("OCTAHEDRAL", shorts([511, 511, 511, 0])), shorts([0, 0, -32767, 0]));
    // The identity, whose largest component is the fourth.
    assert_eq!(decode("QUATERNION", shorts([0, 0, 0, 2047])), shorts([0, 0, 0, 32767]));
    // 3 times 2^-1, and -1 times 2^4.
    let two = [(-1_i32 << 24) | 3, (4 << 24) | 0xff_ffff];
    let bytes: [u8; 8] = two.map(i32::to_le_bytes).as_flattened().try_into().expect("eight");
    let expected = [1.5_f32, -16.0].map(f32::to_le_bytes);
    assert_eq!(decode("EXPONENTIAL", bytes), expected.as_flattened());
}

/// The sample with a grid compressed by Draco.
fn draco(side: u32) -> Sample {
    let (positions, indices) = grid(side);
    let mut mesh = Mesh::new();
    let mut attribute = PointAttribute::new();
    let kind = GeometryAttributeType::Position;
    attribute.init(kind, 3, DataType::Float32, false, positions.len());
    for (ix, value) in positions.as_flattened().iter().enumerate() {
        attribute.buffer_mut().write(4 * ix, &value.to_le_bytes());
    }
    let id = mesh.add_attribute(attribute);
    mesh.set_num_faces(indices.len() / 3);
    for (ix, face) in indices.as_chunks::<3>().0.iter().enumerate() {
        mesh.set_face(FaceIndex(ix as u32), face.map(Into::into));
    }
    let id = mesh.attribute(id).unique_id();
    let mut encoder = MeshEncoder::new();
    encoder.set_mesh(mesh);
    let mut bytes = EncoderBuffer::new();
    encoder.encode(&EncoderOptions::new(), &mut bytes).expect("encodes");
    let mut sample = sample();
    let view = add_view(&mut sample, bytes.data());
    let accessors = sample.json["accessors"].as_array_mut().expect("accessors");
    accessors.push(json!({"componentType": 5126, "type": "VEC3", "count": positions.len(),
        "min": [0, 0, 0], "max": [1, 1, 1]}));
    accessors.push(json!({"componentType": 5123, "type": "SCALAR", "count": indices.len()}));
    let last = accessors.len();
    sample.json["meshes"][0]["primitives"] = json!([{"attributes": {"POSITION": last - 2}, "indices": last - 1, "extensions":
            {"KHR_draco_mesh_compression": {"bufferView": view, "attributes": {"POSITION": id}}}}]);
    sample.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
    sample
}

#[test]
fn draco_primitives_decode() {
    let scene = load(&draco(9)).expect("valid");
    assert_eq!(triangles_of(&scene), grid_triangles(9));
    assert!(scene.warnings.is_empty(), "{:?}", scene.warnings);
    let mut other = draco(4);
    let extension = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
    other.json.pointer_mut(extension).expect("there")["attributes"]["POSITION"] = 77.into();
    let error = load(&other).expect_err("no such attribute").to_string();
    assert!(error.contains("attributes.POSITION is 77"), "{error}");
}

/// Flipped and truncated bytes of compressed data give an error or a scene, never a panic.
#[test]
fn damaged_compression_is_refused_or_read() {
    let mut rng = Pcg64Mcg::seed_from_u64(3);
    let samples = [meshopt("TRIANGLES", 6), meshopt("INDICES", 6), draco(6)];
    let plain = sample().binary.len();
    let (mut read, mut refused) = (0, 0);
    for whole in &samples {
        for _ in 0..150 {
            let mut binary = whole.binary.clone();
            for _ in 0..rng.random_range(1..4) {
                let at = rng.random_range(plain..binary.len());
                binary[at] = rng.random();
            }
            match load(&Sample { json: whole.json.clone(), binary }) {
                Ok(_) => read += 1,
                Err(_) => refused += 1,
            }
        }
    }
    assert!(read > 10 && refused > 10, "{read} read, {refused} refused");
    for (field, value, expected) in [
        ("count", json!(1_000_000), "compressed bytes that hold all elements"),
        ("byteStride", json!(3), "byteStride"),
        ("mode", json!("ODD"), "unknown variant"),
        ("byteLength", json!(9_999_999), "inside its buffer"),
        ("buffer", json!(9), "buffer is 9"),
    ] {
        let mut faulty = meshopt("TRIANGLES", 6);
        let views = faulty.json["bufferViews"].as_array_mut().expect("views");
        let extension = views.last_mut().expect("a view");
        extension["extensions"]["EXT_meshopt_compression"][field] = value;
        let error = load(&faulty).expect_err(field).to_string();
        assert!(error.contains(expected) && error.contains("bufferViews["), "{error}");
    }
}
