//! Laws as formulas: where they may act ([`sites`], given what is [`deflected`]), those of the
//! rod's file ([`of_rod_file`]), a proposed one as a file holds it ([`written`]), and what
//! textbooks say of it.

pub mod deflected;
pub mod measures;
pub mod of_rod_file;
pub mod remembered;
pub mod sites;
pub mod textbook;
pub mod written;
