//! What deep images are to be like, and how they are built.

use assign::AssignError;

use crate::Directions;

/// How triangles become samples of the single pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Raster {
    /// A thread a triangle, a workgroup a large one.
    #[default]
    Compute,
    /// The GPU's rasteriser. It counts neither large triangles nor rejected ones.
    Fragment,
}

/// Which pixels a triangle covers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Coverage {
    /// Those whose centre it covers: small triangles may be missing.
    #[default]
    Centres,
    /// All that it touches. A fragment has the depth of the triangle's plane at the pixel's centre,
    /// clamped to the triangle's own depths: what a ray through the pixel hits is at most as far from
    /// it as the plane rises over 0.708 pixels.
    Conservative,
}

/// How fragments are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Build {
    /// Geometry is visited once, and sampled on a grid across each triangle's dominant axis; each
    /// sample is a fragment of every direction (Archer et al. 2019, section 3.1).
    SinglePass {
        /// Samples a pixel's width, along each axis. 1 is the paper's, and leaves holes where a
        /// direction sees a triangle better than its dominant axis does, at most 1.73 times.
        oversampling: u32,
        /// Who rasterises.
        raster: Raster,
    },
    /// Geometry is visited for each direction (the paper's brute force).
    PerDirection {
        /// Which pixels a triangle covers.
        coverage: Coverage,
        /// Directions of a dispatch: 1 as a renderer would draw them, one by one.
        at_once: u32,
    },
}

impl Default for Build {
    fn default() -> Self {
        Self::SinglePass { oversampling: 1, raster: Raster::default() }
    }
}

/// How a pixel's fragments are stored.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Storage {
    /// One behind the other, in ascending depth.
    #[default]
    Arrays,
    /// In linked lists, unsorted: quicker to build, slower to cast rays through.
    LinkedLists,
}

/// What deep images are to be like.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct DeepImageSettings {
    /// The directions.
    pub directions: Directions,
    /// Pixels along each side of an image.
    pub size_px: u32,
    /// How fragments are found.
    pub build: Build,
    /// How they are stored.
    pub storage: Storage,
    /// The most fragments to make room for, for tests of overflow and tight budgets of memory. Images
    /// that need more say nothing: every ray's length is unknown.
    pub most_fragments: u32,
}

impl Default for DeepImageSettings {
    /// As the paper: 169 directions, 64 pixels.
    fn default() -> Self {
        Self {
            directions: Directions::default(),
            size_px: 64,
            build: Build::default(),
            storage: Storage::default(),
            most_fragments: MAX_FRAGMENTS,
        }
    }
}

/// The most fragments: 4 GiB of arrays.
pub const MAX_FRAGMENTS: u32 = 1 << 30;

/// The most samples along each side of an image.
const MOST_SIDE: u32 = 1024;

impl DeepImageSettings {
    /// Samples along each side of the grid that triangles are sampled on.
    pub(crate) fn side_cells(&self) -> u32 {
        self.size_px.saturating_mul(self.oversampling())
    }

    pub(crate) fn oversampling(&self) -> u32 {
        match self.build {
            Build::SinglePass { oversampling, .. } => oversampling,
            Build::PerDirection { .. } => 1,
        }
    }

    /// Pixels of all images together.
    pub(crate) fn pixel_count(&self) -> u32 {
        self.directions.count() * self.size_px * self.size_px
    }

    /// Names the first setting out of its range.
    pub fn check(&self) -> Result<(), AssignError> {
        let range = |field: &str, value: u32, most: u32| {
            if (1..=most).contains(&value) {
                return Ok(());
            }
            Err(AssignError::Parameter {
                field: field.into(),
                value: value.to_string(),
                accepted: format!("1 to {most}"),
            })
        };
        range("size_px", self.size_px, MOST_SIDE)?;
        range("most_fragments", self.most_fragments, MAX_FRAGMENTS)?;
        match self.build {
            Build::SinglePass { oversampling, .. } => {
                range("oversampling", oversampling, MOST_SIDE / self.size_px)?;
            }
            Build::PerDirection { at_once, .. } => {
                range("at_once", at_once, self.directions.count())?;
            }
        }
        let pixels = u64::from(self.directions.count()) * u64::from(self.size_px).pow(2);
        if pixels > MOST_PIXELS {
            return Err(AssignError::Parameter {
                field: "directions x size_px^2".into(),
                value: pixels.to_string(),
                accepted: format!("at most {MOST_PIXELS}"),
            });
        }
        Ok(())
    }
}

/// The most pixels of all images: their prefix sum takes one dispatch a level.
const MOST_PIXELS: u64 = 1 << 26;
