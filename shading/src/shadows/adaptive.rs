//! Rectangles that frames subdivide: their trees, the tests of a round, and what its answers change.

use assign::{AssignError, FrameWrites, Gpu, Light, LightShape, Passes, View};
use bytemuck::{bytes_of, cast_slice};

use super::{
    banding::{BandTest, Banding, Drawn, MOST_TESTS},
    clear_face::clear_face,
    plan::Plan,
    quadtree::{INNER, Node},
    rectangle::{MovedFace, Patch, Rectangle},
    start_level::start_level,
};
use crate::{ShadingError, ShadowModel, bound_maps::BoundMaps};

/// Bytes of a vector of the records.
const VECTOR_BYTES: u64 = 16;

/// What one call of [`Renderer::refine_shadows`](crate::Renderer::refine_shadows) did.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ShadowRefinement {
    /// Rounds whose answers were taken since the maps were made, this one among them.
    pub rounds: u32,
    /// Quads that were divided into four.
    pub expanded: u32,
    /// Quads whose four parts were merged.
    pub pruned: u32,
    /// Quads with bands that were not divided, because their light has as many maps as it can.
    pub skipped: u32,
    /// Maps that were drawn.
    pub drawn: u32,
    /// Whether the last round changed nothing, and the next one would test the same quads. If the view stays, so do
    /// the maps.
    pub is_settled: bool,
}

/// The state of all rectangles.
#[derive(Debug)]
pub(super) struct Adaptive {
    rectangles: Vec<Rectangle>,
    down: u32,
    banding: Banding,
    pub(super) clear_face: wgpu::RenderPipeline,
    writes: FrameWrites,
    /// The quads of the round on its way: a rectangle and its node.
    asked: Vec<(usize, Node)>,
    is_started: bool,
    last: ShadowRefinement,
}

impl Adaptive {
    /// Places the maps of the corners of all rectangles in the plan. `None` if the model is another one.
    pub(super) fn new(
        gpu: &Gpu,
        frame: &wgpu::BindGroupLayout,
        plan: &mut Plan,
        lights: &[Light],
        model: ShadowModel,
    ) -> Result<Option<Self>, ShadingError> {
        let ShadowModel::Adaptive { down, .. } = model else { return Ok(None) };
        let mut rectangles = Vec::new();
        for site in &plan.sites {
            let light = &lights[site.light];
            let LightShape::Area(emitter) = light.shape else { continue };
            rectangles.push(Rectangle::new(site.clone(), light, emitter, &plan.records, plan.maps));
        }
        // Leaves are at most as many as points, and tested parents a quarter of the leaves.
        let each = (plan.maps + plan.maps / 4).min(INNER as u32);
        let most = MOST_TESTS / each;
        if rectangles.len() as u64 > u64::from(most) {
            return Err(AssignError::Parameter {
                field: "shadow model".into(),
                value: format!("{model} for {} rectangles", rectangles.len()),
                accepted: format!(
                    "one for at most {most} rectangles with {} maps each, or maps:N,PX: a frame tests at most \
                     {MOST_TESTS} quads",
                    plan.maps
                ),
            }
            .into());
        }
        let mut patch = Patch::default();
        rectangles.iter_mut().for_each(|rectangle| rectangle.place_points(&mut patch));
        patch.move_faces(&mut plan.faces);
        for (first, vectors) in patch.records {
            plan.records[first..first + vectors.len()].copy_from_slice(&vectors);
        }
        Ok(Some(Self {
            banding: Banding::new(gpu, frame, each * rectangles.len() as u32)?,
            rectangles,
            down,
            clear_face: clear_face(gpu)?,
            writes: FrameWrites::new(gpu),
            asked: Vec::new(),
            is_started: false,
            last: ShadowRefinement::default(),
        }))
    }

    /// The faces of all maps among those of the plan, ascending.
    pub(super) fn drawn_faces(&self, face_count: usize) -> Vec<u32> {
        let mut is_drawn = vec![true; face_count];
        for rectangle in &self.rectangles {
            is_drawn[rectangle.all_faces()].fill(false);
            rectangle.faces().for_each(|face| is_drawn[face] = true);
        }
        (0..).zip(is_drawn).filter_map(|(face, is_drawn)| is_drawn.then_some(face)).collect()
    }

