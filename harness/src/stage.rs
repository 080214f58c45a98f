//! The scene, lights and camera of a comparison, ready to draw.

use assign::{Gpu, LightBuffer, LightKind, RejectedLight, Suns, View};
use glam::DVec3;
use scenes::{Aabb, Dielectric, Material, Pose, Scene, primary_light, scatter_particles};
use shading::{AreaModel, LayerOptions, Renderer, ShadowModel};

use crate::{
    camera,
    cli::{CliError, LayerArgs, StageArgs},
    error::HarnessError,
    moving::{Moving, kinds_of},
    open_lights::OpenLights,
    optics::Optics,
    results::{DeepImages, Planes, Vpls},
    stage_lights::Lit,
    vpls::{Bounce, Made, VplMaker},
};

/// What all strategies of a run share.
pub struct Stage {
    /// The scene.
    pub scene: Scene,
    /// Its content hash.
    pub scene_hash: String,
    /// Factor on the radii of the scattered lights.
    pub radius_scale: f64,
    /// Where lights were scattered.
    pub light_box: Aabb,
    /// The number of the scene's own lights among all lights.
    pub own_lights: usize,
    /// Lights whose file gives no range.
    pub open_lights: Option<OpenLights>,
    /// Suns, which light all samples and stand in no list.
    pub suns: Suns,
    /// The lights without the faulty ones.
    pub lights: LightBuffer,
    /// How they move, if they do.
    pub moving: Option<Moving>,
    /// How area lights are shaded.
    pub area_model: AreaModel,
    /// With `--compensate N`, the number N.
    pub compensation: Option<f32>,
    /// With `--specular-reach N`, the number N.
    pub specular_reach: Option<f32>,
    /// The solid angle below which an area light is a point, steradians.
    pub area_lod: Option<f32>,
    /// How lights are shadowed. The renderer has the maps.
    pub shadows: ShadowModel,
    /// The time that drawing the maps once takes, ms, if there are any.
    pub(crate) shadow_draw_ms: Option<f64>,
    /// The time in which the CPU planned the maps of the last frame's lights, ms, if they move.
    pub(crate) shadow_plan_ms: Option<f64>,
    /// With an adaptive model: frames until the maps had settled, and the time of the test for bands, ms.
    pub(crate) shadow_rounds: Option<(u32, Option<f64>)>,
    /// The deep images that rays of shadows cross, if there are any.
    pub(crate) shadow_images: Option<DeepImages>,
    /// How the virtual point lights were made, if the lights are such.
    pub vpls: Option<Vpls>,
    /// What makes them in every frame, if they stay on the GPU.
    pub bounce: Option<Bounce>,
    /// The camera.
    pub view: View,
    /// Notes about the view, one sentence each, such as surfaces that the camera's planes cut away.
    pub notes: Vec<String>,
    /// The pipeline.
    pub renderer: Renderer,
    pub(crate) vpl_maker: VplMaker,
    /// Virtual point lights that the GPU found faulty.
    faulty_vpls: u32,
    optics: Optics,
    /// The size of the image that the arguments ask for, pixels.
    size: [u32; 2],
    /// The diagonal of the scene's core before it was scaled, metres.
    unscaled_m: f32,
    /// Whether the camera walks along the scene's path.
    walks: bool,
    pub(crate) gpu: Gpu,
}

/// The view and the lights that the arguments give a scene.
struct Set {
    optics: Optics,
    view: View,
    notes: Vec<String>,
    radius_scale: f64,
    lit: Lit,
}

impl Set {
    fn new(scene: &Scene, unscaled_m: f32, args: &StageArgs) -> Result<Self, HarnessError> {
        let mut optics = Optics::new(scene, args)?;
        let size = [args.size.width, args.size.height];
        let pose = camera::pose(scene, args)?;
        optics.fit_near(scene, &[optics.view(scene, pose, size)]);
        let view = optics.view(scene, pose, size);
        let notes = optics.notes(scene, &[view]);
        let radius_scale = args.radius_scale.unwrap_or_else(|| radius_scale_of(unscaled_m));
        let lit = Lit::new(scene, radius_scale, args)?;
        Ok(Self { optics, view, notes, radius_scale, lit })
    }
}

