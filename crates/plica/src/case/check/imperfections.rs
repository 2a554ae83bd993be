//! The imperfections: of what, how large, and in harmonics that the run has.

use super::super::keys::join;
use super::super::problem::Problems;
use super::super::spec::{self, Spec};
use super::super::spelling::nearest;
use super::super::{Open, Wanted};
use super::stages::SMALLEST_STRETCH;
use super::start::check_size;
use super::tube::tidy;
use super::zone;
use crate::study::{ModeShape, Stage, inverted_by_imperfections};
use crate::tube::{
    Axial, End, Imperfection, Mesh, Part, Push, Random, Shape, Support, Symmetry, Tube, Wave,
};

/// Largest displacement, over the thickness of the wall.
const LARGEST_DISPLACEMENT: f64 = 0.25;
/// So many control points are a large mesh.
const LARGE: usize = 1_000_000;
/// Largest change of a muscle's activity.
const LARGEST_CHANGE: f64 = 0.5;

/// The imperfections of a tube, and the modes that they have the shape of.
pub(super) fn imperfections(
    spec: &Spec,
    tube: &Tube,
    run: (&Mesh, Symmetry),
    open: &Open<'_>,
    problems: &mut Problems,
) -> (Vec<Imperfection>, Vec<ModeShape>) {
    let (mut imperfections, mut modes) = (vec![], vec![]);
    for (i, written) in spec.imperfections.iter().enumerate() {
        let path = format!("imperfections[{}]", i + 1);
        let (of, is_there) = part(&path, written, tube, problems);
        let amplitude = amplitude(&path, written, of, spec, tube, problems);
        let shape = match &written.shape {
            spec::Shape::Wave(written) => wave(&path, *written, of, spec, tube, run, problems),
            spec::Shape::Random(written) => random(&path, *written, of, run, problems),
            spec::Shape::Mode(file) => {
                let wanted = Wanted::Mode(i + 1, file);
                let Some((shape, mode)) = mode(&path, wanted, of, tube, run, open, problems) else {
                    continue;
                };
                modes.push(mode);
                shape
            }
        };
        if is_there {
            imperfections.push(Imperfection {
                of,
                amplitude,
                shape,
            });
        }
    }
    (imperfections, modes)
}

/// What is imperfect, and whether the tube has it; if not, one of its kind.
fn part(
    path: &str,
    written: &spec::Imperfection,
    tube: &Tube,
    problems: &mut Problems,
) -> (Part, bool) {
    let key = format!("{path}.of");
    if !matches!(written.of, spec::Part::ColonEnd | spec::Part::IleumEnd)
        && written.direction.is_some()
        && problems.is_as_written(&key)
    {
        let rule = "only an imperfect end has a direction";
        let cure = Some("leave it out".into());
        problems.key(&format!("{path}.direction"), rule, cure);
    }
    match &written.of {
        spec::Part::ColonEnd => {
            let end = end(&key, written, End::Colon, tube.ends[0], problems);
            (end, true)
        }
        spec::Part::IleumEnd => {
            let end = end(&key, written, End::Ileum, tube.ends[1], problems);
            (end, true)
        }
        spec::Part::Geometry => (Part::Geometry, true),
        spec::Part::Muscle(name) => {
            let found = tube.muscles.iter().position(|muscle| muscle.name == *name);
            if found.is_none() && problems.none_about(&[&join("muscles", name)]) {
                let names = || tube.muscles.iter().map(|muscle| muscle.name.as_str());
                let cure = match nearest(name, names()) {
                    Some(near) => format!("did you mean \"{near}\"?"),
                    None => format!("add [{}]", join("muscles", name)),
                };
                let rule = "there is no muscle of this name";
                problems.value(&format!("{key}.muscle"), rule, Some(cure));
            }
            (Part::Muscle(found.unwrap_or_default()), found.is_some())
        }
    }
}

