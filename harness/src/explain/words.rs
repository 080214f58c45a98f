//! A pixel explained in words, at most 100 columns wide.

use std::fmt::Write;

use super::pixel::{
    BoundsSeen, Difference, Explanation, GroupSeen, LightSeen, ListSeen, SampleSeen, StrategySeen,
};
use crate::{
    digits::{grouped, rounded},
    report::terminal::push_wrapped,
};

/// The most lights of a list that are shown unless all are.
const MOST_SHOWN: usize = 12;

/// The text of an explanation; `shows_all` shows every light of the lists.
pub fn text_of(explanation: &Explanation, shows_all: bool) -> String {
    let mut text = String::new();
    push_wrapped(&mut text, &heading(explanation));
    text.push('\n');
    match &explanation.sample {
        Some(sample) => push_sample(&mut text, sample, explanation.lights),
        None => text.push_str(
            "This pixel shows no opaque surface (sky): it has no sample, reads no list, and no light adds to it.\n",
        ),
    }
    for strategy in &explanation.strategies {
        push_strategy(&mut text, strategy, explanation, shows_all);
    }
    if explanation.sample.is_some() {
        text.push_str(
            "\nWhat lights add is evaluated on the GPU by the function that shading calls; whether a light reaches\n\
             the sample is decided on the CPU in f64.\n",
        );
    }
    for note in &explanation.notes {
        push_wrapped(&mut text, &format!("Note: {note}"));
    }
    text
}

/// `Pixel 12,30 of 64x36, deferred, frame 3 of 60: atrium, 300 lights`.
fn heading(explanation: &Explanation) -> String {
    let Explanation { pixel, size, frame, path_frames, .. } = explanation;
    let when = match (frame, path_frames) {
        (Some(frame), Some(frames)) => format!(", frame {frame} of {frames} of the path"),
        (Some(frame), None) => format!(", frame {frame}"),
        (None, Some(_)) => ", the still view before the path".to_owned(),
        (None, None) => String::new(),
    };
    format!(
        "Pixel {},{} of {}x{}, {}{when}: {}, {} lights",
        pixel[0],
        pixel[1],
        size[0],
        size[1],
        explanation.mode,
        explanation.scene,
        grouped(&explanation.lights.to_string())
    )
}

/// Appends a line that starts with a name.
fn push_fact(text: &mut String, name: &str, words: &str) {
    let _ = writeln!(text, "  {name:<11}{words}");
}

fn push_sample(text: &mut String, sample: &SampleSeen, lights: u64) {
    text.push_str("Sample\n");
    push_fact(text, "position", &format!("{} m in the world", vector(sample.position_world)));
    let in_view = vector(sample.position_view.map(f64::from));
    push_fact(text, "", &format!("{in_view} m in view space"));
    push_fact(
        text,
        "depth",
        &format!(
            "{} m along the view, {} in the depth buffer",
            rounded(sample.depth_view_m.into()),
            sample.depth_clip
        ),
    );
    push_fact(text, "normal", &vector(sample.normal_world.map(f64::from)));
    let material = &sample.material;
    push_fact(
        text,
        "material",
        &format!(
            "base colour {}, metallic {}, roughness {}",
            vector(material.base_color.map(f64::from)),
            rounded(material.metallic.into()),
            rounded(material.roughness.into())
        ),
    );
    for (name, radiance) in [("emits", sample.emission), ("from suns", sample.from_suns)] {
        if radiance != [0.0; 3] {
            push_fact(text, name, &colour(radiance));
        }
    }
    let (reached, lights) = (count(sample.reached_by), grouped(&lights.to_string()));
    push_fact(text, "reached by", &format!("{reached} of {lights} lights"));
}

