//! KNOWN: a sparse pencil whose spectrum is chosen.

use crate::model::{Assembler, Model};
use crate::random::SplitMix64;

/// KNOWN(n, Λ, seed): M = CᵀC and K = Cᵀ diag(Λ) C with a sparse unit lower triangular C.
///
/// The entries of C are multiples of 1/8 with at most 3/4 in a row below the diagonal, so M is exact in floating point and
/// ‖C⁻¹‖ ≤ 4 in the row-sum norm: the spectrum is Λ up to the rounding of K, a few ε of the largest. The model has no
/// nodes.
///
/// # Panics
/// If there are more than u32::MAX eigenvalues.
pub fn known(lambda: &[f64], seed: u64) -> Model {
    let n = u32::try_from(lambda.len()).expect("rows fit 32 bits");
    let mut random = SplitMix64::new(seed);
    let (mut stiffness, mut mass) = (Assembler::default(), Assembler::default());
    for (row, &value) in (0..n).zip(lambda) {
        let mut terms = vec![(row, 1.0)];
        for distance in [1, 2 + random.below(4) as u32] {
            if let Some(column) = row.checked_sub(distance) {
                // −3/8 … 3/8 without zero, which would cut the chain.
                let eighths = 1.0 + random.below(3) as f64;
                let sign = if random.next_u64() & 1 == 0 { 1.0 } else { -1.0 };
                terms.push((column, sign * eighths / 8.0));
            }
        }
        for &(i, c_i) in &terms {
            for &(j, c_j) in &terms {
                mass.add(i, j, c_i * c_j);
                stiffness.add(i, j, c_i * c_j * value);
            }
        }
    }
    let mut model = Model::node_major(Vec::new(), &[], stiffness, mass);
    model.n = lambda.len();
    model
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dense::{largest_difference, spectrum};
    use crate::random::fnv1a;

    #[test]
    fn spectrum_is_the_chosen_one() {
        let mut lambda = vec![0.0, 0.0, 1.0, 1.0, 1.0, 1.0 + 1e-10, 2.5];
        lambda.extend((3..50).map(f64::from));
        let found = spectrum(&known(&lambda, fnv1a("known")));
        // ε times the largest eigenvalue times cond(C)², below 100 for this C.
        assert!(largest_difference(&found, &lambda) <= 49.0 * 100.0 * f64::EPSILON);
    }

    #[test]
    fn seed_decides() {
        assert_eq!(known(&[1.0, 2.0, 3.0, 4.0], 7), known(&[1.0, 2.0, 3.0, 4.0], 7));
        assert_ne!(known(&[1.0, 2.0, 3.0, 4.0], 7), known(&[1.0, 2.0, 3.0, 4.0], 8));
    }
}
