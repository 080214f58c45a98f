//! Primitives: attributes read, checked and completed.

use glam::Vec3;
use gltf::json::{
    Index,
    accessor::Accessor,
    mesh::{Mode, Primitive, Semantic},
    validation::Checked,
};
use rayon::prelude::*;

use super::{
    Warnings, file::File, limits, materials::Materials, repeats, tangents, warnings::kept_name,
};
use crate::{Aabb, Mesh, SceneError, Vertex};

/// All triangle meshes, and for each glTF mesh the range of its primitives among them.
pub(super) struct Meshes {
    pub(super) meshes: Vec<Mesh>,
    pub(super) ranges: Vec<std::ops::Range<u32>>,
}

/// Converts every mesh of the file, primitives in parallel.
pub(super) fn load(
    file: &File,
    materials: &Materials,
    warnings: &mut Warnings,
) -> Result<Meshes, SceneError> {
    limits::check_meshes(file)?;
    let all = file.root.meshes.iter().enumerate();
    let jobs: Vec<_> =
        all.flat_map(|(mesh, json)| (0..json.primitives.len()).map(move |ix| (mesh, ix))).collect();
    let done: Result<Vec<_>, _> = jobs
        .par_iter()
        .map(|&(mesh, ix)| {
            let mut warnings = Warnings::default();
            let job = Job::new(file, materials, mesh, ix);
            Ok((mesh, job.convert(&mut warnings)?, warnings))
        })
        .collect();
    let mut meshes = Vec::new();
    let mut ranges = vec![0..0; file.root.meshes.len()];
    for (source, mesh, noted) in done? {
        warnings.append(noted);
        let Some(mesh) = mesh else { continue };
        let range = &mut ranges[source];
        if range.start == range.end {
            *range = meshes.len() as u32..meshes.len() as u32;
        }
        range.end += 1;
        meshes.push(mesh);
    }
    Ok(Meshes { meshes, ranges })
}

/// One primitive on its way.
struct Job<'a> {
    file: &'a File,
    primitive: &'a Primitive,
    name: String,
    field: String,
    material: usize,
    uv_set: u32,
    needs_tangents: bool,
}

impl<'a> Job<'a> {
    fn new(file: &'a File, materials: &Materials, mesh: usize, ix: usize) -> Self {
        let json = &file.root.meshes[mesh];
        let primitive = &json.primitives[ix];
        let default = materials.materials.len() - 1;
        let material = primitive.material.map_or(default, |m| m.value().min(default));
        let name = json.name.as_deref().map_or_else(|| format!("mesh {mesh}"), kept_name);
        Self {
            file,
            primitive,
            name: if json.primitives.len() > 1 { format!("{name}.{ix}") } else { name },
            field: format!("meshes[{mesh}].primitives[{ix}]"),
            material,
            uv_set: materials.uv_sets[material],
            needs_tangents: materials.materials[material].normal_texture.is_some(),
        }
    }

    /// The mesh; `None` where there is nothing to draw.
    fn convert(&self, warnings: &mut Warnings) -> Result<Option<Mesh>, SceneError> {
        let Checked::Valid(mode) = self.primitive.mode else {
            return Ok(None);
        };
        use Mode::{LineLoop, LineStrip, Lines, Points};
        if matches!(mode, Points | Lines | LineLoop | LineStrip) {
            warnings.add(format!("mesh {:?}: {mode:?} are not drawn", self.name));
            return Ok(None);
        }
        self.note_ignored(warnings);
        let positions = self.positions()?;
        let indices = self.indices(mode, positions.len())?;
        if indices.is_empty() {
            warnings.add(format!("mesh {:?}: has no triangles", self.name));
            return Ok(None);
        }
        let mut mesh = self.assemble(positions, indices, warnings)?;
        repeats::drop_repeats(&mut mesh, warnings);
        if mesh.indices.is_empty() {
            return Ok(None);
        }
        self.complete(&mut mesh, warnings)?;
        mesh.bounds = Aabb::from_points(mesh.vertices.iter().map(|v| Vec3::from(v.position)));
        Ok(Some(mesh))
    }

    fn note_ignored(&self, warnings: &mut Warnings) {
        if self.primitive.targets.as_ref().is_some_and(|t| !t.is_empty()) {
            warnings.add("morph targets are ignored".into());
        }
        if self.attribute(Semantic::Joints(0)).is_some() {
            warnings.add("skins are ignored: skinned meshes show their bind pose".into());
        }
        if self.attribute(Semantic::Colors(0)).is_some() {
            warnings.add("vertex colours (COLOR_0) are ignored".into());
        }
    }

    fn attribute(&self, semantic: Semantic) -> Option<Index<Accessor>> {
        self.primitive.attributes.get(&Checked::Valid(semantic)).copied()
    }

