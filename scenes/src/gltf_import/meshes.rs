//! Converts primitives to meshes: reads, checks and completes their attributes.

use std::collections::HashMap;

use glam::Vec3;
use gltf::json::{
    Index,
    accessor::{Accessor, Type},
    mesh::{Mode, Primitive, Semantic},
    validation::Checked,
};
use rayon::prelude::*;

use super::{
    Warnings, draco::DracoMesh, file::File, influence::Influence, materials::Materials,
    mesh_limits::check_meshes, repeats, tangents, triangle_list::triangle_list,
    warnings::kept_name,
};
use crate::{Aabb, Mesh, SceneError, Vertex};

/// All triangle meshes, and for each glTF mesh the range of its primitives among them.
pub(super) struct Meshes {
    pub(super) meshes: Vec<Mesh>,
    pub(super) ranges: Vec<std::ops::Range<u32>>,
    /// For each mesh that a skin can pose, the joints that move its vertices.
    pub(super) influences: HashMap<usize, Vec<Influence>>,
}

/// Converts every mesh of the file, with primitives in parallel.
pub(super) fn load(
    file: &File,
    materials: &Materials,
    warnings: &mut Warnings,
) -> Result<Meshes, SceneError> {
    check_meshes(file)?;
    let all = file.root.meshes.iter().enumerate();
    let jobs: Vec<_> =
        all.flat_map(|(mesh, json)| (0..json.primitives.len()).map(move |ix| (mesh, ix))).collect();
    let done: Result<Vec<_>, _> = jobs
        .par_iter()
        .map(|&(mesh, ix)| {
            let mut warnings = Warnings::default();
            let mut job = Job::new(file, materials, mesh, ix);
            Ok((mesh, job.convert(&mut warnings)?, warnings))
        })
        .collect();
    let mut meshes = Vec::new();
    let mut ranges = vec![0..0; file.root.meshes.len()];
    let mut influences = HashMap::new();
    for (source, converted, noted) in done? {
        warnings.append(noted);
        let Some((mesh, moved_by)) = converted else { continue };
        if !moved_by.is_empty() {
            influences.insert(meshes.len(), moved_by);
        }
        let range = &mut ranges[source];
        if range.start == range.end {
            *range = meshes.len() as u32..meshes.len() as u32;
        }
        range.end += 1;
        meshes.push(mesh);
    }
    Ok(Meshes { meshes, ranges, influences })
}

