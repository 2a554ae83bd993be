//! The obstacles: their names and shapes, and their distance from the tube at rest.

use super::super::keys::{self, Case};
use super::super::problem::Problems;
use super::lumen::LUMEN;
use super::muscles::{ENDS, WALLS, is_name};
use super::zone::{length, tidy};
use crate::study::Stage;
use crate::tube::{
    Load, Mesh, Obstacle, ObstacleShape, Outline, Placement, Support, Symmetry, Tube,
};
use std::f64::consts::TAU;

/// Names that would give a column of the history the name of another.
const RESERVED: [&str; 2] = ["at_min", "share"];
/// Points around the edge of a fixed end at which its distance from an obstacle is measured.
const POINTS: usize = 360;
/// Largest number of places along a stage at which an obstacle is compared with the edges of fixed ends.
const LARGEST_COUNT: usize = 200;
/// Largest motion of an obstacle in a load step, in its radii. A wall that is deeper inside is pushed out on the wrong side.
const LARGEST_STEP: f64 = 0.5;

/// Returns the obstacles, dimensionless.
pub(super) fn obstacles(case: &Case, problems: &mut Problems) -> Vec<Obstacle> {
    let mut obstacles: Vec<Obstacle> = vec![];
    for (i, obstacle) in case.obstacles.iter().enumerate() {
        let path = format!("obstacles[{}]", i + 1);
        check_name(
            &format!("{path}.name"),
            &obstacle.name,
            &obstacles,
            case,
            problems,
        );
        let (shape, radius, position) = match &obstacle.shape {
            keys::ObstacleShape::Rod(rod) => {
                let half = rod
                    .length
                    .map_or(f64::INFINITY, |x| 0.5 * x / case.tube.diameter);
                (
                    ObstacleShape::Rod { half_length: half },
                    rod.radius,
                    rod.position,
                )
            }
            keys::ObstacleShape::Sheath(sheath) => {
                (ObstacleShape::Sheath, sheath.radius, sheath.position)
            }
            keys::ObstacleShape::Ball(ball) => (ObstacleShape::Ball, ball.radius, ball.position),
            keys::ObstacleShape::Plate(plate) => {
                let [x, y, z] = plate.normal;
                let size = x.hypot(y).hypot(z);
                let key = format!("{path}.shape.plate.normal");
                if size == 0.0 && problems.are_sound(&[&key]) {
                    problems.value(&key, "must not be zero", "try [-1.0, 0.0, 0.0]");
                }
                let normal = [z, x, y].map(|x| if size > 0.0 { x / size } else { 0.0 });
                (ObstacleShape::Plate { normal }, 0.0, plate.position)
            }
        };
        obstacles.push(Obstacle {
            name: obstacle.name.clone(),
            shape,
            rest: Placement {
                radius: radius / case.tube.diameter,
                position: in_tube(position, case),
            },
            friction: obstacle.friction,
        });
    }
    obstacles
}

/// Returns a position of a case, [x, y, z], as (z, x, y) in D.
pub(super) fn in_tube([x, y, z]: [f64; 3], case: &Case) -> [f64; 3] {
    [z, x, y].map(|x| x / case.tube.diameter)
}

fn check_name(key: &str, name: &str, before: &[Obstacle], case: &Case, problems: &mut Problems) {
    if !problems.is_as_written(key) {
        return;
    }
    let is_taken = ENDS.contains(&name)
        || RESERVED.contains(&name)
        || name == LUMEN
        || [&case.ends.colon_name, &case.ends.ileum_name].contains(&&name.to_owned())
        || WALLS.contains(&name)
        || case.muscles.contains_key(name)
        || before.iter().any(|obstacle| obstacle.name == name);
    if !is_name(name) {
        let rule = "must consist of letters, digits, - and _, at most 40 of them";
        problems.value(key, rule, "");
    } else if is_taken {
        let rule = "a muscle, an end, a surface, a column or another obstacle has this name";
        problems.value(key, rule, "choose another name");
    }
}

/// Checks that obstacles are clear of the tube at rest, keep the symmetry, and move slowly enough.
pub(super) fn check(
    case: &Case,
    tube: &Tube,
    (mesh, symmetry): (&Mesh, Symmetry),
    (begin, stages): (&Load, &[Stage]),
    problems: &mut Problems,
) {
    for (i, obstacle) in tube.obstacles.iter().enumerate() {
        let path = format!("obstacles[{}]", i + 1);
        if !problems.are_sound(&[&path, "tube", "mesh", "stages", "start", "symmetry"]) {
            continue;
        }
        check_symmetry(i, obstacle, symmetry, (begin, stages), problems);
        check_ends(i, obstacle, tube, symmetry, (begin, stages), problems);
        check_steps(i, obstacle, case, (begin, stages), problems);
        check_fixed_ends(i, obstacle, tube, (begin, stages), problems);
        if case.start.is_none() {
            let gap = gap_at_rest(obstacle, tube);
            let [elements, ..] = mesh.elements();
            let breakpoints = mesh.breakpoints_along(tube.length);
            let lengths = breakpoints.windows(2).map(|pair| pair[1] - pair[0]);
            let range = mesh.contact_range * lengths.fold(f64::INFINITY, f64::min);
            let needed = range.max(0.25 * tube.length / elements as f64);
            if gap < needed {
                let rule = match gap > 0.0 {
                    true => format!(
                        "the obstacle is {} from the tube at rest, which must be at least {}",
                        length(case, gap),
                        length(case, tidy(needed))
                    ),
                    false => "the obstacle overlaps the tube at rest".to_owned(),
                };
                let help = "begin farther away, and move it or change its radius in a stage";
                problems.key(&format!("{path}.shape"), rule, help);
            }
        }
    }
}

