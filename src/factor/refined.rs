//! Solves as accurate as those of a factor in double precision, by a factor that is kept in single.
//!
//! ```text
//! A = K − σM     n × n, with its border           X, B   n × k
//! D A D ≈ L̃ L̃ᵀ   L̃ rounded to single precision    D      powers of two
//! ```
//! L is computed in double precision and each entry is rounded. L̃ L̃ᵀ is then definite whatever it is rounded to, and far nearer
//! to A than a matrix whose elimination was rounded: L⁻¹L̃ − I is of the size u κ(L) = u √κ(A), not u κ(A), with u = 6·10⁻⁸.
//! Conjugate gradients (Hestenes, Stiefel 1952) go on where √κ nears 10⁷ too, with a step or two for each eigenvalue that is
//! out of line: three steps on solids (κ = 10⁷ to 10⁹), six on a plate (10¹²), seven on a bar (7·10¹³). Every right-hand side has
//! scalars of its own, so that its solution never depends on the other columns of its block.

use std::sync::{Mutex, OnceLock};

use faer::{Mat, MatMut, MatRef};

use super::Analysis;
use super::exact_residual::exact_residual;
use super::multifrontal::{Numbers, lock};
use super::substitution::Factor;
use crate::dense;
use crate::error::{Error, Result};
use crate::sparse::Pencil;
use crate::sparse::{absolute_product, product};

/// Right-hand sides that are solved for at once, with nine more blocks of so many columns.
const TILE: usize = 8;
/// |B − AX| relative to |A||X| + |B| that is aimed at in every row: what a factor in double precision leaves is 2e-15 to 1e-14.
const AIM: f64 = 16.0 * f64::EPSILON;
/// |B − AX| relative to |A||X| + |B| up to which a solution that gets no better is accepted: rounding of a residual of a hundred
/// terms may add up to γ_100.
const MAX_STALLED_RESIDUAL: f64 = 100.0 * f64::EPSILON;
/// Rows whose terms are below this share of the typical row are at rest, and measured against that: their terms are rounding
/// of solutions elsewhere (Arioli, Demmel, Duff 1989).
const AT_REST: f64 = 1e-6;
/// Steps up to which a solve is worth waiting for. Each costs a solve and a product.
const MAX_STEPS: usize = 200;

/// A factor in single precision with the matrix it is of.
#[derive(Debug)]
pub(super) struct Refined<'a> {
    analysis: &'a Analysis,
    pencil: Pencil<'a>,
    sigma: f64,
    /// D, for the border too.
    scale: Vec<f64>,
    numbers: Numbers<f32>,
    work: Mutex<Refinement>,
    shortfall: OnceLock<Shortfall>,
}

/// What it took to make solves as accurate as in double precision.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Refinement {
    /// Right-hand sides.
    pub n_solves: u64,
    /// Steps of conjugate gradients of all of them together.
    pub n_steps: u64,
    /// Steps of the one that took most.
    pub most_steps: usize,
}

/// A solve that was given up.
#[derive(Clone, Copy, Debug)]
struct Shortfall {
    column: usize,
    residual: f64,
    steps: usize,
}

/// Right-hand sides of one tile on their way; the rows of the border are zero in all of them but the products.
struct Tile {
    /// B, n + n_B rows.
    load: Mat<f64>,
    /// X.
    x: Mat<f64>,
    /// B − AX.
    residual: Mat<f64>,
    /// |A||X| + |B|, and no less than rows at rest are measured against; n rows.
    terms: Mat<f64>,
    /// Steps of each.
    steps: Vec<usize>,
}

/// The scalars of one right-hand side.
#[derive(Clone, Copy, Debug)]
struct Scalars {
    column: usize,
    /// rᵀ M⁻¹ r of the step before.
    rho: f64,
}

