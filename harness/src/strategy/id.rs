//! The id of a strategy: a family, and a point on its axes.

mod stored;

use std::{
    cmp::Ordering,
    collections::BTreeMap,
    fmt,
    hash::{Hash, Hasher},
};

use assign::{FrustumTests, LightSource};
use assign_clustered::SpecularCut;
use assign_grid::GridBox;
use serde_json::Value;

use super::{Axis, IdError, Options, Role, Row, StandIn, parse};

/// The id of a strategy, such as `SC-E/48x48x40/bvh`.
///
/// [`Display`](fmt::Display) writes it in the canonical form: the family, the parameters, then one
/// segment per axis that is not at its default, in the order of [`Axis::ALL`]. Ids are equal where their
/// texts are. Stored results may hold ids that this program cannot run. These keep their text, have no
/// row where the family is unknown, and say what their segments say.
#[derive(Clone, Debug)]
pub struct StrategyId {
    text: String,
    row: Option<&'static Row>,
    options: Options,
    is_runnable: bool,
    /// Parameters of a stored result that the id does not say.
    unread: BTreeMap<String, Value>,
}

impl StrategyId {
    /// Reads an id that this program can run, in any case and with segments in any order. A family
    /// without parameters takes its default ones.
    pub fn parse(id: &str) -> Result<Self, IdError> {
        let (row, options) = parse::parse(id)?;
        Ok(Self::new(row, options))
    }

    /// Reads any id, as stored results hold it.
    pub fn read(id: &str) -> Self {
        Self::parse(id).unwrap_or_else(|_| {
            let (row, options) = parse::read_foreign(id);
            Self { is_runnable: false, text: id.to_owned(), row, options, unread: BTreeMap::new() }
        })
    }

    /// The canonical id of a point on the axes of a family.
    pub(super) fn new(row: &'static Row, options: Options) -> Self {
        let segments = Axis::ALL.iter().filter(|axis| row.has_axis(**axis));
        let mut text = row.id_of(&options.parameters);
        for segment in segments.filter_map(|axis| axis.segment(&options)) {
            text += "/";
            text += &segment;
        }
        Self { text, row: Some(row), options, is_runnable: true, unread: BTreeMap::new() }
    }

    /// The same family with other options.
    ///
    /// # Errors
    ///
    /// An id that this program cannot run, an option that the family does not have, and options that
    /// contradict each other.
    pub fn with(&self, change: impl FnOnce(&mut Options)) -> Result<Self, IdError> {
        let (row, _) = parse::parse(&self.text)?;
        let mut options = self.options.clone();
        change(&mut options);
        let mut lacking = Axis::ALL.iter().filter(|axis| !row.has_axis(**axis));
        if let Some(segment) = lacking.find_map(|axis| axis.segment(&options)) {
            return Err(parse::refuse(&self.text, row, &segment));
        }
        parse::check_pairs(&self.text, row, &options)?;
        let changed = Self::new(row, options);
        // What the text says is what the options say.
        Self::parse(&changed.text)?;
        Ok(changed)
    }

    /// The id as text.
    pub fn as_str(&self) -> &str {
        &self.text
    }

    /// The family: `SC-E`.
    pub fn family(&self) -> &str {
        self.text.split('/').next().unwrap_or_default()
    }

