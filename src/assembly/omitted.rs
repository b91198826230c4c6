//! What a superelement leaves out, as far as its file tells: from which frequency on, and with how much mass at most.
//!
//! ```text
//! u = Ψ p + Q o          Q: the omitted motions of the interior, ΨᵀKQ = 0, QᵀMQ = 1
//! Λ = QᵀKQ ⪰ κ           no omitted motion is slower than the modes that were kept
//! C = ΨᵀMQ,  C Cᵀ ⪯ S    S = M̂ − M̂V (VᵀM̂V)⁻¹ VᵀM̂,  V: shapes that are exact in the full model
//! ```
//! *Stiffness.* The columns of Ψ on the interface are constraint modes, in equilibrium inside; so motions Q of the interior can be
//! chosen orthogonal to all of Ψ in K. An exact shape x = Ψv has Kx = λMx inside, and QᵀMx = QᵀKx/λ = 0; for rigid-body motions the
//! inertia-relief modes do the same, K_II Ψ_IRM = (MU)_I. So CᵀV = 0, and a motion of Q is orthogonal in M to every mode that was
//! kept: its Rayleigh quotient is not below κ, the end of the band that was counted to be complete. With the interface held the modes
//! are those of K_II alone and the argument is the one of the interior; with some of it held Q is at rest there, too, and Kx = λMx holds
//! wherever Q moves.
//!
//! *Mass.* The mass of Ψ and Q together is not negative. Taking V out of it, which couples with nothing of Q, leaves S − C Cᵀ ⪰ 0.
//!
//! What joins the components to each other and to the ground acts on the interface, where Q is zero. So the full assembly, condensed to
//! the reduced coordinates at λ < κ, is K̂ − λM̂ − λ² X with X = C (Λ − λ)⁻¹ Cᵀ ⪯ S/(κ − λ).
//!
//! *Free modes* say more. All that is orthogonal in M to them is not slower than κ with the interface free either, the other eigenvectors z
//! of K̂, M̂ and Q together: with a = zᵀK̂z ≥ κ at unit modal mass, C (Λ/κ − 1)⁻¹ Cᵀ ⪯ A = diag(a/κ − 1) in these coordinates, where
//! S is the identity. As 1/(Λ − λ) is the parallel sum of 1/(κ − λ) and of 1/(Λ − κ), and a parallel sum of projections is not below the
//! projection of the parallel sum, X ⪯ S/(κ − λ) : A/κ = diag 1/(κ′ − λ) with κ′ = κa/(a − κ) (Anderson and Duffin, *Series and parallel
//! addition of matrices*, 1969).
//!
//! Either way X ⪯ Σ g gᵀ/(κ′ − λ), κ′ ≥ κ, and the right-hand side is that of a linear eigenproblem, in which the mass S = GGᵀ, taken
//! off M̂, hangs on springs of the frequencies κ′:
//! ```text
//! ⎡K̂ + Gκ′Gᵀ  −Gκ′⎤ ⎡x⎤     ⎡M̂ − GGᵀ   ⎤ ⎡x⎤
//! ⎣  −κ′Gᵀ      κ′ ⎦ ⎣y⎦ = λ ⎣         1 ⎦ ⎣y⎦
//! ```
//! Below κ it has no fewer eigenvalues than the full assembly. So no frequency of that is below the lesser of κ and the one of the same
//! number here.

use faer::{Mat, MatRef};
use supel_runtime::{Coordinate, Superelement, Verdict};

use super::spectrum::{Pencil, Spectrum};
use crate::dense;
use crate::error::Result;
use crate::job::{Boundary, Method, ModeOrigin};
use crate::rigid::n_passing;

/// How far λ of the reduced matrices may be from the one that the file states for the shape to count as exact.
const SAME_EIGENVALUE: f64 = 1e-6;
/// The check that counts the modes.
const COMPLETENESS: &str = "M-06";

