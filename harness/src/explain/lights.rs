//! The lights of a pixel: those that its list holds, and those that reach it.

use std::collections::{HashMap, HashSet};

use assign::{
    ENTRY_DIFFUSE, ENTRY_LIGHT, ENTRY_SPECULAR, Light, LightBuffer, LightKind, LightShape,
};
use glam::DVec3;
use rayon::prelude::*;
use shading::{is_missed, luminance};

use super::pixel::{LightSeen, ListSeen};

/// Both terms of a light.
const ALL_TERMS: u32 = ENTRY_DIFFUSE | ENTRY_SPECULAR;

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
    let missed = lights
        .par_iter()
        .zip(&listed)
        .enumerate()
        .filter(|(_, (light, terms))| is_missed(light, **terms, place.point, place.normal));
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
    let known: HashSet<u32> = entries[..listed].iter().map(|entry| entry & ENTRY_LIGHT).collect();
    let given = GivenIndex::new(buffer);
    let mut seen = Vec::new();
    for (ix, (&entry, &radiance)) in entries.iter().zip(radiance).enumerate() {
        let slot = entry & ENTRY_LIGHT;
        let is_listed = ix < listed;
        let is_missed = missed.binary_search(&slot).is_ok();
        let lacks_a_term = !is_listed && known.contains(&slot);
        if is_listed && is_missed {
            // It follows with both terms.
            continue;
        }
        let light = lights.get(slot as usize);
        seen.push(LightSeen {
            light: slot,
            given: light.and_then(|light| given.of(slot, light)),
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

/// The index of lights among all lights of the run, before they were ordered.
enum GivenIndex<'a> {
    /// The CPU ordered them: the buffer knows.
    Ordered(&'a LightBuffer),
    /// The GPU ordered them: the place of each light by its numbers. Equal lights share the last one's.
    ByValue(HashMap<[u32; 7], u32>, &'a LightBuffer),
}

impl<'a> GivenIndex<'a> {
    fn new(buffer: &'a LightBuffer) -> Self {
        if !buffer.order().is_on_gpu() {
            return Self::Ordered(buffer);
        }
        let places = buffer.lights().iter().zip(0..).map(|(light, place)| (key_of(light), place));
        Self::ByValue(places.collect(), buffer)
    }

    /// The index of a slot's light; `None` if only the GPU knows.
    fn of(&self, slot: u32, light: &Light) -> Option<u32> {
        match self {
            Self::Ordered(buffer) => buffer.given_index(slot),
            Self::ByValue(places, buffer) => buffer.given_index(*places.get(&key_of(light))?),
        }
    }
}

/// The numbers by which lights are told apart.
fn key_of(light: &Light) -> [u32; 7] {
    let ([x, y, z], [r, g, b]) = (light.position.to_array(), light.intensity.to_array());
    [x, y, z, light.range_m, r, g, b].map(f32::to_bits)
}

fn kind_name(kind: LightKind) -> &'static str {
    match kind {
        LightKind::Point => "point",
        LightKind::Spot => "spot",
        LightKind::Rectangle => "rectangle",
        LightKind::Polygon => "polygon",
        LightKind::Vpl => "vpl",
        LightKind::Disc => "disc",
        LightKind::Sphere => "sphere",
        LightKind::Line => "line",
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
