//! Loads of inertia: deflection under unit accelerations (M-18), effective mass (M-19).

use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef, Side};

use super::check::{Check, Limits, MAX_EXCUSE};
use super::conditioning::{Columns, independence};
use super::directions::Directions;
use super::evidence::{Evidence, data_noise};
use crate::basis::{DynamicCoordinate, clear_unloaded};
use crate::cache::{Kind, Reader, Recorded, Writer, recalled};
use crate::dense;
use crate::eigen::{lowest_eigenpairs, scaled_by};
use crate::error::Result;
use crate::factor::SolveOperator;
use crate::sparse::{absolute_energy, product};

/// Share of each direction's inertia that a mode of the reduced model carries, its interface held.
#[derive(Clone, Debug, PartialEq)]
pub struct EffectiveMasses {
    /// The directions.
    pub directions: Vec<String>,
    /// For each mode, the shares in each direction.
    pub shares: Vec<Vec<f64>>,
}

/// M-18, along the unit translations and about the middle of the mass, where these are known.
pub(super) fn accelerations(evidence: &Evidence<'_>, condition: f64) -> Option<Check> {
    const FAIL: f64 = 1e-6;
    if !evidence.is_held() {
        return None;
    }
    let partition = evidence.partition;
    let n_i = partition.n_internal;
    let directions = Directions::of_unit_motions(evidence)?;
    let inertia = product(&partition.mass, directions.motions.as_ref());
    let mut loads = inertia.as_ref().subrows(0, n_i).to_owned();
    let along = dense::gram(evidence.rigid.mass_orthonormal.as_ref(), directions.motions.as_ref());
    let beyond = beyond_rigid(evidence, along.as_ref(), loads.as_ref());
    // An acceleration that rests on the interface deflects nothing: what rounding leaves of its load has no column, and is no size of one.
    clear_unloaded(partition, &absolute_energy(&partition.mass, directions.motions.as_ref()), loads.as_mut());
    let loads = loads.as_ref();
    let mut answers = dense::side_by_side(loads, beyond.as_ref());
    evidence.factor.solve_in_place(answers.as_mut());
    let (full, of_beyond) = answers.as_ref().split_at_col(directions.count());
    let reduced = reduced_deflections(evidence, loads)?;
    let error = full - &reduced;
    let forces = product(partition.internal().stiffness, error.as_ref());
    let at_rest = (loads.norm_max() == 0.0).then(|| "no acceleration deflects the interior".to_owned());
    let (mut worst, mut left) = ((0.0, at_rest), 0.0f64);
    for j in 0..directions.count() {
        let (missed, whole) = (root_of_energy(error.as_ref(), forces.as_ref(), j), root_of_energy(full, loads, j));
        let share = if missed == 0.0 { 0.0 } else { missed / whole };
        let of_rest = root_of_energy(of_beyond, beyond.as_ref(), j);
        left = left.max(if whole > 0.0 { of_rest / whole } else { 0.0 });
        if dense::worse(share, worst.0) {
            worst = (share, Some(directions.acceleration(j)));
        }
    }
    let limits = if is_exact(evidence, &directions, along.as_ref()) {
        // The columns answer the part of an acceleration that is a rigid-body motion. Of the rest, which rounding leaves where soft motions
        // cannot be told from free ones, they miss no more energy than it has: they answer best of all their combinations.
        // A column that adds little to those before it is put together from large parts of little.
        let (least, _) = independence(evidence, Columns::BeforeResidualVectors);
        let of_parts = evidence.basis.n_dynamic() as f64 * f64::EPSILON / least;
        let arithmetic = f64::EPSILON * condition + left + of_parts;
        // The condition is that of the matrix, not of this solve; a thousandth of a deflection makes no difference.
        Limits { engineering: 1e-9, arithmetic, data: data_noise(partition) * condition }.capped(1e-3, MAX_EXCUSE)
    } else {
        Limits::NONE
    };
    Some(Check {
        id: "M-18",
        name: "deflection under unit accelerations",
        equation: "max ‖u − Ψ_D η‖_K / ‖u‖_K, interface held, u = K_II⁻¹ (M t)_I, η = K̂_ηη⁻¹ Ψ_Dᵀ (M t)_I",
        value: worst.0,
        limits,
        fail_above: if limits.engineering.is_finite() { limits.value().max(FAIL) } else { f64::INFINITY },
        worst: worst.1,
    })
}

/// √(aᵀb) of a column of displacements and one of forces.
pub(super) fn root_of_energy(a: MatRef<'_, f64>, b: MatRef<'_, f64>, j: usize) -> f64 {
    let energy = dense::dot(dense::column(a, j), dense::column(b, j));
    // Below zero it is rounding; NaN stays NaN.
    if energy < 0.0 { 0.0 } else { energy.sqrt() }
}

