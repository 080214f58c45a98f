//! Reads images. Headers tell the number of pixels before anything is decoded; decoding runs in
//! parallel. Each image gets one entry per encoding in use. Entries of the file that name the same
//! bytes share one image.

use std::{
    borrow::Cow,
    collections::{HashMap, HashSet},
    io::Cursor,
};

use image::{ImageFormat, ImageReader, Limits};
use rayon::prelude::*;

use super::{file::File, limits, warnings::kept_name};
use crate::{Encoding, Image, SceneError};

/// The longest side that is accepted, pixels. GPUs offer as much.
const MAX_SIDE: u32 = 16_384;

/// How much a decoder may allocate beside its pixels, bytes.
const DECODER_BYTES: u64 = 64 << 20;

/// The images in use, numbered in order of first use.
pub(super) struct ImageTable {
    /// For each image of the file, the first image that names the same bytes.
    firsts: Vec<usize>,
    numbers: HashMap<(usize, Encoding), u32>,
    uses: Vec<(usize, Encoding)>,
    /// The file's own entries in use, those that share their bytes included.
    entries: HashSet<(usize, Encoding)>,
}

/// An image of the file, still encoded.
struct Source<'a> {
    /// Its name in errors.
    label: String,
    bytes: Cow<'a, [u8]>,
    size: [u32; 2],
}

impl ImageTable {
    /// Starts with no image in use.
    pub(super) fn new(file: &File) -> Self {
        let mut first_of = HashMap::new();
        let images = file.root.images.iter().enumerate();
        let firsts = images.map(|(ix, image)| {
            // Buffer views of equal start and length are the same.
            let view = image.buffer_view.and_then(|view| file.root.get(view));
            let place =
                view.map(|v| (v.buffer.value(), v.byte_offset.map_or(0, |o| o.0), v.byte_length.0));
            match (&image.uri, place) {
                (None, None) => ix,
                (uri, place) => *first_of.entry((uri, place)).or_insert(ix),
            }
        });
        Self {
            firsts: firsts.collect(),
            numbers: HashMap::new(),
            uses: Vec::new(),
            entries: HashSet::new(),
        }
    }

    /// The number of the file's image `ix` in that encoding.
    pub(super) fn number(&mut self, ix: usize, encoding: Encoding) -> u32 {
        self.entries.insert((ix, encoding));
        let first = self.first(ix);
        *self.numbers.entry((first, encoding)).or_insert_with(|| {
            self.uses.push((first, encoding));
            self.uses.len() as u32 - 1
        })
    }

    fn first(&self, ix: usize) -> usize {
        self.firsts.get(ix).copied().unwrap_or(ix)
    }

    /// Decodes all images in use. Each source is decoded once.
    pub(super) fn decode(self, file: &File) -> Result<Vec<Image>, SceneError> {
        let mut sources = Vec::new();
        let mut place_of = HashMap::new();
        let mut encoded = 0_u64;
        for (ix, _) in &self.uses {
            if place_of.contains_key(ix) {
                continue;
            }
            let source = open(file, *ix)?;
            encoded = encoded.saturating_add(source.bytes.len() as u64);
            let most = limits::budget_bytes();
            if encoded > most {
                let accepted = format!("at most {most}, a quarter of the machine's memory");
                return Err(file.invalid("bytes of all images in use", encoded, accepted));
            }
            if is_cut_short(&source.bytes) {
                file.note(format!(
                    "{:?} is a truncated JPEG: the missing part is grey",
                    source.label
                ));
            }
            place_of.insert(*ix, sources.len());
            sources.push(source);
        }
        self.check_pixels(file, |ix| place_of.get(&ix).map(|place| sources[*place].size))?;
        let decoded: Vec<_> = sources.par_iter().map(|source| decode(file, source)).collect();
        let mut pixels = decoded.into_iter().collect::<Result<Vec<_>, _>>()?;
        // How many further images need the pixels of each source.
        let mut wanted = vec![0; sources.len()];
        for (ix, _) in &self.uses {
            wanted[place_of[ix]] += 1;
        }
        let images = self.uses.iter().map(|(ix, encoding)| {
            let place = place_of[ix];
            wanted[place] -= 1;
            let [width, height] = sources[place].size;
            let rgba = if wanted[place] == 0 {
                std::mem::take(&mut pixels[place])
            } else {
                pixels[place].clone()
            };
            Image { name: name(file, *ix), width, height, rgba, encoding: *encoding }
        });
        Ok(images.collect())
    }

