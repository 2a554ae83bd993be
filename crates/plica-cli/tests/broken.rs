//! The messages about every broken case in `broken/`. `PLICA_BLESS=1 cargo test` rewrites
//! `broken.txt`.

use crate::common::{compare, plica, tests, text};

#[test]
fn broken_cases_are_explained() {
    let mut names: Vec<String> = std::fs::read_dir(tests().join("broken"))
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    assert!(names.len() >= 60);
    let mut page = String::new();
    for name in names {
        let said = plica(&tests().join("broken"), &["check", &name]);
        assert_eq!(
            said.status.code(),
            Some(2),
            "{name}: {}",
            text(&said.stderr)
        );
        assert!(said.stdout.is_empty(), "{name}");
        page += &format!("==== {name}\n{}\n", text(&said.stderr));
    }
    compare("broken.txt", &page);
}
