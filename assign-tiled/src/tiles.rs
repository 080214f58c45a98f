//! The tile grid: the viewport cut into rectangles of pixels.

use std::{fmt, str::FromStr};

use assign::{AssignError, Bounds, Frame, View, intersect::UNBOUNDED};
use bytemuck::{Pod, Zeroable};

/// Width and height of a tile, pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TileSize(pub [u32; 2]);

impl TileSize {
    /// Checks each field.
    pub fn check(&self) -> Result<(), AssignError> {
        match self.0.iter().find(|t| !(1..=16_384).contains(*t)) {
            None => Ok(()),
            Some(value) => Err(AssignError::Parameter {
                field: "tile size".into(),
                value: value.to_string(),
                accepted: "1 to 16384 pixels".into(),
            }),
        }
    }
}

impl fmt::Display for TileSize {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}x{}", self.0[0], self.0[1])
    }
}

impl FromStr for TileSize {
    type Err = AssignError;

    /// Reads `WIDTHxHEIGHT`.
    fn from_str(text: &str) -> Result<Self, AssignError> {
        let fail = || AssignError::Parameter {
            field: "tile size".into(),
            value: text.into(),
            accepted: "WIDTHxHEIGHT in pixels, such as 28x28".into(),
        };
        let numbers: Vec<u32> = text
            .split('x')
            .map(|part| part.parse().map_err(|_| fail()))
            .collect::<Result<_, _>>()?;
        let [width, height] = numbers[..] else {
            return Err(fail());
        };
        let size = Self([width, height]);
        size.check()?;
        Ok(size)
    }
}

/// The depths of a tile that have a list.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum TileDepths {
    /// From the near to the far plane: T-I.
    Implicit,
    /// From the nearest to the farthest sample: T-E, *MinMax*.
    Explicit,
    /// The same, found by the pass that culls (Andersson 2009).
    ExplicitAtOnce,
    /// As `Explicit`, cut in the middle: two lists per tile (Thomas 2015, *HalfZ*).
    HalfZ,
    /// Both halves, each shrunk to the samples in it (Thomas 2015, *modified HalfZ*).
    ModifiedHalfZ,
    /// From the nearest to the farthest sample, cut into 32 slices, without those that hold none (Harada 2012,
    /// *2.5D culling*).
    Sliced,
}

impl TileDepths {
    /// The family in ids.
    pub fn family(self) -> &'static str {
        match self {
            Self::Implicit => "T-I",
            Self::Explicit => "T-E",
            Self::ExplicitAtOnce => "T-E1",
            Self::HalfZ => "HalfZ",
            Self::ModifiedHalfZ => "ModifiedHalfZ",
            Self::Sliced => "T-25D",
        }
    }

    /// Lists per tile.
    pub(crate) fn lists(self) -> u32 {
        match self {
            Self::Implicit | Self::Explicit | Self::ExplicitAtOnce | Self::Sliced => 1,
            Self::HalfZ | Self::ModifiedHalfZ => 2,
        }
    }
}

impl From<Bounds> for TileDepths {
    fn from(bounds: Bounds) -> Self {
        match bounds {
            Bounds::Implicit => Self::Implicit,
            Bounds::Explicit => Self::Explicit,
        }
    }
}

/// [`TilesUniform::surfaces_only`] of lists that serve only surfaces.
pub(crate) const SURFACES_ONLY: u32 = 1;

/// [`TilesUniform::surfaces_only`] of lists that serve surfaces and what lies in front of them.
pub(crate) const SURFACES_AND_FRONT: u32 = 2;

/// The tiles as shaders read them: `struct Tiles` of `tiles.wesl`. 40 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct TilesUniform {
    /// Tiles along x and y.
    pub counts: [u32; 2],
    /// Width and height of a tile, pixels.
    pub tile_px: [u32; 2],
    /// Upper left pixel of the viewport.
    pub origin_px: [u32; 2],
    /// Least view depth of a sample, metres: the near plane, as shading rebuilds it.
    pub near_m: f32,
    /// Greatest view depth of a sample, metres: the far plane, as shading rebuilds it, or [`UNBOUNDED`].
    pub far_m: f32,
    /// 1: lists serve only the surfaces in the depth buffer. 2: they also serve what lies in front of these. 0: lists
    /// serve any depth.
    pub surfaces_only: u32,
    /// Pads to 40 bytes.
    pub padding: u32,
}

impl TilesUniform {
    /// Cuts `view` into tiles; lists serve any depth.
    pub fn new(size: TileSize, view: &View) -> Self {
        let viewport = [view.viewport.width, view.viewport.height];
        Self {
            counts: [0, 1].map(|i| viewport[i].div_ceil(size.0[i])),
            tile_px: size.0,
            origin_px: [view.viewport.x, view.viewport.y],
            near_m: view.nearest_rebuilt_m(),
            far_m: view.farthest_rebuilt_m().unwrap_or(UNBOUNDED),
            surfaces_only: 0,
            padding: 0,
        }
    }

    /// Extends the ends of the view to all samples of a frame. `strategy` is the strategy's id.
    ///
    /// # Errors
    ///
    /// Those of [`Frame::extends_past_planes`].
    pub(crate) fn serve(&mut self, frame: &Frame<'_>, strategy: &str) -> Result<(), AssignError> {
        if frame.extends_past_planes(strategy)? {
            (self.near_m, self.far_m) = (0.0, UNBOUNDED);
        }
        Ok(())
    }

    /// Number of tiles.
    pub fn tile_count(&self) -> u32 {
        self.counts.iter().product()
    }
}

#[cfg(test)]
mod tests {
    use glam::Vec3;

    use super::*;

    #[test]
    fn sizes_print_as_they_parse() {
        let size: TileSize = "28x16".parse().unwrap();
        assert_eq!(size.to_string(), "28x16");
        for bad in ["", "28", "0x28", "28x16385", "axb", "28x28x2"] {
            let error = bad.parse::<TileSize>().unwrap_err().to_string();
            assert!(error.contains("must be"), "{bad}: {error}");
        }
    }

    #[test]
    fn the_last_tile_may_reach_beyond_the_viewport() {
        let view = View::look_at(Vec3::ZERO, Vec3::NEG_Z, 1.0, 0.5, [130, 64]);
        let tiles = TilesUniform::new(TileSize([64, 64]), &view);
        assert_eq!(tiles.counts, [3, 1]);
        assert_eq!(tiles.tile_count(), 3);
        assert_eq!(tiles.far_m, UNBOUNDED);
    }
}
