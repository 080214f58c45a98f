//! Draws the frames of a case with one instance of a strategy, and checks each frame.

use std::collections::HashSet;

use bytemuck::cast_slice;
use glam::Vec3;

use super::{
    Make,
    cases::Case,
    check,
    feed::Feed,
    plan::{Lit, Living, Plan},
    rig::{Asked, Probe, Rig, Surfaces},
    seen::{Seen, UNWRITTEN},
    stage::Rng,
    violation::{Breach, Figures, Findings, Outcome, Place},
};
use crate::{
    AssignError, Assignment, EncoderPasses, Frame, FrameBindings, Light, LightBuffer, LightKinds,
    LightOrder, SampleDomain,
};

/// The number of frames after which the pool must fit all lists.
const FRAMES_TO_GROW: u32 = 6;
/// Size of the pool in the overflow case, entries.
const TINY_POOL: u32 = 64;

/// Runs one case with the samples in `asked`, or on surfaces only if the strategy refuses look-ups at any depth.
/// Violations are an outcome; an error is any other failure.
pub(super) fn run(
    rig: &Rig,
    case: &Case,
    make: &Make<'_>,
    asked: Asked,
) -> Result<Outcome, AssignError> {
    let seed =
        case.name.bytes().fold(7, |sum: u64, byte| sum.wrapping_mul(31).wrapping_add(byte.into()));
    let mut findings = Findings::new(case.name);
    let mut figures = Figures::default();
    let mut run = Run { rig, make, asked, findings: &mut findings, figures: &mut figures };
    let plan = (case.build)(&mut Rng::new(seed));
    let done = match &plan {
        Plan::Still(lit) => run.sequence(std::slice::from_ref(lit)),
        Plan::Sequence(stages) => run.sequence(stages),
        Plan::Living(living) => run.living(living),
        Plan::Overflow(lit) => run.overflow(lit),
        Plan::Quarantine { clean, dirty, bad } => run.quarantine(clean, dirty, bad),
    };
    if let Err(error) = done {
        return match error {
            AssignError::Unsupported { .. } if figures.frames == 0 => {
                Ok(Outcome::Unserved(error.to_string()))
            }
            other => Err(other),
        };
    }
    if case.has_pairs && figures.pairs == 0 {
        let detail = format!("no light reaches any of {} samples", figures.samples);
        findings.add(Breach::Vacuous, Place::default(), detail);
    }
    Ok(if findings.violations.is_empty() {
        Outcome::Passed(figures)
    } else {
        Outcome::Failed(findings.violations)
    })
}

/// Whether the strategy has groups in a plain view.
pub(super) fn has_groups(rig: &Rig, case: &Case, make: &Make<'_>) -> Result<bool, AssignError> {
    let Plan::Still(lit) = (case.build)(&mut Rng::new(1)) else {
        return Ok(true);
    };
    let mut session = Session::new(rig, make, Asked::stated(SampleDomain::AnyDepth))?;
    session.set_up(rig, &lit)?;
    session.draw(rig, &lit, false)?;
    Ok(session.strategy.lists().group_count() > 0)
}

/// The state of a running case.
struct Run<'r> {
    rig: &'r Rig,
    make: &'r Make<'r>,
    asked: Asked,
    findings: &'r mut Findings,
    figures: &'r mut Figures,
}

