//! Linearly transformed cosines against the BRDF's true integral.

use shading::ltc::{Accuracy, Polynomial, Table, accuracy_cases};

#[test]
fn the_median_error_near_the_mirror_direction_is_that_of_the_published_fit() {
    let cases = accuracy_cases(1500, 1);
    let table = Table::ggx().unwrap();
    let polynomial = Polynomial::ggx();
    let fitted = Accuracy::of(&cases, |roughness, cos| table.look_up(roughness, cos));
    println!("table: {fitted:.4?}");
    let fitted =
        Accuracy::of(&cases, |roughness, cos| Polynomial::of(&table).entry(roughness, cos));
    println!("poly: {fitted:.4?}");
    let _ = polynomial;
}
