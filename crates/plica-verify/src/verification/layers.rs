//! Walls with layers, fibres and residual stretches, and the laws of the first invariant.

use super::VerificationError;
use super::layered_wall::{Family, Layer, LayeredWall, Shape};
use super::report::Recorder;
use super::tube_model::{TubeModel, radial_displacement, solve_from_rest};
use plica::assembly::Point;
use plica::equilibrium::TubeProblem;
use plica::material::{
    Composite, Demiray, Fibres, Fung, Gent, LengthTension, Material, Matrix, NeoHookean, Tone,
    Volumetric, Yeoh,
};
use plica::solve::State;
use plica::tube::{Load, MeshLayer, Opening, ResidualStretch, WallLayer};

/// Source of most references.
pub(super) const ONE: &str = "one-dimensional solution";

/// Returns a law of Plica with the constants of a layer of the reference solution.
fn material(layer: &Layer) -> Material {
    let bulk = layer.bulk;
    let matrix = match layer.shape {
        Shape::Linear(mu) => Matrix::NeoHookean(NeoHookean {
            mu,
            lambda: bulk,
            volumetric: Volumetric::Quadratic,
        }),
        Shape::Polynomial(c) => Matrix::Yeoh(Yeoh { c, bulk }),
        Shape::Exponential(shear_modulus, stiffening) => Matrix::Demiray(Demiray {
            shear_modulus,
            stiffening,
            bulk,
        }),
        Shape::Limited(shear_modulus, limit) => Matrix::Gent(Gent {
            shear_modulus,
            limit,
            bulk,
        }),
        Shape::Orthotropic([c, along, around, both]) => {
            let a = [[along, 0.0, both], [0.0; 3], [both, 0.0, around]];
            Matrix::Fung(Fung::new(c, a, bulk))
        }
    };
    let fibres = layer.fibres.iter();
    let fibres = fibres.map(|family| Fibres::new(family.k, family.dispersion, family.angle));
    Material::Composite(Composite {
        matrix,
        fibres: fibres.collect(),
        tones: layer
            .tone
            .map(|[tension, best, least]| {
                Tone::new(tension, LengthTension::Rachev { best, least }, 0.0)
            })
            .into_iter()
            .collect(),
    })
}

/// Returns a tube of Plica like one of the reference solution, with lengths over its outer diameter.
pub(super) fn model(wall: &LayeredWall, elements: &[usize]) -> TubeModel {
    let outer = wall.layers[wall.layers.len() - 1].outer;
    let thickness = outer - wall.inner;
    let mut model = TubeModel::ring(thickness / (2.0 * outer), 0.3, elements[0]);
    let mut inner = wall.inner;
    model.tube.layers.clear();
    for (layer, &elements) in wall.layers.iter().zip(elements) {
        let share = (layer.outer - inner) / thickness;
        inner = layer.outer;
        model.tube.layers.push(WallLayer {
            share,
            residual: ResidualStretch {
                along: layer.along,
                around: layer.around,
                opening: None,
            },
            ..WallLayer::of(material(layer))
        });
        model.layers.push(MeshLayer { share, elements });
    }
    if wall.layers.len() == 1 {
        model.layers.clear();
    }
    model
}

/// Solves for the state of a tube that is stretched, and then inflated.
pub(super) fn inflated(
    model: &TubeModel,
    wall: &LayeredWall,
    p: f64,
    steps: usize,
) -> Result<(TubeProblem, State<Load>), VerificationError> {
    let problem = model.problem(1);
    let mut load = model.under_pressure([p, 0.0]);
    load.ends[1].displacement = (wall.stretch - 1.0) * model.tube.length;
    let state = solve_from_rest(&problem, &load, steps)?;
    Ok((problem, state))
}

/// Records the current inner and outer radius, in the unit of the reference solution.
pub(super) fn radii(
    recorder: &mut Recorder<'_>,
    tolerance: f64,
    (problem, state): (&TubeProblem, &State<Load>),
    wall: &LayeredWall,
    (expected, source): ([f64; 2], &str),
) {
    let outer = wall.layers[wall.layers.len() - 1].outer;
    let at_rest = [problem.tube.tube.inner_radius(), 0.5];
    for ((name, R), r) in ["a", "b"].into_iter().zip(at_rest).zip(expected) {
        let radius = 2.0 * outer * (R + radial_displacement(problem, state, R));
        recorder.relative(tolerance, name, radius, (r, source));
    }
}

/// Records the inflation of rings of Yeoh's, Demiray's, Gent's and Fung's law.
pub fn laws(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    for (name, shape) in [
        ("Yeoh", Shape::Polynomial([0.2, 0.05, 0.02])),
        ("Demiray", Shape::Exponential(0.4, 0.8)),
        ("Gent", Shape::Limited(0.4, 3.0)),
        ("Fung", Shape::Orthotropic([0.4, 0.8, 1.2, 0.3])),
    ] {
        let layer = Layer {
            shape,
            ..Layer::new(0.5, 0.4, 20.0)
        };
        let wall = LayeredWall {
            inner: 0.44,
            layers: vec![layer],
            stretch: 1.2,
        };
        let p = 0.04;
        let expected = wall.inflate(p, 8)?;
        let (problem, state) = inflated(&model(&wall, &[8]), &wall, p, 8)?;
        recorder.case(format!("ring, {name}, ℓ = 1.2, internal pressure p = {p}"))?;
        let expected = [expected.radii[0], expected.radii[1]];
        radii(recorder, 1e-5, (&problem, &state), &wall, (expected, ONE));
    }
    Ok(())
}

