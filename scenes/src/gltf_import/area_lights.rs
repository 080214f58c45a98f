//! Area lights, from the `extras` of a node or from EXT_lights_area.
//!
//! Core glTF has no area lights. A node carries one in its `extras`:
//! ```json
//! "extras": { "lightbench_area_light": {
//!   "shape": "rectangle", "width": 1.2, "height": 0.6,
//!   "color": [1.0, 0.9, 0.8], "intensity": 40.0, "range": 6.0, "two_sided": false
//! } }
//! ```
//!
//! | field | meaning | default |
//! |---|---|---|
//! | `shape` | `rectangle`, `polygon`, `disc`, `sphere` or `line` | none: required |
//! | `width`, `height` | size of a rectangle around the node's origin, along its X and Y axes, metres | none: required |
//! | `vertices` | vertices of a polygon, `[x, y, z]` in node space, metres: 3 to 10, plane, convex, counter-clockwise seen from the front | none: required |
//! | `radius` | radius of a disc, of a sphere, or of a line with round ends, around the node's origin, metres | none: required |
//! | `length` | distance between the middles of a line's round ends, along the node's X axis, metres | none: required |
//! | `color` | linear RGB | white |
//! | `intensity` | intensity along the normal, in the unit of a punctual light: radiance times area; a sphere has it in all directions, and a line across its axis | 1 |
//! | `range` | metres from the closest point of the emitter | as for a punctual light without a range ([`close_ranges`](crate::close_ranges)) |
//! | `two_sided` | whether a flat one emits from its back too | `false` |
//! | `diffuse_share` | where diffuse light ends, as a share of the range, above 0 and at most 1 | 1 |
//!
//! A rectangle and a disc emit along the node's -Z axis, like a camera or a spot. The node's scale changes
//! an emitter's size but not its intensity. A node that stretches a disc, a sphere or a line by different
//! factors along its axes is an error.
//!
//! Rectangles and discs of EXT_lights_area emit along -Z too, but their `intensity` is the
//! luminance. So the node's scale changes their size and the light that they give.

use std::f32::consts::TAU;

use assign::{Emitter, Light, MAX_VERTICES};
use glam::{Mat4, Vec3};
use gltf::json::scene::Node;
use serde::Deserialize;

use super::{Warnings, file::File, warnings::kept_name};
use crate::SceneError;

/// The key in a node's `extras`.
pub(super) const KEY: &str = "lightbench_area_light";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Json {
    shape: Shape,
    width: Option<f32>,
    height: Option<f32>,
    vertices: Option<Vec<[f32; 3]>>,
    radius: Option<f32>,
    length: Option<f32>,
    #[serde(default = "white")]
    color: [f32; 3],
    #[serde(default = "one")]
    intensity: f32,
    range: Option<f32>,
    #[serde(default)]
    two_sided: bool,
    #[serde(default = "one")]
    diffuse_share: f32,
}

#[derive(Deserialize)]
#[serde(rename_all = "lowercase")]
enum Shape {
    Rectangle,
    Polygon,
    Disc,
    Sphere,
    Line,
}

/// The factor by which a transform stretches all lengths alike; `None` if it stretches some more than others.
fn even_scale(to_world: Mat4) -> Option<f32> {
    let [x, y, z] = [0, 1, 2].map(|axis| to_world.col(axis).truncate());
    let scale = x.length();
    let slack = 1e-3 * scale;
    let is_even = (y.length() - scale).abs() <= slack && (z.length() - scale).abs() <= slack;
    let most = slack * scale;
    let is_square = x.dot(y).abs().max(y.dot(z).abs()).max(z.dot(x).abs()) <= most;
    (is_even && is_square).then_some(scale)
}

fn white() -> [f32; 3] {
    [1.0; 3]
}

fn one() -> f32 {
    1.0
}

/// The area lights that node `ix` carries. Faulty ones are kept, so that uploading reports them.
pub(super) fn of_node(
    file: &File,
    ix: usize,
    node: &Node,
    to_world: Mat4,
    warnings: &mut Warnings,
) -> Result<impl Iterator<Item = Light>, SceneError> {
    let extension = of_extension(file, ix, node, to_world, warnings)?;
    Ok(of_extras(file, ix, node, to_world)?.into_iter().chain(extension))
}

