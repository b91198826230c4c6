//! Expansion modes V of a file (22): the inertia forces that mode acceleration answers (23).
//!
//! ```text
//! V      n × k      the modes on all rows of the model, held ones among them
//! TᵀMV   n' × k     their inertia forces on the dofs that move
//! ```
//! Held dofs and rigid patches follow a mode as near as they can: the motion T v̂ that is nearest to v in the mass has
//! TᵀMT v̂ = TᵀM v, so that TᵀMV are the inertia forces of those motions, and v̂ need not be known. Each v is kept with its largest
//! entry in [1, 2): a mode may be of any size. An average loses nothing: its T is a change of variables. Where constraints tie dofs, all
//! rows follow together.

use std::collections::BTreeMap;

use faer::Mat;

use super::transformation::{DofOrigin, Transformation};
use super::transformation_row::TransformationRow;
use crate::dense;
use crate::error::{Error, Result};
use crate::input::ModeColumns;
use crate::model::Model;
use crate::sparse::{absolute_energy, diagonal, product};

/// Expansion modes on the dofs of a partition.
#[derive(Clone, Debug)]
pub struct Expansion {
    /// What is known of each mode.
    pub facts: Vec<ExpansionFacts>,
    /// TᵀMV, n' × k, each column in the unit of its mode.
    pub inertia: Mat<f64>,
}

/// What is remembered of an expansion mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpansionFacts {
    /// The displacement of the file that an entry of one stands for, a power of two.
    pub unit: f64,
    /// |v|ᵀ|M||v|, in this unit: what rounding of the inertia forces is relative to.
    pub terms: f64,
    /// The share of v that held dofs and rigid patches cannot follow: the root of what is left of Σ M_ii v_i².
    pub not_followed: f64,
}

/// Expansion modes on all rows of a model.
#[derive(Clone, Debug)]
pub struct RowModes {
    values: Mat<f64>,
    inertia: Mat<f64>,
    units: Vec<f64>,
    terms: Vec<f64>,
    /// The diagonal of M.
    weights: Vec<f64>,
    /// Whether constraints tie dofs to each other, so that no few rows follow a mode by themselves.
    are_constrained: bool,
}

/// The modes of a file on the rows of a model; those of rows that were dropped, which have no mass, are left out.
///
/// # Errors
/// [`Error::ModesNothing`] where a mode is zero or moves no mass.
pub fn expansion_modes(model: &Model, modes: &ModeColumns) -> Result<RowModes> {
    let (n, k) = (model.n_dofs(), modes.columns.len());
    let (mut values, mut units) = (Mat::zeros(n, k), Vec::with_capacity(k));
    for (at, column) in modes.columns.iter().enumerate() {
        let value = |row: usize| column[model.rows.of(row)];
        let largest = (0..n).fold(0.0f64, |max, row| max.max(value(row).abs()));
        if largest == 0.0 {
            return Err(Error::ModesNothing { mode: at + 1, found: "zero everywhere" });
        }
        let unit = largest.log2().floor().clamp(-1022.0, 1023.0).exp2();
        dense::column_mut(values.as_mut(), at).iter_mut().enumerate().for_each(|(row, to)| *to = value(row) / unit);
        units.push(unit);
    }
    let inertia = product(&model.mass, values.as_ref());
    let terms = absolute_energy(&model.mass, values.as_ref());
    if let Some(at) = terms.iter().position(|terms| *terms == 0.0) {
        return Err(Error::ModesNothing { mode: at + 1, found: "no dof with mass that it moves" });
    }
    let (weights, are_constrained) = (diagonal(&model.mass), model.constraints.is_some());
    Ok(RowModes { values, inertia, units, terms, weights, are_constrained })
}

impl RowModes {
    /// √M_ii of a row.
    fn root_of_weight(&self, row: usize) -> f64 {
        self.weights[row].max(0.0).sqrt()
    }

    /// √M_ii v_i.
    fn weighted(&self, row: usize, at: usize) -> f64 {
        self.root_of_weight(row) * self.values[(row, at)]
    }
}

impl Expansion {
    /// None.
    pub fn none(n_dofs: usize) -> Self {
        Self { facts: Vec::new(), inertia: Mat::zeros(n_dofs, 0) }
    }

