//! Small glTF files made by tests.

// Each test of the folder compiles this file and uses a part of it.
#![allow(dead_code)]

use std::path::Path;

use scenes::{Scene, SceneError, load_gltf};
use serde_json::{Value, json};

/// A file under construction: its JSON and its only buffer.
#[derive(Clone)]
pub(crate) struct MadeUp {
    pub(crate) json: Value,
    pub(crate) binary: Vec<u8>,
}

/// Floats as a buffer holds them.
pub(crate) fn floats(values: &[f32]) -> Vec<u8> {
    values.iter().flat_map(|v| v.to_le_bytes()).collect()
}

impl MadeUp {
    /// A triangle with normals, uvs and indices: accessors 0 to 3, mesh 0, node 0, material 0.
    pub(crate) fn triangle() -> Self {
        let mut file = Self {
            json: json!({
                "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                "nodes": [{"mesh": 0}],
                "meshes": [{"primitives": [{"attributes":
                    {"POSITION": 0, "NORMAL": 1, "TEXCOORD_0": 2}, "indices": 3, "material": 0}]}],
                "materials": [{}], "textures": [], "images": [],
                "buffers": [{"byteLength": 0}], "bufferViews": [], "accessors": [],
            }),
            binary: Vec::new(),
        };
        file.accessor(&floats(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]), 3, 5126, "VEC3");
        file.accessor(&floats(&[0.0, 0.0, 1.0].repeat(3)), 3, 5126, "VEC3");
        file.accessor(&floats(&[0.0, 0.0, 1.0, 0.0, 0.0, 1.0]), 3, 5126, "VEC2");
        file.accessor(&[0, 0, 1, 0, 2, 0], 3, 5123, "SCALAR");
        file
    }

    /// The list at the root.
    pub(crate) fn list(&mut self, name: &str) -> &mut Vec<Value> {
        let json = self.json.as_object_mut().expect("an object");
        json.entry(name).or_insert_with(|| json!([])).as_array_mut().expect("a list")
    }

    /// Adds to a list at the root. Returns the index.
    pub(crate) fn push(&mut self, list: &str, value: Value) -> usize {
        let list = self.list(list);
        list.push(value);
        list.len() - 1
    }

    /// Adds bytes to the buffer. Returns the index of their view.
    pub(crate) fn view(&mut self, bytes: &[u8]) -> usize {
        let offset = self.binary.len();
        self.binary.extend_from_slice(bytes);
        self.binary.resize(self.binary.len().next_multiple_of(4), 0);
        self.json["buffers"][0]["byteLength"] = self.binary.len().into();
        let view = json!({"buffer": 0, "byteOffset": offset, "byteLength": bytes.len()});
        self.push("bufferViews", view)
    }

    /// Adds an accessor over its own bytes.
    pub(crate) fn accessor(
        &mut self,
        bytes: &[u8],
        count: usize,
        component: u32,
        kind: &str,
    ) -> usize {
        let view = self.view(bytes);
        let mut accessor =
            json!({"bufferView": view, "count": count, "componentType": component, "type": kind});
        if kind == "VEC3" {
            accessor["min"] = json!([-1.0, -1.0, -1.0]);
            accessor["max"] = json!([1.0, 1.0, 1.0]);
        }
        self.push("accessors", accessor)
    }

    /// Adds an image with a texture, a material that shows it, and a mesh and node of its own.
    pub(crate) fn textured(&mut self, image: Value) {
        let image = self.push("images", image);
        let texture = self.push("textures", json!({"source": image}));
        let material = self.push(
            "materials",
            json!({"pbrMetallicRoughness": {"baseColorTexture": {"index": texture}}}),
        );
        let mut primitive = self.json["meshes"][0]["primitives"][0].clone();
        primitive["material"] = material.into();
        let mesh = self.push("meshes", json!({"primitives": [primitive]}));
        let node = self.push("nodes", json!({"mesh": mesh}));
        self.json["scenes"][0]["nodes"].as_array_mut().expect("nodes").push(node.into());
    }

    /// As a GLB.
    pub(crate) fn glb(&self) -> Vec<u8> {
        let mut json = self.json.to_string().into_bytes();
        json.resize(json.len().next_multiple_of(4), b' ');
        let mut bytes = b"glTF\x02\0\0\0".to_vec();
        bytes.extend((28 + json.len() as u32 + self.binary.len() as u32).to_le_bytes());
        for (kind, data) in [(b"JSON", &json), (b"BIN\0", &self.binary)] {
            bytes.extend((data.len() as u32).to_le_bytes());
            bytes.extend(kind);
            bytes.extend(data);
        }
        bytes
    }

    /// Loads it as a GLB.
    pub(crate) fn load(&self) -> Result<Scene, SceneError> {
        let folder = tempfile::tempdir().expect("a temporary folder");
        load_file(&folder.path().join("made-up.glb"), &self.glb())
    }

    /// The message of the error when it is loaded.
    pub(crate) fn error(&self) -> String {
        self.load().expect_err("refused").to_string()
    }
}

/// Writes a file and loads it.
pub(crate) fn load_file(path: &Path, bytes: &[u8]) -> Result<Scene, SceneError> {
    std::fs::write(path, bytes).expect("writes");
    load_gltf(path)
}

/// A PNG of any size with a correct header but without pixels.
pub(crate) fn png_header(width: u32, height: u32) -> Vec<u8> {
    let mut bytes = b"\x89PNG\r\n\x1a\n".to_vec();
    let mut header = b"IHDR".to_vec();
    header.extend(width.to_be_bytes());
    header.extend(height.to_be_bytes());
    header.extend([8, 0, 0, 0, 0]);
    for chunk in [&header[..], b"IDAT"] {
        bytes.extend((chunk.len() as u32 - 4).to_be_bytes());
        bytes.extend(chunk);
        bytes.extend(crc32(chunk).to_be_bytes());
    }
    bytes
}

/// A PNG of 2 by 2 pixels.
pub(crate) fn png() -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = image::RgbaImage::from_pixel(2, 2, image::Rgba([255, 128, 0, 255]));
    image.write_to(&mut bytes, image::ImageFormat::Png).expect("encodes");
    bytes.into_inner()
}

/// The checksum of PNG chunks.
pub(crate) fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(u32::MAX, |crc, byte| {
        (0..8).fold(crc ^ u32::from(*byte), |crc, _| {
            if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 }
        })
    })
}
