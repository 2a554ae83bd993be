//! Surfaces that carry a field.

use super::DrawError;
use super::light::{cross, minus, unit};

/// A structured grid of quadrilaterals that carries a field.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// Points along a row.
    pub columns: usize,
    /// Number of rows.
    pub rows: usize,
    /// `rows * columns` points, row after row, in units of D; a triangle with a point that is
    /// not finite is left out.
    pub points: Vec<[f64; 3]>,
    /// The field at the points; NaN is drawn grey.
    pub values: Vec<f64>,
    /// What of it can be seen.
    pub sides: Sides,
}

/// The sides of a surface that can be seen; its normal points along its rows × from row to row.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Sides {
    /// Either.
    #[default]
    Both,
    /// The one that the normal points to: the other is turned into a body.
    Front,
    /// The other one.
    Back,
}

impl Surface {
    /// Whether the lists fill the grid.
    ///
    /// # Errors
    /// [`DrawError::Grid`] if they do not.
    pub fn check(&self) -> Result<(), DrawError> {
        let Surface { columns, rows, .. } = *self;
        let (points, values) = (self.points.len(), self.values.len());
        let wanted = columns.checked_mul(rows);
        if wanted == Some(points) && wanted == Some(values) {
            return Ok(());
        }
        // A product past usize fits no list: report it as the grid it is, without overflowing the message.
        let (columns, rows) = if wanted.is_some() {
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

    /// Unit normals at the points from differences along the grid; zero where the grid is degenerate.
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
