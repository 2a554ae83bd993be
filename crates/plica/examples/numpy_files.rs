//! Results as NumPy files: the walls and the stress of a grown ring.
//!
//! A ring in plane strain (sliding ends) whose circular muscle has contracted uniformly to θη = 0.75 is a closed tube with
//! residual stress. Its energy per unit length follows from one equation in the radius.
//!
//! Expected: W = 1.32551829e-5 E·D² per unit length, from a one-dimensional integration to the digits shown.
//!
//! The program writes `outer_wall.npy` (points × (z, r)) and `hoop_stress.npy` (points through the wall × (radius at rest,
//! Cauchy stress)) to the directory named by its argument, or to the system's directory for temporary files. Read them with
//! `numpy.load`.

use plica::assembly::Point;
use plica::measure::{Face, Meridians};
use plica::{Study, case};
use std::error::Error;
use std::fs;
use std::path::Path;

const CASE: &str = "
    tube = { length = 0.2, thickness = 0.06 }
    ends = { colon = 'sliding', ileum = 'sliding' }
    mesh.control_points = { axial = 4, around = 60, thickness = 8 }
    [muscles.circular]
    direction = 'circular'
    zone = [0.0, 0.2]
    profile.table = [[0.0, 1.0], [1.0, 1.0]]
    [[stages]]
    steps = 5
    drive.circular.diameter_ratio = 0.75
";

/// Writes rows of two numbers as a NumPy file, version 1.0 of the format.
fn write_npy(path: &Path, rows: &[[f64; 2]]) -> std::io::Result<()> {
    let shape = format!("({}, 2)", rows.len());
    let mut header =
        format!("{{'descr': '<f8', 'fortran_order': False, 'shape': {shape}, }}").into_bytes();
    // The header ends with a line feed, and the data begins at a multiple of 64 bytes.
    header.resize((header.len() + 11).next_multiple_of(64) - 11, b' ');
    header.push(b'\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header);
    bytes.extend(rows.as_flattened().iter().flat_map(|x| x.to_le_bytes()));
    fs::write(path, bytes)
}

fn main() -> Result<(), Box<dyn Error>> {
    let directory = std::env::args_os().nth(1);
    let directory = directory.map_or_else(std::env::temp_dir, Into::into);
    let plan = case::read(CASE, "grown ring")?;
    let mut study = Study::new(&plan)?;
    let state = study.by_ref().last().ok_or("no state")??;
    let tube = study.tube();

    let z: Vec<f64> = (0..=20).map(|i| 0.01 * f64::from(i)).collect();
    let meridians = Meridians::of(tube, &state.load, &state.unknowns);
    let wall = &meridians.walls(Face::Outer, &[0.0], &z)[0];
    let outer: Vec<[f64; 2]> = wall.points.iter().map(|&(z, r)| [z, r]).collect();

    let stress = (0..=20).map(|i| {
        let radius = plan.tube.inner_radius() + plan.tube.thickness * f64::from(i) / 20.0;
        let (z, angle) = (0.1, 0.0);
        let sample = tube.sample(&state.load, &state.unknowns, Point { z, radius, angle });
        [radius, sample.stress.0[2][2]]
    });
    let stress: Vec<[f64; 2]> = stress.collect();

    write_npy(&directory.join("outer_wall.npy"), &outer)?;
    write_npy(&directory.join("hoop_stress.npy"), &stress)?;
    println!("written to {}", directory.display());
    let energy = state.energy / plan.tube.length;
    println!("W = {energy:.6e} E·D² per unit length (expected 1.325518e-5)");
    Ok(())
}
