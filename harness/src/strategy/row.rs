//! One row of the registry: everything that the program knows about a family.

use assign::{AssignError, Gpu, Needs};
use shading::Mode;

use super::{Axis, Method, Options, Refusal};

/// What part a family plays in a comparison.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// No culling: the image and the time that the others are compared with.
    Baseline,
    /// No culling with the early exit that all culling strategies have.
    EarlyExit,
    /// A cost without lights, not a competitor.
    Control,
    /// A strategy of the comparison paper (Enhuber 2019).
    ComparisonPaper,
    /// A strategy of another paper.
    OtherPaper,
    /// A strategy that engines ship.
    Engine,
    /// A strategy of this workspace.
    Own,
}

impl Role {
    /// The role in words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Baseline => "baseline",
            Self::EarlyExit => "baseline with an early exit",
            Self::Control => "control",
            Self::ComparisonPaper => "of the comparison paper",
            Self::OtherPaper => "of another paper",
            Self::Engine => "shipped by engines",
            Self::Own => "our own",
        }
    }
}

/// A family's colour in tables and charts: on white and on black, as CSS writes it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Colour {
    /// On a light page.
    pub light: &'static str,
    /// On a dark page.
    pub dark: &'static str,
}

/// The grey of families that compete with none, and of those that this program does not know.
pub const GREY: Colour = Colour { light: "#8a8f93", dark: "#8d9398" };

/// An id that stands in for the comparison paper's strategy, because earlier versions measured it under the
/// id that the paper's strategy has today.
#[derive(Clone, Copy, Debug)]
pub struct StandIn {
    /// The segment of the id: `hs`.
    pub segment: &'static str,
    /// What it is instead of the paper's strategy: `T-I by HS only`.
    pub what: &'static str,
    /// The parameter by which schema 1 tells an old record, and its value.
    pub told_by: (&'static str, &'static str),
    /// Whether only records that store no planes can be old.
    pub needs_no_planes: bool,
    /// Turns the old id into that of today.
    pub to_today: fn(&mut Options),
    /// Undoes that.
    pub to_then: fn(&mut Options),
}

/// The parameters that searches try.
#[derive(Clone, Copy, Debug)]
pub struct Sizes {
    /// A few, for `advise`: those around the default, without the default.
    pub few: &'static [&'static str],
    /// More, for the search of the comparison study.
    pub many: &'static [&'static str],
}

/// One row of the registry: a family of strategies.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    /// The first part of its ids, as the paper that it comes from calls it.
    pub family: &'static str,
    /// Its plain name: `sparse clusters, explicit bounds`.
    pub name: &'static str,
    /// One sentence of what it is.
    pub about: &'static str,
    /// What part it plays in a comparison.
    pub role: Role,
    /// Where it comes from: the paper with the section, equation or table.
    pub source: &'static str,
    /// The crate that holds it.
    pub krate: &'static str,
    /// Names of the parameters, with their units. An id joins the values by `x`.
    pub parameters: &'static [&'static str],
    /// The parameters of an id that gives none.
    pub default: &'static str,
    /// Further parameters that overviews show beside the default.
    pub variants: &'static [&'static str],
    /// Further axes, each a segment of its own in an id.
    pub axes: &'static [Axis],
    /// The parameters that searches try.
    pub sizes: Sizes,
    /// Whether it cuts the samples into groups, each with a list of lights. Others have no lists to count.
    pub has_groups: bool,
    /// What it reads besides the view and the lights.
    pub needs: Needs,
    /// The modes that it refuses.
    pub refuses: &'static [Refusal],
    /// The largest relative difference of a channel that it states about itself; `None` where no bit
    /// may differ.
    pub tolerance: Option<f64>,
    /// Ids that stand in for the comparison paper's strategy.
    pub stand_ins: &'static [StandIn],
    /// Whether the pass that lights pixels rasterises triangles in every mode.
    pub shade_rasterises: bool,
    /// The id under which `compare` measures it where the command line names no strategies.
    pub in_default: Option<&'static str>,
    /// Its colour in tables and charts.
    pub colour: Colour,
    /// Makes it on a device.
    pub make: fn(&Gpu, &Options) -> Result<Method, AssignError>,
}

/// No needs at all: a start for rows.
pub(super) const NEEDS_NOTHING: Needs = Needs {
    depth: false,
    normals: false,
    materials: false,
    models: false,
    triangles: false,
    hierarchy: false,
    occluders: false,
};

/// Reads the depth of the surfaces.
pub(super) const NEEDS_DEPTH: Needs = Needs { depth: true, ..NEEDS_NOTHING };

impl Row {
    /// A family without groups, parameters or needs: a start for rows. It cannot be made.
    pub(super) const PLAIN: Self = Self {
        family: "",
        name: "",
        about: "",
        role: Role::OtherPaper,
        source: "",
        krate: "",
        parameters: &[],
        default: "",
        variants: &[],
        axes: &[],
        sizes: Sizes { few: &[], many: &[] },
        has_groups: false,
        needs: NEEDS_NOTHING,
        refuses: &[],
        tolerance: None,
        stand_ins: &[],
        shade_rasterises: false,
        in_default: None,
        colour: GREY,
        make: |_, _| {
            Err(AssignError::Parameter {
                field: "make".into(),
                value: "missing in a row of the registry".into(),
                accepted: "the function that makes the strategy".into(),
            })
        },
    };

    /// The id with the parameters that it takes where none are given.
    pub fn default_id(&self) -> String {
        self.id_of(self.default)
    }

    /// The id with some parameters.
    pub fn id_of(&self, parameters: &str) -> String {
        match parameters {
            "" => self.family.to_owned(),
            _ => format!("{}/{parameters}", self.family),
        }
    }

    /// The ids that overviews show: those at the default parameters, and at the variants.
    pub fn overview_ids(&self) -> impl Iterator<Item = String> {
        std::iter::once(self.default_id())
            .chain(self.variants.iter().map(|parameters| self.id_of(parameters)))
    }

    /// Name and sentence, as lists of strategies print them.
    pub fn description(&self) -> String {
        format!("{}: {}", self.name, self.about)
    }

    /// Whether ids have a segment for an axis.
    pub fn has_axis(&self, axis: Axis) -> bool {
        self.axes.contains(&axis)
    }

    /// Why it cannot light pixels in a mode; `None` where it can.
    pub fn refuses_mode(&self, mode: Mode) -> Option<&'static str> {
        let refusal = self.refuses.iter().find(|refusal| refusal.modes.contains(&mode))?;
        Some(refusal.why)
    }

    /// The sentence that it cannot run in a mode, with the reason; `None` where it can.
    pub fn refusal(&self, mode: Mode) -> Option<String> {
        let why = self.refuses_mode(mode)?;
        Some(format!("{} cannot run in mode {}, because {why}.", self.family, mode.name()))
    }

    /// The style class that gives its colour: `strategy-sc-e`.
    pub fn class(&self) -> String {
        match self.colour == GREY {
            true => "strategy-none".to_owned(),
            false => format!("strategy-{}", self.family.to_lowercase()),
        }
    }
}
