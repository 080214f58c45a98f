//! Fuzzes the importer with damaged glTF files of every kind. Each file is read or refused, without
//! a panic, within limits of time and memory.
//!
//! Inputs come from seeds: small files made here, or those of a folder. They are changed in places
//! that a reader uses: values, keys and branches of the JSON, numbers in buffers, headers of
//! images, chunks of a GLB, and parts beside the file. Input `n` depends only on `n` and the seed,
//! so every input can be made again. Environment variables set how much is run:
//! | variable | what | without it |
//! | variable | meaning | default |
//! | `LIGHTBENCH_FUZZ_INPUTS` | number of inputs | 300 |
//! | `LIGHTBENCH_FUZZ_FIRST` | index of the first input | 0 |
//! | `LIGHTBENCH_FUZZ_SEED` | another series of inputs | 1 |
//! | `LIGHTBENCH_FUZZ_FILES` | a folder whose `.gltf` and `.glb` files are seeds too | none |
//!
//! A long run: `LIGHTBENCH_FUZZ_INPUTS=10000 cargo test -p scenes --release --test fuzz -- --nocapture`.
//! The present input lies in `fuzz-PROCESS/` in cargo's folder for test files. It stays there after
//! a failure or an abort.

#[path = "../made_up/mod.rs"]
mod made_up;
mod mutate;
mod odd;
mod seeds;
mod watch;

use std::{
    env, fs,
    path::{Path, PathBuf},
    time::{Duration, Instant},
};

use rand::SeedableRng;
use rand_pcg::Pcg64Mcg;
use scenes::{SceneError, load_gltf};

/// The longest time that an input may take.
const MOST_TIME: Duration = Duration::from_secs(10);

/// The most memory that the process may use for an input, bytes.
const MOST_BYTES: u64 = 4_000_000_000;

/// The figures of a run.
#[derive(Default)]
struct Figures {
    loaded: u32,
    refused: u32,
    longest: (Duration, u64),
    peak: (u64, u64),
}

fn number(variable: &str, default: u64) -> u64 {
    let Ok(text) = env::var(variable) else { return default };
    text.parse().unwrap_or_else(|_| panic!("{variable} is {text:?}: it must be a number"))
}

#[test]
fn damaged_files_are_read_or_refused() {
    let inputs = number("LIGHTBENCH_FUZZ_INPUTS", 300);
    let first = number("LIGHTBENCH_FUZZ_FIRST", 0);
    let seed = number("LIGHTBENCH_FUZZ_SEED", 1);
    let files = env::var_os("LIGHTBENCH_FUZZ_FILES").map(PathBuf::from);
    let seeds = seeds::all(files.as_deref());
    let folder = format!("fuzz-{}", std::process::id());
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join(folder);
    let mut figures = Figures::default();
    for n in first..first + inputs {
        let mut rng = Pcg64Mcg::seed_from_u64(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ n);
        let input = mutate::input(&seeds, &mut rng);
        let _ = fs::remove_dir_all(&folder);
        fs::create_dir_all(&folder).expect("a folder for the input");
        let path = input.write(&folder);
        run(n, path, &mut figures);
    }
    let _ = fs::remove_dir_all(&folder);
    let seconds = figures.longest.0.as_secs_f64();
    println!(
        "{inputs} inputs: {} read, {} refused; longest {seconds:.2} s (input {}), peak {:.0} MB (input {})",
        figures.loaded,
        figures.refused,
        figures.longest.1,
        figures.peak.0 as f64 / 1e6,
        figures.peak.1,
    );
    // Damage is light enough that files are read past the header, and deep enough that it is
    // noticed.
    let least = inputs.min(300) as u32 / 10;
    assert!(figures.loaded >= least && figures.refused >= least);
}

/// A seed that is refused undamaged would test nothing.
#[test]
fn seeds_are_read_as_they_are() {
    for (ix, seed) in seeds::all(None).iter().enumerate() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        fs::write(folder.path().join("part.png"), made_up::png()).expect("writes");
        let scene = made_up::load_file(&folder.path().join("seed.glb"), &seed.glb());
        assert!(scene.is_ok(), "seed {ix}: {:?}", scene.map(|s| s.name));
    }
}

fn run(n: u64, path: PathBuf, figures: &mut Figures) {
    watch::forget_peak();
    let start = Instant::now();
    let shown = path.display().to_string();
    let outcome = watch::within(MOST_TIME, move || look_at(&path));
    let took = start.elapsed();
    let peak = watch::peak_bytes();
    match outcome {
        Ok(true) => figures.loaded += 1,
        Ok(false) => figures.refused += 1,
        Err(fault) => panic!("input {n} ({shown}): {fault}"),
    }
    assert!(peak < MOST_BYTES, "input {n} ({shown}): {peak} bytes");
    figures.longest = figures.longest.max((took, n));
    figures.peak = figures.peak.max((peak, n));
}

/// Whether the file is read. The scene and its warnings must be sound in any case.
fn look_at(path: &Path) -> bool {
    let scene = match load_gltf(path) {
        Ok(scene) => scene,
        Err(error) => {
            is_sound_line(&error.to_string(), 3000);
            let names_file = error.to_string().contains("input.gl");
            assert!(names_file || matches!(error, SceneError::OutOfRange { .. }), "{error}");
            return false;
        }
    };
    assert!(scene.triangle_count() > 0 && !scene.bounds.is_empty());
    assert!(scene.warnings.len() < 1000, "{} warnings", scene.warnings.len());
    for warning in &scene.warnings {
        is_sound_line(warning, 600);
    }
    for mesh in &scene.meshes {
        let count = mesh.vertices.len();
        assert!(mesh.indices.iter().all(|ix| (*ix as usize) < count), "{mesh:?}");
        assert!((mesh.material as usize) < scene.materials.len(), "{mesh:?}");
        let finite = |v: &scenes::Vertex| {
            let all = [&v.position[..], &v.normal, &v.tangent, &v.uv];
            all.iter().all(|values| values.iter().all(|x| x.is_finite()))
        };
        assert!(mesh.vertices.iter().all(finite), "{mesh:?}");
    }
    for texture in scene.materials.iter().flat_map(|m| m.textures()).flatten() {
        assert!((texture.image as usize) < scene.images.len());
    }
    let frames = 16;
    for pose in (0..frames).map(|frame| scene.path.pose(frame, frames)) {
        assert!(pose.eye.is_finite() && pose.forward().is_finite(), "{pose:?}");
    }
    let middle = scene.world_triangles().flatten().all(glam::Vec3::is_finite);
    assert!(middle, "a corner is not finite");
    assert_eq!(scene.hash().len(), 64);
    true
}

fn is_sound_line(line: &str, most: usize) {
    let odd = |c: char| c.is_control() || ('\u{202a}'..='\u{202e}').contains(&c);
    assert!(!line.contains(odd), "{line:?}");
    assert!(line.chars().count() < most, "{} characters: {line:.300}", line.len());
}
