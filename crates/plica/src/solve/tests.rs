//! The solvers on energies of one or two unknowns with known equilibria.

use super::iterate::Iterate;
use super::*;
use crate::matrix::{BlockBanded, Singular};
use crate::monitor::Monitor;
use std::cell::Cell;
use std::rc::Rc;
use std::sync::Arc;

/// An energy with its first and second derivatives.
type Jet<const N: usize> = (f64, [f64; N], [[f64; N]; N]);

/// An energy W(load, u) of N free unknowns, which may be undefined behind a wall.
struct Toy<const N: usize> {
    jet: fn(f64, [f64; N]) -> Jet<N>,
    /// Bound of the first unknown.
    wall: f64,
    damping: Arc<BlockBanded>,
}

/// The first unknown is behind the wall.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("behind the wall")]
pub(super) struct BehindTheWall;

fn toy<const N: usize>(jet: fn(f64, [f64; N]) -> Jet<N>) -> Toy<N> {
    let mut unit = [[0.0; N]; N];
    for i in 0..N {
        unit[i][i] = 1.0;
    }
    Toy {
        jet,
        wall: f64::INFINITY,
        damping: Arc::new(matrix(unit)),
    }
}

pub(super) fn matrix<const N: usize>(entries: [[f64; N]; N]) -> BlockBanded {
    let mut matrix = BlockBanded::zeros(1, N, 1);
    let places: Vec<[usize; N]> = (0..N)
        .map(|i| std::array::from_fn(|j| matrix.place(0, i, j)))
        .collect();
    let panel = matrix.panels_mut().next().unwrap();
    for i in 0..N {
        for j in 0..N {
            panel[places[i][j]] = entries[i][j];
        }
    }
    matrix
}

impl<const N: usize> Equilibrium for Toy<N> {
    type Load = f64;
    type EvaluationError = BehindTheWall;
    type Tangent = Direct;

    fn prescribed(&self) -> &[bool] {
        &[false; 2][..N]
    }
    fn apply_prescribed(&self, _: &f64, _: &mut [f64]) {}
    fn between(&self, from: &f64, to: &f64, t: f64) -> f64 {
        from + t * (to - from)
    }
    fn forces(&self, load: &f64, u: &[f64]) -> Result<ResidualEvaluation, BehindTheWall> {
        if u[0] >= self.wall {
            return Err(BehindTheWall);
        }
        let (energy, residual, _) = (self.jet)(*load, u.try_into().unwrap());
        Ok(ResidualEvaluation {
            energy,
            residual: residual.to_vec(),
            residual_scale: 1.0,
            rounding: 1e-15,
        })
    }
    fn tangent(&self, load: &f64, u: &[f64]) -> Direct {
        let stiffness = matrix((self.jet)(*load, u.try_into().unwrap()).2);
        Direct::new(stiffness, self.damping.clone(), self.prescribed().into())
    }
    fn damping(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.damping.multiply_add(factor, v, y);
    }
}

/// A shallow truss with minima at u = −1 and 1 and a load that pushes from the one to the other. The
/// first ceases to exist at u = −1/√3 under a load of 2/(3√3) = 0.385.
fn truss() -> Toy<1> {
    toy(|load, [u]| {
        let well = u * u - 1.0;
        let energy = 0.25 * well * well - load * u;
        (energy, [u * well - load], [[3.0 * u * u - 1.0]])
    })
}

/// A strut: x follows the load, and beyond x = 1 the straight state y = 0 is a saddle. The bent branch
/// is x = 2 load − 1, y² = x − 1.
fn strut() -> Toy<2> {
    toy(|load, [x, y]| {
        let energy = 0.5 * (x - load).powi(2) + 0.25 * y.powi(4) + 0.5 * (1.0 - x) * y * y;
        let residual = [x - load - 0.5 * y * y, y * y * y + (1.0 - x) * y];
        (energy, residual, [[1.0, -y], [-y, 3.0 * y * y + 1.0 - x]])
    })
}

/// A unit spring, and a wall at u = 1.
fn spring_before_a_wall() -> Toy<1> {
    Toy {
        wall: 1.0,
        ..toy(|load, [u]| (0.5 * u * u - load * u, [u - load], [[1.0]]))
    }
}

