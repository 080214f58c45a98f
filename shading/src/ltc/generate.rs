//! Generates the committed files: the table, and its polynomials in Rust and WESL.

use std::{fs, path::Path};

use glam::{DMat3, DVec3};

use super::{
    accuracy::{ACCURACY_DEGREES, Accuracy, accuracy_cases},
    lobe::Masking,
    polygon::ltc_integral,
    polynomial::Polynomial,
    table::{Entry, Table, cos_view},
};
use crate::ShadingError;

/// The number of rectangles for the medians, and their seed.
const CASES: usize = 1500;
const SEED: u64 = 1;

/// The accuracy of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitReport {
    /// Errors of the table against the BRDF.
    pub table: Accuracy,
    /// Errors of the table of GGX with Hammon's masking, against the same BRDF.
    pub hammon: Accuracy,
    /// Errors of the polynomials against the BRDF.
    pub polynomial: Accuracy,
    /// Root mean square errors of the polynomials against the table, in the order of
    /// [`POLYNOMIAL_COMPONENTS`](super::POLYNOMIAL_COMPONENTS).
    pub rms_errors: [f64; 6],
    /// Difference between the table and the committed one, at the latter's places.
    pub difference: TableDifference,
}

/// The greatest difference between two tables.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TableDifference {
    /// The greatest difference of A and B.
    pub integrals: f64,
    /// The greatest difference of the share of a lobe that a polygon of about its size covers.
    pub covered: f64,
}

/// Fits tables of `size` texels on each side for both maskings, and polynomials for the first. Writes
/// `ggx.bin`, `ggx_hammon.bin`, `polynomial_coefficients.rs` and `ltc_polynomial.wesl` to a folder,
/// if one is given. Calls `progress` with the number of entries just done, of `2 * size * size`,
/// from several threads.
///
/// # Errors
///
/// [`ShadingError::LtcTable`] for a size that is not accepted, [`ShadingError::Write`] if a file
/// cannot be written.
pub fn generate(
    out_dir: Option<&Path>,
    size: usize,
    progress: impl Fn(usize) + Sync,
) -> Result<FitReport, ShadingError> {
    if let Some(dir) = out_dir {
        write(dir, |dir| fs::create_dir_all(dir))?;
    }
    let table = Table::fit(Masking::Correlated, size, &progress)?;
    let hammon = Table::fit(Masking::Hammon, size, &progress)?;
    let polynomial = Polynomial::fit(&table);
    if let Some(dir) = out_dir {
        write(&dir.join("ggx.bin"), |path| fs::write(path, table.to_bytes()))?;
        write(&dir.join("ggx_hammon.bin"), |path| fs::write(path, hammon.to_bytes()))?;
        write(&dir.join("polynomial_coefficients.rs"), |path| {
            fs::write(path, polynomial.to_rust())
        })?;
        write(&dir.join("ltc_polynomial.wesl"), |path| fs::write(path, polynomial.to_wesl()))?;
    }
    let cases = accuracy_cases(CASES, SEED, ACCURACY_DEGREES);
    Ok(FitReport {
        table: Accuracy::measure(&cases, |roughness, cos| table.look_up(roughness, cos)),
        hammon: Accuracy::measure(&cases, |roughness, cos| hammon.look_up(roughness, cos)),
        polynomial: Accuracy::measure(&cases, |roughness, cos| polynomial.entry(roughness, cos)),
        rms_errors: polynomial.rms_errors(&table),
        difference: Table::ggx()?.difference(&table),
    })
}

fn write(path: &Path, write: impl Fn(&Path) -> std::io::Result<()>) -> Result<(), ShadingError> {
    write(path).map_err(|error| {
        let reason = error.to_string();
        ShadingError::Write { path: path.to_owned(), reason }
    })
}

impl Table {
    /// The greatest differences to another table, at this table's places.
    pub fn difference(&self, other: &Self) -> TableDifference {
        let differences =
            self.entries().map(|(x, y, entry)| entry.difference(&other.look_up(x, cos_view(y))));
        differences.fold(TableDifference::default(), |largest, next| TableDifference {
            integrals: largest.integrals.max(next.integrals),
            covered: largest.covered.max(next.covered),
        })
    }
}

impl Entry {
    /// The difference to another entry. Elements of the inverse are not compared one by one,
    /// because different ones give the same lobe at grazing views.
    pub fn difference(&self, other: &Self) -> TableDifference {
        let pairs = self.integrals.iter().zip(other.integrals);
        let integrals = pairs.map(|(a, b)| f64::from((a - b).abs())).fold(0.0, f64::max);
        let lobe: DMat3 = self.inverse().inverse();
        // Adjacent squares in the cosine's own space, moved to where this lobe has them.
        let covered = [[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0]].map(|[x, y]| {
            let corner = |i: f64, j: f64| lobe * DVec3::new(x + i, y + j, 1.0);
            let square =
                [corner(-0.5, -0.5), corner(0.5, -0.5), corner(0.5, 0.5), corner(-0.5, 0.5)];
            (ltc_integral(&self.inverse(), &square) - ltc_integral(&other.inverse(), &square)).abs()
        });
        TableDifference { integrals, covered: covered.into_iter().fold(0.0, f64::max) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_small_fit_is_written_and_read() {
        let folder = tempfile::tempdir().unwrap();
        let dir = folder.path().join("new");
        let entries = std::sync::atomic::AtomicUsize::new(0);
        let count = |done| {
            entries.fetch_add(done, std::sync::atomic::Ordering::Relaxed);
        };
        let report = generate(Some(&dir), 8, count).unwrap();
        assert_eq!(entries.into_inner(), 2 * 64);
        let table = Table::from_bytes(&fs::read(dir.join("ggx.bin")).unwrap()).unwrap();
        assert_eq!(table.size(), 8);
        let hammon = Table::from_bytes(&fs::read(dir.join("ggx_hammon.bin")).unwrap()).unwrap();
        assert!(hammon.difference(&table).integrals > 1e-3, "both maskings give one table");
        let polynomial = Polynomial::fit(&table);
        let text = |name| fs::read_to_string(dir.join(name)).unwrap();
        assert_eq!(text("polynomial_coefficients.rs"), polynomial.to_rust());
        assert_eq!(text("ltc_polynomial.wesl"), polynomial.to_wesl());
        // It is coarser than the committed table.
        let TableDifference { integrals, covered } = report.difference;
        assert!(report.table.median > 0.04 && integrals > 0.01 && covered > 0.01, "{report:?}");
    }

    #[test]
    fn sizes_and_folders_that_fail_are_named() {
        let refusal = generate(None, 1, |_| ()).unwrap_err().to_string();
        assert_eq!(refusal, "LTC table: size is 1: it must be 2 to 1024 texels on each side");
        let file = tempfile::NamedTempFile::new().unwrap();
        let refusal = generate(Some(file.path()), 2, |_| ()).unwrap_err();
        assert!(matches!(refusal, ShadingError::Write { .. }), "{refusal}");
    }
}
