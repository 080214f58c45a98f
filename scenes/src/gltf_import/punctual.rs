//! Reads lights of KHR_lights_punctual: points, spots and suns.

use std::f32::consts::FRAC_PI_4;

use assign::{Light, LightShape, Sun};
use glam::{DMat4, Vec3};
use gltf::json::{
    extensions::scene::khr_lights_punctual::{Light as JsonLight, Type as LightType},
    scene::Node,
    validation::Checked,
};

use super::{Warnings, file::File, placed::Placed, warnings::kept_name};
use crate::{Pose, SceneError};

impl Placed {
    /// Adds the light that a node carries. A faulty sun is left out with a warning. Other faulty
    /// lights are kept, so that uploading reports them.
    pub(super) fn add_light(
        &mut self,
        file: &File,
        node: &Node,
        to_world: &DMat4,
        warnings: &mut Warnings,
    ) -> Result<(), SceneError> {
        let Some(ix) = light_of(node) else {
            return Ok(());
        };
        let lights = lights(file);
        let json = lights.get(ix).ok_or_else(|| {
            file.invalid("KHR_lights_punctual.light", ix, format!("below {}", lights.len()))
        })?;
        let intensity = Vec3::from(json.color) * json.intensity;
        let pose = Pose::of_node(to_world);
        let direction = pose.forward();
        let shape = match json.type_ {
            Checked::Valid(LightType::Point) => LightShape::Point,
            Checked::Valid(LightType::Spot) => spot(json, direction),
            Checked::Valid(LightType::Directional) => {
                let sun = Sun { direction, irradiance: intensity };
                match sun.check() {
                    Ok(()) => self.suns.push(sun),
                    Err(fault) => warnings.add(format!("{} is left out: {fault}", name(json, ix))),
                }
                return Ok(());
            }
            Checked::Invalid => {
                warnings.add(format!("{} is left out: its type is unknown", name(json, ix)));
                return Ok(());
            }
        };
        self.lights.push(Light {
            position: pose.eye,
            // `close_ranges` chooses this range later, from the size of the scene.
            range_m: json.range.unwrap_or(f32::INFINITY),
            intensity,
            shape,
        });
        Ok(())
    }
}

/// The index of the light that a node carries.
fn light_of(node: &Node) -> Option<usize> {
    let extension = node.extensions.as_ref()?.khr_lights_punctual.as_ref()?;
    Some(extension.light.value())
}

/// The lights of the file.
fn lights(file: &File) -> &[JsonLight] {
    let of_root = file.root.extensions.as_ref().and_then(|e| e.khr_lights_punctual.as_ref());
    of_root.map_or(&[][..], |e| &e.lights)
}

/// Whether a node carries a directional light.
pub(super) fn is_sun(file: &File, node: &Node) -> bool {
    let light = light_of(node).and_then(|ix| lights(file).get(ix));
    light.is_some_and(|light| matches!(light.type_, Checked::Valid(LightType::Directional)))
}

/// The cone of a spot. Missing angles get the specification's defaults.
fn spot(json: &JsonLight, direction: Vec3) -> LightShape {
    let [inner, outer] = json
        .spot
        .as_ref()
        .map_or([0.0, FRAC_PI_4], |spot| [spot.inner_cone_angle, spot.outer_cone_angle]);
    LightShape::Spot { direction, inner_angle: inner.min(outer), outer_angle: outer }
}

fn name(json: &JsonLight, ix: usize) -> String {
    format!("light {:?}", json.name.as_deref().map_or_else(|| format!("light {ix}"), kept_name))
}