/// An imperfect end, if it is held as that needs.
fn end(
    key: &str,
    written: &spec::Imperfection,
    end: End,
    support: Support,
    problems: &mut Problems,
) -> Part {
    let push = match written.direction {
        Some(spec::Push::Axial) => Push::Axial,
        Some(spec::Push::Across) | None => Push::Across,
    };
    let problem = match (support, push) {
        (Support::Fixed, _) | (Support::Sliding, Push::Axial) => None,
        (Support::Sliding, Push::Across) => Some((
            "a sliding end is held along the axis only",
            "write direction = \"axial\", or hold it with \"fixed\" in [ends]",
        )),
        (Support::Free, _) => Some((
            "only where an end is held can be imperfect, and this one is free",
            "hold it, with \"fixed\" in [ends]",
        )),
    };
    let direction = key.replace(".of", ".direction");
    if let Some((rule, cure)) = problem
        && problems.is_as_written(key)
        && problems.is_as_written(&direction)
    {
        problems.value(key, rule, Some(cure.into()));
    }
    Part::End(end, push)
}

/// The amplitude, in D if it is a length.
fn amplitude(
    path: &str,
    written: &spec::Imperfection,
    of: Part,
    spec: &Spec,
    tube: &Tube,
    problems: &mut Problems,
) -> f64 {
    let key = format!("{path}.amplitude");
    let of_key = format!("{path}.of");
    if matches!(of, Part::Muscle(_)) {
        if written.amplitude.abs() > LARGEST_CHANGE
            && problems.none_about(&[&key])
            && problems.is_as_written(&of_key)
        {
            let rule = format!(
                "must be from -{LARGEST_CHANGE} to {LARGEST_CHANGE} (a fraction of the muscle's activity)"
            );
            problems.value(&key, rule, Some("try 0.01".into()));
        }
        return written.amplitude;
    }
    let diameter = spec.tube.diameter;
    let largest = LARGEST_DISPLACEMENT * tube.thickness;
    let amplitude = written.amplitude / diameter;
    if amplitude.abs() > largest
        && problems.none_about(&[&key, "tube.thickness", "tube.diameter"])
        && problems.is_as_written(&of_key)
    {
        let rule = format!(
            "must be at most a quarter of the wall's thickness, {}",
            tidy(largest * diameter)
        );
        let cure = format!("try {}", tidy(1e-4 * diameter));
        problems.value(&key, rule, Some(cure));
    }
    amplitude
}

/// One wave, of a harmonic that the run has.
fn wave(
    path: &str,
    wave: spec::Wave,
    of: Part,
    spec: &Spec,
    tube: &Tube,
    run: (&Mesh, Symmetry),
    problems: &mut Problems,
) -> Shape {
    let of_key = format!("{path}.of");
    let path = format!("{path}.shape.wave");
    check_harmonic(&format!("{path}.mode"), wave.mode, run, problems);
    let key = format!("{path}.axial");
    if matches!(of, Part::End(..)) && wave.axial.is_some() && problems.is_as_written(&of_key) {
        nothing_along(&key, problems);
    }
    let axial = match wave.axial {
        None if of == Part::Geometry => Axial::HalfWaves(1),
        None | Some(spec::Axial::Uniform) => Axial::Uniform,
        Some(spec::Axial::HalfSine) => Axial::HalfWaves(1),
        Some(spec::Axial::Zone(written)) => {
            let key = format!("{key}.zone");
            Axial::Zone(zone(&key, spec, written, tube.length, problems))
        }
    };
    let phase = wave.phase_degrees.to_radians();
    Shape::Wave(Wave::new(wave.mode, phase, axial))
}

