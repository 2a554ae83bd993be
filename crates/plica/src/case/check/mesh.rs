//! The mesh and what repeats around it.

use super::super::problem::Problems;
use super::super::spec::{self, Refine, Spec};
use super::zone;
use crate::spline::Refinement;
use crate::tube::{Integration, Mesh, Symmetry, Tube};

/// Control points of the sector that is solved, at most: some 100 GB.
const LARGEST: usize = 20_000_000;

const AXIAL: &str = "mesh.control_points.axial";
const AROUND: &str = "mesh.control_points.around";
const THICKNESS: &str = "mesh.control_points.thickness";
const DEGREE: &str = "mesh.degree";

/// The mesh, and the symmetry of the run.
pub(super) fn mesh(spec: &Spec, tube: &Tube, problems: &mut Problems) -> (Mesh, Symmetry) {
    let points = spec.mesh.control_points;
    let mesh = Mesh {
        axial: points.axial,
        around: points.around,
        thickness: points.thickness,
        degree: spec.mesh.degree,
        refinements: refinements(spec, tube, problems),
        volumetric: match spec.mesh.volumetric_integration {
            spec::Integration::Full => Integration::Full,
            spec::Integration::Reduced => Integration::Reduced,
        },
    };
    let symmetry = match spec.symmetry {
        spec::Symmetry::Axisymmetric => Symmetry::Axisymmetric,
        spec::Symmetry::Fold(m) => Symmetry::Fold(m),
        spec::Symmetry::None => Symmetry::None,
    };
    let degree = mesh.degree;
    for (key, count) in [(AXIAL, mesh.axial), (THICKNESS, mesh.thickness)] {
        if count <= degree && problems.none_about(&[key, DEGREE]) {
            let rule = format!("must be above the degree of the splines, {degree}");
            problems.value(key, rule, Some(format!("try {}", 2 * degree + 2)));
        }
    }
    if mesh.around < 2 * degree + 2 && problems.none_about(&[AROUND, DEGREE]) {
        let rule = format!("must be at least {} for degree {degree}", 2 * degree + 2);
        problems.value(AROUND, rule, Some("try 60".into()));
    }
    if mesh.volumetric == Integration::Reduced
        && ![3, 5].contains(&degree)
        && problems.none_about(&["mesh.volumetric_integration", DEGREE])
    {
        let rule = format!("there is such a rule for splines of degree 3 and 5, not for {degree}");
        let cure = "try degree 3, or \"full\"".to_owned();
        problems.value("mesh.volumetric_integration", rule, Some(cure));
    }
    if let Symmetry::Fold(m) = symmetry
        && !mesh.around.is_multiple_of(m)
        && problems.none_about(&["symmetry", AROUND])
    {
        let around = mesh.around;
        let rule = format!("must divide the {around} control points around the tube");
        let cure = format!("try {} points around", around.next_multiple_of(m));
        problems.value("symmetry.fold", rule, Some(cure));
    }
    if problems.none_about(&["mesh.control_points", DEGREE, "symmetry"]) {
        let solved = mesh.axial * mesh.thickness * mesh.rings(symmetry);
        if solved > LARGEST {
            let rule = format!("{solved} control points to solve for, {LARGEST} at most");
            problems.key("mesh.control_points", rule, None);
        }
    }
    (mesh, symmetry)
}

/// Where elements are denser: as written, or in the zones of the muscles.
fn refinements(spec: &Spec, tube: &Tube, problems: &mut Problems) -> Vec<Refinement> {
    let Some(list) = &spec.mesh.refine else {
        return in_zones(tube);
    };
    let mut refinements = Vec::new();
    for (i, refine) in list.iter().enumerate() {
        let key = format!("mesh.refine[{}].zone", i + 1);
        let [from, to] = zone(&key, spec, refine.zone, tube.length, problems);
        let factor = refine.factor;
        refinements.push(Refinement { from, to, factor });
    }
    refinements
}

/// The zones of the muscles, cut where a profile has a kink, so that elements end there.
fn in_zones(tube: &Tube) -> Vec<Refinement> {
    let mut refinements = Vec::new();
    for muscle in &tube.muscles {
        let [a, b] = muscle.zone;
        let mut cuts = vec![a];
        cuts.extend(muscle.profile.kinks().iter().map(|x| a + x * (b - a)));
        cuts.push(b);
        for cut in cuts.windows(2).filter(|cut| cut[0] < cut[1]) {
            let refinement = Refinement {
                from: cut[0],
                to: cut[1],
                factor: Refine::usual_factor(),
            };
            if !refinements.contains(&refinement) {
                refinements.push(refinement);
            }
        }
    }
    refinements
}
