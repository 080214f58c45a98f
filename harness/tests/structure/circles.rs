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
    /// Reads every Rust file below `src`: a crate for each of `lib.rs` and `main.rs` that is there, with all
    /// other files in both.
    pub(crate) fn read(src: &FilePath) -> io::Result<Vec<Self>> {
        let roots = ["lib.rs", "main.rs"].map(|name| src.join(name));
        let mut crates = Vec::new();
        for root in roots.iter().filter(|root| root.is_file()) {
            let mut files = vec![(Path::new(), fs::read_to_string(root)?)];
            collect_files(src, &[], &mut files)?;
            crates.push(Self::from_files(&files));
        }
        Ok(crates)
    }

    /// Reads sources, each with the path of its module.
    ///
    /// # Panics
    ///
    /// Where two sources have the same path.
    pub(crate) fn from_files(files: &[(Path, String)]) -> Self {
        let mut modules = BTreeMap::new();
        for (path, source) in files {
            let is_child = |other: &&Path| other.len() == path.len() + 1 && other.starts_with(path);
            let others = files.iter().map(|(other, _)| other);
            let children: Vec<String> =
                others.filter(is_child).filter_map(|c| c.last().cloned()).collect();
            let known = modules.insert(path.clone(), read_module(path, &children, source));
            assert!(known.is_none(), "two files are the module {path:?}");
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
                let defines = |glob: &&Path| **glob != inside && self.offers(glob, name, steps - 1);
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

    /// Whether a module defines or imports a name, or gets it through a glob.
    fn offers(&self, module: &[String], name: &str, steps: usize) -> bool {
        self.modules.get(module).is_some_and(|module| {
            module.items.contains(name)
                || module.imports.contains_key(name)
                || (steps > 0 && module.globs.iter().any(|glob| self.offers(glob, name, steps - 1)))
        })
    }

    /// The paths that a module names, those behind the names that a glob gives it included.
    fn named(&self, module: &Module) -> Vec<Path> {
        let mut named = module.named.clone();
        for glob in &module.globs {
            let is_foreign = |word: &&String| {
                !module.items.contains(*word) && !module.imports.contains_key(*word)
            };
            let offered = |word: &&String| self.offers(glob, word, MAX_STEPS);
            let words = module.words.iter().filter(is_foreign).filter(offered);
            named.extend(words.map(|word| child_of(glob, word)));
        }
        named
    }

    /// Every use of one module by another.
    pub(crate) fn edges(&self) -> BTreeSet<Edge> {
        let mut edges = BTreeSet::new();
        for (from, module) in &self.modules {
            for path in self.named(module) {
                let to = self.definition(&path, MAX_STEPS);
                if *from != to {
                    edges.insert(Edge { from: from.clone(), to });
                }
            }
        }
        edges
    }

    /// The edges that lie on a circle.
    pub(crate) fn edges_of_circles(&self) -> BTreeSet<Edge> {
        let edges = self.edges();
        let mut found = BTreeSet::new();
        collect_circles(&edges.iter().collect(), &mut found);
        found
    }
}

/// Adds the edges of every circle. A circle whose modules all lie below one of them is that module and its
/// parts: without that module, the parts must have no circle.
fn collect_circles(edges: &BTreeSet<&Edge>, found: &mut BTreeSet<Edge>) {
    for circle in circles(edges) {
        let inside = |edge: &&&Edge| circle.contains(&edge.from) && circle.contains(&edge.to);
        let within: BTreeSet<&Edge> = edges.iter().filter(inside).copied().collect();
        let is_top = |module: &&&Path| circle.iter().all(|other| other.starts_with(module));
        match circle.iter().find(is_top) {
            None => found.extend(within.into_iter().cloned()),
            Some(top) => {
                let is_below = |edge: &&Edge| edge.from != **top && edge.to != **top;
                collect_circles(&within.into_iter().filter(is_below).collect(), found);
            }
        }
    }
}

/// The sets of modules each of which reaches all others of its set.
fn circles<'a>(edges: &BTreeSet<&'a Edge>) -> BTreeSet<BTreeSet<&'a Path>> {
    let mut used: BTreeMap<&Path, Vec<&Path>> = BTreeMap::new();
    for Edge { from, to } in edges.iter().copied() {
        used.entry(from).or_default().push(to);
    }
    let reached: BTreeMap<&Path, BTreeSet<&Path>> =
        used.keys().map(|from| (*from, reachable(&used, from))).collect();
    let reaches = |from: &Path, to: &Path| reached.get(from).is_some_and(|all| all.contains(to));
    let circle_of = |module: &&'a Path| -> BTreeSet<&'a Path> {
        let is_with = |other: &&&'a Path| reaches(module, other) && reaches(other, module);
        reached.keys().filter(is_with).copied().collect()
    };
    reached.keys().map(circle_of).filter(|circle| circle.len() > 1).collect()
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

/// Collects paths and sources of the modules below a folder, except the root.
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
            let is_root = path.is_empty() && matches!(stem, "lib" | "main");
            if !is_root {
                let path = if stem == "mod" { path.to_vec() } else { child };
                files.push((path, fs::read_to_string(&file)?));
            }
        }
    }
    Ok(())
}
