//! The table of fitted lobes.
//!
//! Indexed by x = perceptual roughness and y = sqrt(1 - cos view), both 0 to 1; the first texel's
//! centre lies on 0, the last one's on 1, and between centres the look-up is bilinear.

use std::{ops::Index, sync::LazyLock};

use glam::DMat3;

use super::fit::Fit;
use crate::ShadingError;

const MAGIC: &[u8; 4] = b"LTCT";
const VERSION: u32 = 1;
const HEADER_BYTES: usize = 12;
/// Texels each way.
const SIZES: std::ops::RangeInclusive<u32> = 2..=1024;
