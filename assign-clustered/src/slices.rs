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
}

impl Slices {
    /// Checks the depth.
    ///
    /// # Errors
    ///
    /// [`AssignError::Parameter`] if it is not from 0.001 to 1,000,000 m.
    pub fn check(self) -> Result<(), AssignError> {
        match self {
            Self::Near(end_m) if !(1e-3..=1e6).contains(&end_m) => Err(AssignError::Parameter {
                field: "end of the first slice".into(),
                value: end_m.to_string(),
                accepted: "0.001 to 1000000 m".into(),
            }),
            _ => Ok(()),
        }
    }

    /// Its segment of an id: `/even`, `/near5`, or nothing.
    pub fn segment(self) -> String {
        match self {
            Self::Exponential => String::new(),
            Self::Even => "/even".to_owned(),
            Self::Near(end_m) => format!("/near{end_m}"),
        }
    }
}
