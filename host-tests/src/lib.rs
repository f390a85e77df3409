//! What several tests of this crate share.

pub mod links;
