//! Methods chosen by their ids: `FAMILY/PARAMETERS/TESTS/SOURCE`, segments after the first in any
//! order.

use std::collections::BTreeMap;

use assign::{AreaBounds, AssignError, Assignment, FrustumTests, Gpu, LightSource, Reuse};
use assign_clustered::SpecularCut;
use serde_json::Value;
use shading::RASTER_SPHERE_TOLERANCE;

use crate::{
    cli::{CliError, CompareArgs},
    registry::{Axis, Method, STRATEGIES, Spec, StrategyEntry},
};

mod segments;
mod specular;

use segments::CAP;

/// Names every method, at its default parameters.
pub const ALL: &str = "all";

/// A method chosen by its id.
#[derive(Clone)]
pub struct Choice {
    entry: &'static StrategyEntry,
    spec: Spec,
    /// Whether the id says which tests, and which source.
    says: (bool, bool),
    /// Whether it was named, and not meant by [`ALL`].
    pub is_named: bool,
    id: String,
}

/// All methods that a command line asks for, in its order.
pub fn choices(args: &CompareArgs) -> Result<Vec<Choice>, CliError> {
    let mut named = Vec::new();
    for id in &args.strategies.0 {
        if id.eq_ignore_ascii_case(ALL) {
            for entry in STRATEGIES {
                named.push(Choice { is_named: false, ..Choice::parse(entry.family)? });
            }
        } else {
            named.push(Choice::parse(id)?);
        }
    }
    let mut choices = Vec::new();
    for mut choice in named {
        if let Some(tests) = args.test.filter(|_| !choice.says.0) {
            choice.spec.settings.tests = tests;
        }
        let is_fixed = choice.says.1 || !choice.entry.axes.contains(&Axis::Source);
        let fixed = [choice.spec.settings.source];
        for source in if is_fixed { &fixed } else { args.sources() } {
            choice.spec.settings.source = *source;
            choice.check_bounds()?;
            choices.push(choice.clone());
        }
    }
    Ok(choices)
}

impl Choice {
    /// Makes the method on a device.
    pub fn make(&self, gpu: &Gpu) -> Result<Method, AssignError> {
        let mut method = (self.entry.make)(gpu, &self.spec)?;
        if let Method::Lists { early_exit, .. } = &mut method {
            *early_exit &= !self.spec.evaluates_all;
        }
        Ok(match (method, self.spec.cap, self.spec.reuse) {
            (method, None, None) => method,
            (Method::Lists { mut strategy, early_exit }, cap, reuse) => {
                strategy.lists_mut().cap_lists(cap.unwrap_or(u32::MAX));
                let strategy: Box<dyn Assignment> = match reuse {
                    Some(frames) => Box::new(Reuse::new(strategy, frames)?),
                    None => strategy,
                };
                Method::Lists { strategy, early_exit }
            }
            (method, ..) => method,
        })
    }

    /// Makes the method once, to check its parameters and take its id from the strategy.
    pub fn checked(mut self, gpu: &Gpu) -> Result<Self, AssignError> {
        self.id = match self.make(gpu)? {
            Method::Lists { strategy, .. } if self.has_groups() => {
                let cap = self.spec.cap.map_or_else(String::new, |most| format!("/{CAP}{most}"));
                strategy.id() + &cap + if self.spec.evaluates_all { "/no-exit" } else { "" }
            }
            _ => self.entry.family.to_owned(),
        };
        if !self.spec.parameters.is_empty() {
            let written = self.id.split('/').nth(1).unwrap_or_default();
            self.spec.parameters = written.to_owned();
        }
        Ok(self)
    }

    /// Whether two ids mean the same method, however they are written.
    pub fn is_same(&self, other: &Self) -> bool {
        let parameters = |choice: &Self| -> Vec<String> {
            let sizes = choice.spec.parameters.split('x');
            sizes.map(|size| size.parse().map_or(size.to_owned(), |n: f64| n.to_string())).collect()
        };
        let rest = |choice: &Self| Spec { parameters: String::new(), ..choice.spec.clone() };
        self.entry.family == other.entry.family
            && parameters(self) == parameters(other)
            && rest(self) == rest(other)
    }

