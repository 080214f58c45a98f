//! Area lights: the `extras` of a node.
//!
//! glTF has no area lights. A node carries one as
//!
//! ```json
//! "extras": { "lightbench_area_light": {
//!   "shape": "rectangle", "width": 1.2, "height": 0.6,
//!   "color": [1.0, 0.9, 0.8], "intensity": 40.0, "range": 6.0, "two_sided": false
//! } }
//! ```
//!
//! | field | what | without it |
//! |---|---|---|
//! | `shape` | `rectangle` or `polygon` | refused |
//! | `width`, `height` | of a rectangle around the node's origin, along its X and Y, metres | refused |
//! | `vertices` | of a polygon, `[x, y, z]` in node space, metres: 3 to 10, plane, convex, counter-clockwise seen from the front | refused |
//! | `color` | linear RGB | white |
//! | `intensity` | along the normal, as of a punctual light: radiance times area | 1 |
//! | `range` | metres from the closest point of the emitter | as of a punctual light without one ([`close_ranges`](crate::close_ranges)) |
//! | `two_sided` | whether it emits from its back too | `false` |
//! | `diffuse_share` | where diffuse light ends, as a share of the range, above 0 and at most 1 | 1 |
//!
//! A rectangle emits along the node's -Z, as cameras look and spots shine. Scale acts on its size,
//! not on its intensity.
//!
//! The other form is EXT_lights_area. Its rectangles and discs emit along -Z too, and their
//! `intensity` is the luminance: scale acts on their size, and so on the light they give.

use std::f32::consts::TAU;

use assign::{Emitter, Light, MAX_VERTICES};
use glam::{Mat4, Vec3};
use gltf::json::scene::Node;
use serde::Deserialize;

use super::{Warnings, file::File};
use crate::{SceneError, lights::THRESHOLD};

/// The key in a node's `extras`.
pub(super) const KEY: &str = "lightbench_area_light";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct Json {
    shape: Shape,
    width: Option<f32>,
    height: Option<f32>,
    vertices: Option<Vec<[f32; 3]>>,
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
}

fn white() -> [f32; 3] {
    [1.0; 3]
}

fn one() -> f32 {
    1.0
}

/// The area lights that node `ix` carries. Faulty ones are converted too, to be reported where
/// lights are uploaded.
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
        .map_err(|error| refuse(format!("an area light, but: {error}")))?;
    // A mirroring transform turns outlines round.
    let mirrored = to_world.determinant() < 0.0;
    let (emitter, position) = match (json.shape, json.width, json.height, json.vertices) {
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
            let accepted = "a rectangle with width and height, or a polygon with vertices";
            return Err(refuse(accepted.into()));
        }
    };
    let emitter = if json.two_sided { emitter.two_sided() } else { emitter };
    let emitter = emitter.with_diffuse_share(json.diffuse_share);
    let intensity = Vec3::from(json.color) * json.intensity;
    use super::{Warnings, file::File};
    use crate::SceneError;
}
