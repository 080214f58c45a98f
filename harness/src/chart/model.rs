//! What a chart of points and lines shows.

/// How an axis turns values into lengths.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps, from the least to the greatest value.
    #[default]
    Linear,
    /// Equal steps that start at zero.
    LinearFromZero,
    /// Equal factors; exact zeros get a lane of their own.
    Log,
}

/// An axis: what it measures, in what unit, on what scale.
#[derive(Clone, Debug, Default)]
pub struct Axis {
    /// What is measured: `Frame time`.
    pub label: String,
    /// The unit, may be empty: `ms`.
    pub unit: String,
    /// How values become lengths.
    pub scale: Scale,
}

impl Axis {
    /// An axis of a label, a unit and a scale.
    pub fn new(label: impl Into<String>, unit: impl Into<String>, scale: Scale) -> Self {
        Self { label: label.into(), unit: unit.into(), scale }
    }

    /// The label with its unit: `Frame time (ms)`.
    pub(super) fn caption(&self) -> String {
        match (self.label.is_empty(), self.unit.is_empty()) {
            (_, true) => self.label.clone(),
            (true, false) => self.unit.clone(),
            (false, false) => format!("{} ({})", self.label, self.unit),
        }
    }
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Marks {
    /// A shape per point.
    #[default]
    Points,
    /// A line from point to point.
    Line,
    /// A line with a shape per point.
    LineAndPoints,
    /// A dashed line: fits and references.
    Dashed,
    /// A staircase: along to the next point, then up or down.
    Steps,
}

impl Marks {
    pub(super) fn has_line(self) -> bool {
        self != Self::Points
    }

    pub(super) fn has_shapes(self) -> bool {
        matches!(self, Self::Points | Self::LineAndPoints)
    }
}

/// A value at a place, with what is known about its spread.
#[derive(Clone, Debug, Default)]
pub struct Point {
    /// Where along the horizontal axis.
    pub x: f64,
    /// Where along the vertical axis.
    pub y: f64,
    /// From where to where `x` may lie: a horizontal whisker.
    pub x_range: Option<[f64; 2]>,
    /// From where to where `y` may lie: a vertical whisker.
    pub y_range: Option<[f64; 2]>,
    /// A short text beside the point, drawn where there is room; may be empty.
    pub label: String,
    /// The name of the point for the page's script (`data-key`); may be empty.
    pub key: String,
    /// The text of the hover tip, its lines separated by `\n`; may be empty.
    pub tip: String,
}

impl Point {
    /// A point with a tip.
    pub fn new(x: f64, y: f64, tip: impl Into<String>) -> Self {
        Self { x, y, tip: tip.into(), ..Self::default() }
    }
}

/// Points that belong together.
#[derive(Clone, Debug, Default)]
pub struct Series {
    /// Its name, at the end of its line or in the legend; may be empty.
    pub name: String,
    /// The class that gives `--colour`: `strategy-3`. Empty is the colour of text.
    pub class: String,
    /// How it is drawn.
    pub marks: Marks,
    /// Whether it is drawn faded, behind the others.
    pub faded: bool,
    /// The shape of its points; `None` takes the next free one. Series of the same shape and class belong
    /// together and share a row in the lane of exact zeros.
    pub shape: Option<usize>,
    /// Its points, in the order in which a line joins them.
    pub points: Vec<Point>,
}

impl Series {
    /// A series of points that are drawn in one way, in the colour that a class gives.
    pub fn new(
        name: impl Into<String>,
        class: impl Into<String>,
        marks: Marks,
        points: Vec<Point>,
    ) -> Self {
        Self { name: name.into(), class: class.into(), marks, points, ..Self::default() }
    }
}

/// Points and lines over two axes.
#[derive(Clone, Debug, Default)]
pub struct XyChart {
    /// What the chart shows, in a few words.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// What is drawn: faded series first, staircases last, else in this order.
    pub series: Vec<Series>,
    /// A remark below the chart; may be empty.
    pub note: String,
}

impl XyChart {
    /// A chart without a remark. Series without points are left out.
    pub fn new(title: impl Into<String>, axes: [Axis; 2], mut series: Vec<Series>) -> Self {
        series.retain(|series| !series.points.is_empty());
        let [x, y] = axes;
        Self { title: title.into(), x, y, series, note: String::new() }
    }
}
