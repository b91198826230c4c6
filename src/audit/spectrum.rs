//! The reduced pencil by itself: frequencies, modal masses, symmetry, definiteness, conditioning.

use faer::{Mat, MatRef};

use super::content::Content;
use crate::dense;
use crate::eigen::{eigenvalues, sharpen};
use crate::error::Result;
use crate::job::Boundary;
use crate::verification::check::{Check, Limits};
use crate::verification::limits::{Judged, n_nearly_free};

/// The eigenvalues that the checks need.
pub(super) struct Spectrum {
    /// Interface free.
    pub(super) free: Vec<f64>,
    /// Under the boundary of the modes, rigid-body modes left out.
    same_boundary: Vec<f64>,
}

impl Spectrum {
    pub(super) fn of(content: &Content<'_>) -> Result<Self> {
        let (k, m) = (content.k_of_pencil.as_ref(), content.m.as_ref());
        let n_zero = content.n_massive();
        let mut free = eigenvalues(k, m, content.first)?;
        sharpen(&mut free, (k, m), content.first, n_zero + content.kept.len())?;
        let same_boundary = match content.boundary {
            Boundary::FreeInterface => free.get(n_zero..).unwrap_or_default().to_vec(),
            Boundary::FixedInterface | Boundary::MixedInterface => {
                let moving = content.moving();
                let [k, m] = [content.k.as_ref(), m].map(|a| dense::part(a, &moving));
                let inner = (k.as_ref(), m.as_ref());
                let n_zero = if content.boundary == Boundary::MixedInterface { content.n_passing()? } else { 0 };
                // A heavy mass inside makes the held component far softer than the free one, whose first eigenvalue leaves it no digits.
                let near = content.kept.iter().copied().find(|lambda| *lambda > 0.0).unwrap_or(content.first);
                let mut held = eigenvalues(inner.0, inner.1, near)?;
                sharpen(&mut held, inner, near, n_zero + content.kept.len())?;
                held.split_off(n_zero.min(held.len()))
            }
        };
        Ok(Self { free, same_boundary })
    }
}

impl Spectrum {
    /// What the energy of rigid-body motion is compared with: the first elastic eigenvalue, or the one beyond motions that are nearly free.
    pub(super) fn of_energies(&self, content: &Content<'_>) -> f64 {
        match n_nearly_free(&self.free, content.n_massive()) {
            n_free if n_free > content.n_massive() => self.free[n_free],
            _ => content.first,
        }
    }
}

/// M-14: the eigenvalues of K̂ and M̂ are those the file names.
pub(super) fn frequencies(content: &Content<'_>, spectrum: &Spectrum) -> Check {
    let mut worst = (0.0, None);
    for (j, lambda) in content.kept.iter().enumerate() {
        let found = spectrum.same_boundary.get(j).copied().unwrap_or(f64::INFINITY);
        let difference = 0.5 * (found / lambda - 1.0).abs();
        if dense::worse(difference, worst.0) {
            worst = (difference, Some(format!("mode {}", j + 1)));
        }
    }
    let Judged { limits, fail_above } = content.frequency_limits();
    Check {
        id: "M-14",
        name: "reduced matrices have the stated frequencies",
        equation: "max |f(K̂, M̂) / f_stated − 1| under the boundary of the modes (34)–(35)",
        value: worst.0,
        limits,
        fail_above,
        worst: worst.1,
    }
}

/// M-03: the dynamic modes are mass-normalised, so that their block of M̂ is the identity. Of MacNeal's method M̂ sees the modes and
/// rigid-body motion alone instead.
pub(super) fn modal_masses(content: &Content<'_>) -> Result<Check> {
    match content.mass_rank {
        Some(rank) => massless(content, rank),
        None => Ok(unit_masses(content)),
    }
}

/// M-03: beyond the modes and rigid-body motion nothing has mass.
///
/// That these have theirs is seen in the frequencies (M-14) and the rigid-body mass (M-16). M̂ is a sum of squares, so that rounding leaves
/// r ε of the largest, and no square root of it.
fn massless(content: &Content<'_>, rank: usize) -> Result<Check> {
    let (values, vectors) = dense::symmetric_eigen(dense::unit_diagonal(content.m.as_ref()).0.as_ref())?;
    let r = values.len();
    // Ascending: the first r − rank are those of motions without mass.
    let of = |at: usize| values[at].abs() / values[r - 1].abs().max(f64::MIN_POSITIVE);
    let mut worst = (0.0, None);
    for at in 0..r - rank {
        if dense::worse(of(at), worst.0) {
            let part = |i: usize| vectors[(i, at)].abs();
            let largest = (0..r).max_by(|a, b| part(*a).total_cmp(&part(*b)));
            worst = (of(at), largest.map(|i| content.name_of(i)));
        }
    }
    Ok(Check {
        id: "M-03",
        name: "mass is that of the modes and of rigid-body motion",
        equation: "max |λ| / λ_max of D M̂ D with unit diagonal, beyond the largest n_r + n_modes",
        value: worst.0,
        limits: Limits { engineering: 1e-10, ..Limits::default() },
        fail_above: 1e-8,
        worst: worst.1,
    })
}

