//! Images: decoded in parallel, one entry per encoding in use.

use std::{collections::HashMap, io::Cursor};

use image::{ImageFormat, ImageReader, Limits};
use rayon::prelude::*;

use super::file::File;
use crate::{Encoding, Image, SceneError};

/// The longest side accepted, pixels: what GPUs offer.
const MAX_SIDE: u32 = 16_384;

/// The images in use, numbered in order of first use.
#[derive(Default)]
pub(super) struct ImageTable {
    numbers: HashMap<(usize, Encoding), u32>,
    uses: Vec<(usize, Encoding)>,
}

impl ImageTable {
    /// The number of the file's image `ix` in that encoding.
    pub(super) fn number(&mut self, ix: usize, encoding: Encoding) -> u32 {
        *self.numbers.entry((ix, encoding)).or_insert_with(|| {
            self.uses.push((ix, encoding));
            self.uses.len() as u32 - 1
        })
    }

    /// Decodes all of them.
    pub(super) fn decode(self, file: &File) -> Result<Vec<Image>, SceneError> {
        self.uses.into_par_iter().map(|(ix, encoding)| decode(file, ix, encoding)).collect()
    }
}

fn decode(file: &File, ix: usize, encoding: Encoding) -> Result<Image, SceneError> {
    let field = format!("images[{ix}]");
    let images = &file.root.images;
    let source = images
        .get(ix)
        .ok_or_else(|| file.invalid("image", ix, format!("below {}", images.len())))?;
    let fetched;
    let (bytes, label) = match (&source.uri, source.buffer_view) {
        (Some(uri), _) => {
            fetched = file.fetch(uri, &format!("{field}.uri"))?;
            let short: String = uri.chars().take(60).collect();
            (&fetched[..], format!("{field} ({short})"))
        }
        (None, Some(view)) => (file.view(view.value())?, field.clone()),
        (None, None) => {
            return Err(file.invalid(field, "without uri and bufferView", "one of them"));
        }
    };
    let fail = |reason: String| SceneError::Image {
        file: file.path.clone(),
        image: label.clone(),
        reason,
    };
    let mut reader = ImageReader::new(Cursor::new(bytes))
        .with_guessed_format()
        .map_err(|e| fail(e.to_string()))?;
    if !matches!(reader.format(), Some(ImageFormat::Png | ImageFormat::Jpeg | ImageFormat::WebP)) {
        return Err(fail("its first bytes are those of none of them".into()));
    }
    let mut limits = Limits::default();
    limits.max_image_width = Some(MAX_SIDE);
    limits.max_image_height = Some(MAX_SIDE);
    reader.limits(limits);
    let pixels = reader.decode().map_err(|e| fail(e.to_string()))?.into_rgba8();
    if pixels.width() == 0 || pixels.height() == 0 {
        return Err(fail("it has no pixels".into()));
    }
    Ok(Image {
        name: source.name.clone().or_else(|| source.uri.clone()).unwrap_or(field),
        width: pixels.width(),
        height: pixels.height(),
        rgba: pixels.into_raw(),
        encoding,
    })
}