impl Run<'_> {
    /// Draws the stages in sequence with one instance. Draws each stage's last frame twice.
    fn sequence(&mut self, stages: &[Lit]) -> Result<(), AssignError> {
        let mut session = Session::new(self.rig, self.make, self.asked)?;
        let mut fresh = true;
        for (stage, lit) in (0..).zip(stages) {
            self.findings.stage = stage;
            session.set_up(self.rig, lit)?;
            let settled = self.settle(&mut session, lit, fresh)?;
            let again = self.frame(&mut session, lit, false, fresh)?;
            check::same(&settled, &again, Breach::Unstable, self.findings);
            fresh = false;
        }
        Ok(())
    }

    /// Draws frames until no list overflows. `fresh` says that no earlier stage left records
    /// behind.
    fn settle(
        &mut self,
        session: &mut Session,
        lit: &Lit,
        fresh: bool,
    ) -> Result<Seen, AssignError> {
        let mut seen = self.frame(session, lit, fresh, fresh)?;
        for _ in 1..FRAMES_TO_GROW {
            if !seen.overflowed() {
                return Ok(seen);
            }
            seen = self.frame(session, lit, false, fresh)?;
        }
        if seen.overflowed() {
            let detail = format!(
                "{} groups overflow after {FRAMES_TO_GROW} frames",
                seen.snapshot.counters.overflowed_groups
            );
            self.findings.add(Breach::OverflowStays, Place::default(), detail);
        }
        Ok(seen)
    }

    /// Draws one frame and checks what must hold for every frame.
    fn frame(
        &mut self,
        session: &mut Session,
        lit: &Lit,
        wipe: bool,
        complete: bool,
    ) -> Result<Seen, AssignError> {
        self.findings.frame = self.figures.frames;
        let seen = session.draw(self.rig, lit, wipe)?;
        check::lists(&seen, complete, self.findings);
        let lights = session.lights.read(&self.rig.gpu)?;
        let pairs = check::pairs(&seen, &lights, self.findings);
        self.figures.frames += 1;
        self.figures.samples += seen.probes.len() as u64;
        self.figures.pairs += pairs.reaching;
        self.figures.listed += pairs.listed;
        if !seen.overflowed() {
            self.figures.fitting[0] += seen.probes.len() as u64;
            self.figures.fitting[1] += pairs.listed;
        }
        self.figures.any_depth |= session.asked.samples == SampleDomain::AnyDepth;
        Ok(seen)
    }

    /// Draws frames of lights that change in each of them.
    fn living(&mut self, living: &Living) -> Result<(), AssignError> {
        let mut session = Session::living(self.rig, self.make, living, self.asked)?;
        for (stage, lit) in (0..).zip(&living.frames) {
            self.findings.stage = stage;
            session.set_up(self.rig, lit)?;
            self.settle(&mut session, lit, stage == 0)?;
            let counts = session.lights.read_counts(&self.rig.gpu)?.unwrap_or_default();
            let found = (counts.faulty + counts.dark) as usize;
            if found != living.bad {
                let detail = format!("{} lights are faulty, but the GPU found {found}", living.bad);
                self.findings.add(Breach::Quarantine, Place::default(), detail);
            }
            self.slots(&session.lights.read(&self.rig.gpu)?, &lit.lights);
        }
        Ok(())
    }

    /// Checks that each sound light has one slot. Records from the GPU do not hold all of a light, so
    /// position, range and kind name it.
    fn slots(&mut self, slots: &[Light], given: &[Light]) {
        let name = |light: &Light| {
            let [x, y, z] = light.position.to_array().map(f32::to_bits);
            [x, y, z, light.range_m.to_bits(), light.kind() as u32]
        };
        let is_lit = |light: &&Light| light.intensity != Vec3::ZERO;
        let mut found: Vec<_> = slots.iter().filter(is_lit).map(name).collect();
        let mut sound: Vec<_> = given.iter().filter(|l| l.check().is_ok()).map(name).collect();
        found.sort_unstable();
        sound.sort_unstable();
        if found != sound {
            let lost = sound.iter().filter(|light| found.binary_search(light).is_err()).count();
            let detail = format!(
                "{} slots have a light, {} lights are sound, and {lost} of these have no slot",
                found.len(),
                sound.len()
            );
            self.findings.add(Breach::Slots, Place::default(), detail);
        }
    }

    /// With a pool that is far too small, no pair is missed and the overflow is counted. Without
    /// the limit, the overflow ends.
    fn overflow(&mut self, lit: &Lit) -> Result<(), AssignError> {
        let mut session = Session::new(self.rig, self.make, self.asked)?;
        session.strategy.lists_mut().limit_pool(TINY_POOL);
        session.set_up(self.rig, lit)?;
        for wipe in [true, false] {
            let seen = self.frame(&mut session, lit, wipe, true)?;
            // Bit masks have no pool.
            let lists = session.strategy.lists();
            let has_pool = !lists.storage().is_mask() && lists.group_count() > 0;
            if has_pool && !seen.overflowed() {
                let detail =
                    format!("with {} lights and a pool of {TINY_POOL} entries", seen.light_count);
                self.findings.add(Breach::NoOverflow, Place::default(), detail);
            }
        }
        session.strategy.lists_mut().limit_pool(u32::MAX);
        let settled = self.settle(&mut session, lit, true)?;
        let again = self.frame(&mut session, lit, false, true)?;
        check::same(&settled, &again, Breach::Unstable, self.findings);
        Ok(())
    }

    /// Faulty lights are omitted and counted, and the lists of the sound lights do not change.
    fn quarantine(&mut self, clean: &Lit, dirty: &Lit, bad: &[usize]) -> Result<(), AssignError> {
        let mut settled = Vec::new();
        for lit in [clean, dirty] {
            let mut session = Session::new(self.rig, self.make, self.asked)?;
            session.set_up(self.rig, lit)?;
            settled.push(self.settle(&mut session, lit, true)?);
            let rejected = session.lights.rejected().iter().map(|r| r.index);
            let expected = if std::ptr::eq(lit, dirty) { bad } else { &[] };
            if !rejected.eq(expected.iter().copied()) {
                let detail = format!(
                    "faulty lights are {expected:?}, but these were omitted: {:?}",
                    session.lights.rejected()
                );
                self.findings.add(Breach::Quarantine, Place::default(), detail);
            }
        }
        check::same(&settled[0], &settled[1], Breach::Quarantine, self.findings);
        Ok(())
    }
}

