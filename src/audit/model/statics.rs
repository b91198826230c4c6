//! Rigid and static motions of the full model against K̂_BB and M̂_BB: M-05, M-10, M-16, M-17, M-18.

use faer::linalg::solvers::SolveLstsq;
use faer::{Mat, MatRef};

use super::full::{Full, Solutions};
use super::scaled::Scaled;
use crate::dense;
use crate::error::Result;
use crate::modes::SplitMix64;
use crate::rigid::absolute_energy;
use crate::sparse::product;
use crate::verification::check::{Check, Limits};

/// Loads solved at most: more interface motions than these are mixed at random.
const MAX_LOADS: usize = 48;
/// Seed of the mixing.
const SEED: u64 = 0xa0d1;
/// Roundings of one sign may exceed their typical sum by this.
const NOISE_FACTOR: f64 = 10.0;
/// The most that rounding may excuse.
const LARGEST_EXCUSE: f64 = 1e-3;

/// M-05: how many motions of the full model are free.
pub(super) fn rigid_body_count(scaled: &Scaled, full: &Full<'_>) -> Check {
    let (stored, found) = (scaled.u.ncols(), full.rigid.count());
    Check {
        id: "M-05",
        name: "full model has as many free motions",
        equation: "|zero modes of K − n_r|, by inverse iteration",
        value: stored.abs_diff(found) as f64,
        limits: Limits::default(),
        fail_above: 0.0,
        worst: Some(format!("{found} in the model, {stored} in the file")),
    }
}

/// M-05: Û moves the interface as zero modes of the full model do; M-16: and has their inertia.
pub(super) fn rigid_body_modes(scaled: &Scaled, full: &Full<'_>) -> Vec<Check> {
    let n_r = scaled.u.ncols();
    if n_r == 0 {
        return Vec::new();
    }
    let u_b = scaled.u.as_ref().subrows(0, scaled.n_b);
    let q_b = full.rigid_interface();
    // Rows weighted by inertia make translations and rotations count alike.
    let weight: Vec<f64> = (0..scaled.n_b).map(|i| scaled.m[(i, i)].max(0.0).sqrt()).collect();
    let weighted = |a: MatRef<'_, f64>| Mat::from_fn(a.nrows(), a.ncols(), |i, j| weight[i] * a[(i, j)]);
    let (q, u) = (weighted(q_b), weighted(u_b));
    let combination = q.qr().solve_lstsq(&u);
    let mut left = u.clone();
    dense::add_product(left.as_mut(), -1.0, q.as_ref(), combination.as_ref());
    let ratio = |j: usize| dense::norm(dense::column(left.as_ref(), j)) / dense::norm(dense::column(u.as_ref(), j));
    let value = (0..n_r).map(ratio).fold(0.0, |worst, error| if dense::worse(error, worst) { error } else { worst });
    let arithmetic = (NOISE_FACTOR * f64::EPSILON * full.condition()).min(LARGEST_EXCUSE);
    let limits = full.by_roundings(scaled, Limits { engineering: 1e-9, arithmetic, data: 0.0 });
    // QᵀMQ = I, so that U = Q A has the inertia AᵀA.
    let inertia = dense::gram(combination.as_ref(), combination.as_ref());
    let mut worst = (0.0, None);
    for j in 0..n_r {
        for i in 0..=j {
            let size = (inertia[(i, i)] * inertia[(j, j)]).sqrt();
            let error = (inertia[(i, j)] - scaled.m_f[(i, j)]).abs() / size;
            if dense::worse(error, worst.0) {
                worst = (error, Some(format!("rigid-body modes {} and {}", i + 1, j + 1)));
            }
        }
    }
    vec![
        Check {
            id: "M-05",
            name: "rigid-body modes are free in the full model",
            equation: "max ‖Û_B − Q_B A‖ / ‖Û_B‖, Q by inverse iteration",
            value,
            limits,
            fail_above: limits.value().max(1e-6),
            worst: None,
        },
        Check {
            id: "M-16",
            name: "rigid-body mass is that of the full model",
            equation: "max |M_F − AᵀQᵀMQA|_ij / √(ii jj)",
            value: worst.0,
            limits,
            fail_above: limits.value().max(1e-6),
            worst: worst.1,
        },
    ]
}

