//! What the pictures of a run cost.
//!
//! `cargo bench -p plica --bench pictures` prints what docs/performance.md says. On one thread.

use criterion::{Criterion, criterion_group, criterion_main};
use plica::run_directory::{self, RunDirectory};
use plica_view::report::pictures;
use std::hint::black_box;

fn of_a_run(c: &mut Criterion) {
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build_global()
        .expect("no pool was built yet");
    let text = include_str!("../../../cases/small.toml");
    let plan = plica::case::read(text, "small").expect("the case is sound");
    let out = std::env::temp_dir().join(format!("plica-pictures-{}", std::process::id()));
    let directory = RunDirectory::create(&out, text, &plan.title, true);
    let summary = run_directory::run(
        &plan,
        &mut directory.expect("there is room for a run"),
        &mut (),
    );
    let summary = summary.expect("the tube can be followed");
    c.bench_function("pictures of cases/small.toml", |b| {
        b.iter(|| black_box(pictures(&plan, &summary)))
    });
    std::fs::remove_dir_all(out).expect("the run was written here");
}

criterion_group!(benches, of_a_run);
criterion_main!(benches);