/// The conversion of one primitive.
struct Job<'a> {
    file: &'a File,
    primitive: &'a Primitive,
    name: String,
    field: String,
    material: usize,
    uv_set: u32,
    has_textures: bool,
    needs_tangents: bool,
    /// Its compressed form, if it has one.
    draco: Option<DracoMesh>,
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
            has_textures: materials.materials[material].textures().iter().any(Option::is_some),
            needs_tangents: materials.materials[material].normal_texture.is_some(),
            draco: None,
        }
    }

    /// The mesh and the joints that move its vertices; `None` where there is nothing to draw.
    fn convert(
        &mut self,
        warnings: &mut Warnings,
    ) -> Result<Option<(Mesh, Vec<Influence>)>, SceneError> {
        let Checked::Valid(mode) = self.primitive.mode else {
            return Ok(None);
        };
        use Mode::{LineLoop, LineStrip, Lines, Points};
        if matches!(mode, Points | Lines | LineLoop | LineStrip) {
            warnings
                .add(format!("mesh {:?}: primitives of type {mode:?} are not drawn", self.name));
            return Ok(None);
        }
        if self.attribute(Semantic::Positions).is_none() {
            warnings.add(format!("mesh {:?} has no POSITION and is not drawn", self.name));
            return Ok(None);
        }
        self.note_ignored(warnings);
        let promised = self.attribute(Semantic::Positions).and_then(|ix| self.file.root.get(ix));
        let promised = promised.map_or(0, |accessor| accessor.count.0);
        self.draco = DracoMesh::decode(self.file, self.primitive, &self.field, promised)?;
        let positions = self.positions()?;
        let indices = self.indices(mode, positions.len())?;
        if indices.is_empty() {
            warnings.add(format!("mesh {:?} has no triangles and is not drawn", self.name));
            return Ok(None);
        }
        let mut mesh = self.assemble(positions, indices, warnings)?;
        mesh.colors = self.colors(mesh.vertices.len())?;
        let mut influences = self.influences(mesh.vertices.len())?;
        if influences.is_empty() {
            repeats::drop_repeats(&mut mesh, warnings);
        }
        if mesh.indices.is_empty() {
            return Ok(None);
        }
        for sources in self.complete(&mut mesh, warnings)? {
            mesh.colors = gather(&mesh.colors, &sources);
            influences = gather(&influences, &sources);
        }
        mesh.bounds = Aabb::from_points(mesh.vertices.iter().map(|v| Vec3::from(v.position)));
        Ok(Some((mesh, influences)))
    }

    fn note_ignored(&self, warnings: &mut Warnings) {
        if self.primitive.targets.as_ref().is_some_and(|t| !t.is_empty()) {
            warnings.add("morph targets are ignored".into());
        }
        if self.attribute(Semantic::Joints(1)).is_some() {
            warnings.add("skins: JOINTS_1 is ignored; at most four joints move a vertex".into());
        }
        if self.attribute(Semantic::Colors(1)).is_some() {
            warnings.add("vertex colours: COLOR_1 is ignored; only COLOR_0 is used".into());
        }
    }

    fn attribute(&self, semantic: Semantic) -> Option<Index<Accessor>> {
        self.primitive.attributes.get(&Checked::Valid(semantic)).copied()
    }

    /// The values of an attribute, from the compressed mesh if they are in it.
    fn floats<const N: usize>(
        &self,
        semantic: &Semantic,
        accessor: Index<Accessor>,
    ) -> Result<Vec<[f32; N]>, SceneError> {
        let name = semantic.to_string();
        let compressed = self.draco.as_ref().zip(self.file.root.get(accessor));
        match compressed.and_then(|(draco, accessor)| draco.floats(&name, accessor)) {
            Some(values) => Ok(values),
            None => self.file.floats::<N>(accessor),
        }
    }

    fn positions(&self) -> Result<Vec<[f32; 3]>, SceneError> {
        let field = format!("{}.attributes.POSITION", self.field);
        let Some(accessor) = self.attribute(Semantic::Positions) else {
            return Err(self.file.invalid(field, "missing", "an accessor"));
        };
        let positions = self.floats::<3>(&Semantic::Positions, accessor)?;
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
        let indices = match (&self.draco, self.primitive.indices) {
            (Some(draco), _) => draco.indices(),
            (None, Some(accessor)) => self.file.indices(accessor)?,
            (None, None) => (0..vertices as u32).collect(),
        };
        if let Some(index) = indices.iter().find(|ix| **ix as usize >= vertices) {
            let accepted = format!("below {vertices}, the number of vertices");
            return Err(self.file.invalid(format!("{}.indices", self.field), index, accepted));
        }
        // A compressed strip is stored as triangles.
        let mode = if self.draco.is_some() { Mode::Triangles } else { mode };
        Ok(triangle_list(mode, indices))
    }

    /// The vertices with the attributes that the file has. The others stay zero.
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
        if self.has_textures && self.attribute(Semantic::TexCoords(self.uv_set)).is_none() {
            warnings.add(format!(
                "mesh {:?} has no TEXCOORD_{}, which its textures need: each texture shows one colour",
                self.name, self.uv_set
            ));
        }
        let mut bad = 0;
        for uv in vertices.iter_mut().map(|v| &mut v.uv) {
            if !(uv[0].is_finite() && uv[1].is_finite()) {
                *uv = [0.0; 2];
                bad += 1;
            }
        }
        if bad > 0 {
            warnings.add(format!(
                "mesh {:?}: {bad} NaN or infinite texture coordinates were set to 0",
                self.name
            ));
        }
        Ok(Mesh {
            name: self.name.clone(),
            vertices,
            indices,
            colors: Vec::new(),
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
        let values = self.floats::<N>(&semantic, accessor)?;
        if values.len() != vertices.len() {
            return Err(self.file.invalid(
                format!("{}.attributes ({semantic:?}) count", self.field),
                values.len(),
                format!("{}, the count of POSITION", vertices.len()),
            ));
        }
        for (vertex, value) in vertices.iter_mut().zip(values) {
            set(vertex, value);
        }
        Ok(())
    }

    /// The values of COLOR_0, one per vertex; empty where the primitive has none or all are white.
    fn colors(&self, vertices: usize) -> Result<Vec<[f32; 4]>, SceneError> {
        let Some(accessor) = self.attribute(Semantic::Colors(0)) else {
            return Ok(Vec::new());
        };
        let kind = self.file.root.get(accessor).map(|json| json.type_);
        let mut colors = if kind == Some(Checked::Valid(Type::Vec3)) {
            let colors = self.floats::<3>(&Semantic::Colors(0), accessor)?.into_iter();
            colors.map(|[r, g, b]| [r, g, b, 1.0]).collect()
        } else {
            self.floats::<4>(&Semantic::Colors(0), accessor)?
        };
        self.check_count("COLOR_0", colors.len(), vertices)?;
        for channel in colors.as_flattened_mut() {
            // glTF 2.0, section 3.7.2.1, clamps colours. NaN counts as 1.
            *channel = if channel.is_nan() { 1.0 } else { channel.clamp(0.0, 1.0) };
        }
        let is_white = colors.iter().all(|color| *color == [1.0; 4]);
        Ok(if is_white { Vec::new() } else { colors })
    }

    /// The joints that move each vertex under a skin; empty where no skin can move it.
    fn influences(&self, vertices: usize) -> Result<Vec<Influence>, SceneError> {
        let attributes =
            (self.attribute(Semantic::Joints(0)), self.attribute(Semantic::Weights(0)));
        let (Some(joints), Some(weights)) = attributes else {
            return Ok(Vec::new());
        };
        if self.file.root.skins.is_empty() {
            return Ok(Vec::new());
        }
        let joints = self.floats::<4>(&Semantic::Joints(0), joints)?;
        let weights = self.floats::<4>(&Semantic::Weights(0), weights)?;
        self.check_count("JOINTS_0", joints.len(), vertices)?;
        self.check_count("WEIGHTS_0", weights.len(), vertices)?;
        let pairs = joints.into_iter().zip(weights);
        Ok(pairs.map(|(joints, weights)| Influence::new(joints, weights)).collect())
    }

    fn check_count(&self, name: &str, count: usize, vertices: usize) -> Result<(), SceneError> {
        if count == vertices {
            return Ok(());
        }
        let field = format!("{}.attributes.{name} count", self.field);
        Err(self.file.invalid(field, count, format!("{vertices}, the count of POSITION")))
    }

    /// Adds or repairs normals and tangents. Each step that adds vertices returns, for every new
    /// vertex, the index of the old one.
    fn complete(
        &self,
        mesh: &mut Mesh,
        warnings: &mut Warnings,
    ) -> Result<Vec<Vec<u32>>, SceneError> {
        let mut sources = Vec::new();
        let has_normals = self.attribute(Semantic::Normals).is_some();
        if !has_normals {
            if mesh.indices.len() > u32::MAX as usize {
                let accepted = "at most 4294967295 to compute normals";
                let field = format!("{}.indices count", self.field);
                return Err(self.file.invalid(field, mesh.indices.len(), accepted));
            }
            sources.push(tangents::flatten(mesh));
        }
        let repaired = tangents::repair_normals(mesh);
        if repaired > 0 && has_normals {
            let name = &self.name;
            warnings.add(format!("mesh {name:?}: {repaired} normals of length 0 were replaced"));
        }
        // glTF ignores tangents where normals are missing.
        let has_tangents = has_normals && self.attribute(Semantic::Tangents).is_some();
        if self.needs_tangents && !has_tangents {
            sources.push(tangents::generate(mesh));
        }
        tangents::repair_tangents(mesh);
        Ok(sources)
    }
}

/// The values of new vertices, copied from the old ones; empty if there were none.
fn gather<T: Copy>(values: &[T], sources: &[u32]) -> Vec<T> {
    if values.is_empty() {
        return Vec::new();
    }
    sources.iter().map(|ix| values[*ix as usize]).collect()
}
