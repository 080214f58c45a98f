//! How depth is cut into slices.

use assign::AssignError;

/// How the slices of clusters grow with depth in a perspective view. In an orthographic view, all slices are
/// equally deep.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Slices {
    /// Each slice is deeper than the one before by the same factor (Olsson et al. 2012; Enhuber 2019, equation
    /// 3.3).
    #[default]
    Exponential,
    /// All slices are equally deep.
    Even,
    /// The first slice reaches from the near plane to this view depth, metres, and the others grow as
    /// exponential ones from there. Exponential slices spend many on the first metres, where few samples are
    /// (Persson 2013, "Practical Clustered Shading"). Where the others would have less than an octave, or there is
    /// only one slice, slices are exponential.
    Near(f32),
    /// Exponential slices, divided into this many cascades with about the same number of slices each. The farthest cascade has tiles of the grid's
    /// size, and each nearer one has tiles of twice the sides of the one behind it (Billeter 2015,
    /// "Many-Light Rendering on Mobile Hardware"; Enhuber 2019, section 2.2): with tiles of one size, near clusters
    /// are small in the world, and hold few samples each.
    Cascaded(u32),
}

impl Slices {
    /// The most cascades.
    pub const MAX_CASCADES: u32 = 4;

    /// Whether tiles differ in size from slice to slice.
    pub fn is_cascaded(self) -> bool {
        matches!(self, Self::Cascaded(_))
    }

    /// Checks the depth, or the number of cascades of a grid with so many slices.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] if the depth is not from 0.001 to 1,000,000 m, or if there are fewer than 2 or more
    /// than 4 cascades, or fewer slices than cascades.
    pub fn check(self, slices: u32) -> Result<(), AssignError> {
        match self {
            Self::Near(end_m) if !(1e-3..=1e6).contains(&end_m) => Err(AssignError::Parameter {
                field: "end of the first slice".into(),
                value: end_m.to_string(),
                accepted: "0.001 to 1000000 m".into(),
            }),
            Self::Cascaded(count) if !(2..=Self::MAX_CASCADES.min(slices)).contains(&count) => {
                Err(AssignError::Parameter {
                    field: "number of cascades".into(),
                    value: format!("{count}, of {slices} slices"),
                    accepted: format!("2 to {}, and at most one per slice", Self::MAX_CASCADES),
                })
            }
            _ => Ok(()),
        }
    }

    /// Its segment of an id: `/even`, `/near5`, `/cascades3`, or nothing.
    pub fn segment(self) -> String {
        match self {
            Self::Exponential => String::new(),
            Self::Even => "/even".to_owned(),
            Self::Near(end_m) => format!("/near{end_m}"),
            Self::Cascaded(count) => format!("/cascades{count}"),
        }
    }
}
