//! The strategy HC: cells of the world that grow with distance, in a hash table.

use assign::{
    AssignError, Assignment, CullSettings, Culler, CullerDescriptor, FIRST_STRATEGY_BINDING,
    Facing, Frame, Gpu, GroupShape, Groups, LightLists, LightTraits, Lookup, Needs, Passes,
    StrategyModule, entry, storage_entry,
};

use crate::hash_table::{HASHED_WESL, HashTable, TableUse};

/// The widest cells, pixels.
const MAX_CELL_PX: u32 = 16_384;

/// Hashed cells: each cell that holds a visible sample has a list of lights.
#[derive(Debug)]
pub struct HashedCells {
    cell_px: u32,
    settings: CullSettings,
    table: HashTable,
    culler: Culler,
}

impl HashedCells {
    /// Makes the strategy. The edge of a cell is at most `cell_px` pixels, and more than half of that, but at least a
    /// 252th of the distance to the eye. Smaller cells have shorter lists, but more lists are made.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] if `cell_px` is not 1 to 16384.
    pub fn new(gpu: &Gpu, cell_px: u32, settings: CullSettings) -> Result<Self, AssignError> {
        if !(1..=MAX_CELL_PX).contains(&cell_px) {
            return Err(AssignError::Parameter {
                field: "cell edge".into(),
                value: cell_px.to_string(),
                accepted: format!("1 to {MAX_CELL_PX} pixels"),
            });
        }
        Ok(Self {
            cell_px,
            settings,
            culler: Culler::new(
                gpu,
                &CullerDescriptor {
                    label: "HC",
                    shape: GroupShape::Box,
                    settings,
                    sparse: true,
                    facing: Facing::Unknown,
                    // SAFETY: its loop counts up to a constant.
                    #[allow(unsafe_code, reason = "its loop ends")]
                    module: unsafe { StrategyModule::new(HASHED_WESL) },
                    bindings: &bindings(),
                },
            )?,
            // After the check of limits.
            table: HashTable::new(gpu, cell_px)?,
        })
    }

    /// What the strategy needs of a device with such settings.
    pub fn required_limits(settings: CullSettings) -> wgpu::Limits {
        Culler::required_limits(&bindings(), true, settings)
    }

    /// The same strategy for another view: [`Assignment::for_view`].
    ///
    /// # Errors
    ///
    /// [`AssignError::OutOfMemory`] if the device has no memory left.
    pub fn view(&self, gpu: &Gpu) -> Result<Self, AssignError> {
        let mut view = Self::new(gpu, self.cell_px, self.settings)?;
        view.table.limit_as(&self.table);
        view.culler.share(&self.culler);
        Ok(view)
    }

    /// Caps the table at a power of two of at least `slots`, for tests of full tables and for tight memory
    /// budgets. Samples of cells that find no slot read all lights.
    pub fn limit_table(&mut self, slots: u32) {
        self.table.limit(slots);
    }

    /// How full the table was. The value may be a few frames old.
    pub fn table_use(&self) -> Option<TableUse> {
        self.table.table_use()
    }
}

/// The strategy's resources that culling and the look-up read.
fn bindings() -> [wgpu::BindGroupLayoutEntry; 1] {
    let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
    [storage_entry(FIRST_STRATEGY_BINDING, stages, true)]
}

impl Assignment for HashedCells {
    fn id(&self) -> String {
        format!("HC/{}{}", self.cell_px, self.settings.suffix(GroupShape::Box))
    }

    fn needs(&self) -> Needs {
        Needs {
            depth: true,
            hierarchy: self.culler.reads_hierarchy(),
            occluders: self.culler.reads_occluders(),
            ..Needs::default()
        }
    }

    fn updates_groups(&self) -> bool {
        true
    }

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(self.view(gpu)?))
    }

    fn compile(&mut self, gpu: &Gpu, lights: LightTraits) -> Result<(), AssignError> {
        self.culler.compile(gpu, lights)
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        frame.view.check()?;
        let depths = frame.surface_and_layer_depths(&self.id())?;
        let count = self.table.prepare(gpu, frame, &depths, self.culler.writes_mut())?;
        self.culler.prepare(
            gpu,
            frame,
            Groups::Live { count, live: self.table.live() },
            &[entry(FIRST_STRATEGY_BINDING, self.table.buffer())],
        )
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        if frame.changes.is_none() {
            self.culler.record_writes(passes);
            self.table.record(frame.view, passes);
        } else if self.table.wants_growth() {
            // The next frame fills a larger table.
            self.culler.lists_mut().expire();
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
        self.table.bytes() + self.culler.memory_bytes()
    }
}
