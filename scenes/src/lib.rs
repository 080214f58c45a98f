//! Scenes on the CPU: geometry, materials, lights and camera paths.
//!
//! [`open`] makes a [`Scene`] from the id of a procedural scene ([`list`]) or from a glTF 2.0 file
//! ([`load_gltf`]). [`scatter_lights`] draws any number of lights from a seed. [`CameraPath`] leads
//! a camera through the scene; the frame number alone decides where it is.
//!
//! World space is right-handed with +Y up, in metres. Colours are linear RGB. Triangles are
//! counter-clockwise seen from the front.

mod aabb;
mod animated_node;
mod atrium;
mod builder;
mod bvh;
mod emitters;
mod error;
mod extent;
mod fit;
mod framing;
mod gltf_import;
mod hash;
mod hierarchy;
mod light_animation;
mod lights;
mod material;
mod memory;
mod motion;
mod nearest;
mod noise;
mod open_ranges;
mod particles;
mod path;
mod picture;
mod places;
mod pose;
mod primary_light;
mod radii;
mod random;
mod registry;
mod scene;
pub mod stability;
mod tour;
mod town;

pub use aabb::Aabb;
pub use atrium::atrium;
pub use emitters::Outlines;
pub use error::SceneError;
pub use framing::Framing;
pub use gltf_import::load_gltf;
pub use hierarchy::{BuildEffort, DistinctTriangles, build_hierarchy};
pub use light_animation::LightAnimation;
pub use lights::{LightSpec, MAX_LIGHTS, MIN_RADIUS_M, THRESHOLD, scatter_lights};
pub use material::{Dielectric, Encoding, Filter, Image, Material, Sampler, TextureRef, Wrap};
pub use motion::{
    MAX_SPEED_M_S, MAX_TIME_S, Motion, MotionClock, MotionLaw, MotionRules, motion_constants,
};
pub use nearest::DepthSpan;
pub use open_ranges::{LOST, close_ranges};
pub use particles::{MAX_PARTICLES, Particle, scatter_particles};
pub use path::CameraPath;
pub use places::Places;
pub use pose::Pose;
pub use primary_light::primary_light;
pub use radii::Radii;
pub use registry::{SceneEntry, list, open, open_lights, open_seeded};
pub use scene::{Camera, Instance, Lens, Mesh, Model, Scene, Vertex};
pub use town::{TownSize, town};
