//! The stability test of a state: the circumferential modes that an axisymmetric state is unstable to, and the sign of
//! the lowest eigenvalue of any other state.

use super::lowest_modes::Noise;
use super::problem::{TubeSolver, TubeTangent};
use super::verdict::{Instability, Stability, UnstableMode};
use super::{TubeProblem, harmonic_tangent::HarmonicSystem};
use crate::assembly::SplineTube;
use crate::monitor::Monitor;
use crate::solve::{Equilibrium, Operator, Path, Search, Solver, Tangent, lowest};
use crate::tube::Load;
use rayon::prelude::*;
use std::f64::consts::PI;

/// Smallest circumferential displacement of a twisted tube, in D.
const TWISTED: f64 = 1e-9;

/// Largest difference of displacements between rings of an axisymmetric tube, in D.
const ROUND: f64 = 1e-9;

/// Iterations allowed to determine the sign of the lowest eigenvalue.
const ITERATIONS: usize = 80;

/// Tests the stability of the state of a path.
///
/// An axisymmetric state without twist is tested against the circumferential modes 0 to `modes`,
/// whatever the symmetry of the run: in an axisymmetric run, mode 0 is the run's own tangent and all
/// others are blocks of the tangent of the whole tube. For any other state only the run's own tangent
/// is tested, whose eigenvalues do not separate by mode: for a twisted axisymmetric run all of them count
/// for mode 0; otherwise the verdict says whether the lowest eigenvalue is negative. It is
/// [`Stability::Unknown`] if its sign did not show within 80 iterations, if the monitor cancelled, if
/// `modes` is zero, which skips the test, or if a twisted axisymmetric state has no negative eigenvalue in mode 0:
/// higher modes, whose phase travels along a twisted tube, are not tested.
///
/// If the load drives the volume of the lumen, the state is tested at a held volume, which matters to mode 0.
///
/// Uses the solver that the path has at its state, and makes it if needed. Friction has no energy of its own, and is left
/// out.
pub fn test_stability(
    problem: &TubeProblem,
    path: &mut Path<impl Equilibrium<Load = Load, Tangent = TubeTangent>>,
    modes: usize,
    monitor: &mut dyn Monitor,
) -> Stability {
    let tube = &problem.tube;
    let (own, k) = (path.state().negative_pivots, tube.sector.rings);
    let u = &path.state().u;
    let round = |u: &[f64]| {
        let mut rings = u.chunks_exact(k);
        rings.all(|rings| rings.iter().all(|x| (x - rings[0]).abs() <= ROUND))
    };
    let round =
        round(u) && tube.geometric_imperfection().is_none_or(round) && !tube.tube.has_sectors();
    let of_ring: Vec<f64> = u.iter().step_by(k).copied().collect();
    let twisted = of_ring.iter().skip(2).step_by(3).any(|u| u.abs() > TWISTED);
    if !round || (twisted && k > 1) {
        let without_friction = problem.has_friction().then(|| {
            let tangent = problem.without_friction().tangent(&path.state().load, u);
            tangent.into_shifted(0.0).ok()
        });
        let (own, solver) = match &without_friction {
            None => (own, path.solver()),
            Some(None) => (1, None),
            Some(Some(solver)) => {
                let own = solver
                    .negative_pivots()
                    .max(usize::from(solver.is_unstable()));
                (own, Some(solver))
            }
        };
        let unstable = match (own, solver) {
            (0, _) if modes == 0 => None,
            (0, Some(TubeSolver::Harmonic(system))) => lowest_is_negative(tube, system, monitor),
            (0, _) => None,
            _ => Some(true),
        };
        return match unstable {
            Some(true) => Stability::Unstable(vec![Instability {
                mode: UnstableMode::Lowest,
                eigenvalues: own.max(1),
            }]),
            Some(false) => Stability::Stable,
            None => Stability::Unknown,
        };
    }
    let highest = if twisted {
        0
    } else {
        modes.min((tube.sector.around - 1) / 2)
    };
    // The harmonics of the cyclic sector are those of the run's own tangent.
    let repeats = tube.sector.around / k;
    let known = match path.solver() {
        Some(TubeSolver::Harmonic(system)) if !problem.has_friction() => {
            system.negative_in_harmonics()
        }
        _ => None,
    };
    let known = known.unwrap_or(&[]).to_vec();
    // The blocks of an axisymmetric state are those of its ring alone.
    let ring = (k > 1).then(|| {
        let mut ring = TubeProblem::new(tube.axisymmetric());
        if problem.contact.is_some() {
            ring = ring.with_contact();
        }
        match problem.driven_lumen_at_rest() {
            Some(_) => ring.with_driven_lumen(),
            None => ring,
        }
    });
    let ring = ring.as_ref().unwrap_or(problem);
    let load = &path.state().load;
    let negative = |n: usize| {
        // With contact, the run's own tangent does not twist.
        if k == 1 && n == 0 && problem.contact.is_none() && !problem.has_friction() {
            return own;
        }
        if let (0, Some(&count)) = (n % repeats, known.get(n / repeats)) {
            return count;
        }
        let prescribed = ring.tube.prescribed_in_harmonic(n);
        // A singular block is at the limit of stability and counts as unstable.
        let mut tangent = ring.ring_tangent(load, &of_ring, n);
        tangent.constrain(&prescribed);
        tangent
            .factor()
            .map_or(1, |factor| factor.negative_pivots())
    };
    let counts: Vec<(usize, usize)> = (0..=highest)
        .into_par_iter()
        .map(|n| (n, negative(n)))
        .collect();
    let unstable: Vec<Instability> = counts
        .into_iter()
        .filter(|(_, eigenvalues)| *eigenvalues > 0)
        .map(|(n, eigenvalues)| Instability {
            mode: UnstableMode::Circumferential(n),
            eigenvalues,
        })
        .collect();
    if unstable.is_empty() {
        if twisted && modes > 0 {
            Stability::Unknown
        } else {
            Stability::Stable
        }
    } else {
        Stability::Unstable(unstable)
    }
}

