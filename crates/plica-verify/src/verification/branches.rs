//! Branches of equilibria: folds and branch points with closed forms, and a tube past its pressure maximum.

use super::VerificationError;
use super::chains::{Chain, bratu, column, truss};
use super::layers::model;
use super::report::Recorder;
use super::tube_model::tight_settings;
use super::volume::wall;
use plica::solve::Path;
use plica::solve::arc::{
    Accuracy, ArcSettings, Branch, BranchEnd, Curve, Family, Fold, LoadFamily, Point, Reduced,
};
use std::f64::consts::PI;

/// Largest number of points of a branch.
const POINTS: usize = 400;

fn family(chain: &Chain) -> LoadFamily<&Chain> {
    LoadFamily {
        problem: chain,
        loads: [0.0, 1.0],
        range: [0.0, 1.0],
    }
}

/// Follows a branch to its end, or to a point that fulfils a condition.
fn follow<F: Family>(
    curve: &Curve<'_, F>,
    from: Point,
    range: [f64; 2],
    condition: impl Fn(&Point) -> bool,
) -> Result<Vec<Point>, VerificationError> {
    let mut points = vec![from.clone()];
    let mut branch = Branch::begin(curve, from, range);
    while points.len() < POINTS && !points.last().is_some_and(&condition) {
        match branch.advance(&mut ()) {
            Ok(point) => points.push(point.clone()),
            Err(BranchEnd::Range) => break,
            Err(BranchEnd::Lost(failure)) => {
                return Err(VerificationError::Solve(failure.to_string()));
            }
        }
    }
    Ok(points)
}

fn failed(error: impl std::fmt::Display) -> VerificationError {
    VerificationError::Solve(error.to_string())
}

/// Returns the first fold of a branch.
fn first_fold<F: Family>(
    curve: &Curve<'_, F>,
    points: &[Point],
) -> Result<Fold, VerificationError> {
    let turns = |pair: &&[Point]| pair[0].tangent.1 * pair[1].tangent.1 < 0.0;
    let pair = points
        .windows(2)
        .find(turns)
        .ok_or_else(|| failed("no fold"))?;
    let near = curve
        .between([&pair[0], &pair[1]], 0.5, &mut ())
        .map_err(failed)?;
    let mode = curve
        .critical(&near, Some(&near.tangent.0))
        .map_err(failed)?;
    let reduced = Reduced::new(curve, &near, &mode.vector);
    reduced.fold(&near, &mut ()).map_err(failed)
}

/// Records folds and branches of structures.
pub fn structures(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let first_angle = 0.4_f64;
    recorder.case("truss of two bars at 0.4 radians, followed through both folds")?;
    let chain = truss(first_angle);
    let family_of = family(&chain);
    let settings = ArcSettings::for_range([0.0, 0.2]);
    let start = vec![first_angle; 2];
    let (curve, first) = Curve::begin(&family_of, settings, 0.0, start, &mut ()).map_err(failed)?;
    let points = follow(&curve, first, [-0.2, 0.2], |_| false)?;
    let force = |a: f64| 2.0 * (a.sin() - first_angle.cos() * a.tan());
    let error = points
        .iter()
        .map(|point| (point.parameter - force(point.u[0])).abs());
    recorder.zero(
        1e-7,
        "largest error of P along the branch",
        error.fold(0.0, f64::max),
        "closed form",
    );
    let critical = first_angle.cos().cbrt().acos();
    let fold = first_fold(&curve, &points)?;
    recorder.relative(
        1e-9,
        "P at the fold",
        fold.parameter,
        (force(critical), "closed form"),
    );

    recorder.case("Bratu's problem by linear elements")?;
    let mut found = vec![];
    for elements in [32, 64, 128] {
        let chain = bratu(elements);
        let family = family(&chain);
        let settings = ArcSettings::for_range([0.0, 4.0]);
        let start = vec![0.0; elements + 1];
        let begun = Curve::begin(&family, settings, 0.0, start, &mut ());
        let (curve, first) = begun.map_err(failed)?;
        let points = follow(&curve, first, [0.0, 4.0], |point| point.negative > 0)?;
        let fold = first_fold(&curve, &points)?;
        found.push([fold.parameter, fold.u[elements / 2]]);
    }
    // Errors are even powers of the size of elements (Richardson).
    let extrapolated = |i: usize| {
        let finer = |n: usize| found[n + 1][i] + (found[n + 1][i] - found[n][i]) / 3.0;
        finer(1) + (finer(1) - finer(0)) / 15.0
    };
    recorder.relative(
        1e-7,
        "λ at the fold, extrapolated",
        extrapolated(0),
        (3.513_830_719_1, "closed form"),
    );
    recorder.relative(
        1e-6,
        "u at the middle, extrapolated",
        extrapolated(1),
        (1.186_842_2, "closed form"),
    );

    recorder.case("column of 96 elements")?;
    let links = 96;
    let chain = column(links);
    let family = family(&chain);
    let settings = ArcSettings::for_range([2.0, 4.0]);
    let begun = Curve::begin(&family, settings, 2.0, vec![0.0; links + 1], &mut ());
    let (curve, first) = begun.map_err(failed)?;
    let points = follow(&curve, first, [2.0, 4.0], |point| point.negative > 0)?;
    let near = points.last().ok_or_else(|| failed("no point"))?;
    let mode = curve.critical(near, None).map_err(failed)?.vector;
    let reduced = Reduced::new(&curve, near, &mode);
    let point = reduced.branch_point(near, &mut ()).map_err(failed)?;
    let critical = (2.0 * links as f64 * (0.25 * PI / links as f64).sin()).powi(2);
    recorder.relative(
        1e-9,
        "P at the branch point",
        point.parameter,
        (critical, "closed form of the elements"),
    );
    let curvature = point.form.curvature() / critical;
    recorder.relative(
        2e-3,
        "curvature of P/P_cr in the angle of the head",
        curvature,
        (0.125, "elastica"),
    );
    let [side, _] = reduced.switch(&point, 0.05, &mut ()).map_err(failed)?;
    let points = follow(&curve, side, [2.0, 3.5], |_| false)?;
    for (degrees, ratio) in [
        (20.0, 1.0154),
        (40.0, 1.0637),
        (60.0, 1.1517),
        (80.0, 1.2939),
    ] {
        let angle = |point: &Point| point.u[links].abs().to_degrees() - degrees;
        let pair = points
            .windows(2)
            .find(|pair| angle(&pair[0]) * angle(&pair[1]) <= 0.0);
        let pair = pair.ok_or_else(|| failed("the angle was not reached"))?;
        let ends = [angle(&pair[0]), angle(&pair[1])];
        let located = curve.locate::<VerificationError>(
            [&pair[0], &pair[1]],
            ends,
            Accuracy {
                width: 1e-8,
                zero: 1e-10,
            },
            |point| Ok(angle(point)),
            &mut (),
        )?;
        let computed = located[1].0.parameter / critical;
        let name = format!("P/P_cr where the head has turned by {degrees}°");
        recorder.relative(2e-4, name, computed, (ratio, "elastica"));
    }
    Ok(())
}

