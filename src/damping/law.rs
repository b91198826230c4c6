//! Damping that is made from the reduced matrices: Rayleigh's and that of modes.
//!
//! ```text
//! α M̂ + β K̂                         Rayleigh
//! α PᵀM̂P                            its first part on the deformation, P = I − Û (ÛᵀM̂Û)⁻¹ ÛᵀM̂
//! M̂ Φ diag(2ζω) Φᵀ M̂               modal
//! ```

use faer::{Mat, MatRef};

use crate::dense;
use crate::eigen::{eigenvalue_beyond, elastic_scale, lowest_eigenpairs};
use crate::error::{Error, Result};
use crate::job::{ComponentDampingJob, MassActsOn, ModalDampingJob};

/// A reduced component in the user's units.
#[derive(Clone, Copy, Debug)]
pub struct Reduced<'a> {
    /// K̂, r × r.
    pub stiffness: MatRef<'a, f64>,
    /// M̂, r × r.
    pub mass: MatRef<'a, f64>,
    /// Û, r × n_r.
    pub motions: MatRef<'a, f64>,
    /// The rank of M̂, where its method makes it singular.
    pub mass_rank: Option<usize>,
}

/// Damping made from reduced matrices.
pub(super) struct Law {
    /// Symmetric to the bit, r × r.
    pub(super) matrix: Mat<f64>,
    /// What entry (i, i) is a sum of, before rigid-body motion is taken from it.
    pub(super) sizes: Vec<f64>,
    /// What entry (i, i) is a sum of before the terms of M̂Φ cancel, as they do where an interface dof moves the body as a whole.
    pub(super) terms: Vec<f64>,
    /// The largest eigenvalue over the first elastic one where modes are damped, one elsewhere.
    pub(super) spread: f64,
}

impl Law {
    /// The damping that a job makes of reduced matrices; none where it makes none.
    pub(super) fn of(job: &ComponentDampingJob, reduced: Reduced<'_>) -> Result<Option<Self>> {
        if !job.has_law() {
            return Ok(None);
        }
        let Reduced { stiffness: k, mass: m, .. } = reduced;
        let mut law = Self {
            matrix: Mat::zeros(k.nrows(), k.nrows()),
            sizes: vec![0.0; k.nrows()],
            terms: vec![0.0; k.nrows()],
            spread: 1.0,
        };
        if let Some(rayleigh) = job.rayleigh {
            let size = |i: usize| rayleigh.mass * m[(i, i)] + rayleigh.stiffness * k[(i, i)];
            law.sizes = (0..k.nrows()).map(size).collect();
            let inertia = match rayleigh.mass_acts_on {
                MassActsOn::Motion => m.to_owned(),
                MassActsOn::Deformation => elastic_mass(reduced),
            };
            law.matrix += inertia * faer::Scale(rayleigh.mass);
            law.matrix += k.to_owned() * faer::Scale(rayleigh.stiffness);
        }
        if let Some(modal) = &job.modal {
            law.add_modes(modal, reduced)?;
        }
        dense::symmetrise(&mut law.matrix);
        Ok(Some(law))
    }

    fn add_modes(&mut self, modal: &ModalDampingJob, reduced: Reduced<'_>) -> Result<()> {
        let (lambda, shapes) = elastic_modes(reduced)?;
        let (n_named, n_modes) = (modal.n_named(), lambda.len());
        if n_named > n_modes {
            return Err(Error::DampingModes { n_named, n_modes });
        }
        let momenta = dense::product(reduced.mass, shapes.as_ref());
        let factor = |(mode, lambda): (usize, &f64)| {
            let omega = lambda.sqrt();
            2.0 * modal.ratio_of(mode, omega / std::f64::consts::TAU) * omega
        };
        let factors: Vec<f64> = lambda.iter().enumerate().map(factor).collect();
        let weighted = Mat::from_fn(momenta.nrows(), n_modes, |i, j| momenta[(i, j)] * factors[j]);
        let damping = dense::product(weighted.as_ref(), momenta.transpose());
        self.sizes.iter_mut().enumerate().for_each(|(i, size)| *size += damping[(i, i)]);
        self.matrix += damping;
        let moduli = dense::product(dense::absolute(reduced.mass).as_ref(), dense::absolute(shapes.as_ref()).as_ref());
        for (i, terms) in self.terms.iter_mut().enumerate() {
            *terms += factors.iter().enumerate().map(|(j, factor)| factor * moduli[(i, j)].powi(2)).sum::<f64>();
        }
        if let (Some(first), Some(last)) = (lambda.first(), lambda.last()) {
            self.spread = last / first;
        }
        Ok(())
    }
}

/// λ ascending and Φ, M̂-orthonormal and without rigid-body motion, of the elastic modes with the interface free.
fn elastic_modes(reduced: Reduced<'_>) -> Result<(Vec<f64>, Mat<f64>)> {
    let Reduced { stiffness: k, mass: m, motions, mass_rank } = reduced;
    let (r, n_r) = (k.nrows(), motions.ncols());
    let none = || Ok((Vec::new(), Mat::zeros(r, 0)));
    if mass_rank.unwrap_or(r) <= n_r {
        return none();
    }
    let Some(near) = elastic_scale((k, m, motions))? else { return none() };
    // Near the first elastic eigenvalue rounding is relative to the low ones.
    let (values, shapes) = lowest_eigenpairs(k, m, eigenvalue_beyond(n_r, (k, m), near)?, r)?;
    if values.is_empty() {
        return Err(Error::DenseEigen { n: r });
    }
    let n_finite = mass_rank.map_or(values.len(), |rank| values.len().min(rank));
    let elastic: Vec<usize> = (n_r..n_finite).filter(|mode| values[*mode] > 0.0).collect();
    let shapes = without_rigid_motion(reduced, dense::columns(shapes.as_ref(), &elastic));
    Ok((elastic.iter().map(|mode| values[*mode]).collect(), shapes))
}

/// P X: what rounding has left of rigid-body motion goes.
fn without_rigid_motion(reduced: Reduced<'_>, mut x: Mat<f64>) -> Mat<f64> {
    // In a basis of their own: motions about a far origin are nearly one, and next to a heavy mass rotations about it hardly count.
    let motions = dense::orthonormal(reduced.motions, reduced.mass);
    let shares = dense::gram(dense::product(reduced.mass, motions.as_ref()).as_ref(), x.as_ref());
    dense::add_product(x.as_mut(), -1.0, motions.as_ref(), shares.as_ref());
    x
}

/// PᵀM̂P = M̂ − M̂Û (ÛᵀM̂Û)⁻¹ ÛᵀM̂.
fn elastic_mass(reduced: Reduced<'_>) -> Mat<f64> {
    let m = reduced.mass;
    let deformed = without_rigid_motion(reduced, Mat::identity(m.nrows(), m.nrows()));
    let mut mass = dense::gram(deformed.as_ref(), dense::product(m, deformed.as_ref()).as_ref());
    dense::symmetrise(&mut mass);
    mass
}
