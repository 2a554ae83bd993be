//! The imperfections: their parts, amplitudes and shapes.

use super::super::files::{Input, InputFile, OpenInput};
use super::super::key::join;
use super::super::keys::{self, Case};
use super::super::problem::Problems;
use super::super::spelling::nearest;
use super::stages::broken_by_strength;
use super::start::check_size;
use super::zone::{length, tidy, zone};
use crate::study::{ModeShape, Stage, inverted_by_imperfections};
use crate::tube::{
    Axial, End, EndDirection, Imperfection, Mesh, Part, Random, Shape, Support, Symmetry, Tube,
    Wave,
};

/// Largest displacement over the thickness of the wall.
const LARGEST_DISPLACEMENT: f64 = 0.25;
/// Largest change of a muscle's activity.
const LARGEST_CHANGE: f64 = 0.5;
/// Number of control points from which on it takes long to examine a wall.
const LARGE: usize = 1_000_000;
/// Largest and usual number of modes and of half-waves of a random shape.
const LARGEST_COUNT: usize = 50;
const USUAL_COUNT: usize = 4;
const AROUND: &str = "mesh.control_points.around";
const NO_SYMMETRY: &str = "use symmetry = \"none\"";

/// The mesh and the symmetry.
type Run<'a> = (&'a Mesh, Symmetry);

/// Returns the imperfections of a tube, and the modes that are their shapes.
pub(super) fn imperfections(
    case: &Case,
    tube: &Tube,
    run: Run<'_>,
    open: &OpenInput<'_>,
    problems: &mut Problems,
) -> (Vec<Imperfection>, Vec<ModeShape>) {
    let (mut imperfections, mut modes) = (vec![], vec![]);
    for (i, written) in case.imperfections.iter().enumerate() {
        let path = format!("imperfections[{}]", i + 1);
        let (of, exists) = part(&path, written, tube, problems);
        let amplitude = amplitude(&path, written.amplitude, of, case, tube, problems);
        let shape = match &written.shape {
            keys::Shape::Wave(written) => wave(&path, written, of, case, tube, run, problems),
            keys::Shape::Random(written) => random(&path, written, of, run, problems),
            keys::Shape::Mode(file) => {
                let file = InputFile::Mode(i + 1, file);
                let Some((shape, mode)) = mode(&path, file, of, (case, tube), run, open, problems)
                else {
                    continue;
                };
                modes.push(mode);
                shape
            }
        };
        if exists {
            imperfections.push(Imperfection {
                of,
                amplitude,
                shape,
            });
        }
    }
    (imperfections, modes)
}

/// Returns the part that is imperfect, and whether the tube has it.
fn part(
    path: &str,
    written: &keys::Imperfection,
    tube: &Tube,
    problems: &mut Problems,
) -> (Part, bool) {
    let key = format!("{path}.of");
    let is_end = matches!(written.of, keys::Part::ColonEnd | keys::Part::IleumEnd);
    if !is_end && written.direction.is_some() && problems.is_as_written(&key) {
        let rule = "only an imperfect end has a direction";
        problems.key(&format!("{path}.direction"), rule, "leave it out");
    }
    match &written.of {
        keys::Part::ColonEnd => (end(path, written, End::Colon, tube, problems), true),
        keys::Part::IleumEnd => (end(path, written, End::Ileum, tube, problems), true),
        keys::Part::Geometry => (Part::Geometry, true),
        keys::Part::Muscle(name) => {
            let found = tube.muscles.iter().position(|muscle| muscle.name == *name);
            if found.is_none() && problems.are_sound(&[&join("muscles", name)]) {
                let names = tube.muscles.iter().map(|muscle| muscle.name.as_str());
                let help = match nearest(name, names) {
                    Some(near) => format!("did you mean \"{near}\"?"),
                    None => format!("add [{}]", join("muscles", name)),
                };
                let rule = "there is no muscle of this name";
                problems.value(&format!("{key}.muscle"), rule, help);
            }
            (Part::Muscle(found.unwrap_or_default()), found.is_some())
        }
    }
}

/// Checks that an imperfect end is held in the direction of its displacement.
fn end(
    path: &str,
    written: &keys::Imperfection,
    end: End,
    tube: &Tube,
    problems: &mut Problems,
) -> Part {
    let push = written.direction.unwrap_or(EndDirection::Across);
    let problem = match (tube.ends[end as usize], push) {
        (Support::Fixed, _) | (Support::Sliding, EndDirection::Axial) => None,
        (Support::Sliding, EndDirection::Across) => Some((
            "a sliding end is held along the axis only",
            "write direction = \"axial\", or \"fixed\" in [ends]",
        )),
        (Support::Free, _) => Some((
            "a free end cannot be imperfect",
            "write \"fixed\" in [ends]",
        )),
    };
    let key = format!("{path}.of");
    if let Some((rule, help)) = problem
        && problems.is_as_written(&key)
        && problems.is_as_written(&format!("{path}.direction"))
    {
        problems.value(&key, rule, help);
    }
    Part::End(end, push)
}