/// One instance of a strategy, and what a renderer keeps with it.
struct Session {
    strategy: Box<dyn Assignment>,
    frame: FrameBindings,
    lights: LightBuffer,
    surfaces: Option<Surfaces>,
    asked: Asked,
    /// The renderer's own buffers of lights, if it writes them on the GPU.
    feed: Option<Feed>,
}

impl Session {
    fn new(rig: &Rig, make: &Make<'_>, asked: Asked) -> Result<Self, AssignError> {
        Ok(Self {
            strategy: make(&rig.gpu)?,
            frame: FrameBindings::new(&rig.gpu),
            lights: LightBuffer::new(&rig.gpu, &[])?,
            surfaces: None,
            asked,
            feed: None,
        })
    }

    /// A session whose lights the GPU sorts.
    fn living(
        rig: &Rig,
        make: &Make<'_>,
        living: &Living,
        asked: Asked,
    ) -> Result<Self, AssignError> {
        let order = LightOrder::Gpu { every: living.every };
        let lights = LightBuffer::ordered(&rig.gpu, &[], order)?;
        let feed = living.from_gpu.then(|| Feed::new(&rig.gpu, &living.frames)).transpose()?;
        Ok(Self { lights, feed, ..Self::new(rig, make, asked)? })
    }

    /// Uploads a stage.
    fn set_up(&mut self, rig: &Rig, lit: &Lit) -> Result<(), AssignError> {
        match &self.feed {
            Some(feed) => {
                feed.write(&rig.gpu, &lit.lights);
                self.lights.update_from_gpu(&rig.gpu, &feed.lights())?;
            }
            None => self.lights.update(&rig.gpu, &lit.lights)?,
        }
        if lit.opaque_only {
            self.asked = Asked::stated(SampleDomain::OpaqueSurfaces);
        }
        self.surfaces = Some(rig.set_up(&lit.stage, self.asked)?);
        Ok(())
    }