    /// The number of maps of each rectangle, in the order of slots.
    pub(super) fn maps_of_rectangles(&self) -> impl Iterator<Item = u32> + '_ {
        self.rectangles.iter().map(Rectangle::maps)
    }

    /// Rectangles that have no places left for some quad.
    pub(super) fn full_rectangles(&self) -> u32 {
        self.rectangles.iter().filter(|rectangle| rectangle.is_full()).count() as u32
    }

    /// Starts the trees, or takes the answers of a round that have arrived. Returns what changes; `None` if nothing
    /// was started or has arrived.
    pub(super) fn advance(&mut self, view: &View) -> Option<Patch> {
        let mut patch = Patch::default();
        let mut now = ShadowRefinement { rounds: self.last.rounds, ..Default::default() };
        if !self.is_started {
            self.is_started = true;
            for rectangle in &mut self.rectangles {
                let level = start_level(view, rectangle.emitter(), rectangle.position(), self.down);
                rectangle.start_at(level);
                rectangle.place_points(&mut patch);
            }
            now.is_settled = !self.has_tests();
        } else {
            let flags = self.banding.arrived()?;
            let asked = std::mem::take(&mut self.asked);
            let answers: Vec<(usize, Node, bool)> =
                asked.iter().zip(flags).map(|((ix, node), flag)| (*ix, *node, flag)).collect();
            for of_one in answers.chunk_by(|a, b| a.0 == b.0) {
                let rectangle = &mut self.rectangles[of_one[0].0];
                let tested: Vec<(Node, bool)> =
                    of_one.iter().map(|(_, node, flag)| (*node, *flag)).collect();
                let change = rectangle.refine(&tested);
                now.expanded += change.expanded;
                now.pruned += change.pruned;
                now.skipped += change.skipped;
                if change.expanded + change.pruned > 0 {
                    rectangle.place_points(&mut patch);
                }
            }
            now.rounds += 1;
            now.is_settled = now.expanded + now.pruned == 0 && self.tests() == asked;
        }
        now.drawn = patch.maps;
        self.last = now;
        Some(patch)
    }

    /// What the last [`advance`](Self::advance) that had something to do did.
    pub(super) fn last(&self) -> ShadowRefinement {
        self.last
    }

    /// Records the commands that write a patch to the records and to the views of faces.
    pub(super) fn write(
        &mut self,
        patch: &Patch,
        records: &wgpu::Buffer,
        (views, stride): (&wgpu::Buffer, u32),
        passes: &mut dyn Passes,
    ) -> Result<(), AssignError> {
        for (first, vectors) in &patch.records {
            self.writes.write(records, *first as u64 * VECTOR_BYTES, cast_slice(vectors))?;
        }
        for MovedFace { face, world_to_view, .. } in &patch.faces {
            // The first field of `ViewUniform`.
            let offset = *face as u64 * u64::from(stride);
            self.writes.write(views, offset, bytes_of(&world_to_view.to_cols_array()))?;
        }
        self.writes.record(passes.encoder());
        Ok(())
    }

    /// Whether a quad is left that could change.
    pub(super) fn has_tests(&self) -> bool {
        !self.tests().is_empty()
    }

    /// The quads to test, by rectangle.
    fn tests(&self) -> Vec<(usize, Node)> {
        let of_one = |(ix, rectangle): (usize, &Rectangle)| {
            rectangle.tests().into_iter().map(move |node| (ix, node))
        };
        self.rectangles.iter().enumerate().flat_map(of_one).collect()
    }

    /// Records a round, unless one is on its way or there is nothing to test. Returns whether it did.
    pub(super) fn record_round(
        &mut self,
        drawn: Drawn<'_>,
        maps: &BoundMaps,
        passes: &mut dyn Passes,
    ) -> Result<bool, ShadingError> {
        if self.banding.is_waiting() {
            return Ok(false);
        }
        let asked = self.tests();
        if asked.is_empty() {
            return Ok(false);
        }
        let tests: Vec<BandTest> = asked
            .iter()
            .map(|(ix, node)| {
                let rectangle = &self.rectangles[*ix];
                BandTest {
                    corners: rectangle.corner_maps(*node),
                    middle_world: rectangle.position().to_array(),
                    reach_2: rectangle.reach_m().powi(2),
                    light: rectangle.light() as u32,
                    padding: [0; 3],
                }
            })
            .collect();
        self.banding.record(drawn, self.down, maps, &tests, passes)?;
        self.asked = asked;
        Ok(true)
    }
}
