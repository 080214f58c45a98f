//! Maps that follow lights which the CPU moves.
//!
//! Each frame plans the maps again, because a map looks from where its light is. The atlas, the records and the views keep
//! their buffers, so shaders stay bound. A frame may have fewer lights than shadows were cast for, never more maps than the
//! atlas holds.

use assign::{AssignError, Gpu, LightBuffer};
use bytemuck::cast_slice;

use super::{ShadowMaps, plan::Plan};
use crate::{ShadingError, ShadowModel};

impl ShadowMaps {
    /// Plans the maps for other lights, and uploads where they look. They must be drawn again. Returns false if the lights
    /// are those that the maps are for.
    ///
    /// # Errors
    ///
    /// [`AssignError::Unsupported`] for lights that the CPU does not know and for models that frames subdivide, and
    /// [`AssignError::Parameter`] if the atlas is too small. The maps then stay as they are.
    pub(crate) fn follow(&mut self, gpu: &Gpu, lights: &LightBuffer) -> Result<bool, ShadingError> {
        let model = self.asked.model;
        check_known(model, lights)?;
        if lights.lights() == self.lights {
            return Ok(false);
        }
        if model.is_adaptive() {
            return Err(AssignError::Unsupported {
                strategy: format!("shadow model {model}"),
                asked: "lights that move".into(),
                reason: "its trees settle in frames with the same lights: maps:N,PX serves them"
                    .into(),
            }
            .into());
        }
        let [width, height] = self.figures.atlas_px;
        let columns = width / model.px();
        let plan = Plan::place(
            lights.lights(),
            self.asked.sunny,
            model,
            (self.figures.maps_per_area_light, columns),
        );
        let records: &[u8] = cast_slice(&plan.records);
        let fits = plan.size[1] <= height
            && plan.faces.len() <= self.capacity
            && records.len() as u64 <= self.bound.records().size();
        if !fits {
            return Err(AssignError::Parameter {
                field: "lights with shadow maps".into(),
                value: format!("{} with {} faces", lights.lights().len(), plan.faces.len()),
                accepted: format!(
                    "at most as many as fit the atlas of {width}x{height} texels with {} faces for which shadows were \
                     cast: call Renderer::cast_shadows for all lights of all frames",
                    self.capacity
                ),
            }
            .into());
        }
        gpu.queue.write_buffer(self.bound.records(), 0, records);
        self.views.write(gpu, &plan.faces);
        self.figures.maps = plan.map_count + self.asked.sunny.squares();
        self.figures.faces = plan.faces.len() as u32;
        self.drawn = (0..self.figures.faces).collect();
        self.faces = plan.faces;
        self.lights.clear();
        self.lights.extend_from_slice(lights.lights());
        (self.is_drawn, self.has_occluders) = (false, false);
        Ok(true)
    }
}

/// Refuses lights whose slots the CPU does not know.
pub(super) fn check_known(model: ShadowModel, lights: &LightBuffer) -> Result<(), AssignError> {
    if !lights.order().is_on_gpu() && lights.live_count().is_none() {
        return Ok(());
    }
    Err(AssignError::Unsupported {
        strategy: format!("shadow model {model}"),
        asked: "lights that the GPU moves, makes or orders".into(),
        reason: "the CPU chooses points of the lights, and must know the lights and their order"
            .into(),
    })
}