/// A spring that stiffens towards a wall at u = 1, which it never reaches: u = load/(1 + load).
fn stiffening_spring() -> Toy<1> {
    Toy {
        wall: 1.0,
        ..toy(|load, [u]| {
            let left = 1.0 - u;
            let energy = -u - left.ln() - load * u;
            (energy, [u / left - load], [[1.0 / (left * left)]])
        })
    }
}

/// A spring that softens: load = u − u², at most 1/4, with no equilibrium beyond. Another spring follows at twice the load.
fn softening_spring() -> Toy<2> {
    toy(|load, [u, v]| {
        let w = v - 2.0 * load;
        let energy = 0.5 * u * u - u * u * u / 3.0 - load * u + 0.5 * w * w;
        (
            energy,
            [u - u * u - load, w],
            [[1.0 - 2.0 * u, 0.0], [0.0, 1.0]],
        )
    })
}

fn path_from<P>(problem: &P, from: f64, u: impl Into<Vec<f64>>, to: f64) -> Path<&P>
where
    P: Equilibrium<Load = f64, EvaluationError = BehindTheWall>,
{
    let mut path = Path::begin(problem, from, u.into(), Settings::default()).unwrap();
    path.begin_segment(to);
    path
}

fn newton_from<P: Equilibrium>(
    problem: &P,
    load: &P::Load,
    u: impl Into<Vec<f64>>,
) -> Result<Solution, Failure<P::EvaluationError>> {
    let settings = Settings::default();
    newton(
        problem,
        load,
        u.into(),
        &settings,
        &mut Effort::default(),
        &mut (),
    )
}

/// Returns the solution and the number of linear solves.
fn relaxation_from<P: Equilibrium>(
    problem: &P,
    load: &P::Load,
    u: impl Into<Vec<f64>>,
    settings: &Settings,
) -> (Solution, usize) {
    let mut effort = Effort::default();
    let found = relaxation(problem, load, u.into(), settings, &mut effort, &mut ());
    (found.unwrap(), effort.linear_solves)
}

/// With a tolerance of 1e-8 and stiffnesses about one, errors are below 1e-7.
fn assert_at<const N: usize>(state: &State<f64>, u: [f64; N]) {
    for i in 0..N {
        assert!(
            (state.u[i] - u[i]).abs() < 1e-7,
            "{:?} is not {u:?}",
            state.u
        );
    }
}

#[test]
fn newton_follows_a_truss_and_relaxation_takes_it_through_its_snap() {
    let truss = truss();
    let mut path = path_from(&truss, 0.0, [-1.0], 0.5);
    for t in [0.2, 0.4, 0.6] {
        let step = path.advance(t, &mut ()).unwrap();
        assert_eq!((step.method, step.damping_work), (Method::Newton, 0.0));
        assert!(path.state().u[0] < -1.0 / 3.0_f64.sqrt());
    }
    let near = path.state().u.clone();
    let step = path.advance(0.8, &mut ()).unwrap();
    assert_eq!(step.method, Method::Relaxation);
    assert!(step.damping_work > 0.0);
    let state = path.state();
    assert_eq!((state.load, path.reached()), (0.4, 0.8));
    assert!(state.energy < truss.forces(&0.4, &near).unwrap().energy);
    assert!(state.in_equilibrium() && state.negative_pivots == 0);
    // u³ − u = 0.4 has one real root.
    let u = 2.0 / 3.0_f64.sqrt() * ((0.6 * 3.0_f64.sqrt()).acosh() / 3.0).cosh();
    assert_at(state, [u]);
    let step = path.advance(1.0, &mut ()).unwrap();
    assert_eq!(step.method, Method::Newton);
}

#[test]
fn a_state_on_a_saddle_is_not_stable() {
    let strut = strut();
    let mut path = path_from(&strut, 1.5, [1.5, 0.0], 2.0);
    assert_eq!(path.state().negative_pivots, 1);
    path.advance(1.0, &mut ()).unwrap();
    let state = path.state();
    assert_at(state, [2.0, 0.0]);
    assert!(state.in_equilibrium());
    assert_eq!((state.u[1], state.negative_pivots), (0.0, 1));

    // A small perturbation leads to the bent branch.
    let (found, _) = relaxation_from(&strut, &2.0, [2.0, 1e-3], &Settings::default());
    let mut path = path_from(&strut, 2.0, found.u, 2.1);
    assert_at(path.state(), [3.0, 2.0_f64.sqrt()]);
    assert_eq!(path.state().negative_pivots, 0);
    let step = path.advance(1.0, &mut ()).unwrap();
    assert_eq!(step.method, Method::Newton);
    assert_at(path.state(), [3.2, 2.2_f64.sqrt()]);
}