/// Checks that the placements of an obstacle keep an axisymmetric tube axisymmetric.
fn check_symmetry(
    i: usize,
    obstacle: &Obstacle,
    symmetry: Symmetry,
    (begin, stages): (&Load, &[Stage]),
    problems: &mut Problems,
) {
    if let Symmetry::Fold(_) = symmetry {
        // Beside the axis it is repeated, on the axis it is not.
        let on_axis = obstacle.is_axisymmetric(&begin.obstacles[i]);
        for (s, stage) in stages.iter().enumerate() {
            let leaves = |load: &Load| obstacle.is_axisymmetric(&load.obstacles[i]) != on_axis;
            if stage.loads().any(leaves) {
                let key = format!("stages[{}].drive.{}.position", s + 1, obstacle.name);
                let rule = "the symmetry repeats an obstacle beside the axis, but not one on it";
                let help = "keep it on the axis, or beside it, in all stages";
                return problems.value(&key, rule, help);
            }
        }
    }
    if symmetry != Symmetry::Axisymmetric {
        return;
    }
    let help = "use symmetry = \"none\" or a fold, or place the obstacle on the axis";
    if !obstacle.is_axisymmetric(&begin.obstacles[i]) {
        let rule = "an axisymmetric tube needs an obstacle that is symmetric about its axis";
        return problems.key(&format!("obstacles[{}].shape", i + 1), rule, help);
    }
    for (s, stage) in stages.iter().enumerate() {
        let leaves = |load: &Load| !obstacle.is_axisymmetric(&load.obstacles[i]);
        if stage.loads().any(leaves) {
            let key = format!("stages[{}].drive.{}.position", s + 1, obstacle.name);
            let rule = "an axisymmetric tube needs obstacles that stay on its axis";
            return problems.value(&key, rule, help);
        }
    }
}

/// Checks that the ends hold a tube which an obstacle pushes.
fn check_ends(
    i: usize,
    obstacle: &Obstacle,
    tube: &Tube,
    symmetry: Symmetry,
    (begin, stages): (&Load, &[Stage]),
    problems: &mut Problems,
) {
    if !problems.are_sound(&["ends"]) {
        return;
    }
    let key = format!("obstacles[{}].shape", i + 1);
    let pushes_along = obstacle.friction > 0.0
        || match obstacle.shape {
            ObstacleShape::Rod { half_length } => half_length.is_finite(),
            ObstacleShape::Sheath => false,
            ObstacleShape::Ball => true,
            ObstacleShape::Plate { normal } => normal[0] != 0.0,
        };
    let mut loads = std::iter::once(begin).chain(stages.iter().flat_map(Stage::loads));
    let pushes_across = symmetry == Symmetry::None
        && loads.any(|load| !obstacle.is_axisymmetric(&load.obstacles[i]));
    if pushes_across && !tube.ends.contains(&Support::Fixed) {
        let rule = "the obstacle can push the tube sideways, and no end holds it";
        problems.key(&key, rule, "write \"fixed\" for an end in [ends]");
    } else if pushes_along && tube.ends == [Support::Free; 2] {
        let rule = "the obstacle can push the tube along its axis, and no end holds it";
        let help = "write \"fixed\" or \"sliding\" for an end in [ends]";
        problems.key(&key, rule, help);
    }
}

/// Checks that an obstacle stays clear of the edges of fixed ends, which cannot give way.
fn check_fixed_ends(
    i: usize,
    obstacle: &Obstacle,
    tube: &Tube,
    (begin, stages): (&Load, &[Stage]),
    problems: &mut Problems,
) {
    let meets = |load: &Load| {
        let edges = [0, 1]
            .into_iter()
            .filter(|end| tube.ends[*end] == Support::Fixed);
        let mut points = edges.flat_map(|end| {
            let at_rest = tube.length * end as f64;
            let motion = load.ends[end];
            let z = at_rest + motion.displacement;
            radii_at(tube, at_rest).into_iter().flat_map(move |radius| {
                (0..POINTS).map(move |j| {
                    let (sin, cos) = (TAU * j as f64 / POINTS as f64).sin_cos();
                    let [x, y] = motion.shift;
                    [z, x + radius * cos, y + radius * sin]
                })
            })
        });
        points.any(|point| obstacle.shape.distance(&load.obstacles[i], point).gap < 0.0)
    };
    let mut before = begin;
    for (s, stage) in stages.iter().enumerate() {
        let steps = stage.steps.min(LARGEST_COUNT);
        if (1..=steps).any(|n| meets(&stage.load_at(before, n as f64 / steps as f64))) {
            let key = format!("stages[{}]", s + 1);
            let rule = format!("{} runs into the edge of a fixed end", obstacle.name);
            let help = "write \"sliding\" or \"free\" for the end in [ends], or let the obstacle widen inside the tube";
            return problems.key(&key, rule, help);
        }
        before = &stage.load;
    }
}

