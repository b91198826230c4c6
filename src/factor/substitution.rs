//! Solves: forward from the leaves of the tree of tasks, backward from its roots, a block of right-hand sides at a time.
//!
//! Going forward a task works on the rows of its own steps and gathers what it changes outside, `outer`, which its parent
//! adds to its own in the order of its children; going backward a child fetches those rows from its parent. No row is
//! ever written by two tasks, so that tasks may run side by side.
//!
//! ```text
//! forward    y = B⁻¹ L_11⁻¹ P f,   f_border − L_border y
//! backward   x = Pᵀ L_11⁻ᵀ (y − L_borderᵀ x_border)
//! ```

use std::sync::Mutex;

use faer::prelude::ReborrowMut;
use faer::{Mat, MatMut, MatRef};
use rayon::prelude::*;

use super::Analysis;
use super::elimination::Kind;
use super::entry::Entry;
use super::multifrontal::{Numbers, lock};
use super::rows::{Block, Row};
use crate::tally;

/// Rows that are packed or unpacked by one task.
const PACK_ROWS: usize = 1024;

/// A factor as the solves see it.
pub(super) struct Factor<'a, T> {
    analysis: &'a Analysis,
    numbers: &'a Numbers<T>,
    kind: Kind,
}

impl<T> Clone for Factor<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Factor<'_, T> {}

impl<'a, T: Entry> Factor<'a, T> {
    pub(super) fn definite(analysis: &'a Analysis, numbers: &'a Numbers<T>) -> Self {
        Self { analysis, numbers, kind: Kind::Definite }
    }

    pub(super) fn indefinite(analysis: &'a Analysis, numbers: &'a Numbers<T>) -> Self {
        Self { analysis, numbers, kind: Kind::Indefinite }
    }

    /// X ← A_II⁻¹ X, n rows: the border is held.
    pub(super) fn solve_in_place(self, block: MatMut<'_, f64>) {
        let mut block = block;
        let mut start = 0;
        while start < block.ncols() {
            let left = block.ncols() - start;
            let tile = block.rb_mut().subcols_mut(start, left.min(16));
            start += tile.ncols();
            match left {
                1..=4 => self.solve_tile::<4>(tile),
                5..=8 => self.solve_tile::<8>(tile),
                _ => self.solve_tile::<16>(tile),
            }
        }
    }

    /// Solves for a block of at most eight columns.
    pub(super) fn solve_eight(self, block: MatMut<'_, f64>) {
        self.solve_tile::<8>(block);
    }

    /// ‖L⁻¹f‖² of each column of loads, n rows, by a definite factor: the forward half alone.
    pub(super) fn compliances(self, loads: MatRef<'_, f64>) -> Vec<f64> {
        let mut compliances = Vec::with_capacity(loads.ncols());
        for start in (0..loads.ncols()).step_by(16) {
            let left = loads.ncols() - start;
            let tile = loads.subcols(start, left.min(16));
            match left {
                1..=4 => compliances.extend_from_slice(&self.compliances_of_tile::<4>(tile)[..left]),
                5..=8 => compliances.extend_from_slice(&self.compliances_of_tile::<8>(tile)[..left]),
                _ => compliances.extend_from_slice(&self.compliances_of_tile::<16>(tile)[..tile.ncols()]),
            }
        }
        compliances
    }

    fn compliances_of_tile<const W: usize>(self, tile: MatRef<'_, f64>) -> Row<W> {
        let mut rows = pack::<W>(tile, |step| self.analysis.given()[step] as usize);
        self.forward(&mut rows, &mut vec![[0.0; W]; self.analysis.n_border()]);
        squares(&rows)
    }

    /// −A_II⁻¹ A_IB X_B for motions of the border, n_B rows: the backward half alone.
    pub(super) fn follow_border(self, border: MatRef<'_, f64>) -> Mat<f64> {
        const W: usize = 8;
        let mut x = Mat::zeros(self.analysis.n(), border.ncols());
        for start in (0..border.ncols()).step_by(W) {
            let width = W.min(border.ncols() - start);
            let mut rows = vec![[0.0; W]; self.analysis.n()];
            let at_border = pack::<W>(border.subcols(start, width), |row| row);
            self.backward(&mut rows, &at_border);
            self.unpack(&rows, x.as_mut().subcols_mut(start, width));
            tally::solved(width);
        }
        x
    }

