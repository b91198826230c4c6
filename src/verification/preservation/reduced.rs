//! The reduced model under a boundary of the scene: its elastic eigenvalues, and what rounding can make of each.
//!
//! ```text
//! P = 1 − Û ÛᵀM̂                   r × r     takes out the rigid-body motions Û that the support lets pass
//! (PᵀK̂P + αM̂) y = θ⁻¹ M̂ y                   dense, α at the first eigenvalue that is looked for
//! x = P y,  λ = xᵀK̂x / xᵀM̂x                 Rayleigh quotient
//! ```
//! The full model is solved with the same motions deflated; ΨÛ is the motion itself (24), so that Ψx is M-orthogonal to it and
//! Rayleigh's bound holds between the two whatever energy the digits of K leave to a rigid-body motion.
//!
//! A dense decomposition errs by ε λ_j/λ_1 in the vector of eigenvalue j, and units of dofs and added masses spread a
//! spectrum over ten powers of ten and more. The error of the quotient is the square of the vector's, and eigenvalues past
//! [`SPREAD`] are found with the lower ones deflated, as the elastic ones are with rigid-body motion deflated.

use faer::{Mat, MatRef};

use super::super::evidence::{Evidence, coordinate_scales};
use super::answered::{is_kept, n_left_out};
use super::reference::Reference;
use crate::dense;
use crate::eigen::Spectral;
use crate::error::Result;

/// Eigenvalues found at once lie within this factor: (ε · 10⁶)² is below rounding.
const SPREAD: f64 = 1e6;

/// An elastic eigenvalue of the reduced model.
#[derive(Clone, Copy, Debug)]
pub(super) struct Quotient {
    pub(super) lambda: f64,
    /// Relative rounding of xᵀK̂x and xᵀM̂x and of the entries of K̂ themselves.
    pub(super) rounding: f64,
    /// How much the block K̂_Bη that was set to zero could have changed it, relatively.
    pub(super) uncoupled: f64,
}

/// Eigenvalues of the full model with those of a reduced one, in their order.
pub(super) struct Answers {
    /// Numbers of the eigenvalues of the reference that are asked for, ascending.
    pub(super) asked: Vec<usize>,
    /// What answers each; fewer where the reduced model has no more.
    pub(super) found: Vec<Quotient>,
}

/// The elastic eigenvalues that answer those of a reference, ascending: as many as it asks for, or all there are. K̂ and M̂ may be cut down
/// to their leading coordinates.
///
/// # Errors
/// A reduced pencil that is not definite.
pub(super) fn quotients(
    evidence: &Evidence<'_>,
    reference: &Reference,
    k: MatRef<'_, f64>,
    m: MatRef<'_, f64>,
) -> Result<Answers> {
    let asked = reference.asked_of(evidence, k.nrows());
    let supported = Supported::new(evidence, reference, k, m);
    let mut found: Vec<Quotient> = Vec::new();
    let mut taken = reference.passing_coordinates(&supported.kept, (supported.n_free, reference.boundary.held.len()));
    while let Some(first) = asked.get(found.len()).map(|at| reference.lambda[*at]) {
        let mass_taken = dense::product(supported.mass.as_ref(), taken.as_ref());
        let stiffness = without(&supported.stiffness, &taken, &mass_taken);
        let spectral = Spectral::of(stiffness.as_ref(), supported.mass.as_ref(), first)?.of_rank(supported.mass_rank);
        let lambda = spectral.eigenvalues().split_off(taken.ncols().min(spectral.eigenvalues().len()));
        // Rounding may leave the first one of a near-mechanism below zero.
        let n_new = lambda.iter().take_while(|value| **value <= SPREAD * lambda[0].abs()).count();
        let n_new = n_new.min(asked.len() - found.len());
        if n_new == 0 {
            break;
        }
        let vectors: Vec<Vec<f64>> = (0..n_new).map(|j| spectral.eigenvector(taken.ncols() + j)).collect();
        let mut x = Mat::from_fn(supported.kept.len(), n_new, |i, j| vectors[j][i]);
        let along = dense::gram(mass_taken.as_ref(), x.as_ref());
        dense::add_product(x.as_mut(), -1.0, taken.as_ref(), along.as_ref());
        found.extend(supported.quotients(evidence, &mut x));
        taken = dense::side_by_side(taken.as_ref(), x.as_ref());
    }
    found.sort_by(|a, b| a.lambda.total_cmp(&b.lambda));
    Ok(Answers { asked, found })
}

