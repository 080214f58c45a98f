//! The headings that `--help` groups options under.
//!
//! Options for everyday use have no heading: clap lists them first, under "Options", and `-h` shows only
//! them. Every other option has one of these headings and is hidden from `-h`.

pub(super) const SCENE: &str = "Scene and camera";
pub(super) const SCATTERED: &str = "Scattered lights";
pub(super) const LAYERS: &str = "Transparent surfaces, particles and fog";
pub(super) const MOTION: &str = "Lights that move";
pub(super) const RANGES: &str = "Ranges and order of all lights";
pub(super) const BOUNCE: &str = "Indirect light: one bounce, by virtual point lights (VPLs)";
pub(super) const DEEP: &str = "Deep images, for ranges of virtual point lights, and for shadows";
pub(super) const SHADING: &str = "Shading";
pub(super) const LISTS: &str = "How strategies build light lists";
pub(super) const TIMING: &str = "Timing";
pub(super) const CHECKS: &str = "Checks and pictures";
pub(super) const RAYS: &str = "Rays";
pub(super) const JOBS: &str = "Part of a study";
