//! The words in segments of ids that set axes.

/// The segment of slices that are equally deep.
pub(super) const EVEN: &str = "even";
/// The prefix of a segment that gives the first slice a depth of its own.
pub(super) const NEAR: &str = "near";
/// The prefix of a segment that sets the number of cascades.
pub(super) const CASCADES: &str = "cascades";
/// The prefix of a segment that sets the bins of normals.
pub(super) const NORMALS: &str = "n";
/// The prefix of a segment that lists lights for their specular term beyond their range.
pub(super) const REACH: &str = "reach";
/// The prefix of a segment that sets the most lights of a list.
pub(super) const CAP: &str = "cap";
/// The prefix of a segment that makes ranges random below an irradiance.
pub(super) const STOCHASTIC: &str = "stochastic";
/// The prefix of a segment that sets for how many frames lists are used.
pub(super) const REUSE: &str = "reuse";
/// The prefix of a segment that sets for how many frames lists of larger lights are kept.
pub(super) const KEEP: &str = "keep";
/// The segment that makes only those lists again that a changed light touches.
pub(super) const TOUCHED: &str = "touched";
/// The segment that leaves lights out of lists which shadow maps hide.
pub(super) const OCCLUSION: &str = "occ";
/// The segment that lets the rasteriser add lights to cells.
pub(super) const RASTER: &str = "raster";
/// The segment that turns the early exit off.
pub(super) const NO_EXIT: &str = "no-exit";
/// The segment that tests a wrong rectangle on the screen. A flaw.
pub(super) const RECTANGLE: &str = "rect";
/// The segment that culls by positions and ranges in half precision. A flaw.
pub(super) const HALF: &str = "half";
/// The segment that culls by view depths which ignore an oblique near plane. A flaw.
pub(super) const PLAIN_DEPTH: &str = "plain-depth";
/// The segment that puts lists into a random order. A flaw.
pub(super) const UNORDERED: &str = "unordered";