impl Stage {
    /// Opens the scene, makes the lights and uploads both.
    pub fn new(gpu: &Gpu, args: &StageArgs) -> Result<Self, HarnessError> {
        let mut stage = Self::under_scattered_lights(gpu, args)?;
        stage.bounce(gpu, args)?;
        stage.move_lights(0)?;
        Ok(stage)
    }

    fn under_scattered_lights(gpu: &Gpu, args: &StageArgs) -> Result<Self, HarnessError> {
        let scene = scenes::open_seeded(&args.scene, args.seed)?;
        let unscaled_m = scene.core_bounds.diagonal();
        let scene = scene.scaled(args.scene_scale)?.replicated(args.replicate)?;
        let mut scene = scene.with_roughness(args.roughness)?;
        if args.bounce.is_on() {
            // Only the primary light may light the image, as in the truth.
            scene = scene.without_emission();
        }
        let Set { optics, view, notes, radius_scale, lit } = Set::new(&scene, unscaled_m, args)?;
        if let Some(animation) =
            scene.light_animation.as_ref().filter(|_| args.motion.motion.is_none())
        {
            scene.warnings.push(format!(
                "the file animates {} of its lights: they stand still without --motion file",
                animation.count()
            ));
        }
        scene.warnings.extend(lit.warnings.iter().map(|line| format!("--lights-from: {line}")));
        Ok(Self {
            scene_hash: scene.hash(),
            radius_scale,
            light_box: lit.bounds,
            own_lights: lit.own,
            open_lights: lit.open,
            suns: lit.suns,
            lights: LightBuffer::ordered(gpu, &lit.lights, args.light_order())?,
            moving: Moving::new(gpu, args, &scene, lit.lights)?,
            area_model: AreaModel::default(),
            compensation: None,
            specular_reach: None,
            area_lod: None,
            shadows: ShadowModel::None,
            shadow_draw_ms: None,
            shadow_plan_ms: None,
            shadow_rounds: None,
            shadow_images: None,
            vpls: None,
            bounce: None,
            vpl_maker: VplMaker::default(),
            faulty_vpls: 0,
            renderer: Renderer::new(gpu, &scene, &optics.target(&view))?,
            size: [args.size.width, args.size.height],
            scene,
            view,
            notes,
            optics,
            unscaled_m,
            walks: false,
            gpu: gpu.clone(),
        })
    }

    /// Replaces lights and camera by those of other arguments, which must name the same scene at the same
    /// scale.
    pub fn set_up(&mut self, gpu: &Gpu, args: &StageArgs) -> Result<(), HarnessError> {
        let Set { optics, view, notes, radius_scale, lit } =
            Set::new(&self.scene, self.unscaled_m, args)?;
        self.radius_scale = radius_scale;
        self.light_box = lit.bounds;
        self.own_lights = lit.own;
        self.open_lights = lit.open;
        self.suns = lit.suns;
        self.lights = LightBuffer::ordered(gpu, &lit.lights, args.light_order())?;
        self.moving = Moving::new(gpu, args, &self.scene, lit.lights)?;
        self.walks = false;
        self.view = view;
        self.notes = notes;
        self.optics = optics;
        self.size = [args.size.width, args.size.height];
        self.bounce(gpu, args)?;
        self.move_lights(0)
    }

    /// Moves the lights to where they are in a frame, if they move. Lights that every frame makes are sorted
    /// again if their order is old.
    fn move_lights(&mut self, frame: u32) -> Result<(), HarnessError> {
        match (&mut self.moving, &self.bounce) {
            (Some(moving), _) => {
                moving.go_to(&self.gpu, frame, &mut self.lights)?;
                self.move_shadows()
            }
            (None, Some(bounce)) => Ok(self.lights.update_from_gpu(&self.gpu, &bounce.lights())?),
            (None, None) => Ok(()),
        }
    }