#[test]
fn newton_refuses_an_indefinite_tangent() {
    for found in [
        newton_from(&strut(), &1.5, [1.5, 0.1]),
        newton_from(&iterated(strut()), &1.5, [1.5, 0.1]),
    ] {
        let failure = found.unwrap_err();
        assert_eq!(failure, Failure::Indefinite { negative_pivots: 1 });
    }
}

#[test]
fn newton_halves_a_full_step_that_ends_at_the_same_energy() {
    // The full step leads from u to −u.
    let cusp = toy(|_, [u]: [f64; 1]| {
        let root = u.abs().sqrt();
        (u.abs() * root, [1.5 * root * u.signum()], [[0.75 / root]])
    });
    assert_eq!(newton_from(&cusp, &0.0, [1.0]).unwrap().u, [0.0]);
}

#[test]
fn a_resumed_path_begins_with_its_halving_level() {
    let spring = spring_before_a_wall();
    let resumed = |halving_level| {
        let continuation = ContinuationState {
            halving_level,
            ..ContinuationState::at_start(vec![0.0], vec![])
        };
        let (loads, settings) = (Segment::between(0.0, 0.5), Settings::default());
        let path = Path::resume(&spring, loads, 0.0, vec![0.0], continuation, settings);
        let mut path = path.unwrap();
        let step = path.advance(1.0, &mut ()).unwrap();
        // One for each accepted state, since predictions are exact.
        let states = step.effort.linear_solves;
        (states, path.continuation_state().halving_level)
    };
    assert_eq!([0, 1, 2, 3].map(resumed), [(1, 0), (2, 0), (3, 0), (4, 0)]);
}

#[test]
fn steps_to_undefined_energies_are_shortened() {
    let spring = stiffening_spring();
    let mut path = path_from(&spring, 0.0, [0.0], 3.0);
    // The tangent alone predicts u = 3.
    let step = path.advance(1.0, &mut ()).unwrap();
    assert_eq!(step.method, Method::Newton);
    assert_at(path.state(), [0.75]);
}

#[test]
fn a_path_ends_at_a_wall_as_close_as_its_halvings_permit() {
    let spring = spring_before_a_wall();
    let mut path = path_from(&spring, 0.0, [0.0], 2.0);
    path.advance(0.4, &mut ()).unwrap();
    let error = path.advance(0.9, &mut ()).unwrap_err();
    let broken = (Method::Newton, Failure::Evaluation(BehindTheWall));
    assert!(error.attempts.contains(&broken), "{error}");
    assert!(error.to_string().contains("behind the wall"), "{error}");
    assert!(!error.is_cancelled());
    // Eight halvings of a step of 0.5.
    let (state, shortest) = (path.state(), 0.5 / 256.0);
    assert!(path.reached() < 0.5 && path.reached() + shortest >= 0.5);
    assert_eq!(path.continuation_state().halving_level, 8);
    assert_eq!(state.load, 2.0 * path.reached());
    assert!(state.in_equilibrium());
    assert_at(state, [state.load]);
}

#[test]
fn a_path_that_ends_at_a_limit_point_reports_its_load() {
    for wall in [f64::INFINITY, 1.0] {
        let spring = Toy {
            wall,
            ..softening_spring()
        };
        let mut path = path_from(&spring, 0.0, [0.0, 0.0], 1.0);
        path.advance(0.1, &mut ()).unwrap();
        path.advance(0.2, &mut ()).unwrap();
        let error = path.advance(0.3, &mut ()).unwrap_err();
        let limit = error.limit_point.unwrap();
        assert!((limit - 0.25).abs() < 1e-3, "{limit}");
        assert_eq!(path.load_at(limit), limit);
        assert!((0.249..=0.25).contains(&path.reached()), "{error}");
        // Relaxation, which has 200 at most, is tried once.
        let solves = error.step.effort.linear_solves;
        assert!(solves < 250, "{solves}");
        // The states that lead to it may be in one large step.
        let mut path = path_from(&spring, 0.0, [0.0, 0.0], 1.0);
        let limit = path.advance(1.0, &mut ()).unwrap_err().limit_point.unwrap();
        assert!((limit - 0.25).abs() < 1e-3, "{limit}");
    }
}

