//! The modes that the coordinates are named after, as eigenpairs of the reduced pencil: M-14.
//!
//! ```text
//! q   n_η   amplitudes of a named mode: column of the inverse of the mixing
//! v   r     [v_B; q], v_B free or zero
//! ```
//! By equations (34) and (35) (K̂ − ω²M̂) v = 0 for some displacement v_B of the interface. It is not in the file and is
//! found by least squares; that something is left over tells that mixing, frequency and matrices do not belong together.

use faer::{Mat, MatRef};
use supel_runtime::Coordinate;

use super::content::Content;
use crate::dense::{self, NOISE_FACTOR, unpacked};
use crate::verification::check::{Check, Limits};
use crate::verification::limits::{Judged, LARGEST_EXCUSE};

/// What rounding of a mixing explains without a failure, though not without a warning: modes of near frequencies that the interface hardly
/// sees have columns that are nearly one, and no digits of amplitudes are left that tell them apart. Their frequencies are compared all
/// the same.
const LARGEST_EXPLAINED: f64 = 0.1;

/// The amplitudes of the coordinate's named columns, n_η × n_η: C⁻¹ of stored = named · C.
pub(super) fn named_amplitudes(content: &Content<'_>) -> Mat<f64> {
    let n = content.n_reduced() - content.n_b;
    match &content.superelement.tensors().mixing {
        Some(mixing) => dense::inverse(unpacked(mixing).as_ref()),
        None => Mat::identity(n, n),
    }
}

/// A mixing C and its inverse.
pub(super) type WithInverse<'a> = (MatRef<'a, f64>, MatRef<'a, f64>);

/// |X||C||C⁻¹| of C and its inverse: what ε makes an error of X C⁻¹ of where X already went through C, or of C⁻¹ itself where X is C⁻¹
/// (Higham 2002, section 14.1).
pub(super) fn terms_of_unmixing(x: MatRef<'_, f64>, (mixing, inverse): WithInverse<'_>) -> Mat<f64> {
    let [x, c, inverse] = [x, mixing, inverse].map(dense::absolute);
    dense::product(x.as_ref(), dense::product(c.as_ref(), inverse.as_ref()).as_ref())
}

/// M-14: backward error of the named modes.
pub(super) fn residual(content: &Content<'_>) -> Option<Check> {
    let amplitudes = named_amplitudes(content);
    let metadata = content.superelement.metadata();
    let named = metadata.coordinates[content.n_b..].iter().enumerate();
    let modes: Vec<(usize, usize)> =
        named.filter_map(|(slot, coordinate)| coordinate.mode().map(|(mode, _)| (slot, mode))).collect();
    if modes.is_empty() {
        return None;
    }
    let rounding = rounding_of_amplitudes(content, amplitudes.as_ref());
    let judged = |slot: usize| {
        let of_energies = content.rounding_limits();
        let arithmetic = of_energies.arithmetic.max(rounding[slot].min(LARGEST_EXCUSE));
        let limits = Limits { engineering: 1e-9, arithmetic, ..of_energies };
        Judged { limits, fail_above: limits.value().max(1e-6).max(rounding[slot].min(LARGEST_EXPLAINED)) }
    };
    let mut worst: (f64, Judged, Option<String>) = (0.0, judged(modes[0].0), None);
    for (slot, mode) in modes {
        let q = dense::column(amplitudes.as_ref(), slot);
        let (error, judged) = (backward_error(content, content.lambda[mode], q), judged(slot));
        if dense::worse(judged.severity(error), worst.1.severity(worst.0)) {
            worst = (error, judged, Some(format!("mode {}", mode + 1)));
        }
    }
    let (value, Judged { limits, fail_above }, at) = worst;
    Some(Check {
        id: "M-14",
        name: "named modes are eigenpairs of K̂ and M̂",
        equation: "max ‖K̂v − ω²M̂v‖ / ((‖K̂‖ + ω²‖M̂‖) ‖v‖), v of the mixing, in scales of K̂ + λ₁M̂",
        value,
        limits,
        fail_above,
        worst: at,
    })
}

/// What rounding of the mixing C makes of the amplitudes q of each named column, relative to the column: A = C⁻¹ is known to ε|A||C||A|.
/// Where a column keeps 10⁻⁸ of its length without those before it, C has entries of 10⁸.
fn rounding_of_amplitudes(content: &Content<'_>, amplitudes: MatRef<'_, f64>) -> Vec<f64> {
    let n = amplitudes.nrows();
    let Some(mixing) = &content.superelement.tensors().mixing else { return vec![0.0; n] };
    let errors = terms_of_unmixing(amplitudes, (unpacked(mixing).as_ref(), amplitudes));
    let scaled = |a: MatRef<'_, f64>, j: usize| {
        dense::norm(&(0..n).map(|i| a[(i, j)] / content.scale[content.n_b + i]).collect::<Vec<f64>>())
    };
    let of_column = |j: usize| NOISE_FACTOR * f64::EPSILON * scaled(errors.as_ref(), j) / scaled(amplitudes, j);
    (0..n).map(of_column).collect()
}