    /// With `--primary` or `--vpls`, replaces the lights by the primary light or by its reflections.
    fn bounce(&mut self, gpu: &Gpu, args: &StageArgs) -> Result<(), HarnessError> {
        (self.vpls, self.bounce, self.faulty_vpls) = (None, None, 0);
        if !args.bounce.is_on() {
            return Ok(());
        }
        let primary = primary_light(&self.scene);
        self.own_lights = 0;
        if args.bounce.primary {
            self.lights = LightBuffer::ordered(gpu, &[primary], args.light_order())?;
            return Ok(());
        }
        let Made { lights, bounce, figures, faulty } =
            self.vpl_maker.make(gpu, &self.scene, &self.renderer, primary, args)?;
        (self.lights, self.bounce) = (lights, bounce);
        (self.vpls, self.faulty_vpls) = (Some(figures), faulty);
        self.note_vpls();
        Ok(())
    }

    /// Sets what is drawn over the opaque surfaces. Particles are scattered where lights are by default.
    pub fn show_layers(&mut self, args: &LayerArgs, seed: u64) -> Result<(), HarnessError> {
        let options = LayerOptions {
            sheets: args.transparent,
            particles: match args.particles {
                // A scene without triangles has no room, and needs none.
                0 => Vec::new(),
                count => scatter_particles(count, seed, self.scene.core_bounds)?,
            },
            fog_per_m: args.fog.map(|density| density as f32),
        };
        if options.sheets && !self.scene.materials.iter().any(Material::is_transparent) {
            let accepted = "left out, because no material of the scene is transparent (alphaMode BLEND or \
                            KHR_materials_transmission)";
            return Err(CliError::out_of_range("--transparent", "given", accepted).into());
        }
        Ok(self.renderer.show_layers(&options)?)
    }

    /// Sets the samples per pixel, 1 or 4.
    pub fn sample_pixels(&mut self, samples: u32) -> Result<(), HarnessError> {
        if self.renderer.samples() != samples {
            self.renderer.sample_pixels(&self.optics.target(&self.view), samples)?;
        }
        Ok(())
    }

    /// Uploads the camera, untimed, and binds the lights.
    pub fn prepare(&mut self) -> Result<(), HarnessError> {
        Ok(self.renderer.prepare(&self.view, &self.lights)?)
    }

    /// Moves to frame `frame` of `count`: the camera along the scene's path, if it
    /// [follows](Self::follow_path) it, and the lights, if they move.
    pub fn go_to(&mut self, frame: u32, count: u32) -> Result<(), HarnessError> {
        if self.walks {
            let pose = self.scene.path.pose(frame, count);
            self.view = self.optics.view(&self.scene, pose, self.size);
        }
        self.move_lights(frame)?;
        self.prepare()
    }

    /// Puts the camera at a pose, which the next [`go_to`](Self::go_to) or [`prepare`](Self::prepare) uploads. The
    /// planes stay, so surfaces may be cut away.
    pub fn stand_at(&mut self, pose: Pose) {
        let size = [self.view.viewport.width, self.view.viewport.height];
        self.walks = false;
        self.view = self.optics.view(&self.scene, pose, size);
    }

    /// Moves the near plane in front of every surface in the view and in `count` poses of the path, unless an
    /// option or the file sets it.
    pub fn follow_path(&mut self, count: u32) {
        self.walks = true;
        let pose = |frame| self.scene.path.pose(frame, count);
        let mut views: Vec<View> =
            (0..count).map(|frame| self.optics.view(&self.scene, pose(frame), self.size)).collect();
        views.push(self.view);
        self.optics.fit_near(&self.scene, &views);
        self.optics.place_near(&mut self.view);
        views.iter_mut().for_each(|view| self.optics.place_near(view));
        self.notes = self.optics.notes(&self.scene, &views);
        self.note_vpls();
    }

    /// Adds notes about materials that virtual point lights simplify, and about faulty lights.
    fn note_vpls(&mut self) {
        if self.faulty_vpls > 0 {
            let faulty = self.faulty_vpls;
            self.notes.push(format!("{faulty} virtual point lights are faulty and light nothing"));
        }
        if self.vpls.is_some() && self.has_dielectrics() {
            self.notes.push(
                "surfaces send out virtual point lights as plain dielectrics would: \
                 KHR_materials_ior and KHR_materials_specular change only how a surface reflects \
                 light that reaches it"
                    .to_owned(),
            );
        }
    }

