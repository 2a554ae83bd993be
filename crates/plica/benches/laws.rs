//! Cost of a tangent product and of a linearisation of the whole tube by law, relative to the neo-Hookean law.
//!
//! `cargo bench -p plica --bench laws` prints the table of docs/performance.md: CPU milliseconds of one thread, medians of
//! rounds in which the laws alternate, and medians of the ratios of a round. The tube is that of `cases/carotid.toml`, one
//! layer, stretched and inflated so that all fibres are in tension.

use plica::assembly::{MatrixFreeTangent, SplineTube};
use plica::material::{
    Composite, Fibres, Fung, Law, Material, Matrix, MooneyRivlin, NeoHookean, TangentData,
    Volumetric, Yeoh,
};
use plica::study::Plan;
use std::time::{Duration, Instant};

/// Control points along, around and through the wall.
const MESH: [usize; 3] = [105, 48, 6];
const ROUNDS: usize = 15;

fn laws() -> Vec<(&'static str, Material)> {
    let neo_hookean = NeoHookean {
        mu: 1.0,
        lambda: 300.0,
        volumetric: Volumetric::Quadratic,
    };
    let composite = |matrix, fibres| {
        Material::Composite(Composite {
            matrix,
            fibres,
            tones: vec![],
        })
    };
    let family = |k2, dispersion, angle| Fibres::new([0.8, k2], dispersion, angle);
    let pair = |dispersion| [0.5, -0.5].map(|angle| family(0.84, dispersion, angle));
    let four = [0.0, 1.57].map(|angle| family(0.5, 0.0, angle));
    let of_matrix = Matrix::NeoHookean(neo_hookean);
    let yeoh = Yeoh {
        c: [0.5, 0.1, 0.02],
        bulk: 300.0,
    };
    let fung = Fung::new(
        0.6,
        [[0.9, 0.05, 0.2], [0.05, 0.4, 0.1], [0.2, 0.1, 1.1]],
        300.0,
    );
    vec![
        ("neo-Hookean", Material::NeoHookean(neo_hookean)),
        (
            "Mooney–Rivlin",
            Material::MooneyRivlin(MooneyRivlin::new(3.0, 0.495, 0.3)),
        ),
        ("Yeoh", composite(Matrix::Yeoh(yeoh), vec![])),
        (
            "two families of fibres (HGO)",
            composite(of_matrix, pair(0.0).to_vec()),
        ),
        (
            "two dispersed families (GOH)",
            composite(of_matrix, pair(0.226).to_vec()),
        ),
        (
            "four families",
            composite(of_matrix, [pair(0.0), four].concat()),
        ),
        ("Fung", composite(Matrix::Fung(fung), vec![])),
    ]
}

/// Returns the CPU time of this thread, or the time of the clock where the system does not tell.
fn now(start: Instant) -> Duration {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").unwrap_or_default();
    let nanoseconds = text.split(' ').next().and_then(|own| own.parse().ok());
    nanoseconds.map_or_else(|| start.elapsed(), Duration::from_nanos)
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

struct Subject {
    name: &'static str,
    numbers: usize,
    tube: SplineTube,
    tangent: MatrixFreeTangent,
    times: [Vec<f64>; 2],
}

fn main() {
    let text = include_str!("../../../cases/carotid.toml");
    let mut plan: Plan = plica::case::read(text, "carotid").expect("the case is sound");
    [plan.mesh.axial, plan.mesh.around, plan.mesh.thickness] = MESH;
    plan.mesh.layers.truncate(1);
    plan.tube.layers.truncate(1);
    plan.tube.layers[0].share = 1.0;
    let mut subjects: Vec<Subject> = laws()
        .into_iter()
        .map(|(name, law)| {
            let numbers = match &law {
                Material::NeoHookean(law) => <NeoHookean as Law>::TangentData::count(law),
                law => <Material as Law>::TangentData::count(law),
            };
            let mut tube = plan.tube.clone();
            tube.layers[0].material = law;
            Subject {
                name,
                numbers,
                tube: SplineTube::new(&tube, &plan.mesh, MESH[1]),
                tangent: MatrixFreeTangent::default(),
                times: [vec![], vec![]],
            }
        })
        .collect();
    let load = plan.tube.rest();
    let unknowns = subjects[0].tube.unknowns();
    // Stretched along, and inflated: the radial component is the second of three, by ring.
    let row = unknowns / MESH[0];
    let u: Vec<f64> = (0..unknowns)
        .map(|n| match n / MESH[1] % 3 {
            0 => 0.5 * plan.tube.length * (n / row) as f64 / MESH[0] as f64,
            1 => 0.15 + 1e-4 * (n as f64).sin(),
            _ => 0.0,
        })
        .collect();
    let mut y = vec![0.0; unknowns];
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build();
    pool.expect("a thread").install(|| {
        for _ in 0..ROUNDS {
            for subject in &mut subjects {
                let start = Instant::now();
                let before = now(start);
                subject.tube.linearise(&load, &u, &mut subject.tangent);
                let between = now(start);
                subject
                    .tube
                    .add_tangent_product(&subject.tangent, 1.0, &u, &mut y);
                subject
                    .tube
                    .add_tangent_product(&subject.tangent, 1.0, &u, &mut y);
                let after = now(start);
                subject.times[0].push((after - between).as_secs_f64() * 500.0);
                subject.times[1].push((between - before).as_secs_f64() * 1e3);
            }
        }
    });
    println!("{} x {} x {} control points", MESH[0], MESH[1], MESH[2]);
    println!(
        "{:>30} {:>8} {:>9} {:>6} {:>11} {:>6}",
        "law", "numbers", "product", "ratio", "linearise", "ratio"
    );
    let reference = subjects[0].times.clone();
    for subject in &subjects {
        let of = |n: usize| {
            let ratios = subject.times[n].iter().zip(&reference[n]);
            let ratio = median(ratios.map(|(own, other)| own / other).collect());
            (median(subject.times[n].clone()), ratio)
        };
        let ((product, more), (linearise, longer)) = (of(0), of(1));
        println!(
            "{:>30} {:>8} {product:>9.2} {more:>6.2} {linearise:>11.2} {longer:>6.2}",
            subject.name, subject.numbers
        );
    }
}
