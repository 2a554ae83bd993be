//! Random axisymmetric cases with contact: each run completes or stops with a reason, and no state crosses itself. The check
//! of crossings is independent of the code of contact: polygons through points of the walls.
//!
//! `PLICA_RANDOM_CASES=30 cargo test --release -p plica contact_cases -- --nocapture` runs more cases than by default.

use crate::common::Chance;
use plica::assembly::SplineTube;
use plica::case;
use plica::monitor::Monitor;
use plica::study::{Ending, Study};
use plica::tube::Tube;
use std::fmt::{Display, Write};

/// Default number of cases.
const COUNT: usize = 3;

/// Seed of the first case: this one and the next are quick.
const FIRST: u64 = 5;

/// Most solves of a case.
const MAX_SOLVES: usize = 1500;

/// Points of an element in the first polygon, and in a finer one that confirms a crossing.
const POINTS: [usize; 2] = [10, 200];

fn between(chance: &mut Chance, low: f64, high: f64) -> f64 {
    low + (high - low) * chance.below(1001) as f64 / 1000.0
}

/// Returns a case with a fold, a narrow waist, a pushed end or a pressure that closes the lumen.
fn random_case(chance: &mut Chance) -> String {
    let mut case = "contact = true\n".to_owned();
    let mut add = |text: std::fmt::Arguments<'_>| case.write_fmt(text).unwrap();
    let length = between(chance, 1.5, 3.0);
    let thickness = [0.02, 0.04, 0.06, 0.12, 0.2][chance.below(5)];
    add(format_args!(
        "[tube]\nlength = {length:.3}\nthickness = {thickness}\n[material.neo-hookean]\npoisson_ratio = {}\n",
        [0.3, 0.45, 0.49][chance.below(3)]
    ));
    let width = between(chance, 0.2, 0.6);
    let from = between(chance, 0.1, length - width - 0.1);
    for (name, direction) in [("ring", "circular"), ("band", "longitudinal")] {
        add(format_args!(
            "[muscles.{name}]\ndirection = \"{direction}\"\nzone = [{from:.3}, {:.3}]\n",
            from + width
        ));
    }
    let ileum = ["fixed", "fixed", "sliding"][chance.below(3)];
    add(format_args!("[ends]\nileum = \"{ileum}\"\n"));
    add(format_args!(
        "[mesh]\ncontrol_points = {{ axial = {}, around = 12, thickness = 4 }}\n",
        40 + chance.below(30)
    ));
    let mut other = Chance(chance.0 ^ 0x5555);
    let mut stage = |text: &str| {
        add(format_args!(
            "[[stages]]\nsteps = {}\n{text}",
            4 + chance.below(5)
        ));
    };
    let waist = between(&mut other, 0.15, 0.5);
    let grown = between(&mut other, 1.2, 1.8);
    let pushed = -between(&mut other, 0.1, 0.4) * length;
    let pressure = between(&mut other, 0.2, 2.0) * thickness * thickness;
    let contract = format!("drive.ring.diameter_ratio = {waist:.3}\n");
    let relax = format!("drive.band.length_ratio = {grown:.3}\n");
    let push = format!("drive.ileum.displacement = {pushed:.3}\n");
    let press = format!("drive.outer-wall.pressure = {pressure:.4e}\n");
    let release = "drive.ring.diameter_ratio = 1.0\n";
    match other.below(6) {
        0 => [&contract[..], &relax].map(&mut stage).to_vec(),
        1 => [&contract[..], &relax, release].map(&mut stage).to_vec(),
        2 => [
            &(relax.clone() + &contract)[..],
            "drive.band.length_ratio = 1.0\n",
            release,
        ]
        .map(&mut stage)
        .to_vec(),
        3 => [&contract[..], &push].map(&mut stage).to_vec(),
        4 => [&push[..], &contract].map(&mut stage).to_vec(),
        _ => [&(press + &contract)[..], &relax].map(&mut stage).to_vec(),
    };
    let scheme = ["static", "static", "static", "backward-euler"][other.below(4)];
    case += &format!(
        "[solver]\nscheme = \"{scheme}\"\nmax_step_halvings = 4\n[output]\npictures = false\nstability_modes = 0\n"
    );
    case
}

/// Cancels a run after a number of solves.
struct Limit(usize);

