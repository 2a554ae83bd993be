//! The quick verification, as `plica verify` runs it.

use plica_verify::verification::verify;

#[test]
fn every_row_of_the_quick_verification_passes() {
    let verification = verify(false, &|_| true, &mut ()).unwrap();
    println!("{}", verification.text());
    assert!(
        verification.rows.len() > 90,
        "{} rows",
        verification.rows.len()
    );
    assert_eq!(verification.failed(), 0);
    let pictures = verification.pictures().unwrap();
    assert!(pictures.iter().all(|(_, png)| png.len() > 1000));
}
