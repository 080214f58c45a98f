//! The pictures of the page. Each is stored once, while there is room.

use std::collections::{BTreeMap, HashMap};
use std::io::Cursor;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use image::{ImageFormat, ImageReader, imageops::FilterType};
use serde_json::{Map, Value, json};
use shading::HdrImage;

use crate::digits::rounded;
use crate::report::explained::explain_command;
use crate::report::format::{difference, significant};
use crate::report::markup::{Html, html};
use crate::report::picture_pair::{PicturePair, verdict};
use crate::results::{Errors, Record};
use crate::study::against_truth::truth_of;
use crate::study::data::Entry;
use crate::study::manifest::Done;
use crate::study::page::pictures::linear;

/// Pictures are at most this wide, pixels: as wide as the page shows them.
const WIDEST: u32 = 960;

/// The pictures take no more room than this, bytes: a browser has to hold the page.
const ROOM: usize = 48 << 20;

/// Pictures of records, by key.
pub(crate) struct Shots<'a> {
    done: &'a Done,
    /// The index in `uris` by key, and by the picture itself.
    by_key: HashMap<String, Option<usize>>,
    by_picture: HashMap<Vec<u8>, usize>,
    uris: Vec<String>,
    bytes: usize,
    pictures: Map<String, Value>,
    /// What opens at each key.
    viewers: BTreeMap<String, Html>,
    /// Pictures for which there was no room.
    pub(crate) left_out: usize,
}

/// Which pictures of a record are wanted.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Wanted {
    /// Its image beside the image without culling, and their difference.
    Pair,
    /// Its image beside the image under lights without a range.
    Unbounded,
    /// Its image beside the truth.
    Truth,
}

impl<'a> Shots<'a> {
    /// None yet.
    pub(crate) fn new(done: &'a Done) -> Self {
        Self {
            done,
            by_key: HashMap::new(),
            by_picture: HashMap::new(),
            uris: Vec::new(),
            bytes: 0,
            pictures: Map::new(),
            viewers: BTreeMap::new(),
            left_out: 0,
        }
    }

    /// Keeps the pictures of a record; returns the key by which the page opens them, if there are any.
    pub(crate) fn keep(&mut self, entry: Entry<'_>, wanted: Wanted) -> Option<String> {
        let Entry { job, record, .. } = entry;
        let images = &record.image.files;
        let image = match wanted {
            // Under the exposure of the truth, as the truth itself.
            Wanted::Truth => {
                let exposure = truth_of(self.done, &job.scene)?.1.exposure;
                self.linear(&job.name, images.raw.as_deref()?, exposure)?
            }
            _ => self.file(&job.name, images.tone_mapped.as_deref()?)?,
        };
        let (reference, difference, text) = match wanted {
            Wanted::Pair => {
                let baseline = images.baseline.as_deref();
                let reference = baseline.and_then(|name| self.file(&job.name, name));
                let difference = images.difference.as_deref();
                (reference, difference.and_then(|name| self.file(&job.name, name)), "no culling")
            }
            Wanted::Unbounded => {
                let raw = images.raw_unbounded.as_deref();
                let exposure = images.exposure.unwrap_or(1.0);
                let reference = raw.and_then(|name| self.linear(&job.name, name, exposure));
                (reference, None, "no range")
            }
            Wanted::Truth => {
                let (job, truth) = truth_of(self.done, &job.scene)?;
                (self.linear(&job.name, &truth.raw, truth.exposure), None, "truth")
            }
        };
        let key = format!("{}:{text}:{}", job.name, record.strategy);
        let errors = match wanted {
            Wanted::Pair => &record.image.errors,
            Wanted::Unbounded => &record.image.unbounded_errors,
            Wanted::Truth => &record.image.truth_errors,
        };
        let name = match wanted {
            Wanted::Truth => {
                record.setting.area_model.as_deref().unwrap_or(record.strategy.as_str())
            }
            _ => record.strategy.as_str(),
        };
        let pair = PicturePair {
            scene: &record.setting.scene,
            name,
            size: [record.setting.width, record.setting.height],
            image: Some(&image),
            reference: reference.as_deref(),
            reference_name: text,
            difference: difference.as_deref(),
            gain: images.difference_amplification,
            verdict: verdict(record),
            explain: explain_command(&job.command, record, None),
        };
        let shot = viewer(record, &pair, errors);
        self.viewers.insert(key.clone(), shot);
        Some(key)
    }

    /// Keeps a file of a job; returns the name by which the page opens it.
    pub(crate) fn file(&mut self, job: &str, name: &str) -> Option<String> {
        self.picture(job, name, |path| {
            let picture =
                ImageReader::open(path).ok()?.with_guessed_format().ok()?.decode().ok()?;
            let (width, height) = (picture.width(), picture.height());
            if width <= WIDEST {
                return std::fs::read(path).ok();
            }
            let height = (u64::from(height) * u64::from(WIDEST) / u64::from(width)).max(1) as u32;
            let small = picture.resize_exact(WIDEST, height, FilterType::Triangle);
            let mut png = Cursor::new(Vec::new());
            small.write_to(&mut png, ImageFormat::Png).ok()?;
            Some(png.into_inner())
        })
    }

