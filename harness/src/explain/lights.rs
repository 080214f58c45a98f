//! The lights of a pixel: those that its list holds, and those that reach it.

use assign::{ENTRY_DIFFUSE, ENTRY_LIGHT, ENTRY_SPECULAR, Light, LightBuffer, LightKind, LightShape};
use glam::DVec3;
use rayon::prelude::*;
use serde::Serialize;
use shading::{is_missed, luminance};

use super::pixel::ListSeen;

/// Both terms of a light.
const ALL_TERMS: u32 = ENTRY_DIFFUSE | ENTRY_SPECULAR;

/// A light at the pixel.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LightSeen {
    /// Its slot in the buffer, by which lists name it.
    pub light: u32,
    /// Its index among all lights of the run, before they were ordered; `null` if only the GPU knows.
    pub given: Option<u32>,
    /// Its kind: `point`, `spot`, `rectangle`, `polygon` or `vpl`.
    pub kind: &'static str,
    /// Distance from the sample to the nearest point of the emitter, as a share of the light's range.
    pub distance_over_range: f64,
    /// Radiance that it adds, or that it would add if it is missed: linear RGB.
    pub radiance: [f32; 3],
    /// Whether the list holds it.
    pub is_listed: bool,
    /// Whether it reaches the sample, decided in f64.
    pub reaches: bool,
    /// Whether it reaches the sample, and the list lacks it or a term of it.
    pub is_missed: bool,
    /// The terms that its entry names; empty if it is not listed.
    pub terms: &'static str,
}

/// The sample as the check of lists sees it.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub(super) point: DVec3,
    /// For strategies that know normals.
    pub(super) normal: Option<DVec3>,
}

/// The entries to evaluate at a pixel: first those of its list, then the missed lights with both terms.
pub(super) fn entries_of(list: &[u32], lights: &[Light], place: Place) -> Vec<u32> {
    let mut listed = vec![0; lights.len()];
    for entry in list {
        if let Some(terms) = listed.get_mut((entry & ENTRY_LIGHT) as usize) {
            *terms |= entry & ALL_TERMS;
        }
    }
    let missed = lights.par_iter().zip(&listed).enumerate().filter(|(_, (light, terms))| {
        is_missed(light, **terms, place.point, place.normal)
    });
    let missed: Vec<u32> = missed.map(|(slot, _)| slot as u32 | ALL_TERMS).collect();
    [list, &missed].concat()
}

/// The number of lights that reach a point.
pub(super) fn reaching(lights: &[Light], point: DVec3) -> usize {
    lights.par_iter().filter(|light| light.reach(point) > 0.0).count()
}

/// The list of a pixel with its lights, from the entries of [`entries_of`] and the radiance of each. A light that the
/// list holds without a term that reaches is there once, with the radiance of both terms.
pub(super) fn list_seen(
    (entries, radiance): (&[u32], &[[f32; 3]]),
    listed: usize,
    lights: &[Light],
    buffer: &LightBuffer,
    place: Place,
) -> ListSeen {
    let missed: Vec<u32> = entries[listed..].iter().map(|entry| entry & ENTRY_LIGHT).collect();
    let mut seen = Vec::new();
    for (ix, (&entry, &radiance)) in entries.iter().zip(radiance).enumerate() {
        let slot = entry & ENTRY_LIGHT;
        let is_listed = ix < listed;
        let is_missed = missed.binary_search(&slot).is_ok();
        let lacks_a_term = !is_listed && entries[..listed].iter().any(|e| e & ENTRY_LIGHT == slot);
        if is_listed && is_missed {
            // It follows with both terms.
            continue;
        }
        let light = lights.get(slot as usize);
        seen.push(LightSeen {
            light: slot,
            given: light.and_then(|light| given_index(buffer, slot, light)),
            kind: light.map_or("unknown", |light| kind_name(light.kind())),
            distance_over_range: light.map_or(f64::NAN, |light| distance_share(light, place.point)),
            radiance,
            is_listed: is_listed || lacks_a_term,
            reaches: light.is_some_and(|light| light.reach(place.point) > 0.0),
            is_missed,
            terms: match (is_listed, entry & ALL_TERMS) {
                (false, _) => "",
                (true, ENTRY_DIFFUSE) => "diffuse",
                (true, ENTRY_SPECULAR) => "specular",
                (true, 0) => "none",
                (true, _) => "both",
            },
        });
    }
    let reaching = seen.iter().filter(|light| light.is_listed && light.reaches).count();
    let brightness = |light: &LightSeen| {
        let brightness = luminance(&light.radiance);
        if brightness.is_nan() { f64::INFINITY } else { brightness }
    };
    seen.sort_by(|a, b| {
        (b.is_missed.cmp(&a.is_missed))
            .then(brightness(b).total_cmp(&brightness(a)))
            .then(a.distance_over_range.total_cmp(&b.distance_over_range))
    });
    ListSeen { listed, reaching, missed: missed.len(), lights: seen }
}

/// The index of a slot's light among all lights of the run. With an order of the GPU, equal lights share the first
/// one's.
fn given_index(buffer: &LightBuffer, slot: u32, light: &Light) -> Option<u32> {
    if !buffer.order().is_on_gpu() {
        return buffer.given_index(slot);
    }
    let place = buffer.lights().iter().position(|known| known == light)?;
    buffer.given_index(place as u32)
}

fn kind_name(kind: LightKind) -> &'static str {
    match kind {
        LightKind::Point => "point",
        LightKind::Spot => "spot",
        LightKind::Rectangle => "rectangle",
        LightKind::Polygon => "polygon",
        LightKind::Vpl => "vpl",
    }
}

/// The distance to the nearest point of the emitter, over the range.
fn distance_share(light: &Light, point: DVec3) -> f64 {
    let to_point = point - light.position.as_dvec3();
    let distance = match &light.shape {
        LightShape::Area(emitter) => to_point.distance(emitter.closest(to_point)),
        LightShape::Point | LightShape::Spot { .. } | LightShape::Vpl { .. } => to_point.length(),
    };
    distance / f64::from(light.range_m)
}
