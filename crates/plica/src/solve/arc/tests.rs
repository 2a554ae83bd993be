//! Branches with closed forms.

use super::super::{Direct, Equilibrium, ResidualEvaluation};
use super::*;
use crate::matrix::BlockBanded;
use std::f64::consts::PI;
use std::sync::Arc;

/// Value, gradient and second derivatives of the energy of an element with two unknowns.
type Jet = (f64, [f64; 2], [[f64; 2]; 2]);

/// A chain of equal elements, each with the energy `element`(λ, u, element) of its two unknowns.
struct Chain {
    element: fn(f64, [f64; 2], usize) -> Jet,
    prescribed: Vec<bool>,
    damping: Arc<BlockBanded>,
}

#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("undefined")]
struct Never;

impl Chain {
    fn new(
        unknowns: usize,
        prescribed: &[usize],
        element: fn(f64, [f64; 2], usize) -> Jet,
    ) -> Self {
        let mut damping = BlockBanded::zeros(unknowns, 1, 1);
        for i in 0..unknowns {
            damping.add_at(i, 0, 0, 0, 1.0);
        }
        Self {
            element,
            prescribed: (0..unknowns).map(|i| prescribed.contains(&i)).collect(),
            damping: Arc::new(damping),
        }
    }
}

impl Equilibrium for Chain {
    type Load = f64;
    type EvaluationError = Never;
    type Tangent = Direct;

    fn prescribed(&self) -> &[bool] {
        &self.prescribed
    }
    fn apply_prescribed(&self, _: &f64, u: &mut [f64]) {
        for (u, prescribed) in u.iter_mut().zip(&self.prescribed) {
            if *prescribed {
                *u = 0.0;
            }
        }
    }
    fn between(&self, from: &f64, to: &f64, t: f64) -> f64 {
        from + t * (to - from)
    }
    fn forces(&self, load: &f64, u: &[f64]) -> Result<ResidualEvaluation, Never> {
        let mut energy = 0.0;
        let mut residual = vec![0.0; u.len()];
        for i in 0..u.len() - 1 {
            let (w, gradient, _) = (self.element)(*load, [u[i], u[i + 1]], i);
            energy += w;
            residual[i] += gradient[0];
            residual[i + 1] += gradient[1];
        }
        Ok(ResidualEvaluation {
            energy,
            residual,
            residual_scale: 1.0,
            rounding: 1e-15,
        })
    }
    fn tangent(&self, load: &f64, u: &[f64]) -> Direct {
        let mut K = BlockBanded::zeros(u.len(), 1, 1);
        for i in 0..u.len() - 1 {
            let (.., H) = (self.element)(*load, [u[i], u[i + 1]], i);
            K.add_at(i, 0, 0, 0, H[0][0]);
            K.add_at(i, 1, 0, 0, H[1][0]);
            K.add_at(i + 1, 0, 0, 0, H[1][1]);
        }
        Direct::new(K, self.damping.clone(), self.prescribed.as_slice().into())
    }
    fn damping(&self, factor: f64, v: &[f64], y: &mut [f64]) {
        self.damping.multiply_add(factor, v, y);
    }
}

fn family(chain: &Chain) -> LoadFamily<&Chain> {
    LoadFamily {
        problem: chain,
        loads: [0.0, 1.0],
        range: [0.0, 1.0],
    }
}

/// From there Newton's method finds the special point.
const ROUGH: Accuracy = Accuracy {
    width: 1e-3,
    zero: 1e-2,
};

/// Follows a branch to its end and returns its points.
fn follow<F: Family>(curve: &Curve<'_, F>, from: Point, range: [f64; 2]) -> Vec<Point> {
    follow_until(curve, from, range, |_| false)
}