#[test]
fn a_limit_load_may_be_a_minimum() {
    let spring = toy(|load, [u]| {
        let energy = 0.5 * u * u + u * u * u / 3.0 - load * u;
        (energy, [u + u * u - load], [[1.0 + 2.0 * u]])
    });
    let mut path = path_from(&spring, 0.0, [0.0], -0.5);
    let limit = path.advance(1.0, &mut ()).unwrap_err().limit_point.unwrap();
    assert!((path.load_at(limit) + 0.25).abs() < 1e-3, "{limit}");
}

#[test]
fn neither_a_wall_nor_a_bifurcation_is_a_limit_point() {
    let spring = spring_before_a_wall();
    let mut path = path_from(&spring, 0.0, [0.0], 2.0);
    assert_eq!(path.advance(1.0, &mut ()).unwrap_err().limit_point, None);
    // The straight strut loses stability at x = 1, beyond which there is no stable state.
    let strut = toy(|load, [x, y]| {
        let energy = 0.5 * (x - load).powi(2) - 0.25 * y.powi(4) + 0.5 * (1.0 - x) * y * y;
        let residual = [x - load - 0.5 * y * y, (1.0 - x - y * y) * y];
        (energy, residual, [[1.0, -y], [-y, 1.0 - x - 3.0 * y * y]])
    });
    let mut path = path_from(&strut, 0.0, [0.0, 0.0], 2.0);
    if let Err(error) = path.advance(1.0, &mut ()) {
        assert_eq!(error.limit_point, None);
    }
    // With an imperfection, the load of the same strut has a maximum.
    let strut = toy(|load, [x, y]| {
        let energy =
            0.5 * (x - load).powi(2) - 0.25 * y.powi(4) + 0.5 * (1.0 - x) * y * y - 1e-3 * y;
        let residual = [x - load - 0.5 * y * y, (1.0 - x - y * y) * y - 1e-3];
        (energy, residual, [[1.0, -y], [-y, 1.0 - x - 3.0 * y * y]])
    });
    let mut path = path_from(&strut, 0.0, [0.0, 1e-3], 2.0);
    let limit = path.advance(1.0, &mut ()).unwrap_err().limit_point.unwrap();
    // 1 − load = 3/2 y² + 1e-3/y is least at 3 y³ = 1e-3.
    let y = (1e-3_f64 / 3.0).cbrt();
    let exact = 1.0 - 1.5 * y * y - 1e-3 / y;
    assert!(
        (path.load_at(limit) / exact - 1.0).abs() < 1e-3,
        "{} {exact}",
        path.load_at(limit)
    );
}

/// Cancels at once, and counts how often it is asked.
#[derive(Default)]
struct Cancels {
    asked: Cell<usize>,
}

impl Monitor for Cancels {
    fn is_cancelled(&self) -> bool {
        self.asked.set(self.asked.get() + 1);
        true
    }
}

#[test]
fn a_cancelled_path_stays_where_it_was() {
    let truss = truss();
    let mut path = path_from(&truss, 0.0, [-1.0], 0.5);
    path.advance(0.2, &mut ()).unwrap();
    let before = path.state().clone();
    // Before the snap and past it.
    for t in [0.4, 1.0] {
        let error = path.advance(t, &mut Cancels::default()).unwrap_err();
        assert!(error.is_cancelled(), "{error}");
        assert_eq!(path.reached(), 0.2);
        assert_eq!(path.state().load, before.load);
        assert_eq!(path.state().u, before.u);
    }
    path.advance(0.4, &mut ()).unwrap();
}

#[test]
fn on_a_smooth_branch_no_step_takes_more_solves_than_the_first() {
    let truss = truss();
    let mut path = path_from(&truss, 0.0, [1.0], 4.0);
    let costs: Vec<usize> = (1..=10)
        .map(|i| path.advance(f64::from(i) / 10.0, &mut ()).unwrap())
        .map(|step| step.effort.linear_solves)
        .collect();
    assert!(costs.iter().all(|&cost| cost <= costs[0]), "{costs:?}");
    // The prediction by the cubic improves.
    assert!(costs[9] < costs[0], "{costs:?}");
}

