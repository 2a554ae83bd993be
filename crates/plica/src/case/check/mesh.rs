//! The mesh and the symmetry.

use super::super::keys::Case;
use super::super::problem::Problems;
use super::layers::mesh_layers;
use super::zone::zone;
use crate::spline::Refinement;
use crate::tube::{Integration, Mesh, Symmetry, Tube};

/// Largest number of control points that are solved for, which takes some 100 GB.
const LARGEST: usize = 20_000_000;
/// Control points through a wall without layers.
const POINTS_THROUGH: usize = 8;
/// Refinement of the zones of muscles.
const FACTOR: f64 = 3.0;

const AXIAL: &str = "mesh.control_points.axial";
const AROUND: &str = "mesh.control_points.around";
const THICKNESS: &str = "mesh.control_points.thickness";
const DEGREE: &str = "mesh.degree";
const GRADING: &str = "mesh.grading";
const INTEGRATION: &str = "mesh.volumetric_integration";

/// Returns the mesh, and the symmetry of the solution.
pub(super) fn mesh(case: &Case, tube: &Tube, problems: &mut Problems) -> (Mesh, Symmetry) {
    let points = &case.mesh.control_points;
    let (layers, degree) = (mesh_layers(case, &tube.layers), case.mesh.degree);
    let thickness = match (&layers[..], &case.layers[..]) {
        ([], []) => points.thickness.unwrap_or(POINTS_THROUGH),
        ([], written) => written[0].elements + degree,
        (layers, _) => Mesh::points_through(degree, layers),
    };
    if !case.layers.is_empty() && points.thickness.is_some() && problems.are_sound(&[THICKNESS]) {
        let rule = "cannot be given for a wall with layers";
        problems.key(THICKNESS, rule, "give each layer its number of elements");
    }
    let mesh = Mesh {
        axial: points.axial,
        around: points.around,
        thickness,
        degree: case.mesh.degree,
        refinements: refinements(case, tube, problems),
        grading: case.mesh.grading,
        contact_range: case.mesh.contact_range,
        volumetric: case.mesh.volumetric_integration,
        layers,
    };
    let (degree, around) = (mesh.degree, mesh.around);
    for (key, count) in [(AXIAL, mesh.axial), (THICKNESS, mesh.thickness)] {
        if count <= degree && problems.are_sound(&[key, DEGREE]) {
            let rule = format!("must be above the degree of the splines, {degree}");
            problems.value(key, rule, format!("try {}", 2 * degree + 2));
        }
    }
    if around < 2 * degree + 2 && problems.are_sound(&[AROUND, DEGREE]) {
        let rule = format!("must be at least {} for degree {degree}", 2 * degree + 2);
        problems.value(AROUND, rule, "try 60");
    }
    if mesh.volumetric == Integration::Reduced
        && ![3, 5].contains(&degree)
        && problems.are_sound(&[INTEGRATION, DEGREE])
    {
        let rule = format!("needs splines of degree 3 or 5, not {degree}");
        problems.value(INTEGRATION, rule, "try degree 3, or \"full\"");
    }
    if mesh.volumetric == Integration::Reduced
        && mesh.grading != 1.0
        && problems.are_sound(&[INTEGRATION, GRADING])
    {
        let rule = "needs elements of one thickness, grading 1";
        problems.value(INTEGRATION, rule, "try \"full\"");
    }
    if mesh.layers.len() > 1 && mesh.grading != 1.0 && problems.are_sound(&[GRADING]) {
        let help = "give a layer more elements instead";
        problems.value(GRADING, "must be 1 for a wall with several layers", help);
    }
    if let Symmetry::Fold(m) = case.symmetry
        && !around.is_multiple_of(m)
        && problems.are_sound(&["symmetry", AROUND])
    {
        let rule = format!("must divide the {around} control points around the tube");
        let help = format!("try {} points around", around.next_multiple_of(m));
        problems.value("symmetry.fold", rule, help);
    }
    if problems.are_sound(&["mesh.control_points", DEGREE, "symmetry", "layers"]) {
        let solved = mesh.axial * mesh.thickness * mesh.rings(case.symmetry);
        if solved > LARGEST {
            let rule = format!("{solved} control points to solve for, {LARGEST} at most");
            problems.key("mesh.control_points", rule, "");
        }
    }
    (mesh, case.symmetry)
}

/// Returns the zones with smaller elements: as written, or those of the muscles.
fn refinements(case: &Case, tube: &Tube, problems: &mut Problems) -> Vec<Refinement> {
    let Some(list) = &case.mesh.refine else {
        return zones_of_muscles(case, tube);
    };
    let mut refinements = Vec::new();
    for (i, refine) in list.iter().enumerate() {
        let key = format!("mesh.refine[{}].zone", i + 1);
        let [from, to] = zone(&key, case, refine.zone, tube.length, problems);
        let factor = refine.factor;
        refinements.push(Refinement { from, to, factor });
    }
    refinements
}

/// Returns the zones of the muscles, cut at the kinks of profiles, so that elements end there. Zones that move or repeat
/// have no elements of their own.
fn zones_of_muscles(case: &Case, tube: &Tube) -> Vec<Refinement> {
    let mut refinements = Vec::new();
    for muscle in &tube.muscles {
        let drives = case
            .stages
            .iter()
            .filter_map(|stage| stage.drive.get(&muscle.name));
        if muscle.repeat.is_some() || drives.into_iter().any(|drive| drive.shift.is_some()) {
            continue;
        }
        let [a, b] = muscle.zone;
        let mut cuts = vec![a];
        cuts.extend(muscle.profile.kinks().iter().map(|x| a + x * (b - a)));
        cuts.push(b);
        for cut in cuts.windows(2).filter(|cut| cut[0] < cut[1]) {
            let refinement = Refinement {
                from: cut[0],
                to: cut[1],
                factor: FACTOR,
            };
            if !refinements.contains(&refinement) {
                refinements.push(refinement);
            }
        }
    }
    refinements
}
