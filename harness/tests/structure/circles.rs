//! Builds the graph of a crate's modules, and finds circles in it.

use std::{
    collections::{BTreeMap, BTreeSet},
    fmt, fs, io,
    path::Path as FilePath,
};

use crate::module::{Module, Path, read_module};

/// One module uses another.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Edge {
    /// The module that imports.
    pub(crate) from: Path,
    /// The module that it imports from.
    pub(crate) to: Path,
}

impl fmt::Display for Edge {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} -> {}", self.from.join("::"), self.to.join("::"))
    }
}

/// How many re-exports are followed from one name.
const MAX_STEPS: usize = 16;

/// The modules of one crate, keyed by their paths.
#[derive(Debug, Default)]
pub(crate) struct Crate {
    modules: BTreeMap<Path, Module>,
}

impl Crate {
    /// Reads every Rust file below `src`.
    pub(crate) fn read(src: &FilePath) -> io::Result<Self> {
        let mut files = Vec::new();
        collect_files(src, &[], &mut files)?;
        Ok(Self::from_files(&files))
    }

    /// Reads sources, each with the path of its module.
    pub(crate) fn from_files(files: &[(Path, String)]) -> Self {
        let mut modules = BTreeMap::new();
        for (path, source) in files {
            let is_child = |other: &&Path| other.len() == path.len() + 1 && other.starts_with(path);
            let others = files.iter().map(|(other, _)| other);
            let children: Vec<String> =
                others.filter(is_child).filter_map(|c| c.last().cloned()).collect();
            modules.insert(path.clone(), read_module(path, &children, source));
        }
        let of_tests: Vec<Path> = modules
            .iter()
            .flat_map(|(path, module)| module.test_modules.iter().map(|name| child_of(path, name)))
            .collect();
        modules.retain(|path, _| !of_tests.iter().any(|tests| path.starts_with(tests)));
        Self { modules }
    }

    /// The module that defines what `path` names, after at most `steps` imports and re-exports.
    fn definition(&self, path: &[String], steps: usize) -> Path {
        let mut inside = Path::new();
        for (ix, name) in path.iter().enumerate() {
            let child = child_of(&inside, name);
            if self.modules.contains_key(&child) {
                inside = child;
                continue;
            }
            let followed = self.modules.get(&inside).filter(|_| steps > 0).and_then(|module| {
                if let Some(import) = module.imports.get(name) {
                    return Some(import.clone());
                }
                let defines = |glob: &&Path| {
                    **glob != inside
                        && self.modules.get(*glob).is_some_and(|m| m.items.contains(name))
                };
                let glob = module.globs.iter().find(defines)?;
                Some(child_of(glob, name))
            });
            return match followed {
                Some(import) => {
                    self.definition(&[import.as_slice(), &path[ix + 1..]].concat(), steps - 1)
                }
                None => inside,
            };
        }
        inside
    }

    /// Every use of one module by another that is neither its ancestor nor below it.
    pub(crate) fn edges(&self) -> BTreeSet<Edge> {
        let mut edges = BTreeSet::new();
        for (from, module) in &self.modules {
            for path in &module.named {
                let to = self.definition(path, MAX_STEPS);
                if !from.starts_with(&to) && !to.starts_with(from) {
                    edges.insert(Edge { from: from.clone(), to });
                }
            }
        }
        edges
    }

    /// The edges that lie on a circle.
    pub(crate) fn edges_of_circles(&self) -> BTreeSet<Edge> {
        let edges = self.edges();
        let mut used: BTreeMap<&Path, Vec<&Path>> = BTreeMap::new();
        for Edge { from, to } in &edges {
            used.entry(from).or_default().push(to);
        }
        let reached: BTreeMap<&Path, BTreeSet<&Path>> =
            used.keys().map(|from| (*from, reachable(&used, from))).collect();
        let is_on_circle =
            |edge: &&Edge| reached.get(&edge.to).is_some_and(|all| all.contains(&edge.from));
        edges.iter().filter(is_on_circle).cloned().collect()
    }
}

fn child_of(parent: &[String], name: &str) -> Path {
    [parent, &[name.to_owned()]].concat()
}

/// The modules that `start` uses, directly or through others.
fn reachable<'a>(used: &BTreeMap<&'a Path, Vec<&'a Path>>, start: &Path) -> BTreeSet<&'a Path> {
    let mut reached = BTreeSet::new();
    let mut open: Vec<&Path> = used.get(start).cloned().unwrap_or_default();
    while let Some(module) = open.pop() {
        if reached.insert(module) {
            open.extend(used.get(module).into_iter().flatten());
        }
    }
    reached
}

/// Collects paths and sources of the modules below a folder.
fn collect_files(
    folder: &FilePath,
    path: &[String],
    files: &mut Vec<(Path, String)>,
) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let file = entry?.path();
        let Some(stem) = file.file_stem().and_then(|stem| stem.to_str()) else { continue };
        let child = child_of(path, stem);
        if file.is_dir() {
            collect_files(&file, &child, files)?;
        } else if file.extension().is_some_and(|extension| extension == "rs") {
            let is_parent = matches!(stem, "lib" | "main" | "mod");
            let path = if is_parent { path.to_vec() } else { child };
            files.push((path, fs::read_to_string(&file)?));
        }
    }
    Ok(())
}
