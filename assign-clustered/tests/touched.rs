//! Lists that stay where no light changed lose no light, and only touched groups get new lists.

use std::collections::BTreeMap;

use assign::{
    AssignError, Assignment, Bounds, CullSettings, Frame, Gpu, Light, LightBuffer, LightOrder,
    LightShape, LightSource, ListsSnapshot, Touched, View,
    conformance::{self, CountedPasses},
};
use assign_clustered::{ClusterOptions, Clustered, Normals, Occupancy};
use glam::Vec3;

const SIZE: [u32; 2] = [64, 48];

/// The light that is a spot.
const SPOT: usize = 33;

fn clusters(gpu: &Gpu, bounds: Bounds, occupancy: Occupancy) -> Result<Clustered, AssignError> {
    let settings = CullSettings { source: LightSource::Hierarchy, ..CullSettings::default() };
    Clustered::new(gpu, "8x8x8".parse()?, bounds, occupancy, settings)
}

fn touched(
    bounds: Bounds,
    occupancy: Occupancy,
) -> impl Fn(&Gpu) -> Result<Box<dyn Assignment>, AssignError> {
    move |gpu| Ok(Box::new(Touched::new(gpu, Box::new(clusters(gpu, bounds, occupancy)?))?))
}

#[test]
fn lists_that_stay_conform() {
    let cases = [
        "33-lights",
        "overflow",
        "light-count-changes",
        "mixed-kinds",
        "lights-move",
        "gpu-order",
        "gpu-order-stale",
        "gpu-order-some-move",
        "lights-from-gpu",
    ];
    for case in cases {
        for (bounds, occupancy) in
            [(Bounds::Explicit, Occupancy::Sparse), (Bounds::Implicit, Occupancy::Dense)]
        {
            conformance::run_case(case, &touched(bounds, occupancy)).expect(case);
        }
    }
}

/// A frame's passes and lists, and how many entries were written.
struct Drawn {
    passes: BTreeMap<String, u32>,
    lists: ListsSnapshot,
}

impl Drawn {
    /// The lights of each group.
    fn groups(&self) -> Vec<Vec<u32>> {
        let groups = 0..self.lists.lists.len() as u32 - 1;
        groups.map(|group| self.lists.entries_of(group).expect("inside").to_vec()).collect()
    }

    fn is_update(&self) -> bool {
        self.passes.contains_key("touch")
    }
}

/// A wall, seen from some metres away.
struct Wall {
    gpu: Gpu,
    depth: wgpu::TextureView,
}

impl Wall {
    fn draw(&self, strategy: &mut dyn Assignment, lights: &LightBuffer, back_m: f32) -> Drawn {
        let view = View::look_at(
            Vec3::new(5.0, 5.0, 12.0 + back_m),
            Vec3::new(5.0, 5.0, 0.0),
            1.0,
            0.1,
            SIZE,
        );
        let frame = Frame::new(&view, lights).with_depth(&self.depth);
        strategy.prepare(&self.gpu, &frame).expect("prepares");
        let mut passes_recorded = BTreeMap::new();
        let mut encoder = self.gpu.device.create_command_encoder(&Default::default());
        let mut passes = CountedPasses::new(&mut encoder, &mut passes_recorded);
        lights.record(&mut passes);
        strategy.record(&frame, &mut passes);
        self.gpu.queue.submit([encoder.finish()]);
        self.gpu.wait().expect("waits");
        Drawn {
            passes: passes_recorded,
            lists: strategy.lists().snapshot(&self.gpu).expect("lists"),
        }
    }
}

fn lights() -> Vec<Light> {
    (0..100)
        .map(|ix| {
            let place = Vec3::new((ix % 10) as f32, (ix / 10) as f32, (ix % 3) as f32);
            let mut light = Light::point(place, 2.0, Vec3::ONE);
            if ix == SPOT {
                let (inner_angle, outer_angle) = (0.2, 0.4);
                light.shape = LightShape::Spot { direction: Vec3::NEG_Z, inner_angle, outer_angle };
            }
            light
        })
        .collect()
}