/// Checks an amplitude, and returns it in D if it is a length.
fn amplitude(
    path: &str,
    written: f64,
    of: Part,
    case: &Case,
    tube: &Tube,
    problems: &mut Problems,
) -> f64 {
    let key = format!("{path}.amplitude");
    if !problems.is_as_written(&format!("{path}.of")) || !problems.are_sound(&[&key]) {
        return written;
    }
    if matches!(of, Part::Muscle(_)) {
        if written.abs() > LARGEST_CHANGE {
            let rule = format!(
                "must be from -{LARGEST_CHANGE} to {LARGEST_CHANGE} (a fraction of the muscle's activity)"
            );
            problems.value(&key, rule, "try 0.01");
        }
        return written;
    }
    let diameter = case.tube.diameter;
    let largest = LARGEST_DISPLACEMENT * tube.thickness;
    let amplitude = written / diameter;
    if amplitude.abs() > largest && problems.are_sound(&["tube.thickness", "tube.diameter"]) {
        let rule = format!(
            "must be at most a quarter of the wall's thickness, {}",
            length(case, largest)
        );
        problems.value(&key, rule, format!("try {}", tidy(1e-4 * diameter)));
    }
    amplitude
}

/// Returns a single wave.
fn wave(
    path: &str,
    wave: &keys::Wave,
    of: Part,
    case: &Case,
    tube: &Tube,
    run: Run<'_>,
    problems: &mut Problems,
) -> Shape {
    let key = format!("{path}.shape.wave");
    let (mode, axial) = (format!("{key}.mode"), format!("{key}.axial"));
    match run.1 {
        Symmetry::Fold(m) if m > 0 && !wave.mode.is_multiple_of(m) => {
            if problems.are_sound(&[&mode, "symmetry"]) {
                let rule =
                    format!("must be a multiple of {m}, since the tube repeats {m} times around");
                problems.value(&mode, rule, format!("try {m}, or use another symmetry"));
            }
        }
        _ => check_largest_mode(&mode, wave.mode, run, problems),
    }
    if wave.axial.is_some() {
        check_axial_shape(path, &axial, of, problems);
    }
    let along = match wave.axial {
        None if of == Part::Geometry => Axial::HalfWaves(1),
        None => Axial::Uniform,
        Some(Axial::Zone(written)) => {
            let key = format!("{axial}.zone");
            Axial::Zone(zone(&key, case, written, tube.length, problems))
        }
        Some(axial) => axial,
    };
    Shape::Wave(Wave::new(wave.mode, wave.phase_degrees.to_radians(), along))
}

/// Returns a random shape.
fn random(
    path: &str,
    random: &keys::Random,
    of: Part,
    run: Run<'_>,
    problems: &mut Problems,
) -> Shape {
    let key = format!("{path}.shape.random");
    let (mesh, symmetry) = run;
    let resolved = mesh.around / 4;
    let usual = match symmetry {
        Symmetry::Axisymmetric => 0,
        Symmetry::Fold(_) | Symmetry::None => USUAL_COUNT.min(resolved),
    };
    let modes = random.modes.unwrap_or(usual);
    check_largest_mode(&format!("{key}.modes"), modes, run, problems);
    if random.half_waves.is_some() {
        check_axial_shape(path, &format!("{key}.half_waves"), of, problems);
    }
    let half_waves = match of {
        Part::End(..) => 0,
        _ => random.half_waves.unwrap_or(USUAL_COUNT).min(LARGEST_COUNT),
    };
    let fold = match symmetry {
        Symmetry::Fold(m) => m.max(1),
        Symmetry::Axisymmetric | Symmetry::None => 1,
    };
    // The limits matter only if a problem was found.
    let modes = modes.min(resolved).min(LARGEST_COUNT);
    Shape::Random(Random::new(random.seed as u64, modes, half_waves, fold))
}

