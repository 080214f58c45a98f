//! The scenes of a study.

use std::path::Path;

use glam::DVec3;
use scenes::Aabb;

use crate::{
    bench::Bench,
    cli::{self, CliError, Invocation, Size, StudyArgs},
    error::HarnessError,
    report::format::slug,
};

/// A scene with its scale.
#[derive(Clone, Debug, PartialEq)]
pub struct StudyScene {
    /// The name or file.
    pub scene: String,
    /// Its name in jobs and in the report: unique within the study.
    pub name: String,
    /// Factor on its size.
    pub scale: f64,
}

impl StudyScene {
    /// The scenes that a study is asked for.
    pub fn all(args: &StudyArgs) -> Result<Vec<Self>, CliError> {
        if args.scene_scale.len() > args.scene.len() {
            let value = args.scene_scale.len().to_string();
            let accepted = "given once for each --scene at most";
            return Err(CliError::out_of_range("--scene-scale", &value, accepted));
        }
        let mut all: Vec<Self> = Vec::new();
        for (ix, scene) in args.scene.iter().enumerate() {
            let path = Path::new(scene);
            let stem = path.file_stem().map_or_else(|| scene.into(), |stem| stem.to_string_lossy());
            // Many files are called scene.gltf, so their folder names them.
            let folder = path.parent().and_then(Path::file_name).map(|name| name.to_string_lossy());
            let name = match folder {
                Some(folder) if stem == "scene" => folder.into_owned(),
                _ => stem.into_owned(),
            };
            let name = name.strip_prefix(scenes::stability::PREFIX).unwrap_or(&name);
            let mut name = slug(name);
            while all.iter().any(|known| known.name == name) {
                name += &format!("-{}", ix + 1);
            }
            let scale = args.scene_scale.get(ix).copied().unwrap_or(1.0);
            all.push(Self { scene: scene.clone(), name, scale });
        }
        Ok(all)
    }

    /// The options of jobs that draw it under scattered lights only.
    pub(crate) fn options(&self, Size { width, height }: Size, seed: u64) -> Vec<String> {
        let (scale, size) = (self.scale.to_string(), format!("{width}x{height}"));
        let scene = ["--scene", &self.scene, "--scene-scale", &scale, "--size", &size];
        let lit = ["--seed", &seed.to_string(), "--no-own-lights"];
        scene.into_iter().chain(lit).map(str::to_owned).collect()
    }

    /// The boxes of its core and of all that is in it, metres in world space, and where that begins in the
    /// coordinates that options take.
    pub(crate) fn boxes(&self, bench: &mut Bench) -> Result<([Aabb; 2], DVec3), HarnessError> {
        let scale = self.scale.to_string();
        let words = ["lightbench", "compare", "--scene", &self.scene, "--scene-scale", &scale];
        let words = [&words[..], &["--size", "16x9", "--lights", "1"]].concat();
        let Invocation::Compare(args) = cli::parse(words)? else {
            return Ok(([Aabb::EMPTY; 2], DVec3::ZERO));
        };
        let scene = &bench.stage(&args.stage)?.scene;
        Ok(([scene.core_bounds, scene.bounds], scene.origin))
    }
}