/// What a superelement leaves out of the motions of its full model.
#[derive(Clone, Debug, PartialEq)]
pub enum Omitted {
    /// Nothing: its coordinates are all there are.
    Nothing,
    /// Motions from a frequency on.
    Above {
        /// √κ/2π.
        hz: f64,
        /// Their mass.
        mass: SprungMass,
    },
    /// The file does not say.
    Unknown {
        /// Why not, and what to do.
        why: String,
    },
    /// The file contradicts itself, or failed a check: its matrices need not be those of a reduction, which alone has no frequency below that of
    /// the full model.
    InDoubt {
        /// What tells so, and what to do.
        why: String,
    },
}

impl Omitted {
    fn unknown(why: &str) -> Self {
        Self::Unknown { why: why.to_owned() }
    }

    fn in_doubt(why: &str) -> Self {
        Self::InDoubt { why: why.to_owned() }
    }
}

/// The mass that omitted motions have at most, on springs.
#[derive(Clone, Debug, PartialEq)]
pub struct SprungMass {
    /// G, r × number of springs.
    pub(super) factor: Mat<f64>,
    /// κ′ of each spring, not below κ.
    pub(super) springs: Vec<f64>,
}

/// What a superelement of the matrices K̂, M̂ and the motions Û leaves out.
pub(super) fn omitted(
    superelement: &Superelement,
    k: MatRef<'_, f64>,
    m: MatRef<'_, f64>,
    u: MatRef<'_, f64>,
) -> Result<Omitted> {
    if superelement.metadata().verification.verdict == Verdict::Fail {
        return Ok(Omitted::in_doubt("a check had failed when it was made; reduce it again"));
    }
    if is_whole(superelement) {
        return Ok(Omitted::Nothing);
    }
    let (boundary, hz) = match kept(superelement) {
        Ok(kept) => kept,
        Err(why) => return Ok(Omitted::Unknown { why }),
    };
    let kappa = (std::f64::consts::TAU * hz).powi(2);
    let mass = match boundary {
        Boundary::FreeInterface => of_free_modes(superelement, (k, m, u), kappa)?,
        Boundary::FixedInterface | Boundary::MixedInterface => of_held_modes(superelement, (k, m, u), kappa)?,
    };
    Ok(mass.map_or_else(|without| without, |mass| Omitted::Above { hz, mass }))
}

/// Whether the coordinates are as many as the dofs of the model, and none stands for several of them.
fn is_whole(superelement: &Superelement) -> bool {
    let metadata = superelement.metadata();
    let has_patch = metadata.interface_nodes.iter().any(|node| node.label.is_none());
    !has_patch && metadata.coordinates.len() as u64 >= metadata.model.n_dofs
}

/// The boundary of the modes that were kept, and the frequency below which none is missing; or why that is unknown.
fn kept(superelement: &Superelement) -> Result<(Boundary, f64), String> {
    let metadata = superelement.metadata();
    let name = metadata.method.name();
    let method =
        Method::of_file(metadata.method).ok_or_else(|| format!("its method, {name}, is not one of this program"))?;
    match method.modes() {
        ModeOrigin::Computed => {}
        ModeOrigin::File => return Err("its modes come from a file, which may leave out any others".to_owned()),
        ModeOrigin::None => {
            return Err(format!(
                "{name} keeps no modes, and its file does not say where those that it leaves out begin"
            ));
        }
    }
    if !metadata.validity.unloaded.is_empty() {
        return Err("it was reduced for loads on some of its interface dofs alone".to_owned());
    }
    if !metadata.verification.checks.iter().any(|check| check.id == COMPLETENESS) {
        return Err("its modes were not counted; reduce it with run.certify = \"count\" (reduce --certify)".to_owned());
    }
    let of_motions = |coordinate: &Coordinate| {
        matches!(coordinate, Coordinate::InertiaRelief { .. } | Coordinate::RigidBodyMode { .. })
    };
    let boundary = method.boundary().holding(metadata.modes_held.len(), superelement.n_interface());
    if boundary == Boundary::FreeInterface && n_named(superelement, of_motions) < superelement.n_rigid() {
        return Err("it has free modes without an inertia-relief mode for each rigid-body mode".to_owned());
    }
    let Some([_, end]) = metadata.validity.band_hz.filter(|[_, end]| *end > 0.0) else {
        return Err(
            "it keeps no mode above zero, and its file does not say where those that it leaves out begin".to_owned()
        );
    };
    // The modes that were left out are not slower than the last one that was kept, which is known up to its bar.
    let bars = metadata.coordinates.iter().filter_map(|coordinate| {
        let (_, frequency_hz) = coordinate.mode()?;
        (frequency_hz >= 0.5 * end).then_some(coordinate.error_bar_hz().unwrap_or(0.0))
    });
    let from = end - bars.fold(0.0, f64::max);
    if from > 0.0 {
        Ok((boundary, from))
    } else {
        Err("the error bars of its modes are as large as their frequencies".to_owned())
    }
}

