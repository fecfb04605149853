//! Prints the table of matching digits of docs/least-squares.md; see there.

#[path = "../tests/nist/problems.rs"]
mod problems;

use problems::Nist;

pub fn main() {
    let Some(all) = Nist::all(&Nist::folder()) else {
        println!("no NIST files in {}", Nist::folder().display());
        return;
    };
    println!(
        "| problem | start | parameters | standard deviations | sum of squares | iterations | evaluations | stop |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    for nist in &all {
        for start in 0..2 {
            let fit = nist.fit(start);
            let digits = nist.digits(&fit);
            println!(
                "| {} | {} | {:.1} | {:.1} | {:.1} | {} | {} | {:?} |",
                nist.name,
                start + 1,
                digits.parameters,
                digits.standard_deviations,
                digits.sum_of_squares,
                fit.iterations,
                fit.evaluations,
                fit.reason,
            );
        }
    }
}