/// Static answers of the full model to loads on the interface.
pub(super) struct Answers {
    /// F, n_B × k.
    loads: Mat<f64>,
    /// What F is made of: FᵀK̂⁺F = mixingᵀ mixing · λ₁.
    mixing: Mat<f64>,
    solutions: Solutions,
    /// [U Q], n' × (k + n_r): motions whose interior is in equilibrium.
    pub(super) motions: Mat<f64>,
    /// [U Q]_B.
    pub(super) interface: Mat<f64>,
}

impl Answers {
    pub(super) fn of(scaled: &Scaled, full: &Full<'_>) -> Result<Self> {
        let all = scaled.interface_loads(full.first)?;
        let mixing = mixing(all.ncols());
        let loads = dense::product(all.as_ref(), mixing.as_ref());
        let solutions = full.solve_interface_loads(loads.as_ref());
        let (u, q) = (solutions.u.as_ref(), full.rigid.orthonormal.as_ref());
        let k = u.ncols();
        let motions = Mat::from_fn(u.nrows(), k + q.ncols(), |i, j| if j < k { u[(i, j)] } else { q[(i, j - k)] });
        let interface = motions.as_ref().subrows(full.partition.n_internal, scaled.n_b).to_owned();
        Ok(Self { loads, mixing, solutions, motions, interface })
    }

    fn count(&self) -> usize {
        self.loads.ncols()
    }

    /// Rounding of the energies, relative to the first elastic eigenvalue: ε times the terms before they cancel.
    fn rounding(&self, full: &Full<'_>) -> f64 {
        let terms = absolute_energy(&full.partition.stiffness, self.solutions.u.as_ref());
        let largest = terms.into_iter().fold(0.0, f64::max);
        (NOISE_FACTOR * f64::EPSILON * largest / full.first).min(LARGEST_EXCUSE)
    }
}

/// The identity, or as many random mixtures of unit length as are solved.
fn mixing(n: usize) -> Mat<f64> {
    if n <= MAX_LOADS {
        return Mat::identity(n, n);
    }
    let mut mixing = Mat::zeros(n, MAX_LOADS);
    SplitMix64::new(SEED).fill(mixing.as_mut());
    for j in 0..MAX_LOADS {
        let column = dense::column_mut(mixing.as_mut(), j);
        let length = dense::norm(column);
        column.iter_mut().for_each(|value| *value /= length);
    }
    mixing
}

/// M-10: how well the full model was solved.
pub(super) fn solves(full: &Full<'_>, answers: &Answers) -> Check {
    let arithmetic = (f64::EPSILON * full.condition()).min(LARGEST_EXCUSE);
    let limits = Limits { engineering: 1e-10, arithmetic, data: 0.0 };
    Check {
        id: "M-10",
        name: "static loads on the full model were solved",
        equation: "max ‖f − Ku‖ / ‖f‖ in the norm of (K − σM)⁻¹, by conjugate gradients",
        value: answers.solutions.residual,
        limits,
        fail_above: limits.value().max(1e-6),
        worst: Some(format!("{} loads on the interface", answers.count())),
    }
}

