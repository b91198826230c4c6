//! The spectrum of the reduced pencil, by dense decompositions of its own.

use faer::{Mat, MatRef};

use super::check::{Limits, MAX_EXCUSE};
use super::evidence::{Evidence, coordinate_scales, data_noise};
use super::limits::{self, GROUNDED, Known, n_nearly_free};
use crate::dense;
use crate::eigen::{Spectral, eigenvalues, rayleigh_quotients, scaled_by, sharpen, zero};
use crate::error::Result;
use crate::job::Boundary;
use crate::rigid::zero_modes;

/// Eigenvalues of the reduced pencil with its interface free, and under the boundary of the retained modes.
pub(super) struct Spectrum {
    /// All finite ones, ascending, interface free.
    free: Vec<f64>,
    /// Whether the reduced pencil is near enough to definite to have a spectrum.
    is_definite: bool,
    /// The M̂-orthonormal eigenvectors of as many as there are rigid-body modes, r × n_r or fewer.
    pub(super) zero_shapes: Mat<f64>,
    /// Eigenvalues under the boundary of the retained modes, zero modes left out.
    pub(super) same_boundary: Vec<f64>,
    /// Rigid-body motions that cost energy in K̂, and motions without energy that are not rigid-body motions.
    pub(super) n_held: usize,
    pub(super) n_others: usize,
    /// Eigenvalues below the first elastic one that energies are compared with: zero modes that have mass, and with it a place in the
    /// spectrum, and motions of a body as a whole that are nearly free.
    n_soft: usize,
    /// The first elastic eigenvalue of the full model under the boundary of the retained modes, where one is known.
    of_full: Option<f64>,
    /// The coordinate that takes the largest part in the smallest eigenvalue of K̂, in the scales of its coordinates.
    pub(super) softest: usize,
    /// The smallest eigenvalue of K̂_BB with its rigid-body modes lifted out, in the same scales; one where the interface has no others.
    pub(super) lowest_elastic: f64,
    /// The smallest eigenvalue of M̂ with unit diagonal, and the coordinate that takes the largest part in it.
    pub(super) lowest_mass: (f64, usize),
    /// What rounding makes of an energy, relative to the first elastic eigenvalue; zero where none is known.
    pub(super) noise: f64,
}

impl Spectrum {
    pub(super) fn of(evidence: &Evidence<'_>) -> Result<Self> {
        let (k, m) = (evidence.reduction.stiffness.as_ref(), evidence.reduction.mass.as_ref());
        let lambda = match first_of_full(evidence, evidence.rigid.n_grey) {
            Some(lambda) => lambda,
            None => evidence.reduction.elastic_scale()?.unwrap_or(1.0),
        };
        let (_, vectors) = dense::symmetric_eigen(scaled_by(k, &coordinate_scales(evidence)).as_ref())?;
        let (masses, mass_vectors) = dense::symmetric_eigen(equilibrated(m, m).as_ref())?;
        let (k_held, n_pencil) = (with_massless_lifted(evidence), evidence.rigid.count() - evidence.rigid.n_massless);
        let lifted = lifted_eigenvalues(evidence)?;
        // Those beyond the rigid-body modes that are soft by their own account, and one more.
        let n_looked_at = n_pencil + evidence.rigid.n_grey + 1;
        let spectral = Spectral::if_definite(k_held.as_ref(), m, lambda)?;
        let spectral = spectral.map(|spectral| spectral.of_rank(evidence.reduction.mass_rank()));
        let is_definite = spectral.is_some();
        if !is_definite {
            // Whether K itself is at fault, or its digits, says the full model.
            zero_modes(evidence.partition)?;
        }
        let (mut free, shapes) = spectral.map_or((Vec::new(), Mat::zeros(k.nrows(), 0)), |s| s.lowest(n_looked_at));
        let shapes = by_their_energy(&mut free, shapes.as_ref(), (k_held.as_ref(), m));
        let n_modes = evidence.retained.modes.count();
        sharpen(&mut free, (k_held.as_ref(), m), lambda, n_pencil + n_modes)?;
        let same_boundary = match evidence.retained.boundary {
            Boundary::FreeInterface => free.get(n_pencil..).unwrap_or_default().to_vec(),
            Boundary::FixedInterface | Boundary::MixedInterface => {
                let (moving, n_zero) = (evidence.moving(), evidence.n_zero());
                let [k, m] = [k, m].map(|a| dense::part(a, &moving));
                let inner = (k.as_ref(), m.as_ref());
                let mut held = eigenvalues(inner.0, inner.1, lambda)?;
                sharpen(&mut held, inner, lambda, n_zero + n_modes)?;
                held.split_off(n_zero.min(held.len()))
            }
        };
        let levels = zero_levels(evidence, shapes.as_ref());
        let is_zero = |j: usize| zero::is_zero(free[j], levels[j]);
        let n_others = (n_pencil..shapes.ncols()).filter(|j| is_zero(*j)).count();
        let n_soft = (n_pencil + n_others).max(n_nearly_free(&free, n_pencil));
        let first = free.get(n_soft).copied().unwrap_or(0.0);
        let is_free = |j: usize| is_zero(j) || free[j].abs() <= GROUNDED * first;
        let n_free = (0..n_pencil.min(shapes.ncols())).filter(|j| is_free(*j)).count();
        let spectrum = Self {
            zero_shapes: shapes.as_ref().subcols(0, n_pencil.min(shapes.ncols())).to_owned(),
            free,
            is_definite,
            lowest_elastic: lifted.first().copied().unwrap_or(1.0),
            same_boundary,
            n_held: n_pencil - n_free,
            n_others,
            n_soft,
            of_full: first_of_full(evidence, n_soft - n_pencil),
            softest: largest_component(vectors.as_ref()),
            lowest_mass: (masses.first().copied().unwrap_or(0.0), largest_component(mass_vectors.as_ref())),
            noise: 0.0,
        };
        let noise = spectrum.first_elastic().map_or(0.0, |first| energy_noise(evidence, first));
        Ok(Self { noise, ..spectrum })
    }

