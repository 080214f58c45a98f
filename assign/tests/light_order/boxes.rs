//! The boxes over the lights, of every level, are those of what lies below them.

use std::ops::Range;

use assign::{
    Gpu, Light, LightBuffer, LightNode, LightOrder, conformance::download, intersect::LightVolume,
};
use glam::Vec3;

use crate::{gpu, lights, mixed, own::Own, record};

/// Children of a box.
const CHILDREN: usize = 64;

/// How much larger than the lights a box may be, as a share of their distance from the origin.
const SLACK: f32 = 1e-5;

/// The lights by slot, and the boxes over them.
struct Boxes {
    slots: Vec<Light>,
    nodes: Vec<LightNode>,
    /// The places of each level, from the lowest.
    levels: Vec<Range<usize>>,
}

/// Checks the boxes of every level.
pub(crate) fn check_boxes(gpu: &Gpu, buffer: &LightBuffer) {
    Boxes::read(gpu, buffer).check().unwrap();
}

impl Boxes {
    fn read(gpu: &Gpu, buffer: &LightBuffer) -> Self {
        let mut below = (buffer.spheres().size() / 16) as usize;
        let mut levels = Vec::new();
        let mut end = 0;
        for _ in 0..buffer.traits().levels {
            below = below.div_ceil(CHILDREN);
            levels.push(end..end + below);
            end += below;
        }
        let nodes = download(gpu, buffer.nodes(), end).unwrap();
        Self { slots: buffer.read(gpu).unwrap(), nodes, levels }
    }

    fn check(&self) -> Result<(), String> {
        for (ix, node) in self.nodes[self.levels[0].clone()].iter().enumerate() {
            let end = self.slots.len().min(CHILDREN * (ix + 1));
            let slots = self.slots.get(CHILDREN * ix..end).unwrap_or_default();
            let lit: Vec<&Light> = slots.iter().filter(|l| l.intensity != Vec3::ZERO).collect();
            if let Some(wrong) = wrong_box(node, &lit) {
                return Err(format!("box {ix} over {} lights: {wrong}: {node:?}", lit.len()));
            }
        }
        for (level, pair) in (2..).zip(self.levels.windows(2)) {
            let children = &self.nodes[pair[0].clone()];
            let parents = &self.nodes[pair[1].clone()];
            for (ix, (parent, children)) in
                parents.iter().zip(children.chunks(CHILDREN)).enumerate()
            {
                // Boxes without a light have their corners the wrong way round.
                let joined = children.iter().map(corners).reduce(join).unwrap();
                if corners(parent) != joined {
                    return Err(format!("box {ix} of level {level}: {parent:?}, not {joined:?}"));
                }
            }
        }
        Ok(())
    }
}

fn corners(node: &LightNode) -> (Vec3, Vec3) {
    (node.min_world.into(), node.max_world.into())
}

fn join(a: (Vec3, Vec3), b: (Vec3, Vec3)) -> (Vec3, Vec3) {
    (a.0.min(b.0), a.1.max(b.1))
}

/// What is wrong with the box around some lights.
fn wrong_box(node: &LightNode, lights: &[&Light]) -> Option<&'static str> {
    let (low, high) = corners(node);
    let of_light = |light: &&Light| {
        let volume = LightVolume::from(*light);
        let along = |axis: Vec3| volume.extent_along(axis);
        let below = Vec3::new(along(Vec3::NEG_X), along(Vec3::NEG_Y), along(Vec3::NEG_Z));
        let above = Vec3::new(along(Vec3::X), along(Vec3::Y), along(Vec3::Z));
        (light.position - below, light.position + above)
    };
    let Some(exact) = lights.iter().map(of_light).reduce(join) else {
        return low.cmple(high).any().then_some("it is not empty");
    };
    if low.cmpgt(exact.0).any() || high.cmplt(exact.1).any() {
        return Some("a light juts out");
    }
    let farthest = lights.iter().map(|l| l.position.abs().max_element() + l.radius_m());
    let slack = SLACK * farthest.fold(0.0, f32::max);
    let is_loose = low.cmplt(exact.0 - slack).any() || high.cmpgt(exact.1 + slack).any();
    is_loose.then_some("it is too large")
}

#[test]
fn boxes_hold_the_lights_in_every_frame_of_a_stale_order() {
    let gpu = gpu();
    let order = LightOrder::Gpu { every: 3 };
    // Numbers of lights that grow and shrink, with and without a sort.
    for counts in [[700, 650, 800, 720, 640], [30_000, 29_000, 31_000, 30_500, 28_000]] {
        let mut buffer = LightBuffer::ordered(&gpu, &mixed(counts[0], 0), order).unwrap();
        record(&gpu, &buffer);
        for (seed, &count) in (1..).zip(&counts) {
            let given = if count < 1000 { mixed(count, seed) } else { lights(count, seed) };
            buffer.update(&gpu, &given).unwrap();
            record(&gpu, &buffer);
            check_boxes(&gpu, &buffer);
            // Every light has one slot.
            let mut names: Vec<u32> = buffer
                .read(&gpu)
                .unwrap()
                .iter()
                .filter(|light| light.intensity != Vec3::ZERO)
                .map(|light| light.intensity.x as u32)
                .collect();
            names.sort_unstable();
            assert_eq!(names, (1..=count).collect::<Vec<_>>(), "{count} lights, frame {seed}");
        }
    }
}

/// Few lights in a buffer with room for so many that their boxes have three levels. Faulty ones lie
/// between them, so that lights are below the first and the last box of each level.
#[test]
fn three_levels_of_boxes_hold_lights_of_all_kinds() {
    let gpu = gpu();
    let empty = Light::point(Vec3::splat(51.0), 0.0, Vec3::ONE);
    let mut given = vec![empty; 262_145];
    for (place, light) in given.iter_mut().step_by(100).zip(mixed(2_600, 1)) {
        *place = light;
    }
    let own = Own::new(&gpu, &given);
    let buffer = LightBuffer::from_gpu(&gpu, &own.lights(given.len() as u32), 1).unwrap();
    record(&gpu, &buffer);
    let counts = buffer.read_counts(&gpu).unwrap().unwrap();
    assert_eq!(counts.faulty as usize, given.len() - 2_600);
    let mut boxes = Boxes::read(&gpu, &buffer);
    assert_eq!(boxes.levels.len(), 3);
    boxes.check().unwrap();
    // Negative controls: a light juts out of one box of each level, and a box lies around no light.
    for places in boxes.levels.clone() {
        let (first, last) = (places.start, places.end - 1);
        for place in [first, last] {
            let whole = boxes.nodes[place];
            assert!(whole.min_world[0] < whole.max_world[0], "no light below {place}");
            boxes.nodes[place].max_world[0] = whole.max_world[0].next_down() - 1e-3;
            assert!(boxes.check().is_err(), "a box at place {place} that is too small");
            boxes.nodes[place].max_world[0] = whole.max_world[0] + 0.1;
            assert!(boxes.check().is_err(), "a box at place {place} that is too large");
            boxes.nodes[place] = whole;
        }
    }
    let places = boxes.levels[0].clone();
    let empty = boxes.nodes[places].iter().position(|node| node.min_world[0] > node.max_world[0]);
    boxes.nodes[empty.unwrap()] = LightNode::default();
    assert!(boxes.check().is_err(), "a box around no light");
}