/// The same energies with conjugate gradients as linear solver.
struct Iterated<const N: usize> {
    toy: Toy<N>,
    /// Iterations after which a solve is cut off.
    limit: usize,
    /// Number of solves that were cut off.
    cut_off: Rc<Cell<usize>>,
}

fn iterated<const N: usize>(toy: Toy<N>) -> Iterated<N> {
    Iterated {
        toy,
        limit: 100,
        cut_off: Rc::default(),
    }
}

struct IteratedTangent {
    stiffness: Direct,
    damping: Arc<BlockBanded>,
    prescribed: Vec<bool>,
    alpha: f64,
    limit: usize,
    cut_off: Rc<Cell<usize>>,
}

impl<const N: usize> Equilibrium for Iterated<N> {
    type Load = f64;
    type EvaluationError = BehindTheWall;
    type Tangent = IteratedTangent;

    fn prescribed(&self) -> &[bool] {
        self.toy.prescribed()
    }
    fn apply_prescribed(&self, load: &f64, u: &mut [f64]) {
        self.toy.apply_prescribed(load, u);
    }
    fn between(&self, from: &f64, to: &f64, t: f64) -> f64 {
        self.toy.between(from, to, t)
    }
    fn forces(&self, load: &f64, u: &[f64]) -> Result<ResidualEvaluation, BehindTheWall> {
        self.toy.forces(load, u)
    }
    fn tangent(&self, load: &f64, u: &[f64]) -> IteratedTangent {
        IteratedTangent {
            stiffness: self.toy.tangent(load, u),
            damping: self.toy.damping.clone(),
            prescribed: self.prescribed().to_vec(),
            alpha: 0.0,
            limit: self.limit,
            cut_off: self.cut_off.clone(),
        }
    }
    fn damping(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.toy.damping(factor, v, y);
    }
}

impl Tangent for IteratedTangent {
    type Solver = Self;

    fn multiply_add(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.stiffness.multiply_add(factor, v, y);
    }
    fn shifted(&self, alpha: f64) -> Result<Self, Singular> {
        Ok(Self {
            stiffness: self.stiffness.clone(),
            damping: self.damping.clone(),
            prescribed: self.prescribed.clone(),
            alpha,
            limit: self.limit,
            cut_off: self.cut_off.clone(),
        })
    }
}

impl Solver for IteratedTangent {
    fn negative_pivots(&self) -> usize {
        0
    }
    fn solve(
        &self,
        b: &mut [f64],
        accuracy: f64,
        monitor: &dyn Monitor,
    ) -> Result<Solved, NegativeCurvature> {
        let solved = conjugate_gradients(self, b, accuracy, self.limit, monitor)?;
        let cut_off = usize::from(!solved.converged);
        self.cut_off.set(self.cut_off.get() + cut_off);
        Ok(solved)
    }
}

impl Operator for IteratedTangent {
    fn prescribed(&self) -> &[bool] {
        &self.prescribed
    }
    fn apply(&self, v: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.stiffness.multiply_add(1.0, v, out);
        self.damping.multiply_add(self.alpha, v, out);
    }
    fn precondition(&self, r: &[f64], out: &mut [f64]) {
        out.copy_from_slice(r);
    }
    fn metric(&self, v: &[f64], out: &mut [f64]) {
        out.fill(0.0);
        self.damping.multiply_add(1.0, v, out);
    }
}

#[test]
fn direct_and_iterative_solvers_follow_the_same_path() {
    let (direct, other) = (truss(), iterated(truss()));
    let mut one = path_from(&direct, 0.0, [-1.0], 0.5);
    let mut other = path_from(&other, 0.0, [-1.0], 0.5);
    for t in [0.2, 0.4, 0.6, 0.8, 1.0] {
        let exact = one.advance(t, &mut ()).unwrap();
        let step = other.advance(t, &mut ()).unwrap();
        assert_eq!(step.method, exact.method);
        // At least one inner iteration for each linear solve, failed attempts included.
        assert_eq!(exact.effort.inner_iterations, 0);
        let Effort {
            linear_solves,
            inner_iterations,
        } = step.effort;
        assert!(inner_iterations >= linear_solves, "{step:?}");
        assert_at(other.state(), [one.state().u[0]]);
    }
}

