//! Settings of deep images, and how they are built.

use assign::AssignError;

use crate::Directions;

/// What takes the samples of the single pass.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Raster {
    /// Compute: one thread per triangle, one workgroup per large triangle.
    #[default]
    Compute,
    /// The GPU's rasteriser. It counts neither large nor rejected triangles.
    Fragment,
}

/// Which pixels a triangle covers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Coverage {
    /// Pixels whose centre it covers. Small triangles may be missing.
    #[default]
    Centres,
    /// All pixels that it touches. A fragment has the depth of the triangle's plane at the pixel's centre, clamped
    /// to the triangle's own depths. The depth at which a ray through the pixel hits the triangle differs from it
    /// by at most the plane's rise over 0.708 pixels.
    Conservative,
}

/// How fragments are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum Build {
    /// One visit to the geometry. It samples each triangle on a grid across the triangle's dominant axis. Each
    /// sample becomes a fragment of every direction (Archer et al. 2019, section 3.1).
    SinglePass {
        /// Samples per pixel width along each axis. The paper has 1, which leaves holes: a direction may see a
        /// triangle up to 1.73 times larger than the dominant axis does.
        oversampling: u32,
        /// What takes the samples.
        raster: Raster,
    },
    /// One visit to the geometry per direction (the paper's brute force).
    PerDirection {
        /// Which pixels a triangle covers.
        coverage: Coverage,
        /// Directions per dispatch. 1 draws them one by one, as a renderer would.
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
    /// One after the other, in ascending depth.
    #[default]
    Arrays,
    /// In unsorted linked lists: faster to build, slower to cast rays through.
    LinkedLists,
}

/// Settings of deep images.
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
    /// The most fragments to make room for: a limit on memory, and a means to test overflow. If images need more,
    /// the length of every ray is unknown.
    pub most_fragments: u32,
}

impl Default for DeepImageSettings {
    /// The paper's: 169 directions of 64 x 64 pixels.
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

/// The most fragments: 4 GiB as arrays.
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

    /// Checks every setting. The error names the first one out of its range.
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
        range("pixels along the side of a deep image (size_px)", self.size_px, MOST_SIDE)?;
        range("fragments of deep images (most_fragments)", self.most_fragments, MAX_FRAGMENTS)?;
        match self.build {
            Build::SinglePass { oversampling, .. } => {
                range("oversampling of deep images", oversampling, MOST_SIDE / self.size_px)?;
            }
            Build::PerDirection { at_once, .. } => {
                range("directions per dispatch (at_once)", at_once, self.directions.count())?;
            }
        }
        let pixels = u64::from(self.directions.count()) * u64::from(self.size_px).pow(2);
        if pixels > MOST_PIXELS {
            return Err(AssignError::Parameter {
                field: "pixels of all deep images (directions x size_px^2)".into(),
                value: pixels.to_string(),
                accepted: format!("at most {MOST_PIXELS}"),
            });
        }
        Ok(())
    }
}

/// The most pixels of all images together, so that each level of their prefix sum takes one dispatch.
const MOST_PIXELS: u64 = 1 << 26;
