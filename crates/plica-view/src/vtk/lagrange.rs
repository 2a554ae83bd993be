//! Node numbering of Lagrange hexahedra.

/// Corners of a hexahedron: around the lower face, then around the upper one.
const CORNERS: [[usize; 3]; 8] = [
    [0, 0, 0],
    [1, 0, 0],
    [1, 1, 0],
    [0, 1, 0],
    [0, 0, 1],
    [1, 0, 1],
    [1, 1, 1],
    [0, 1, 1],
];

/// Edges from corner to corner.
const EDGES: [[usize; 2]; 12] = [
    [0, 1],
    [1, 2],
    [3, 2],
    [0, 3],
    [4, 5],
    [5, 6],
    [7, 6],
    [4, 7],
    [0, 4],
    [1, 5],
    [2, 6],
    [3, 7],
];

/// Returns the nodes (i, j, k), each from 0 to `degree`, of a Lagrange hexahedron in the order of VTK: corners, edges,
/// faces (normal to i, j, k, the lower one first), interior; the first index varies fastest.
pub(super) fn lagrange_hexahedron(degree: usize) -> Vec<[usize; 3]> {
    let inner = 1..degree;
    let mut nodes: Vec<[usize; 3]> = CORNERS.map(|c| c.map(|x| x * degree)).to_vec();
    for [from, to] in EDGES.map(|edge| edge.map(|corner| CORNERS[corner])) {
        for step in inner.clone() {
            nodes.push([0, 1, 2].map(|i| from[i] * (degree - step) + to[i] * step));
        }
    }
    for normal in 0..3 {
        let [first, second] = [[1, 2], [0, 2], [0, 1]][normal];
        for side in [0, degree] {
            for b in inner.clone() {
                for a in inner.clone() {
                    let mut node = [side; 3];
                    (node[first], node[second]) = (a, b);
                    nodes.push(node);
                }
            }
        }
    }
    for k in inner.clone() {
        for j in inner.clone() {
            nodes.extend(inner.clone().map(|i| [i, j, k]));
        }
    }
    nodes
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn every_node_occurs_once() {
        for degree in 1..=5 {
            let nodes = lagrange_hexahedron(degree);
            assert_eq!(nodes.len(), (degree + 1).pow(3));
            let distinct: BTreeSet<_> = nodes.iter().collect();
            assert_eq!(distinct.len(), nodes.len());
            assert!(nodes.iter().flatten().all(|&i| i <= degree));
        }
    }

    #[test]
    fn quadratic_nodes_have_the_order_of_vtk() {
        // Edge 9 starts at corner 1, edge 11 at corner 3; face 0 is normal to i.
        let nodes = lagrange_hexahedron(2);
        assert_eq!(nodes[8 + 9], [2, 0, 1]);
        assert_eq!(nodes[8 + 11], [0, 2, 1]);
        assert_eq!(nodes[20], [0, 1, 1]);
        assert_eq!(nodes[26], [1, 1, 1]);
    }
}
