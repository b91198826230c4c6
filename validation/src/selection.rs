//! The modal basis of a variant, taken from a superelement that holds more than it needs.
//!
//! ```text
//! K̂, M̂   r × r        Herting's superelement, which spans its free-free modes exactly
//! x       r            a mode of K̂, M̂ with the dofs of some nodes held; in full X_I = Ψ_S x_B + Ψ_D x_η, X_B = x_B
//! T       r × (n_B + n)   [I 0; 0 x_η …]
//! ```
//! The mode-acceleration column of a mode is X_I − Ψ_S X_B (23), up to its length: in reduced coordinates just its part
//! x_η. So TᵀK̂T and TᵀM̂T are the superelement of the named modes alone, without inertia-relief modes; with no mode
//! at all it is Guyan's. Damping, gravity, loads and recovered rows go along.

use faer::{Mat, Side};
use supel::dense;
use supel_runtime::{Coordinate, Matrix, Metadata, Method, Recovery, Superelement, Tensors};

use crate::Result;

/// Which modes of the component are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Modes {
    /// The lowest ones of the free component, without its rigid-body modes.
    Free(usize),
    /// The lowest ones of the component with all six dofs of an interface node held.
    Held {
        /// Number of the interface node.
        node: usize,
        /// How many.
        count: usize,
    },
}

/// The superelement that keeps the static modes and some modes of a richer one.
///
/// # Errors
/// The mass matrix is singular, there are fewer modes than asked for, or the result is refused by the format.
pub fn selected(rich: &Superelement, modes: Modes) -> Result<Superelement> {
    let (n_b, tensors) = (rich.n_interface(), rich.tensors());
    let found = shapes(rich, modes)?;
    let n = found.frequencies.len();
    let transform = Mat::from_fn(rich.n_coordinates(), n_b + n, |i, j| match (i < n_b, j < n_b) {
        (true, true) => f64::from(u8::from(i == j)),
        (false, false) => found.shapes[(i, j - n_b)],
        _ => 0.0,
    });
    let rows =
        |matrix: &Matrix| Matrix::from_fn(n_b + n, matrix.cols(), |i, j| if i < n_b { matrix[(i, j)] } else { 0.0 });
    let tensors = Tensors {
        stiffness: congruence(&tensors.stiffness, &transform),
        mass: congruence(&tensors.mass, &transform),
        // Ψ_S U_B = U_I: rigid-body motion has no amplitudes.
        rigid_body_modes: rows(&tensors.rigid_body_modes),
        damping: tensors.damping.as_ref().map(|damping| on_both_sides(damping, &transform)),
        matrices: tensors.matrices.iter().map(|further| on_both_sides(further, &transform)).collect(),
        gravity: tensors.gravity.as_ref().map(|gravity| projected(gravity, &transform)),
        load_vectors: tensors.load_vectors.as_ref().map(|loads| projected(loads, &transform)),
        quantities: tensors.quantities.as_ref().map(|rows| on_the_right(rows, &transform)),
        recovery: tensors.recovery.as_ref().map(|recovery| recovered(recovery, &transform)).transpose()?,
        rigid_body_mass: tensors.rigid_body_mass.clone(),
        interface_positions: tensors.interface_positions.clone(),
        interface_frames: tensors.interface_frames.clone(),
        frequencies: found.frequencies.clone(),
        // The modes are not mixed.
        mixing: None,
    };
    Ok(Superelement::new(tensors, metadata(rich, modes, &found.frequencies))?)
}

fn metadata(rich: &Superelement, modes: Modes, frequencies: &[f64]) -> Metadata {
    let mut metadata = rich.metadata().clone();
    metadata.coordinates.truncate(rich.n_interface());
    metadata.coordinates.extend(frequencies.iter().enumerate().map(|(mode, omega)| Coordinate::ElasticMode {
        mode,
        frequency_hz: omega / std::f64::consts::TAU,
        error_bar_hz: None,
    }));
    metadata.method = if frequencies.is_empty() { Method::Guyan } else { Method::ModeAcceleration };
    metadata.validity.band_hz = None;
    metadata.dropped.clear();
    if let Modes::Held { node, .. } = modes {
        metadata.validity.assumptions.push(format!("the modes are those with interface node {node} held"));
    }
    metadata
}

