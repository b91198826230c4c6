//! Which shapes of a result are eigenvectors, each of its own.
//!
//! ```text
//! G    XᵀMX of the shapes without their rigid-body motion
//! L    G of those that are kept = L Lᵀ, row by row: what is left of a shape beside those before it is its last entry
//! ```

use faer::{Mat, MatRef};

use super::claims::Claims;
use super::measured::{Measured, lacking};
use super::turned;
use crate::dense;
use crate::eigen::{ModalProblem, Modes, ShiftInvert, rayleigh_quotients};
use crate::error::Result;
use crate::sparse::product;

/// δ up to which a shape is taken for an eigenvector: its frequency is then known to a hundredth by the bound that holds for any vector,
/// and to the square of that where the next mode is far.
pub(super) const RECOGNISED: f64 = 2e-2;
/// Share of the modal mass from which on a shape is rigid-body motion.
pub(super) const RIGID: f64 = 0.5;
/// What a shape has besides rigid-body motion, from which on it is no combination of such motions: a hundredth of its modal mass.
const MOSTLY_ELASTIC: f64 = 0.1;
/// What is left of a shape that is a mode of its own, whatever its neighbours: half of its modal mass.
const OF_ITS_OWN: f64 = 0.7;
/// What is left of a shape of which nothing is left: G squares it, so that it is rounding.
const NOTHING: f64 = 1e-7;

/// What each shape is by itself and among the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Standing {
    /// An eigenvector of its own.
    Kept,
    /// Rigid-body motion, independent of the shapes before it.
    Rigid,
    /// A combination of others, mostly of this one.
    DependsOn(usize),
    /// No eigenvector.
    None,
}

/// The standing of every shape, and the modes that the kept ones are.
pub(super) struct Independent {
    pub(super) standing: Vec<Standing>,
    /// M-orthonormal, ascending, with what is known of their errors.
    pub(super) modes: Modes,
}

/// Tells eigenvectors from what is none, and independent ones from repetitions.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub(super) fn independent(
    problem: ModalProblem<'_>,
    operator: &dyn ShiftInvert,
    (claims, measured): (&Claims, &Measured),
) -> Result<Independent> {
    let k = claims.count();
    let mut standing = vec![Standing::None; k];
    let is_rigid = |j: usize| measured.rigid_share(j) > RIGID;
    let rigid: Vec<usize> = (0..k).filter(|j| claims.has_mass[*j] && is_rigid(*j)).collect();
    stand_among(&mut standing, &rigid, measured.along_rigid.as_ref());
    let elastic = without_rigid_motion(problem, claims, measured);
    let momenta = product(problem.mass, elastic.as_ref());
    let gram = dense::gram(elastic.as_ref(), momenta.as_ref());
    // Good shapes first: the others are cleaned of what belongs to them.
    let mut order: Vec<usize> =
        (0..k).filter(|j| claims.has_mass[*j] && !is_rigid(*j) && measured.lacking[*j] <= RECOGNISED).collect();
    let decade = |j: usize| measured.lacking[j].max(1e-10).log10().floor() as i32;
    order.sort_by_key(|j| (decade(*j), *j));
    let mut factor = Factor::default();
    for j in order {
        let (row, left) = factor.row_of(&gram, j);
        let length = gram[(j, j)].sqrt();
        let is_own = left > OF_ITS_OWN * length || {
            let rest = || factor.rest(elastic.as_ref(), j, &row);
            left > NOTHING * length && is_eigenvector(problem, operator, rest())
        };
        if is_own {
            standing[j] = Standing::Kept;
            factor.push(j, row, left);
        } else {
            standing[j] = factor.nearest(&gram, j).map_or(Standing::None, Standing::DependsOn);
        }
    }
    in_order_of_the_file(&mut standing);
    let modes = turned::modes_of(problem, operator, factor.orthonormal(elastic.as_ref()), [None, None])?;
    Ok(Independent { standing, modes })
}

/// Of two shapes that are the same the later one is the repetition, whichever was the better one.
fn in_order_of_the_file(standing: &mut [Standing]) {
    for j in 0..standing.len() {
        if let Standing::DependsOn(other) = standing[j]
            && other > j
            && standing[other] == Standing::Kept
        {
            (standing[j], standing[other]) = (Standing::Kept, Standing::DependsOn(j));
        }
    }
}