/// Records the pressure maximum of a ring, followed in the pressure, and its states beyond.
pub fn balloon(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    recorder.case("active ring, followed in the pressure past its maximum")?;
    let wall = wall();
    let model = model(&wall, &[8]);
    let problem = model.problem(1);
    let rest = model.tube.rest();
    let zero = vec![0.0; problem.tube.unknowns()];
    // The active tension narrows the tube without load.
    let mut path = Path::begin(problem.clone(), rest.clone(), zero, tight_settings())?;
    path.begin_segment(rest.clone());
    path.advance(1.0, &mut ())?;
    let mut pressed = rest.clone();
    pressed.pressures[0].follower = 0.1;
    let family = LoadFamily {
        problem: problem.clone(),
        loads: [rest, pressed],
        range: [0.0, 0.1],
    };
    let inner = problem.tube.tube.inner_radius();
    let radius = |point: &Point| {
        let ratio = problem.tube.lumen_volume(&point.u) / problem.tube.lumen_volume_at_rest();
        inner * ratio.sqrt()
    };
    let settings = ArcSettings::for_range([0.0, 0.1]);
    let start = path.state().u.clone();
    let (curve, first) = Curve::begin(&family, settings, 0.0, start, &mut ()).map_err(failed)?;
    let points = follow(&curve, first, [0.0, 0.1], |point| {
        radius(point) > 1.8 * inner
    })?;
    let mut worst = 0.0_f64;
    for point in &points {
        let expected = wall.pressure_at(radius(point))?;
        worst = worst.max((point.parameter - expected).abs());
    }
    recorder.zero(
        1e-8,
        "largest error of p along the branch, in E",
        worst,
        "one-dimensional solution",
    );
    let fold = first_fold(&curve, &points)?;
    // The maximum of the one-dimensional solution, by the golden section.
    let (mut low, mut high) = (1.1 * inner, 1.8 * inner);
    let share = 0.5 * (5.0_f64.sqrt() - 1.0);
    while high - low > 1e-7 {
        let [a, b] = [high - share * (high - low), low + share * (high - low)];
        if wall.pressure_at(a)? > wall.pressure_at(b)? {
            high = b;
        } else {
            low = a;
        }
    }
    let maximum = wall.pressure_at(0.5 * (low + high))?;
    recorder.relative(
        1e-7,
        "p at the fold",
        fold.parameter,
        (maximum, "one-dimensional solution"),
    );
    let last = points
        .last()
        .map_or(f64::NAN, |point| point.negative as f64);
    let expected = (1.0, "one beyond the maximum");
    recorder.row(
        "negative eigenvalues behind the fold",
        last,
        expected,
        super::row::Tolerance::Absolute(0.0),
    );
    Ok(())
}
