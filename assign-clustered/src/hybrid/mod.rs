//! HG: hybrid lighting. Each light adds itself to the cells that it touches.
//!
//! # Idea
//!
//! A cell is a froxel, as a cluster is; only cells that hold samples count. But no cell looks for its lights.
//! Each light finds the tiles that its outline covers on the screen and the depths that it spans over each
//! tile. Then it adds itself to the cells between those depths (Archer et al. 2019, section 3.2, after their
//! hybrid lighting of 2018). So a light costs only the cells that it touches, which suits many small lights.
//!
//! # Phases
//!
//! 1. `occupancy` clears the cells and reads the depth buffer once. For each tile it sets one bit per slice that
//!    holds samples.
//! 2. `count` gives each light 32 lanes; each lane takes every 32nd tile of the light's outline.
//!    - It skips a tile without samples at the light's depths.
//!    - Otherwise it finds the depths between which the light's ball meets the tile's pyramid, and adds 1 to
//!      each cell between them that holds samples. At these depths the distance from the ball's centre to the
//!      tile's rectangle, a convex function of depth, equals the radius. Newton's method approaches both ends
//!      from outside and never passes them.
//!    - Cones and half balls shrink the outline, and are tested against a ball around the tile's part.
//! 3. `reserve` gives each cell one lane. The cell's list takes a place in the pool, or becomes all lights.
//! 4. `fill` runs the pipeline of `count` once more, so both find the same pairs to the bit. Each cell's
//!    cursor now points to places instead of counting.
//! 5. `sort` gives each list one workgroup. The atomic cursors of `fill` write the entries in a different order on
//!    every run. Sorting by light index makes the lists the same in every run. The workgroup reads the unsorted
//!    entries from a second pool. It sorts short lists by rank, and long ones by one bit per light, which is enough
//!    because no light comes twice.
//!
//! Worked example: there are lights 0 to 2. Lights 0 and 2 reach cell 5, light 1 reaches cell 6. The cursors
//! of cells 5 and 6 count to 2 and 1, so their places are 0 to 1 and 2. `fill` may leave `[2 0 | 1]`, and
//! `sort` makes it `[0 2 | 1]`.
//!
//! # Cost
//!
//! - `occupancy` grows with pixels.
//! - `count` and `fill` grow with the tiles of all outlines.
//! - `reserve` grows with cells, `sort` with entries.
//!
//! A hierarchy of lights would save no work, because no light is tested against cells that it does not touch.
//! Memory is 16 bytes and one bit per cell, and 8 bytes per listed light. Other strategies take 4 bytes per
//! listed light.
//!
//! Of all listed pairs of a light and a cell, at most 0.7 % do not meet. This holds for point lights with ranges
//! of 0.2 to 40 m in perspective views, and of 0.2 to 6 m in orthographic ones (`tests/hybrid_rates.rs`).
//!
//! # Where it fails
//!
//! - A light that fills the screen is added to every cell, by one atomic each, twice. Many such lights wait for
//!   one another.
//! - A light is tested against a whole tile and slice, not against the samples in it. Lists are as long as those
//!   of clusters with implicit bounds, and longer than those with explicit bounds.
//! - Half-spaces of one-sided lights, and cones, are tested only against a ball around the tile's part.
//! - Area lights list both of their terms, diffuse and specular.
//! - A surface whose depth equals the cleared depth cannot be told from background. Its samples get all lights.
//!
//! HG serves look-ups at any depth. Then every cell counts as holding samples.
//!
//! # By the rasteriser: `HG/…/raster`
//!
//! `count` and `fill` may leave the walk over tiles to the rasteriser, as Örtegren and Persson (2016), Bevy and Godot
//! do. The target has one pixel per tile; each light draws a rectangle of whole tiles, and each fragment tests its
//! light against its tile as a lane does. Örtegren and Persson draw a mesh of the light's shape instead, and read the
//! depths over a tile from its front and back faces; that needs conservative rasterisation, which WebGPU lacks. So
//! their proxy is tighter on the screen, and this test is tighter in depth. The rectangle is that of the light's ball;
//! fragments outside the outline of a cone end at once.
//!
//! It balances work by itself: a light that covers all tiles is spread over the whole GPU. But fragments are shaded
//! in blocks of four, so small lights waste up to three of four lanes, and GPUs of data centres run fragment
//! shaders on few of their processors.

mod buffers;
mod grid;
mod parts;
mod passes;
mod scatter;
mod shader;

pub use grid::HybridGrid;
pub use parts::HybridParts;
pub use scatter::Scatter;
pub use shader::{HYBRID_WESL, HybridShader};
