#![allow(missing_docs, clippy::unwrap_used, clippy::print_stdout)]
use rodcal::diagnosis::rig::diagnose;
use rodcal::rig::readings::Readings;
use rodcal::rod::Rod;
fn main() {
    let args: Vec<String> =
        std::env::args().skip(1).filter(|a| !a.starts_with("--") && a != "diagnose" && a != "rig").collect();
    let rod = if args[0] == "linear" {
        None
    } else {
        Some(Rod::read(args[0].as_ref()).unwrap_or_else(|e| {
            eprintln!("{e}");
            std::process::exit(2)
        }))
    };
    let readings = Readings::read(args[1].as_ref()).unwrap_or_else(|e| {
        eprintln!("{e}");
        std::process::exit(2)
    });
    let found = diagnose(&readings, rod.as_ref()).unwrap_or_else(|e| {
        eprintln!("{e}");
        std::process::exit(2)
    });
    println!("{:#}", rodcal::report::diagnosis::rig::json(&found, None));
    std::process::exit(i32::from(found.diagnosis.is_mismatch()));
}