/// The standing of shapes that are rigid-body motion, by their coordinates in it.
fn stand_among(standing: &mut [Standing], rigid: &[usize], along: MatRef<'_, f64>) {
    let gram = dense::gram(along, along);
    let mut factor = Factor::default();
    for j in rigid {
        let (row, left) = factor.row_of(&gram, *j);
        // What a shape has besides rigid-body motion says nothing of it.
        let elastic = (1.0 - gram[(*j, *j)]).max(0.0).sqrt();
        if left > NOTHING.max(10.0 * elastic.min(0.1)) * gram[(*j, *j)].sqrt() {
            standing[*j] = Standing::Rigid;
            factor.push(*j, row, left);
        } else if elastic <= MOSTLY_ELASTIC {
            standing[*j] = factor.nearest(&gram, *j).map_or(Standing::None, Standing::DependsOn);
        }
    }
}

/// X − Q QᵀMX.
fn without_rigid_motion(problem: ModalProblem<'_>, claims: &Claims, measured: &Measured) -> Mat<f64> {
    let mut elastic = claims.shapes.clone();
    dense::add_product(elastic.as_mut(), -1.0, problem.deflated[0], measured.along_rigid.as_ref());
    elastic
}

fn is_eigenvector(problem: ModalProblem<'_>, operator: &dyn ShiftInvert, shape: Mat<f64>) -> bool {
    let (lambda, _, residual) = rayleigh_quotients(problem, shape.as_ref());
    let momentum = product(problem.mass, shape.as_ref());
    let mass = dense::dots(shape.as_ref(), momentum.as_ref())[0];
    lacking(operator, &lambda, residual.as_ref())[0] <= RECOGNISED * mass.sqrt()
}

/// L of the shapes that were kept.
#[derive(Default)]
struct Factor {
    kept: Vec<usize>,
    /// The rows of L, each without its last entry.
    rows: Vec<Vec<f64>>,
    last: Vec<f64>,
}

impl Factor {
    /// The row of a further shape, and what is left of it.
    fn row_of(&self, gram: &Mat<f64>, j: usize) -> (Vec<f64>, f64) {
        let mut row: Vec<f64> = Vec::with_capacity(self.kept.len());
        for (i, other) in self.kept.iter().enumerate() {
            let known: f64 = self.rows[i].iter().zip(&row).map(|(a, b)| a * b).sum();
            row.push((gram[(*other, j)] - known) / self.last[i]);
        }
        let left = gram[(j, j)] - row.iter().map(|value| value * value).sum::<f64>();
        (row, left.max(0.0).sqrt())
    }

    fn push(&mut self, j: usize, row: Vec<f64>, left: f64) {
        self.kept.push(j);
        self.rows.push(row);
        self.last.push(left);
    }

    /// The kept shape that a shape has most in common with.
    fn nearest(&self, gram: &Mat<f64>, j: usize) -> Option<usize> {
        let share = |other: usize| (gram[(other, j)].powi(2) / gram[(other, other)]).abs();
        self.kept.iter().copied().max_by(|a, b| share(*a).total_cmp(&share(*b)))
    }

    fn lower(&self) -> Mat<f64> {
        let n = self.kept.len();
        Mat::from_fn(n, n, |i, j| match i.cmp(&j) {
            std::cmp::Ordering::Less => 0.0,
            std::cmp::Ordering::Equal => self.last[i],
            std::cmp::Ordering::Greater => self.rows[i][j],
        })
    }

    /// What is left of a shape with this row, n' × 1.
    fn rest(&self, shapes: MatRef<'_, f64>, j: usize, row: &[f64]) -> Mat<f64> {
        // a with Lᵀ a = c, from the last one back.
        let mut coefficients = row.to_vec();
        for i in (0..row.len()).rev() {
            let known: f64 = (i + 1..row.len()).map(|m| self.rows[m][i] * coefficients[m]).sum();
            coefficients[i] = (row[i] - known) / self.last[i];
        }
        let mut rest = shapes.subcols(j, 1).to_owned();
        for (other, coefficient) in self.kept.iter().zip(coefficients) {
            let column = dense::column_mut(rest.as_mut(), 0);
            dense::add_scaled(column, -coefficient, dense::column(shapes, *other));
        }
        rest
    }

    /// The kept shapes, M-orthonormal: X L⁻ᵀ.
    fn orthonormal(&self, shapes: MatRef<'_, f64>) -> Mat<f64> {
        let mut vectors = dense::columns(shapes, &self.kept);
        if !self.kept.is_empty() {
            dense::divide(vectors.as_mut(), self.lower().as_ref());
        }
        vectors
    }
}
