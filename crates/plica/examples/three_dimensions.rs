//! Following a circumferential mode into three dimensions: an imperfect ring becomes oval.
//!
//! The perfect ring of `ring_buckling` stays round at any pressure. Here its geometry has a wave of mode 2 with an amplitude of
//! 1e-3 D, and half of the circumference is solved for (`symmetry = { fold = 2 }`). Near the critical pressure pc of
//! mode 2 a perfect structure with a bifurcation amplifies an imperfection by about 1 / (1 − p/pc) (Southwell).
//!
//! Expected (pc = 6.94351e-4 E): the additional amplitude at p = pc/2 is about as large as the imperfection itself; a fit of
//! amplitude over pressure (Southwell's plot) gives pc within a few per cent.

use plica::{Study, case};
use std::error::Error;

const CRITICAL: f64 = 6.94351e-4;
const IMPERFECTION: f64 = 1e-3;

fn main() -> Result<(), Box<dyn Error>> {
    let text = format!(
        "
        symmetry = {{ fold = 2 }}
        tube = {{ length = 0.5, thickness = 0.06 }}
        ends = {{ colon = 'sliding', ileum = 'sliding' }}
        mesh.control_points = {{ axial = 4, around = 24, thickness = 4 }}
        output.stability_modes = 0
        [[imperfections]]
        of = 'geometry'
        amplitude = {IMPERFECTION:e}
        shape = {{ wave = {{ mode = 2, axial = 'uniform' }} }}
        [[stages]]
        steps = 8
        drive.outer-wall.pressure = {:e}
        ",
        0.8 * CRITICAL
    );
    let plan = case::read(&text, "oval")?;
    let mut points = vec![];
    let mut first = None;
    for state in Study::new(&plan)? {
        let state = state?;
        let pressure = state.load.pressures[1].follower;
        let asymmetry = state.measures.asymmetry;
        let growth = asymmetry.amplitude - *first.get_or_insert(asymmetry.amplitude);
        println!(
            "p/pc = {:.2}: mode {}, amplitude {:.3e} D",
            pressure / CRITICAL,
            asymmetry.harmonic,
            asymmetry.amplitude
        );
        if pressure > 0.3 * CRITICAL {
            points.push((growth, growth / pressure));
        }
    }
    // Southwell's plot: growth / p is linear in growth, with the slope 1 / pc.
    let n = points.len() as f64;
    let mean = |f: fn(&(f64, f64)) -> f64| points.iter().map(f).sum::<f64>() / n;
    let (x, y) = (mean(|p| p.0), mean(|p| p.1));
    let covariance: f64 = points.iter().map(|p| (p.0 - x) * (p.1 - y)).sum();
    let variance: f64 = points.iter().map(|p| (p.0 - x).powi(2)).sum();
    let critical = variance / covariance;
    println!("critical pressure {critical:.3e} E (expected {CRITICAL:.3e} within 5 %)");
    Ok(())
}
