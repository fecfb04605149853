//! How a load becomes a reading: what each parameter of an effect does ([`action`]) and how all
//! act together ([`state`]), on the structure, in the slide, by the history of the loads and in the
//! display.

pub mod action;
pub mod display;
pub mod load_history;
pub mod recovery;
pub mod slide;
pub mod state;
pub mod structure;