    /// Has the next frame sort the lights anew, also if it is the frame that is shown.
    pub fn expire_order(&mut self) {
        self.lights.expire_order();
        if let Some(moving) = &mut self.moving {
            moving.forget_frame();
        }
    }

    /// Whether a material differs from glTF's default dielectric.
    pub fn has_dielectrics(&self) -> bool {
        let plain = Dielectric::default();
        self.scene.materials.iter().any(|material| !material.unlit && material.dielectric != plain)
    }

    /// The eye in the coordinates of the scene's file, metres.
    pub fn eye(&self) -> DVec3 {
        self.scene.origin + self.view.eye().as_dvec3()
    }

    /// The lights that are left out because they are faulty; of lights that move, at rest.
    pub fn rejected(&self) -> &[RejectedLight] {
        match &self.moving {
            Some(moving) => moving.rejected(),
            None => self.lights.rejected(),
        }
    }

    /// Counts the lights that are faulty in the frame that was drawn last, if lights move. It waits for the
    /// GPU.
    pub fn count_left_out(&mut self) -> Result<(), HarnessError> {
        match &mut self.moving {
            Some(moving) => Ok(moving.count_left_out(&self.gpu, &self.lights)?),
            None => Ok(()),
        }
    }

    /// Time in which the CPU ordered the lights and built the hierarchy over them, ms; `None` if that is part
    /// of the pass `upload`, or the GPU's work.
    pub fn light_build_ms(&self) -> Option<f64> {
        let is_once = self.moving.is_none() && !self.lights.order().is_on_gpu();
        is_once.then(|| self.lights.build_time().as_secs_f64() * 1e3)
    }

    /// Near and far plane of the view.
    pub fn planes(&self) -> Planes {
        self.optics.planes(&self.view)
    }

    /// The number of lights. Lights that frames make were counted once, before the frames.
    pub fn light_count(&self) -> u64 {
        match (&self.bounce, &self.vpls) {
            (Some(_), Some(vpls)) => vpls.kept,
            _ => u64::from(self.lights.count()),
        }
    }

    /// Lights of each kind, by name, and suns. Lights that the GPU moves count as at rest.
    pub fn light_kinds(&self) -> [(&'static str, u64); 9] {
        let mut kinds = match &self.moving {
            Some(moving) => moving.kinds(),
            None => kinds_of(self.lights.lights()),
        };
        if self.bounce.is_some() {
            kinds[LightKind::Vpl as usize] = self.light_count();
        }
        let count = |kind: LightKind| kinds[kind as usize];
        [
            ("point", count(LightKind::Point)),
            ("spot", count(LightKind::Spot)),
            ("rectangle", count(LightKind::Rectangle)),
            ("polygon", count(LightKind::Polygon)),
            ("disc", count(LightKind::Disc)),
            ("sphere", count(LightKind::Sphere)),
            ("line", count(LightKind::Line)),
            ("vpl", count(LightKind::Vpl)),
            ("sun", self.suns.as_slice().len() as u64),
        ]
    }
}

/// The factor that makes scattered lights as large in their scene as lights of one metre are in a hall: lights
/// of one metre would leave a town dark. Rooms and halls keep the comparison paper's radii.
fn radius_scale_of(diagonal_m: f32) -> f64 {
    let diagonal_m = f64::from(diagonal_m);
    (diagonal_m / diagonal_m.clamp(10.0, 60.0)).clamp(1e-6, 1e6)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn halls_keep_the_papers_radii_and_towns_get_larger_ones() {
        assert_eq!(radius_scale_of(28.9), 1.0);
        assert_eq!(radius_scale_of(600.0), 10.0);
        assert_eq!(radius_scale_of(1.0), 0.1);
        assert_eq!(radius_scale_of(0.0), 1e-6);
    }
}
