//! What was found, written into the rod's file or taken out of the readings.

mod correction;
mod readings;
mod written_item;

pub use correction::Correction;
pub(super) use correction::as_found;
pub use written_item::WrittenItem;
