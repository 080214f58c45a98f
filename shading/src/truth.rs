//! Which lights reach which point, on the CPU in f64.

use assign::{ENTRY_DIFFUSE, ENTRY_SPECULAR, Light, Sun, Suns};
use glam::{DVec3, Vec3A};
use obvhs::{aabb::Aabb, bvh2::Bvh2};
use scenes::{BuildEffort, build_hierarchy};

/// A pair closer to the edge of the light's support than this share of it does not count as missed.
/// The window is below 2e-11 there.
pub const EDGE: f64 = 1e-6;

/// A hierarchy over the bounding boxes of lights. It shares no code with any strategy.
pub struct LightBvh<'a> {
    lights: &'a [Light],
    bvh: Bvh2,
    suns: Suns,
}

/// Whether a list misses a light at a sample: the light reaches the sample, and the list lacks it or the flag of a
/// term that reaches. `listed` are the flags of the light's entry, 0 without an entry. A pair closer to the
/// [`EDGE`] than that share does not count. `normal` is the sample's, for strategies that know normals: their
/// lists need no light below the sample's horizon.
pub fn is_missed(light: &Light, listed: u32, point: DVec3, normal: Option<DVec3>) -> bool {
    let diffuse = light.diffuse_reach(point) > EDGE;
    let needed = ENTRY_SPECULAR | if diffuse { ENTRY_DIFFUSE } else { 0 };
    light.reach(point) > EDGE
        && needed & !listed != 0
        && normal.is_none_or(|normal| light.above_horizon(point, normal) > EDGE)
}

impl<'a> LightBvh<'a> {
    /// Builds the hierarchy.
    pub fn new(lights: &'a [Light]) -> Self {
        let boxes: Vec<Aabb> = lights
            .iter()
            .map(|light| {
                // The box is a little larger than the range, because traversal decides in f32.
                let reach = light.radius_m() * 1.000_01 + light.position.abs().max_element() * 1e-6;
                Aabb::new((light.position - reach).into(), (light.position + reach).into())
            })
            .collect();
        let bvh = build_hierarchy(&boxes, BuildEffort::Thorough);
        Self { lights, bvh, suns: Suns::default() }
    }

    /// The same with suns, which reach every sample and appear in no list.
    #[must_use]
    pub fn with_suns(self, suns: Suns) -> Self {
        Self { suns, ..self }
    }

    /// The suns.
    pub fn suns(&self) -> &[Sun] {
        self.suns.as_slice()
    }

    /// The lights over which it was built.
    pub fn lights(&self) -> &'a [Light] {
        self.lights
    }

    /// Calls `found` with the index and the [`Light::reach`] of every light that reaches `point`.
    pub fn lights_at(&self, point: [f32; 3], mut found: impl FnMut(u32, f64)) {
        let exact = DVec3::from(point.map(f64::from));
        self.bvh.point_traverse(Vec3A::from(point), |bvh, node| {
            let node = &bvh.nodes[node as usize];
            let leaves = node.first_index..node.first_index + node.prim_count;
            for leaf in leaves {
                let light = bvh.primitive_indices[leaf as usize];
                let reach = self.lights[light as usize].reach(exact);
                if reach > 0.0 {
                    found(light, reach);
                }
            }
            true
        });
    }
}

#[cfg(test)]
mod tests {
    use assign::{Emitter, LightShape};
    use glam::Vec3;

    use super::*;

    fn lights(count: u32) -> Vec<Light> {
        (0..count).map(|i| Light::point(Vec3::new(i as f32, 0.0, 0.0), 1.5, Vec3::ONE)).collect()
    }

    #[test]
    fn lights_at_one_place_or_in_a_row_take_seconds() {
        let start = std::time::Instant::now();
        for apart_m in [0.0, 2.0] {
            let at = |ix: u32| Vec3::new(ix as f32 * apart_m, 0.0, 0.0);
            let lights: Vec<Light> =
                (0..100_000).map(|ix| Light::point(at(ix), 1.5, Vec3::ONE)).collect();
            let mut found = 0;
            LightBvh::new(&lights).lights_at([0.1, 0.0, 0.0], |_, _| found += 1);
            assert_eq!(found, if apart_m > 0.0 { 1 } else { 100_000 });
        }
        let seconds = start.elapsed().as_secs_f64();
        println!("{seconds:.2} s");
        assert!(seconds < 30.0, "{seconds} s");
    }

    /// Lights of every kind along a line, with some emitters much larger than their range.
    fn mixed(count: u32) -> Vec<Light> {
        let mut lights = lights(count);
        for (ix, light) in lights.iter_mut().enumerate() {
            let shape = match ix % 4 {
                0 => continue,
                1 => LightShape::Spot { direction: Vec3::Y, inner_angle: 0.2, outer_angle: 1.2 },
                2 => LightShape::Vpl { normal: Vec3::NEG_Z, min_distance_m: 0.0 },
                _ => {
                    let emitter = Emitter::rectangle(5.0 * Vec3::X, 0.5 * Vec3::Y);
                    LightShape::Area(if ix % 8 == 3 { emitter.two_sided() } else { emitter })
                }
            };
            (light.shape, light.range_m) = (shape, 0.4 + 0.2 * (ix % 5) as f32);
        }
        lights
    }

    #[test]
    fn the_hierarchy_finds_what_a_loop_finds() {
        let lights = mixed(200);
        let bvh = LightBvh::new(&lights);
        let mut beyond_the_middles_range = 0;
        for step in 0..400 {
            let point = [step as f32 * 0.5 + 0.01, 0.3, -0.2];
            let mut found = Vec::new();
            bvh.lights_at(point, |light, _| found.push(light));
            found.sort_unstable();
            let exact = DVec3::from(point.map(f64::from));
            let looped: Vec<u32> =
                (0..200).filter(|&i| lights[i as usize].reach(exact) > 0.0).collect();
            assert_eq!(found, looped, "at {point:?}");
            let is_beyond = |light: &Light| {
                exact.distance(light.position.as_dvec3()) > f64::from(light.range_m)
            };
            let beyond = looped.iter().filter(|&&ix| is_beyond(&lights[ix as usize]));
            beyond_the_middles_range += beyond.count();
        }
        assert!(beyond_the_middles_range > 400, "{beyond_the_middles_range}");
    }
}