/// M-03: without an interface the named columns are rigid-body modes and modes, whose inertia is known: M̂ = Cᵀ [M_F 0; 0 I] C. Static
/// answers, to loads or to the inertia of the modes of a file, have an inertia that the file does not tell.
pub(super) fn mixing(content: &Content<'_>) -> Option<Check> {
    let mixing = content.superelement.tensors().mixing.as_ref().filter(|_| content.n_b == 0)?;
    let coordinates = &content.superelement.metadata().coordinates;
    let is_answer = |coordinate: &Coordinate| {
        matches!(coordinate, Coordinate::ExpansionMode { .. } | Coordinate::ResidualVector { .. })
    };
    if coordinates.iter().any(is_answer) {
        return None;
    }
    let inertia = |i: usize, j: usize| match (&coordinates[i], &coordinates[j]) {
        (Coordinate::RigidBodyMode { index: a }, Coordinate::RigidBodyMode { index: b }) => {
            if *a.max(b) < content.n_rigid() { content.m_f[(*a, *b)] } else { f64::NAN }
        }
        _ => f64::from(u8::from(i == j)),
    };
    let (n, c) = (coordinates.len(), unpacked(mixing));
    let named = Mat::from_fn(n, n, inertia);
    let expected = dense::gram(c.as_ref(), dense::product(named.as_ref(), c.as_ref()).as_ref());
    let mut worst = (0.0, None);
    for j in 0..n {
        for i in 0..=j {
            let error = (expected[(i, j)] - content.m[(i, j)]).abs();
            if dense::worse(error, worst.0) {
                worst = (error, Some(format!("{} and {}", content.name_of(i), content.name_of(j))));
            }
        }
    }
    Some(Check {
        id: "M-03",
        name: "mixing makes the named modes orthonormal",
        equation: "max |M̂ − Cᵀ [M_F 0; 0 I] C|",
        value: worst.0,
        limits: Limits { engineering: 1e-10, ..Limits::default() },
        fail_above: 1e-8,
        worst: worst.1,
    })
}

fn backward_error(content: &Content<'_>, lambda: f64, q: &[f64]) -> f64 {
    let (r, b) = (content.n_reduced(), content.n_b);
    let d = &content.scale;
    let dynamic = Mat::from_fn(r, r, |i, j| (content.k[(i, j)] - lambda * content.m[(i, j)]) * d[i] * d[j]);
    let amplitude = Mat::from_fn(r - b, 1, |i, _| q[i] / d[b + i]);
    // A held interface takes up the reaction: its rows are not part of the eigenproblem.
    let moving = content.moving();
    let rows = dense::part(dynamic.as_ref(), &moving);
    let (n_free, n_moving) = (moving.len() - (r - b), moving.len());
    let mut residual = dense::product(rows.as_ref().subcols(n_free, n_moving - n_free), amplitude.as_ref());
    let mut motion = dense::norm(dense::column(amplitude.as_ref(), 0)).powi(2);
    if n_free > 0 {
        let interface = rows.as_ref().subcols(0, n_free);
        let mut load = residual.clone();
        load *= faer::Scale(-1.0);
        let displacement = dense::least_squares(interface, load.as_ref());
        dense::add_product(residual.as_mut(), 1.0, interface, displacement.as_ref());
        motion += dense::norm(dense::column(displacement.as_ref(), 0)).powi(2);
    }
    let norm = |a: &Mat<f64>| {
        let column = |j: usize| (0..r).map(|i| (a[(i, j)] * d[i] * d[j]).abs()).sum::<f64>();
        (0..r).map(column).fold(0.0, f64::max)
    };
    let size = norm(&content.k) + lambda * norm(&content.m);
    dense::norm(dense::column(residual.as_ref(), 0)) / (size * motion.sqrt())
}

/// The inertia-relief coordinates: slot among the modal ones and number of the rigid-body mode.
pub(super) fn relief(content: &Content<'_>) -> Vec<(usize, usize)> {
    let coordinates = &content.superelement.metadata().coordinates[content.n_b..];
    let of = |(slot, coordinate): (usize, &Coordinate)| match *coordinate {
        Coordinate::InertiaRelief { index } => Some((slot, index)),
        _ => None,
    };
    coordinates.iter().enumerate().filter_map(of).collect()
}