    /// Keeps a linear image, tone-mapped as the others.
    pub(crate) fn linear(&mut self, job: &str, name: &str, exposure: f64) -> Option<String> {
        self.picture(job, name, |path| tone_mapped_png(&HdrImage::read_exr(path).ok()?, exposure))
    }

    /// Keeps a picture of the light that a linear image of a job lacks against another one, tone-mapped as both.
    pub(crate) fn lost(
        &mut self,
        job: &str,
        [image, reference]: [&str; 2],
        exposure: f64,
    ) -> Option<String> {
        let done = self.done;
        self.drawn(format!("{job}/{image} lacks"), || {
            let [image, reference] = [image, reference].map(|name| linear(done, job, Some(name)));
            let (image, reference) = (image?, reference?);
            let size = |image: &HdrImage| (image.width, image.height);
            if size(&image) != size(&reference) {
                return None;
            }
            let pairs = reference.pixels.iter().zip(&image.pixels);
            let lack =
                |(a, b): (&[f32; 3], &[f32; 3])| [0, 1, 2].map(|ix| (a[ix] - b[ix]).max(0.0));
            let pixels = pairs.map(lack).collect();
            tone_mapped_png(&HdrImage { pixels, ..*image }, exposure)
        })
    }

    fn picture(
        &mut self,
        job: &str,
        name: &str,
        read: impl FnOnce(&Path) -> Option<Vec<u8>>,
    ) -> Option<String> {
        let folder = self.done.folders.get(job)?;
        // No name leads out of its folder.
        Path::new(name).file_name().filter(|file| *file == name)?;
        let path = folder.join(name);
        self.drawn(format!("{job}/{name}"), || read(&path))
    }

    /// Keeps a picture under the key, and draws it only once; returns the key.
    pub(crate) fn drawn(
        &mut self,
        key: String,
        draw: impl FnOnce() -> Option<Vec<u8>>,
    ) -> Option<String> {
        if let Some(known) = self.by_key.get(&key) {
            return known.map(|_| key);
        }
        let ix = draw().and_then(|png| self.store(png));
        self.by_key.insert(key.clone(), ix);
        self.pictures.insert(key.clone(), ix?.into());
        Some(key)
    }

    fn store(&mut self, png: Vec<u8>) -> Option<usize> {
        if let Some(&ix) = self.by_picture.get(&png) {
            return Some(ix);
        }
        if self.bytes + png.len() > ROOM {
            self.left_out += 1;
            return None;
        }
        self.bytes += png.len();
        self.uris.push(format!("data:image/png;base64,{}", STANDARD.encode(&png)));
        self.by_picture.insert(png, self.uris.len() - 1);
        Some(self.uris.len() - 1)
    }

    /// The viewers of all shots, which the page's script opens.
    pub(crate) fn templates(&self) -> Html {
        let template = |(key, body): (&String, &Html)| {
            html!("<template data-shot=\"{}\">{}</template>\n", key, body)
        };
        self.viewers.iter().map(template).collect()
    }

    /// What the page's script needs: the pictures, each stored once.
    pub(crate) fn view(self) -> Value {
        json!({ "pictures": self.pictures, "uris": self.uris })
    }
}

/// A linear image as a picture, at most as wide as the page shows it.
fn tone_mapped_png(image: &HdrImage, exposure: f64) -> Option<Vec<u8>> {
    if image.width <= WIDEST {
        return image.to_png(exposure as f32).ok();
    }
    let rgb = image.tone_mapped(exposure as f32);
    let picture = image::RgbImage::from_raw(image.width, image.height, rgb)?;
    let height = u64::from(image.height) * u64::from(WIDEST) / u64::from(image.width);
    let height = height.max(1) as u32;
    let small = image::imageops::resize(&picture, WIDEST, height, FilterType::Triangle);
    let mut png = Cursor::new(Vec::new());
    small.write_to(&mut png, ImageFormat::Png).ok()?;
    Some(png.into_inner())
}

/// A shot beside what it should look like, with its time and its errors.
fn viewer(record: &Record, pair: &PicturePair<'_>, errors: &Errors) -> Html {
    let threshold = record
        .setting
        .threshold
        .map_or_else(String::new, |threshold| format!(", threshold {}", rounded(threshold)));
    let mut figures = html!("<li>{} ms</li>", significant(record.assign_and_shade_ms()));
    for (id, error) in errors {
        if let Some(error) = error.filter(|error| error.is_finite()) {
            figures += html!("<li>{} {}</li>", id.replace('_', " "), difference(error));
        }
    }
    let difference = match pair.difference.is_some() {
        true => pair.difference(false),
        false => Html::default(),
    };
    html!(
        "<div class=\"figcaption\"><b>{}{}</b><button type=\"button\" class=\"quiet\">Close</button></div>\n\
         <ul class=\"legend\">{}</ul>\n<div class=\"stage\">{}{}</div>\n",
        pair.name,
        threshold,
        figures,
        pair.main(),
        difference
    )
}
