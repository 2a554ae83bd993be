//! Where on a page there is ink: what has none need not be painted.

use super::canvas::Place;
use std::ops::Range;

/// Side of a cell of the page, in pixels.
const CELL: usize = 32;
/// As many cells without ink between two that have some are painted with them.
const BRIDGED: usize = 1;
/// Most cells of a block on top of each other: what is painted at a time stays small.
const TALL: usize = 8;

/// A rectangle on the page, in points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Patch {
    from: Place,
    to: Place,
}

impl Patch {
    /// Around places, and so far beyond; none around none.
    pub fn around(places: impl IntoIterator<Item = Place>, beyond: f64) -> Option<Self> {
        let patch = |p: Place| Self { from: p, to: p };
        let joined = places.into_iter().map(patch).reduce(|a, b| Self {
            from: (a.from.0.min(b.from.0), a.from.1.min(b.from.1)),
            to: (a.to.0.max(b.to.0), a.to.1.max(b.to.1)),
        })?;
        let finite = [joined.from, joined.to].map(|p| p.0.is_finite() && p.1.is_finite());
        (finite == [true; 2]).then_some(Self {
            from: (joined.from.0 - beyond, joined.from.1 - beyond),
            to: (joined.to.0 + beyond, joined.to.1 + beyond),
        })
    }
}

/// A block of pixels of a page.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Block {
    pub columns: Range<usize>,
    pub rows: Range<usize>,
}

impl Block {
    /// Whether a patch reaches into it, of a page with so many pixels per point, a pixel's smoothing included.
    pub fn meets(&self, patch: &Patch, per_point: f64) -> bool {
        let apart = |range: &Range<usize>, from: f64, to: f64| {
            to * per_point + 1.0 < range.start as f64 || from * per_point - 1.0 > range.end as f64
        };
        !apart(&self.columns, patch.from.0, patch.to.0)
            && !apart(&self.rows, patch.from.1, patch.to.1)
    }
}

/// Blocks that hold all patches, and do not overlap, of a page of so many pixels with so many per point.
pub(super) fn blocks<'a>(
    patches: impl Iterator<Item = &'a Patch>,
    [width, height]: [usize; 2],
    per_point: f64,
) -> Vec<Block> {
    let (across, down) = (width.div_ceil(CELL), height.div_ceil(CELL));
    let mut inked = vec![false; across * down];
    for Patch { from, to } in patches {
        // Rounded outwards, with a pixel for smoothing.
        let cells = |from: f64, to: f64, all: usize| {
            let first = ((from * per_point - 1.0).max(0.0) / CELL as f64) as usize;
            let last = ((to * per_point + 1.0).max(-1.0) / CELL as f64).floor();
            first..((last + 1.0) as usize).min(all)
        };
        let columns = cells(from.0, to.0, across);
        for row in cells(from.1, to.1, down) {
            if columns.start < columns.end {
                inked[row * across..][columns.clone()].fill(true);
            }
        }
    }
    // Blocks that may go on in the next row of cells, and those that do not.
    let (mut open, mut done): (Vec<Block>, Vec<Block>) = (vec![], vec![]);
    for (row, cells) in inked.chunks(across.max(1)).enumerate() {
        let rows = row * CELL..((row + 1) * CELL).min(height);
        let mut next = vec![];
        for run in runs(cells) {
            let columns = run.start * CELL..(run.end * CELL).min(width);
            let goes_on =
                |block: &Block| block.columns == columns && block.rows.len() < TALL * CELL;
            let top = match open.iter().position(goes_on) {
                Some(k) => open.swap_remove(k).rows.start,
                None => rows.start,
            };
            next.push(Block {
                columns,
                rows: top..rows.end,
            });
        }
        done.append(&mut open);
        open = next;
    }
    done.append(&mut open);
    done
}

/// Runs of cells that have ink, small gaps bridged.
fn runs(cells: &[bool]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = vec![];
    for (i, _) in cells.iter().enumerate().filter(|(_, inked)| **inked) {
        match runs.last_mut() {
            Some(run) if i <= run.end + BRIDGED => run.end = i + 1,
            _ => runs.push(i..i + 1),
        }
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;

    fn patch(from: Place, to: Place) -> Patch {
        Patch::around([from, to], 0.0).unwrap()
    }

    #[test]
    fn blocks_hold_every_patch_and_do_not_overlap() {
        let patches = [
            patch((10.0, 10.0), (300.0, 12.0)),
            patch((10.0, 10.0), (12.0, 250.0)),
            patch((120.0, 100.0), (140.0, 130.0)),
            // Partly or wholly beside the page.
            patch((-50.0, 290.0), (20.0, 900.0)),
            patch((-50.0, -50.0), (-40.0, -40.0)),
            patch((2000.0, 10.0), (2100.0, 20.0)),
        ];
        let size = [700, 620];
        let per_point = 2.0;
        let blocks = blocks(patches.iter(), size, per_point);
        let mut painted = vec![0; size[0] * size[1]];
        for block in &blocks {
            for row in block.rows.clone() {
                for column in block.columns.clone() {
                    painted[row * size[0] + column] += 1;
                }
            }
        }
        assert!(painted.iter().all(|times| *times <= 1));
        for patch in &patches {
            for row in 0..size[1] {
                for column in 0..size[0] {
                    let (x, y) = (column as f64 / per_point, row as f64 / per_point);
                    let within = (patch.from.0..=patch.to.0).contains(&x)
                        && (patch.from.1..=patch.to.1).contains(&y);
                    assert!(!within || painted[row * size[0] + column] == 1);
                }
            }
        }
        // Most of the page is bare.
        let share = painted.iter().sum::<usize>() as f64 / painted.len() as f64;
        assert!(share < 0.3, "{share}");
        for block in &blocks {
            assert!(patches.iter().any(|patch| block.meets(patch, per_point)));
            assert!(!block.meets(&patches[4], per_point));
        }
    }

    #[test]
    fn what_is_nowhere_has_no_ink() {
        assert_eq!(Patch::around([], 1.0), None);
        assert_eq!(Patch::around([(f64::NAN, 0.0)], 1.0), None);
        assert!(blocks([].iter(), [100, 100], 1.0).is_empty());
    }
}
