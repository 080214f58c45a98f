//! The order of lights in their buffer.
//!
//! Lists ascend in light index. If the order follows space, lights that are close in space are
//! close in every list and in memory, and boxes around consecutive lights are small: see
//! [`light_nodes`](crate::light_nodes).

#[cfg(feature = "still-lights")]
mod leaves;

use std::{fmt, str::FromStr};

use glam::Vec3;

use crate::{AssignError, Light};

/// The order of lights in the buffer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum LightOrder {
    /// The renderer's order.
    #[default]
    Given,
    /// By the Morton code of the lights' positions, 21 bits per axis.
    Morton,
    /// The leaves, depth first, of a bounding volume hierarchy over the lights' supports. The CPU
    /// builds it, so it suits lights that do not move. It needs the feature `still-lights`.
    #[cfg(feature = "still-lights")]
    Bvh,
    /// By a code of the lights' positions. The GPU sorts the lights and builds the hierarchy, on the
    /// clock: see [`LightBuffer::record`](crate::LightBuffer::record).
    Gpu {
        /// The lights are sorted anew in every `every`th frame. In the frames between, the order is
        /// that of earlier positions, and the boxes are larger. Lists are complete either way.
        every: u32,
    },
    /// As [`Gpu`](Self::Gpu), but the lights are sorted anew as soon as their boxes may have grown by a
    /// share of the side that the boxes of 64 evenly spread lights have. How far lights moved
    /// ([`LightBuffer::travel`](crate::LightBuffer::travel)) bounds the growth.
    GpuGrown {
        /// The share, in percent; at least 1.
        percent: u32,
    },
}

/// The order that only the feature `still-lights` has, as messages list it.
const BVH: &str = if cfg!(feature = "still-lights") { "bvh, " } else { "" };

impl LightOrder {
    /// Whether the GPU sorts the lights.
    pub fn is_on_gpu(self) -> bool {
        matches!(self, Self::Gpu { .. } | Self::GpuGrown { .. })
    }

    /// The lights' indices in this order.
    pub(crate) fn indices(self, lights: &[Light]) -> Vec<u32> {
        match self {
            // The GPU sorts them.
            Self::Given | Self::Gpu { .. } | Self::GpuGrown { .. } => {
                (0..lights.len() as u32).collect()
            }
            Self::Morton => morton(lights),
            #[cfg(feature = "still-lights")]
            Self::Bvh => leaves::in_order(lights),
        }
    }
}

fn morton(lights: &[Light]) -> Vec<u32> {
    let codes = morton_codes(lights);
    let mut order: Vec<u32> = (0..lights.len() as u32).collect();
    // The sort is stable, so lights at one place keep the renderer's order.
    order.sort_by_key(|&light| codes[light as usize]);
    order
}

fn morton_codes(lights: &[Light]) -> Vec<u64> {
    let low = lights.iter().map(|l| l.position).fold(Vec3::INFINITY, Vec3::min).as_dvec3();
    let high = lights.iter().map(|l| l.position).fold(Vec3::NEG_INFINITY, Vec3::max).as_dvec3();
    let cells = f64::from((1 << 21) - 1);
    let scale = cells / (high - low).max_element().max(f64::MIN_POSITIVE);
    let code = |light: &Light| {
        let cell = ((light.position.as_dvec3() - low) * scale).min(glam::DVec3::splat(cells));
        cell.to_array()
            .iter()
            .enumerate()
            .fold(0, |code, (axis, &x)| code | spread(x as u64) << axis)
    };
    lights.iter().map(code).collect()
}

/// Puts two zero bits between each of the low 21 bits.
fn spread(x: u64) -> u64 {
    let x = (x | x << 32) & 0x001f_0000_0000_ffff;
    let x = (x | x << 16) & 0x001f_0000_ff00_00ff;
    let x = (x | x << 8) & 0x100f_00f0_0f00_f00f;
    let x = (x | x << 4) & 0x10c3_0c30_c30c_30c3;
    (x | x << 2) & 0x1249_2492_4924_9249
}

impl fmt::Display for LightOrder {
    /// As [`FromStr`] reads it: `gpu8` for lights that the GPU sorts in every eighth frame.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Given => f.write_str("given"),
            Self::Morton => f.write_str("morton"),
            #[cfg(feature = "still-lights")]
            Self::Bvh => f.write_str("bvh"),
            Self::Gpu { every: 1 } => f.write_str("gpu"),
            Self::Gpu { every } => write!(f, "gpu{every}"),
            Self::GpuGrown { percent } => write!(f, "gpu{percent}%"),
        }
    }
}

impl FromStr for LightOrder {
    type Err = AssignError;

