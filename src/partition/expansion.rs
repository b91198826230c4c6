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

use faer::{Mat, MatRef};

use super::transformation::Transformation;
use super::transformation_row::TransformationRow;
use crate::dense::{self, NOISE_FACTOR};
use crate::error::{Error, Result};
use crate::input::ModeColumns;
use crate::model::Model;
use crate::sparse::{SparseMatrix, absolute_energy, diagonal, product};

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
    /// The share of v that held dofs and rigid patches cannot follow: the root of what is left of vᵀMv, or zero below a millionth.
    pub not_followed: f64,
}

/// Expansion modes on all rows of a model.
#[derive(Clone, Debug)]
pub struct RowModes {
    inertia: Mat<f64>,
    units: Vec<f64>,
    terms: Vec<f64>,
    /// vᵀMv of each.
    squares: Vec<f64>,
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
    let squares = dense::dots(values.as_ref(), inertia.as_ref());
    Ok(RowModes { inertia, units, terms, squares })
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

    /// TᵀMV, with what follows of each mode by TᵀMT.
    ///
    /// # Errors
    /// [`Error::ModesNothing`] where held dofs take all of a mode.
    pub fn carried(modes: &RowModes, (transformation, mass): (&Transformation, &SparseMatrix)) -> Result<Self> {
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
        let not_followed = not_followed(modes, (transformation, mass), inertia.as_ref());
        let facts = |at: usize| ExpansionFacts {
            unit: modes.units[at],
            terms: modes.terms[at],
            not_followed: not_followed[at],
        };
        Ok(Self { facts: (0..k).map(facts).collect(), inertia })
    }
}

/// Steps of conjugate gradients: the mass of meshes is near its diagonal, so that tens are enough; stopped early, the share is a bound from
/// above.
const STEPS: usize = 200;
/// Share of vᵀMv, in the norm of the diagonal, of a residual that further steps would follow.
const SETTLED: f64 = 1e-15;
/// Share of vᵀMv that is not told from nothing.
const NOTHING: f64 = 1e-12;

/// The root of min_q (v − Tq)ᵀM(v − Tq) over vᵀMv of each mode.
fn not_followed(
    modes: &RowModes,
    (transformation, mass): (&Transformation, &SparseMatrix),
    inertia: MatRef<'_, f64>,
) -> Vec<f64> {
    let k = modes.units.len();
    if transformation.rows.iter().all(|row| matches!(row, TransformationRow::Dof(_))) {
        return vec![0.0; k];
    }
    let diagonal = diagonal(mass);
    let share = |at: usize| {
        let whole = modes.squares[at];
        let left = whole - followed((mass, &diagonal), dense::column(inertia, at), whole);
        let rounding = (NOTHING * whole).max(NOISE_FACTOR * f64::EPSILON * modes.terms[at]);
        if left > rounding { (left / whole).sqrt() } else { 0.0 }
    };
    (0..k).map(share).collect()
}

/// max_q 2qᵀf − qᵀMq by conjugate gradients, each step of which adds to it: of a mode with vᵀMv what the dofs follow that it loads with
/// f = TᵀMv, M theirs.
fn followed((mass, diagonal): (&SparseMatrix, &[f64]), inertia: &[f64], whole: f64) -> f64 {
    let n = inertia.len();
    let mut left = inertia.to_vec();
    let (mut direction, mut slope, mut followed) = (Mat::zeros(n, 1), 0.0, 0.0);
    for _ in 0..STEPS {
        let step: Vec<f64> = left.iter().zip(diagonal).map(|(f, d)| if *d > 0.0 { f / d } else { 0.0 }).collect();
        let next = dense::dot(&left, &step);
        if next <= SETTLED * whole {
            break;
        }
        let turn = if slope > 0.0 { next / slope } else { 0.0 };
        let along = dense::column_mut(direction.as_mut(), 0);
        along.iter_mut().zip(&step).for_each(|(along, step)| *along = step + turn * *along);
        slope = next;
        let image = product(mass, direction.as_ref());
        let size = dense::dot(dense::column(direction.as_ref(), 0), dense::column(image.as_ref(), 0));
        // A mass that is not definite has no nearest motion.
        if size <= 0.0 {
            break;
        }
        let length = slope / size;
        dense::add_scaled(&mut left, -length, dense::column(image.as_ref(), 0));
        followed += length * slope;
    }
    followed
}