    /// k.
    pub fn count(&self) -> usize {
        self.facts.len()
    }

    /// TᵀMV.
    ///
    /// # Errors
    /// [`Error::ModesNothing`] where held dofs take all of a mode.
    pub fn carried(modes: &RowModes, transformation: &Transformation) -> Result<Self> {
        let k = modes.units.len();
        let mut inertia = Mat::zeros(transformation.dofs.len(), k);
        for at in 0..k {
            let column = dense::column_mut(inertia.as_mut(), at);
            let of_rows = dense::column(modes.inertia.as_ref(), at);
            for (row, value) in transformation.rows.iter().zip(of_rows) {
                row.entries().for_each(|(dof, factor)| column[dof as usize] += factor * value);
            }
            if column.iter().all(|value| *value == 0.0) {
                return Err(Error::ModesNothing { mode: at + 1, found: "all of its inertia on held dofs" });
            }
        }
        let not_followed = not_followed(modes, transformation);
        let facts = |at: usize| ExpansionFacts {
            unit: modes.units[at],
            terms: modes.terms[at],
            not_followed: not_followed[at],
        };
        Ok(Self { facts: (0..k).map(facts).collect(), inertia })
    }
}

/// The root of min_q Σ M_ii (v − Tq)_i² over Σ M_ii v_i² of each mode. A row of its own dof follows; a held one does not; the rows of a
/// rigid patch follow its node by least squares.
fn not_followed(modes: &RowModes, transformation: &Transformation) -> Vec<f64> {
    let k = modes.units.len();
    let square = |row: usize, at: usize| modes.weighted(row, at).powi(2);
    let whole = |at: usize| (0..modes.values.nrows()).map(|row| square(row, at)).sum::<f64>();
    let share = |(at, lost): (usize, f64)| if lost > 0.0 { (lost / whole(at)).sqrt().min(1.0) } else { 0.0 };
    if modes.are_constrained {
        let left = NotFollowed { modes, transformation, diagonal: diagonal_of(modes, transformation) };
        return (0..k).map(|at| share((at, left.least(at, whole(at))))).collect();
    }
    let mut lost = vec![0.0; k];
    let mut patches: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (row, of_row) in transformation.rows.iter().enumerate() {
        match of_row {
            TransformationRow::Dof(_) => {}
            TransformationRow::Held => (0..k).for_each(|at| lost[at] += square(row, at)),
            TransformationRow::Tied(entries) => {
                let node = entries.iter().find_map(|(dof, _)| match transformation.dofs[*dof as usize].origin {
                    DofOrigin::PatchNode(node, _) | DofOrigin::Distortion(node, _) => Some(node),
                    DofOrigin::Row(_) => None,
                });
                match node {
                    Some(node) => patches.entry(node).or_default().push(row),
                    None => (0..k).for_each(|at| lost[at] += square(row, at)),
                }
            }
        }
    }
    // A patch with dofs for what deviates from its mean motion loses no motion.
    for dof in &transformation.dofs {
        if let DofOrigin::Distortion(node, _) = dof.origin {
            patches.remove(&node);
        }
    }
    for rows in patches.values() {
        lost.iter_mut().zip(lost_by_patch(modes, transformation, rows)).for_each(|(lost, of_patch)| *lost += of_patch);
    }
    lost.into_iter().enumerate().map(share).collect()
}

/// min_q Σ M_ii (v − Tq)_i² of each mode on the rows of a rigid patch.
fn lost_by_patch(modes: &RowModes, transformation: &Transformation, rows: &[usize]) -> Vec<f64> {
    let k = modes.units.len();
    let mut dofs: Vec<u32> =
        rows.iter().flat_map(|row| transformation.rows[*row].entries().map(|(dof, _)| dof)).collect();
    dofs.sort_unstable();
    dofs.dedup();
    // As many rows as columns at least, and more of nothing change no least squares.
    let n = rows.len().max(dofs.len());
    let mut motions = Mat::zeros(n, dofs.len());
    for (i, row) in rows.iter().enumerate() {
        for (dof, factor) in transformation.rows[*row].entries() {
            let j = dofs.binary_search(&dof).unwrap_or_default();
            motions[(i, j)] = modes.root_of_weight(*row) * factor;
        }
    }
    let mut left = Mat::from_fn(n, k, |i, at| rows.get(i).map_or(0.0, |row| modes.weighted(*row, at)));
    let followed = dense::least_squares(motions.as_ref(), left.as_ref());
    dense::add_product(left.as_mut(), -1.0, motions.as_ref(), followed.as_ref());
    (0..k).map(|at| dense::norm(dense::column(left.as_ref(), at)).powi(2)).collect()
}