/// Returns whether the lowest eigenvalue of the tangent of a state that is not axisymmetric is negative; none if its sign
/// was not determined.
fn lowest_is_negative(
    tube: &SplineTube,
    system: &HarmonicSystem,
    monitor: &mut dyn Monitor,
) -> Option<bool> {
    if system.average_is_indefinite() {
        return Some(true);
    }
    let search = Search {
        wanted: 1,
        accuracy: 1e-3,
        iterations: ITERATIONS,
        side_of: Some(0.0),
    };
    // From the same seeds always: eigenvectors of the state before would hide what has become
    // negative since, and make the answer depend on the way. Noise, made smooth, has a part of every
    // eigenvector.
    let mut seeds = seeds(tube);
    let mut noise = Noise::default();
    let force: Vec<f64> = seeds[0].iter().map(|_| noise.next()).collect();
    let mut smooth = vec![0.0; force.len()];
    system.precondition(&force, &mut smooth);
    seeds.push(smooth);
    lowest(system, &seeds, &search, monitor).is_below(0.0)
}

/// Two displacements with a part of every low harmonic, not alike on any two sides of the tube.
fn seeds(tube: &SplineTube) -> Vec<Vec<f64>> {
    let (k, length) = (tube.sector.rings, tube.tube.length);
    let repeats = tube.sector.around / k;
    let highest = 4.min((k - 1) / 2);
    let seed = |quarter: f64| {
        tube.control_values_from(|z, _, ring| {
            let along = (PI * z / length).sin() + 0.5 * (2.0 * PI * z / length + quarter).sin();
            let (mut radial, mut around) = (0.0, 0.0);
            for n in 1..=highest {
                let n = (n * repeats) as f64;
                let phi = n * tube.sector.ring_angle(ring) + quarter * (1.0 + 0.3 * n);
                radial += along * phi.cos();
                around += along * (-phi.sin() / n);
            }
            [0.1 * radial, along + radial, around]
        })
    };
    vec![seed(0.0), seed(0.5 * PI)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Material, NeoHookean};
    use crate::tube::{Mesh, Support, Tube, WallLayer};

    #[test]
    fn of_an_oval_the_sign_of_the_lowest_eigenvalue_is_that_of_the_assembled_tangent() {
        let tube = Tube {
            length: 1.0,
            thickness: 0.06,
            layers: vec![WallLayer::of(Material::NeoHookean(NeoHookean::new(
                1.0, 0.4,
            )))],
            muscles: vec![],
            ends: [Support::Fixed, Support::Sliding],
            imperfections: vec![],
            obstacles: vec![],
            patches: vec![],
            foundations: vec![],
        };
        let mesh = Mesh {
            axial: 8,
            around: 12,
            thickness: 4,
            degree: 3,
            refinements: vec![],
            grading: 1.0,
            contact_range: 0.25,
            volumetric: Default::default(),
            layers: vec![],
        };
        let mut seen = [0; 3];
        for rings in [12, 6] {
            let problem = TubeProblem::new(SplineTube::new(&tube, &mesh, rings));
            let tube = &problem.tube;
            for (size, pressure) in [
                (0.004, 0.0),
                (0.004, 0.02),
                (0.004, 0.05),
                (0.02, 0.0),
                (0.02, 0.05),
                (0.04, 0.0),
                (0.04, 0.02),
                (0.04, 0.03),
            ] {
                // Not an equilibrium, which makes no difference to the tangent.
                let oval = tube.control_values_from(|z, _, ring| {
                    let phi = 2.0 * tube.sector.ring_angle(ring);
                    let size = size * (1.0 + (3.0 * z).cos());
                    [0.0, size * phi.cos(), -0.5 * size * phi.sin()]
                });
                let mut load = tube.tube.rest();
                load.pressures[1].follower = pressure;
                let mut tangent = tube.tangent(&load, &oval);
                tangent.constrain(tube.prescribed());
                let negative = tangent.factor().unwrap().negative_pivots();
                let mut path = Path::begin(&problem, load, oval, Default::default()).unwrap();
                let Some(TubeSolver::Harmonic(system)) = path.solver() else {
                    unreachable!("many rings")
                };
                let average = system.average_is_indefinite();
                assert!(!average || negative > 0);
                assert_eq!(path.state().negative_pivots, usize::from(average));
                let verdict = test_stability(&problem, &mut path, 4, &mut ());
                println!("{rings} {pressure}: {negative} negative, {average}, {verdict}");
                assert_eq!(verdict.is_unstable(), negative > 0);
                assert_ne!(verdict, Stability::Unknown);
                seen[usize::from(negative > 0) + usize::from(average)] += 1;
            }
        }
        // Stable, and unstable with and without the average telling.
        assert!(seen.iter().all(|&times| times > 0), "{seen:?}");
    }
}