/// (M (t − Q Qᵀ M t))_I of the loads (M t)_I, with QᵀMt given: inertia of what is no rigid-body motion.
fn beyond_rigid(evidence: &Evidence<'_>, along: MatRef<'_, f64>, loads: MatRef<'_, f64>) -> Mat<f64> {
    let mut beyond = loads.to_owned();
    let momenta = evidence.rigid.mass_orthonormal.as_ref().subrows(0, loads.nrows());
    dense::add_product(beyond.as_mut(), -1.0, momenta, along);
    beyond
}

/// Ψ_D K̂_ηη⁻¹ Ψ_Dᵀ F; none where K̂_ηη is not definite, which M-25 says.
pub(super) fn reduced_deflections(evidence: &Evidence<'_>, loads: MatRef<'_, f64>) -> Option<Mat<f64>> {
    let psi_d = evidence.basis.dynamic_modes.as_ref();
    let (n_b, n_eta) = (evidence.partition.n_interface(), psi_d.ncols());
    let stiffness = evidence.reduction.stiffness.as_ref().submatrix(n_b, n_b, n_eta, n_eta);
    let scales: Vec<f64> = (0..n_eta).map(|i| dense::power_of_two_root(stiffness[(i, i)])).collect();
    let factor = scaled_by(stiffness, &scales).llt(Side::Lower).ok()?;
    let mut eta = dense::gram(psi_d, loads);
    let scale = |eta: &mut Mat<f64>| {
        *eta = Mat::from_fn(eta.nrows(), eta.ncols(), |i, j| eta[(i, j)] * scales[i]);
    };
    scale(&mut eta);
    factor.solve_in_place(eta.as_mut());
    scale(&mut eta);
    Some(dense::product(psi_d, eta.as_ref()))
}

/// Whether the answers to these accelerations are among the columns of Ψ_D: Ψ_D has inertia relief for every rigid-body
/// mode, and the accelerations are rigid-body motions that K lets pass.
fn is_exact(evidence: &Evidence<'_>, directions: &Directions, along: MatRef<'_, f64>) -> bool {
    // A translation that is a rigid-body motion leaves only rounding; one that is held stays whole.
    const SAME: f64 = 1e-6;
    let basis = evidence.basis;
    let is_relief = |c: &DynamicCoordinate| matches!(c, DynamicCoordinate::InertiaRelief(_));
    let kept = basis.coordinates.iter().filter(|c| is_relief(c)).count();
    let dropped = basis.dropped.iter().filter(|column| is_relief(&column.coordinate)).count();
    let rigid = evidence.rigid;
    if rigid.count() == 0 || kept + dropped < rigid.count() {
        return false;
    }
    (0..directions.count()).all(|j| {
        let kept: f64 = (0..along.nrows()).map(|i| along[(i, j)].powi(2)).sum();
        (1.0 - kept / directions.masses[j]).abs() <= SAME
    })
}

/// The effective masses of the reduced model with its interface held, for a free component; none where the mass is that of free modes alone.
///
/// Γ = M_II U_I + M_IB U_B is the inertia of a rigid-body acceleration on the interior; a mode φ carries (φᵀΨ_DᵀΓ)² of the
/// total ΓᵀM_II⁻¹Γ. No modes carry nothing, whatever the total is.
pub(super) fn effective_masses(evidence: &Evidence<'_>) -> Result<Option<EffectiveMasses>> {
    // With the interface held a mass without that of the static answers has shares that add up to more than the whole.
    if evidence.reduction.modal_mass.is_some() || !evidence.is_held() {
        return Ok(None);
    }
    let partition = evidence.partition;
    let (n_i, n_b, n_eta) = (partition.n_internal, partition.n_interface(), evidence.basis.n_dynamic());
    let directions = Directions::free(evidence);
    if n_eta == 0 {
        return Ok(Some(EffectiveMasses { directions: directions.names, shares: Vec::new() }));
    }
    let inertia = product(&partition.mass, directions.motions.as_ref());
    let gamma = inertia.as_ref().subrows(0, n_i);
    let start = directions.motions.as_ref().subrows(0, n_i);
    let key = || partition.key_of_matrices("inertia of the interior").columns(directions.motions.as_ref());
    let found = || Ok(InteriorMasses(interior_masses(evidence, gamma, start)));
    let InteriorMasses(Some(totals)) = recalled(partition.cache(), key, found)? else { return Ok(None) };
    if totals.len() != directions.count() {
        return Ok(None);
    }
    let (k, m) = (evidence.reduction.stiffness.as_ref(), evidence.reduction.mass.as_ref());
    let held = |a: MatRef<'_, f64>| a.submatrix(n_b, n_b, n_eta, n_eta).to_owned();
    let first = (0..n_eta).map(|i| k[(n_b + i, n_b + i)]).fold(f64::INFINITY, f64::min);
    let (_, shapes) = lowest_eigenpairs(held(k).as_ref(), held(m).as_ref(), first, n_eta)?;
    let participation = dense::gram(evidence.basis.dynamic_modes.as_ref(), gamma);
    let participation = dense::gram(shapes.as_ref(), participation.as_ref());
    let share =
        |mode: usize, j: usize| if totals[j] > 0.0 { participation[(mode, j)].powi(2) / totals[j] } else { 0.0 };
    let shares = (0..shapes.ncols()).map(|mode| (0..totals.len()).map(|j| share(mode, j)).collect()).collect();
    Ok(Some(EffectiveMasses { directions: directions.names, shares }))
}

