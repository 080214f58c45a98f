//! Light assignment to models: each model has a list, or each part of a model.
//!
//! # Idea
//!
//! The scene is already divided into models, and a view sample knows its model (Enhuber 2019,
//! section 3.4). A model's group is the oriented box around it. A size limit cuts the boxes of
//! large models into equal parts, along the boxes' own axes; the paper leaves this as an open
//! question. A sample finds its part by its position.
//!
//! | id | groups |
//! |---|---|
//! | `M` | one per model |
//! | `M/2` | parts of models, each at most 2 m along each axis of the model's box, or a 64th of it |
//!
//! # Phases
//!
//! 1. `cull`: one workgroup per part tests lights against the part's oriented box and writes the
//!    part's list. The test is exact for point lights. The pass reads neither depth nor view.
//!
//! Deferred shading needs each pixel's model. The renderer writes it in an extra pass or to an
//! extra target.
//!
//! # Cost
//!
//! `cull` grows with parts times lights. Pixels and view do not matter. Memory is 12 bytes per
//! part, 80 bytes per model and 4 bytes per listed light.
//!
//! Times in ms for 10,000 lights in Sponza at 1920x1080 (H200, 2026-11-25;
//! `results/h200-all/sponza-1.6.json`, whose command is in `results/README.md`): M takes 0.562 to
//! assign, of which 0.502 writes the models of pixels, and 19.6 to shade, with lists of 3,858
//! lights per sample. M/2 takes 0.647 to assign and 0.297 to shade, with 55.0 lights per sample.
//!
//! # Where it fails
//!
//! - A building that is one model is one group, whose list holds every light in it. Such lists are
//!   the longest of all strategies.
//! - Models out of view are culled as well.
//! - Parts divide the box, not the surface, so most parts of a large hollow model are empty.
//!
//! - A sample in the open lies on no model and reads all lights, so the strategy refuses look-ups at any depth.
//! - A sample that the rounding of depth puts outside its model's box reads the list of all lights,
//!   which is slow but correct.

mod parts;
mod per_model;

pub use parts::{ModelRecord, Parts};
pub use per_model::{MODELS_WESL, PerModel};

/// Compiles the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
