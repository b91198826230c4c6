//! Where a response is looked at: at the interface dofs, and at the outputs of the scene inside.
//!
//! ```text
//! H = P_B [1 − (z + α) θ]⁻¹ P_Bᵀ               n_B × n_B   between interface dofs
//! H_o = T_o Ψ P [1 − (z + α) θ]⁻¹ P_Bᵀ         n_o × n_B   displacement at outputs; rotations times the length
//! ```
//! T_o are the rows of T that outputs follow, Ψ the basis whose coordinates the pencil has.

use faer::{Mat, MatRef, c64};

use super::super::evidence::Evidence;
use super::interfaces::{interface_lengths, rotation_length};
use crate::cache::{Reader, Writer};
use crate::eigen::{Spectral, complex_shift};
use crate::partition::{Output, Partition};
use crate::reduction::panel_of;

/// A model in spectral form, with what outputs see of it.
pub(super) struct Observed<'s> {
    at_interface: &'s Spectral,
    inside: Option<Inside<'s>>,
}

/// What outputs see.
struct Inside<'s> {
    spectral: &'s Spectral,
    /// T_o Ψ P, n_o × r.
    shapes: Mat<f64>,
    /// What turns displacements of the interface dofs into lengths.
    lengths: Vec<f64>,
}

impl<'s> Observed<'s> {
    /// A model whose leading coordinates are the interface dofs. A file need not have the shapes inside: outputs see the model whose
    /// coordinates they are rows for.
    pub(super) fn new(at_interface: &'s Spectral, of_outputs: &'s Spectral, outputs: &Outputs<'_>) -> Self {
        let inside = (outputs.rows.nrows() > 0).then(|| Inside {
            spectral: of_outputs,
            shapes: of_outputs.shapes_at(outputs.rows.as_ref().subcols(0, of_outputs.n())),
            lengths: interface_lengths(outputs.partition),
        });
        Self { at_interface, inside }
    }

    /// r.
    pub(super) fn n(&self) -> usize {
        self.at_interface.n()
    }

    /// n_o r.
    pub(super) fn n_seen(&self) -> f64 {
        self.inside.as_ref().map_or(0.0, |inside| inside.shapes.nrows() as f64 * inside.shapes.ncols() as f64)
    }
}

/// Outputs with their rows of a basis.
pub(super) struct Outputs<'p> {
    partition: &'p Partition,
    /// T_o Ψ, n_o × r.
    rows: Mat<f64>,
}

impl<'p> Outputs<'p> {
    /// Outputs of the scene, by their numbers, on a basis of n' rows.
    pub(super) fn on(partition: &'p Partition, numbers: &[usize], basis: MatRef<'_, f64>) -> Self {
        let length = rotation_length(partition);
        let mut rows = Mat::zeros(numbers.len(), basis.ncols());
        for (at, number) in numbers.iter().enumerate() {
            for (k, t) in entries(partition, *number, length) {
                for j in 0..basis.ncols() {
                    rows[(at, j)] += t * basis[(k, j)];
                }
            }
        }
        Self { partition, rows }
    }

    /// A unit force on an output as the internal dofs have it, n_I × 1.
    pub(super) fn on_dofs(partition: &Partition, number: usize) -> Mat<f64> {
        let mut load = Mat::zeros(partition.n_internal, 1);
        let entries = entries(partition, number, rotation_length(partition));
        entries.filter(|(k, _)| *k < partition.n_internal).for_each(|(k, t)| load[(k, 0)] += t);
        load
    }

    /// All outputs of the scene on the basis of a reduction.
    pub(super) fn of_reduction(own: &Evidence<'p>) -> Self {
        let all: Vec<usize> = (0..own.partition.outputs.len()).collect();
        let n_columns = if all.is_empty() { 0 } else { own.basis.n_reduced() };
        Self::on(own.partition, &all, panel_of(own.basis, 0..n_columns).as_ref())
    }

