//! One mesh made to move like another.

pub mod propose;
