//! The page of shadow maps: errors by the number of maps, their size, their filter and the lights in one atlas.

mod approach;
pub(crate) mod charts;
mod pictures;
mod rays;
mod table;

use self::charts::{Sweep, swept};
use super::cells::{METRIC, adaptive, atlas, atlases, floor_of, least, maps, pipeline_of, steps};
use super::jobs::{ADAPTIVE, APPROACH, COMPARED, LIGHTS, MAPS, NONE, RAYS, SIDES, TAPS};
use super::{lod, occlusion, roughness};
use crate::report::format::{difference, number, short_adapter};
use crate::report::rank::listed;
use crate::study::data::{Entry, entries};
use crate::study::manifest::Done;
use crate::study::page::figure::Charts;
use crate::study::page::part::Part;
use crate::study::page::shots::Shots;

/// The sweeps of the study, in the order of the page.
const SWEEPS: [Sweep; 5] = [
    Sweep {
        section: MAPS,
        title: "Error by the number of maps in one atlas",
        note: "Each line is an atlas of one size. More maps have smaller sides, so that all fit. The dashed line is P: \
               the exact visible share of each light, times its exact light without shadows. No model of visible shares \
               is below it.",
        axis: ("Maps of each light", ""),
        x: |entry| Some(maps(entry.record)?.maps),
        series: |entry| {
            let px = f64::from(atlas(entry).unwrap_or_default());
            format!("atlas of {}\u{b2}", number(px))
        },
        has_floor: true,
    },
    Sweep {
        section: SIDES,
        title: "Error by the size of maps",
        note: "Each line is one number of maps. The dashed line is P.",
        axis: ("Side of a map", "texels"),
        x: |entry| Some(maps(entry.record)?.px),
        series: of_maps,
        has_floor: true,
    },
    Sweep {
        section: TAPS,
        title: "Error by the filter",
        note: "A look-up compares this many texels of each map (percentage-closer filtering). Offsets grow with the \
               filter, so light leaks farther. The dashed line is P.",
        axis: ("Texels compared in each map", ""),
        x: |entry| Some(maps(entry.record)?.taps),
        series: of_maps,
        has_floor: true,
    },
    Sweep {
        section: LIGHTS,
        title: "Error by the lights in one atlas",
        note: "All lights share one atlas, so more lights have smaller maps. Each image is compared with T of as many \
               lights, at a smaller size than the others. P is computed for one number of lights only, so no line is drawn.",
        axis: ("Lights", ""),
        x: |entry| u32::try_from(entry.record.setting.lights).ok(),
        series: of_maps,
        has_floor: false,
    },
    Sweep {
        section: ADAPTIVE,
        title: "Error where frames subdivide the lights",
        note: "The fewer pixels are tested for bands, the fewer maps the lights get. The table below also has fixed numbers \
               of maps of the same side. The dashed line is P.",
        axis: ("Pixels along an axis of which one is tested", ""),
        x: |entry| Some(adaptive(entry.record)?.down),
        series: |_| "adaptive".to_owned(),
        has_floor: true,
    },
];

/// `25 maps`, the name of a line.
fn of_maps(entry: &Entry<'_>) -> String {
    maps(entry.record).map_or_else(|| "no shadows".to_owned(), |maps| format!("{} maps", maps.maps))
}

const TABLE_NOTE: &str = "Errors are those against T, the truth with shadows. The row P is the floor: it has no maps. The last two columns \
     are times from the records. \u{201c}Draw maps\u{201d} draws all maps once, or builds the deep images that rays cross, before the frames. \
     \u{201c}Shade\u{201d} is a frame\u{2019}s lighting pass without culling. Times of a software adapter say nothing \
     of a GPU.";

const APPROACH_NOTE: &str = "The camera looks at a place in front of the light. The last column is what a frame would take whose light moves: drawing \
     all maps, the test for bands, and shading. Times of a software adapter say nothing of a GPU.";

