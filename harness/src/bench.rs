//! A device, with the scene that was drawn last: runs that follow one another share it.

use std::sync::Arc;

use assign::Gpu;
use scenes::{Scene, stability::PREFIX};
use shading::{ShadowModel, WorldTriangles};

use crate::{
    cli::StageArgs,
    described::describe,
    error::HarnessError,
    machine::machine,
    messages::{say, say_error},
    out_folder::leave_all,
    results::Machine,
    shadows::Casting,
    stage::Stage,
};

/// A device with the scene that was drawn last.
pub struct Bench {
    gpu: Gpu,
    machine: Machine,
    stage: Option<(String, Stage)>,
    triangles: Option<(String, Scene, WorldTriangles)>,
}

impl Bench {
    /// Opens a device.
    pub fn open(adapter: Option<&str>) -> Result<Self, HarnessError> {
        let gpu = Gpu::open(adapter)?;
        end_on_device_error(&gpu);
        let machine = machine(&gpu);
        say(format!("adapter  {} ({}, {})", machine.adapter, machine.backend, machine.driver));
        Ok(Self { gpu, machine, stage: None, triangles: None })
    }

    /// The machine that results come from.
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// The device.
    pub fn gpu(&self) -> &Gpu {
        &self.gpu
    }

    /// The stage that arguments ask for; the scene is opened once while it stays the same.
    pub fn stage(&mut self, args: &StageArgs) -> Result<&mut Stage, HarnessError> {
        let bounce = args.bounce.is_on();
        // Only scenarios depend on the seed.
        let seed = args.scene.starts_with(PREFIX).then_some(args.seed);
        let StageArgs { scene, scene_scale, replicate, roughness, .. } = args;
        let key = format!("{scene} {scene_scale} {replicate} {roughness:?} {bounce} {seed:?}");
        let (_, stage) = match self.stage.take().filter(|(known, _)| *known == key) {
            Some((key, mut stage)) => {
                // The maps are those of other lights.
                stage.cast_shadows(ShadowModel::None, Casting::default())?;
                stage.set_up(&self.gpu, args)?;
                self.stage.insert((key, stage))
            }
            None => {
                let stage = Stage::new(&self.gpu, args)?;
                describe(&stage);
                self.stage.insert((key, stage))
            }
        };
        Ok(stage)
    }

    /// A scene and its triangles on the GPU; opened once while it stays the same.
    pub fn triangles(
        &mut self,
        scene: &str,
        scale: f64,
    ) -> Result<(&Scene, &WorldTriangles), HarnessError> {
        let key = format!("{scene} {scale}");
        let known = self.triangles.take().filter(|(known, ..)| *known == key);
        let (_, scene, triangles) = match known {
            Some(known) => self.triangles.insert(known),
            None => {
                let scene = scenes::open(scene)?.scaled(scale)?;
                let triangles = WorldTriangles::new(&self.gpu, &scene)?;
                self.triangles.insert((key, scene, triangles))
            }
        };
        Ok((scene, triangles))
    }
}

/// Ends the program on a device error that no call returned: one line, exit code 1, no panic.
fn end_on_device_error(gpu: &Gpu) {
    gpu.device.on_uncaptured_error(Arc::new(|error: wgpu::Error| {
        say_error(format!("device: {error}"));
        leave_all();
        std::process::exit(1);
    }));
}
