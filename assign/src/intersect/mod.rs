//! Intersection tests on the CPU.