/// Reads a mode, and checks that it belongs to the tube and has the symmetry of the run.
fn mode(
    path: &str,
    input: InputFile<'_>,
    of: Part,
    (case, tube): (&Case, &Tube),
    (mesh, symmetry): Run<'_>,
    open: &OpenInput<'_>,
    problems: &mut Problems,
) -> Option<(Shape, ModeShape)> {
    let key = format!("{path}.shape.mode");
    let InputFile::Mode(imperfection, file) = input else {
        return None;
    };
    if !problems.is_as_written(&key) {
        return None;
    }
    let state = open(input).and_then(Input::state);
    let read = state.and_then(|state| Ok((state.mode()?, state)));
    let (mode, state) = match read {
        Ok(read) => read,
        Err(error) => {
            let help = "give the path of modes/mode-NN-harmonic-N.safetensors, which plica stability \
                 writes to a run, relative to the case file";
            problems.value(&key, error.to_string(), help);
            return None;
        }
    };
    if of != Part::Geometry {
        if problems.is_as_written(&format!("{path}.of")) {
            let rule = "only an imperfect geometry can have the shape of a mode";
            problems.key(&key, rule, "write of = \"geometry\"");
        }
        return None;
    }
    let n = mode.harmonic;
    if problems.are_sound(&["symmetry", "tube.length", "tube.thickness", "tube.diameter"]) {
        check_size(&key, &state, case, tube, problems);
        let wrong = match symmetry {
            Symmetry::Axisymmetric if n > 0 => {
                Some("an axisymmetric run has mode 0 only".to_owned())
            }
            Symmetry::Fold(m) if m > 0 && !n.is_multiple_of(m) => {
                Some(format!("the tube repeats {m} times around"))
            }
            _ => None,
        };
        if let Some(wrong) = wrong {
            let rule = format!("is of circumferential mode {n}, and {wrong}");
            let help = match n {
                0 | 1 => NO_SYMMETRY.to_owned(),
                n => format!("use symmetry = {{ fold = {n} }}, or \"none\""),
            };
            problems.value(&key, rule, help);
        } else if n > mesh.around / 4 && problems.are_sound(&[AROUND]) {
            let rule = format!(
                "is of circumferential mode {n}, and {} control points around the tube resolve at most {}",
                mesh.around,
                mesh.around / 4
            );
            problems.value(&key, rule, format!("try {} points around", 4 * n));
        }
    }
    let named = ModeShape {
        imperfection,
        file: file.to_owned(),
        state,
    };
    Some((Shape::Mode(mode), named))
}

/// Checks that an imperfection with a shape along the tube is not of an end.
fn check_axial_shape(path: &str, key: &str, of: Part, problems: &mut Problems) {
    if matches!(of, Part::End(..)) && problems.is_as_written(&format!("{path}.of")) {
        let rule = "an end is a single cross-section, and has no shape along the tube";
        problems.key(key, rule, "leave it out");
    }
}

/// Checks that the symmetry allows a largest circumferential mode, and that the mesh resolves it.
fn check_largest_mode(key: &str, n: usize, (mesh, symmetry): Run<'_>, problems: &mut Problems) {
    let (around, most) = (mesh.around, mesh.around / 4);
    if !problems.are_sound(&[key, "symmetry", AROUND]) {
        return;
    }
    if symmetry == Symmetry::Axisymmetric && n > 0 {
        problems.value(key, "an axisymmetric run has mode 0 only", NO_SYMMETRY);
    } else if n > most {
        let rule = format!(
            "must be at most {most}, a quarter of the {around} control points around the tube"
        );
        problems.value(key, rule, format!("try {} points around", 4 * n));
    }
}

/// Checks that all imperfections of the geometry together leave a wall that is not folded over.
pub(super) fn check_wall(
    case: &Case,
    tube: &Tube,
    (mesh, symmetry): Run<'_>,
    problems: &mut Problems,
) {
    let of_geometry = |imperfection: &Imperfection| imperfection.of == Part::Geometry;
    let Some(last) = tube.imperfections.iter().rposition(of_geometry) else {
        return;
    };
    // The zones of the muscles refine the mesh.
    if !problems.are_sound(&["imperfections", "tube", "mesh", "symmetry", "muscles"]) {
        return;
    }
    // This takes long on a large mesh; other problems are reported first.
    let is_large = mesh.axial * mesh.thickness * mesh.rings(symmetry) > LARGE;
    if is_large && !problems.is_empty() {
        return;
    }
    if let Some(at) = inverted_by_imperfections(tube, mesh, symmetry) {
        let z = length(case, at.place.z);
        let rule = format!(
            "with it the stress-free wall is folded over, near z = {z}, {}",
            at.place.angle_and_depth()
        );
        // The outline comes last.
        if last < case.imperfections.len() {
            let key = format!("imperfections[{}].amplitude", last + 1);
            problems.value(&key, rule, "make it smaller");
        } else {
            problems.key("tube", rule, "let the tables rise or fall more slowly");
        }
    }
}

/// Checks the smallest stress-free stretch where an imperfect muscle is strongest.
pub(super) fn check_stretches(tube: &Tube, stages: &[Stage], problems: &mut Problems) {
    if !problems.are_sound(&["imperfections", "start", "tube.length", "tube.diameter"]) {
        return;
    }
    for (m, muscle) in tube.muscles.iter().enumerate() {
        let own = |imperfection: &&Imperfection| imperfection.of == Part::Muscle(m);
        let amplitudes = tube
            .imperfections
            .iter()
            .filter(own)
            .map(|i| i.amplitude.abs());
        let strongest = 1.0 + amplitudes.sum::<f64>();
        let Some(last) = tube.imperfections.iter().rposition(|i| own(&i)) else {
            continue;
        };
        let drives = (1..=stages.len()).map(|i| format!("stages[{i}].drive.{}", muscle.name));
        let mut keys = drives.chain([format!("muscles.{}", muscle.name)]);
        if !keys.all(|key| problems.are_sound(&[&key])) {
            continue;
        }
        if let Some(rule) = broken_by_strength(tube, m, strongest, stages) {
            problems.value(&format!("imperfections[{}].amplitude", last + 1), rule, "");
        }
    }
}
