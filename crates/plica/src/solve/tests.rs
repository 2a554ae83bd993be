//! The solver on energies of one or two unknowns, whose equilibria are known.

use super::{
    Direct, Equilibrium, Failure, Method, Monitor, NegativeCurvature, Operator, Path, PseudoTime,
    ResidualEvaluation, Scheme, Settings, Solved, Solver, State, Tangent, conjugate_gradients,
    newton, relaxation,
};
use crate::matrix::{BlockBanded, Singular};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// An energy with its slopes and curvatures.
type Jet<const N: usize> = (f64, [f64; N], [[f64; N]; N]);

/// An energy W(load, u) of N unknowns, all free, that may end at a wall.
struct Toy<const N: usize> {
    jet: fn(f64, [f64; N]) -> Jet<N>,
    /// Where the first unknown may not go.
    wall: f64,
    damping: Arc<BlockBanded>,
}

/// The first unknown is past the wall.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("past the wall")]
struct PastTheWall;

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

fn matrix<const N: usize>(entries: [[f64; N]; N]) -> BlockBanded {
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
    type EvaluationError = PastTheWall;
    type Tangent = Direct;

    fn prescribed(&self) -> &[bool] {
        &[false; 2][..N]
    }
    fn apply_prescribed(&self, _: &f64, _: &mut [f64]) {}
    fn between(&self, from: &f64, to: &f64, t: f64) -> f64 {
        from + t * (to - from)
    }
    fn forces(&self, load: &f64, u: &[f64]) -> Result<ResidualEvaluation, PastTheWall> {
        if u[0] >= self.wall {
            return Err(PastTheWall);
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

/// A shallow truss: wells at u = −1 and 1, and a load that pushes from the one to the other. The
/// near one ends at u = −1/√3 under a load of 2/(3√3) = 0.385.
fn truss() -> Toy<1> {
    toy(|load, [u]| {
        let well = u * u - 1.0;
        let energy = 0.25 * well * well - load * u;
        (energy, [u * well - load], [[3.0 * u * u - 1.0]])
    })
}

/// A strut: x follows the load, and beyond x = 1 the straight y = 0 is a saddle. The bent branch
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

fn begin_segment<P>(problem: &P, from: f64, u: impl Into<Vec<f64>>, to: f64) -> Path<&P>
where
    P: Equilibrium<Load = f64, EvaluationError = PastTheWall>,
{
    let settings = Settings {
        scheme: Scheme::Static,
        ..Settings::default()
    };
    let mut path = Path::begin(problem, from, u.into(), settings).unwrap();
    path.begin_segment(to);
    path
}

/// States of tolerance 1e-8 and stiffness about one are as exact as that.
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
fn a_truss_is_followed_by_newton_and_snaps_to_the_far_well() {
    let truss = truss();
    let mut path = begin_segment(&truss, 0.0, [-1.0], 0.5);
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
fn a_state_that_symmetry_keeps_on_a_saddle_is_never_called_stable() {
    let strut = strut();
    let mut path = begin_segment(&strut, 1.5, [1.5, 0.0], 2.0);
    assert_eq!(path.state().negative_pivots, 1);
    path.advance(1.0, &mut ()).unwrap();
    let state = path.state();
    assert_at(state, [2.0, 0.0]);
    assert!(state.in_equilibrium());
    assert_eq!((state.u[1], state.negative_pivots), (0.0, 1));

    // The least push off it leads to the bent branch.
    let pushed = vec![2.0, 1e-3];
    let found = relaxation(&strut, &2.0, pushed, &Settings::default(), &mut ()).unwrap();
    let mut path = begin_segment(&strut, 2.0, found.u, 2.1);
    assert_at(path.state(), [3.0, 2.0_f64.sqrt()]);
    assert_eq!(path.state().negative_pivots, 0);
    let step = path.advance(1.0, &mut ()).unwrap();
    assert_eq!(step.method, Method::Newton);
    assert_at(path.state(), [3.2, 2.2_f64.sqrt()]);
}

#[test]
fn newton_refuses_an_indefinite_tangent() {
    let found = newton(
        &strut(),
        &1.5,
        vec![1.5, 0.1],
        &Settings::default(),
        &mut (),
    );
    let failure = found.unwrap_err();
    assert_eq!(failure, Failure::Indefinite { negative_pivots: 1 });
}

#[test]
fn steps_that_lead_past_a_wall_are_shortened() {
    let spring = stiffening_spring();
    let mut path = begin_segment(&spring, 0.0, [0.0], 3.0);
    // The tangent alone leads to u = 3.
    let step = path.advance(1.0, &mut ()).unwrap();
    assert_eq!(step.method, Method::Newton);
    assert_at(path.state(), [0.75]);
}

#[test]
fn a_path_that_ends_at_a_wall_says_so_and_stays_before_it() {
    let spring = spring_before_a_wall();
    let mut path = begin_segment(&spring, 0.0, [0.0], 2.0);
    path.advance(0.4, &mut ()).unwrap();
    let error = path.advance(0.9, &mut ()).unwrap_err();
    let broken = (Method::Newton, Failure::Evaluation(PastTheWall));
    assert!(error.tried.contains(&broken), "{error}");
    assert!(error.to_string().contains("past the wall"), "{error}");
    assert!(!error.stopped());
    // As near to load 1 as steps that are halved eight times get.
    let (state, shortest) = (path.state(), 0.5 / 256.0);
    assert!(path.reached() < 0.5 && path.reached() + shortest >= 0.5);
    assert_eq!(state.load, 2.0 * path.reached());
    assert!(state.in_equilibrium());
    assert_at(state, [state.load]);
}

/// Someone who has seen enough.
struct Stops;

impl Monitor for Stops {
    fn solved(&mut self, _: Method, _: f64) -> bool {
        false
    }
}

#[test]
fn a_path_that_is_stopped_stays_where_it_was() {
    let truss = truss();
    let mut path = begin_segment(&truss, 0.0, [-1.0], 0.5);
    path.advance(0.2, &mut ()).unwrap();
    let before = path.state().clone();
    // Before the snap and past it.
    for t in [0.4, 1.0] {
        let error = path.advance(t, &mut Stops).unwrap_err();
        assert!(error.stopped(), "{error}");
        assert_eq!(path.reached(), 0.2);
        assert_eq!(path.state().load, before.load);
        assert_eq!(path.state().u, before.u);
    }
    path.advance(0.4, &mut ()).unwrap();
}

#[test]
fn on_a_smooth_branch_no_step_costs_more_than_the_first() {
    let truss = truss();
    let mut path = begin_segment(&truss, 0.0, [1.0], 4.0);
    let costs: Vec<usize> = (1..=10)
        .map(|i| path.advance(f64::from(i) / 10.0, &mut ()).unwrap())
        .map(|step| step.iterations)
        .collect();
    assert!(costs.iter().all(|&cost| cost <= costs[0]), "{costs:?}");
    // The cubic through two states comes closer and closer.
    assert!(costs[9] < costs[0], "{costs:?}");
}

/// The same energies with tangents that are solved with by conjugate gradients.
struct Iterated<const N: usize> {
    toy: Toy<N>,
    /// Iterations after which a solve is cut off.
    at_most: usize,
    /// How often one was.
    cut_off: Arc<AtomicUsize>,
}

fn iterated<const N: usize>(toy: Toy<N>) -> Iterated<N> {
    Iterated {
        toy,
        at_most: 100,
        cut_off: Arc::default(),
    }
}

struct IteratedTangent {
    stiffness: Direct,
    damping: Arc<BlockBanded>,
    prescribed: Vec<bool>,
    alpha: f64,
    at_most: usize,
    cut_off: Arc<AtomicUsize>,
}

impl<const N: usize> Equilibrium for Iterated<N> {
    type Load = f64;
    type EvaluationError = PastTheWall;
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
    fn forces(&self, load: &f64, u: &[f64]) -> Result<ResidualEvaluation, PastTheWall> {
        self.toy.forces(load, u)
    }
    fn tangent(&self, load: &f64, u: &[f64]) -> IteratedTangent {
        IteratedTangent {
            stiffness: self.toy.tangent(load, u),
            damping: self.toy.damping.clone(),
            prescribed: self.prescribed().to_vec(),
            alpha: 0.0,
            at_most: self.at_most,
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
            at_most: self.at_most,
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
        monitor: &mut dyn Monitor,
    ) -> Result<Solved, NegativeCurvature> {
        let solved = conjugate_gradients(self, b, accuracy, self.at_most, monitor)?;
        self.cut_off
            .fetch_add(usize::from(!solved.reached), Ordering::Relaxed);
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
fn a_path_by_iteration_leads_through_the_same_states() {
    let (direct, other) = (truss(), iterated(truss()));
    let mut one = begin_segment(&direct, 0.0, [-1.0], 0.5);
    let mut other = begin_segment(&other, 0.0, [-1.0], 0.5);
    for t in [0.2, 0.4, 0.6, 0.8, 1.0] {
        let exact = one.advance(t, &mut ()).unwrap();
        let step = other.advance(t, &mut ()).unwrap();
        assert_eq!(step.method, exact.method);
        // One for each linear solve at least, whether it led anywhere or not.
        assert_eq!(exact.inner_iterations, 0);
        assert!(step.inner_iterations >= step.iterations, "{step:?}");
        assert_at(other.state(), [one.state().u[0]]);
    }
}

/// Someone who has seen enough after the first iteration inside a linear solve.
#[derive(Default)]
struct StopsWithin {
    asked: usize,
}

impl Monitor for StopsWithin {
    fn solved(&mut self, _: Method, _: f64) -> bool {
        self.asked == 0
    }
    fn iterating(&mut self) -> bool {
        self.asked += 1;
        false
    }
}

#[test]
fn whoever_cuts_off_a_linear_solve_stops_what_asked_for_it() {
    let strut = iterated(strut());
    let settings = Settings::default();
    let (load, off) = (2.5, vec![3.5, 1.0]);
    let found = newton(
        &strut,
        &load,
        off.clone(),
        &settings,
        &mut StopsWithin::default(),
    );
    assert_eq!(found.unwrap_err(), Failure::Stopped);
    let found = relaxation(&strut, &load, off, &settings, &mut StopsWithin::default());
    assert_eq!(found.unwrap_err(), Failure::Stopped);
    for scheme in [Scheme::Static, Scheme::PseudoTime(PseudoTime::default())] {
        let settings = Settings {
            scheme,
            ..Settings::default()
        };
        let mut path = Path::begin(&strut, 2.5, vec![4.0, 3.0_f64.sqrt()], settings).unwrap();
        path.begin_segment(3.0);
        // du/dt is cut off at first, then a step.
        let mut monitor = StopsWithin::default();
        let error = path.advance(1.0, &mut monitor).unwrap_err();
        assert!(error.stopped(), "{error}");
        assert!(monitor.asked <= 2);
        assert_eq!((path.reached(), path.state().load), (0.0, 2.5));
        path.advance(1.0, &mut ()).unwrap();
        assert_at(path.state(), [5.0, 2.0]);
    }
}

/// Springs of stiffness 1 and 30, pulled alike: one iteration does not solve their systems, and they
/// are given no more.
fn cut_off_springs() -> Iterated<2> {
    let springs = toy(|load, [x, y]| {
        let (a, b) = (x - load, y - load / 30.0);
        let energy = 0.5 * (a * a + 30.0 * b * b);
        (energy, [a, 30.0 * b], [[1.0, 0.0], [0.0, 30.0]])
    });
    Iterated {
        at_most: 1,
        ..iterated(springs)
    }
}

#[test]
fn relaxation_remembers_the_drag_that_a_solver_needs() {
    let springs = cut_off_springs();
    let settings = Settings {
        tolerance: 1e-3,
        ..Settings::default()
    };
    let found = relaxation(&springs, &0.5, vec![0.0; 2], &settings, &mut ()).unwrap();
    let cut_off = springs.cut_off.load(Ordering::Relaxed);
    println!("{} of {} solves", cut_off, found.iterations);
    // Drag that shrinks back as fast as it may is cut off in every third or fourth.
    assert!(5 * cut_off < found.iterations, "{cut_off}");
}

#[test]
fn newton_gives_up_where_linear_systems_are_cut_off_and_relaxation_goes_on() {
    let springs = cut_off_springs();
    let settings = Settings::default();
    let failed = newton(&springs, &0.5, vec![0.0; 2], &settings, &mut ()).unwrap_err();
    assert!(
        matches!(failed, Failure::Unsolved { iterations: 2, .. }),
        "{failed}"
    );
    // The path does not halve its step for that; a drag makes the systems easier, step by step.
    let settings = Settings {
        tolerance: 1e-2,
        ..settings
    };
    let mut path = Path::begin(&springs, 0.0, vec![0.0; 2], settings).unwrap();
    path.begin_segment(0.5);
    let step = path.advance(1.0, &mut ()).unwrap();
    assert_eq!(step.method, Method::Relaxation);
    assert_eq!(path.reached(), 1.0);
}

#[test]
fn negative_curvature_refuses_newton() {
    let (load, u) = (1.5, vec![1.5, 0.1]);
    let found = newton(&iterated(strut()), &load, u, &Settings::default(), &mut ());
    let failure = found.unwrap_err();
    assert_eq!(failure, Failure::Indefinite { negative_pivots: 1 });
}

#[test]
fn a_saddle_is_left_along_the_motion_off_it_in_a_few_solves() {
    let leave = |push: f64| {
        let start = vec![2.5, push];
        relaxation(
            &iterated(strut()),
            &2.5,
            start,
            &Settings::default(),
            &mut (),
        )
        .unwrap()
    };
    let mut iterations = vec![];
    for push in [1e-2, 1e-4, -1e-6] {
        let found = leave(push);
        let [x, y] = [4.0, 3.0_f64.sqrt() * push.signum()];
        assert!((found.u[0] - x).abs() < 1e-7 && (found.u[1] - y).abs() < 1e-7);
        iterations.push(found.iterations);
    }
    // However near the saddle it was.
    assert!(iterations[2] <= iterations[0] + 2, "{iterations:?}");
    // Exactly on it, nothing leads off.
    let found = leave(0.0);
    assert_eq!(found.u, [2.5, 0.0]);
}