impl<'a> Refined<'a> {
    pub(super) fn new(
        analysis: &'a Analysis,
        (pencil, sigma): (Pencil<'a>, f64),
        scale: Vec<f64>,
        numbers: Numbers<f32>,
    ) -> Self {
        Self { analysis, pencil, sigma, scale, numbers, work: Mutex::default(), shortfall: OnceLock::new() }
    }

    /// L̃.
    pub(super) fn numbers(&self) -> &Numbers<f32> {
        &self.numbers
    }

    /// X ← A⁻¹ X, n rows: the border is held.
    pub(super) fn solve_in_place(&self, mut block: MatMut<'_, f64>) {
        for start in (0..block.ncols()).step_by(TILE) {
            let width = TILE.min(block.ncols() - start);
            self.count(self.solve_tile(block.as_mut().subcols_mut(start, width), start));
        }
    }

    /// −A_II⁻¹ A_IB X_B for motions of the border, n_B rows.
    pub(super) fn follow_border(&self, border: MatRef<'_, f64>) -> Mat<f64> {
        let (n, n_border) = (self.analysis.n(), self.analysis.n_border());
        let mut x = Mat::zeros(n, border.ncols());
        for start in (0..border.ncols()).step_by(TILE) {
            let width = TILE.min(border.ncols() - start);
            let mut motion = Mat::zeros(n + n_border, width);
            motion.as_mut().subrows_mut(n, n_border).copy_from(border.subcols(start, width));
            let forces = self.product(motion.as_ref());
            motion.as_mut().subrows_mut(0, n).copy_from(-forces.as_ref().subrows(0, n));
            self.solve_exactly(motion.as_mut(), Mat::zeros(n, width).as_ref(), start);
            x.as_mut().subcols_mut(start, width).copy_from(motion.as_ref().subrows(0, n));
        }
        x
    }

    /// −A_BI A_II⁻¹ F of loads, n rows.
    pub(super) fn load_border(&self, loads: MatRef<'_, f64>) -> Mat<f64> {
        let (n, n_border) = (self.analysis.n(), self.analysis.n_border());
        let mut taken = Mat::zeros(n_border, loads.ncols());
        for start in (0..loads.ncols()).step_by(TILE) {
            let load = loads.subcols(start, TILE.min(loads.ncols() - start));
            let mut motion = Mat::zeros(n + n_border, load.ncols());
            motion.as_mut().subrows_mut(0, n).copy_from(load);
            self.solve_exactly(motion.as_mut(), load, start);
            let forces = self.product(motion.as_ref());
            taken.as_mut().subcols_mut(start, load.ncols()).copy_from(-forces.as_ref().subrows(n, n_border));
        }
        taken
    }

    /// What elimination has left of the border.
    pub(super) fn condensed(&self) -> Mat<f64> {
        let border = &self.scale[self.analysis.n()..];
        let schur = &self.numbers.schur;
        Mat::from_fn(schur.nrows(), schur.ncols(), |i, j| schur[(i, j)] / (border[i] * border[j]))
    }

    /// What the solves so far have taken.
    ///
    /// # Errors
    /// [`Error::NotRefined`] where one was given up.
    pub(super) fn work(&self) -> Result<Refinement> {
        match self.shortfall.get() {
            None => Ok(*lock(&self.work)),
            Some(Shortfall { column, residual, steps }) => {
                Err(Error::NotRefined { column: *column, residual: *residual, aim: AIM, steps: *steps })
            }
        }
    }

    /// X_I of A_II X_I + A_IB X_B = F to rounding of X_I itself, at most [`TILE`] columns; X has the whole right-hand side in place of X_I.
    ///
    /// What the border does is used as a matrix of which columns and products are made by different solves. By a factor in double
    /// precision these are off by κ ε, too, but all alike, and what one lacks the others lack with it. Here each is off in its own way: the
    /// solve of what is left of the equations in twice the precision takes κ ε of that error.
    fn solve_exactly(&self, mut x: MatMut<'_, f64>, load: MatRef<'_, f64>, first: usize) {
        let n = self.analysis.n();
        let steps = self.solve_tile(x.as_mut().subrows_mut(0, n), first);
        let mut correction = exact_residual((self.pencil, self.sigma), x.as_ref(), load);
        let more = self.solve_tile(correction.as_mut(), first);
        let mut interior = x.subrows_mut(0, n);
        interior += correction;
        self.count(steps.into_iter().zip(more).map(|(steps, more)| steps + more));
    }

    /// Counts solves by the steps of each.
    fn count(&self, solves: impl IntoIterator<Item = usize>) {
        let mut work = lock(&self.work);
        for steps in solves {
            work.n_solves += 1;
            work.n_steps += steps as u64;
            work.most_steps = work.most_steps.max(steps);
        }
    }

    /// Solves for at most [`TILE`] right-hand sides, of which the first is number `first` of its block. The steps of each.
    fn solve_tile(&self, mut block: MatMut<'_, f64>, first: usize) -> Vec<usize> {
        let (n, k) = block.shape();
        let mut load = Mat::zeros(n + self.analysis.n_border(), k);
        load.as_mut().subrows_mut(0, n).copy_from(block.as_ref());
        let (x, residual, terms) = (Mat::zeros(load.nrows(), k), load.clone(), Mat::zeros(n, k));
        let mut tile = Tile { load, x, residual, terms, steps: vec![0; k] };
        let mut open: Vec<usize> =
            (0..k).filter(|j| dense::column(block.as_ref(), *j).iter().any(|value| *value != 0.0)).collect();
        let mut before = vec![f64::INFINITY; k];
        while !open.is_empty() {
            self.descend(&mut tile, &open);
            let left = self.true_residuals(&mut tile, &open);
            let mut left = open.iter().copied().zip(left).collect::<Vec<_>>();
            left.retain(|(j, left)| {
                // The residual of recurrences drifts from the true one: start again from that, until it gets no better.
                let is_stuck = left.is_nan() || *left > 0.5 * before[*j] || tile.steps[*j] >= MAX_STEPS;
                let is_done = *left <= if is_stuck { MAX_STALLED_RESIDUAL } else { AIM };
                if is_stuck && !is_done {
                    let shortfall = Shortfall { column: first + j, residual: *left, steps: tile.steps[*j] };
                    self.shortfall.get_or_init(|| shortfall);
                }
                before[*j] = *left;
                !is_stuck && !is_done
            });
            open = left.into_iter().map(|(j, _)| j).collect();
        }
        block.copy_from(tile.x.as_ref().subrows(0, n));
        tile.steps
    }

    /// Conjugate gradients from the solutions and residuals as they are, until each residual is as small as is aimed at.
    fn descend(&self, tile: &mut Tile, open: &[usize]) {
        let n = self.analysis.n();
        let mut running: Vec<Scalars> = open.iter().map(|column| Scalars { column: *column, rho: 0.0 }).collect();
        let mut p = Mat::zeros(tile.x.nrows(), tile.x.ncols());
        let mut is_first = true;
        while !running.is_empty() {
            let z = self.preconditioned(tile.residual.as_ref(), &running);
            for (at, scalars) in running.iter_mut().enumerate() {
                let (z, r) = (dense::column(z.as_ref(), at), dense::column(tile.residual.as_ref(), scalars.column));
                let rho = dense::dot(&r[..n], z);
                let beta = if is_first { 0.0 } else { rho / scalars.rho };
                scalars.rho = rho;
                let p = &mut dense::column_mut(p.as_mut(), scalars.column)[..n];
                p.iter_mut().zip(z).for_each(|(p, z)| *p = z + beta * *p);
            }
            let q = self.product(gathered(p.as_ref(), &running).as_ref());
            let mut broken = vec![false; running.len()];
            for (at, Scalars { column, rho, .. }) in running.iter().copied().enumerate() {
                let (p, q) = (&dense::column(p.as_ref(), column)[..n], &dense::column(q.as_ref(), at)[..n]);
                let energy = dense::dot(p, q);
                // Of a residual that is rounding, so is the direction.
                broken[at] = !(energy > 0.0 && rho > 0.0 && energy.is_finite() && rho.is_finite());
                if !broken[at] {
                    let alpha = rho / energy;
                    dense::add_scaled(&mut dense::column_mut(tile.x.as_mut(), column)[..n], alpha, p);
                    dense::add_scaled(&mut dense::column_mut(tile.residual.as_mut(), column)[..n], -alpha, q);
                }
                tile.steps[column] += 1;
            }
            if is_first {
                self.take_terms(tile, &running);
                is_first = false;
            }
            let mut broken = broken.into_iter();
            running.retain(|Scalars { column, .. }| {
                broken.next() == Some(false) && tile.left(*column) > AIM && tile.steps[*column] < MAX_STEPS
            });
        }
    }

    /// Residuals as they are, and what is left of them.
    fn true_residuals(&self, tile: &mut Tile, open: &[usize]) -> Vec<f64> {
        let n = self.analysis.n();
        let columns: Vec<Scalars> = open.iter().map(|column| Scalars { column: *column, rho: 0.0 }).collect();
        let forces = self.product(gathered(tile.x.as_ref(), &columns).as_ref());
        self.take_terms(tile, &columns);
        for (at, column) in open.iter().enumerate() {
            let load = &dense::column(tile.load.as_ref(), *column)[..n];
            let residual = &mut dense::column_mut(tile.residual.as_mut(), *column)[..n];
            for ((residual, load), force) in residual.iter_mut().zip(load).zip(dense::column(forces.as_ref(), at)) {
                *residual = load - force;
            }
        }
        open.iter().map(|column| tile.left(*column)).collect()
    }

    /// Terms of some columns as their solutions are now.
    fn take_terms(&self, tile: &mut Tile, columns: &[Scalars]) {
        let n = self.analysis.n();
        let x = gathered(tile.x.as_ref(), columns);
        let mut sums = absolute_product(self.pencil.stiffness, x.as_ref());
        if self.sigma != 0.0 {
            sums += faer::Scale(self.sigma.abs()) * absolute_product(self.pencil.mass, x.as_ref());
        }
        for (at, Scalars { column, .. }) in columns.iter().enumerate() {
            let load = dense::column(tile.load.as_ref(), *column);
            let terms = dense::column_mut(tile.terms.as_mut(), *column);
            for ((term, sum), load) in terms.iter_mut().zip(dense::column(sums.as_ref(), at)).zip(load) {
                *term = sum + load.abs();
            }
            let squares = terms.iter().zip(&self.scale).map(|(term, d)| (term * d) * (term * d)).sum::<f64>();
            let at_rest = AT_REST * (squares / n as f64).sqrt();
            terms.iter_mut().zip(&self.scale).for_each(|(term, d)| *term = term.max(at_rest / d));
        }
    }

    /// D (L̃ L̃ᵀ)⁻¹ D times some columns of the residual, n rows.
    fn preconditioned(&self, residual: MatRef<'_, f64>, columns: &[Scalars]) -> Mat<f64> {
        let n = self.analysis.n();
        let scaled = |i: usize, at: usize| residual[(i, columns[at].column)] * self.scale[i];
        let mut z = Mat::from_fn(n, columns.len(), scaled);
        Factor::definite(self.analysis, &self.numbers).solve_eight(z.as_mut());
        for column in z.as_mut().col_iter_mut() {
            column.iter_mut().zip(&self.scale).for_each(|(value, d)| *value *= d);
        }
        z
    }

    /// A X, n + n_B rows.
    fn product(&self, x: MatRef<'_, f64>) -> Mat<f64> {
        let mut y = product(self.pencil.stiffness, x);
        if self.sigma != 0.0 {
            y -= faer::Scale(self.sigma) * product(self.pencil.mass, x);
        }
        y
    }
}

impl Tile {
    /// What is left of a residual in its worst row, relative to the terms there.
    fn left(&self, column: usize) -> f64 {
        let residual = dense::column(self.residual.as_ref(), column).iter();
        dense::worst(residual.zip(dense::column(self.terms.as_ref(), column)).map(|(r, term)| r.abs() / term))
    }
}

fn gathered(x: MatRef<'_, f64>, columns: &[Scalars]) -> Mat<f64> {
    let mut some = Mat::zeros(x.nrows(), columns.len());
    for (at, scalars) in columns.iter().enumerate() {
        some.as_mut().col_mut(at).copy_from(x.col(scalars.column));
    }
    some
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::factor::elimination::Kind;
    use crate::factor::matrix::Shifted;
    use crate::factor::multifrontal::{Keep, eliminate};
    use crate::sparse::SparseMatrix;

    /// Conjugate gradients on a path of 3000 need some thousand steps without a factor of it: the solve is given up, and every
    /// question for the work is answered with the error.
    #[test]
    fn a_solve_that_stays_inaccurate_is_an_error() {
        let n = 3000u32;
        let neighbours = |i: u32| i.saturating_sub(1)..(i + 2).min(n);
        let pointers = (0..=n).map(|i| (0..i).map(|row| neighbours(row).len()).sum()).collect();
        let columns: Vec<u32> = (0..n).flat_map(neighbours).collect();
        let of_row = |i: u32| neighbours(i).map(move |j| if i == j { 2.0 } else { -1.0 });
        let path = SparseMatrix::new((n as usize, n as usize), pointers, columns, (0..n).flat_map(of_row).collect());
        let unit = SparseMatrix::new(path.shape(), (0..=n as usize).collect(), (0..n).collect(), vec![1.0; n as usize]);
        let pencil = Pencil::new(&path, &unit);
        let analysis = Analysis::new(pencil).expect("memory");
        let other = Pencil::new(&unit, &unit);
        let other = Shifted { pencil: other, sigma: 0.0, scale: None, n_border: 0 };
        let numbers = eliminate(&analysis, &other, Kind::Definite, Keep::Factor).expect("definite");
        let refined = Refined::new(&analysis, (pencil, 0.0), vec![1.0; n as usize], numbers);
        let mut x = Mat::from_fn(n as usize, 3, |i, j| if j == 1 { 0.0 } else { ((i * 31) % 23) as f64 - 11.0 });
        refined.solve_in_place(x.as_mut());
        let error = refined.work().expect_err("not refined");
        assert!(
            matches!(error, Error::NotRefined { column: 0, steps: MAX_STEPS, residual, aim } if residual > aim),
            "{error}"
        );
        assert!(x.as_ref().col(1).iter().all(|value| *value == 0.0));
    }
}
