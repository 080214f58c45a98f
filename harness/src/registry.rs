//! Every method that can be compared: one row each. The command line, the lists and the report
//! derive from it.

use assign::{AssignError, Assignment, Everything, FrustumTests, Gpu};
use assign_clustered::DenseImplicit;

use crate::cli::CliError;

/// How a method lights its pixels.
pub enum Method {
    /// A strategy fills lists, the shared pipeline shades by them.
    Lists(Box<dyn Assignment>),
    /// The control: surfaces drawn at the cost of no lights.
    Clay,
}

/// One row: a method, or a family of methods with parameters.
pub struct StrategyEntry {
    /// The id without parameters, as in the comparison paper.
    pub family: &'static str,
    /// Names of the parameters, which stand behind a slash and are joined by `x`.
    pub parameters: &'static [&'static str],
    /// Parameters where none are given.
    pub default: &'static str,
    /// What it is, one line.
    pub summary: &'static str,
    /// Makes it from its parameters.
    make: fn(&Gpu, &str) -> Result<Method, AssignError>,
}

impl StrategyEntry {
    /// The id with the parameters it takes where none are given.
    pub fn default_id(&self) -> String {
        id(self.family, self.default)
    }
}

fn id(family: &str, parameters: &str) -> String {
    if parameters.is_empty() { family.to_owned() } else { format!("{family}/{parameters}") }
}

/// All methods.
pub const STRATEGIES: &[StrategyEntry] = &[
    StrategyEntry {
        family: "None",
        parameters: &[],
        default: "",
        summary: "no culling: every light for every sample; the reference of all images",
        make: |gpu, _| Ok(Method::Lists(Box::new(Everything::new(gpu)?))),
    },
    StrategyEntry {
        family: "Clay",
        parameters: &[],
        default: "",
        summary: "control: surfaces without lights or textures, what drawing alone costs",
        make: |_, _| Ok(Method::Clay),
    },
    StrategyEntry {
        family: "DC-I",
        parameters: &["tile_width_px", "tile_height_px", "slices"],
        default: "64x64x24",
        summary: "dense clusters, implicit bounds: every tile and depth slice has a list",
        make: |gpu, parameters| {
            let tests = FrustumTests::default();
            Ok(Method::Lists(Box::new(DenseImplicit::new(gpu, parameters.parse()?, tests)?)))
        },
    },
];

/// A method chosen by its id.
#[derive(Clone)]
pub struct Choice {
    entry: &'static StrategyEntry,
    parameters: String,
}

impl Choice {
    /// Looks an id such as `DC-I/64x64x24` up; a family alone takes its default parameters.
    pub fn parse(id: &str) -> Result<Self, CliError> {
        let (family, parameters) = id.split_once('/').unwrap_or((id, ""));
        let same = |entry: &&StrategyEntry| entry.family.eq_ignore_ascii_case(family);
        let Some(entry) = STRATEGIES.iter().find(same) else {
            let known: Vec<&str> = STRATEGIES.iter().map(|entry| entry.family).collect();
            return Err(CliError::unknown("strategy", id, &known));
        };
        if entry.parameters.is_empty() && !parameters.is_empty() {
            return Err(CliError::new(format!(
                "strategy {id}: {} takes no parameters",
                entry.family
            )));
        }
        let parameters = if parameters.is_empty() { entry.default } else { parameters };
        Ok(Self { entry, parameters: parameters.to_owned() })
    }

    /// Makes the method on a device.
    pub fn make(&self, gpu: &Gpu) -> Result<Method, AssignError> {
        (self.entry.make)(gpu, &self.parameters)
    }

    /// Makes the method once, to check its parameters and write them as the strategy does.
    pub fn checked(mut self, gpu: &Gpu) -> Result<Self, AssignError> {
        if let Method::Lists(strategy) = self.make(gpu)? {
            let id = strategy.id();
            self.parameters =
                id.split_once('/').map_or(String::new(), |(_, parameters)| parameters.to_owned());
        }
        Ok(self)
    }

    /// The id with parameters.
    pub fn id(&self) -> String {
        id(self.entry.family, &self.parameters)
    }

    /// The parameters by name.
    pub fn parameters(&self) -> impl Iterator<Item = (&'static str, &str)> {
        self.entry.parameters.iter().copied().zip(self.parameters.split('x'))
    }

    /// Whether it is the reference of all images.
    pub fn is_reference(&self) -> bool {
        self.entry.family == crate::results::BASELINE
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ids_are_found_in_any_case_and_complete_themselves() {
        assert_eq!(Choice::parse("dc-i").map(|c| c.id()).unwrap(), "DC-I/64x64x24");
        assert_eq!(Choice::parse("DC-I/32x32x8").map(|c| c.id()).unwrap(), "DC-I/32x32x8");
        let choice = Choice::parse("DC-I/32x16x8").unwrap();
        let parameters: Vec<_> = choice.parameters().collect();
        assert_eq!(
            parameters,
            [("tile_width_px", "32"), ("tile_height_px", "16"), ("slices", "8")]
        );
    }

    #[test]
    fn unknown_ids_name_the_nearest() {
        let error = Choice::parse("DCI").err().unwrap().to_string();
        assert!(error.contains("DC-I"), "{error}");
        assert!(Choice::parse("None/3").is_err());
    }
}
