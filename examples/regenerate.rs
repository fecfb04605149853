//! Makes again what pages and data of this project were made by, and reports to look at: one
//! program for all of it, for each takes its time to link.
//!
//! `cargo run --release --example regenerate -- nist-table | table3 | forecast | readings |
//! campaign | gallery`; what comes after the name is explained at the top of the file of that name.

#![allow(missing_docs, clippy::print_stdout)]

mod forecast_campaigns;
mod nist_table;
mod reconstruct_readings;
mod report_gallery;
mod simulate_campaign;
mod table3;

fn main() -> rodcal::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(2).collect();
    match std::env::args().nth(1).as_deref() {
        Some("nist-table") => nist_table::main(),
        Some("table3") => table3::main(&arguments),
        Some("forecast") => forecast_campaigns::main(&arguments)?,
        Some("readings") => reconstruct_readings::main(),
        Some("campaign") => simulate_campaign::main(),
        Some("gallery") => report_gallery::main(&arguments)?,
        _ => println!("which? nist-table, table3, forecast, readings, campaign, gallery"),
    }
    Ok(())
}
