//! What was found, written into robot and campaign.

pub mod apply;
pub mod correction_table;
pub mod destination;
pub mod extended;