fn push_strategy(text: &mut String, seen: &StrategySeen, of: &Explanation, shows_all: bool) {
    let lossy = if seen.is_lossy { " (it loses light on purpose)" } else { "" };
    let _ = writeln!(text, "\n{}{lossy}", seen.strategy);
    push_fact(text, "radiance", &colour(seen.radiance));
    if let Some(difference) = &seen.difference {
        difference_lines(difference).iter().for_each(|line| push_fact(text, "", line));
    }
    for (ix, group) in seen.groups.iter().enumerate() {
        push_group(text, if ix == 0 { "group" } else { "and group" }, group, of.size);
    }
    match &seen.list {
        Some(list) => push_list(text, list, shows_all),
        None if of.sample.is_some() => {
            push_fact(text, "list", "it has none: no list decides what it draws");
        }
        None => {}
    }
}

fn difference_lines(difference: &Difference) -> Vec<String> {
    if difference.is_same {
        return vec!["the same as without culling, in every bit".to_owned()];
    }
    let relative = match difference.relative.is_finite() {
        true => {
            format!("at most {} of a channel's value without culling", number(difference.relative))
        }
        false => "an amount that is not finite".to_owned(),
    };
    let off = colour(difference.radiance);
    vec![format!("differs from no culling by {off}"), format!("({relative})")]
}

fn push_group(text: &mut String, name: &str, group: &GroupSeen, image: [u32; 2]) {
    let Some(index) = group.index else {
        let words = match group.count {
            0 => "none: every sample reads the list of all lights, or finds its lights itself",
            _ => "outside all groups: it reads the list of all lights",
        };
        push_fact(text, name, words);
        return;
    };
    let (index, count) = (grouped(&index.to_string()), grouped(&group.count.to_string()));
    let place =
        group.bounds.as_ref().and_then(|bounds| tile_words(bounds, image)).unwrap_or_default();
    push_fact(text, name, &format!("{index} of {count}{place}"));
    if group.overflowed {
        let words =
            "OVERFLOW: its list did not fit into the pool, so it reads the list of all lights";
        push_fact(text, "", words);
    }
    match &group.bounds {
        Some(bounds) => bounds_lines(bounds).iter().enumerate().for_each(|(ix, line)| {
            push_fact(text, if ix == 0 { "bounds" } else { "" }, line);
        }),
        None => push_fact(text, "bounds", "the strategy keeps none"),
    }
}

/// `: tile (3,4)`, if the rectangle is one of a grid that starts at the upper left corner.
fn tile_words(bounds: &BoundsSeen, image: [u32; 2]) -> Option<String> {
    let BoundsSeen::Frustum { low_px, high_px, .. } = bounds else { return None };
    if [0, 1].iter().all(|&axis| low_px[axis] < 0.5 && high_px[axis] > image[axis] as f32 - 0.5) {
        return Some(": the whole image".to_owned());
    }
    let tile = [0, 1].map(|axis| {
        let size = high_px[axis] - low_px[axis];
        let tile = (low_px[axis] / size).round();
        let fits = size >= 0.5 && (tile * size - low_px[axis]).abs() < 0.25;
        fits.then_some(tile as i64)
    });
    let [Some(x), Some(y)] = tile else { return None };
    Some(format!(
        ": tile ({x},{y}) of {} x {} pixels",
        size_of(low_px, high_px, 0),
        size_of(low_px, high_px, 1)
    ))
}

fn size_of(low: &[f32; 2], high: &[f32; 2], axis: usize) -> String {
    rounded(f64::from(high[axis] - low[axis]))
}