fn unit_masses(content: &Content<'_>) -> Check {
    let (b, r) = (content.n_b, content.n_reduced());
    let mut worst = (0.0, None);
    for j in b..r {
        for i in b..=j {
            let error = (content.m[(i, j)] - f64::from(u8::from(i == j))).abs();
            if dense::worse(error, worst.0) {
                worst = (error, Some(format!("{} and {}", content.name_of(i), content.name_of(j))));
            }
        }
    }
    let limits = content.inertia_limits();
    Check {
        id: "M-03",
        name: "modal masses are one",
        equation: "max |M̂_ηη − I|",
        value: worst.0,
        limits,
        fail_above: limits.value().max(1e-8),
        worst: worst.1,
    }
}

/// M-13: equation (29).
pub(super) fn block_coupling(content: &Content<'_>) -> Check {
    let mut worst = (0.0, None);
    for j in content.n_b..content.n_reduced() {
        for i in 0..content.n_b {
            let error = content.k[(i, j)].abs() * content.scale[i] * content.scale[j];
            if dense::worse(error, worst.0) {
                worst = (error, Some(format!("{} and {}", content.name_of(i), content.name_of(j))));
            }
        }
    }
    let limits = content.rounding_limits();
    Check {
        id: "M-13",
        name: "interface and modes uncoupled in stiffness",
        equation: "max |K̂_Bη|_ij, in scales of K̂ + λ₁M̂ (29)",
        value: worst.0,
        limits,
        fail_above: limits.value().max(1e-6),
        worst: worst.1,
    }
}

/// M-23: conditioning of M̂, which every explicit integrator and every initial acceleration divides by.
pub(super) fn condition(content: &Content<'_>) -> Result<Check> {
    let value = condition_on(content.m.as_ref(), content.mass_rank)?;
    Ok(Check {
        id: "M-23",
        name: "condition of the reduced mass",
        equation: "λ_max / λ_min of D M̂ D with unit diagonal",
        value,
        limits: Limits::NONE,
        fail_above: f64::INFINITY,
        worst: None,
    })
}

/// λ_max / λ_min of D M D with unit diagonal. A semidefinite mass is judged by M-25.
pub(crate) fn condition_of(m: MatRef<'_, f64>) -> Result<f64> {
    condition_on(m, None)
}

/// The condition of a mass on the motions that have any, of which there are as many as its rank.
fn condition_on(m: MatRef<'_, f64>, rank: Option<usize>) -> Result<f64> {
    let (values, _) = dense::symmetric_eigen(dense::unit_diagonal(m).0.as_ref())?;
    let n_massless = rank.map_or(0, |rank| values.len() - rank);
    let (least, most) = (values.get(n_massless).copied().unwrap_or(1.0), values.last().copied().unwrap_or(1.0));
    Ok(if least > 0.0 { most / least } else { 1.0 / f64::EPSILON })
}

/// M-25, symmetry: clients keep one triangle.
pub(super) fn symmetry(content: &Content<'_>) -> Check {
    let asymmetry = |a: &Mat<f64>| dense::symmetrise(&mut a.clone());
    Check {
        id: "M-25",
        name: "reduced matrices are symmetric to the bit",
        equation: "max |K̂ − K̂ᵀ|/|K̂|, |M̂ − M̂ᵀ|/|M̂|",
        value: asymmetry(&content.k).max(asymmetry(&content.m)),
        limits: Limits::default(),
        fail_above: 0.0,
        worst: None,
    }
}

/// The least eigenvalue of a mass brought to unit diagonal, where it is too negative to be that of a singular mass.
///
/// # Errors
/// As [`dense::symmetric_eigen`].
pub(crate) fn negative_mass(m: MatRef<'_, f64>) -> Result<Option<f64>> {
    /// Size of a negative eigenvalue that is taken for zero: rotations without inertia leave some.
    const SINGULAR_MASS: f64 = 1e-10;
    let (values, _) = dense::symmetric_eigen(dense::unit_diagonal(m).0.as_ref())?;
    Ok(values.first().copied().filter(|least| *least < -SINGULAR_MASS))
}

/// M-25, definiteness. As in a reduction a mass that is singular is not a failure; M-23 shows it.
pub(super) fn definiteness(content: &Content<'_>, spectrum: &Spectrum) -> Check {
    let (first, is_mass) = (spectrum.of_energies(content), matches!(negative_mass(content.m.as_ref()), Ok(None)));
    let (value, worst) = match spectrum.free.first() {
        _ if !is_mass => (f64::INFINITY, Some("the reduced mass has a negative eigenvalue".to_owned())),
        None if content.n_reduced() > 0 => (f64::INFINITY, Some("K̂ + λ₁M̂ is not definite".to_owned())),
        lowest => ((-lowest.copied().unwrap_or(0.0) / first).max(0.0), None),
    };
    let Judged { limits, fail_above } = content.energy_limits(first);
    Check {
        id: "M-25",
        name: "reduced mass and stiffness are not negative",
        equation: "λ_min(M̂) ≥ 0; max(0, −λ_min(K̂, M̂)) / λ₁",
        value,
        limits,
        fail_above,
        worst,
    }
}