/// Checks that an obstacle moves by at most half its radius in a step.
fn check_steps(
    i: usize,
    obstacle: &Obstacle,
    case: &Case,
    (begin, stages): (&Load, &[Stage]),
    problems: &mut Problems,
) {
    if matches!(obstacle.shape, ObstacleShape::Plate { .. }) {
        return;
    }
    let mut before = begin.obstacles[i];
    for (s, stage) in stages.iter().enumerate() {
        // An endless cylinder does not change when it moves along z.
        let first = match obstacle.shape {
            ObstacleShape::Sheath => 1,
            ObstacleShape::Rod { half_length } if half_length.is_infinite() => 1,
            _ => 0,
        };
        // The largest motion, over the whole stage at this speed, and the smallest radius.
        let (mut moved, mut square, mut radius) = (0.0_f64, 0.0_f64, before.radius);
        let corners = stage.course.iter().map(|(at, load)| (*at, load));
        let mut last = (0.0, before);
        for (at, load) in corners.chain([(1.0, &stage.load)]) {
            let next = load.obstacles[i];
            let motion = (first..3).map(|k| next.position[k] - last.1.position[k]);
            let own: f64 = motion.map(|x| x * x).sum();
            let change = own.sqrt() + (next.radius - last.1.radius).abs();
            moved = moved.max(change / (at - last.0));
            square = square.max(own);
            radius = radius.min(next.radius);
            last = (at, next);
        }
        let steps = (moved / (LARGEST_STEP * radius)).ceil();
        if steps > stage.steps as f64 && square > 0.0 {
            let key = format!("stages[{}].steps", s + 1);
            let rule = format!(
                "{} moves by {} in a step, more than half its radius of {}",
                obstacle.name,
                length(case, tidy(moved / stage.steps as f64)),
                length(case, radius)
            );
            return problems.key(&key, rule, format!("write steps = {steps}"));
        }
        before = stage.load.obstacles[i];
    }
}

/// Returns the smallest distance of an obstacle from the wall at rest; negative where they overlap.
fn gap_at_rest(obstacle: &Obstacle, tube: &Tube) -> f64 {
    if tube.outline().is_some() {
        return gap_of_points(obstacle, tube);
    }
    let Placement { radius, position } = obstacle.rest;
    let [z, x, y] = position;
    let across = x.hypot(y);
    let radii = [tube.inner_radius(), Tube::OUTER_RADIUS];
    // Distance of a point or a segment of the axis of an obstacle from the wall.
    let from_wall = |half_length: f64| {
        let beside = (radii[0] - across).max(across - radii[1]).max(0.0);
        let beyond = (z - half_length - tube.length)
            .max(-z - half_length)
            .max(0.0);
        beside.hypot(beyond) - radius
    };
    match obstacle.shape {
        ObstacleShape::Ball => from_wall(0.0),
        ObstacleShape::Rod { half_length } => from_wall(half_length),
        ObstacleShape::Sheath => radius - across - radii[1],
        ObstacleShape::Plate {
            normal: [n_z, n_x, n_y],
        } => {
            let at = |end: f64| n_z * (end - z) - n_x * x - n_y * y - n_x.hypot(n_y) * radii[1];
            at(0.0).min(at(tube.length))
        }
    }
}

/// Returns the outer and the inner radius at z.
fn radii_at(tube: &Tube, z: f64) -> [f64; 2] {
    let radii = [Tube::OUTER_RADIUS, tube.inner_radius()];
    let outline = tube.outline();
    radii.map(|radius| {
        let size = [tube.length, tube.thickness];
        let outwards = |outline: &Outline| outline.displacement(z, radius, size)[1];
        radius + outline.map_or(0.0, outwards)
    })
}

/// Returns the smallest distance of an obstacle from points of the faces of the wall at rest.
fn gap_of_points(obstacle: &Obstacle, tube: &Tube) -> f64 {
    let rows = (0..=POINTS).map(|i| tube.length * i as f64 / POINTS as f64);
    let points = rows.flat_map(|z| {
        let radii = radii_at(tube, z).into_iter();
        radii.flat_map(move |radius| {
            (0..POINTS).map(move |j| {
                let (sin, cos) = (TAU * j as f64 / POINTS as f64).sin_cos();
                [z, radius * cos, radius * sin]
            })
        })
    });
    let gaps = points.map(|point| obstacle.shape.distance(&obstacle.rest, point).gap);
    gaps.fold(f64::INFINITY, f64::min)
}