fn of_extras(
    file: &File,
    ix: usize,
    node: &Node,
    to_world: Mat4,
) -> Result<Option<Light>, SceneError> {
    let Some(extras) = &node.extras else {
        return Ok(None);
    };
    let Ok(mut extras) = serde_json::from_str::<serde_json::Value>(extras.get()) else {
        return Ok(None);
    };
    let Some(value) = extras.get_mut(KEY).map(serde_json::Value::take) else {
        return Ok(None);
    };
    let field = || format!("nodes[{ix}].extras.{KEY}");
    let text = value.to_string();
    let refuse = |accepted: String| file.invalid(field(), text.clone(), accepted);
    let json: Json = serde_json::from_value(value)
        .map_err(|error| refuse(format!("a valid area light: {error}")))?;
    // A mirroring transform reverses the outline.
    let mirrored = to_world.determinant() < 0.0;
    let is_round = json.radius.is_some() || json.length.is_some();
    let (emitter, position) = match (json.shape, json.width, json.height, json.vertices) {
        (shape @ (Shape::Disc | Shape::Sphere | Shape::Line), None, None, None) => {
            let scale = even_scale(to_world).ok_or_else(|| {
                let accepted =
                    "a node that stretches a disc, a sphere or a line alike along all axes";
                refuse(accepted.into())
            })?;
            let emitter = match (shape, json.radius, json.length) {
                (Shape::Disc, Some(radius), None) if radius > 0.0 => {
                    Emitter::disc(to_world.transform_vector3(Vec3::NEG_Z), radius * scale)
                }
                (Shape::Sphere, Some(radius), None) if radius > 0.0 => {
                    Emitter::sphere(radius * scale)
                }
                (Shape::Line, Some(radius), Some(length)) if radius > 0.0 && length > 0.0 => {
                    let half = to_world.transform_vector3(Vec3::X * 0.5 * length);
                    Emitter::line(half, radius * scale)
                }
                _ => {
                    let accepted = "a disc or a sphere with a radius above 0, or a line with length and \
                                    radius above 0";
                    return Err(refuse(accepted.into()));
                }
            };
            (emitter, to_world.transform_point3(Vec3::ZERO))
        }
        (Shape::Rectangle | Shape::Polygon, ..) if is_round => {
            let accepted = "radius only for a disc, a sphere or a line, and length only for a line";
            return Err(refuse(accepted.into()));
        }
        (Shape::Rectangle, Some(width), Some(height), None) if !(width > 0.0 && height > 0.0) => {
            return Err(refuse("a rectangle with width and height above 0".into()));
        }
        (Shape::Rectangle, Some(width), Some(height), None) => {
            let x = to_world.transform_vector3(Vec3::X * 0.5 * width);
            let y = to_world.transform_vector3(Vec3::NEG_Y * 0.5 * height);
            let y = if mirrored { -y } else { y };
            (Emitter::rectangle(x, y), to_world.transform_point3(Vec3::ZERO))
        }
        (Shape::Polygon, None, None, Some(vertices)) => {
            let to_world = |v: &[f32; 3]| to_world.transform_point3(Vec3::from(*v));
            let mut world: Vec<Vec3> = vertices.iter().map(to_world).collect();
            if mirrored {
                world.reverse();
            }
            Emitter::polygon(&world).map_err(|fault| refuse(format!("sound, but: {fault}")))?
        }
        _ => {
            let accepted = "a rectangle with width and height, a polygon with vertices, a disc or a sphere \
                            with radius, or a line with length and radius";
            return Err(refuse(accepted.into()));
        }
    };
    let emitter = if json.two_sided { emitter.two_sided() } else { emitter };
    let emitter = emitter.with_diffuse_share(json.diffuse_share);
    let intensity = Vec3::from(json.color) * json.intensity;
    Ok(Some(Light::area(emitter, position, json.range.unwrap_or(f32::INFINITY), intensity)))
}

/// The extension's name, on nodes and at the root.
pub(super) const EXTENSION: &str = "EXT_lights_area";