    /// Prepares a frame. If the strategy refuses look-ups at any depth, prepares it with look-ups on opaque
    /// surfaces.
    fn prepare(&mut self, rig: &Rig, lit: &Lit) -> Result<(), AssignError> {
        let frame = frame_of(lit, &self.lights, self.surfaces.as_ref(), self.asked.declared);
        self.frame.update(&rig.gpu, &frame)?;
        match self.strategy.prepare(&rig.gpu, &frame) {
            Err(AssignError::Unsupported { .. })
                if self.asked.declared == SampleDomain::AnyDepth =>
            {
                self.asked = Asked::stated(SampleDomain::OpaqueSurfaces);
                self.set_up(rig, lit)?;
                let frame =
                    frame_of(lit, &self.lights, self.surfaces.as_ref(), self.asked.declared);
                self.strategy.prepare(&rig.gpu, &frame)
            }
            other => other,
        }
    }

    /// Draws one frame. `wipe` first fills all records with [`UNWRITTEN`].
    fn draw(&mut self, rig: &Rig, lit: &Lit, wipe: bool) -> Result<Seen, AssignError> {
        let gpu = &rig.gpu;
        self.prepare(rig, lit)?;
        let group_count = self.strategy.lists().group_count();
        if wipe {
            let records = vec![UNWRITTEN; group_count as usize];
            let lists = self.strategy.lists().lists();
            gpu.queue.write_buffer(lists, 8, cast_slice(&records));
        }
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let frame = frame_of(lit, &self.lights, self.surfaces.as_ref(), self.asked.declared);
        let mut passes = EncoderPasses { encoder: &mut encoder };
        self.lights.record(&mut passes);
        self.strategy.record(&frame, &mut passes);
        let surfaces = self.surfaces.as_ref();
        let surfaces = surfaces.ok_or_else(|| AssignError::Device("no stage set up".into()))?;
        let kinds = self.kinds();
        rig.record_probe(&mut encoder, &*self.strategy, &self.frame, kinds, surfaces)?;
        gpu.queue.submit([encoder.finish()]);
        let mut probes = rig.read_probes(surfaces)?;
        if self.asked == Asked::unstated(false) {
            keep_unlisted(&mut probes);
        }
        let seen = Seen {
            snapshot: self.strategy.lists().snapshot(gpu)?,
            probes,
            group_count,
            light_count: self.lights.read(gpu)?.len() as u32,
            knows_normals: self.strategy.needs().normals,
            per_sample: None,
        };
        if !self.strategy.lookup().is_per_sample() {
            return Ok(seen);
        }
        let dumped = rig.dump(&*self.strategy, &self.frame, kinds, surfaces)?;
        Ok(seen.with_read(dumped, rig.read_probes(surfaces)?))
    }

    /// The kinds of lights for which the look-up is compiled.
    fn kinds(&self) -> LightKinds {
        match self.strategy.lookup().is_per_sample() {
            true => self.lights.kinds(),
            // It reads no lights, and one look-up serves all cases.
            false => LightKinds::default(),
        }
    }
}

/// Keeps the samples on surfaces, and of the others those whose group holds no sample on a surface.
fn keep_unlisted(probes: &mut Vec<Probe>) {
    let groups: HashSet<u32> =
        probes.iter().filter(|p| p.is_on_surface()).map(|p| p.group).collect();
    probes.retain(|probe| probe.is_on_surface() || !groups.contains(&probe.group));
}

fn frame_of<'a>(
    lit: &'a Lit,
    lights: &'a LightBuffer,
    surfaces: Option<&'a Surfaces>,
    samples: SampleDomain,
) -> Frame<'a> {
    Frame {
        depth: surfaces.map(|s| &s.depth),
        normals: surfaces.map(|s| &s.normals),
        // Lists lack no light whatever surfaces are made of, so any image serves as their materials.
        base_color: surfaces.map(|s| &s.normals),
        models: Some(&lit.stage.models),
        surface_bounds: lit.stage.surface_bounds(),
        ..Frame::new(&lit.stage.view, lights).sampled_at(samples)
    }
}
