//! Each model beside the truth: image, difference, and the worst tile.

use std::io::Cursor;

use image::{ImageFormat, RgbImage, imageops};

use crate::image_errors::{ImagePair, TILE_PX, worst_tile_at};
use crate::report::format::significant;
use crate::report::markup::{Html, html};
use crate::study::against_truth::{MODELS, truth_of};
use crate::study::area::page::models::model;
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;
use crate::study::page::figure::panels;
use crate::study::page::part::Part;
use crate::study::page::pictures::{figure, linear};
use crate::study::page::shots::Shots;

/// Gain of difference pictures, relative to the images.
const GAIN: f32 = 8.0;

/// Side of the cut-out around the worst tile in pixels, and its enlargement.
const CUT_PX: u32 = 4 * TILE_PX as u32;
const LARGER: u32 = 4;

/// One panel a model.
pub(crate) fn pictures(done: &Done, scene: &str, shots: &mut Shots<'_>) -> Option<Part> {
    let (job, truth) = truth_of(done, scene)?;
    let exposure = truth.exposure;
    let reference = linear(done, &job.name, Some(&truth.raw))?;
    let truth_key = shots.linear(&job.name, &truth.raw, exposure)?;
    let mut shown: Vec<(String, Html)> = Vec::new();
    for entry in entries(done, scene, MODELS) {
        let Entry { job, record, .. } = entry;
        let raw = record.image.files.raw.as_deref();
        let Some(image) = linear(done, &job.name, raw) else { continue };
        if (image.width, image.height) != (reference.width, reference.height) {
            continue;
        }
        let pair = ImagePair { image: &image, reference: &reference, exposure: exposure as f32 };
        let picture = raw.and_then(|raw| shots.linear(&job.name, raw, exposure));
        let gain = GAIN * exposure as f32;
        let difference = shots.drawn(format!("{}:difference", job.name), || {
            image.difference_png(&reference, gain).ok()
        });
        let corner = worst_tile_at(&pair).unwrap_or_default();
        let cut = shots.drawn(format!("{}:tile", job.name), || beside(&pair, corner));
        let name = model(record);
        let body = figure(Some(truth_key.clone()), "The truth", "")
            + figure(picture, name, "")
            + figure(
                difference,
                &format!("Difference \u{d7} {}", significant(f64::from(gain))),
                "absolute and linear; black means none",
            )
            + figure(
                cut,
                "The worst tile",
                &format!(
                    "of {TILE_PX} pixels, at {}, {}, with its surroundings: truth on the left, \
                     {name} on the right",
                    corner[0], corner[1]
                ),
            );
        shown.push((name.to_owned(), html!("<div class=\"views\">{}</div>\n", body)));
    }
    Some(Part::new(
        "pictures",
        "What models look like",
        "All pictures use the exposure of the truth.",
        panels("Model", &shown),
    ))
}

/// The enlarged surroundings of a tile: the truth on the left, the image on the right.
fn beside(pair: &ImagePair<'_>, corner: [u32; 2]) -> Option<Vec<u8>> {
    let (width, height) = (pair.image.width, pair.image.height);
    let size = [CUT_PX.min(width), CUT_PX.min(height)];
    let middle = TILE_PX as u32 / 2;
    let from = [(corner[0], width, size[0]), (corner[1], height, size[1])]
        .map(|(at, all, part)| (at + middle).saturating_sub(part / 2).min(all - part));
    let mut both = RgbImage::new(2 * size[0] * LARGER + LARGER, size[1] * LARGER);
    for (image, left) in [(pair.reference, 0), (pair.image, size[0] * LARGER + LARGER)] {
        let whole = RgbImage::from_raw(width, height, image.tone_mapped(pair.exposure))?;
        let cut = imageops::crop_imm(&whole, from[0], from[1], size[0], size[1]).to_image();
        let (wide, high) = (size[0] * LARGER, size[1] * LARGER);
        let large = imageops::resize(&cut, wide, high, imageops::FilterType::Nearest);
        imageops::replace(&mut both, &large, i64::from(left), 0);
    }
    let mut png = Cursor::new(Vec::new());
    both.write_to(&mut png, ImageFormat::Png).ok()?;
    Some(png.into_inner())
}

#[cfg(test)]
mod tests {
    use shading::HdrImage;

    use super::*;

    #[test]
    fn a_cut_stays_inside_its_image() {
        for (width, height) in [(16, 16), (200, 40), (300, 300)] {
            let pixels = vec![[0.5; 3]; (width * height) as usize];
            let image = HdrImage { width, height, pixels };
            let pair = ImagePair { image: &image, reference: &image, exposure: 1.0 };
            for corner in [[0, 0], [width - 16, height - 16]] {
                let png = beside(&pair, corner).expect("a picture");
                let size = image::load_from_memory(&png).expect("a picture").to_rgb8().dimensions();
                let sides = [width.min(CUT_PX), height.min(CUT_PX)];
                assert_eq!(size, ((2 * sides[0] + 1) * LARGER, sides[1] * LARGER));
            }
        }
    }
}