/// Follows a branch to a point that fulfils a condition, or to its end.
fn follow_until<F: Family>(
    curve: &Curve<'_, F>,
    from: Point,
    range: [f64; 2],
    condition: impl Fn(&Point) -> bool,
) -> Vec<Point> {
    let mut points = vec![from.clone()];
    let mut branch = Branch::begin(curve, from, range);
    while points.len() < 500 && !points.last().is_some_and(&condition) {
        match branch.advance(&mut ()) {
            Ok(point) => points.push(point.clone()),
            Err(BranchEnd::Range) => break,
            Err(BranchEnd::Lost(failure)) => panic!("{failure}"),
        }
    }
    points
}

/// Locates the fold between the first two points whose tangents differ in the sign of dλ/ds.
fn first_fold<F: Family>(curve: &Curve<'_, F>, points: &[Point]) -> Fold {
    let turns = |pair: &&[Point]| pair[0].tangent.1 * pair[1].tangent.1 < 0.0;
    let pair = points.windows(2).find(turns).unwrap();
    assert_eq!(pair[0].negative.abs_diff(pair[1].negative), 1);
    let slopes = [pair[0].tangent.1, pair[1].tangent.1];
    let found = curve.locate::<super::curve::Failure<F>>(
        [&pair[0], &pair[1]],
        slopes,
        ROUGH,
        |point| Ok(point.tangent.1),
        &mut (),
    );
    let [(near, _), _] = found.unwrap();
    let mode = curve.critical(&near, None).unwrap().vector;
    let reduced = Reduced::new(curve, &near, &mode);
    reduced.fold(&near, &mut ()).unwrap()
}

/// A shallow truss of two bars under a force at its apex: the first unknown is the angle α of the bars; the second follows
/// it. With EA = 1 and half-span 1 the strain energy is (cos α₀/cos α − 1)² / cos α₀ and the height of the apex tan α.
const FIRST_ANGLE: f64 = 0.4;

fn truss() -> Chain {
    Chain::new(2, &[], |force, [a, b], _| {
        let c0 = FIRST_ANGLE.cos();
        // N = c₀/cos α − 1 and its derivatives.
        let (sin, cos) = a.sin_cos();
        let n = c0 / cos - 1.0;
        let n1 = c0 * sin / (cos * cos);
        let n2 = c0 * (1.0 + sin * sin) / cos.powi(3);
        let (t1, t2) = (1.0 / (cos * cos), 2.0 * sin / cos.powi(3));
        // The height falls by tan α₀ − tan α under the force.
        let w = n * n / c0 + force * a.tan();
        let d = 2.0 * n * n1 / c0 + force * t1;
        let dd = 2.0 * (n1 * n1 + n * n2) / c0 + force * t2;
        let s = b - a;
        let H = [[dd + 1.0, -1.0], [-1.0, 1.0]];
        (w + 0.5 * s * s, [d - s, s], H)
    })
}

#[test]
fn a_truss_is_followed_through_both_folds_to_the_closed_form() {
    let chain = truss();
    let family = family(&chain);
    let range = [-0.2, 0.2];
    let start = vec![FIRST_ANGLE; 2];
    let settings = ArcSettings::for_range([0.0, 0.2]);
    let (curve, first) = Curve::begin(&family, settings, 0.0, start, &mut ()).unwrap();
    let points = follow(&curve, first, range);
    // To the reflected truss and beyond, under a force that reverses between its folds.
    let last = points.last().unwrap();
    assert_eq!(last.parameter, 0.2);
    assert!(last.u[0] < -FIRST_ANGLE, "{}", last.u[0]);
    for point in &points {
        let a = point.u[0];
        // P = 2 EA (sin α₀ ...): equilibrium of the apex with the strain cos α₀/cos α − 1.
        let force = -2.0 * (FIRST_ANGLE.cos() / a.cos() - 1.0) * a.sin();
        assert!((point.parameter - force).abs() < 1e-7, "{a}: {force}");
        let unstable = a.cos().powi(3) > FIRST_ANGLE.cos();
        assert_eq!(point.negative, usize::from(unstable), "{a}");
    }
    let fold = first_fold(&curve, &points);
    let critical = FIRST_ANGLE.cos().cbrt().acos();
    assert!((fold.u[0] - critical).abs() < 1e-6, "{:?}", fold.u);
    let force = 2.0 * (critical.sin() - FIRST_ANGLE.cos() * critical.tan());
    assert!((fold.parameter - force).abs() < 1e-11, "{}", fold.parameter);
    assert!(fold.curvature < 0.0);
}