    fn positions(&self) -> Result<Vec<[f32; 3]>, SceneError> {
        let field = format!("{}.attributes.POSITION", self.field);
        let Some(accessor) = self.attribute(Semantic::Positions) else {
            return Err(self.file.invalid(field, "missing", "an accessor"));
        };
        let positions = self.file.floats::<3>(accessor)?;
        for (ix, position) in positions.iter().enumerate() {
            if let Some(value) = position.iter().find(|x| !x.is_finite()) {
                let field = format!("{field} (accessors[{accessor}]) element {ix}");
                return Err(self.file.invalid(field, value, "finite"));
            }
        }
        Ok(positions)
    }

    /// The indices as a triangle list.
    fn indices(&self, mode: Mode, vertices: usize) -> Result<Vec<u32>, SceneError> {
        let indices = match self.primitive.indices {
            Some(accessor) => self.file.indices(accessor)?,
            None => (0..vertices as u32).collect(),
        };
        if let Some(index) = indices.iter().find(|ix| **ix as usize >= vertices) {
            let accepted = format!("below {vertices}, the number of vertices");
            return Err(self.file.invalid(format!("{}.indices", self.field), index, accepted));
        }
        Ok(match mode {
            Mode::TriangleStrip => indices
                .windows(3)
                .enumerate()
                .flat_map(|(ix, w)| {
                    let odd = ix % 2;
                    [w[0], w[1 + odd], w[2 - odd]]
                })
                .collect(),
            Mode::TriangleFan => {
                indices.windows(2).skip(1).flat_map(|w| [w[0], w[1], indices[0]]).collect()
            }
            _ => {
                let mut indices = indices;
                indices.truncate(indices.len() / 3 * 3);
                indices
            }
        })
    }

    /// Vertices as far as the file has them; what is missing stays zero.
    fn assemble(
        &self,
        positions: Vec<[f32; 3]>,
        indices: Vec<u32>,
        warnings: &mut Warnings,
    ) -> Result<Mesh, SceneError> {
        let mut vertices: Vec<_> = positions
            .into_iter()
            .map(|position| Vertex { position, ..Vertex::default() })
            .collect();
        self.fill(Semantic::Normals, &mut vertices, |v, normal| v.normal = normal)?;
        self.fill(Semantic::Tangents, &mut vertices, |v, tangent| v.tangent = tangent)?;
        self.fill(Semantic::TexCoords(self.uv_set), &mut vertices, |v, uv| v.uv = uv)?;
        let mut bad = 0;
        for uv in vertices.iter_mut().map(|v| &mut v.uv) {
            if !(uv[0].is_finite() && uv[1].is_finite()) {
                *uv = [0.0; 2];
                bad += 1;
            }
        }
        if bad > 0 {
            warnings.add(format!("mesh {:?}: {bad} NaN or infinite uvs set to 0", self.name));
        }
        Ok(Mesh {
            name: self.name.clone(),
            vertices,
            indices,
            material: self.material as u32,
            bounds: Aabb::EMPTY,
        })
    }

    fn fill<const N: usize>(
        &self,
        semantic: Semantic,
        vertices: &mut [Vertex],
        set: impl Fn(&mut Vertex, [f32; N]),
    ) -> Result<(), SceneError> {
        let Some(accessor) = self.attribute(semantic.clone()) else {
            return Ok(());
        };
        let values = self.file.floats::<N>(accessor)?;
        if values.len() != vertices.len() {
            return Err(self.file.invalid(
                format!("{}.attributes ({semantic:?}) count", self.field),
                values.len(),
                format!("{}, as POSITION has", vertices.len()),
            ));
        }
        for (vertex, value) in vertices.iter_mut().zip(values) {
            set(vertex, value);
        }
        Ok(())
    }

    /// Adds or repairs normals and tangents.
    fn complete(&self, mesh: &mut Mesh, warnings: &mut Warnings) -> Result<(), SceneError> {
        let has_normals = self.attribute(Semantic::Normals).is_some();
        if !has_normals {
            if mesh.indices.len() > u32::MAX as usize {
                let accepted = "at most 4294967295 to compute normals";
                let field = format!("{}.indices count", self.field);
                return Err(self.file.invalid(field, mesh.indices.len(), accepted));
            }
            tangents::flatten(mesh);
        }
        let repaired = tangents::repair_normals(mesh);
        if repaired > 0 && has_normals {
            let name = &self.name;
            warnings.add(format!("mesh {name:?}: {repaired} normals of length 0 replaced"));
        }
        // glTF: tangents are ignored where normals are missing.
        let has_tangents = has_normals && self.attribute(Semantic::Tangents).is_some();
        if self.needs_tangents && !has_tangents {
            tangents::generate(mesh);
        }
        tangents::repair_tangents(mesh);
        Ok(())
    }
}
