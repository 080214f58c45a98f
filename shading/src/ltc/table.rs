//! The table of fitted lobes.
//!
//! It is indexed by x = perceptual roughness and y = sqrt(1 - cos view), both 0 to 1. The centre of
//! the first texel lies on 0 and that of the last one on 1. Between centres the look-up is
//! bilinear.
//!
//! It stores M^-1, not M, because interpolated M^-1 is more precise. The error is the median error
//! of the share of a square, about as large as the lobe, that the lobe covers:
//!
//! | roughness | view | error with M^-1 | with M |
//! |---|---|---|---|
//! | 0.05 to 0.16 | near the normal | 0.9 % | 2.7 % |
//! | 0.05 to 0.16 | midway | 1.4 % | 2.9 % |
//! | 0.16 to 0.48 | near the normal | 0.14 % | 0.22 % |
//! | 0.16 to 0.48 | most grazing | 1.8 % | 1.0 % |

use glam::DMat3;
use rayon::prelude::*;

use super::{
    fit::{Fit, fit_masked},
    lobe::Masking,
    polygon::share_above_horizon,
};
use crate::ShadingError;

const MAGIC: [u8; 4] = *b"LTCT";
const VERSION: u32 = 1;
const HEADER_BYTES: usize = 12;
/// The least and the most texels on each side.
const SIZES: (usize, usize) = (2, 1024);
/// Texels each way of the committed table.
pub const TABLE_SIZE: usize = 64;

/// The table's values for a roughness and a view.
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Entry {
    /// a, b, c, d of `M^-1 = [[a, 0, b], [0, 1, 0], [c, 0, d]]` in rows, divided by its middle
    /// element.
    pub inverse: [f32; 4],
    /// A, the integral of D V cos; B, that of D V cos (1 - v.h)^5; 0; 0.
    pub integrals: [f32; 4],
}

impl Entry {
    pub(super) fn new(fit: &Fit) -> Self {
        let inverse = fit.matrix.inverse();
        let scaled =
            |column: usize, row: usize| (inverse.col(column)[row] / inverse.y_axis.y) as f32;
        Self {
            inverse: [scaled(0, 0), scaled(2, 0), scaled(0, 2), scaled(2, 2)],
            integrals: [fit.albedo as f32, fit.fresnel as f32, 0.0, 0.0],
        }
    }

    /// M^-1, for [`ltc_integral`](super::ltc_integral).
    pub fn inverse(&self) -> DMat3 {
        let [a, b, c, d] = self.inverse.map(f64::from);
        DMat3::from_cols_array(&[a, 0.0, c, 0.0, 1.0, 0.0, b, 0.0, d])
    }

    /// The factor from the share of the lobe that a polygon covers to the radiance reflected, for a
    /// reflectance at normal incidence: `(f0 * (A - B) + B) / share`, with the lobe's share above
    /// the horizon.
    pub fn specular_albedo(&self, f0: f64) -> f64 {
        let [a, b, ..] = self.integrals.map(f64::from);
        (f0 * (a - b) + b) / self.share_above_horizon()
    }

    /// The lobe's share above the surface's horizon, 1/2 to 1.
    pub fn share_above_horizon(&self) -> f64 {
        share_above_horizon(&self.inverse())
    }

    fn zip(self, other: Self, f: impl Fn(f32, f32) -> f32) -> Self {
        let each = |a: [f32; 4], b: [f32; 4]| std::array::from_fn(|i| f(a[i], b[i]));
        Self {
            inverse: each(self.inverse, other.inverse),
            integrals: each(self.integrals, other.integrals),
        }
    }
}

/// Fitted lobes for all roughnesses and views.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    size: usize,
    /// Row-major over y, x fastest.
    entries: Vec<Entry>,
}

impl Table {
    /// The table of GGX with height-correlated Smith, 64 x 64.
    ///
    /// # Errors
    ///
    /// Those of [`Self::from_bytes`], if the committed file is not valid.
    pub fn ggx() -> Result<Self, ShadingError> {
        Self::load(Masking::Correlated)
    }

    /// The table of GGX with the given masking, 64 x 64.
    ///
    /// # Errors
    ///
    /// Those of [`Self::from_bytes`], if the committed file is not valid.
    pub fn load(masking: Masking) -> Result<Self, ShadingError> {
        Self::from_bytes(match masking {
            Masking::Correlated => include_bytes!("ggx.bin"),
            Masking::Hammon => include_bytes!("ggx_hammon.bin"),
        })
    }