/// A random shape, in harmonics that the run has.
fn random(
    path: &str,
    random: spec::Random,
    of: Part,
    run: (&Mesh, Symmetry),
    problems: &mut Problems,
) -> Shape {
    let of_key = format!("{path}.of");
    let path = format!("{path}.shape.random");
    let (mesh, symmetry) = run;
    let key = format!("{path}.modes");
    let told_apart = match symmetry {
        Symmetry::Axisymmetric => 0,
        Symmetry::Fold(_) | Symmetry::None => mesh.around / 4,
    };
    let usual = spec::Random::usual_count();
    let harmonics = random.modes.unwrap_or(usual.min(told_apart));
    check_highest(&key, harmonics, run, problems);
    let end = matches!(of, Part::End(..));
    if end && random.half_waves.is_some() && problems.is_as_written(&of_key) {
        nothing_along(&format!("{path}.half_waves"), problems);
    }
    let half_waves = random.half_waves.unwrap_or(usual);
    let half_waves = if end {
        0
    } else {
        half_waves.min(LARGEST_COUNT)
    };
    // Any number does where something was found wrong.
    let harmonics = harmonics.min(mesh.around / 4).min(LARGEST_COUNT);
    let fold = match symmetry {
        Symmetry::Fold(m) => m.max(1),
        Symmetry::Axisymmetric | Symmetry::None => 1,
    };
    Shape::Random(Random::new(random.seed, harmonics, half_waves, fold))
}

/// A mode, if it is one of this tube and of a harmonic that the run has.
fn mode(
    path: &str,
    wanted: Wanted<'_>,
    of: Part,
    tube: &Tube,
    (mesh, symmetry): (&Mesh, Symmetry),
    open: &Open<'_>,
    problems: &mut Problems,
) -> Option<(Shape, ModeShape)> {
    let key = format!("{path}.shape.mode");
    let Wanted::Mode(imperfection, file) = wanted else {
        return None;
    };
    if !problems.is_as_written(&key) {
        return None;
    }
    let read = open(wanted).and_then(|state| Ok((state.mode()?, state)));
    let (mode, state) = match read {
        Ok(read) => read,
        Err(error) => {
            let cure = "give the path of a mode that plica stability has left in a run, \
                 modes/mode-NN-harmonic-N.safetensors, from the case file on";
            problems.value(&key, error.to_string(), Some(cure.into()));
            return None;
        }
    };
    if of != Part::Geometry {
        if problems.is_as_written(&format!("{path}.of")) {
            let rule = "only an imperfect geometry can have the shape of a mode";
            problems.key(&key, rule, Some("write of = \"geometry\"".into()));
        }
        return None;
    }
    let n = mode.harmonic;
    let about_others = ["symmetry", "tube.length", "tube.thickness", "tube.diameter"];
    if problems.none_about(&about_others) {
        check_size(&key, &state, tube, problems);
        let most = mesh.around / 4;
        let wrong = match symmetry {
            Symmetry::Axisymmetric if n > 0 => {
                Some("an axisymmetric run has harmonic 0 only".to_owned())
            }
            Symmetry::Fold(m) if m > 0 && !n.is_multiple_of(m) => {
                Some(format!("the tube repeats {m} times around"))
            }
            _ => None,
        };
        if let Some(wrong) = wrong {
            let rule = format!("is of harmonic {n}, and {wrong}");
            let cure = match n {
                0 | 1 => NO_SYMMETRY.to_owned(),
                n => format!("use symmetry = {{ fold = {n} }}, or \"none\""),
            };
            problems.value(&key, rule, Some(cure));
        } else if n > most && problems.none_about(&["mesh.control_points.around"]) {
            let around = mesh.around;
            let rule = format!(
                "is of harmonic {n}, and {around} control points around the tube draw at most {most}"
            );
            problems.value(&key, rule, Some(format!("try {} points around", 4 * n)));
        }
    }
    let named = ModeShape {
        imperfection,
        file: file.to_owned(),
        state,
    };
    Some((Shape::Mode(mode), named))
}

/// As in the table of keys.
const LARGEST_COUNT: usize = 50;
const NO_SYMMETRY: &str = "use symmetry = \"none\"";

fn nothing_along(key: &str, problems: &mut Problems) {
    let rule = "an end is one cross-section, and nothing is spread along it";
    problems.key(key, rule, Some("leave it out".into()));
}

/// Whether a harmonic keeps the symmetry of the run, and the mesh draws it.
fn check_harmonic(key: &str, n: usize, run: (&Mesh, Symmetry), problems: &mut Problems) {
    if let Symmetry::Fold(m) = run.1
        && m > 0
        && !n.is_multiple_of(m)
    {
        if problems.none_about(&[key, "symmetry"]) {
            let rule =
                format!("must be a multiple of {m}, since the tube repeats {m} times around");
            let cure = format!("try {m}, or use another symmetry");
            problems.value(key, rule, Some(cure));
        }
        return;
    }
    check_highest(key, n, run, problems);
}

