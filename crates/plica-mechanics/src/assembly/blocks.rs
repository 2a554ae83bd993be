//! Moduli on displacement gradients as 3×3 blocks, and their rotation to control rings.

use crate::rings::Rotation;
use crate::tensor::{Real, Tensor2};

/// A 3×3 block.
pub type Block<V> = [[V; 3]; 3];

/// Adds Gᵣᵀ A Gₛ for every pair of gradients; for r = s only the pairs on and above the diagonal.
#[inline(always)]
pub fn add_rotated<V: Real>(
    sum: &mut [[Block<V>; 3]; 3],
    blocks: &[Block<V>; 6],
    r: &Rotation,
    s: &Rotation,
    same: bool,
) {
    const UPPER: [(usize, usize); 6] = [(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)];
    for (block, (alpha, beta)) in blocks.iter().zip(UPPER) {
        add_block(
            &mut sum[alpha][beta],
            block,
            (r, slope(alpha)),
            (s, slope(beta)),
        );
        if !same && alpha != beta {
            let transposed = Tensor2(*block).transpose().0;
            add_block(
                &mut sum[beta][alpha],
                &transposed,
                (r, slope(beta)),
                (s, slope(alpha)),
            );
        }
    }
}

/// Returns 1 for the gradient over s, which needs the slope around of a ring's functions, 0 for ζ
/// and R, which need the value.
#[inline(always)]
fn slope(gradient: usize) -> usize {
    usize::from(gradient == 1)
}

/// sum += Gᵣᵀ block Gₛ with G = [[g, 0, 0], [0, a, b], [0, c, d]].
#[inline(always)]
fn add_block<V: Real>(
    sum: &mut Block<V>,
    block: &Block<V>,
    (r, dr): (&Rotation, usize),
    (s, ds): (&Rotation, usize),
) {
    let plain = |x: f64| block[0][0].like(x);
    let (gr, [ar, br, cr, dr]) = (r.axial[dr], r.plane[dr].map(plain));
    let (gs, [as_, bs, cs, ds]) = (plain(s.axial[ds]), s.plane[ds].map(plain));
    let mut half = *block;
    for j in 0..3 {
        half[0][j] = block[0][j].times(gr);
        half[1][j] = ar.mul_add(block[1][j], cr * block[2][j]);
        half[2][j] = br.mul_add(block[1][j], dr * block[2][j]);
    }
    for i in 0..3 {
        sum[i][0] = half[i][0].mul_add(gs, sum[i][0]);
        sum[i][1] = half[i][1].mul_add(as_, half[i][2].mul_add(cs, sum[i][1]));
        sum[i][2] = half[i][1].mul_add(bs, half[i][2].mul_add(ds, sum[i][2]));
    }
}

/// Fills the pairs of gradients below the diagonal from those above.
#[inline(always)]
pub fn mirror<V: Copy>(sum: &mut [[Block<V>; 3]; 3]) {
    for alpha in 0..3 {
        for beta in 0..alpha {
            for i in 0..3 {
                for j in 0..3 {
                    sum[alpha][beta][i][j] = sum[beta][alpha][j][i];
                }
            }
        }
    }
}