    /// −A_BI A_II⁻¹ F of loads, n rows: the forward half alone.
    pub(super) fn load_border(self, loads: MatRef<'_, f64>) -> Mat<f64> {
        const W: usize = 8;
        let mut gathered = Mat::zeros(self.analysis.n_border(), loads.ncols());
        for start in (0..loads.ncols()).step_by(W) {
            let width = W.min(loads.ncols() - start);
            let mut rows = pack::<W>(loads.subcols(start, width), |step| self.analysis.given()[step] as usize);
            let mut border = vec![[0.0; W]; self.analysis.n_border()];
            self.forward(&mut rows, &mut border);
            let mut tile = gathered.as_mut().subcols_mut(start, width);
            tile.copy_from(Mat::from_fn(border.len(), width, |i, j| border[i][j]));
        }
        gathered
    }

    /// X ← A⁻¹ X, n + n_B rows; `at_border` solves with the Schur complement.
    pub(super) fn solve_with_border(self, mut block: MatMut<'_, f64>, at_border: impl Fn(MatMut<'_, f64>)) {
        const W: usize = 8;
        let (n, n_border) = (self.analysis.n(), self.analysis.n_border());
        for start in (0..block.ncols()).step_by(W) {
            let width = W.min(block.ncols() - start);
            let tile = block.rb_mut().subcols_mut(start, width);
            let (mut internal, mut interface) = tile.split_at_row_mut(n);
            let mut rows = pack::<W>(internal.as_ref(), |step| self.analysis.given()[step] as usize);
            let mut border = pack::<W>(interface.as_ref(), |row| row);
            self.forward(&mut rows, &mut border);
            interface.copy_from(Mat::from_fn(n_border, width, |i, j| border[i][j]));
            at_border(interface.rb_mut());
            let border = pack::<W>(interface.as_ref(), |row| row);
            self.backward(&mut rows, &border);
            self.unpack(&rows, internal.rb_mut());
            tally::solved(width);
        }
    }

    /// At most W right-hand sides.
    fn solve_tile<const W: usize>(self, tile: MatMut<'_, f64>) {
        let mut rows = pack::<W>(tile.as_ref(), |step| self.analysis.given()[step] as usize);
        let mut border = vec![[0.0; W]; self.analysis.n_border()];
        let width = tile.ncols();
        self.forward(&mut rows, &mut border);
        border.fill([0.0; W]);
        self.backward(&mut rows, &border);
        self.unpack(&rows, tile);
        tally::solved(width);
    }

    fn unpack<const W: usize>(self, rows: &[Row<W>], tile: MatMut<'_, f64>) {
        let step = self.analysis.step();
        tile.par_row_chunks_mut(PACK_ROWS).enumerate().for_each(|(chunk, mut tile)| {
            let steps = &step[chunk * PACK_ROWS..][..tile.nrows()];
            for (j, column) in tile.as_mut().col_iter_mut().enumerate() {
                for (value, step) in column.iter_mut().zip(steps) {
                    *value = rows[*step as usize][j];
                }
            }
        });
    }

    /// Eliminates: `rows` by steps, and what is left at the border is added to `border`.
    fn forward<const W: usize>(self, rows: &mut [Row<W>], border: &mut [Row<W>]) {
        let tasks = &self.analysis.tasks().0;
        let own = self.by_task(rows);
        let outer: Vec<Mutex<Vec<Row<W>>>> = tasks.iter().map(|_| Mutex::new(Vec::new())).collect();
        self.analysis.tasks().leaves_first(|t| {
            let task = &tasks[t];
            let mut own = lock(&own[t]);
            let mut out = vec![[0.0; W]; task.to_parent.len()];
            for child in &task.children {
                let change = std::mem::take(&mut *lock(&outer[*child]));
                add(&change, &tasks[*child].to_parent, &mut own, &mut out);
            }
            let first = self.analysis.steps_of(task).start;
            let mut update = Vec::new();
            for s in task.supernodes.clone() {
                let node = self.analysis.supernode(s);
                let block = Block::new(self.numbers.supernode(self.analysis, t, s), self.kind);
                let top = node.steps.start - first..node.steps.end - first;
                block.forward(&mut own[top.clone()], &mut update);
                block.divide(&mut own[top]);
                add(&update, node.local, &mut own, &mut out);
            }
            *lock(&outer[t]) = out;
        });
        for (t, task) in tasks.iter().enumerate().filter(|(_, task)| task.parent.is_none()) {
            add(&lock(&outer[t]), &task.to_parent, border, &mut []);
        }
    }

    /// Substitutes back from the rows of `border`.
    fn backward<const W: usize>(self, rows: &mut [Row<W>], border: &[Row<W>]) {
        let tasks = &self.analysis.tasks().0;
        let own = self.by_task(rows);
        let outer: Vec<Mutex<Vec<Row<W>>>> = tasks.iter().map(|_| Mutex::new(Vec::new())).collect();
        self.analysis.tasks().roots_first(|t| {
            let task = &tasks[t];
            let out = match task.parent {
                Some(up) => fetched(&task.to_parent, &lock(&own[up]), &lock(&outer[up])),
                None => fetched(&task.to_parent, border, &[]),
            };
            let mut own = lock(&own[t]);
            let first = self.analysis.steps_of(task).start;
            let mut below = Vec::new();
            for s in task.supernodes.clone().rev() {
                let node = self.analysis.supernode(s);
                let block = Block::new(self.numbers.supernode(self.analysis, t, s), self.kind);
                fetch(node.local, &own, &out, &mut below);
                block.backward(&mut own[node.steps.start - first..node.steps.end - first], &below);
            }
            *lock(&outer[t]) = out;
        });
    }

    /// The rows of each task's own steps.
    fn by_task<const W: usize>(self, mut rows: &mut [Row<W>]) -> Vec<Mutex<&mut [Row<W>]>> {
        let tasks = self.analysis.tasks().0.iter();
        let split =
            |task| rows.split_off_mut(..self.analysis.steps_of(task).len()).expect("the tasks make up the steps");
        tasks.map(split).map(Mutex::new).collect()
    }
}