/// Whether a highest harmonic is one that the run has, and the mesh draws it.
fn check_highest(
    key: &str,
    n: usize,
    (mesh, symmetry): (&Mesh, Symmetry),
    problems: &mut Problems,
) {
    const AROUND: &str = "mesh.control_points.around";
    if !problems.none_about(&[key, "symmetry", AROUND]) {
        return;
    }
    if symmetry == Symmetry::Axisymmetric && n > 0 {
        let rule = "an axisymmetric run has harmonic 0 only";
        problems.value(key, rule, Some(NO_SYMMETRY.into()));
    } else if n > mesh.around / 4 {
        let rule = format!(
            "must be at most {}, a quarter of the {} control points around the tube",
            mesh.around / 4,
            mesh.around
        );
        let cure = format!("try {} points around", 4 * n);
        problems.value(key, rule, Some(cure));
    }
}

/// Whether the imperfections of the geometry, all together, leave a wall.
pub(super) fn check_wall(
    spec: &Spec,
    tube: &Tube,
    (mesh, symmetry): (&Mesh, Symmetry),
    problems: &mut Problems,
) {
    let of_geometry = |imperfection: &Imperfection| imperfection.of == Part::Geometry;
    let Some(last) = tube.imperfections.iter().rposition(of_geometry) else {
        return;
    };
    // Elements are denser in the zones of the muscles.
    if !problems.none_about(&["imperfections", "tube", "mesh", "symmetry", "muscles"]) {
        return;
    }
    // On a large mesh it takes long: first what is told at once.
    let large = mesh.axial * mesh.thickness * mesh.rings(symmetry) > LARGE;
    if large && !problems.is_empty() {
        return;
    }
    if let Some(at) = inverted_by_imperfections(tube, mesh, symmetry) {
        let z = tidy(at.place.z * spec.tube.diameter);
        let near = at.place.angle_and_depth();
        let rule = format!("with it the stress-free wall is folded over, near z = {z}, {near}");
        let key = format!("imperfections[{}].amplitude", last + 1);
        problems.value(&key, rule, Some("make it smaller".into()));
    }
}

/// Whether the wall can take the targets of the stages where an imperfect muscle is strongest.
pub(super) fn check_stretches(tube: &Tube, stages: &[Stage], problems: &mut Problems) {
    if !problems.none_about(&["imperfections", "start", "tube.length", "tube.diameter"]) {
        return;
    }
    for (m, muscle) in tube.muscles.iter().enumerate() {
        let own = |i: &&Imperfection| i.of == Part::Muscle(m);
        let strongest = 1.0
            + tube
                .imperfections
                .iter()
                .filter(own)
                .map(|i| i.amplitude.abs())
                .sum::<f64>();
        if strongest == 1.0 {
            continue;
        }
        let drives = (1..=stages.len()).map(|i| format!("stages[{i}].drive.{}", muscle.name));
        let mut about: Vec<String> = drives.collect();
        about.push(format!("muscles.{}", muscle.name));
        if about.iter().any(|key| !problems.none_about(&[key])) {
            continue;
        }
        let smallest = stages
            .iter()
            .map(|stage| muscle.smallest_stretch(stage.load.muscles[m], tube.length))
            .fold(1.0, f64::min);
        let smallest = 1.0 - strongest * (1.0 - smallest);
        if smallest < SMALLEST_STRETCH {
            let last = tube
                .imperfections
                .iter()
                .rposition(|i| own(&i))
                .unwrap_or_default();
            let rule = format!(
                "where it is strongest, {} shrinks the wall to {} of its size, {SMALLEST_STRETCH} at least",
                muscle.name,
                tidy(smallest)
            );
            problems.value(
                &format!("imperfections[{}].amplitude", last + 1),
                rule,
                None,
            );
        }
    }
}