    /// The family's row; `None` where this program does not know the family.
    pub fn row(&self) -> Option<&'static Row> {
        self.row
    }

    /// Whether this program can run it.
    pub fn is_runnable(&self) -> bool {
        self.is_runnable
    }

    /// The point on the axes.
    pub fn options(&self) -> &Options {
        &self.options
    }

    /// The family's role; `None` where this program does not know the family.
    pub fn role(&self) -> Option<Role> {
        self.row.map(|row| row.role)
    }

    /// Whether it cuts the samples into groups.
    pub fn has_groups(&self) -> bool {
        self.row.is_some_and(|row| row.has_groups)
    }

    /// Whether it reads the depth of the surfaces before it assigns lights, so that a renderer without
    /// a depth pre-pass must draw one for it.
    pub fn reads_depth(&self) -> bool {
        self.row.is_some_and(|row| row.needs.depth) || self.options.grid_box == GridBox::Visible
    }

    /// Whether the pass that lights pixels rasterises triangles in every mode.
    pub fn shade_rasterises(&self) -> bool {
        self.row.is_some_and(|row| row.shade_rasterises)
    }

    /// Whether it reads the hierarchy over the lights: because its id says so, or always.
    pub fn reads_hierarchy(&self) -> bool {
        self.is_bvh() || self.row.is_some_and(|row| row.needs.hierarchy)
    }

    /// Whether its id says that it finds lights through the hierarchy.
    pub fn is_bvh(&self) -> bool {
        self.options.source == Some(LightSource::Hierarchy)
    }

    /// The parameters: `48x48x40`. Empty where it has none.
    pub fn size(&self) -> &str {
        &self.options.parameters
    }

    /// The tests against frusta, where the family has any.
    pub fn tests(&self) -> Option<FrustumTests> {
        self.row?.has_axis(Axis::Tests).then(|| self.options.settings().tests)
    }

    /// The lossy knob: `cap8`, `reuse4`, `stochastic0.01`, `s0.001`, `cone45` or `dif`.
    pub fn knob(&self) -> Option<String> {
        [Axis::Specular, Axis::Stochastic, Axis::Reuse, Axis::Cap]
            .into_iter()
            .find_map(|axis| axis.segment(&self.options))
    }

    /// The number of segments behind the family and the parameters.
    pub fn segment_count(&self) -> usize {
        self.text.split('/').skip(if self.size().is_empty() { 1 } else { 2 }).count()
    }

    /// Whether it may show another image than no culling of that many lights, because a knob says so.
    pub fn is_lossy(&self, lights: u64) -> bool {
        self.options.cap.is_some_and(|most| u64::from(most) < lights)
            || self.options.fewer.is_some_and(|(_, most)| u64::from(most) < lights)
            || self.options.stochastic.is_some()
            || self.options.reuse.is_some_and(|frames| frames > 1)
            || self.options.specular != SpecularCut::None
            || self.has_flaw()
    }

    /// Whether it fails on purpose: a segment of it is a flaw that renderers ship. [`flaw`](Self::flaw) says
    /// which one.
    pub fn has_flaw(&self) -> bool {
        Axis::ALL.iter().any(|axis| axis.is_flaw() && axis.segment(&self.options).is_some())
    }

    /// The same without what [`is_lossy`](Self::is_lossy) counts as a loss: its nearest lossless setting.
    /// `None` where it has no such knob, and where this program cannot run it.
    pub fn nearest_lossless(&self) -> Option<Self> {
        let lossless = self.with(|options| {
            (options.cap, options.fewer, options.reuse) = (None, None, None);
            (options.is_rectangle, options.is_half, options.is_unordered) = (false, false, false);
            options.is_plain_depth = false;
            options.stochastic = None;
            options.specular = SpecularCut::None;
        });
        lossless.ok().filter(|lossless| lossless != self)
    }

    /// Whether its groups are parts of what the family has whole where no parameters are given.
    fn is_parted(&self) -> bool {
        self.row.is_some_and(|row| row.default.is_empty()) && !self.size().is_empty()
    }

    /// The family with what tells it from the comparison paper's strategy: the size of the parts of
    /// models (`M/2`), the box of a grid (`G/supports`), and the tests of a stand-in (`T-I/hs`).
    pub fn short(&self) -> String {
        let mut short = self.family().to_owned();
        let Some(row) = self.row else { return short };
        let is_stand_in =
            |segment: &String| row.stand_ins.iter().any(|known| known.segment == segment);
        let segments = [
            self.is_parted().then(|| self.size().to_owned()),
            Axis::Box.segment(&self.options),
            Axis::Tests.segment(&self.options).filter(is_stand_in),
        ];
        for segment in segments.into_iter().flatten() {
            short += "/";
            short += &segment;
        }
        short
    }

    /// What it is instead of the comparison paper's strategy that it stands in for: `G over supports`.
    /// `None` where it stands in for none.
    pub fn stand_in(&self) -> Option<&'static str> {
        self.row_of_stand_in().map(|stand_in| stand_in.what)
    }

    /// How it stands in for the comparison paper's strategy; `None` where it stands in for none.
    pub(crate) fn row_of_stand_in(&self) -> Option<&'static StandIn> {
        let has = |segment: &str| self.text.split('/').skip(1).any(|known| known == segment);
        self.row?.stand_ins.iter().find(|known| has(known.segment))
    }

    /// Whether the comparison paper has it: whole models, and grids over boxes of the lights. Only
    /// sizes, tests and the box of a grid may differ from their defaults. Its stand-ins count too.
    pub fn is_of_the_paper(&self) -> bool {
        let free = [Axis::Tests, Axis::Box];
        let mut fixed = Axis::ALL.iter().filter(|axis| !free.contains(axis));
        self.role() == Some(Role::ComparisonPaper)
            && self.is_runnable
            && !self.is_parted()
            && matches!(self.options.grid_box, GridBox::Positions | GridBox::Supports)
            && fixed.all(|axis| axis.segment(&self.options).is_none())
    }

    /// The style class that colours it: the same for a family in every table and chart, grey where the
    /// family is unknown.
    pub fn class(&self) -> String {
        self.row.map_or_else(|| "strategy-none".to_owned(), Row::class)
    }

    /// The parameters, each with its name: `slices`, 40. None of an unknown family.
    pub fn sizes(&self) -> impl Iterator<Item = (&'static str, Value)> {
        let number = |text: &str| {
            let whole = text.parse::<u64>().map(Value::from);
            whole.or_else(|_| text.parse::<f64>().map(Value::from)).unwrap_or_else(|_| text.into())
        };
        let names = self.row.map_or(&[][..], |row| row.parameters);
        let values = self.size().split('x').filter(|value| !value.is_empty()).map(number);
        names.iter().copied().zip(values)
    }

    /// Parameters and settings by name, as results store them: those of the id, and stored ones that it
    /// does not say, such as those of an unknown family.
    pub fn parameters(&self) -> BTreeMap<String, Value> {
        let Some(row) = self.row else { return self.unread.clone() };
        let settings = row.axes.iter().filter_map(|axis| axis.parameter(&self.options));
        let stated = self.sizes().chain(settings).map(|(name, value)| (name.to_owned(), value));
        stated.chain(self.unread.clone()).collect()
    }
}

impl fmt::Display for StrategyId {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.text)
    }
}

impl PartialEq for StrategyId {
    fn eq(&self, other: &Self) -> bool {
        self.text == other.text
    }
}

impl Eq for StrategyId {}

impl PartialOrd for StrategyId {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl Ord for StrategyId {
    fn cmp(&self, other: &Self) -> Ordering {
        self.text.cmp(&other.text)
    }
}

impl Hash for StrategyId {
    fn hash<H: Hasher>(&self, state: &mut H) {
        self.text.hash(state);
    }
}

impl PartialEq<str> for StrategyId {
    fn eq(&self, other: &str) -> bool {
        self.text == other
    }
}

impl PartialEq<&str> for StrategyId {
    fn eq(&self, other: &&str) -> bool {
        self.text == *other
    }
}

impl From<&str> for StrategyId {
    fn from(id: &str) -> Self {
        Self::read(id)
    }
}

impl From<String> for StrategyId {
    fn from(id: String) -> Self {
        Self::read(&id)
    }
}

#[cfg(test)]
mod tests;
