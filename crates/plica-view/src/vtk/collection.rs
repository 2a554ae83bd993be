//! Collections of files, one per step.

use std::fmt::Write;

/// Returns a collection file (`.pvd`) for pairs of a step and the path of its file, relative to the collection.
pub fn collection<'a>(files: impl Iterator<Item = (usize, &'a str)>) -> String {
    let mut text = String::from(
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n <Collection>\n",
    );
    for (step, file) in files {
        let _ = writeln!(
            text,
            "  <DataSet timestep=\"{step}\" part=\"0\" file=\"{file}\"/>"
        );
    }
    text + " </Collection>\n</VTKFile>\n"
}
