//! Light assignment: which lights may reach which view samples.
//!
//! A strategy is three things: a set of *groups* of view samples, a function from a view sample to
//! its group, and, for each group, the list of lights that may reach it. Each strategy crate
//! implements [`Assignment`]. This crate holds what they share.
//!
//! # A frame
//!
//! 1. The renderer fills a [`Frame`]: the [`View`], the [`LightBuffer`] and whatever the strategy
//!    [needs](Assignment::needs).
//! 2. [`Assignment::prepare`] sizes buffers and is not timed. [`Assignment::record`] records named
//!    passes, which are timed.
//! 3. Shading calls `open_lights(sample)`, and then `next_light(&cursor)` until it returns false,
//!    both from the WESL module `package::look_up`, which [`Lookup`] supplies. It sums the lights in this order:
//!    ascending index, whatever the [`Storage`]. The order is the same for every strategy, so images can be
//!    compared bit for bit. Take the fall-off from the WESL module `package::window`: a light's support
//!    ends where that window does, so a list may lack lights that another fall-off would still show. Specular terms may
//!    reach farther (`package::specular_reach`), with a strategy whose [lists do](Assignment::specular_reach).
//!
//! # Promises
//!
//! A group's list holds every light whose support contains one of the group's samples, in ascending
//! index, without repeats. If a list does not fit into the entry pool, the group reads the list of
//! all lights, the overflow is counted, and the pool grows before a later frame. No input makes a
//! strategy drop a light silently. The module `conformance` (feature `conformance`) checks this for
//! any strategy and rejects faulty ones.

mod assignment;
mod compiled;
#[cfg(feature = "conformance")]
pub mod conformance;
mod cull;
mod cull_kernel;
mod cull_settings;
mod cull_source;
mod depth_bind_groups;
mod depth_kernels;
mod emitter;
mod entries;
mod error;
mod events;
mod everything;
mod fewer;
mod frame;
mod frame_images;
mod frame_writes;
mod gpu;
#[cfg(not(target_arch = "wasm32"))]
mod gpu_open;
mod groups;
mod half;
mod hitches;
pub mod intersect;
mod keep;
mod kept_bind_group;
pub mod kernel;
mod leave_to_inner;
mod light;
mod light_buffer;
mod light_changes;
mod light_fault;
mod light_nodes;
mod light_order;
mod light_reader;
mod light_record;
mod light_sorter;
mod limits;
mod link_errors;
mod list_records;
mod lists;
mod lists_bindings;
mod live_groups;
mod masks;
mod models;
mod occlusion;
mod passes;
mod plain_depth;
mod plain_wgsl;
mod readback;
mod reuse;
mod scalar_masks;
mod shader;
mod specular_reach;
mod spot_ramp;
mod stochastic;
mod storage;
mod strategy_module;
mod sun;
mod touched;
mod touched_groups;
mod trees;
mod unordered;
mod view;
mod window;

// Their types stand in this crate's interface, so a renderer may take them from here.
pub use {glam, wgpu};

pub use assignment::{Assignment, Lookup};
pub use cull::{Culler, CullerDescriptor};
pub use cull_settings::{AreaBounds, Bounds, CullSettings, FrustumTests, LightSource};
pub use depth_bind_groups::DepthBindGroups;
pub use depth_kernels::DepthKernels;
pub use emitter::{Emitter, MAX_VERTICES, Outline};
pub use entries::{UNFILTERED, entry, storage_entry, texture, texture_entry, uniform_entry};
pub use error::AssignError;
pub use everything::Everything;
pub use fewer::{Fewer, Kept};
pub use frame::{Frame, FrameBindings, Needs, SampleDomain};
pub use frame_images::DepthImage;
pub use frame_writes::FrameWrites;
pub use gpu::Gpu;
pub use groups::{Facing, GroupShape, Groups};
pub use half::Half;
pub use hitches::{Hitches, Mapped};
pub use keep::Keep;
pub use kept_bind_group::KeptBindGroup;
pub use light::{Light, LightShape, MAX_INTENSITY, MAX_RANGE_M, MIN_RANGE_M, MIN_SPOT_ANGLE};
pub(crate) use light_buffer::FrameLights;
pub use light_buffer::{GpuLights, LightBuffer, MAX_LIGHTS, RejectedLight, SlotCounts, Travel};
pub use light_changes::LightChanges;
pub use light_fault::LightFault;
pub use light_nodes::LightNode;
pub use light_order::LightOrder;
pub use light_reader::{BOUNDS_BOX_WESL, LightReader, Team};
pub use light_record::{LightEmission, LightKind, LightKinds, LightSphere, LightTraits};
pub use limits::{check_limits, storage_buffer_limits};
pub use list_records::{
    ALL_LIGHTS, Counters, CullUniform, ENTRY_DIFFUSE, ENTRY_LIGHT, ENTRY_SPECULAR, LightList,
    ListsSnapshot,
};
pub use lists::LightLists;
pub use lists_bindings::{FIRST_STRATEGY_BINDING, ListsBindings};
pub use live_groups::LiveGroups;
pub use models::ModelBox;
pub use occlusion::{Occluders, OcclusionTest};
pub use passes::{EncoderPasses, Passes};
pub use plain_depth::PlainDepth;
pub use plain_wgsl::Slots;
pub use readback::Readback;
pub use reuse::Reuse;
pub use shader::Shader;
pub use specular_reach::{
    MAX_SPECULAR_REACH, check_listed_reach, check_specular_reach, lobe_peak, specular_reach,
};
pub use spot_ramp::SpotRamp;
pub use stochastic::{Stochastic, check_threshold, random_of};
pub use storage::Storage;
pub use strategy_module::{StrategyModule, StrategyWesl};
pub use sun::{MAX_IRRADIANCE, MAX_SUNS, Sun, Suns};
pub use touched::Touched;
pub use unordered::Unordered;
pub use view::{DepthMapping, Projection, View, ViewError, ViewUniform, Viewport};
pub use window::{MIN_DISTANCE_2, fall_off, range_window};

/// Compiles the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
