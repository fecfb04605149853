//! Laws that nobody has listed: where they may act on a robot, what their variables are called, how
//! its file holds them.

pub mod measures;
pub mod sites;
pub mod textbook;
pub mod written;