/// How many coordinates of a kind the file names, those included that were dropped because others span them.
fn n_named(superelement: &Superelement, is_one: impl Fn(&Coordinate) -> bool) -> usize {
    superelement.metadata().named_columns().filter(|coordinate| is_one(coordinate)).count()
}

/// The omitted mass next to free modes: what is left of M̂ beyond them, each direction on a spring of its own.
fn of_free_modes(
    superelement: &Superelement,
    (k, m, u): (MatRef<'_, f64>, MatRef<'_, f64>, MatRef<'_, f64>),
    kappa: f64,
) -> Result<Result<SprungMass, Omitted>> {
    let spectrum = match stated_spectrum(superelement, (k, m), dense::orthonormal(u, m))? {
        Ok(spectrum) => spectrum,
        Err(without) => return Ok(Err(without)),
    };
    let others = superelement.frequencies_kept().len()..spectrum.lambda.len();
    if others.clone().any(|j| spectrum.lambda[j] < (1.0 - SAME_EIGENVALUE) * kappa) {
        return Ok(Err(Omitted::in_doubt(OTHER_FREQUENCIES)));
    }
    // A direction at κ itself couples with nothing: its spring is rigid.
    let sprung: Vec<usize> = others.filter(|j| spectrum.lambda[*j] > kappa).collect();
    let shapes = dense::columns(spectrum.shapes.as_ref(), &sprung);
    let springs = sprung.iter().map(|j| kappa / (1.0 - kappa / spectrum.lambda[*j])).collect();
    Ok(Ok(SprungMass { factor: dense::product(m, shapes.as_ref()), springs }))
}

/// The omitted mass next to modes with the interface held, or some of it: what is left of M̂ beyond them, and beyond the rigid-body motions where
/// inertia-relief modes make these uncoupled.
fn of_held_modes(
    superelement: &Superelement,
    (k, m, u): (MatRef<'_, f64>, MatRef<'_, f64>, MatRef<'_, f64>),
    kappa: f64,
) -> Result<Result<SprungMass, Omitted>> {
    let (r, n_b) = (superelement.n_coordinates(), superelement.n_interface());
    let named = &superelement.metadata().modes_held;
    let held: Vec<usize> = if named.is_empty() { (0..n_b).collect() } else { named.clone() };
    let scales: Vec<f64> = (0..n_b).map(|i| dense::power_of_two_root(k[(i, i)])).collect();
    if held.len() < n_b && n_passing(u.subrows(0, n_b), &scales, &held)? > 0 {
        let why = "its modes were computed with some of its interface held, which lets it move as a rigid body";
        return Ok(Err(Omitted::unknown(why)));
    }
    let moving: Vec<usize> = (0..r).filter(|at| !held.contains(at)).collect();
    let [k, inner_m] = [k, m].map(|a| dense::part(a, &moving));
    let spectrum = match stated_spectrum(superelement, (k.as_ref(), inner_m.as_ref()), Mat::zeros(moving.len(), 0))? {
        Ok(spectrum) => spectrum,
        Err(without) => return Ok(Err(without)),
    };
    let n_modes = superelement.frequencies_kept().len();
    let mut modes = Mat::zeros(r, n_modes);
    for (row, at) in moving.iter().enumerate() {
        (0..n_modes).for_each(|j| modes[(*at, j)] = spectrum.shapes[(row, j)]);
    }
    let is_relief = |coordinate: &Coordinate| matches!(coordinate, Coordinate::InertiaRelief { .. });
    let is_uncoupled = n_named(superelement, is_relief) >= u.ncols();
    let exact = if is_uncoupled { dense::side_by_side(modes.as_ref(), u) } else { modes };
    let factor = omitted_mass(m, exact.as_ref())?;
    let springs = vec![kappa; factor.ncols()];
    Ok(Ok(SprungMass { factor, springs }))
}

/// Why no shape of the reduced matrices counts as exact.
const OTHER_FREQUENCIES: &str =
    "its matrices do not have the frequencies that it states to the digits that bounds need";

/// The elastic spectrum of reduced matrices, which begins with the frequencies that the file states; or why it is not to be used.
fn stated_spectrum(
    superelement: &Superelement,
    (k, m): (MatRef<'_, f64>, MatRef<'_, f64>),
    rigid: Mat<f64>,
) -> Result<Result<Spectrum, Omitted>> {
    let Some(spectrum) = Pencil::of(k, m, rigid).spectrum(None)? else {
        return Ok(Err(Omitted::in_doubt(OTHER_FREQUENCIES)));
    };
    let stated: Vec<f64> = superelement.frequencies_kept().iter().map(|omega| omega * omega).collect();
    let is_found = |(j, stated): (usize, &f64)| {
        let found = spectrum.lambda.get(j);
        found.is_some_and(|found| (found - stated).abs() <= SAME_EIGENVALUE * stated + spectrum.rounding[j])
    };
    if !stated.iter().enumerate().all(is_found) {
        return Ok(Err(Omitted::in_doubt(OTHER_FREQUENCIES)));
    }
    // QᵀMx = QᵀKx/λ says nothing of a motion without energy.
    if stated.iter().zip(&spectrum.rounding).any(|(stated, rounding)| stated <= rounding) {
        let why = "it keeps a mode of frequency zero, with which motions that it leaves out may couple";
        return Ok(Err(Omitted::unknown(why)));
    }
    Ok(Ok(spectrum))
}

/// G of S = M̂ − M̂V (VᵀM̂V)⁻¹ VᵀM̂ = GGᵀ.
fn omitted_mass(m: MatRef<'_, f64>, exact: MatRef<'_, f64>) -> Result<Mat<f64>> {
    let n = m.nrows();
    let shapes = dense::orthonormal(exact, m);
    let momenta = dense::product(m, shapes.as_ref());
    let taken = dense::product(momenta.as_ref(), momenta.transpose());
    let scale: Vec<f64> = (0..n).map(|i| dense::power_of_two_root(m[(i, i)])).collect();
    let mut rest = Mat::from_fn(n, n, |i, j| (m[(i, j)] - taken[(i, j)]) * scale[i] * scale[j]);
    dense::symmetrise(&mut rest);
    let (values, vectors) = dense::symmetric_eigen(rest.as_ref())?;
    // Below, S is the rounding of the difference.
    let kept: Vec<usize> = (0..n).filter(|j| values[*j] > n as f64 * f64::EPSILON).collect();
    Ok(Mat::from_fn(n, kept.len(), |i, j| vectors[(i, kept[j])] * values[kept[j]].sqrt() / scale[i]))
}