    /// How far below zero the lowest eigenvalue lies, relative to the first elastic one; one, which it is at least, where the
    /// reduced pencil is too far from definite to have a spectrum.
    pub(super) fn negative_share(&self) -> f64 {
        match (self.free.first(), self.first_elastic()) {
            (Some(lowest), _) if *lowest >= 0.0 => 0.0,
            (Some(lowest), Some(first)) => -lowest / first,
            // An interface of rigid-body motions alone has no stiffness to be compared with.
            (Some(lowest), None) => -lowest,
            // Coordinates without mass have no spectrum.
            (None, _) if self.is_definite => 0.0,
            // K̂ + αM̂ is not definite with α the first elastic eigenvalue: some λ lies below −α.
            (None, _) => 1.0,
        }
    }

    /// The eigenvalue of a number, from zero, where there are so many.
    pub(super) fn number(&self, index: usize) -> Option<f64> {
        self.free.get(index).copied()
    }

    /// What the energy of a motion is compared with: the eigenvalue of the reduced model of this number, from zero, or the
    /// highest elastic one where there are not so many.
    ///
    /// Without any elastic eigenvalue, or without a spectrum because the reduced pencil is too far from definite, what the full model shows of itself serves: the first eigenvalue with the interface held.
    /// As many interface dofs as rigid-body motions then hold the component, and that is not above the first elastic one
    /// (Cauchy). None where that is not known either.
    pub(super) fn scale(&self, index: usize) -> Option<f64> {
        let elastic = self.free.get(self.n_soft..).unwrap_or_default();
        self.free.get(index.max(self.n_soft)).or(elastic.last()).copied().or(self.of_full)
    }

    /// The lowest eigenvalues, one for each rigid-body mode.
    pub(super) fn rigid(&self) -> &[f64] {
        &self.free[..self.zero_shapes.ncols()]
    }

    /// All other eigenvalues.
    pub(super) fn elastic(&self) -> &[f64] {
        &self.free[self.zero_shapes.ncols()..]
    }

    /// The scale of the first elastic eigenvalue.
    pub(super) fn first_elastic(&self) -> Option<f64> {
        self.scale(self.n_soft)
    }
}

/// Computes the lowest eigenvalues anew from their shapes, as xᵀKx / xᵀMx, and puts both in order. As 1/θ − α they have the rounding of
/// α and of the factor of M̂, which next to a heavy mass is more than nothing: the energy of a shape has that of its own terms.
fn by_their_energy(free: &mut [f64], shapes: MatRef<'_, f64>, (k, m): (MatRef<'_, f64>, MatRef<'_, f64>)) -> Mat<f64> {
    let [energies, masses] = [k, m].map(|a| dense::dots(shapes, dense::product(a, shapes).as_ref()));
    let quotients: Vec<f64> = energies.iter().zip(masses).map(|(energy, mass)| energy / mass).collect();
    let mut order: Vec<usize> = (0..quotients.len()).collect();
    order.sort_by(|a, b| quotients[*a].total_cmp(&quotients[*b]));
    free.iter_mut().zip(&order).for_each(|(value, j)| *value = quotients[*j]);
    dense::columns(shapes, &order)
}

/// The first elastic eigenvalue of the full model under the boundary of the retained modes, soft motions left out as in the reduced one.
fn first_of_full(evidence: &Evidence<'_>, n_soft: usize) -> Option<f64> {
    let modes = &evidence.retained.modes;
    let n_soft = match evidence.retained.boundary {
        Boundary::FreeInterface => n_soft,
        Boundary::FixedInterface | Boundary::MixedInterface => 0,
    };
    modes.lambda.get(n_soft).copied().or(modes.next)
}

