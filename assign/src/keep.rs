//! Lists that stay valid for several frames while the lights move: the `update` axis without loss.
//!
//! Lists made for balls that are larger than the lights' own stay complete as long as no light has left its
//! ball. So [`Keep`] grows every light's ball by how far it may move, and makes new lists
//!
//! - after a number of frames,
//! - as soon as a light may have left its ball ([`LightBuffer::travel`]),
//! - if the lights are sorted anew, for lists name slots,
//! - and if the view changed, unless the groups are fixed in the world.
//!
//! It spares the passes that make lists, and pays with longer lists. Cones and outlines count as balls, so
//! lights that turn stay in their lists. This is future work of the comparison paper (section 8), which
//! proposes to update only what changed.
//!
//! Where it fails: with a camera that moves, only [`Assignment::is_view_bound`]'s exceptions keep their lists;
//! fast lights need such large balls that their lists are made in every frame; lights that jump have no bound.
//! If surfaces move, call [`LightLists::expire`] before that frame's `prepare`.

use glam::Vec3;

use crate::{
    AssignError, Assignment, Frame, FrameWrites, Gpu, LightBuffer, LightKinds, LightTraits,
    ModelBox, Passes, SampleDomain, Travel, View, leave_to_inner,
};

/// Room for lights that become faster: the next frames may move them so much further than the last one.
const ROOM: f32 = 1.25;

/// A strategy that keeps its lists for up to `frames` frames, and loses no light.
pub struct Keep {
    inner: Box<dyn Assignment>,
    frames: u32,
    /// The lights with larger balls, in the same slots.
    wide: LightBuffer,
    /// What `wide` uploads for a frame.
    writes: FrameWrites,
    /// How far the balls reach beyond the lights' own, metres.
    reach_m: f32,
    /// The travel of the frame before.
    last: Option<Travel>,
    /// What the recorded lists were made for, and their age in frames.
    made: Option<(Made, u32)>,
    models: Vec<ModelBox>,
    /// The frame that is prepared makes lists for this.
    next: Option<Made>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Made {
    /// `None` if the groups are fixed in the world.
    view: Option<View>,
    samples: SampleDomain,
    light_count: u32,
    surface_bounds: Option<(Vec3, Vec3)>,
    /// Of the lists and of the order of the lights.
    generations: [u32; 2],
    travel: Travel,
}

impl Made {
    /// Whether lists for these lights hold all of `now`'s, whose balls may reach `reach_m` further.
    fn holds(&self, now: &Self, reach_m: f32) -> bool {
        let Self { travel, .. } = *self;
        *self == Self { travel, ..*now }
            && travel.jumps == now.travel.jumps
            && now.travel.metres - travel.metres <= f64::from(reach_m)
    }
}

impl Keep {
    /// Wraps a strategy. With `frames` 1 it makes its lists every frame.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] if `frames` is 0, and [`AssignError::Unsupported`] if the strategy tests
    /// lights against normals, which do not know larger balls, or if lists have [trees](crate::Storage::Trees).
    pub fn new(gpu: &Gpu, inner: Box<dyn Assignment>, frames: u32) -> Result<Self, AssignError> {
        if frames == 0 {
            return Err(AssignError::Parameter {
                field: "frames of a list".into(),
                value: "0".into(),
                accepted: "1 or more".into(),
            });
        }
        let needs = inner.needs();
        if needs.normals || needs.triangles {
            return Err(AssignError::Unsupported {
                strategy: inner.id(),
                asked: format!("keep{frames}"),
                reason: "it reads normals or triangles, against which only the lights' own volumes are tested"
                    .into(),
            });
        }
        inner.lists().check_later_frames(inner.id(), &format!("keep{frames}"))?;
        Ok(Self {
            inner,
            frames,
            wide: LightBuffer::new(gpu, &[])?,
            writes: FrameWrites::new(gpu),
            reach_m: 0.0,
            last: None,
            made: None,
            models: Vec::new(),
            next: None,
        })
    }
}

impl Assignment for Keep {
    fn id(&self) -> String {
        format!("{}/keep{}", self.inner.id(), self.frames)
    }

    leave_to_inner!(needs, is_view_bound, lookup, bind_group, lists);

    fn for_view(&self, gpu: &Gpu) -> Result<Box<dyn Assignment>, AssignError> {
        Ok(Box::new(Self::new(gpu, self.inner.for_view(gpu)?, self.frames)?))
    }

    fn compile(&mut self, gpu: &Gpu, lights: LightTraits) -> Result<(), AssignError> {
        // Larger balls stand for cones and outlines.
        self.inner.compile(gpu, LightTraits { kinds: LightKinds::default(), ..lights })
    }

    fn prepare(&mut self, gpu: &Gpu, frame: &Frame<'_>) -> Result<(), AssignError> {
        let travel = frame.lights.travel();
        let mut now = Made {
            view: self.inner.is_view_bound().then_some(*frame.view),
            samples: frame.samples,
            light_count: frame.lights.count(),
            surface_bounds: frame.surface_bounds,
            generations: [self.inner.lists().generation(), frame.lights.order_generation()],
            travel,
        };
        let last = self.last.replace(travel);
        let wants_growth = self.inner.lists_mut().wants_growth(gpu);
        if let Some((made, age)) = &self.made
            && age + 1 < self.frames
            && !wants_growth
            && made.holds(&now, self.reach_m)
            && self.models == frame.models.unwrap_or_default()
        {
            self.next = None;
            return Ok(());
        }
        // After an error there are no lists.
        self.made = None;
        let step_m = last.map_or(0.0, |last| travel.since(&last));
        self.reach_m = step_m as f32 * (self.frames - 1) as f32 * ROOM;
        self.wide.update_wide(gpu, frame.lights, self.reach_m, &mut self.writes)?;
        self.inner.prepare(gpu, &Frame { lights: &self.wide, ..*frame })?;
        // It may have laid the lists out anew.
        now.generations[0] = self.inner.lists().generation();
        self.models = frame.models.unwrap_or_default().to_vec();
        self.next = Some(now);
        Ok(())
    }

    fn record(&mut self, frame: &Frame<'_>, passes: &mut dyn Passes) {
        match (self.next, &mut self.made) {
            (Some(next), made) => {
                self.writes.record(passes.encoder());
                self.wide.record(passes);
                self.inner.record(&Frame { lights: &self.wide, ..*frame }, passes);
                *made = Some((next, 0));
            }
            (None, Some((_, age))) => *age += 1,
            (None, None) => {}
        }
    }

    fn memory_bytes(&self) -> u64 {
        self.inner.memory_bytes() + self.wide.memory_bytes() + self.writes.bytes()
    }
}