/// Steps of conjugate gradients: T is the identity but for rows of few entries, so that tens are enough; stopped early, the share is a
/// bound from above.
const STEPS: usize = 200;
/// Share of what is left, squared, by which a further step could make it smaller, below which none is taken.
const SETTLED: f64 = 1e-12;
/// Share of a mode, squared, that is rounding.
const ROUNDING: f64 = 1e-24;

/// The diagonal of TᵀWT with W the diagonal of M.
fn diagonal_of(modes: &RowModes, transformation: &Transformation) -> Vec<f64> {
    let mut diagonal = vec![0.0; transformation.dofs.len()];
    for (row, of_row) in transformation.rows.iter().enumerate() {
        let weight = modes.weights[row].max(0.0);
        of_row.entries().for_each(|(dof, factor)| diagonal[dof as usize] += weight * factor * factor);
    }
    diagonal
}

/// What a motion of the dofs leaves of a mode where constraints tie dofs to each other.
struct NotFollowed<'a> {
    modes: &'a RowModes,
    transformation: &'a Transformation,
    diagonal: Vec<f64>,
}

impl NotFollowed<'_> {
    /// min_q Σ M_ii (v − Tq)_i² by conjugate gradients on TᵀWT q = TᵀWv, from the motion that has the values of v.
    fn least(&self, at: usize, whole: f64) -> f64 {
        let mut left = self.after_own_values(at);
        let mut size = self.size(&left);
        let (mut direction, mut slope) = (Vec::new(), 0.0);
        for _ in 0..STEPS {
            let force = self.pulled_back(&left);
            let step: Vec<f64> =
                force.iter().zip(&self.diagonal).map(|(f, d)| if *d > 0.0 { f / d } else { 0.0 }).collect();
            let next = dense::dot(&force, &step);
            if next <= SETTLED * size || size <= ROUNDING * whole {
                break;
            }
            direction = match slope > 0.0 {
                true => step
                    .iter()
                    .zip(&direction)
                    .map(|(step, before): (&f64, &f64)| step + next / slope * before)
                    .collect(),
                false => step,
            };
            slope = next;
            let moved: Vec<f64> = self.moved(&direction);
            let length = slope / self.size(&moved);
            left.iter_mut().zip(&moved).for_each(|(left, moved)| *left -= length * moved);
            size = self.size(&left);
        }
        size
    }

    /// v − Tq with the values of v for those dofs that are rows of the model.
    fn after_own_values(&self, at: usize) -> Vec<f64> {
        let own = |origin: DofOrigin| match origin {
            DofOrigin::Row(row) => self.modes.values[(row, at)],
            DofOrigin::PatchNode(..) | DofOrigin::Distortion(..) => 0.0,
        };
        let q: Vec<f64> = self.transformation.dofs.iter().map(|dof| own(dof.origin)).collect();
        let values = dense::column(self.modes.values.as_ref(), at);
        values.iter().zip(self.moved(&q)).map(|(value, moved)| value - moved).collect()
    }

    /// T q.
    fn moved(&self, q: &[f64]) -> Vec<f64> {
        let of_row = |row: &TransformationRow| row.entries().map(|(dof, factor)| factor * q[dof as usize]).sum();
        self.transformation.rows.iter().map(of_row).collect()
    }

    /// TᵀW x.
    fn pulled_back(&self, x: &[f64]) -> Vec<f64> {
        let mut force = vec![0.0; self.transformation.dofs.len()];
        for (row, of_row) in self.transformation.rows.iter().enumerate() {
            let weighted = self.modes.weights[row].max(0.0) * x[row];
            of_row.entries().for_each(|(dof, factor)| force[dof as usize] += factor * weighted);
        }
        force
    }

    /// xᵀWx.
    fn size(&self, x: &[f64]) -> f64 {
        x.iter().zip(&self.modes.weights).map(|(x, weight)| weight.max(0.0) * x * x).sum()
    }
}