#[test]
fn a_monitor_cancels_within_the_first_linear_solves() {
    let strut = iterated(strut());
    let settings = Settings::default();
    let (load, u) = (2.5, vec![3.5, 1.0]);
    for solve in [newton, relaxation] {
        let (mut effort, mut monitor) = (Effort::default(), Cancels::default());
        let found = solve(
            &strut,
            &load,
            u.clone(),
            &settings,
            &mut effort,
            &mut monitor,
        );
        assert_eq!(found.unwrap_err(), Failure::Cancelled);
        let expected = Effort {
            linear_solves: 0,
            inner_iterations: 1,
        };
        assert_eq!(effort, expected);
    }
    for scheme in [Scheme::Static, Scheme::PseudoTime(PseudoTime::default())] {
        let settings = Settings {
            scheme,
            ..Settings::default()
        };
        let mut path = Path::begin(&strut, 2.5, vec![4.0, 3.0_f64.sqrt()], settings).unwrap();
        path.begin_segment(3.0);
        let mut monitor = Cancels::default();
        let error = path.advance(1.0, &mut monitor).unwrap_err();
        assert!(error.is_cancelled(), "{error}");
        // In the solve for du/dt, in that of Newton, and after it.
        assert!(monitor.asked.get() <= 3);
        assert_eq!((path.reached(), path.state().load), (0.0, 2.5));
        path.advance(1.0, &mut ()).unwrap();
        assert_at(path.state(), [5.0, 2.0]);
    }
}

/// Springs of stiffness 1 and 30 under equal forces. One iteration does not solve their systems, and
/// no more are permitted.
fn cut_off_springs() -> Iterated<2> {
    let springs = toy(|load, [x, y]| {
        let (a, b) = (x - load, y - load / 30.0);
        let energy = 0.5 * (a * a + 30.0 * b * b);
        (energy, [a, 30.0 * b], [[1.0, 0.0], [0.0, 30.0]])
    });
    Iterated {
        limit: 1,
        ..iterated(springs)
    }
}

#[test]
fn relaxation_keeps_the_damping_that_the_linear_solver_needs() {
    let springs = cut_off_springs();
    let settings = Settings {
        tolerance: 1e-3,
        ..Settings::default()
    };
    let (_, solves) = relaxation_from(&springs, &0.5, [0.0; 2], &settings);
    let cut_off = springs.cut_off.get();
    // If the damping decreased as fast as possible, every third or fourth solve would be cut off.
    assert!(5 * cut_off < solves, "{cut_off} of {solves}");
}

#[test]
fn relaxation_takes_over_at_once_where_linear_solves_are_inaccurate() {
    let springs = cut_off_springs();
    let failed = newton_from(&springs, &0.5, [0.0; 2]).unwrap_err();
    let expected = matches!(
        failed,
        Failure::NotConverged {
            cause: Cause::InaccurateSolves,
            linear_solves: 2,
            ..
        }
    );
    assert!(expected, "{failed}");
    // The path does not halve its step, since damping makes the systems easier to solve.
    let settings = Settings {
        tolerance: 1e-2,
        ..Settings::default()
    };
    let mut path = Path::begin(&springs, 0.0, vec![0.0; 2], settings).unwrap();
    path.begin_segment(0.5);
    let step = path.advance(1.0, &mut ()).unwrap();
    assert_eq!(step.method, Method::Relaxation);
    assert_eq!(path.reached(), 1.0);
}

#[test]
fn relaxation_leaves_a_saddle_in_few_solves() {
    let strut = iterated(strut());
    let leave = |push: f64| relaxation_from(&strut, &2.5, [2.5, push], &Settings::default());
    let mut solves = vec![];
    for push in [1e-2, 1e-4, -1e-6] {
        let (found, count) = leave(push);
        let [x, y] = [4.0, 3.0_f64.sqrt() * push.signum()];
        assert!((found.u[0] - x).abs() < 1e-7 && (found.u[1] - y).abs() < 1e-7);
        solves.push(count);
        // The decrease of the energy is the work of the damping.
        let start = strut.forces(&2.5, &[2.5, push]).unwrap().energy;
        assert!((start - found.forces.energy - found.damping_work).abs() < 1e-12);
    }
    // However close to the saddle it begins.
    assert!(solves[2] <= solves[0] + 2, "{solves:?}");
    // Symmetry keeps it exactly on the saddle.
    let (found, _) = leave(0.0);
    assert_eq!(found.u, [2.5, 0.0]);
}

