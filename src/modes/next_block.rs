//! The next block of a Lanczos basis: M-orthogonal to what is there, M-orthonormal in itself.

use faer::{Mat, MatRef};
use rayon::prelude::*;

use super::eigenproblem::mass_norm;
use super::lanczos::Basis;
use super::orthogonalisation::mass_qr;
use crate::dense;
use crate::sparse::product;

/// Share of its length that a column may lose to the columns before it while M times it is still good enough as it is carried
/// along: it loses one digit then.
const SHRINKS: f64 = 0.1;

/// Passes over V, the last one only where the one before left little of a column.
const MAX_PASSES: usize = 3;
/// Share of a unit column that is not rounding, where the first pass was not over all of V: half its digits.
const LEFT: f64 = 1e-8;
/// Share of a unit column that has to be left for its orthogonality to be that of rounding: twice is enough.
const MIN_SHARE_LEFT: f64 = 0.5;

/// What a block has of the columns of V, before anything is taken out of it.
pub(super) struct Coupled {
    /// The first column that it has anything of but rounding.
    from: usize,
    /// The shares of the columns from there on.
    shares: Mat<f64>,
    /// Length below which a column of the block is rounding.
    floor: f64,
}

impl Basis<'_> {
    /// Makes a block M-orthogonal to V and M-orthonormal in itself: block = V C + W B. Stores W and M W.
    ///
    /// The first pass takes out `start` and normalises, however small the columns are; the second, on columns of unit length,
    /// takes out what rounding left along all of V. Errors of a solve lie along the lowest modes and grow with the condition of
    /// K: where they made up most of a column, there is a third pass.
    pub(super) fn orthonormalise(&mut self, mut block: Mat<f64>, start: Coupled) -> (Mat<f64>, Mat<f64>) {
        let width = block.ncols();
        let mut known = Some(start.shares);
        let mut coefficients = Mat::zeros(self.size, width);
        let mut coupling: Mat<f64> = Mat::identity(width, width);
        let mut mass_block = Mat::zeros(0, 0);
        let mut dependent = vec![false; width];
        for pass in 0..MAX_PASSES {
            let (from, least) = match pass {
                0 => (start.from, start.floor),
                1 if start.from > 0 => (0, LEFT),
                _ => (0, MIN_SHARE_LEFT),
            };
            let basis = self.v().subcols(from, self.size - from);
            let c = known.take().unwrap_or_else(|| dense::gram(basis, mass_block.as_ref()));
            dense::add_product(block.as_mut(), -1.0, basis, c.as_ref());
            dense::add_product(coefficients.as_mut().subrows_mut(from, c.nrows()), 1.0, c.as_ref(), coupling.as_ref());
            // What was blown up took its rounding along: rigid-body motion, and the difference between M W and what is carried.
            self.problem.deflate(block.as_mut());
            mass_block = product(self.problem.mass, block.as_ref());
            let r = mass_qr(&mut block, &mut mass_block, least, &mut dependent);
            coupling = dense::product(r.as_ref(), coupling.as_ref());
            if pass > 0 && (0..width).all(|j| dependent[j] || r[(j, j)] > MIN_SHARE_LEFT) {
                break;
            }
            if shrinks(&r) {
                mass_block = product(self.problem.mass, block.as_ref());
            }
        }
        self.replace_dependent(&mut block, &dependent);
        let kept: Vec<usize> = (0..width).filter(|j| !dependent[*j] || self.holds(block.as_ref(), *j)).collect();
        let coupling = Mat::from_fn(kept.len(), width, |i, j| coupling[(kept[i], j)]);
        let next = self.vectors.as_mut().subcols_mut(self.size, kept.len());
        next.par_col_iter_mut().zip(&kept).for_each(|(mut column, j)| column.copy_from(block.col(*j)));
        let next = self.vectors.as_ref().subcols(self.size, kept.len());
        let is_carried = dependent.iter().all(|dependent| !dependent);
        self.mass_next = if is_carried { mass_block } else { product(self.problem.mass, next) };
        (coefficients, coupling)
    }

    /// What a block has of all of V, by inner products.
    pub(super) fn coupled_to_all(&self, block: &Mat<f64>) -> Coupled {
        let mass_block = product(self.problem.mass, block.as_ref());
        let own = (0..block.ncols()).fold(0.0f64, |max, j| {
            let square = dense::dot(dense::column(block.as_ref(), j), dense::column(mass_block.as_ref(), j));
            max.max(square.max(0.0).sqrt())
        });
        let floor = f64::EPSILON * self.largest_diagonal().max(own);
        Coupled { from: 0, shares: dense::gram(self.v(), mass_block.as_ref()), floor }
    }

    /// What OP W has of V, W the last columns of V and `mass_last` M W. By its recurrence OP W couples to W and to the block
    /// before W alone, and to that one by Bᵀ = (OP V)ᵀ M W: neither asks for M OP W.
    pub(super) fn coupled_by_recurrence(&self, mass_last: &Mat<f64>, image: &Mat<f64>) -> Coupled {
        let before = self.size - mass_last.ncols();
        let to_previous = self.coupling.as_ref().subcols(self.recent, before - self.recent).transpose();
        let mut shares = Mat::zeros(self.size - self.recent, image.ncols());
        shares.as_mut().subrows_mut(0, before - self.recent).copy_from(to_previous);
        let to_last = dense::gram(mass_last.as_ref(), image.as_ref());
        shares.as_mut().subrows_mut(before - self.recent, mass_last.ncols()).copy_from(&to_last);
        let own = (0..to_last.ncols().min(to_last.nrows())).fold(0.0f64, |max, j| max.max(to_last[(j, j)].abs()));
        Coupled { from: self.recent, shares, floor: f64::EPSILON * self.largest_diagonal().max(own) }
    }

    fn largest_diagonal(&self) -> f64 {
        (0..self.projected.nrows()).fold(0.0f64, |max, i| max.max(self.projected[(i, i)].abs()))
    }

    fn holds(&self, block: MatRef<'_, f64>, j: usize) -> bool {
        dense::column(block, j).iter().any(|value| *value != 0.0)
    }

    /// Puts new random directions in the place of dependent columns, or zeros where the space is exhausted.
    fn replace_dependent(&mut self, block: &mut Mat<f64>, dependent: &[bool]) {
        const ATTEMPTS: usize = 3;
        for j in (0..block.ncols()).filter(|j| dependent[*j]) {
            dense::column_mut(block.as_mut(), j).fill(0.0);
            for _ in 0..ATTEMPTS {
                let mut fresh = Mat::zeros(block.nrows(), 1);
                self.random.fill(fresh.as_mut());
                self.problem.deflate(fresh.as_mut());
                let mut image = product(self.problem.mass, fresh.as_ref());
                self.apply(&mut image);
                if let Some(unit) = self.unit_component(&image, block) {
                    block.as_mut().subcols_mut(j, 1).copy_from(&unit);
                    break;
                }
            }
        }
    }

    /// The part of a vector M-orthogonal to V and to the block, at unit length; none where nothing but rounding is left.
    fn unit_component(&self, image: &Mat<f64>, block: &Mat<f64>) -> Option<Mat<f64>> {
        // What is left of a random direction after projection is of order one unless the space is exhausted.
        const LEFT: f64 = 1e-8;
        let mut vector = image.clone();
        for pass in 0..3 {
            let before = mass_norm(self.problem.mass, &vector);
            for basis in [self.v(), block.as_ref()] {
                let c = dense::gram(basis, product(self.problem.mass, vector.as_ref()).as_ref());
                dense::add_product(vector.as_mut(), -1.0, basis, c.as_ref());
            }
            let after = mass_norm(self.problem.mass, &vector);
            if after.is_nan() || after <= if pass == 0 { LEFT } else { 0.5 } * before {
                return None;
            }
            vector.as_mut().col_mut(0).iter_mut().for_each(|value| *value /= after);
        }
        Some(vector)
    }
}

/// Whether a column lost so much to those before it that M times it, which was carried along, lost digits; `r` is their triangle.
fn shrinks(r: &Mat<f64>) -> bool {
    (0..r.ncols()).any(|j| r[(j, j)] < SHRINKS * dense::norm(dense::column(r.as_ref(), j)))
}
