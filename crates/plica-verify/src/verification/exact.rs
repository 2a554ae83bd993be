//! What must be so to rounding: stress-free growth, rigid motions, a tube that is turned.

use super::found::{Findings, Trouble};
use super::specimen::{Specimen, energy, under};
use plica::activation::Direction;
use plica::assembly::Point;
use plica::assembly::SplineTube;
use plica::matrix::BlockBanded;
use plica::spline::{Basis, gauss_legendre};
use plica::tube::{Axial, Imperfection, Load, Part, Shape, Support, Wave};

/// Relative error of what only rounding disturbs.
const ROUNDING: f64 = 1e-12;

/// A tube with free ends that relaxes evenly grows, and stays free of stress; W of one that is held is the
/// measure of what is left of it.
pub fn free_growth(found: &mut Findings<'_>) -> Result<(), Trouble> {
    for (rings, name) in [(1, "axisymmetric"), (12, "no symmetry")] {
        let mut specimen = Specimen::new(1.0, 0.06, 0.495, [8, 12, 2]);
        specimen.tube.ends = [Support::Fixed, Support::Free];
        // Fixed at a face, growth around would be hindered; along it is not.
        let specimen = specimen.with_even_muscle(Direction::Longitudinal);
        let problem = specimen.problem(rings);
        let theta = 1.3;
        let load = Load {
            muscles: vec![theta],
            ..specimen.tube.rest()
        };
        let state = under(&problem, &load, 3)?;
        found.case(format!("tube with a free end, θζ = {theta}, {name}"))?;
        found.nothing(1e-14, "W", energy(&problem, &state), "pure growth");
        let at = Point {
            z: 1.0,
            radius: 0.5,
            angle: 0.1,
        };
        let end = problem.tube.sample(&state.load, &state.u, at).position[0];
        found.within(ROUNDING, "length", end, (theta, "pure growth"));
    }
    Ok(())
}

/// An active tube that is shifted and turned as a whole stores what it stored.
pub fn objectivity(found: &mut Findings<'_>) -> Result<(), Trouble> {
    let specimen = Specimen::new(1.0, 0.1, 0.495, [8, 12, 2]).with_even_muscle(Direction::Circular);
    let tube = specimen.problem(12).tube;
    let load = Load {
        muscles: vec![0.8],
        ..specimen.tube.rest()
    };
    // Waves of no symmetry, then the whole turned about an axis across it and shifted.
    let wavy = |z: f64, r: f64, phi: f64| {
        [
            0.03 * (2.0 * z + phi).sin(),
            0.04 * (3.0 * z + 2.0 * phi).cos() * r,
            0.03 * (z - phi).sin(),
        ]
    };
    let (sin, cos) = 0.9_f64.sin_cos();
    let turned = |[z, x, y]: [f64; 3]| [cos * z - sin * x + 0.3, sin * z + cos * x - 0.2, y + 0.1];
    let control = tube.circle.control_radius;
    let displaced = |whole: bool| {
        tube.control_values_from(|z, r, ring| {
            let phi = tube.sector.ring_angle(ring);
            let (s, c) = phi.sin_cos();
            let [along, outwards, around] = wavy(z, r, phi);
            if !whole {
                return [along, outwards, around];
            }
            let r = r * control;
            let (x, y) = (r + outwards, around);
            let at = turned([z + along, c * x - s * y, s * x + c * y]);
            // Back to the ring's directions, from where its point was.
            [at[0] - z, c * at[1] + s * at[2] - r, -s * at[1] + c * at[2]]
        })
    };
    let (still, moved) = (displaced(false), displaced(true));
    let [before, after] = [&still, &moved].map(|u| tube.forces(&load, u));
    let (before, after) = (before?, after?);
    let size = |residual: &[f64]| residual.iter().map(|r| r * r).sum::<f64>().sqrt();
    let same = "before it was turned";
    found.case("active tube, shifted and turned as a whole")?;
    found.within(ROUNDING, "W", after.energy, (before.energy, same));
    found.within(
        ROUNDING,
        "size of R",
        size(&after.residual),
        (size(&before.residual), same),
    );
    Ok(())
}

/// A muscle that is uneven around, turned by a ring: the same tube, seen from elsewhere.
pub fn frame(found: &mut Findings<'_>) -> Result<(), Trouble> {
    let mut specimen =
        Specimen::new(1.0, 0.1, 0.495, [8, 12, 2]).with_even_muscle(Direction::Circular);
    specimen.tube.ends = [Support::Fixed; 2];
    let load = Load {
        muscles: vec![0.8],
        ..specimen.tube.rest()
    };
    let mut energies = vec![];
    for turned in [0.0, 1.0, 0.5] {
        let angle = 0.3 + turned * std::f64::consts::TAU / 12.0;
        specimen.tube.imperfections = vec![Imperfection {
            of: Part::Muscle(0),
            amplitude: 0.3,
            shape: Shape::Wave(Wave::new(1, angle, Axial::HalfWaves(1))),
        }];
        let problem = specimen.problem(12);
        energies.push(energy(&problem, &under(&problem, &load, 1)?));
    }
    found.case("tube with an uneven muscle, 12 rings")?;
    let before = (energies[0], "before it was turned");
    found.within(1e-10, "W, the muscle turned by a ring", energies[1], before);
    let before = (energies[0], "before it was turned");
    found.within(1e-6, "W, turned by half a ring", energies[2], before);
    Ok(())
}

