//! What a renderer relies on from frame to frame: no hitches, several views in one submission, and the limits of its
//! device. Every strategy of the registry is tested.

mod hitches;
mod limits;
mod stage;
mod views;