/// The reduced pencil as the superelement has it, without the dofs that are held, with its loads and springs.
struct Supported {
    stiffness: Mat<f64>,
    mass: Mat<f64>,
    /// Numbers of the coordinates left.
    kept: Vec<usize>,
    /// How many of them are interface dofs.
    n_free: usize,
    /// Powers of two near one over the root of the stiffness before condensation.
    scales: Vec<f64>,
    /// The rank that the mass has at most, where the method makes it singular: that of the component, and the dofs with loads.
    mass_rank: Option<usize>,
}

impl Supported {
    fn new(evidence: &Evidence<'_>, reference: &Reference, k: MatRef<'_, f64>, m: MatRef<'_, f64>) -> Self {
        let boundary = &reference.boundary;
        let n_b = boundary.held.len();
        let moves = |i: &usize| *i >= n_b || !boundary.held[*i];
        let kept: Vec<usize> = (0..k.nrows()).filter(moves).filter(|i| is_kept(evidence, *i)).collect();
        let part = |a: MatRef<'_, f64>| Mat::from_fn(kept.len(), kept.len(), |i, j| a[(kept[i], kept[j])]);
        let (mut stiffness, mut mass) = (part(k), part(m));
        let n_free = kept.partition_point(|i| *i < n_b);
        for i in 0..n_free {
            mass[(i, i)] += boundary.load[kept[i]];
            stiffness[(i, i)] += boundary.springs[kept[i]];
        }
        let all = coordinate_scales(evidence);
        let scales = kept.iter().map(|i| all[*i]).collect();
        let n_loaded = kept[..n_free].iter().filter(|i| boundary.load[**i] > 0.0).count();
        let mass_rank = evidence.reduction.mass_rank().map(|rank| rank + n_loaded - n_left_out(evidence, k.nrows()));
        Self { stiffness, mass, kept, n_free, scales, mass_rank }
    }

    /// The Rayleigh quotients of columns, which are brought to unit modal mass.
    fn quotients(&self, evidence: &Evidence<'_>, x: &mut Mat<f64>) -> Vec<Quotient> {
        let (energies, inertias) = (Terms::of(&self.stiffness, x), Terms::of(&self.mass, x));
        let coupling = 2.0 * evidence.reduction.measured.block_coupling;
        let quotient = |j: usize| {
            let column = dense::column_mut(x.as_mut(), j);
            let scaled: Vec<f64> = column.iter().zip(&self.scales).map(|(x, d)| (x / d).abs()).collect();
            let (interface, modes) = scaled.split_at(self.n_free);
            let energy = energies.sizes[j] + evidence.constraint.cancellation * dense::dot(&scaled, &scaled);
            let own = energies.values[j].abs();
            let length = inertias.values[j].sqrt();
            column.iter_mut().for_each(|x| *x /= length);
            Quotient {
                lambda: energies.values[j] / inertias.values[j],
                rounding: f64::EPSILON * (energy / own + inertias.sizes[j] / inertias.values[j]),
                // 2 x_Bᵀ K̂_Bη x_η, of which M-13 knows the largest entry.
                uncoupled: coupling * interface.iter().sum::<f64>() * modes.iter().sum::<f64>() / own,
            }
        };
        (0..energies.values.len()).map(quotient).collect()
    }
}

/// PᵀKP = K − (KU)(MU)ᵀ − (MU)(KU)ᵀ + (MU)(UᵀKU)(MU)ᵀ.
fn without(stiffness: &Mat<f64>, u: &Mat<f64>, mass_u: &Mat<f64>) -> Mat<f64> {
    let mut forces = dense::product(stiffness.as_ref(), u.as_ref());
    let energies = dense::gram(u.as_ref(), forces.as_ref());
    // The two terms in the middle take a half of the last one each.
    dense::add_product(forces.as_mut(), -0.5, mass_u.as_ref(), energies.as_ref());
    let mut projected = stiffness.clone();
    dense::add_product(projected.as_mut(), -1.0, forces.as_ref(), mass_u.transpose());
    dense::add_product(projected.as_mut(), -1.0, mass_u.as_ref(), forces.transpose());
    dense::symmetrise(&mut projected);
    projected
}

/// xᵀAx of every column, and |x|ᵀ|A||x|.
struct Terms {
    values: Vec<f64>,
    sizes: Vec<f64>,
}

impl Terms {
    fn of(a: &Mat<f64>, x: &Mat<f64>) -> Self {
        let quadratic = |a: &Mat<f64>, x: &Mat<f64>| -> Vec<f64> {
            let image = dense::product(a.as_ref(), x.as_ref());
            (0..x.ncols()).map(|j| dense::dot(dense::column(x.as_ref(), j), dense::column(image.as_ref(), j))).collect()
        };
        Self { values: quadratic(a, x), sizes: quadratic(&dense::absolute(a.as_ref()), &dense::absolute(x.as_ref())) }
    }
}