/// Rows of W from a block of at most W columns; `row_at` is the row of the block at each place.
fn pack<const W: usize>(block: MatRef<'_, f64>, row_at: impl Fn(usize) -> usize + Sync) -> Vec<Row<W>> {
    let mut rows = vec![[0.0; W]; block.nrows()];
    rows.par_chunks_mut(PACK_ROWS).enumerate().for_each(|(chunk, rows)| {
        for (j, column) in block.col_iter().enumerate() {
            for (place, row) in rows.iter_mut().enumerate() {
                row[j] = column[row_at(chunk * PACK_ROWS + place)];
            }
        }
    });
    rows
}

/// The sum of the squares of each column, added up by chunks of a fixed size.
fn squares<const W: usize>(rows: &[Row<W>]) -> Row<W> {
    let of_chunk = |rows: &[Row<W>]| {
        rows.iter().fold([0.0; W], |sums: Row<W>, row| std::array::from_fn(|j| sums[j] + row[j] * row[j]))
    };
    let chunks: Vec<Row<W>> = rows.par_chunks(PACK_ROWS).map(of_chunk).collect();
    chunks.iter().fold([0.0; W], |sums, chunk| std::array::from_fn(|j| sums[j] + chunk[j]))
}

/// Adds rows to the places they belong to, own ones first.
fn add<const W: usize>(rows: &[Row<W>], places: &[u32], own: &mut [Row<W>], outer: &mut [Row<W>]) {
    for (row, place) in rows.iter().zip(places) {
        let place = *place as usize;
        let target = if place < own.len() { &mut own[place] } else { &mut outer[place - own.len()] };
        for (target, value) in target.iter_mut().zip(row) {
            *target += value;
        }
    }
}

fn fetch<const W: usize>(places: &[u32], own: &[Row<W>], outer: &[Row<W>], rows: &mut Vec<Row<W>>) {
    rows.clear();
    rows.extend(places.iter().map(|place| {
        let place = *place as usize;
        if place < own.len() { own[place] } else { outer[place - own.len()] }
    }));
}

fn fetched<const W: usize>(places: &[u32], own: &[Row<W>], outer: &[Row<W>]) -> Vec<Row<W>> {
    let mut rows = Vec::new();
    fetch(places, own, outer, &mut rows);
    rows
}