#[test]
fn only_touched_groups_get_new_lists() {
    let gpu = Gpu::open(None).expect("a GPU");
    let depth = conformance::flat_depth(&gpu, SIZE, 0.1 / 12.0);
    let wall = Wall { gpu: gpu.clone(), depth };
    for order in [LightOrder::Given, LightOrder::Gpu { every: 2 }] {
        let mut strategy = touched(Bounds::Explicit, Occupancy::Sparse)(&gpu).expect("a strategy");
        let mut moving = lights();
        let mut buffer = LightBuffer::ordered(&gpu, &moving, order).expect("lights");
        // The pool grows first.
        let mut drawn = wall.draw(&mut *strategy, &buffer, 0.0);
        while !drawn.is_update() {
            drawn = wall.draw(&mut *strategy, &buffer, 0.0);
        }
        let requested = drawn.lists.counters.requested();
        assert!(requested > 300, "{requested} entries");
        let mut cursor = drawn.lists.counters.cursor;
        // Draws the lights; returns how many entries were written, and whether groups stayed.
        let mut next = |moving: &[Light], back_m: f32| {
            buffer.update(&gpu, moving).expect("lights");
            let drawn = wall.draw(&mut *strategy, &buffer, back_m);
            let mut fresh = clusters(&gpu, Bounds::Explicit, Occupancy::Sparse).expect("clusters");
            let all = wall.draw(&mut fresh, &buffer, back_m);
            assert_eq!(drawn.groups(), all.groups());
            let (now, whole) = (drawn.lists.counters, all.lists.counters);
            assert_eq!(
                assign::Counters { cursor: 0, ..now },
                assign::Counters { cursor: 0, ..whole }
            );
            let written = now.cursor.wrapping_sub(cursor);
            cursor = now.cursor;
            (written, drawn)
        };
        assert_eq!(next(&moving, 0.0).0, 0, "nothing changed");
        moving[44].intensity *= 0.5;
        assert_eq!(next(&moving, 0.0).0, 0, "light that is less bright reaches as far");
        moving[44].position.x += 0.1;
        let (written, drawn) = next(&moving, 0.0);
        assert!(drawn.is_update() && !drawn.passes.contains_key("bounds"), "{:?}", drawn.passes);
        assert!((1..requested as u32 / 4).contains(&written), "{written} of {requested}");
        // A light that jumps touches the groups that it leaves. A new order shifts the slots between its
        // two places, and their lights count as changed.
        moving[0].position = Vec3::new(9.0, 9.0, 0.0);
        let most = if order == LightOrder::Given { requested / 2 } else { requested };
        let (written, _) = next(&moving, 0.0);
        assert!((1..=most as u32).contains(&written), "{written} of {requested}");
        // A full pool starts again.
        let mut starts = 0;
        for frame in 0..24 {
            let way = if frame % 2 == 0 { 0.1 } else { -0.1 };
            // Those at the border would leave the box.
            (41..49).chain(51..59).for_each(|ix: usize| moving[ix].position.x += way);
            let (written, drawn) = next(&moving, 0.0);
            assert!(drawn.is_update());
            starts += u32::from(written > 1 << 31);
        }
        assert!(starts > 0, "the pool never filled");
        // A spot that turns reaches other groups, though its ball stays.
        if let LightShape::Spot { direction, .. } = &mut moving[SPOT].shape {
            *direction = Vec3::X;
        }
        let (written, drawn) = next(&moving, 0.0);
        assert!(drawn.is_update() && written > 0);
        for light in &mut moving {
            light.position.z *= 0.99;
        }
        next(&moving, 0.0);
        // Lights out of the box, and another view, need new groups.
        moving[0].position.z = 4.5;
        assert!(!next(&moving, 0.0).1.is_update());
        assert!(!next(&moving, 0.1).1.is_update());
        assert!(next(&moving, 0.1).1.is_update());
    }
}

#[test]
fn more_changes_than_there_is_room_for_touch_all_groups() {
    let gpu = Gpu::open(None).expect("a GPU");
    let depth = conformance::flat_depth(&gpu, SIZE, 0.1 / 12.0);
    let wall = Wall { gpu: gpu.clone(), depth };
    let mut strategy = touched(Bounds::Implicit, Occupancy::Dense)(&gpu).expect("a strategy");
    let mut moving: Vec<Light> = (0..20)
        .flat_map(|layer| {
            lights().into_iter().map(move |mut light| {
                light.position.z += layer as f32 * 0.1;
                light
            })
        })
        .collect();
    let mut buffer = LightBuffer::new(&gpu, &moving).expect("lights");
    while !wall.draw(&mut *strategy, &buffer, 0.0).is_update() {}
    moving.iter_mut().for_each(|light| light.position.x = (light.position.x * 0.9).max(0.5));
    moving[0].position.x = 0.0;
    buffer.update(&gpu, &moving).expect("lights");
    let drawn = wall.draw(&mut *strategy, &buffer, 0.0);
    let counters = drawn.lists.counters;
    assert!(drawn.is_update());
    assert_eq!(u64::from(counters.cursor), counters.requested());
    let mut fresh = clusters(&gpu, Bounds::Implicit, Occupancy::Dense).expect("clusters");
    wall.draw(&mut fresh, &buffer, 0.0);
    assert_eq!(drawn.groups(), wall.draw(&mut fresh, &buffer, 0.0).groups());
}

#[test]
fn no_light_at_all_is_served() {
    let gpu = Gpu::open(None).expect("a GPU");
    let depth = conformance::flat_depth(&gpu, SIZE, 0.1 / 12.0);
    let wall = Wall { gpu: gpu.clone(), depth };
    for order in [LightOrder::Given, LightOrder::Gpu { every: 2 }] {
        let mut strategy = touched(Bounds::Explicit, Occupancy::Sparse)(&gpu).expect("a strategy");
        let mut buffer = LightBuffer::ordered(&gpu, &lights(), order).expect("lights");
        for count in [100, 0, 0, 100, 100] {
            buffer.update(&gpu, &lights()[..count]).expect("lights");
            wall.draw(&mut *strategy, &buffer, 0.0);
        }
    }
}

#[test]
fn strategies_that_read_normals_are_refused() {
    let gpu = Gpu::open(None).expect("a GPU");
    let (size, normals) = ("8x8x8".parse().expect("a size"), Normals::Bins(6));
    let settings = CullSettings::default();
    let plain = ClusterOptions::new(size, Bounds::Explicit, Occupancy::Sparse, settings);
    let split = Clustered::with_options(&gpu, ClusterOptions { normals, ..plain });
    let split = split.expect("a strategy");
    assert!(Touched::new(&gpu, Box::new(split)).is_err());
}