    fn from_str(text: &str) -> Result<Self, AssignError> {
        let lower = text.to_lowercase();
        let number = |digits: &str| {
            let is_plain = digits.bytes().all(|byte| byte.is_ascii_digit());
            digits.parse().ok().filter(|&number: &u32| is_plain && number > 0)
        };
        let gpu = lower.strip_prefix("gpu").and_then(|rest| match rest.strip_suffix('%') {
            _ if rest.is_empty() => Some(Self::Gpu { every: 1 }),
            Some(percent) => Some(Self::GpuGrown { percent: number(percent)? }),
            None => Some(Self::Gpu { every: number(rest)? }),
        });
        match (lower.as_str(), gpu) {
            ("given", _) => Ok(Self::Given),
            ("morton", _) => Ok(Self::Morton),
            #[cfg(feature = "still-lights")]
            ("bvh", _) => Ok(Self::Bvh),
            (_, Some(order)) => Ok(order),
            _ => Err(AssignError::Parameter {
                field: "light order".into(),
                value: text.into(),
                accepted: format!(
                    "given, morton, {BVH}gpu, gpuN for a sort in every Nth frame, or gpuN% for one as soon as \
                     boxes may have grown by N percent"
                ),
            }),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light_nodes::light_box;

    fn lights(count: u32) -> Vec<Light> {
        (0..count)
            .map(|i| {
                let x = i.wrapping_mul(2_654_435_761);
                let at = [x >> 22, (x >> 11) & 1023, x & 1023].map(|v| v as f32 * 0.1);
                Light::point(Vec3::from(at), 0.5 + (i % 7) as f32 * 0.3, Vec3::ONE)
            })
            .collect()
    }

    /// Mean diagonal of the boxes around every 64 consecutive lights, metres.
    fn spread_of(order: LightOrder, lights: &[Light]) -> f32 {
        let order = order.indices(lights);
        let diagonals: Vec<f32> = order
            .chunks(64)
            .map(|chunk| {
                let boxes = chunk.iter().map(|&i| light_box(&lights[i as usize]));
                let (min, max) = boxes.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap();
                min.distance(max)
            })
            .collect();
        diagonals.iter().sum::<f32>() / diagonals.len() as f32
    }

    #[test]
    fn names_are_read_back() {
        for name in ["given", "morton", "bvh", "gpu", "gpu8", "gpu25%"] {
            assert_eq!(name.parse::<LightOrder>().unwrap().to_string(), name);
        }
        for wrong in ["gpu0", "gpu-1", "gpu+8", "gpu0%", "gpu%", "gpux", "hilbert", ""] {
            let error = wrong.parse::<LightOrder>().unwrap_err().to_string();
            assert!(error.contains("gpuN"), "{error}");
        }
    }

    #[test]
    fn orders_are_permutations() {
        for count in [0, 1, 2, 63, 64, 65, 1000] {
            for order in [LightOrder::Given, LightOrder::Morton, LightOrder::Bvh] {
                let mut indices = order.indices(&lights(count));
                indices.sort_unstable();
                assert_eq!(indices, (0..count).collect::<Vec<_>>(), "{order}");
            }
        }
    }

    #[test]
    fn orders_follow_space() {
        let lights = lights(5000);
        let given = spread_of(LightOrder::Given, &lights);
        for order in [LightOrder::Morton, LightOrder::Bvh] {
            let ordered = spread_of(order, &lights);
            assert!(
                ordered < 0.4 * given,
                "{order}: boxes of {ordered} m, in given order {given} m"
            );
        }
    }

    #[test]
    fn coincident_lights_keep_their_order() {
        let lights = vec![Light::point(Vec3::ONE, 1.0, Vec3::ONE); 30_000];
        for order in [LightOrder::Morton, LightOrder::Bvh] {
            assert!(order.indices(&lights).is_sorted(), "{order}");
        }
    }

    #[test]
    fn rows_of_equal_lights_take_seconds() {
        for at_one_place in [1, 2, 4] {
            let at = |ix: u32| Vec3::new((ix / at_one_place) as f32, 0.0, 0.0);
            let lights: Vec<Light> =
                (0..150_000).map(|ix| Light::point(at(ix), 1.5, Vec3::ONE)).collect();
            let start = std::time::Instant::now();
            let mut order = LightOrder::Bvh.indices(&lights);
            let seconds = start.elapsed().as_secs_f64();
            println!("{at_one_place} lights per place took {seconds:.2} s");
            assert!(seconds < 30.0, "{at_one_place} lights per place took {seconds} s");
            order.sort_unstable();
            assert_eq!(order, (0..150_000).collect::<Vec<_>>());
        }
    }

    #[test]
    fn extreme_places_are_ordered_without_panic() {
        let mut lights = lights(100);
        lights[3].position = Vec3::splat(3e38);
        lights[5].position = Vec3::splat(-3e38);
        lights[7].range_m = 1e9;
        for order in [LightOrder::Morton, LightOrder::Bvh] {
            let mut indices = order.indices(&lights);
            indices.sort_unstable();
            assert_eq!(indices, (0..100).collect::<Vec<_>>(), "{order}");
        }
    }
}