/// Bratu's problem u″ + λ eᵘ = 0 on the unit interval by linear elements with the trapezoidal rule.
fn bratu(elements: usize) -> Chain {
    let element: fn(f64, [f64; 2], usize) -> Jet = match elements {
        32 => |l, u, _| bratu_element(l, u, 1.0 / 32.0),
        64 => |l, u, _| bratu_element(l, u, 1.0 / 64.0),
        _ => |l, u, _| bratu_element(l, u, 1.0 / 128.0),
    };
    Chain::new(elements + 1, &[0, elements], element)
}

fn bratu_element(lambda: f64, [a, b]: [f64; 2], h: f64) -> Jet {
    let k = 1.0 / h;
    let [ea, eb] = [a, b].map(|u| 0.5 * h * lambda * u.exp());
    let s = b - a;
    (
        0.5 * k * s * s - ea - eb,
        [-k * s - ea, k * s - eb],
        [[k - ea, -k], [-k, k - eb]],
    )
}

#[test]
fn the_fold_of_bratu_is_the_known_one_by_extrapolation() {
    let mut found = vec![];
    for elements in [32, 64, 128] {
        let chain = bratu(elements);
        let family = family(&chain);
        let settings = ArcSettings::for_range([0.0, 4.0]);
        let start = vec![0.0; elements + 1];
        let (curve, first) = Curve::begin(&family, settings, 0.0, start, &mut ()).unwrap();
        let points = follow_until(&curve, first, [0.0, 4.0], |point| point.negative > 0);
        let fold = first_fold(&curve, &points);
        found.push([fold.parameter, fold.u[elements / 2]]);
    }
    for (i, exact) in [(0, 3.513_830_719_1), (1, 1.186_842_2)] {
        let value = |n: usize| found[n][i];
        let once = [0, 1].map(|n| value(n + 1) + (value(n + 1) - value(n)) / 3.0);
        let twice = once[1] + (once[1] - once[0]) / 15.0;
        assert!((twice - exact).abs() < 2e-7, "{i}: {twice}, not {exact}");
        // The finest mesh alone is not as good.
        assert!((value(2) - exact).abs() > 1e-5);
    }
}

/// A column of unit length and stiffness that is clamped at its foot, under a force on its head; the unknowns are angles.
const LINKS: usize = 96;

fn column() -> Chain {
    Chain::new(LINKS + 1, &[0], |force, [a, b], _| {
        let h = 1.0 / LINKS as f64;
        let (k, s) = (1.0 / h, b - a);
        let p = 0.5 * h * force;
        (
            0.5 * k * s * s + p * (a.cos() + b.cos()),
            [-k * s - p * a.sin(), k * s - p * b.sin()],
            [[k - p * a.cos(), -k], [-k, k - p * b.cos()]],
        )
    })
}