    /// Some of them, by their numbers.
    pub(super) fn only(&self, numbers: &[usize]) -> Self {
        let rows = Mat::from_fn(numbers.len(), self.rows.ncols(), |i, j| self.rows[(numbers[i], j)]);
        Self { partition: self.partition, rows }
    }
}

/// The row T_o of an output, a rotation times the length.
fn entries(partition: &Partition, number: usize, length: f64) -> impl Iterator<Item = (usize, f64)> {
    let Output { row, dof } = partition.outputs[number];
    let unit = if dof.direction.is_rotation() { length } else { 1.0 };
    partition.transformation.rows[row].entries().map(move |(k, t)| (k as usize, unit * t))
}

/// A matrix of frequency responses: displacement of the row for a unit force on the interface dof of the column. Rows are the interface
/// dofs, behind them outputs.
#[derive(Clone, Debug)]
pub(super) struct Response {
    parts: [Mat<f64>; 2],
    /// 1 / (1 + iη).
    factor: c64,
    /// How far the interface dof that moves most does so, as a length, for every column; none without outputs.
    farthest: Vec<f64>,
}

impl Response {
    /// The response of a model, in scaled units.
    pub(super) fn of(model: &Observed<'_>, evidence: &Evidence<'_>, frequency_hz: f64, eta: f64) -> Self {
        let (z, n_b) =
            (complex_shift(evidence.partition.scaling.eigenvalue(frequency_hz), eta), evidence.partition.n_interface());
        let mut response = Self {
            parts: model.at_interface.block(z, n_b),
            factor: c64::new(1.0, 0.0) / c64::new(1.0, eta),
            farthest: Vec::new(),
        };
        if let Some(inside) = &model.inside {
            let seen = inside.spectral.seen(inside.shapes.as_ref(), z, n_b);
            for (part, seen) in response.parts.iter_mut().zip(seen) {
                *part = Mat::from_fn(
                    n_b + seen.nrows(),
                    n_b,
                    |i, j| if i < n_b { part[(i, j)] } else { seen[(i - n_b, j)] },
                );
            }
            response.farthest = response.farthest_by(&inside.lengths);
        }
        response
    }

    fn farthest_by(&self, lengths: &[f64]) -> Vec<f64> {
        let moved = |j: usize| lengths.iter().enumerate().map(move |(i, length)| length * self.get(i, j).norm());
        (0..self.n()).map(|j| moved(j).fold(0.0, f64::max)).collect()
    }

    /// Writes it into an entry of a cache.
    ///
    /// # Errors
    /// The file cannot be written.
    pub(super) fn write(&self, to: &mut Writer<'_>) -> std::io::Result<()> {
        let Self { parts: [re, im], factor, farthest } = self;
        to.columns(re.as_ref())?;
        to.columns(im.as_ref())?;
        to.array(&[factor.re, factor.im])?;
        to.array(farthest)
    }

    /// Reads it; none where the arrays are not those of a response.
    pub(super) fn read(from: &mut Reader<'_>) -> Option<Self> {
        let parts = [from.columns()?, from.columns()?];
        let [re, im] = from.array()?[..] else { return None };
        let farthest: Vec<f64> = from.array()?;
        let n_farthest = if parts[0].nrows() > parts[0].ncols() { parts[0].ncols() } else { 0 };
        (farthest.len() == n_farthest).then_some(Self { parts, factor: c64::new(re, im), farthest })
    }

    /// n_B.
    pub(super) fn n(&self) -> usize {
        self.parts[0].ncols()
    }

    /// n_B and the number of outputs.
    pub(super) fn n_rows(&self) -> usize {
        self.parts[0].nrows()
    }

    /// How far the interface dof that moves most does so under a unit force on one of them; nothing without outputs.
    pub(super) fn farthest(&self, column: usize) -> f64 {
        self.farthest.get(column).copied().unwrap_or(0.0)
    }

    /// Entry (i, j).
    pub(super) fn get(&self, i: usize, j: usize) -> c64 {
        c64::new(self.parts[0][(i, j)], self.parts[1][(i, j)]) * self.factor
    }
}
