//! Rays through deep images against exact ones.
