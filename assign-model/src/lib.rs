//! Light assignment to models: a list for each object, or for each part of it.
//!
//! # Idea
//!
//! The scene is already cut into models, and a view sample knows which one it lies on (Enhuber
//! 2019, section 3.4). A model's group is the oriented box around it. A size limit, the paper's
//! open question, cuts the boxes of large models into equal parts, in their own frames; a sample
//! finds its part by its position.
//!
//! | id | groups |
//! |---|---|
//! | `M` | one per model |
//! | `M/2` | parts of models, each at most 2 m along each axis of the model's box, or a 64th of it |
//!
//! # Phases
//!
//! 1. `cull`: one workgroup per part tests lights against the part's oriented box, which is exact
//!    for point lights, and writes its list. Neither depth nor view is read.
//!
//! Deferred shading needs the model of each pixel: a pass or a target of the renderer's.
//!
//! # Cost
//!
//! `cull` grows with parts times lights, and with neither pixels nor view. Memory is 8 bytes a
//! part, 84 bytes a model and 4 bytes a listed light.
//!
//! Figures, ms, of 10,000 lights in Sponza at 1920x1080 (H200, 2026-11-25;
//! `results/h200-all/sponza-1.6.json`, whose command is in `results/README.md`): M 0.562 to
//! assign, of which 0.502 for the models of pixels, and 19.6 to shade lists of 3,858 lights a sample;
//! M/2 0.647 and 0.297 with 55.0.
//!
//! # Where it fails
//!
//! A building that is one model is one group, and its list holds every light in it: the longest
//! lists of all strategies. Models that nobody sees are culled as well. Parts cut the box, not the
//! surface, so most parts of a large hollow model are empty.
//!
//! A sample in the open lies on no model: look-ups at any depth are refused. A sample that the
//! rounding of depth puts outside its model's box gets all lights: slow, correct.

mod parts;
mod per_model;

pub use parts::{ModelRecord, Parts};
pub use per_model::{MODELS_WESL, PerModel};
