//! How shading normals split a cluster's samples.

use assign::AssignError;

/// Whether clusters are split by shading normals, and into how many bins.
///
/// A bin is a cell of a face of the cube around the unit sphere, with k x k cells per face: 6, 24 or 54 bins
/// (Swarbrick 2025, section 4.2). One bin keeps clusters whole, and still knows the cone of their normals.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Normals {
    /// Clusters are not split, and nothing is known of their normals.
    #[default]
    None,
    /// This number of bins per cluster: 1, 6, 24 or 54.
    Bins(u32),
}

impl Normals {
    /// Checks the number of bins.
    pub fn check(self) -> Result<(), AssignError> {
        match self {
            Self::None | Self::Bins(1 | 6 | 24 | 54) => Ok(()),
            Self::Bins(count) => Err(AssignError::Parameter {
                field: "normal bins".into(),
                value: count.to_string(),
                accepted: "1, 6, 24 or 54".into(),
            }),
        }
    }

    /// Whether the strategy reads normals.
    pub fn is_some(self) -> bool {
        self != Self::None
    }

    /// Groups per cluster.
    pub fn bins(self) -> u32 {
        match self {
            Self::None => 1,
            Self::Bins(count) => count,
        }
    }

    /// Cells along an edge of a face; 0 if one bin takes all normals.
    pub(crate) fn side(self) -> u32 {
        (self.bins() / 6).isqrt()
    }

    /// Its segment of an id: `/n6`, or nothing.
    pub(crate) fn segment(self) -> String {
        match self {
            Self::None => String::new(),
            Self::Bins(count) => format!("/n{count}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bins_are_six_squares_or_one() {
        let sides = [(1, 0), (6, 1), (24, 2), (54, 3)];
        for (count, side) in sides {
            Normals::Bins(count).check().unwrap();
            assert_eq!(Normals::Bins(count).side(), side);
        }
        let error = Normals::Bins(12).check().unwrap_err().to_string();
        assert_eq!(error, "normal bins is 12: it must be 1, 6, 24 or 54");
    }
}
