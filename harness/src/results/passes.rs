//! The passes of a frame and their times.

use std::fmt;

use serde::de::{MapAccess, Visitor};
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::stats::{median, percentile};

/// The purpose of a pass, which decides its bill.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PassKind {
    /// Draws surfaces: depth pre-pass, G-buffer.
    Scene,
    /// Assigns lights: bounds, prefix sums, culling.
    Assign,
    /// Lights pixels.
    Shade,
    /// Anything else: makes the lights.
    #[default]
    Other,
}

/// The times of one pass.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PassTimes {
    /// The purpose of the pass.
    #[serde(default)]
    pub kind: PassKind,
    /// Median of the samples, ms.
    #[serde(deserialize_with = "nan_from_null")]
    pub median_ms: f64,
    /// 95th percentile of the samples by nearest rank, ms.
    #[serde(deserialize_with = "nan_from_null")]
    pub p95_ms: f64,
    /// One time per frame, ms, in the order of the frames.
    #[serde(deserialize_with = "nans_from_nulls")]
    pub samples: Vec<f64>,
}

impl PassTimes {
    /// The times of a pass with their median and 95th percentile.
    pub fn new(kind: PassKind, samples: Vec<f64>) -> Self {
        Self { kind, median_ms: median(&samples), p95_ms: percentile(&samples, 0.95), samples }
    }
}

/// The times from the first of some passes to the last, including gaps, one per frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Spans {
    /// Of the passes that assign lights and light pixels, ms.
    #[serde(deserialize_with = "nans_from_nulls", alias = "assign_and_shade_ms")]
    pub assign_and_shade_samples_ms: Vec<f64>,
    /// Of all passes, ms.
    #[serde(deserialize_with = "nans_from_nulls", alias = "frame_ms")]
    pub frame_samples_ms: Vec<f64>,
}

/// The passes of a frame by name, in the order in which they run. A map in JSON.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Passes(Vec<(String, PassTimes)>);

impl Passes {
    /// Appends a pass, or replaces the pass of the same name.
    pub fn insert(&mut self, name: impl Into<String>, times: PassTimes) {
        let name = name.into();
        match self.0.iter_mut().find(|(known, _)| *known == name) {
            Some((_, old)) => *old = times,
            None => self.0.push((name, times)),
        }
    }

    /// The pass of that name.
    pub fn get(&self, name: &str) -> Option<&PassTimes> {
        self.iter().find_map(|(known, times)| (known == name).then_some(times))
    }

    /// Names and times, in the order in which the passes run.
    pub fn iter(&self) -> impl Iterator<Item = (&str, &PassTimes)> {
        self.0.iter().map(|(name, times)| (name.as_str(), times))
    }

    /// The time per frame of all passes of a kind (`None`: of all passes), ms. It has as many frames as the
    /// pass with the fewest samples.
    pub fn per_frame_ms(&self, kind: Option<PassKind>) -> Vec<f64> {
        self.per_frame_where(|_, pass| kind.is_none_or(|kind| pass == kind))
    }

    /// The time per frame of the passes that are counted by name and kind, ms.
    pub fn per_frame_where(&self, is_counted: impl Fn(&str, PassKind) -> bool) -> Vec<f64> {
        let counted: Vec<&[f64]> = self
            .0
            .iter()
            .filter(|(name, times)| is_counted(name, times.kind))
            .map(|(_, times)| times.samples.as_slice())
            .collect();
        let frames = counted.iter().map(|samples| samples.len()).min();
        let mut sums = vec![0.0; frames.unwrap_or(0)];
        for samples in counted {
            sums.iter_mut().zip(samples).for_each(|(sum, sample)| *sum += sample);
        }
        sums
    }

    /// Bills passes again, by name.
    pub(super) fn bill_again(&mut self, kind: impl Fn(&str, PassKind) -> PassKind) {
        for (name, times) in &mut self.0 {
            times.kind = kind(name, times.kind);
        }
    }

    /// Whether there is a pass of a kind (any pass: `None`).
    pub fn has(&self, kind: Option<PassKind>) -> bool {
        self.0.iter().any(|(_, times)| kind.is_none_or(|kind| times.kind == kind))
    }

    /// Median over frames of [`per_frame_ms`](Self::per_frame_ms); 0 without such a pass.
    pub fn median_ms(&self, kind: Option<PassKind>) -> f64 {
        if self.has(kind) { median(&self.per_frame_ms(kind)) } else { 0.0 }
    }
}

impl<N: Into<String>> FromIterator<(N, PassTimes)> for Passes {
    fn from_iter<I: IntoIterator<Item = (N, PassTimes)>>(passes: I) -> Self {
        let mut all = Self::default();
        for (name, times) in passes {
            all.insert(name, times);
        }
        all
    }
}

impl Serialize for Passes {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        for (name, times) in &self.0 {
            map.serialize_entry(name, times)?;
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for Passes {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct InOrder;

        impl<'de> Visitor<'de> for InOrder {
            type Value = Passes;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a map from pass names to times")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Passes, A::Error> {
                let mut passes = Passes::default();
                while let Some((name, times)) = map.next_entry::<String, PassTimes>()? {
                    passes.insert(name, times);
                }
                Ok(passes)
            }
        }

        deserializer.deserialize_map(InOrder)
    }
}

/// JSON has no NaN. It is written as `null`, and this function reads it back.
pub(super) fn nan_from_null<'de, D: Deserializer<'de>>(deserializer: D) -> Result<f64, D::Error> {
    Ok(Option::deserialize(deserializer)?.unwrap_or(f64::NAN))
}

fn nans_from_nulls<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<f64>, D::Error> {
    let samples: Vec<Option<f64>> = Vec::deserialize(deserializer)?;
    Ok(samples.into_iter().map(|sample| sample.unwrap_or(f64::NAN)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn passes() -> Passes {
        Passes::from_iter([
            ("z pre-pass", PassTimes::new(PassKind::Scene, vec![1.0, 1.0, 1.0])),
            ("cull", PassTimes::new(PassKind::Assign, vec![1.0, 5.0, 2.0])),
            ("bounds", PassTimes::new(PassKind::Assign, vec![4.0, 0.0, 2.0])),
        ])
    }

    #[test]
    fn kinds_are_summed_per_frame_before_the_median() {
        assert_eq!(passes().per_frame_ms(Some(PassKind::Assign)), [5.0, 5.0, 4.0]);
        assert_eq!(passes().median_ms(Some(PassKind::Assign)), 5.0);
        assert_eq!(passes().median_ms(None), 6.0);
        assert_eq!(passes().median_ms(Some(PassKind::Shade)), 0.0);
    }

    #[test]
    fn json_keeps_the_order_of_passes() {
        let json = serde_json::to_string(&passes()).expect("serialises");
        let back: Passes = serde_json::from_str(&json).expect("parses");
        assert_eq!(back, passes());
        let names: Vec<_> = back.iter().map(|(name, _)| name).collect();
        assert_eq!(names, ["z pre-pass", "cull", "bounds"]);
    }

    #[test]
    fn json_keeps_a_sample_that_is_not_a_number() {
        let json = serde_json::to_string(&PassTimes::new(PassKind::Shade, vec![f64::NAN]))
            .expect("serialises");
        let back: PassTimes = serde_json::from_str(&json).expect("parses");
        assert!(back.samples[0].is_nan() && back.median_ms.is_nan());
    }
}