    /// Fits a table of `size` texels on each side, 2 to 1,024, to GGX with the given masking. Calls
    /// `progress` with the number of entries done after every row of roughness, from several
    /// threads.
    ///
    /// # Errors
    ///
    /// [`ShadingError::LtcTable`] for any other size.
    pub fn fit(
        masking: Masking,
        size: usize,
        progress: impl Fn(usize) + Sync,
    ) -> Result<Self, ShadingError> {
        let fit = |roughness, cos_view, start| fit_masked(masking, roughness, cos_view, start);
        check_size(size)?;
        // First along the row where the view is the normal, from rough to smooth. Then, for each
        // roughness separately, from there to grazing views. Every search starts at its neighbour's
        // result.
        let mut upright = Vec::with_capacity(size);
        for x in (0..size).rev() {
            let start = upright.last().map(|fit: &Fit| fit.parameters);
            upright.push(fit(at(x, size), 1.0, start));
        }
        upright.reverse();
        let columns: Vec<Vec<Entry>> = upright
            .par_iter()
            .enumerate()
            .map(|(x, upright)| {
                let mut last = *upright;
                let mut column = vec![Entry::new(upright)];
                for y in 1..size {
                    last = fit(at(x, size), cos_view(at(y, size)), Some(last.parameters));
                    column.push(Entry::new(&last));
                }
                progress(size);
                column
            })
            .collect();
        let entries = (0..size * size).map(|ix| columns[ix % size][ix / size]).collect();
        Ok(Self { size, entries })
    }

    /// Reads the bytes that [`Self::to_bytes`] writes.
    ///
    /// # Errors
    ///
    /// [`ShadingError::LtcTable`] if bytes are missing, too many, or not those of a table.
    pub fn from_bytes(bytes: &[u8]) -> Result<Self, ShadingError> {
        let word = |at: usize| -> Result<[u8; 4], ShadingError> {
            let word = bytes.get(at..at + 4).and_then(|word| word.try_into().ok());
            word.ok_or_else(|| refused("length", bytes.len(), "a header and all entries, in bytes"))
        };
        let magic = word(0)?;
        if magic != MAGIC {
            return Err(refused("magic", magic.escape_ascii(), "LTCT"));
        }
        let version = u32::from_le_bytes(word(4)?);
        if version != VERSION {
            return Err(refused("version", version, VERSION));
        }
        let size = u32::from_le_bytes(word(8)?) as usize;
        check_size(size)?;
        let expected = HEADER_BYTES + size * size * size_of::<Entry>();
        if bytes.len() != expected {
            return Err(refused("length", bytes.len(), format!("{expected} bytes")));
        }
        let floats: Vec<f32> = bytes[HEADER_BYTES..]
            .chunks_exact(4)
            .map(|word| f32::from_le_bytes([word[0], word[1], word[2], word[3]]))
            .collect();
        if let Some(value) = floats.iter().find(|value| !value.is_finite()) {
            return Err(refused("entry", value, "finite"));
        }
        Ok(Self { size, entries: bytemuck::cast_slice(&floats).to_vec() })
    }

    /// The table as a file: magic, version and size, then its entries, all little-endian.
    pub fn to_bytes(&self) -> Vec<u8> {
        let mut bytes = MAGIC.to_vec();
        bytes.extend(VERSION.to_le_bytes());
        bytes.extend((self.size as u32).to_le_bytes());
        let floats: &[f32] = bytemuck::cast_slice(&self.entries);
        bytes.extend(floats.iter().flat_map(|value| value.to_le_bytes()));
        bytes
    }

    /// The entries for upload as `array<vec4f>`, two vectors per entry, row-major over y, x
    /// fastest.
    pub fn as_bytes(&self) -> &[u8] {
        bytemuck::cast_slice(&self.entries)
    }

    /// Texels each way.
    pub fn size(&self) -> usize {
        self.size
    }

    /// The entries with their x and y, in order.
    pub fn entries(&self) -> impl Iterator<Item = (f64, f64, &Entry)> {
        let at = |ix| at(ix, self.size);
        let place = move |(ix, entry)| (at(ix % self.size), at(ix / self.size), entry);
        self.entries.iter().enumerate().map(place)
    }