impl Monitor for Limit {
    fn working(&mut self, _: &dyn Display, _: f64) {
        self.0 += 1;
    }
    fn is_cancelled(&self) -> bool {
        self.0 >= MAX_SOLVES
    }
}

/// Returns the meridian (z, r) of a wall at points of every element.
fn meridian(tube: &SplineTube, u: &[f64], radius: f64, points: usize) -> Vec<[f64; 2]> {
    let z = tube.axial.positions(tube.axial.elements() * points + 1);
    let rings = tube.surface_points(u, radius, &z, &[0.5]);
    let point = |ring: &Vec<plica::assembly::SurfacePoint>| {
        let [z, x, y] = ring[0].position;
        [z, x.hypot(y)]
    };
    rings.iter().map(point).collect()
}

/// Returns whether two segments of a polygon that are not neighbours meet, by a sweep along z.
fn crosses(points: &[[f64; 2]]) -> bool {
    let turn = |a: [f64; 2], b: [f64; 2], c: [f64; 2]| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let low = |i: usize, k: usize| points[i][k].min(points[i + 1][k]);
    let high = |i: usize, k: usize| points[i][k].max(points[i + 1][k]);
    let mut order: Vec<usize> = (0..points.len() - 1).collect();
    order.sort_by(|&i, &j| low(i, 0).total_cmp(&low(j, 0)));
    let mut open: Vec<usize> = vec![];
    for i in order {
        open.retain(|&j| high(j, 0) >= low(i, 0));
        for &j in &open {
            if i.abs_diff(j) < 2 || low(i, 1) > high(j, 1) || low(j, 1) > high(i, 1) {
                continue;
            }
            let [a, b, c, d] = [points[i], points[i + 1], points[j], points[j + 1]];
            if turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0 {
                return true;
            }
        }
        open.push(i);
    }
    false
}

/// Follows a case. Returns how it ended in words, the number of its states, and of those that touch.
fn follow(text: &str) -> (String, usize, usize) {
    let plan = case::read(text, "random").unwrap();
    let mut study = Study::new(&plan).unwrap();
    let (mut states, mut touching, mut limit) = (0, 0, Limit(0));
    while let Some(Ok(state)) = study.next_state(&mut limit) {
        states += 1;
        let contact = state.contact.as_ref().unwrap();
        touching += usize::from(contact.faces.iter().any(Option::is_some));
        assert!(
            state.measures.gap > 0.0,
            "state {states} is measured as crossing"
        );
        for radius in [Tube::OUTER_RADIUS, plan.tube.inner_radius()] {
            let crossing = POINTS
                .iter()
                .all(|&n| crosses(&meridian(study.tube(), &state.unknowns, radius, n)));
            assert!(
                !crossing,
                "state {states} crosses itself at radius {radius}"
            );
        }
    }
    let ending = match study.ending() {
        Some(Ending::Complete) => "complete".to_owned(),
        Some(Ending::Lost(lost)) => format!("lost: {}", lost.error),
        ending => format!("{ending:?}"),
    };
    (ending, states, touching)
}

#[test]
fn polygons_that_cross_are_seen() {
    let open = [
        [0.0, 0.0],
        [1.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
        [0.0, 0.1],
        [0.9, 0.1],
    ];
    assert!(!crosses(&open));
    let mut closed = open;
    closed[5] = [0.5, -0.1];
    assert!(crosses(&closed));
}

#[test]
fn random_cases_with_contact_never_cross_themselves() {
    let count = std::env::var("PLICA_RANDOM_CASES").ok();
    let count = count.and_then(|text| text.parse().ok()).unwrap_or(COUNT);
    let (mut touching, mut complete) = (0, 0);
    for seed in FIRST..FIRST + count as u64 {
        let text = random_case(&mut Chance(0x9E37_79B9_7F4A_7C15_u64.wrapping_mul(seed)));
        let run = std::panic::AssertUnwindSafe(|| follow(&text));
        let Ok((ending, states, touches)) = std::panic::catch_unwind(run) else {
            panic!("seed {seed}:\n{text}");
        };
        println!("{seed}: {states} states, {touches} touch, {ending}");
        touching += usize::from(touches > 0);
        complete += usize::from(ending == "complete");
    }
    assert!(
        touching > 0 && 2 * complete >= count,
        "{touching} {complete}"
    );
}