/// Modes of a superelement: amplitudes of unit length, and angular frequencies.
struct Found {
    shapes: Mat<f64>,
    frequencies: Vec<f64>,
}

fn shapes(rich: &Superelement, modes: Modes) -> Result<Found> {
    let n_b = rich.n_interface();
    let (held, rigid, count) = match modes {
        Modes::Free(count) => (0..0, rich.n_rigid(), count),
        Modes::Held { node, count } => (6 * node..6 * node + 6, 0, count),
    };
    let free: Vec<usize> = (0..rich.n_coordinates()).filter(|i| !held.contains(i)).collect();
    if count > rich.n_modal() || rigid + count > free.len() {
        return Err(format!("{count} modes of a superelement that has {}", rich.n_modal()).into());
    }
    let part = |matrix: &Matrix| Mat::from_fn(free.len(), free.len(), |i, j| matrix[(free[i], free[j])]);
    let (values, vectors) = generalised_eigen(&part(&rich.tensors().stiffness), &part(&rich.tensors().mass))?;
    let first_modal = free.iter().position(|i| *i >= n_b).unwrap_or(free.len());
    let mut shapes = Mat::zeros(rich.n_coordinates(), count);
    for j in 0..count {
        let column = &dense::column(vectors.as_ref(), rigid + j)[first_modal..];
        let length = dense::norm(column);
        (0..column.len()).for_each(|i| shapes[(n_b + i, j)] = column[i] / length);
    }
    Ok(Found { shapes, frequencies: values[rigid..rigid + count].iter().map(|v| v.max(0.0).sqrt()).collect() })
}

/// K x = λ M x: λ ascending and the vectors as columns.
fn generalised_eigen(stiffness: &Mat<f64>, mass: &Mat<f64>) -> Result<(Vec<f64>, Mat<f64>)> {
    let n = mass.nrows();
    // Metres, radians and amplitudes brought to the same size.
    let scale: Vec<f64> = (0..n).map(|i| dense::power_of_two_root(mass[(i, i)])).collect();
    let scaled = |a: &Mat<f64>| Mat::from_fn(n, n, |i, j| a[(i, j)] * scale[i] * scale[j]);
    let factor = scaled(mass).llt(Side::Lower).map_err(|_| "the reduced mass matrix is singular")?;
    let lower = factor.L();
    let mut c = dense::standard_form(lower, scaled(stiffness));
    dense::symmetrise(&mut c);
    let (values, mut vectors) = dense::symmetric_eigen(c.as_ref())?;
    lower.transpose().solve_upper_triangular_in_place(&mut vectors);
    Ok((values, Mat::from_fn(n, n, |i, j| vectors[(i, j)] * scale[i])))
}

fn columns(a: &Matrix) -> Mat<f64> {
    Mat::from_fn(a.rows(), a.cols(), |i, j| a[(i, j)])
}

fn plain(a: &Mat<f64>) -> Matrix {
    Matrix::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)])
}

/// TᵀAT, symmetric to the bit.
fn congruence(a: &Matrix, t: &Mat<f64>) -> Matrix {
    let product = on_both_sides(a, t);
    Matrix::from_fn(t.ncols(), t.ncols(), |i, j| product[(i.max(j), i.min(j))])
}

/// TᵀAT.
fn on_both_sides(a: &Matrix, t: &Mat<f64>) -> Matrix {
    plain(&dense::gram(t.as_ref(), dense::product(columns(a).as_ref(), t.as_ref()).as_ref()))
}

/// TᵀB.
fn projected(b: &Matrix, t: &Mat<f64>) -> Matrix {
    plain(&dense::gram(t.as_ref(), columns(b).as_ref()))
}

/// Rows W T.
fn on_the_right(rows: &Matrix, t: &Mat<f64>) -> Matrix {
    plain(&dense::product(columns(rows).as_ref(), t.as_ref()))
}

/// Rows W T of the same nodes.
fn recovered(recovery: &Recovery, t: &Mat<f64>) -> Result<Recovery> {
    let rows = on_the_right(recovery.rows(), t);
    let new = Recovery::new(rows, recovery.dofs().to_vec(), recovery.precision())?;
    Ok(match recovery.positions() {
        Some(positions) => new.with_positions(positions.to_vec())?,
        None => new,
    })
}
