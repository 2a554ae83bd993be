//! Cost of the main case of Okino et al. (2025) on the paper's axial and thickness mesh.
//!
//! `cargo bench -p plica` prints the table of docs/performance.md. Every figure is taken on one
//! thread.

use criterion::{Criterion, criterion_group, criterion_main};
use plica::assembly::SplineTube;
use plica::equilibrium::TubeProblem;
use plica::matrix::{FarBlocks, SparseFactor};
use plica::solve::{Equilibrium, Path};
use plica::study::Plan;
use std::hint::black_box;
use std::time::Duration;

fn main_case() -> Plan {
    let text = include_str!("../../../cases/invagination.toml");
    plica::case::read(text, "invagination").expect("the main case is sound")
}

fn problem(plan: &Plan) -> TubeProblem {
    TubeProblem::new(SplineTube::new(
        &plan.tube,
        &plan.mesh,
        plan.mesh.rings(plan.symmetry),
    ))
}

/// The contracted tube, Dmin/D = 0.25.
fn contracted<'a>(plan: &Plan, problem: &'a TubeProblem) -> Path<&'a TubeProblem> {
    let rest = vec![0.0; problem.tube.unknowns()];
    let mut path = Path::begin(problem, plan.tube.rest(), rest, plan.solver.clone())
        .expect("a tube at rest is not inverted");
    lead(&mut path, plan, 0);
    path
}

fn lead(path: &mut Path<&TubeProblem>, plan: &Plan, stage: usize) {
    let stage = &plan.stages[stage];
    path.begin_segment(stage.load.clone());
    for n in 1..=stage.steps {
        path.advance(n as f64 / stage.steps as f64, &mut ())
            .expect("the path can be followed");
    }
}

fn kernels(c: &mut Criterion) {
    let plan = main_case();
    let problem = problem(&plan);
    let path = contracted(&plan, &problem);
    let (load, u) = (&path.state().load, &path.state().u);

    let mut group = c.benchmark_group("305 x 60 x 8, axisymmetric");
    group.bench_function("residual", |b| {
        b.iter(|| black_box(problem.forces(load, u)))
    });
    group.bench_function("tangent", |b| {
        b.iter(|| black_box(problem.tube.tangent(load, u)))
    });
    let mut tangent = problem.tube.tangent(load, u);
    tangent.constrain(problem.prescribed());
    group.bench_function("factorisation", |b| {
        b.iter(|| black_box(tangent.clone().factor()))
    });
    let factor = tangent.factor().expect("a stable state is not singular");
    group.bench_function("solve", |b| {
        b.iter(|| {
            let mut x = u.clone();
            factor.solve(&mut x);
            black_box(x)
        });
    });
    group.finish();
}

/// The factorisation when the flanks of a fold touch: `contact` rows on either side of its bottom, each
/// coupled with the mirror images of the three rows around it. The couplings are weak, so that the
/// tangent stays one of a stable state.
fn folds(c: &mut Criterion) {
    let plan = main_case();
    let problem = problem(&plan);
    let path = contracted(&plan, &problem);
    let mut tangent = problem.tube.tangent(&path.state().load, &path.state().u);
    tangent.constrain(problem.prescribed());
    let (rows, size, band) = (tangent.blocks(), tangent.size(), tangent.band());

    let mut group = c.benchmark_group("factorisation, 305 x 60 x 8, flanks in contact");
    for contact in [0, 20, 40, 60] {
        let mut far = FarBlocks::new(size, band);
        for i in rows / 2 - contact..rows / 2 {
            for mirror in rows - 2 - i..=rows - i {
                if far.is_far(mirror, i) {
                    far.block_mut(mirror, i).fill(1e-9);
                }
            }
        }
        group.bench_function(format!("{contact} rows"), |b| {
            b.iter(|| black_box(SparseFactor::of(&tangent, &far)))
        });
    }
    group.finish();
}

fn whole_path(c: &mut Criterion) {
    let plan = main_case();
    let problem = problem(&plan);
    let mut group = c.benchmark_group("the whole path");
    group
        .sample_size(10)
        .measurement_time(Duration::from_secs(100));
    group.bench_function("contraction, 15 states", |b| {
        b.iter(|| black_box(contracted(&plan, &problem).state().energy));
    });
    group.bench_function("contraction and relaxation, 40 states", |b| {
        b.iter(|| {
            let mut path = contracted(&plan, &problem);
            lead(&mut path, &plan, 1);
            black_box(path.state().energy)
        });
    });
    group.finish();
}

fn one_thread(c: &mut Criterion) {
    rayon::ThreadPoolBuilder::new()
        .num_threads(1)
        .build_global()
        .expect("no pool was built yet");
    kernels(c);
    folds(c);
    whole_path(c);
}

criterion_group!(benches, one_thread);
criterion_main!(benches);
