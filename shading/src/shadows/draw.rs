//! Draws shadow maps, and what hides lights from groups.

use assign::{Gpu, Occluders, Passes};

use super::{OccluderDepth, Pyramid, ShadowMaps, sight::Sight};
use crate::{ShadingError, geometry::SceneGpu};

impl ShadowMaps {
    /// Records the pass `shadow-maps`: the depth of all triangles that a face may show.
    pub(crate) fn record(
        &mut self,
        scene: &SceneGpu,
        scene_group: &wgpu::BindGroup,
        passes: &mut dyn Passes,
    ) {
        // Nothing is infinitely far.
        self.draw(scene, scene_group, &self.drawn, wgpu::LoadOp::Clear(0.0), passes);
        (self.is_drawn, self.has_occluders) = (true, false);
    }

    /// Draws some faces. Unless the whole atlas is cleared, each of them is.
    pub(super) fn draw(
        &self,
        scene: &SceneGpu,
        scene_group: &wgpu::BindGroup,
        faces: &[u32],
        load: wgpu::LoadOp<f32>,
        passes: &mut dyn Passes,
    ) {
        let clear = self.adaptive.as_ref().map(|adaptive| &adaptive.clear_face);
        let clear = clear.filter(|_| load == wgpu::LoadOp::Load);
        let descriptor = wgpu::RenderPassDescriptor {
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: self.bound.atlas(),
                depth_ops: Some(wgpu::Operations { load, store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..Default::default()
        };
        passes.render("shadow-maps", &descriptor, &mut |pass| {
            for ix in faces {
                let face = &self.faces[*ix as usize];
                let ([x, y], [width, height]) = (face.origin, face.size);
                pass.set_viewport(x as f32, y as f32, width as f32, height as f32, 0.0, 1.0);
                pass.set_scissor_rect(x, y, width, height);
                if let Some(clear) = clear {
                    pass.set_pipeline(clear);
                    pass.draw(0..3, 0..1);
                }
                pass.set_bind_group(0, &self.views.group, &[*ix * self.views.stride]);
                pass.set_bind_group(2, scene_group, &[]);
                let sight = Sight::new(face, self.asked.ranges);
                let may_see = |bounds| sight.may_see(bounds);
                let curved = self.curved.as_ref().filter(|_| face.is_curved);
                let textures = curved.is_some() || scene.has_mask();
                let pipelines = curved.unwrap_or(&self.pipelines);
                let pipeline = |key| pipelines.get(key);
                scene.draw_pieces(pass, (textures, self.asked.only_opaque), may_see, pipeline);
            }
        });
    }

    /// Records the pass `occluders`, if it was asked for.
    pub(crate) fn record_occluders(&mut self, passes: &mut dyn Passes) {
        if let Some(pyramid) = &self.pyramid {
            pyramid.record(passes);
            self.has_occluders = true;
        }
    }

    /// Makes the pyramid of depths. [`record_occluders`](Self::record_occluders) fills it.
    pub(crate) fn make_pyramid(
        &mut self,
        gpu: &Gpu,
        kept: OccluderDepth,
    ) -> Result<(), ShadingError> {
        let pyramid = Pyramid::new(gpu, self.bound.atlas(), self.figures.atlas_px, kept)?;
        self.figures.occluder_bytes = pyramid.bytes();
        self.pyramid = Some(pyramid);
        Ok(())
    }

    /// What hides lights from groups; `None` without a pyramid.
    pub(crate) fn occluders(&self) -> Option<Occluders<'_>> {
        Some(self.pyramid.as_ref()?.occluders(self.bound.records()))
    }
}
