//! Rigid-body motions of a reduced pencil without inertia: a straight beam of lumped masses turns about its own axis.
//!
//! ```text
//! S⁻¹ ÛᵀMÛ S⁻¹ = V Θ Vᵀ,  W = Û S⁻¹ V      S one root of the largest inertia for translations, one for rotations, one for all others
//! wᵀMw ≤ 10⁻²⁴ max wᵀMw,  ≤ c ε |w|ᵀ|M||w| + (c ε)² |ŵ|ᵀ|M||ŵ|,  ŵ = |Û||S⁻¹V|       no inertia
//! ```
//! The first is the criterion of the full model, the square of the rounding that the direction of a motion carries. The others are what
//! rounding of M and of the terms of W leave where the true inertia is none. Motions that are no unit motions of a body have unit inertia
//! or none, and are of one size whatever their number. The stiffness is no size here: where the interface just holds the component, it
//! has rounding alone.

use std::ops::Range;

use faer::{Mat, MatRef};

use crate::dense::{self, NOISE_FACTOR};
use crate::error::Result;

/// Modal masses relative to the largest below which a rigid motion has no inertia: the square of the rounding that the direction of the
/// motion carries, with a factor of ten thousand. A real one may be small next to a seismic mass.
pub(crate) const NO_MASS: f64 = 1e-24;

/// Rigid-body motions with and without inertia, r × k each; together they span Û.
#[derive(Clone, Debug)]
pub(crate) struct ByInertia {
    pub(crate) massive: Mat<f64>,
    pub(crate) massless: Mat<f64>,
}

impl ByInertia {
    /// Tells the motions of Û, r × n_r, apart. Where all have inertia they are those of Û as they are.
    ///
    /// # Errors
    /// A dense eigenproblem that does not converge.
    pub(crate) fn of(m: MatRef<'_, f64>, u: MatRef<'_, f64>) -> Result<Self> {
        let (r, n_r) = (u.nrows(), u.ncols());
        let as_they_are = || Self { massive: u.to_owned(), massless: Mat::zeros(r, 0) };
        if n_r == 0 {
            return Ok(as_they_are());
        }
        let mut gram = dense::gram(u, dense::product(m, u).as_ref());
        dense::symmetrise(&mut gram);
        let units = units(gram.as_ref());
        let scaled = Mat::from_fn(n_r, n_r, |i, j| gram[(i, j)] * units[i] * units[j]);
        let (_, vectors) = dense::symmetric_eigen(scaled.as_ref())?;
        let directions = Mat::from_fn(n_r, n_r, |i, j| units[i] * vectors[(i, j)]);
        let w = dense::product(u, directions.as_ref());
        // The inertia of the motions themselves: eigenvalues carry the rounding of the largest of them.
        let inertia =
            |m: MatRef<'_, f64>, w: &Mat<f64>| dense::dots(w.as_ref(), dense::product(m, w.as_ref()).as_ref());
        let (own, absolute) = (inertia(m, &w), dense::absolute(m));
        let terms = inertia(absolute.as_ref(), &dense::absolute(w.as_ref()));
        let of_terms = dense::product(dense::absolute(u).as_ref(), dense::absolute(directions.as_ref()).as_ref());
        let of_terms = inertia(absolute.as_ref(), &of_terms);
        let largest = own.iter().fold(0.0f64, |max, inertia| max.max(*inertia));
        let rounding = NOISE_FACTOR * f64::EPSILON;
        let is_massive = |j: &usize| {
            own[*j] > NO_MASS * largest && own[*j] > rounding * terms[*j] + rounding * rounding * of_terms[*j]
        };
        let (massive, massless): (Vec<usize>, Vec<usize>) = (0..n_r).partition(is_massive);
        Ok(match massless.is_empty() {
            true => as_they_are(),
            false => {
                Self { massive: dense::columns(w.as_ref(), &massive), massless: dense::columns(w.as_ref(), &massless) }
            }
        })
    }
}

/// Three translations, three rotations, and what follows; of fewer motions than a body has, all together.
fn units(gram: MatRef<'_, f64>) -> Vec<f64> {
    let n = gram.ncols();
    let groups = match n {
        0..6 => [0..0, 0..0, 0..n],
        _ => [0..3, 3..6, 6..n],
    };
    let of_group = |group: Range<usize>| {
        let largest = group.clone().map(|j| gram[(j, j)]).fold(0.0, f64::max);
        group.map(move |_| dense::power_of_two_root(largest))
    };
    groups.into_iter().flat_map(of_group).collect()
}

/// K with a stiffness of one against some motions, in units of its diagonal: where a motion has neither stiffness nor mass the pencil is
/// singular, and with it no eigenvalue of any other motion changes.
pub(crate) fn lifted(k: MatRef<'_, f64>, motions: MatRef<'_, f64>) -> Mat<f64> {
    let mut lifted = k.to_owned();
    if motions.ncols() == 0 {
        return lifted;
    }
    let scale: Vec<f64> = (0..k.nrows()).map(|i| dense::power_of_two_root(k[(i, i)])).collect();
    let scaled = Mat::from_fn(motions.nrows(), motions.ncols(), |i, j| motions[(i, j)] / scale[i]);
    let z = scaled.qr().compute_thin_Q();
    let z = Mat::from_fn(z.nrows(), z.ncols(), |i, j| z[(i, j)] / scale[i]);
    dense::add_product(lifted.as_mut(), 1.0, z.as_ref(), z.transpose());
    dense::symmetrise(&mut lifted);
    lifted
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two masses on an oblique axis that turn about it: coordinates are two displacements and two rotations of a plane.
    #[test]
    fn a_turn_that_only_a_combination_of_motions_is_has_no_inertia() {
        let axis = [0.6, 0.8];
        // Rotations about the axis move no mass, those across it do; rounding left 1e-17 of the former.
        let mass = Mat::from_fn(2, 2, |i, j| f64::from(u8::from(i == j)) - axis[i] * axis[j] + 1e-17);
        let motions = Mat::<f64>::identity(2, 2);
        let found = ByInertia::of(mass.as_ref(), motions.as_ref()).expect("numbers");
        assert_eq!((found.massive.ncols(), found.massless.ncols()), (1, 1));
        let (x, y) = (found.massless[(0, 0)], found.massless[(1, 0)]);
        assert!((x * axis[1] - y * axis[0]).abs() < 1e-15, "{x} {y}");
    }

    /// 10⁻²³ of the largest inertia is one next to a seismic mass; that of a rounding squared is none.
    #[test]
    fn a_small_inertia_is_one() {
        let one = Mat::<f64>::identity(2, 2);
        for (inertia, n_massless) in [(1e-23, 0), (1e-53, 1), (0.0, 1)] {
            let mass = Mat::from_fn(2, 2, |i, j| if i != j { 0.0 } else { [1.0, inertia][i] });
            let found = ByInertia::of(mass.as_ref(), one.as_ref()).expect("numbers");
            assert_eq!(found.massless.ncols(), n_massless, "{inertia}");
        }
    }
}
