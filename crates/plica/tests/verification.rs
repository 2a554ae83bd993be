//! The quick verification, row by row.

use plica::verification::{Observer, Row, verify};

/// Prints as it goes.
struct Printer;

impl Observer for Printer {
    fn found(&mut self, row: &Row) {
        let verdict = if row.passes() { "ok" } else { "FAILED" };
        println!(
            "{} {}: {} for {}, off by {:.1e} {verdict} {:?}",
            row.case,
            row.quantity,
            row.computed,
            row.reference,
            row.error(),
            row.trouble
        );
    }
}

#[test]
fn every_row_of_the_quick_verification_passes() {
    let only = std::env::var("ONLY").unwrap_or_default();
    let t = std::time::Instant::now();
    let found = verify(
        std::env::var("FULL").is_ok(),
        &|check| check.name.contains(&only),
        &mut Printer,
    )
    .unwrap();
    println!("{:?}", t.elapsed());
    println!("{}", found.text());
    assert_eq!(found.failed(), 0);
}