/// The complete elliptic integral K(k), by the arithmetic-geometric mean.
fn elliptic(k: f64) -> f64 {
    let (mut a, mut b) = (1.0, (1.0 - k * k).sqrt());
    for _ in 0..20 {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    0.5 * PI / a
}

#[test]
fn the_elastica_leaves_its_straight_branch_at_a_supercritical_pitchfork() {
    let chain = column();
    let family = family(&chain);
    let settings = ArcSettings::for_range([2.0, 4.0]);
    let straight = vec![0.0; LINKS + 1];
    let begun = Curve::begin(&family, settings, 2.0, straight, &mut ());
    let (curve, first) = begun.unwrap();
    let points = follow(&curve, first, [2.0, 4.0]);
    let pair = points.windows(2).find(|p| p[0].negative != p[1].negative);
    let [a, b] = pair.unwrap() else { panic!() };
    let mut lowest = |point: &Point| Ok(curve.critical(point, None)?.value);
    let ends = [lowest(a).unwrap(), lowest(b).unwrap()];
    let located = curve.locate::<ArcFailure<Never>>([a, b], ends, ROUGH, &mut lowest, &mut ());
    let [(near, _), _] = located.unwrap();
    let mode = curve.critical(&near, None).unwrap().vector;
    let reduced = Reduced::new(&curve, &near, &mode);
    let point = reduced.branch_point(&near, &mut ()).unwrap();
    // Of the links: 4/h² sin²(π h/4), which differs from π²/4 by π⁴h²/192 or so.
    let h = 1.0 / LINKS as f64;
    let critical = (2.0 / h * (PI * h / 4.0).sin()).powi(2);
    assert!(
        (point.parameter - critical).abs() < 1e-9,
        "{}",
        point.parameter
    );
    assert!((critical - PI * PI / 4.0).abs() < 1e-3);
    let form = point.form;
    assert!(form.is_pitchfork() && form.is_supercritical() && form.alpha < 0.0);
    // P/P_cr = 1 + α²/8 of the angle α of the head, which is the largest entry of the mode.
    let curvature = form.curvature() / critical;
    assert!((curvature - 0.125).abs() < 1e-3, "{curvature}");

    // The other branch, to a head that has turned by more than 80°.
    for start in reduced.switch(&point, 0.05, &mut ()).unwrap() {
        assert_eq!(start.negative, 0);
        assert!((start.u[LINKS].abs() - 0.05).abs() < 1e-4);
        assert!((start.parameter / critical - 1.0 - 0.125 * 0.0025).abs() < 1e-5);
        let points = follow(&curve, start, [2.0, 3.5]);
        assert!(points.last().unwrap().u[LINKS].abs() > 1.4);
        for point in &points {
            let head = point.u[LINKS].abs();
            let exact = (2.0 / PI * elliptic((0.5 * head).sin())).powi(2);
            let ratio = point.parameter / critical;
            assert!((ratio - exact).abs() < 2e-4, "{head}: {ratio}, not {exact}");
            assert_eq!(point.negative, 0);
        }
    }
}

/// An imperfect pitchfork: a ε (λ − 1) + β ε³ + τ = 0 with a = −1, β = ½; the second unknown is a spring of its own.
fn imperfect() -> Chain {
    Chain::new(2, &[], |l, [e, b], _| {
        let [a, beta, tau] = IMPERFECT;
        let m = l - 1.0;
        (
            0.5 * a * m * e * e + 0.25 * beta * e.powi(4) + tau * e + 0.5 * b * b,
            [a * m * e + beta * e.powi(3) + tau, b],
            [[a * m + 3.0 * beta * e * e, 0.0], [0.0, 1.0]],
        )
    })
}

const IMPERFECT: [f64; 3] = [-1.0, 0.5, 0.01];

#[test]
fn the_disconnected_branch_of_an_imperfect_pitchfork_ends_in_its_fold() {
    let chain = imperfect();
    let family = family(&chain);
    let [a, beta, tau] = IMPERFECT;
    let settings = ArcSettings::for_range([1.0, 2.0]);
    // A stable state of the branch that is not connected with small λ: ε > 0 against the force τ.
    let start = vec![1.4, 0.0];
    let (curve, first) = Curve::begin(&family, settings, 2.0, start, &mut ()).unwrap();
    assert_eq!(first.negative, 0);
    let points = follow(&curve, first.reversed(), [0.5, 2.0]);
    let last = points.last().unwrap();
    assert_eq!((last.parameter, last.negative), (2.0, 1));
    let fold = first_fold(&curve, &points);
    let law = 1.0 - 3.0 / a * (beta * tau * tau / 4.0_f64).cbrt();
    assert!((fold.parameter - law).abs() < 1e-10, "{}", fold.parameter);
    assert!(fold.curvature > 0.0);
}

/// A strut: x follows the load, and beyond x = 1 the straight state y = 0 is unstable; the bent branch is y² = 2 (λ − 1). With
/// `skew` ≠ 0 the bent branch crosses the straight one at an angle.
#[test]
fn coefficients_of_a_pitchfork_hold_what_the_rest_of_the_state_adds() {
    let chain = Chain::new(2, &[], |l, [x, y], _| {
        (
            0.5 * (x - l).powi(2) + 0.25 * y.powi(4) + 0.5 * (1.0 - x) * y * y,
            [x - l - 0.5 * y * y, y * y * y + (1.0 - x) * y],
            [[1.0, -y], [-y, 3.0 * y * y + 1.0 - x]],
        )
    });
    let (form, parameter, other) = branch_point_of(&chain);
    assert!((parameter - 1.0).abs() < 1e-9, "{parameter}");
    // −(λ − 1) y + ½ y³: the quartic alone would give 1, and x takes half of it.
    assert!(form.is_pitchfork() && form.is_supercritical());
    assert!((form.alpha + 1.0).abs() < 1e-6, "{form:?}");
    assert!((form.beta - 0.5).abs() < 1e-5, "{form:?}");
    for point in other {
        let [x, y] = point.u[..] else { panic!() };
        assert!((y * y - 2.0 * (point.parameter - 1.0)).abs() < 1e-8);
        assert!((x - (1.0 + y * y)).abs() < 1e-8);
        assert_eq!(point.negative, 0);
    }
}

#[test]
fn at_a_transcritical_point_the_other_branch_crosses_at_an_angle() {
    // y ((1 − x) + 3 y): the other branch is x = λ + …, y = (x − 1)/3.
    let chain = Chain::new(2, &[], |l, [x, y], _| {
        let m = 1.0 - x;
        (
            0.5 * (x - l).powi(2) + 0.5 * m * y * y + y.powi(3),
            [x - l - 0.5 * y * y, m * y + 3.0 * y * y],
            [[1.0, -y], [-y, m + 6.0 * y]],
        )
    });
    let (form, parameter, other) = branch_point_of(&chain);
    assert!((parameter - 1.0).abs() < 1e-9);
    assert!(!form.is_pitchfork() && (form.gamma - 3.0).abs() < 1e-5);
    let expected = [false, true];
    for (point, unstable) in other.iter().zip(expected) {
        let [x, y] = point.u[..] else { panic!() };
        assert!((y - (x - 1.0) / 3.0).abs() < 1e-8 && y.abs() > 0.04);
        // Stable beyond the crossing, where the first branch is not, and unstable before.
        assert_eq!(point.negative, usize::from(unstable), "{y}");
    }
}

/// Returns the normal form and the parameter of the branch point at λ = 1 on the branch y = 0, and points of the other one.
fn branch_point_of(chain: &Chain) -> (NormalForm, f64, [Point; 2]) {
    let family = family(chain);
    let settings = ArcSettings::for_range([0.0, 2.0]);
    let begun = Curve::begin(&family, settings, 0.3, vec![0.3, 0.0], &mut ());
    let (curve, first) = begun.unwrap();
    let points = follow(&curve, first, [0.0, 2.0]);
    let pair = points.windows(2).find(|p| p[0].negative != p[1].negative);
    let near = pair.unwrap()[0].clone();
    let mode = curve.critical(&near, None).unwrap().vector;
    let reduced = Reduced::new(&curve, &near, &mode);
    let found = reduced.branch_point(&near, &mut ()).unwrap();
    assert!(found.imperfection.abs() < 1e-10, "{}", found.imperfection);
    let other = reduced.switch(&found, 0.05, &mut ()).unwrap();
    (found.form, found.parameter, other)
}