/// Force of a rigid-body motion in K̂, in the scales of its coordinates, at which M-12 fails.
pub(super) const NOT_FREE: f64 = 1e-8;

/// λ up to which each of some motions of the reduced model costs no energy: by the full model, whose roundings these are.
pub(super) fn zero_levels(evidence: &Evidence<'_>, shapes: MatRef<'_, f64>) -> Vec<f64> {
    let problem = evidence.partition.free_problem();
    let (_, errors, _) = rayleigh_quotients(problem, evidence.basis.expanded(shapes).as_ref());
    errors.iter().map(|error| error.zero_level).collect()
}

/// What rounding makes of an energy, relative to the first elastic eigenvalue, by the modes of the reduction.
fn energy_noise(evidence: &Evidence<'_>, first: f64) -> f64 {
    let modes = &evidence.retained.modes;
    let known = modes.lambda.iter().zip(&modes.errors);
    let known = known.map(|(lambda, error)| Known { lambda: *lambda, relative_bar: error.data_bar });
    limits::energy_noise((evidence.partition, evidence.rigid), known, first)
}

/// Size below which an eigenvalue of K̂ in the scales of its coordinates is zero: rounding of its r terms before they
/// cancel, or the precision of the data.
///
/// The terms are those of the basis: constraint modes gone wrong are large and would raise the level. Past four digits
/// of the interface's own stiffness nothing is excused by arithmetic, past two nothing by the data.
pub(in crate::verification) fn zero_level(evidence: &Evidence<'_>) -> Limits {
    let cancellation = evidence.constraint.cancellation;
    Limits {
        engineering: 0.0,
        arithmetic: evidence.reduction.n_reduced() as f64 * f64::EPSILON * cancellation,
        data: data_noise(evidence.partition) * cancellation,
    }
    .capped(1e-4, MAX_EXCUSE)
}

/// Eigenvalues of K̂ in the scales of its coordinates, ascending, with its rigid-body modes lifted to order one.
pub(super) fn lifted_eigenvalues(evidence: &Evidence<'_>) -> Result<Vec<f64>> {
    let (k, u) = (&evidence.reduction.stiffness, &evidence.reduction.rigid_body_modes);
    let scales = coordinate_scales(evidence);
    let mut lifted = scaled_by(k.as_ref(), &scales);
    if u.ncols() > 0 {
        let scaled = Mat::from_fn(u.nrows(), u.ncols(), |i, j| u[(i, j)] / scales[i]);
        let z = scaled.qr().compute_thin_Q();
        dense::add_product(lifted.as_mut(), 1.0, z.as_ref(), z.transpose());
        dense::symmetrise(&mut lifted);
    }
    Ok(dense::symmetric_eigen(lifted.as_ref())?.0)
}

/// K̂ with a unit stiffness against the rigid-body motions without mass, in the scales of its coordinates: the pencil would be
/// singular with them, and M̂ sends them to infinity.
fn with_massless_lifted(evidence: &Evidence<'_>) -> Mat<f64> {
    let mut k = evidence.reduction.stiffness.clone();
    let massless = evidence.rigid.massless();
    let (n_i, n_b) = (evidence.partition.n_internal, evidence.partition.n_interface());
    if massless.ncols() == 0 || n_b == 0 {
        return k;
    }
    let scales = coordinate_scales(evidence);
    let scaled =
        Mat::from_fn(
            k.nrows(),
            massless.ncols(),
            |i, j| {
                if i < n_b { massless[(n_i + i, j)] / scales[i] } else { 0.0 }
            },
        );
    let z = scaled.qr().compute_thin_Q();
    let z = Mat::from_fn(z.nrows(), z.ncols(), |i, j| z[(i, j)] / scales[i]);
    dense::add_product(k.as_mut(), 1.0, z.as_ref(), z.transpose());
    dense::symmetrise(&mut k);
    k
}

/// The row of the largest entry of the first column.
fn largest_component(vectors: MatRef<'_, f64>) -> usize {
    let size = |i: usize| if vectors.ncols() > 0 { vectors[(i, 0)].abs() } else { 0.0 };
    (0..vectors.nrows()).max_by(|a, b| size(*a).total_cmp(&size(*b))).unwrap_or(0)
}

/// D A D with powers of two D that bring the diagonal of `by` near one.
fn equilibrated(a: MatRef<'_, f64>, by: MatRef<'_, f64>) -> Mat<f64> {
    let scales: Vec<f64> = (0..by.nrows()).map(|i| dense::power_of_two_root(by[(i, i)])).collect();
    scaled_by(a, &scales)
}