/// One light of EXT_lights_area.
#[derive(Deserialize)]
struct ExtensionJson<'a> {
    name: Option<&'a str>,
    #[serde(rename = "type")]
    kind: &'a str,
    #[serde(default = "white")]
    color: [f32; 3],
    /// Luminance, candela per square metre.
    #[serde(default = "one")]
    intensity: f32,
    /// Height of a rectangle, diameter of a disc, metres.
    #[serde(default = "one")]
    size: f32,
    #[serde(default)]
    rect: RectangleJson,
}

#[derive(Deserialize)]
struct RectangleJson {
    /// Width over height.
    #[serde(default = "one")]
    aspect: f32,
}

impl Default for RectangleJson {
    fn default() -> Self {
        Self { aspect: 1.0 }
    }
}

/// The light of EXT_lights_area that a node refers to.
fn of_extension(
    file: &File,
    ix: usize,
    node: &Node,
    to_world: Mat4,
    warnings: &mut Warnings,
) -> Result<Option<Light>, SceneError> {
    let Some(reference) = node.extensions.as_ref().and_then(|e| e.others.get(EXTENSION)) else {
        return Ok(None);
    };
    let root = file.root.extensions.as_ref().and_then(|e| e.others.get(EXTENSION));
    let lights = root.and_then(|e| e.get("lights")?.as_array()).map_or(&[][..], Vec::as_slice);
    let number = reference.get("light").unwrap_or(&serde_json::Value::Null);
    let found = number.as_u64().and_then(|n| lights.get(usize::try_from(n).ok()?));
    let value = found.ok_or_else(|| {
        let field = format!("nodes[{ix}].extensions.{EXTENSION}.light");
        file.invalid(field, number, format!("below {}, the number of its lights", lights.len()))
    })?;
    let field = || format!("extensions.{EXTENSION}.lights[{number}]");
    // The JSON is borrowed because many nodes may name one light with a long name.
    let json = ExtensionJson::deserialize(value)
        .map_err(|error| file.invalid(field(), value, format!("a valid area light: {error}")))?;
    let (width, height) = (json.size * json.rect.aspect, json.size);
    if !(width > 0.0 && height > 0.0 && width.is_finite()) {
        return Err(file.invalid(field(), value, "a light with size and aspect above 0"));
    }
    let name = json.name.map_or_else(|| format!("area light {number}"), kept_name);
    // A mirroring transform reverses the outline.
    let side = if to_world.determinant() < 0.0 { -1.0 } else { 1.0 };
    let place = |x: f32, y: f32| to_world.transform_vector3(Vec3::new(x, y * side, 0.0));
    let position = to_world.transform_point3(Vec3::ZERO);
    let (emitter, position) = match json.kind {
        "rect" => {
            let half_y = place(0.0, -0.5 * height);
            (Emitter::rectangle(place(0.5 * width, 0.0), half_y), position)
        }
        "disc" if even_scale(to_world).is_some() => {
            let scale = even_scale(to_world).unwrap_or_default();
            let normal = to_world.transform_vector3(Vec3::NEG_Z);
            (Emitter::disc(normal, 0.5 * height * scale), position)
        }
        "disc" => {
            warnings.add(format!(
                "light {name:?}: a disc that its node stretches to an ellipse is drawn as a polygon of \
                 {MAX_VERTICES} vertices and the same area"
            ));
            // The area of a regular polygon is n / 2 r^2 sin(2 pi / n).
            let step = TAU / MAX_VERTICES as f32;
            let radius = 0.5 * height * (step / step.sin()).sqrt();
            let vertex = |ix: usize| {
                let (sin, cos) = (step * ix as f32).sin_cos();
                position + place(radius * cos, -radius * sin)
            };
            let vertices: Vec<Vec3> = (0..MAX_VERTICES).map(vertex).collect();
            match Emitter::polygon(&vertices) {
                Ok(polygon) => polygon,
                Err(fault) => {
                    warnings.add(format!("light {name:?} of {EXTENSION} is left out: {fault}"));
                    return Ok(None);
                }
            }
        }
        other => {
            warnings.add(format!(
                "light {name:?} is left out: {EXTENSION} type {other:?} is not supported"
            ));
            return Ok(None);
        }
    };
    // Intensity is radiance times area.
    let intensity = Vec3::from(json.color) * json.intensity * emitter.area();
    Ok(Some(Light::area(emitter, position, f32::INFINITY, intensity)))
}
