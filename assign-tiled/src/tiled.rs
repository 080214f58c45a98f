//! Tiles: T-I, T-E, HalfZ, ModifiedHalfZ and T-25D.

use assign::{
    AssignError, Assignment, CullSettings, Culler, CullerDescriptor, DepthImage,
    FIRST_STRATEGY_BINDING, Facing, Frame, Gpu, GroupShape, Groups, LightLists, LightTraits,
    Lookup, Needs, Passes, SampleDomain, StrategyModule, entry, storage_entry, uniform_entry,
};
use bytemuck::bytes_of;

use crate::{
    tile_bounds::TileBounds,
    tile_wesl::tile_wesl,
    tiles::{SURFACES_AND_FRONT, SURFACES_ONLY, TileDepths, TileSize, TilesUniform},
};

/// Tiles that each have a list of lights.
#[derive(Debug)]
pub struct Tiled {
    size: TileSize,
    depths: TileDepths,
    settings: CullSettings,
    tiles: wgpu::Buffer,
    tile_bounds: Option<TileBounds>,
    culler: Culler,
}

impl Tiled {
    /// Makes the strategy. Checks `size`.
    pub fn new(
        gpu: &Gpu,
        size: TileSize,
        depths: impl Into<TileDepths>,
        settings: CullSettings,
    ) -> Result<Self, AssignError> {
        size.check()?;
        let depths = depths.into();
        Ok(Self {
            size,
            depths,
            settings,
            tiles: gpu.uniform("tiles", size_of::<TilesUniform>() as u64),
            culler: Culler::new(
                gpu,
                &CullerDescriptor {
                    label: depths.family(),
                    shape: match depths {
                        TileDepths::Sliced => GroupShape::MaskedFrustum,
                        _ => GroupShape::Frustum,
                    },
                    settings,
                    sparse: false,
                    facing: Facing::Unknown,
                    // SAFETY: the loop over a tile's pixels counts up to their number.
                    #[allow(unsafe_code, reason = "its loop ends")]
                    module: unsafe { StrategyModule::new(tile_wesl(depths)) },
                    bindings: &bindings(depths),
                },
            )?,
            // After the check of limits.
            tile_bounds: match depths {
                TileDepths::Implicit | TileDepths::ExplicitAtOnce => None,
                _ => Some(TileBounds::new(gpu, depths)?),
            },
        })
    }
}

impl Tiled {
    /// What the strategy needs of a device with such depths and settings.
    pub fn required_limits(depths: TileDepths, settings: CullSettings) -> wgpu::Limits {
        Culler::required_limits(&bindings(depths), false, settings)
    }

    /// The same strategy for another view: [`Assignment::for_view`].
    ///
    /// # Errors
    ///
    /// [`AssignError::OutOfMemory`] if the device has no memory left.
    pub fn view(&self, gpu: &Gpu) -> Result<Self, AssignError> {
        let mut view = Self::new(gpu, self.size, self.depths, self.settings)?;
        view.culler.share(&self.culler);
        Ok(view)
    }

    /// Whether the samples in a tile bound it.
    fn is_explicit(&self) -> bool {
        self.depths != TileDepths::Implicit
    }

    /// The depth buffer that bounds tiles.
    fn depth_of(&self, frame: &Frame<'_>) -> Result<DepthImage, AssignError> {
        let id = self.id();
        let depth = frame.surface_depth(&id)?;
        if self.depths != TileDepths::ExplicitAtOnce {
            return Ok(depth);
        }
        let reason = "no buffer keeps the bounds of its tiles, so look-ups cannot tell which samples they hold";
        frame.check_domain(&id, &[SampleDomain::OpaqueSurfaces, SampleDomain::InFront], reason)?;
        depth.with_one_sample("its culling kernel reads one sample per pixel")
    }
}

/// The strategy's resources that culling and the look-up read.
fn bindings(depths: TileDepths) -> Vec<wgpu::BindGroupLayoutEntry> {
    let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
    let mut bindings = vec![uniform_entry(FIRST_STRATEGY_BINDING, stages)];
    let buffers = match depths {
        TileDepths::Implicit | TileDepths::ExplicitAtOnce => 0,
        TileDepths::Sliced => 2,
        _ => 1,
    };
    let buffer = |place| storage_entry(FIRST_STRATEGY_BINDING + place, stages, true);
    bindings.extend((1..=buffers).map(buffer));
    bindings
}

impl Assignment for Tiled {
    fn id(&self) -> String {
        let family = self.depths.family();
        format!("{family}/{}{}", self.size, self.settings.suffix(GroupShape::Frustum))
    }

    fn needs(&self) -> Needs {
        let hierarchy = self.culler.reads_hierarchy();
        let occluders = self.culler.reads_occluders();
        Needs { depth: self.is_explicit(), hierarchy, occluders, ..Needs::default() }
    }

    fn updates_groups(&self) -> bool {
        // It would find the bounds of all tiles again.
        self.depths != TileDepths::ExplicitAtOnce
    }

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(self.view(gpu)?))
    }

    fn compile(&mut self, gpu: &Gpu, lights: LightTraits) -> Result<(), AssignError> {
        self.culler.compile(gpu, lights)
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        frame.view.check()?;
        let mut tiles = TilesUniform::new(self.size, frame.view);
        tiles.serve(frame, &self.id())?;
        let mut resources = vec![entry(FIRST_STRATEGY_BINDING, &self.tiles)];
        if self.is_explicit() {
            let depth = self.depth_of(frame)?;
            tiles.surfaces_only = match frame.samples {
                SampleDomain::InFront => SURFACES_AND_FRONT,
                _ => SURFACES_ONLY,
            };
            if let Some(tile_bounds) = &mut self.tile_bounds {
                let writes = self.culler.writes_mut();
                tile_bounds.prepare(gpu, frame, &depth, (&self.tiles, tiles.counts), writes)?;
                resources.extend(tile_bounds.resources());
            }
        }
        self.culler.writes_mut().write(&self.tiles, 0, bytes_of(&tiles))?;
        self.culler.prepare(
            gpu,
            frame,
            Groups::All(tiles.tile_count() * self.depths.lists()),
            &resources,
        )
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        if let Some(tile_bounds) = &self.tile_bounds
            && frame.changes.is_none()
        {
            self.culler.record_writes(passes);
            tile_bounds.record(passes);
        }
        self.culler.record(passes);
    }

    fn lookup(&self) -> Lookup<'_> {
        self.culler.lookup()
    }

    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.culler.bind_group()
    }

    fn lists(&self) -> &LightLists {
        self.culler.lists()
    }

    fn lists_mut(&mut self) -> &mut LightLists {
        self.culler.lists_mut()
    }

    fn memory_bytes(&self) -> u64 {
        let bounds = self.tile_bounds.as_ref().map_or(0, TileBounds::bytes);
        self.tiles.size() + bounds + self.culler.memory_bytes()
    }
}
