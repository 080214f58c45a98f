//! Only the lists that a changed light touches are made again: the `update` axis without loss.
//!
//! As long as view, surfaces and models stay, groups stay, and a list can only change if a light does. So
//! in each frame [`Touched`]
//!
//! 1. finds the lights that changed since the frame before ([`LightChanges`], pass `changes`),
//! 2. finds the groups that one of them reached or reaches (pass `touch`), and
//! 3. makes lists for these groups only (pass `cull`). They follow the others in the pool, which is
//!    therefore kept three times as large. Bit masks stay at their places.
//!
//! It skips the passes that bound groups, and the culling of groups that no change touches. This is future
//! work of the comparison paper (Enhuber 2019, section 8). The CPU has all lists made again if the view
//! changed (unless the groups are fixed in the world), or if a light leaves the box for which groups were
//! laid out. The GPU culls all groups if more than 1,024 lights changed, if the pool has no room left for
//! all lists once more, or if a list did not fit.
//!
//! Where it fails: if all lights move, only the bounds are saved; and a strategy whose groups move with the
//! camera gains nothing while the camera moves. If surfaces move, call [`LightLists::expire`] before that
//! frame's `prepare`.

use glam::Vec3;

use crate::{
    AssignError, Assignment, Frame, Gpu, LightChanges, LightKinds, LightTraits, ModelBox, Passes,
    SampleDomain, View, check_limits, leave_to_inner, storage_buffer_limits,
};

/// The pool has room for so many times the entries of one frame.
const ROOM: u32 = 3;

/// Storage buffers that the pass `touch` takes with the strategies of this workspace: three of lights, records and
/// entries, the strategy's two, the touched groups, the changes, and the live groups.
const STORAGE_BUFFERS: u32 = 9;

/// A strategy that makes only those lists again that a changed light touches, and loses no light.
pub struct Touched {
    inner: Box<dyn Assignment>,
    changes: LightChanges,
    /// What the recorded lists were made for.
    made: Option<Made>,
    models: Vec<ModelBox>,
    /// What the prepared frame makes lists for, and whether it makes only some.
    next: Option<(Made, bool)>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Made {
    /// `None` if the groups are fixed in the world.
    view: Option<View>,
    samples: SampleDomain,
    light_count: u32,
    kinds: LightKinds,
    surface_bounds: Option<(Vec3, Vec3)>,
    /// Of the lists.
    generation: u32,
}

impl Touched {
    /// Wraps a strategy.
    ///
    /// # Errors
    ///
    /// [`AssignError::Unsupported`] if the strategy does not [update groups](Assignment::updates_groups), or
    /// reads normals or triangles, by which a list may change though no volume does, or if lists have
    /// [trees](crate::Storage::Trees); and [`AssignError::Limit`] on a device with less than the
    /// [required limits](Self::required_limits).
    pub fn new(gpu: &Gpu, mut inner: Box<dyn Assignment>) -> Result<Self, AssignError> {
        let needs = inner.needs();
        if !inner.updates_groups() || needs.normals || needs.triangles {
            return Err(AssignError::Unsupported {
                strategy: inner.id(),
                asked: "touched".into(),
                reason: "only tiles, clusters without normals, grids and models can make only some lists \
                         and keep the others"
                    .into(),
            });
        }
        inner.lists().check_later_frames(inner.id(), "touched")?;
        check_limits(gpu, &format!("{}/touched", inner.id()), &Self::required_limits())?;
        inner.lists_mut().leave_room(ROOM);
        let changes = LightChanges::new(gpu)?;
        Ok(Self { inner, changes, made: None, models: Vec::new(), next: None })
    }

    /// What it needs of a device, with the strategies of this workspace: one storage buffer more than WebGPU promises.
    pub fn required_limits() -> wgpu::Limits {
        storage_buffer_limits(STORAGE_BUFFERS)
    }
}

impl Assignment for Touched {
    fn id(&self) -> String {
        format!("{}/touched", self.inner.id())
    }

    leave_to_inner!(needs, is_view_bound, lookup, bind_group, lists);

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Self::new(gpu, self.inner.for_view(gpu)?)?))
    }

    fn compile(&mut self, gpu: &Gpu, lights: LightTraits) -> Result<(), AssignError> {
        self.changes.compile(gpu, lights.kinds)?;
        self.inner.compile(gpu, lights)
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        let now = Made {
            view: self.inner.is_view_bound().then_some(*frame.view),
            samples: frame.samples,
            light_count: frame.lights.count(),
            kinds: frame.lights.kinds(),
            surface_bounds: frame.surface_bounds,
            generation: self.inner.lists().generation(),
        };
        let lists = self.inner.lists_mut();
        // The records of capped lists do not tell how long the lists were.
        let stays = !lists.wants_growth(gpu)
            && !lists.is_capped()
            && self.made.as_ref() == Some(&now)
            && self.changes.serves(frame.lights)
            && self.models == frame.models.unwrap_or_default();
        // After an error there are no lists.
        (self.made, self.next) = (None, None);
        if !stays {
            self.changes.restart(frame.lights);
            self.models = frame.models.unwrap_or_default().to_vec();
        }
        self.changes.prepare(gpu, frame.lights)?;
        let changes = stays.then_some(&self.changes);
        self.inner.prepare(gpu, &Frame { changes, ..*frame })?;
        self.next = Some((Made { generation: self.inner.lists().generation(), ..now }, stays));
        Ok(())
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        let Some((made, stays)) = self.next else { return };
        self.changes.record(passes);
        let changes = stays.then_some(&self.changes);
        self.inner.record(&Frame { changes, ..*frame }, passes);
        self.made = Some(made);
    }

    fn memory_bytes(&self) -> u64 {
        self.inner.memory_bytes() + self.changes.bytes()
    }
}
