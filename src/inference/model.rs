//! What the engine is given, and copies into its findings without looking into it.

pub(in crate::inference) mod description;
pub(in crate::inference) mod effect;
pub(in crate::inference) mod evidence;
pub(in crate::inference) mod forward_model;
pub(in crate::inference) mod hypothesis;
pub(in crate::inference) mod location;
pub(in crate::inference) mod nominal;
pub(in crate::inference) mod quantity;
pub(in crate::inference) mod variable;
