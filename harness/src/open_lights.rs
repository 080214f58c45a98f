//! The note about lights that have no range in their file.

use assign::Light;
use scenes::LOST;

use crate::digits::rounded;

/// Lights without a range in their file, and the ranges that they got.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenLights {
    /// The number of these lights.
    pub count: u64,
    /// The largest irradiance at the end of one of them: intensity / range^2.
    pub threshold: f64,
    /// The shortest and the longest range, metres.
    ranges_m: (f32, f32),
}

impl OpenLights {
    /// The valid lights among those at the indices `open`; `None` if there are none.
    pub fn new(lights: &[Light], open: &[u32]) -> Option<Self> {
        let lights = open.iter().filter_map(|&ix| lights.get(ix as usize));
        let one = |light: &Light| Self {
            count: 1,
            threshold: f64::from(light.intensity.max_element()) / f64::from(light.range_m).powi(2),
            ranges_m: (light.range_m, light.range_m),
        };
        lights.filter(|light| light.check().is_ok()).map(one).reduce(|a, b| Self {
            count: a.count + b.count,
            threshold: a.threshold.max(b.threshold),
            ranges_m: (a.ranges_m.0.min(b.ranges_m.0), a.ranges_m.1.max(b.ranges_m.1)),
        })
    }

    /// States their number, their ranges, the lost light, and the options that change it.
    pub fn note(&self) -> String {
        let Self { count, threshold, ranges_m: (shortest, longest) } = *self;
        let (lights, their, end) = match count {
            1 => ("light has", "its", "ends"),
            _ => ("lights have", "their", "end"),
        };
        let at = match shortest == longest {
            true => rounded(longest.into()),
            false => format!("{} to {}", rounded(shortest.into()), rounded(longest.into())),
        };
        format!(
            "{count} {lights} no range in {their} file, and {end} at {at} m, where a surface receives {} lux. \
             Each light loses at most {} lux on a surface: --threshold moves its end, --unbounded measures \
             the loss",
            rounded(threshold),
            rounded(LOST * threshold)
        )
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn the_note_states_number_range_and_loss() {
        let lamp = |range_m, intensity| Light::point(Vec3::ZERO, range_m, Vec3::splat(intensity));
        let lights = [lamp(10.0, 2.0), lamp(3.0, 9.0), lamp(20.0, 8.0), lamp(1.0, f32::NAN)];
        assert_eq!(OpenLights::new(&lights, &[]), None);
        assert_eq!(OpenLights::new(&lights, &[3]), None);
        let open = OpenLights::new(&lights, &[0, 2, 3]).expect("two are sound");
        assert_eq!(open.count, 2);
        let note = open.note();
        assert!(note.starts_with("2 lights have no range in their file"), "{note}");
        for part in ["end at 10 to 20 m", "receives 0.02 lux", "at most 0.02178 lux"] {
            assert!(note.contains(part), "{note}");
        }
    }
}
