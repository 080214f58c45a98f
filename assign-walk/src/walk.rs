//! W and W1: the look-up finds a sample's lights itself.

use assign::{
    AssignError, Assignment, FIRST_STRATEGY_BINDING, Frame, Gpu, LightLists, LightReader,
    LightSource, ListsBindings, Lookup, Needs, Passes, StrategyModule, StrategyWesl, Team,
    check_limits, entry, storage_buffer_limits, storage_entry, uniform_entry,
};

/// The WESL of the strategy.
pub const fn walk_wesl(team: Team, source: LightSource) -> StrategyWesl<'static> {
    StrategyWesl {
        main: include_str!("shaders/walk.wesl"),
        imports: &[],
        flags: &[],
        reader: LightReader::Walk { team, source },
    }
}

/// Finds a sample's lights while it is shaded.
#[derive(Debug)]
pub struct Walk {
    team: Team,
    source: LightSource,
    /// Only record 0, which lists all lights.
    lists: LightLists,
    bindings: ListsBindings,
    hierarchy_bytes: u64,
}

impl Walk {
    /// Makes the strategy. Lanes always use the hierarchy, whatever `source` says.
    ///
    /// # Errors
    ///
    /// [`AssignError::Unsupported`] for [`Team::Subgroup`] on a device without subgroup operations.
    pub fn new(gpu: &Gpu, team: Team, source: LightSource) -> Result<Self, AssignError> {
        let source = match team {
            Team::Subgroup => source,
            Team::Lane => LightSource::Hierarchy,
        };
        LightReader::Walk { team, source }.check(gpu, id_of(team, source))?;
        check_limits(gpu, id_of(team, source), &Self::required_limits(team, source))?;
        let stages = wgpu::ShaderStages::COMPUTE | wgpu::ShaderStages::FRAGMENT;
        let mut bindings = vec![uniform_entry(FIRST_STRATEGY_BINDING, stages)];
        if source == LightSource::Hierarchy {
            bindings.push(storage_entry(FIRST_STRATEGY_BINDING + 1, stages, true));
        }
        Ok(Self {
            team,
            source,
            lists: LightLists::new(gpu)?,
            bindings: ListsBindings::of_look_up(gpu, id_of(team, source), &bindings),
            hierarchy_bytes: 0,
        })
    }

    /// What the strategy needs of a device. Its look-up reads the lights, the lists and the hierarchy.
    pub fn required_limits(team: Team, source: LightSource) -> wgpu::Limits {
        let hierarchy = team == Team::Lane || source == LightSource::Hierarchy;
        storage_buffer_limits(5 + u32::from(hierarchy))
    }

    /// The same strategy for another view: [`Assignment::for_view`].
    ///
    /// # Errors
    ///
    /// [`AssignError::OutOfMemory`] if the device has no memory left.
    pub fn view(&self, gpu: &Gpu) -> Result<Self, AssignError> {
        let mut view = Self::new(gpu, self.team, self.source)?;
        view.lists.limit_as(&self.lists);
        Ok(view)
    }
}

fn id_of(team: Team, source: LightSource) -> &'static str {
    match (team, source) {
        (Team::Subgroup, LightSource::Linear) => "W",
        (Team::Subgroup, LightSource::Hierarchy) => "W/bvh",
        (Team::Lane, _) => "W1",
    }
}

impl Assignment for Walk {
    fn id(&self) -> String {
        id_of(self.team, self.source).into()
    }

    fn needs(&self) -> Needs {
        Needs { hierarchy: self.source == LightSource::Hierarchy, ..Needs::default() }
    }

    fn is_view_bound(&self) -> bool {
        false
    }

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(self.view(gpu)?))
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        frame.view.check()?;
        let reader = LightReader::Walk { team: self.team, source: self.source };
        reader.check_lights(gpu, id_of(self.team, self.source), frame.lights.count())?;
        self.lists.prepare(gpu, frame.lights, 0)?;
        let mut resources = vec![entry(FIRST_STRATEGY_BINDING, self.lists.uniform())];
        if self.source == LightSource::Hierarchy {
            resources.push(entry(FIRST_STRATEGY_BINDING + 1, frame.lights.nodes()));
            self.hierarchy_bytes = frame.lights.nodes().size();
        }
        self.bindings.bind(gpu, &self.lists, &resources);
        Ok(())
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        self.lists.record_reset(passes.encoder(), frame.lights.live_count());
    }

    fn lookup(&self) -> Lookup<'_> {
        // SAFETY: the module has no loop.
        #[allow(unsafe_code, reason = "it has no loop")]
        let module = unsafe { StrategyModule::new(walk_wesl(self.team, self.source)) };
        Lookup { module, bindings: &self.bindings, shape: None }
    }

    fn bind_group(&self) -> Option<&wgpu::BindGroup> {
        self.bindings.bind_group()
    }

    fn lists(&self) -> &LightLists {
        &self.lists
    }

    fn lists_mut(&mut self) -> &mut LightLists {
        &mut self.lists
    }

    fn memory_bytes(&self) -> u64 {
        self.lists.memory_bytes() + self.hierarchy_bytes
    }
}
