//! One-dimensional chains with exact spectra: BAR, SPRING and RING.

use std::f64::consts::PI;

use crate::model::{Assembler, Model};

/// How the ends of a spring chain are held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// Both end masses tied to the ground.
    Fixed,
    /// Nothing tied: one rigid-body mode.
    Free,
}

/// BAR(N): axial finite elements on the unit interval with both ends fixed, h = 1/(N + 1).
///
/// K = tridiag(−1, 2, −1)/h, M = tridiag(1, 4, 1) h/6.
pub fn bar(n: usize) -> Model {
    let h = 1.0 / (n as f64 + 1.0);
    let (mut stiffness, mut mass) = (Assembler::default(), Assembler::default());
    for i in 0..n as u32 {
        stiffness.add(i, i, 2.0 / h);
        mass.add(i, i, 4.0 * h / 6.0);
        if i + 1 < n as u32 {
            stiffness.add(i, i + 1, -1.0 / h);
            mass.add(i, i + 1, h / 6.0);
        }
    }
    chain(n, h, stiffness, mass)
}

/// Exact eigenvalues of [`bar`], ascending: (6/h²) s/(6 − s) with s = 4 sin²(kπh/2).
pub fn bar_spectrum(n: usize) -> Vec<f64> {
    let h = 1.0 / (n as f64 + 1.0);
    (1..=n)
        .map(|k| {
            let s = 4.0 * (k as f64 * PI * h / 2.0).sin().powi(2);
            6.0 / (h * h) * s / (6.0 - s)
        })
        .collect()
}

/// SPRING(N, ends): unit masses joined by unit springs.
pub fn spring(n: usize, ends: Ends) -> Model {
    let (mut stiffness, mut mass) = (Assembler::default(), Assembler::default());
    for i in 0..n as u32 {
        let springs = match ends {
            Ends::Fixed => 2.0,
            Ends::Free => f64::from(u8::from(i > 0) + u8::from(i + 1 < n as u32)),
        };
        stiffness.add(i, i, springs);
        mass.add(i, i, 1.0);
        if i + 1 < n as u32 {
            stiffness.add(i, i + 1, -1.0);
        }
    }
    chain(n, 1.0, stiffness, mass)
}

/// Exact eigenvalues of [`spring`], ascending: 4 sin²(kπ/(2(N + 1))) fixed, 4 sin²(kπ/(2N)) from k = 0 free.
pub fn spring_spectrum(n: usize, ends: Ends) -> Vec<f64> {
    let (first, parts) = match ends {
        Ends::Fixed => (1, n + 1),
        Ends::Free => (0, n),
    };
    (first..first + n).map(|k| 4.0 * (k as f64 * PI / (2.0 * parts as f64)).sin().powi(2)).collect()
}

/// RING(N, s): N ≥ 3 unit masses on a closed chain of unit springs, each tied to the ground by a spring s.
///
/// Every eigenvalue but the first, and the last of an even ring, is exactly double.
///
/// # Panics
/// If N < 3.
pub fn ring(n: usize, s: f64) -> Model {
    assert!(n >= 3, "a ring needs three masses, not {n}");
    let (mut stiffness, mut mass) = (Assembler::default(), Assembler::default());
    for i in 0..n as u32 {
        stiffness.add(i, i, 2.0 + s);
        mass.add(i, i, 1.0);
        if i + 1 < n as u32 {
            stiffness.add(i, i + 1, -1.0);
        }
    }
    stiffness.add(0, n as u32 - 1, -1.0);
    chain(n, 1.0, stiffness, mass)
}

/// Exact eigenvalues of [`ring`], ascending: s + 4 sin²(πk/N).
pub fn ring_spectrum(n: usize, s: f64) -> Vec<f64> {
    // k and N − k give one value; computing it once makes the pair equal to the bit.
    (0..n).map(|i| s + 4.0 * (PI * i.div_ceil(2) as f64 / n as f64).sin().powi(2)).collect()
}

/// Nodes along x with the direction ux alone.
fn chain(n: usize, h: f64, stiffness: Assembler, mass: Assembler) -> Model {
    let nodes = (1..=n).map(|i| [i as f64 * h, 0.0, 0.0]).collect();
    Model::node_major(nodes, &[0], stiffness, mass)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dense::{largest_difference, spectrum};

    // Jacobi rotations give every eigenvalue to a few ε of the largest.
    const RELATIVE_TO_LARGEST: f64 = 1e-14;

    #[test]
    fn spectra_are_exact() {
        for n in [3, 4, 17, 40] {
            for (model, exact) in [
                (bar(n), bar_spectrum(n)),
                (spring(n, Ends::Fixed), spring_spectrum(n, Ends::Fixed)),
                (spring(n, Ends::Free), spring_spectrum(n, Ends::Free)),
                (ring(n, 0.01), ring_spectrum(n, 0.01)),
                (ring(n, 0.0), ring_spectrum(n, 0.0)),
            ] {
                let largest = exact[n - 1];
                let difference = largest_difference(&spectrum(&model), &exact);
                assert!(
                    difference <= RELATIVE_TO_LARGEST * largest * n as f64,
                    "n = {n}: {difference:e} of {largest:e}"
                );
            }
        }
    }

    #[test]
    fn ring_pairs_are_equal_to_the_bit() {
        let exact = ring_spectrum(240, 0.01);
        assert!((1..239).step_by(2).all(|i| exact[i].to_bits() == exact[i + 1].to_bits()));
    }
}
