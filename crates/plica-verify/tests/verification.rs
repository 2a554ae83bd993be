//! The quick verification, row by row: what `plica verify` holds.

use plica_verify::verification::verify;

#[test]
fn every_row_of_the_quick_verification_passes() {
    let found = verify(false, &|_| true, &mut ()).unwrap();
    println!("{}", found.text());
    assert!(found.rows.len() > 90, "{} rows", found.rows.len());
    assert_eq!(found.failed(), 0);
    assert!(
        found
            .pictures()
            .unwrap()
            .iter()
            .all(|(_, png)| png.len() > 1000)
    );
}