    /// The id with parameters.
    pub fn id(&self) -> &str {
        &self.id
    }

    /// The family: the id without parameters.
    pub fn family(&self) -> &'static str {
        self.entry.family
    }

    /// Parameters and settings by name.
    pub fn parameters(&self) -> BTreeMap<String, Value> {
        let number = |text: &str| {
            let whole = text.parse::<u64>().map(Value::from);
            whole.or_else(|_| text.parse::<f64>().map(Value::from)).unwrap_or_else(|_| text.into())
        };
        let values = self.spec.parameters.split('x').filter(|value| !value.is_empty());
        let mut all: BTreeMap<String, Value> = self
            .entry
            .parameters
            .iter()
            .zip(values)
            .map(|(name, value)| ((*name).to_owned(), number(value)))
            .collect();
        let settings = self.spec.settings;
        for axis in self.entry.axes {
            let (name, value) = match axis {
                Axis::Tests => ("tests", settings.tests.to_string()),
                Axis::Source if settings.source == LightSource::Hierarchy => {
                    ("source", "bvh".into())
                }
                Axis::Source => ("source", "linear".into()),
                Axis::Box => ("box", self.spec.grid_box.name().to_owned()),
                Axis::AreaBounds if settings.area_bounds == AreaBounds::Ball => {
                    ("area_bounds", "ball".into())
                }
                Axis::AreaBounds => continue,
                Axis::Normals | Axis::Specular | Axis::Cap | Axis::Reuse | Axis::Exit => continue,
            };
            all.insert(name.to_owned(), value.into());
        }
        let normal_bins = self.spec.normals.is_some().then(|| self.spec.normals.bins());
        let numbers = [
            ("normal_bins", normal_bins),
            ("list_cap", self.spec.cap),
            ("reuse_frames", self.spec.reuse),
        ];
        for (name, value) in numbers {
            all.extend(value.map(|value| (name.to_owned(), value.into())));
        }
        all.extend(specular::parameter(self.spec.specular));
        if self.spec.evaluates_all {
            all.insert("early_exit".into(), false.into());
        }
        all
    }

    /// Whether it may show another image than no culling of that many lights: a knob says so.
    pub fn is_lossy(&self, lights: u64) -> bool {
        self.spec.cap.is_some_and(|most| u64::from(most) < lights)
            || self.is_reused()
            || self.spec.specular != SpecularCut::None
    }

    /// The most lights of a list.
    pub fn cap(&self) -> u32 {
        self.spec.cap.unwrap_or(u32::MAX)
    }

    /// Whether area lights too dull over a group lose their specular term.
    pub fn is_specular_cut(&self) -> bool {
        matches!(self.spec.specular, SpecularCut::Below(_))
    }

    /// Whether lists are used for several frames.
    pub fn is_reused(&self) -> bool {
        self.spec.reuse.is_some_and(|frames| frames > 1)
    }

    /// Whether it cuts the samples into groups, and so has something to assign.
    pub fn has_groups(&self) -> bool {
        self.entry.axes.contains(&Axis::Cap)
    }

    /// Whether it tests lights by what an option says, because its id says nothing.
    pub fn takes_tests(&self) -> bool {
        self.entry.axes.contains(&Axis::Tests) && !self.says.0
    }

    /// Whether it takes lights from where an option says, because its id says nothing.
    pub fn takes_source(&self) -> bool {
        self.entry.axes.contains(&Axis::Source) && !self.says.1
    }

    /// Whether it tests lights against frusta by more than their half spaces: by their corners.
    pub fn tests_corners(&self) -> bool {
        let half_spaces = FrustumTests { hs: true, ..self.spec.settings.tests };
        self.entry.axes.contains(&Axis::Tests) && half_spaces.to_string() != "hs"
    }

    /// The largest relative difference of a channel that the method states of itself; `None` where
    /// it states that no bit differs.
    pub fn tolerance(&self) -> Option<f64> {
        match self.entry.family {
            "RasterSphere" => Some(RASTER_SPHERE_TOLERANCE),
            _ => None,
        }
    }

    /// Whether it is the reference of all images.
    pub fn is_reference(&self) -> bool {
        self.entry.family == crate::results::BASELINE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameters(id: &str) -> String {
        Choice::parse(id).map(|choice| choice.spec.parameters).unwrap()
    }

    fn asked(line: &[&str]) -> Vec<String> {
        let line = [&["lightbench"], line].concat();
        let Ok(crate::cli::Invocation::Compare(args)) = crate::cli::parse(line) else {
            panic!("not understood");
        };
        let gpu = Gpu::noop().unwrap();
        let checked = |choice: Choice| choice.checked(&gpu).unwrap().id().to_owned();
        choices(&args).unwrap().into_iter().map(checked).collect()
    }

    #[test]
    fn ids_are_found_in_any_case_and_complete_themselves() {
        assert_eq!(parameters("sc-e"), "48x48x40");
        assert_eq!(parameters("SC-E/32x16x8"), "32x16x8");
        assert_eq!(asked(&["--strategies", "t-i/BVH/28X28"]), ["T-I/28x28/bvh"]);
        assert_eq!(asked(&["--strategies", "m,M/2"]), ["M", "M/2"]);
        let lights_first = asked(&["--strategies", "hg,HG/32x32x8/CAP8"]);
        assert_eq!(lights_first, ["HG/48x48x40", "HG/32x32x8/cap8"]);
        assert_eq!(asked(&["--strategies", "g/surfaces/8x8x2"]), ["G/8x8x2/surfaces"]);
        let boxes = asked(&["--strategies", "G/positions,G/Supports/bvh,G/8x8x8/lights"]);
        assert_eq!(boxes, ["G/20x20x20", "G/20x20x20/supports/bvh", "G/8x8x8/supports"]);
        let lossy = asked(&["--strategies", "sc-e/cap32/bvh,T-E/reuse4"]);
        assert_eq!(lossy, ["SC-E/48x48x40/bvh/cap32", "T-E/28x28/reuse4"]);
        let balls = asked(&["--strategies", "sc-e/ball,T-I/outline/bvh,g/BALL/surfaces"]);
        let told = ["SC-E/48x48x40/ball", "T-I/28x28/bvh", "G/20x20x20/surfaces/ball"];
        assert_eq!(balls, told);
        assert_eq!(Choice::parse("SC-E/ball").unwrap().parameters()["area_bounds"], "ball");
        let normals = asked(&["--strategies", "sc-e/BVH/N6,SC-E/s0.001/n24"]);
        assert_eq!(normals, ["SC-E/48x48x40/n6/bvh", "SC-E/48x48x40/n24/s0.001"]);
        let papers = asked(&["--strategies", "SC-E/CONE45/n24,SC-E/dif/bvh/no-exit,t-e/No-Exit"]);
        let expected = ["SC-E/48x48x40/n24/cone45", "SC-E/48x48x40/dif/bvh/no-exit"];
        assert_eq!(papers, [expected[0], expected[1], "T-E/28x28/no-exit"]);
        for id in ["SC-E/n24/s0.001", "SC-E/n24/cone45", "SC-E/dif"] {
            assert!(Choice::parse(id).unwrap().is_lossy(1), "{id}");
        }
        assert!(!Choice::parse("SC-E/no-exit").unwrap().is_lossy(1));
        assert!(!Choice::parse("SC-E/n24").unwrap().is_lossy(1));
    }

    #[test]
    fn settings_are_taken_where_the_id_says_none() {
        let ids = ["--strategies", "T-I/hs,T-E,DC-E,None", "--test", "hs+sat-p", "--source", "bvh"];
        let expected = ["T-I/28x28/hs/bvh", "T-E/28x28/hs+sat-p/bvh", "DC-E/64x64x40/bvh", "None"];
        assert_eq!(asked(&ids), expected);
    }

    #[test]
    fn all_is_every_row_and_both_is_two() {
        assert_eq!(asked(&["--strategies", "all"]).len(), STRATEGIES.len());
        let both = asked(&["--strategies", "all", "--source", "both"]);
        let sources = STRATEGIES.iter().filter(|entry| entry.axes.contains(&Axis::Source));
        assert_eq!(both.len(), STRATEGIES.len() + sources.count());
        assert!(both.contains(&"SC-E/48x48x40/bvh".to_owned()), "{both:?}");
    }

    #[test]
    fn parameters_are_told_by_name() {
        let told = Choice::parse("SC-I/32x16x8/hs").unwrap().parameters();
        assert_eq!(told["tile_width_px"], 32);
        assert_eq!(told["slices"], 8);
        assert_eq!(told["tests"], "hs");
        assert_eq!(told["source"], "linear");
        assert_eq!(Choice::parse("SC-E/n24").unwrap().parameters()["normal_bins"], 24);
    }

    #[test]
    fn what_is_not_understood_names_what_is() {
        let error = |id| Choice::parse(id).err().unwrap().to_string();
        assert!(error("DCI").contains("DC-I"), "{}", error("DCI"));
        assert!(error("None/3").contains("nothing after"), "{}", error("None/3"));
        assert!(error("DC-E/hs").contains("linear or bvh"), "{}", error("DC-E/hs"));
        assert!(error("T-I/28x28/16x16").contains("16x16"), "{}", error("T-I/28x28/16x16"));
        assert!(error("SC-E/n7").contains("n54"), "{}", error("SC-E/n7"));
        assert!(error("T-E/dif").contains("cap32"), "{}", error("T-E/dif"));
        assert!(error("DC-E/n6").contains("linear or bvh"), "{}", error("DC-E/n6"));
        assert!(error("DC-E/cap0").contains("cap32"), "{}", error("DC-E/cap0"));
        assert!(error("T-I/surfaces").contains("hs"), "{}", error("T-I/surfaces"));
    }

    #[test]
    fn segments_that_contradict_each_other_are_refused_by_name() {
        for (id, first, second) in [
            ("SC-E/linear/bvh", "linear", "bvh"),
            ("SC-E/dif/s0.1", "dif", "s0.1"),
            ("T-E/hs/no-exit/no-exit", "no-exit", "no-exit"),
            ("T-I/hs/sat-p", "hs", "sat-p"),
            ("SC-E/cap8/cap16", "cap8", "cap16"),
            ("SC-E/bvh/bvh", "bvh", "bvh"),
            ("T-I/28x28/bvh/16x16", "28x28", "16x16"),
            ("SC-E/dif/n6", "dif", "n6"),
            ("SC-E/n6/dif", "dif", "n6"),
            ("SC-E/ball/bvh", "ball", "bvh"),
        ] {
            let error = Choice::parse(id).err().expect(id).to_string();
            let quoted = [first, second].map(|segment| format!("{segment:?}"));
            assert!(quoted.iter().all(|segment| error.contains(segment)), "{id}: {error}");
        }
        // The option gives the hierarchy to a strategy that names no source.
        let line = ["lightbench", "--strategies", "SC-E/ball", "--source", "bvh"];
        let Ok(crate::cli::Invocation::Compare(args)) = crate::cli::parse(line) else {
            panic!("not understood");
        };
        let error = choices(&args).err().expect("refused").to_string();
        assert!(error.contains("\"ball\"") && error.contains("\"bvh\""), "{error}");
    }
}
