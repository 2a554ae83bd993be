//! The order in which a sparse symmetric matrix is eliminated, and the rows that its factor then has.

use std::collections::BTreeSet;

/// An elimination order of small fill, and the pattern of the factor L in it.
///
/// The order is one of minimum degree: the next row is always one that couples with the fewest rows still
/// left, of these the first. It is then rearranged by a postorder of the elimination tree, in which the
/// parent of a row is the first of the rows under its diagonal. This keeps the fill, and makes the rows
/// under a diagonal lie in long runs.
#[derive(Clone, Debug)]
pub struct Elimination {
    /// The row eliminated at each step.
    pub order: Vec<usize>,
    /// For each step, the later steps whose rows its column of L contains, in increasing order.
    pub below: Vec<Vec<usize>>,
}

impl Elimination {
    /// Orders a matrix of `rows` rows with a band of half-width `band` and the couplings `far` outside it.
    ///
    /// Without far couplings the order is the natural one.
    pub fn of(rows: usize, band: usize, far: impl Iterator<Item = (usize, usize)>) -> Self {
        let near = |i: usize| i.saturating_sub(band)..(i + band + 1).min(rows);
        let mut graph: Vec<Vec<usize>> = (0..rows)
            .map(|i| near(i).filter(|&j| j != i).collect())
            .collect();
        for (i, j) in far {
            graph[i].push(j);
            graph[j].push(i);
        }
        for neighbours in &mut graph {
            neighbours.sort_unstable();
            neighbours.dedup();
        }
        let first_order = eliminate(&mut graph);
        // The graph of an eliminated row now holds the rows below its diagonal.
        let order = postorder(&first_order, &graph);
        let step = inverse(&order);
        let below = order
            .iter()
            .map(|&row| {
                let mut steps: Vec<usize> = graph[row].iter().map(|&i| step[i]).collect();
                steps.sort_unstable();
                steps
            })
            .collect();
        Self { order, below }
    }

    /// Returns the step that eliminates each row.
    pub fn steps(&self) -> Vec<usize> {
        inverse(&self.order)
    }
}

/// Returns the order of minimum degree, and leaves in `graph` the neighbours that each row has when it is
/// eliminated.
fn eliminate(graph: &mut [Vec<usize>]) -> Vec<usize> {
    let mut queue: BTreeSet<(usize, usize)> = (0..graph.len())
        .map(|row| (graph[row].len(), row))
        .collect();
    let mut order = Vec::with_capacity(graph.len());
    while let Some((_, row)) = queue.pop_first() {
        let clique = std::mem::take(&mut graph[row]);
        for &i in &clique {
            let mut union = [&graph[i][..], &clique].concat();
            union.sort_unstable();
            union.dedup();
            union.retain(|&j| j != i && j != row);
            if union.len() != graph[i].len() {
                queue.remove(&(graph[i].len(), i));
                queue.insert((union.len(), i));
            }
            graph[i] = union;
        }
        graph[row] = clique;
        order.push(row);
    }
    order
}

/// Returns a postorder of the elimination tree of `order`, where `below` holds the rows below each row's
/// diagonal. Subtrees keep their order.
fn postorder(order: &[usize], below: &[Vec<usize>]) -> Vec<usize> {
    let rows = order.len();
    let step = inverse(order);
    // Row `rows` stands for the root of all trees.
    let parent = |row: usize| {
        let first = below[row].iter().min_by_key(|&&i| step[i]);
        first.copied().unwrap_or(rows)
    };
    let mut subtree = vec![1; rows + 1];
    for &row in order {
        subtree[parent(row)] += subtree[row];
    }
    // The end of the places not yet taken by a subtree; its root has the last of them.
    let mut end = vec![rows; rows + 1];
    let mut result = vec![0; rows];
    for &row in order.iter().rev() {
        let parent = parent(row);
        let last = end[parent] - 1;
        end[parent] -= subtree[row];
        end[row] = last;
        result[last] = row;
    }
    result
}

fn inverse(order: &[usize]) -> Vec<usize> {
    let mut step = vec![0; order.len()];
    for (k, &row) in order.iter().enumerate() {
        step[row] = k;
    }
    step
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The couplings of two flanks of a fold at the middle of `rows` rows, `contact` rows a side, each
    /// with the mirror image of the other within one row.
    fn fold(rows: usize, contact: usize) -> Vec<(usize, usize)> {
        let from = rows / 2 - contact;
        (from..rows / 2)
            .flat_map(|i| {
                let mirror = rows - 1 - i;
                (mirror - 1..=mirror + 1).map(move |j| (j.max(i), j.min(i)))
            })
            .filter(|(i, j)| i - j > 3)
            .collect()
    }

    /// Eliminates in an order, without thought for cost.
    fn pattern(order: &[usize], coupled: impl Fn(usize, usize) -> bool) -> Vec<Vec<usize>> {
        let n = order.len();
        let mut full: Vec<Vec<bool>> = (0..n)
            .map(|i| (0..n).map(|j| coupled(order[i], order[j])).collect())
            .collect();
        for k in 0..n {
            for i in k + 1..n {
                for j in k + 1..n {
                    full[i][j] |= full[i][k] && full[k][j];
                }
            }
        }
        (0..n)
            .map(|k| (k + 1..n).filter(|&i| full[i][k]).collect())
            .collect()
    }

    #[test]
    fn a_band_is_eliminated_in_its_own_order() {
        let plan = Elimination::of(9, 3, [].into_iter());
        assert_eq!(plan.order, (0..9).collect::<Vec<_>>());
        for k in 0..9 {
            assert_eq!(plan.below[k], (k + 1..(k + 4).min(9)).collect::<Vec<_>>());
        }
    }

    #[test]
    fn the_pattern_is_that_of_the_factor() {
        for far in [fold(40, 12), vec![(30, 2), (17, 5), (39, 0), (39, 20)]] {
            let plan = Elimination::of(40, 3, far.iter().copied());
            let mut sorted = plan.order.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..40).collect::<Vec<_>>());
            let expected = pattern(&plan.order, |i, j| {
                i.abs_diff(j) <= 3 || far.contains(&(i.max(j), i.min(j)))
            });
            assert_eq!(plan.below, expected);
        }
    }

    #[test]
    fn rows_of_a_subtree_are_neighbours() {
        let plan = Elimination::of(40, 1, [(30, 2), (17, 5), (39, 20)].into_iter());
        let mut subtree = [1; 40];
        for k in 0..40 {
            // All rows of the subtree of k lie right before it, so its children end where another begins.
            let children = (0..k).filter(|&c| plan.below[c].first() == Some(&k));
            let mut end = k;
            for c in children.collect::<Vec<_>>().into_iter().rev() {
                assert_eq!(c + 1, end);
                end -= subtree[c];
                subtree[k] += subtree[c];
            }
        }
    }

    #[test]
    fn the_fill_of_a_fold_is_that_of_a_band_of_twice_the_width() {
        let far = fold(305, 40);
        let plan = Elimination::of(305, 3, far.into_iter());
        let tallest = plan.below.iter().map(Vec::len).max();
        assert_eq!(tallest, Some(6));
    }
}