/// M-17: full and reduced model move the interface alike under every load on it.
pub(super) fn stiffness(scaled: &Scaled, full: &Full<'_>, answers: &Answers) -> Check {
    let k = answers.count();
    let work = dense::gram(answers.loads.as_ref(), answers.interface.as_ref().subcols(0, k));
    let expected = dense::gram(answers.mixing.as_ref(), answers.mixing.as_ref());
    let mut worst = (0.0, None);
    for j in 0..k {
        for i in 0..k {
            let error = (work[(i, j)] / full.first - expected[(i, j)]).abs();
            if dense::worse(error, worst.0) {
                worst = (error, Some(format!("loads {} and {} of {k}", i + 1, j + 1)));
            }
        }
    }
    let limits = full.by_roundings(scaled, Limits { engineering: 1e-9, arithmetic: answers.rounding(full), data: 0.0 });
    Check {
        id: "M-17",
        name: "static stiffness is that of the full model",
        equation: "max |FᵀU_B − FᵀK̂_BB⁺F| / λ₁, F of unit energy in every direction, K U = F",
        value: worst.0,
        limits,
        fail_above: limits.value().max(1e-6),
        worst: worst.1,
    }
}

/// M-16: rigid and static motions have the same inertia in both models.
pub(super) fn mass(scaled: &Scaled, full: &Full<'_>, answers: &Answers) -> Check {
    let momenta = product(&full.partition.mass, answers.motions.as_ref());
    let inertia = dense::gram(answers.motions.as_ref(), momenta.as_ref());
    let m_bb = scaled.m.as_ref().submatrix(0, 0, scaled.n_b, scaled.n_b);
    let reduced = dense::gram(answers.interface.as_ref(), dense::product(m_bb, answers.interface.as_ref()).as_ref());
    let mut worst = (0.0, None);
    for j in 0..inertia.ncols() {
        for i in 0..=j {
            // Energies of λ₁ and unit inertia of the zero modes: no entry is above one.
            let error = (inertia[(i, j)] - reduced[(i, j)]).abs();
            if dense::worse(error, worst.0) {
                worst = (error, Some(format!("motions {} and {} of {}", i + 1, j + 1, inertia.ncols())));
            }
        }
    }
    let limits =
        full.by_roundings(scaled, Limits { engineering: 1e-9, arithmetic: rounding_of_motion(full), data: 0.0 });
    Check {
        id: "M-16",
        name: "inertia of motions is that of the full model",
        equation: "max |ZᵀMZ − Z_BᵀM̂_BB Z_B|, Z zero modes and static answers",
        value: worst.0,
        limits,
        fail_above: limits.value().max(1e-6),
        worst: worst.1,
    }
}

/// Rounding of a displacement relative to its length: that of K amplified by its condition.
fn rounding_of_motion(full: &Full<'_>) -> f64 {
    (NOISE_FACTOR * f64::EPSILON * full.condition()).min(LARGEST_EXCUSE)
}

/// M-18: loads of gravity do the same work on these motions.
pub(super) fn gravity(scaled: &Scaled, full: &Full<'_>, answers: &Answers) -> Option<Check> {
    let stored = scaled.gravity.as_ref()?;
    let sites = full.partition.sites()?;
    let along = Mat::from_fn(sites.len(), 3, |i, j| {
        f64::from(u8::from(!sites[i].direction.is_rotation() && sites[i].direction.axis() == j))
    });
    let loads = product(&full.partition.mass, along.as_ref());
    let total = dense::gram(along.as_ref(), loads.as_ref());
    let work = dense::gram(answers.motions.as_ref(), loads.as_ref());
    let reduced = dense::gram(answers.interface.as_ref(), stored.as_ref().subrows(0, scaled.n_b));
    let mut worst = (0.0, None);
    for j in 0..3 {
        for i in 0..work.nrows() {
            let error = (work[(i, j)] - reduced[(i, j)]).abs() / total[(j, j)].sqrt();
            if dense::worse(error, worst.0) {
                worst = (error, Some(format!("along {}", ["x", "y", "z"][j])));
            }
        }
    }
    let limits =
        full.by_roundings(scaled, Limits { engineering: 1e-9, arithmetic: rounding_of_motion(full), data: 0.0 });
    Some(Check {
        id: "M-18",
        name: "loads of gravity are those of the full model",
        equation: "max |ZᵀMe − Z_Bᵀg| / √m",
        value: worst.0,
        limits,
        fail_above: limits.value().max(1e-6),
        worst: worst.1,
    })
}