/// The parts of a scene's section.
pub(crate) fn parts(
    done: &Done,
    scene: &str,
    charts: &mut Charts,
    shots: &mut Shots<'_>,
) -> Vec<Part> {
    let mut parts: Vec<Part> = SWEEPS
        .iter()
        .map(|sweep| {
            Part::new(sweep.section, sweep.title, sweep.note, swept(done, scene, sweep, charts))
        })
        .collect();
    parts.push(rays::part(done, scene, charts));
    let mut all = COMPARED.map(|section| entries(done, scene, section)).concat();
    all.extend(entries(done, scene, RAYS));
    let body = table::table(done, scene, &all);
    parts.push(Part::new("table", "All figures", TABLE_NOTE, body));
    let body = approach::table(done, scene);
    parts.push(Part::new(APPROACH, "Subdivision as the camera approaches", APPROACH_NOTE, body));
    parts.push(roughness::part(done, scene, charts));
    parts.push(lod::part(done, scene, charts));
    parts.push(occlusion::part(done, scene));
    parts.push(Part::new(
        "pictures",
        "What maps look like",
        "All pictures use the exposure of T. Of the sweep of maps, the first, the best and the last are shown, by FLIP.",
        pictures::pictures(done, scene, shots),
    ));
    parts
}

/// Where the error in an atlas is least: `in an atlas of 2,048\u{b2} texels, FLIP against the truth is least with 25
/// maps of 112\u{b2} for each light (0.0331)`.
fn sentence(done: &Done, scene: &str, atlas_px: u32) -> Option<String> {
    let steps = steps(done, scene, atlas_px);
    let best = least(&steps);
    let told: Vec<String> = best
        .iter()
        .map(|(maps, error)| {
            let maps_of = if maps.maps == 1 { "map of" } else { "maps of" };
            let px = number(f64::from(maps.px));
            format!("{} {maps_of} {px}\u{b2} ({})", maps.maps, difference(*error))
        })
        .collect();
    let ties = if told.len() > 1 { ", which tie" } else { "" };
    (!told.is_empty() && steps.len() > 1).then(|| {
        format!(
            "in {scene}, FLIP against the truth in an atlas of {}\u{b2} texels is least with {} for each light{ties}",
            number(f64::from(atlas_px)),
            listed(&told)
        )
    })
}

/// The best maps of the largest atlas, in the first scene that has figures.
pub(crate) fn headline(done: &Done) -> Option<String> {
    let adapter = short_adapter(&done.results.values().next()?.machine.adapter);
    let sentence = done
        .scenes()
        .into_iter()
        .find_map(|scene| sentence(done, scene, *atlases(done, scene).last()?))?;
    Some(format!("On {adapter}, {sentence}."))
}

/// The best maps of each atlas, and what no model of visible shares can beat.
pub(crate) fn findings(done: &Done, scene: &str) -> Vec<String> {
    let all = atlases(done, scene).into_iter();
    let told = all.filter_map(|atlas_px| sentence(done, scene, atlas_px));
    let mut found: Vec<String> =
        told.map(|sentence| sentence.replacen("in ", "In ", 1) + ".").collect();
    if let Some(floor) = floor_of(done, scene, METRIC) {
        let without = entries(done, scene, NONE);
        let without = without.first().and_then(|entry| super::cells::error(entry.record, METRIC));
        let without = without.map_or_else(String::new, |error| {
            format!(" Without shadows it is {}.", difference(error))
        });
        let pipeline = pipeline_of(done, scene, METRIC).map_or_else(String::new, |error| {
            format!(
                " The pipeline itself (G-buffer, textures, area-light model) is off by {}, without shadows and against the \
                 truth without them. No map changes that.",
                difference(error)
            )
        });
        found.push(format!(
            "In {scene}, exact visible shares (P) have a FLIP of {} against the truth: the floor of all \
             maps.{without}{pipeline}",
            difference(floor)
        ));
    }
    found.extend(roughness::finding(done, scene));
    found.extend(lod::finding(done, scene));
    found.extend(rays::finding(done, scene));
    found.extend(occlusion::finding(done, scene));
    found
}