    /// The number of pixels counts every entry of the file, those that share their bytes included.
    fn check_pixels(
        &self,
        file: &File,
        size: impl Fn(usize) -> Option<[u32; 2]>,
    ) -> Result<(), SceneError> {
        let pixels = |(ix, _): &(usize, Encoding)| {
            size(self.first(*ix)).map_or(0, |[width, height]| u64::from(width) * u64::from(height))
        };
        let together = self.entries.iter().map(pixels).fold(0, u64::saturating_add);
        let most = limits::max_pixels();
        if together > most {
            return Err(file.invalid(
                format!("pixels of all {} images in use, by their headers,", self.entries.len()),
                together,
                format!("at most {most}, whose colours take {} MiB", (most * 4) >> 20),
            ));
        }
        Ok(())
    }
}

fn name(file: &File, ix: usize) -> String {
    let image = file.root.images.get(ix);
    let given = image.and_then(|image| image.name.as_deref().or(image.uri.as_deref()));
    given.map_or_else(|| format!("images[{ix}]"), kept_name)
}

/// The file's image, with its header read.
fn open(file: &File, ix: usize) -> Result<Source<'_>, SceneError> {
    let field = format!("images[{ix}]");
    let images = &file.root.images;
    let image = images
        .get(ix)
        .ok_or_else(|| file.invalid("image", ix, format!("below {}", images.len())))?;
    let (bytes, label) = match (&image.uri, image.buffer_view) {
        (Some(uri), _) => {
            let bytes = file.fetch(uri, &format!("{field}.uri"), limits::MAX_IMAGE_BYTES)?;
            let short: String = uri.chars().take(60).collect();
            (Cow::Owned(bytes), format!("{field} ({short})"))
        }
        (None, Some(view)) => (Cow::Borrowed(file.view(view.value())?), field.clone()),
        (None, None) => {
            return Err(file.invalid(field, "without uri and bufferView", "one of them"));
        }
    };
    let mut source = Source { label, bytes, size: [0; 2] };
    let size = reader(file, &source)?.into_dimensions();
    let (width, height) = size.map_err(|e| fail(file, &source, e.to_string()))?;
    if width == 0 || height == 0 {
        return Err(fail(file, &source, "it has no pixels".into()));
    }
    if width.max(height) > MAX_SIDE {
        let accepted = format!("at most {MAX_SIDE} pixels on each side");
        return Err(file.invalid(format!("{field} size"), format!("{width} x {height}"), accepted));
    }
    source.size = [width, height];
    Ok(source)
}

/// Whether the pixels of a JPEG end before its end marker; the decoder fills the rest with grey. A
/// header may contain a small JPEG with an end marker of its own.
fn is_cut_short(bytes: &[u8]) -> bool {
    if !bytes.starts_with(&[0xff, 0xd8]) {
        return false;
    }
    let last = |mark: [u8; 2]| bytes.windows(2).rposition(|window| window == mark);
    let (scan, end) = (last([0xff, 0xda]), last([0xff, 0xd9]));
    scan.is_some() && end < scan
}

fn decode(file: &File, source: &Source<'_>) -> Result<Vec<u8>, SceneError> {
    let mut reader = reader(file, source)?;
    let [width, height] = source.size.map(u64::from);
    let mut limits = Limits::default();
    // Four channels of 16 bits are the most per pixel.
    limits.max_alloc = Some(width * height * 8 + DECODER_BYTES);
    reader.limits(limits);
    let pixels = reader.decode().map_err(|e| fail(file, source, e.to_string()))?.into_rgba8();
    if [pixels.width(), pixels.height()] != source.size {
        return Err(fail(file, source, "its size differs from that in its header".into()));
    }
    Ok(pixels.into_raw())
}

fn reader<'a>(
    file: &File,
    source: &'a Source<'_>,
) -> Result<ImageReader<Cursor<&'a [u8]>>, SceneError> {
    let reader = ImageReader::new(Cursor::new(&source.bytes[..]))
        .with_guessed_format()
        .map_err(|e| fail(file, source, e.to_string()))?;
    if !matches!(reader.format(), Some(ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::WebP)) {
        return Err(fail(file, source, "its first bytes match none of them".into()));
    }
    Ok(reader)
}

fn fail(file: &File, source: &Source<'_>, reason: String) -> SceneError {
    SceneError::Image { file: file.path.clone(), image: source.label.clone(), reason }
}
