//! The numbers of a patch in a row of the history.

use super::table::{Quantity, Visitor};

/// The numbers of a patch in a row.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PatchRow {
    /// Its name in the case.
    pub name: String,
    /// Stress-free thickness over the thickness at rest in its middle.
    pub growth_through: f64,
    /// Work that its growth has done so far.
    pub work: f64,
}

impl PatchRow {
    /// Visits the columns other than that of the work.
    pub(super) fn visit(&mut self, v: &mut impl Visitor) {
        let name = format!("growth_through_{}", self.name);
        v.cell(&name, Quantity::Ratio, &mut self.growth_through);
    }
}