/// Returns media and adventitia of a carotid artery (Holzapfel, Gasser and Ogden 2000), in mm and kPa.
pub(super) fn artery_of([inner, middle, outer]: [f64; 3]) -> LayeredWall {
    let media = Layer::new(middle, 3.0, 1000.0);
    let adventitia = Layer::new(outer, 0.3, 1000.0);
    LayeredWall {
        inner,
        layers: vec![
            media.with_pair([2.3632, 0.8393], 0.0, 29.0_f64.to_radians()),
            adventitia.with_pair([0.5620, 0.7112], 0.0, 62.0_f64.to_radians()),
        ],
        stretch: 1.7,
    }
}

/// Records the radii of a carotid artery, with and without residual stress, and its stresses.
pub fn artery(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let source = "an independent integration";
    let wall = artery_of([0.71, 0.97, 1.10]);
    let mut opened = artery_of([1.43, 1.69, 1.82]);
    for layer in &mut opened.layers {
        layer.around = [5.0 / 9.0; 2];
    }
    let mut active = artery_of([0.71, 0.97, 1.10]);
    active.layers[0].tone = Some([50.0, 1.4, 0.8]);
    let one = active.inflate(13.33, 8)?;
    let (problem, state) = inflated(&model(&active, &[6, 4]), &active, 13.33, 16)?;
    recorder.case(
        "carotid artery, active media (T = 50 kPa, λM = 1.4, λ0 = 0.8), ℓ = 1.7, p = 13.33 kPa",
    )?;
    let expected = ([one.radii[0], one.radii[2]], ONE);
    radii(recorder, 1e-7, (&problem, &state), &active, expected);
    for (wall, p, expected, name) in [
        (&wall, 5.0, [1.06225501, 1.24248370], "no residual stress"),
        (&wall, 13.33, [1.18939766, 1.35261592], "no residual stress"),
        (
            &opened,
            13.33,
            [1.27455486, 1.42755714],
            "opening angle 160°",
        ),
    ] {
        let model = model(wall, &[6, 4]);
        let (problem, state) = inflated(&model, wall, p, 16)?;
        let ring = (&problem, &state);
        recorder.case(format!("carotid artery, {name}, ℓ = 1.7, p = {p} kPa"))?;
        radii(recorder, 1e-7, ring, wall, (expected, source));
        let one = wall.inflate(p, 8)?;
        radii(
            recorder,
            1e-7,
            ring,
            wall,
            ([one.radii[0], one.radii[2]], ONE),
        );
        for (layer, stresses) in one.stresses.iter().enumerate() {
            let radius = problem.tube.tube.faces()[layer] + 1e-12;
            let at = Point {
                z: 0.3 * model.tube.length,
                radius,
                angle: 0.0,
            };
            let sample = problem.tube.sample(&state.load, &state.u, at);
            let name = ["media", "adventitia"][layer];
            for (direction, column, expected) in [("θ", 2, stresses[1]), ("z", 0, stresses[2])] {
                let stress = sample.stress.0[column][column];
                let quantity = format!("σ{direction}, inner face of the {name}");
                recorder.relative(1e-3, quantity, stress, (expected, ONE));
            }
        }
    }
    Ok(())
}

/// Records the radii of a carotid artery described as it is at rest, with the sector to which it opens.
pub fn opening_angle(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    let wall = artery_of([0.71, 0.97, 1.10]);
    let mut model = model(&wall, &[6, 4]);
    for layer in &mut model.tube.layers {
        layer.residual.opening = Some(Opening {
            fraction: 5.0 / 9.0,
            shift: (1.43 - 0.71) / 2.2,
        });
    }
    let (problem, state) = inflated(&model, &wall, 13.33, 16)?;
    recorder.case("carotid artery at rest, opening angle 160°, ℓ = 1.7, p = 13.33 kPa")?;
    let expected = ([1.27455486, 1.42755714], "an independent integration");
    radii(recorder, 1e-7, (&problem, &state), &wall, expected);
    Ok(())
}

/// Records radii and twist of an inflated tube with fibres of one hand, whose ends are free to turn.
pub fn helical_fibres(recorder: &mut Recorder<'_>) -> Result<(), VerificationError> {
    for dispersion in [0.0, 0.2] {
        let mut layer = Layer::new(0.5, 0.4, 20.0);
        layer.fibres.push(Family {
            k: [0.5, 1.0],
            dispersion,
            angle: 0.6,
        });
        let wall = LayeredWall {
            inner: 0.4,
            layers: vec![layer],
            stretch: 1.1,
        };
        let p = 0.05;
        let expected = wall.inflate(p, 4)?;
        // In the uniform state shear stresses act on a cross-section, without torque. They vanish on a sliding end, so
        // that the tube is uniform only far from its ends.
        let mut model = model(&wall, &[6]);
        model.tube.length = 4.0;
        model.elements[0] = 40;
        let (problem, state) = inflated(&model, &wall, p, 8)?;
        recorder.case(format!(
            "tube, fibres at 0.6 rad, dispersion {dispersion}, ℓ = 1.1, p = {p}"
        ))?;
        let both = [expected.radii[0], expected.radii[1]];
        radii(recorder, 1e-5, (&problem, &state), &wall, (both, ONE));
        let turn = |z: f64| {
            let at = Point {
                z,
                radius: 0.45,
                angle: 0.0,
            };
            let [_, x, y] = problem.tube.sample(&state.load, &state.u, at).position;
            y.atan2(x)
        };
        let twist = (turn(2.2) - turn(1.8)) / 0.4;
        recorder.relative(1e-5, "twist over length", twist, (expected.twist, ONE));
    }
    Ok(())
}
