//! What is found: data that a reader needs no other object for.

pub(in crate::inference) mod diagnosis;
pub(in crate::inference) mod finding;
pub(in crate::inference) mod proposal;
pub(in crate::inference) mod ranking;
pub(in crate::inference) mod untested;
