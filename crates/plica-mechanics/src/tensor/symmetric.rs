//! Eigenvalues and eigenvectors of symmetric tensors.

use super::Tensor2;

/// Sweeps; three or four reach rounding.
const SWEEPS: usize = 12;

impl Tensor2 {
    /// Returns the eigenvalues, largest first, and unit eigenvectors of a symmetric tensor, by Jacobi
    /// rotations. Reads only the upper triangle. The eigenvectors form a right-handed basis.
    pub fn eigenpairs(self) -> [(f64, [f64; 3]); 3] {
        let mut a = self.0;
        for i in 0..3 {
            for j in 0..i {
                a[i][j] = a[j][i];
            }
        }
        let mut v = Self::IDENTITY.0;
        let size = a.iter().flatten().fold(0.0_f64, |m, x| m.max(x.abs()));
        for _ in 0..SWEEPS {
            let off = a[0][1].abs().max(a[0][2].abs()).max(a[1][2].abs());
            if off <= f64::EPSILON * size * 1e-3 {
                break;
            }
            for (p, q) in [(0, 1), (0, 2), (1, 2)] {
                if a[p][q] == 0.0 {
                    continue;
                }
                // The smaller of the two angles that make a[p][q] zero.
                let tau = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
                let t = tau.signum() / (tau.abs() + tau.hypot(1.0));
                let c = 1.0 / t.hypot(1.0);
                let s = t * c;
                for row in &mut a {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
                for j in 0..3 {
                    (a[p][j], a[q][j]) = (c * a[p][j] - s * a[q][j], s * a[p][j] + c * a[q][j]);
                }
                for row in &mut v {
                    (row[p], row[q]) = (c * row[p] - s * row[q], s * row[p] + c * row[q]);
                }
            }
        }
        let mut pairs = [0, 1, 2].map(|i| (a[i][i], [v[0][i], v[1][i], v[2][i]]));
        pairs.sort_by(|a, b| b.0.total_cmp(&a.0));
        let [(_, x), (_, y), (_, z)] = &mut pairs;
        let across = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            x[j] * y[k] - x[k] * y[j]
        });
        if across[0] * z[0] + across[1] * z[1] + across[2] * z[2] < 0.0 {
            *z = z.map(|z| -z);
        }
        pairs
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(a: [[f64; 3]; 3]) -> [f64; 3] {
        let pairs = Tensor2(a).eigenpairs();
        for (i, (value, x)) in pairs.iter().enumerate() {
            for row in 0..3 {
                let ax: f64 = (0..3).map(|j| a[row][j] * x[j]).sum();
                assert!((ax - value * x[row]).abs() < 1e-14 * 10.0, "{a:?}");
            }
            for (j, (_, y)) in pairs.iter().enumerate() {
                let dot: f64 = (0..3).map(|k| x[k] * y[k]).sum();
                assert!((dot - f64::from(u8::from(i == j))).abs() < 1e-14);
            }
        }
        let [x, y, z] = pairs.map(|(_, x)| x);
        let vectors = Tensor2([x, y, z]);
        assert!((vectors.determinant() - 1.0).abs() < 1e-14);
        pairs.map(|(value, _)| value)
    }

    #[test]
    fn eigenpairs_satisfy_their_equation() {
        assert_eq!(
            check([[1.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 2.0]]),
            [3.0, 2.0, 1.0]
        );
        check([[2.0, 0.3, -0.7], [0.3, 1.0, 0.4], [-0.7, 0.4, -1.5]]);
        check([[1.0, 1e-9, 0.0], [1e-9, 1.0, 1e-12], [0.0, 1e-12, 1.0]]);
        check([[0.0; 3]; 3]);
        // A double eigenvalue: 1 + 3 nn for a unit vector n.
        let n = [2.0 / 3.0, -1.0 / 3.0, 2.0 / 3.0];
        let a =
            [0, 1, 2].map(|i| [0, 1, 2].map(|j| f64::from(u8::from(i == j)) + 3.0 * n[i] * n[j]));
        let values = check(a);
        assert!((values[0] - 4.0).abs() < 1e-14 && (values[2] - 1.0).abs() < 1e-14);
    }
}
