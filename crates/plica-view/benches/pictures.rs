//! Time of drawing the pictures of a run on one thread, for docs/performance.md.

use criterion::{Criterion, criterion_group, criterion_main};
use plica::run_directory::{self, RunDirectory};
use plica_view::report::pictures;
use std::hint::black_box;

fn run_pictures(c: &mut Criterion) {
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build_global()
        .expect("the pool is built only here");
    let case = concat!(env!("CARGO_MANIFEST_DIR"), "/../../cases/small.toml");
    let text = std::fs::read_to_string(case).expect("the case exists");
    let plan = plica::case::read(&text, "small").expect("the case is valid");
    let out = std::env::temp_dir().join(format!("plica-pictures-{}", std::process::id()));
    let directory = RunDirectory::create(&out, &text, &plan.title, true);
    let summary = run_directory::run(
        &plan,
        &mut directory.expect("the directory can be created"),
        &mut (),
    );
    let summary = summary.expect("the run completes");
    c.bench_function("pictures of cases/small.toml", |b| {
        b.iter(|| black_box(pictures(&plan, &summary)))
    });
    std::fs::remove_dir_all(out).expect("the directory exists");
}

criterion_group!(benches, run_pictures);
criterion_main!(benches);