/// ΓᵀM_II⁻¹Γ of each direction as an entry of a cache has it; none where it is not known.
struct InteriorMasses(Option<Vec<f64>>);

impl Recorded for InteriorMasses {
    const KIND: Kind = Kind::Statics;

    fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        to.array(self.0.as_deref().unwrap_or_default())
    }

    fn read(from: &mut Reader<'_>) -> Option<Self> {
        let totals = from.array()?;
        Some(Self((!totals.is_empty()).then_some(totals)))
    }
}

/// γᵀ M_II⁻¹ γ of each column, by conjugate gradients with the diagonal of M_II: a mass matrix is that well conditioned.
/// None where it is not.
fn interior_masses(evidence: &Evidence<'_>, gamma: MatRef<'_, f64>, start: MatRef<'_, f64>) -> Option<Vec<f64>> {
    // Shares are read to three digits; the square of this is what the total is off by.
    const MAX_RESIDUAL: f64 = 1e-4;
    const MAX_STEPS: usize = 500;
    let mass = evidence.partition.internal().mass;
    let inverse: Vec<f64> = mass.diagonal().into_iter().map(|m| if m > 0.0 { 1.0 / m } else { 0.0 }).collect();
    let precondition = |r: &Mat<f64>| {
        let mut z = r.clone();
        z.col_iter_mut().for_each(|z| z.iter_mut().zip(&inverse).for_each(|(z, inverse)| *z *= inverse));
        z
    };
    let dots = |a: &Mat<f64>, b: &Mat<f64>| dense::dots(a.as_ref(), b.as_ref());
    let gamma = gamma.to_owned();
    let sizes = dots(&gamma, &precondition(&gamma));
    let mut x = start.to_owned();
    let mut r = &gamma - &product(mass, x.as_ref());
    let mut z = precondition(&r);
    let (mut p, mut rz) = (z.clone(), dots(&r, &z));
    for _ in 0..MAX_STEPS {
        if rz.iter().zip(&sizes).all(|(rz, size)| *rz <= MAX_RESIDUAL * MAX_RESIDUAL * size) {
            // The total that the residual still owes is of second order.
            return Some(dots(&gamma, &x).iter().zip(dots(&r, &x)).map(|(found, owed)| found + owed).collect());
        }
        let image = product(mass, p.as_ref());
        let curvature = dots(&p, &image);
        for j in 0..x.ncols() {
            // A column that has converged has no direction left.
            let alpha = if curvature[j] > 0.0 { rz[j] / curvature[j] } else { 0.0 };
            dense::add_scaled(dense::column_mut(x.as_mut(), j), alpha, dense::column(p.as_ref(), j));
            dense::add_scaled(dense::column_mut(r.as_mut(), j), -alpha, dense::column(image.as_ref(), j));
        }
        z = precondition(&r);
        let next = dots(&r, &z);
        let beta: Vec<f64> = next.iter().zip(&rz).map(|(new, old)| if *old > 0.0 { new / old } else { 0.0 }).collect();
        for (j, beta) in beta.into_iter().enumerate() {
            let along = dense::column_mut(p.as_mut(), j).iter_mut().zip(dense::column(z.as_ref(), j));
            along.for_each(|(p, z)| *p = z + beta * *p);
        }
        rz = next;
    }
    None
}

/// M-19: the direction that is carried least.
///
/// It is shown, not judged. M̂ holds the whole rigid-body mass whatever the modes (M-16), so what the modes leave out
/// still moves with the interface; what it misses is its own vibration above the highest mode, which the job does not ask for, and
/// the deflection under its own inertia, which M-18 measures.
pub(super) fn effective_mass(masses: &EffectiveMasses) -> Option<Check> {
    let carried = |j: usize| masses.shares.iter().map(|shares| shares[j]).sum::<f64>();
    let least = (0..masses.directions.len()).map(|j| (carried(j), j)).min_by(|a, b| a.0.total_cmp(&b.0));
    least.map(|(value, j)| Check {
        id: "M-19",
        name: "effective mass of the kept modes, least carried",
        equation: "min Σ (φᵀΨ_DᵀΓ)² / ΓᵀM_II⁻¹Γ, interface held, Γ = M_II U_I + M_IB U_B",
        value,
        limits: Limits::NONE,
        fail_above: f64::INFINITY,
        worst: Some(masses.directions[j].clone()),
    })
}
