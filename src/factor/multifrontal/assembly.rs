//! What fronts hand to their parents, where it waits, and where it goes.

use faer::MatMut;

use crate::factor::Analysis;
use crate::factor::analysis::Supernode;
use crate::heap::fallibly;

/// Why there is no factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::factor) enum Stop {
    /// The first step, in order of elimination, whose pivot is not positive.
    NotPositive(usize),
    /// No memory.
    NoMemory,
}

/// Rows and entries that a child leaves to its parent: a lower triangle, by columns of full length, and after it what the rows
/// have of the diagonal of |L||B||Lᵀ| so far.
pub(super) struct Rest<'a> {
    pub(super) rows: &'a [u32],
    pub(super) values: &'a [f64],
}

/// Entries of a rest of b rows.
pub(super) fn rest_len(b: usize) -> usize {
    b * b + b
}

/// Where the rows of a child lie in the front of its parent, by runs of neighbours.
pub(super) struct Places {
    n_rows: usize,
    /// Columns of the parent that are eliminated.
    size: usize,
    /// How many of the child's rows are such columns.
    n_columns: usize,
    runs: Vec<PlaceRun>,
}

/// Rows `child` .. of the child at rows `parent` .. of the parent's front.
#[derive(Clone, Copy)]
struct PlaceRun {
    child: usize,
    parent: usize,
    len: usize,
}

impl Places {
    pub(super) fn new(rows: &[u32], node: &Supernode<'_>, place: &[u32]) -> Self {
        let place_of = |row: u32| match node.steps.contains(&(row as usize)) {
            true => row as usize - node.steps.start,
            false => place[row as usize] as usize,
        };
        let mut runs: Vec<PlaceRun> = Vec::new();
        for (child, row) in rows.iter().enumerate() {
            let parent = place_of(*row);
            match runs.last_mut() {
                Some(run) if run.parent + run.len == parent => run.len += 1,
                _ => runs.push(PlaceRun { child, parent, len: 1 }),
            }
        }
        let n_columns = rows.partition_point(|row| (*row as usize) < node.steps.end);
        Self { n_rows: rows.len(), size: node.steps.len(), n_columns, runs }
    }

    /// Adds the child's entries in columns that the parent eliminates.
    pub(super) fn add_columns(&self, child: &[f64], mut trapezoid: MatMut<'_, f64>) {
        self.add(child, 0..self.n_columns, 0, trapezoid.as_mut());
    }

    /// Adds the child's other entries to the parent's own rest.
    pub(super) fn add_rest(&self, child: &[f64], mut rest: MatMut<'_, f64>) {
        self.add(child, self.n_columns..self.n_rows, self.size, rest.as_mut());
    }

    /// Adds what the child's rows have of the products so far.
    pub(super) fn add_products(&self, child: &[f64], products: &mut [f64]) {
        let of_child = &child[self.n_rows * self.n_rows..];
        for run in &self.runs {
            let target = &mut products[run.parent..run.parent + run.len];
            target.iter_mut().zip(&of_child[run.child..run.child + run.len]).for_each(|(sum, product)| *sum += product);
        }
    }

    /// Adds some columns of the child to a block that begins `skipped` rows and columns into the front.
    fn add(&self, child: &[f64], columns: std::ops::Range<usize>, skipped: usize, mut block: MatMut<'_, f64>) {
        let mut first_run = 0;
        for j in columns {
            while self.runs[first_run].child + self.runs[first_run].len <= j {
                first_run += 1;
            }
            let at = self.runs[first_run];
            let target = crate::dense::column_mut(block.as_mut(), at.parent + (j - at.child) - skipped);
            let source = &child[j * self.n_rows..(j + 1) * self.n_rows];
            for run in &self.runs[first_run..] {
                let start = run.child.max(j);
                let len = run.child + run.len - start;
                let to = run.parent + (start - run.child) - skipped;
                for (target, source) in target[to..to + len].iter_mut().zip(&source[start..start + len]) {
                    *target += source;
                }
            }
        }
    }
}

/// Rests that wait for their parents inside a task, the next parent's children on top.
#[derive(Default)]
pub(super) struct RestStack {
    values: Vec<f64>,
    /// Supernodes and where their rests begin.
    held: Vec<(usize, usize)>,
    top: usize,
}

impl RestStack {
    pub(super) fn clear(&mut self) {
        self.held.clear();
        self.top = 0;
    }

    /// The rests of a supernode's children, and room for its own above them.
    pub(super) fn open<'b>(
        &'b mut self,
        analysis: &'b Analysis,
        node: &Supernode<'_>,
        room: usize,
    ) -> std::result::Result<(Vec<Rest<'b>>, &'b mut [f64]), Stop> {
        if let Some(more) = (self.top + room).checked_sub(self.values.len()) {
            fallibly(|| self.values.try_reserve(more)).map_err(|_| Stop::NoMemory)?;
            self.values.resize(self.top + room, 0.0);
        }
        let (below, above) = self.values.split_at_mut(self.top);
        let below = &*below;
        let children = self.held[self.held.len().saturating_sub(node.n_children)..].iter().map(|(child, start)| {
            let rows = analysis.supernode(*child).below;
            Rest { rows, values: &below[*start..start + rest_len(rows.len())] }
        });
        Ok((children.collect(), &mut above[..room]))
    }

    /// Puts the rest of supernode `s` in the place of its children's.
    pub(super) fn close(&mut self, s: usize, node: &Supernode<'_>) {
        let room = rest_len(node.below.len());
        let first_child = self.held.len() - node.n_children;
        let bottom = self.held.get(first_child).map_or(self.top, |(_, start)| *start);
        self.values.copy_within(self.top..self.top + room, bottom);
        self.held.truncate(first_child);
        self.held.push((s, bottom));
        self.top = bottom + room;
    }
}
