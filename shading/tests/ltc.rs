//! Linearly transformed cosines against the BRDF's true integral, and their WESL.

#![allow(clippy::unwrap_used, reason = "a helper of a test may fail it")]

use assign::{
    Gpu, Shader,
    conformance::{Bound, download, run_kernel, upload},
    kernel::Slot,
};
use shading::ltc::{
    ACCURACY_DEGREES, Accuracy, LTC_POLYNOMIAL_WESL, Masking, Polynomial, Table, accuracy_cases,
};

/// Median errors of the table, and of the polynomials, by how far from the mirror direction rectangles
/// lie at most, degrees: METHODOLOGY has the same table.
const MEDIANS: [(f64, f64, f64); 4] = [
    (15.0, 0.0256, 0.0268),
    (20.0, 0.0319, 0.0341),
    (25.0, 0.0376, 0.0373),
    (30.0, 0.0458, 0.0436),
];

/// How far a median may be off the one that is stated.
const OFF: f64 = 0.0004;

const METHODOLOGY: &str = include_str!("../../METHODOLOGY.md");

#[test]
fn the_median_errors_are_those_that_methodology_states_for_each_angle() {
    let table = Table::ggx().unwrap();
    let polynomial = Polynomial::ggx();
    let medians = MEDIANS.map(|(degrees, ..)| {
        let cases = accuracy_cases(1500, 1, degrees);
        let fitted = Accuracy::measure(&cases, |roughness, cos| table.look_up(roughness, cos));
        let smooth = Accuracy::measure(&cases, |roughness, cos| polynomial.entry(roughness, cos));
        println!("{degrees} degrees, table: {fitted:.4?}");
        println!("{degrees} degrees, polynomials: {smooth:.4?}");
        (degrees, fitted.median, smooth.median)
    });
    for (found, stated) in medians.into_iter().zip(MEDIANS) {
        assert!((found.1 - stated.1).abs() < OFF, "table: {found:?}, stated {stated:?}");
        assert!((found.2 - stated.2).abs() < OFF, "polynomials: {found:?}, stated {stated:?}");
        let (degrees, table, polynomials) = stated;
        let row = format!("| {degrees} | {:.1} % | {:.1} % |", 100.0 * table, 100.0 * polynomials);
        assert!(METHODOLOGY.contains(&row), "METHODOLOGY lacks the row {row}");
    }
    // The angle matters more than the tolerance, so no figure stands for another angle's.
    assert!(medians.windows(2).all(|pair| pair[1].1 > pair[0].1 + 2.0 * OFF), "{medians:?}");
    assert!(MEDIANS.iter().any(|(degrees, ..)| *degrees == ACCURACY_DEGREES));
}

#[test]
fn lobes_of_a_neighbouring_roughness_or_view_are_told_from_the_fit() {
    let cases = accuracy_cases(1500, 1, ACCURACY_DEGREES);
    let table = Table::ggx().unwrap();
    let median = |roughness: f64, cos_view: f64| {
        Accuracy::measure(&cases, |r, cos| table.look_up(r + roughness, cos + cos_view)).median
    };
    let fitted = median(0.0, 0.0);
    let (rougher, turned) = (median(0.02, 0.0), median(0.0, 0.05));
    assert!(rougher > fitted + 0.003 && turned > fitted + 0.003, "{fitted} {rougher} {turned}");
}

/// The table of GGX with Hammon's masking is farther from the exact BRDF, and close to it (Dobetsberger
/// 2025, table 5.1).
#[test]
fn the_table_of_the_approximate_masking_is_another_and_farther_off() {
    let cases = accuracy_cases(1500, 1, ACCURACY_DEGREES);
    let accuracy = |masking| {
        let table = Table::load(masking).unwrap();
        Accuracy::measure(&cases, |roughness, cos| table.look_up(roughness, cos))
    };
    let (exact, hammon) = (accuracy(Masking::Correlated), accuracy(Masking::Hammon));
    println!("correlated {exact:.4?}, Hammon {hammon:.4?}");
    assert!(exact.median < hammon.median && hammon.median < 3.0 * exact.median);
}

const EVALUATE: &str = "
import package::polynomial::ltc_entry_polynomial;

@group(0) @binding(0) var<storage, read> places: array<vec2f>;
@group(0) @binding(1) var<storage, read_write> entries: array<array<vec4f, 2>>;

@compute @workgroup_size(64)
fn evaluate(@builtin(global_invocation_id) id: vec3u) {
  if id.x < arrayLength(&places) {
    entries[id.x] = ltc_entry_polynomial(places[id.x].x, places[id.x].y);
  }
}
";

/// What the WESL module gives for each pair of roughness and y.
fn on_the_gpu(places: &[[f32; 2]]) -> Vec<[[f32; 4]; 2]> {
    let gpu = Gpu::open(None).expect("an adapter: scripts/test installs the software one");
    let module = Shader::new(1)
        .module("package::polynomial", LTC_POLYNOMIAL_WESL)
        .module("package::evaluate", EVALUATE)
        .create(&gpu, "package::evaluate")
        .unwrap();
    let inputs = upload(&gpu, "places", places).unwrap();
    let outputs = upload(&gpu, "entries", &vec![[[0.0_f32; 4]; 2]; places.len()]).unwrap();
    let groups = [Bound::Buffers(&[(0, Slot::Read, &inputs), (1, Slot::Write, &outputs)])];
    run_kernel(&gpu, &module, "evaluate", &groups, (places.len() as u32).div_ceil(64));
    download(&gpu, &outputs, places.len()).unwrap()
}

#[test]
fn the_polynomials_wesl_is_their_rust() {
    let at = |step: u32| step as f32 / 30.0;
    let places: Vec<_> = (0..31 * 31).map(|ix| [at(ix % 31), at(ix / 31)]).collect();
    let polynomial = Polynomial::ggx();
    for ([x, y], found) in places.iter().zip(on_the_gpu(&places)) {
        let expected = polynomial.entry(f64::from(*x), 1.0 - f64::from(y * y));
        let pairs = found.concat().into_iter().zip([expected.inverse, expected.integrals].concat());
        let off = pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(off < 1e-4, "{x}, {y}: {found:?}, {expected:?}");
    }
}