/// The circle that splines draw, and how projections on splines converge.
pub fn splines(found: &mut Findings<'_>) -> Result<(), Trouble> {
    found.case("spline circle")?;
    let uneven = |around: usize| {
        let specimen = Specimen::new(1.0, 0.06, 0.495, [1, around, 1]);
        let problem = specimen.problem(1);
        let rest = vec![0.0; problem.tube.unknowns()];
        let radii = (0..=50).map(|i| {
            let angle = f64::from(i) / 50.0 * std::f64::consts::TAU / around as f64;
            let at = Point {
                z: 0.5,
                radius: 0.5,
                angle,
            };
            let [_, x, y] = problem
                .tube
                .sample(&specimen.tube.rest(), &rest, at)
                .position;
            x.hypot(y)
        });
        let (low, high) = radii.fold((f64::INFINITY, 0.0_f64), |(low, high), r| {
            (low.min(r), high.max(r))
        });
        (high - low) / 0.5
    };
    let error = uneven(60);
    let quantity = "crest to trough of 60 cubics, over the radius";
    found.row(
        quantity,
        error,
        (3.1e-7, "a prototype, two digits"),
        super::Tolerance::Absolute(0.06e-7),
    );
    let order = (error / uneven(120)).log2();
    found.row(
        "order of it",
        order,
        (4.0, "p + 1"),
        super::Tolerance::Absolute(0.05),
    );
    found.case("projection of a wave on splines in the mean of squares")?;
    for degree in 1..=4 {
        let order = (projection(degree, 16)? / projection(degree, 32)?).log2();
        let quantity = format!("order of its error, p = {degree}");
        let expected = (degree as f64 + 1.0, "p + 1");
        found.row(quantity, order, expected, super::Tolerance::Absolute(0.1));
    }
    Ok(())
}

/// Error of the L2 projection of a wave on splines of so many elements, in L2.
fn projection(degree: usize, elements: usize) -> Result<f64, Trouble> {
    let breakpoints: Vec<f64> = (0..=elements).map(|e| e as f64 / elements as f64).collect();
    let basis = Basis::open(degree, &breakpoints);
    let wave = |x: f64| (5.0 * x + 0.3).sin();
    let mut mass = BlockBanded::zeros(basis.functions(), 1, degree);
    let mut control = vec![0.0; basis.functions()];
    let points: Vec<(f64, f64)> = breakpoints
        .windows(2)
        .flat_map(|ends| {
            let h = ends[1] - ends[0];
            let place = move |(x, w): (f64, f64)| (ends[0] + h * x, h * w);
            gauss_legendre(degree + 4).into_iter().map(place)
        })
        .collect();
    for &(x, weight) in &points {
        let at = basis.evaluate(x);
        for (a, n) in at.value.iter().enumerate() {
            control[at.element + a] += weight * n * wave(x);
            for (b, m) in at.value.iter().enumerate().skip(a) {
                mass.add_at(at.element + a, b - a, 0, 0, weight * n * m);
            }
        }
    }
    let factor = mass.factor().map_err(|e| Trouble::Solve(e.to_string()))?;
    factor.solve(&mut control);
    let squares = points.iter().map(|&(x, weight)| {
        let at = basis.evaluate(x);
        let values = at.value.iter().zip(&control[at.element..]);
        let value: f64 = values.map(|(n, c)| n * c).sum();
        weight * (value - wave(x)).powi(2)
    });
    Ok(squares.sum::<f64>().sqrt())
}

/// No energy, no force, and the volume of a tube at rest.
pub fn rest(found: &mut Findings<'_>) -> Result<(), Trouble> {
    let specimen = Specimen::new(3.0, 0.06, 0.495, [4, 60, 2]);
    let tube: &SplineTube = &specimen.problem(1).tube;
    let forces = tube.forces(&specimen.tube.rest(), &vec![0.0; tube.unknowns()])?;
    found.case("tube at rest")?;
    found.nothing(1e-16, "W", forces.energy, "no stress");
    let largest = forces
        .residual
        .iter()
        .fold(0.0_f64, |most, r| most.max(r.abs()));
    found.nothing(1e-15, "largest residual", largest, "no stress");
    // ∫ N N dV₀ on a displacement of one along the axis, twice.
    let along = tube.control_values_from(|_, _, _| [1.0, 0.0, 0.0]);
    let mut weighed = vec![0.0; along.len()];
    tube.damping().multiply_add(1.0, &along, &mut weighed);
    let volume: f64 = along.iter().zip(&weighed).map(|(u, m)| u * m).sum();
    let (a, b) = (specimen.tube.inner_radius(), 0.5);
    let exact = std::f64::consts::PI * (b * b - a * a) * specimen.tube.length;
    let volume = volume * tube.sector.repeats();
    found.within(1e-10, "volume", volume, (exact, "π (B² − A²) L"));
    Ok(())
}