    /// The entry of a perceptual roughness and a cosine of the view, each clamped to 0..1.
    pub fn look_up(&self, roughness: f64, cos_view: f64) -> Entry {
        let last = self.size - 1;
        let place = |at: f64| {
            let at = unit(at) * last as f64;
            let texel = (at as usize).min(last - 1);
            (texel, (at - texel as f64) as f32)
        };
        let ((x, share_x), (y, share_y)) = (place(roughness), place(y_of(cos_view)));
        let mix = |a: Entry, b: Entry, share: f32| a.zip(b, |a, b| a + share * (b - a));
        let row = |y: usize| {
            let first = y * self.size + x;
            mix(self.entries[first], self.entries[first + 1], share_x)
        };
        mix(row(y), row(y + 1), share_y)
    }
}

/// The coordinate of a texel's centre.
fn at(texel: usize, size: usize) -> f64 {
    texel as f64 / (size - 1) as f64
}

/// The cosine of the view for a y.
pub(super) fn cos_view(y: f64) -> f64 {
    1.0 - y * y
}

/// The y for a cosine of the view, clamped to 0..1.
pub(super) fn y_of(cos_view: f64) -> f64 {
    (1.0 - unit(cos_view)).sqrt()
}

/// A value clamped to 0..1. NaN counts as 0.
pub(super) fn unit(value: f64) -> f64 {
    if value > 0.0 { value.min(1.0) } else { 0.0 }
}

fn check_size(size: usize) -> Result<(), ShadingError> {
    let (least, most) = SIZES;
    let accepted = format!("{least} to {most} texels on each side");
    if (least..=most).contains(&size) { Ok(()) } else { Err(refused("size", size, accepted)) }
}

fn refused(
    field: &'static str,
    value: impl std::fmt::Display,
    accepted: impl std::fmt::Display,
) -> ShadingError {
    let (value, accepted) = (value.to_string(), accepted.to_string());
    ShadingError::LtcTable { field, value, accepted }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_read_as_it_was_written() {
        let table = Table::ggx().unwrap();
        assert_eq!(table.size(), TABLE_SIZE);
        assert_eq!(table.to_bytes(), include_bytes!("ggx.bin"));
        assert_eq!(table.as_bytes().len(), TABLE_SIZE * TABLE_SIZE * 32);
    }

    #[test]
    fn an_invalid_file_is_refused() {
        let good = Table::fit(Masking::Correlated, 2, |_| ()).unwrap().to_bytes();
        let with = |at: usize, bytes: &[u8]| {
            let mut file = good.clone();
            file[at..at + bytes.len()].copy_from_slice(bytes);
            file
        };
        for (file, refusal) in [
            (with(0, b"DDS "), "magic is DDS : it must be LTCT"),
            (with(4, &[2]), "version is 2: it must be 1"),
            (with(8, &[0]), "size is 0: it must be 2 to 1024 texels on each side"),
            (with(8, &[255; 4]), "size is 4294967295: it must be 2 to 1024 texels on each side"),
            (with(8, &[3]), "length is 140: it must be 300 bytes"),
            (with(12, &[255; 4]), "entry is NaN: it must be finite"),
            (good[..11].to_vec(), "length is 11: it must be a header and all entries, in bytes"),
            (good[..139].to_vec(), "length is 139: it must be 140 bytes"),
        ] {
            let error = Table::from_bytes(&file).unwrap_err().to_string();
            assert_eq!(error, format!("LTC table: {refusal}"));
        }
        assert!(Table::from_bytes(&good).is_ok());
    }

    #[test]
    fn between_texels_the_look_up_is_bilinear() {
        let table = Table::ggx().unwrap();
        let last = (TABLE_SIZE - 1) as f64;
        for (x, y, entry) in table.entries() {
            let found = table.look_up(x, cos_view(y));
            // Converting to the cosine and back costs some digits.
            let near = |a: &f32, b: &f32| (a - b).abs() <= 1e-5;
            assert!(found.inverse.iter().zip(&entry.inverse).all(|(a, b)| near(a, b)), "{x}, {y}");
        }
        let at = |x: f64, y: f64| table.look_up(x / last, cos_view(y / last)).inverse[3];
        let mean = 0.25 * (at(30.0, 40.0) + at(31.0, 40.0) + at(30.0, 41.0) + at(31.0, 41.0));
        assert!((at(30.5, 40.5) - mean).abs() < 1e-6);
        // Outside the table, the edge counts.
        assert_eq!(table.look_up(-1.0, 2.0), table.look_up(0.0, 1.0));
        assert_eq!(table.look_up(9.0, -1.0), table.look_up(1.0, 0.0));
        assert_eq!(table.look_up(f64::NAN, 1.0), table.look_up(0.0, 1.0));
    }
}
