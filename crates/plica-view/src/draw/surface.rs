//! Surfaces with a field.

use super::DrawError;
use super::vec3::{cross, minus, unit};

/// A structured grid of quadrilaterals with the values of a field.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Points along a row.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// `rows * columns` points, row by row, in units of D. Triangles with a point that is not finite are left out.
    pub points: Vec<[f64; 3]>,
    /// Field values at the points; NaN is drawn grey.
    pub values: Vec<f64>,
    /// Visible sides.
    pub sides: Sides,
}

/// Visible sides of a surface. The normal is the cross product of the direction along a row and that from row to row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Sides {
    /// Both sides.
    #[default]
    Both,
    /// The side that the normal points to; the other one is inside a body.
    Front,
    /// The side opposite to the normal.
    Back,
}

impl Surface {
    /// Checks the lengths of the lists.
    ///
    /// # Errors
    /// [`DrawError::Grid`] if they do not match the grid.
    pub(super) fn check(&self) -> Result<(), DrawError> {
        let Surface { columns, rows, .. } = *self;
        let (points, values) = (self.points.len(), self.values.len());
        let expected = columns.checked_mul(rows);
        if expected == Some(points) && expected == Some(values) {
            return Ok(());
        }
        // Report zero if the product overflows, because the message multiplies again.
        let (columns, rows) = if expected.is_some() {
            (columns, rows)
        } else {
            (0, 0)
        };
        Err(DrawError::Grid {
            columns,
            rows,
            points,
            values,
        })
    }

    /// Returns unit normals at the points, computed by differences along the grid; zero where the grid is degenerate.
    pub(super) fn normals(&self) -> Vec<[f64; 3]> {
        let (m, n) = (self.columns, self.rows);
        let at = |row: usize, column: usize| self.points[row * m + column];
        let mut normals = Vec::with_capacity(self.points.len());
        for row in 0..n {
            for column in 0..m {
                let along = minus(
                    at(row, (column + 1).min(m - 1)),
                    at(row, column.saturating_sub(1)),
                );
                let across = minus(
                    at((row + 1).min(n - 1), column),
                    at(row.saturating_sub(1), column),
                );
                normals.push(unit(cross(along, across)));
            }
        }
        normals
    }
}