#[test]
fn the_work_of_constant_damping_is_the_fall_of_the_energy_at_a_constant_load() {
    let spring = toy(|load, [u]| (0.5 * (u - load) * (u - load), [u - load], [[1.0]]));
    for integrator in [Integrator::Newmark, Integrator::BackwardEuler] {
        for equilibrate in [false, true] {
            let settings = Settings {
                scheme: Scheme::PseudoTime(PseudoTime {
                    integrator,
                    equilibrate,
                    ..PseudoTime::default()
                }),
                ..Settings::default()
            };
            // From u = 1, out of equilibrium, to u = 0.
            let mut path = Path::begin(&spring, 0.0, vec![1.0], settings).unwrap();
            path.begin_segment(0.0);
            let step = path.advance(1.0, &mut ()).unwrap();
            assert_eq!(step.method, Method::PseudoTime);
            let fall = 0.5 - path.state().energy;
            // A step of 1 % of the way leaves about ½ % of the work.
            assert!(
                (step.damping_work / fall - 1.0).abs() < 0.01,
                "{integrator:?}: {} {fall}",
                step.damping_work
            );
            let still = path.continuation_state().velocity == [0.0];
            assert_eq!(
                (still, path.state().in_equilibrium()),
                (equilibrate, equilibrate)
            );
        }
    }
}

#[test]
fn a_segment_begins_with_whole_steps_and_without_a_previous_point() {
    let spring = spring_before_a_wall();
    let mut path = path_from(&spring, 0.0, [0.0], 2.0);
    path.advance(0.1, &mut ()).unwrap();
    path.advance(0.2, &mut ()).unwrap();
    let previous = path.continuation_state().previous.unwrap();
    assert_eq!((previous.t, &previous.u[..]), (0.1, &[0.2][..]));
    path.advance(0.9, &mut ()).unwrap_err();
    assert_eq!(path.continuation_state().halving_level, 8);
    path.begin_segment(0.5);
    let begun = path.continuation_state();
    assert_eq!((begun.halving_level, begun.reached), (0, 0.0));
    assert_eq!(begun.previous, None);
    let step = path.advance(1.0, &mut ()).unwrap();
    assert_eq!(step.effort.linear_solves, 1);
}

#[test]
fn a_snap_leaves_no_previous_point() {
    let truss = truss();
    let settings = Settings {
        max_step_halvings: 0,
        ..Settings::default()
    };
    let mut path = Path::begin(&truss, 0.0, vec![-1.0], settings).unwrap();
    path.begin_segment(0.5);
    for (t, method, previous) in [
        (0.6, Method::Newton, Some(0.0)),
        (0.8, Method::Relaxation, None),
        (0.9, Method::Newton, Some(0.8)),
    ] {
        let step = path.advance(t, &mut ()).unwrap();
        let before = path.continuation_state().previous.map(|point| point.t);
        assert_eq!((step.method, before), (method, previous));
    }
}

#[test]
fn a_step_is_doubled_as_long_as_the_energy_decreases_and_no_further() {
    // Minima at 0.03 and 1; at 0.02 and 0.04 the energy is the same.
    let well = toy(|_, [u]: [f64; 1]| ((u - 0.03).powi(2), [2.0 * (u - 0.03)], [[2.0]]));
    let slope = toy(|_, [u]: [f64; 1]| (-u, [-1.0], [[0.0]]));
    let ends = |problem: &Toy<1>, first: f64| {
        let at = |u: f64| Iterate::new(problem, &0.0, vec![u]).unwrap();
        at(0.0).expand(vec![first], at(first)).u[0]
    };
    assert_eq!(ends(&well, 0.01), 0.02);
    assert_eq!(ends(&well, 0.005), 0.02);
    assert_eq!(ends(&well, 0.03), 0.03);
    // Up to a tenth of the diameter.
    assert_eq!(ends(&slope, 0.0125), 0.1);
    assert_eq!(ends(&slope, 0.06), 0.06);
}