fn bounds_lines(bounds: &BoundsSeen) -> Vec<String> {
    match bounds {
        BoundsSeen::Frustum { low_px, high_px, depth_m, slices } => {
            let range = |axis: usize| {
                format!("{} to {}", rounded(low_px[axis].into()), rounded(high_px[axis].into()))
            };
            let depth = depth_m.map(|depth| match depth {
                Some(depth) => rounded(depth.into()),
                None => "infinity".to_owned(),
            });
            let slices = slices.map_or_else(String::new, |slices| {
                format!(", {slices} of its 32 slices hold samples")
            });
            vec![
                format!("pixels x {}, y {}", range(0), range(1)),
                format!("view depth {} to {} m{slices}", depth[0], depth[1]),
            ]
        }
        BoundsSeen::Box { min_world, max_world } => {
            vec![
                format!("box from {}", vector(*min_world)),
                format!("to {} m, along the world's axes", vector(*max_world)),
            ]
        }
        BoundsSeen::OrientedBox { center_world, axes, half_extents_m } => vec![
            format!("box around {}", vector(*center_world)),
            format!("half extents {} m", vector(half_extents_m.map(f64::from))),
            format!("along {}", vector(axes[0].map(f64::from))),
            format!("      {}", vector(axes[1].map(f64::from))),
            format!("      {} (world space)", vector(axes[2].map(f64::from))),
        ],
    }
}

fn push_list(text: &mut String, list: &ListSeen, shows_all: bool) {
    let lights = if list.listed == 1 { "light" } else { "lights" };
    let reach = if list.reaching == 1 { "reaches" } else { "reach" };
    push_fact(
        text,
        "list",
        &format!(
            "{} {lights}, {} of them {reach} the sample",
            count(list.listed),
            count(list.reaching)
        ),
    );
    if list.missed > 0 {
        let words = if list.missed == 1 { "light reaches" } else { "lights reach" };
        let words = format!("{} {words} the sample and the list lacks it", count(list.missed));
        push_fact(text, "MISSED", &words);
    }
    if list.lights.is_empty() {
        return;
    }
    let _ = writeln!(
        text,
        "  {:>10} {:>10} {:<9} {:>10} {:>10} {:>10} {:>10}",
        "light", "given as", "kind", "dist/range", "red", "green", "blue"
    );
    let shown = if shows_all { list.lights.len() } else { MOST_SHOWN.max(list.missed.min(64)) };
    for light in list.lights.iter().take(shown) {
        push_light(text, light);
    }
    let rest = list.lights.get(shown..).unwrap_or_default();
    if !rest.is_empty() {
        let lit = rest.iter().filter(|light| light.radiance != [0.0; 3]).count();
        let words = format!("and {} more, {} of which add light", count(rest.len()), count(lit));
        let _ = writeln!(text, "  {words} (--all shows them)");
    }
}

fn push_light(text: &mut String, light: &LightSeen) {
    let given = match light.given {
        Some(given) if given == light.light => String::new(),
        Some(given) => grouped(&given.to_string()),
        None => "?".to_owned(),
    };
    let adds = light.radiance != [0.0; 3];
    let note = match (light.is_missed, light.is_listed, light.reaches) {
        (true, true, _) => "MISSED term",
        (true, false, _) => "MISSED",
        (false, _, false) => "does not reach",
        (false, ..) if !adds => "adds nothing",
        _ if light.terms == "specular" => "specular term",
        _ if light.terms == "diffuse" => "diffuse term",
        _ => "",
    };
    let [red, green, blue] = light.radiance.map(|value| number(value.into()));
    let line = format!(
        "  {:>10} {given:>10} {:<9} {:>10} {red:>10} {green:>10} {blue:>10}  {note}",
        grouped(&light.light.to_string()),
        light.kind,
        format!("{:.4}", light.distance_over_range),
    );
    text.push_str(line.trim_end());
    text.push('\n');
}

fn count(count: usize) -> String {
    grouped(&count.to_string())
}

/// Four significant digits, short enough for a column.
fn number(value: f64) -> String {
    let size = value.abs();
    match size {
        0.0 => "0".to_owned(),
        _ if !size.is_finite() => "not finite".to_owned(),
        _ if (1e-4..1e5).contains(&size) => rounded(value),
        _ => format!("{value:.2e}"),
    }
}

fn vector(v: [f64; 3]) -> String {
    let [x, y, z] = v.map(number);
    format!("({x}, {y}, {z})")
}

fn colour(radiance: [f32; 3]) -> String {
    vector(radiance.map(f64::from))
}
