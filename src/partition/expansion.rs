//! Expansion modes V of a file (22): the inertia forces that mode acceleration answers (23).
//!
//! ```text
//! V      n × k      the modes on all rows of the model, held ones among them
//! TᵀMV   n' × k     their inertia forces on the dofs that move
//! ```
//! Held dofs and rigid patches follow a mode as near as they can: the motion T v̂ that is nearest to v in the mass has
//! TᵀMT v̂ = TᵀM v, so that TᵀMV are the inertia forces of those motions, and v̂ need not be known. Each v is kept with its largest
//! entry in [1, 2): a mode may be of any size. An average loses nothing: its T is a change of variables.

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
    Ok(RowModes { values, inertia, units, terms, weights: diagonal(&model.mass) })
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
    let whole = |at: usize| (0..modes.values.nrows()).map(|row| square(row, at)).sum::<f64>();
    let share = |(at, lost): (usize, f64)| if lost > 0.0 { (lost / whole(at)).sqrt().min(1.0) } else { 0.0 };
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
