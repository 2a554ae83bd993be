//! The quick checks of `plica verify`.

use plica_verify::verification::verify;

#[test]
fn every_row_of_the_quick_verification_passes() {
    let found = verify(false, &|_| true, &mut ()).unwrap();
    println!("{}", found.text());
    assert!(found.rows.len() > 90, "{} rows", found.rows.len());
    assert_eq!(found.failed(), 0);
    let pictures = found.pictures().unwrap();
    assert!(pictures.iter().all(|(_, png)| png.len() > 1000));
}
