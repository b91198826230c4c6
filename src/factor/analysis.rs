//! The symbolic factorisation: order, supernodes, their rows, tasks, work and memory, before any number is computed.
//!
//! ```text
//! order       elimination tree, postorder
//! supernodes  columns of one pattern, joined
//! tasks       what one thread does at a time
//! ```

mod order;
mod supernodes;
mod tasks;

use std::ops::Range;

use super::Storage;
use super::panels::Shape;
use crate::error::{Error, Result};
use crate::heap::fallibly;
use crate::sparse::Pencil;
use order::{EliminationTree, NONE};
use supernodes::Supernodes;

pub(super) use tasks::{Task, Tasks};

/// The symbolic factorisation of a pencil: structure, work and memory, before any number is computed.
///
/// Steps of elimination are numbered in postorder, whatever the order of the pencil: every subtree is a range of steps. The
/// last dofs of the pencil may be a border, which is not eliminated: its rows are part of L, and what elimination leaves of
/// its block is the Schur complement.
#[derive(Debug)]
pub struct Analysis {
    n: usize,
    n_border: usize,
    given: Vec<u32>,
    step: Vec<u32>,
    first: Vec<usize>,
    rows_at: Vec<usize>,
    rows: Vec<u32>,
    local: Vec<u32>,
    values_at: Vec<usize>,
    n_children: Vec<u32>,
    tasks: Tasks,
    /// Most entries that wait for their parents at once, one front after the other.
    stack: usize,
    /// Entries of the factor, without the zeros that supernodes add.
    pub nnz_factor: f64,
    /// Floating-point operations of one factorisation.
    pub flops: f64,
}

/// One supernode: a dense trapezoid of L, its triangle on top.
#[derive(Clone, Debug)]
pub(super) struct Supernode<'a> {
    /// The steps of its columns.
    pub(super) steps: Range<usize>,
    /// Rows below the triangle, ascending; those from `n` on belong to the border.
    pub(super) below: &'a [u32],
    /// The rows of `below` as places of its task: its own steps first, then those it reaches outside.
    pub(super) local: &'a [u32],
    /// Where its entries are in the factor, by panels.
    pub(super) values: Range<usize>,
    /// Supernodes that hand their rest to it.
    pub(super) n_children: usize,
}

impl Supernode<'_> {
    /// Entries of the trapezoid, those above its diagonal too.
    pub(super) fn n_trapezoid(&self) -> usize {
        (self.steps.len() + self.below.len()).saturating_mul(self.steps.len())
    }

    /// Operations of its elimination: the squares of the lengths of its columns.
    pub(super) fn flops(&self) -> u64 {
        let (size, below) = (self.steps.len() as u64, self.below.len() as u64);
        (below + 1..=below + size).map(|length| length * length).sum()
    }
}

impl Analysis {
    /// Analyses the pattern of K ∪ M.
    ///
    /// # Errors
    /// The factor has more entries than can be counted, or there is no memory for its structure.
    pub fn new(pencil: Pencil<'_>) -> Result<Self> {
        Self::with_border(pencil, 0)
    }

    /// Analyses the pattern of K ∪ M of which the last `n_border` dofs stay.
    ///
    /// # Errors
    /// As [`Analysis::new`].
    pub fn with_border(pencil: Pencil<'_>, n_border: usize) -> Result<Self> {
        let n = pencil.stiffness.rows() - n_border;
        let tree = EliminationTree::new(pencil, n)?;
        let supernodes = Supernodes::new(&tree);
        let n_supernodes = supernodes.parent.len();
        let no_memory = || Error::OutOfMemory { what: "the structure of the factor" };
        let (mut rows_at, mut values_at) = (vec![0usize], vec![0usize]);
        for (steps, below) in supernodes.first.windows(2).zip(&supernodes.n_below) {
            let size = steps[1] - steps[0];
            let shape = Shape { rows: size + below, size };
            // Panels have no more entries than their trapezoid.
            shape.rows.checked_mul(size).ok_or_else(no_memory)?;
            let entries = shape.n_values();
            values_at.push(values_at[values_at.len() - 1].checked_add(entries).ok_or_else(no_memory)?);
            rows_at.push(rows_at[rows_at.len() - 1] + below);
        }
        let mut n_children = vec![0; n_supernodes];
        for up in supernodes.parent.iter().filter(|up| **up != NONE) {
            n_children[*up as usize] += 1;
        }
        let rows = rows(pencil, &tree, &supernodes, &rows_at)?;
        let columns = || tree.counts.iter().map(|count| f64::from(*count));
        let work: Vec<f64> = supernodes.first.windows(2).zip(&supernodes.n_below).map(work_of_supernode).collect();
        let tasks = Tasks::new(&supernodes, &work);
        let mut analysis = Self {
            n,
            n_border,
            nnz_factor: columns().sum(),
            flops: columns().map(|count| count * count).sum(),
            given: tree.given,
            step: tree.step,
            first: supernodes.first,
            rows_at,
            rows,
            local: Vec::new(),
            values_at,
            n_children,
            tasks,
            stack: 0,
        };
        analysis.number_places();
        analysis.stack = analysis.predicted_stack();
        Ok(analysis)
    }

    /// Most entries of rests at once where fronts are eliminated in order, and the largest trapezoid: both stay until the end.
    fn predicted_stack(&self) -> usize {
        let (mut live, mut peak, mut largest) = (0usize, 0usize, 0usize);
        let mut waiting = Vec::new();
        for s in 0..self.n_children.len() {
            let node = self.supernode(s);
            let rest = node.below.len().saturating_mul(node.below.len() + 1);
            largest = largest.max(node.n_trapezoid());
            live = live.saturating_add(rest);
            peak = peak.max(live);
            for child in waiting.drain(waiting.len() - node.n_children..) {
                live -= child;
            }
            waiting.push(rest);
        }
        peak.saturating_add(largest)
    }

    /// Numbers the places of each task: its own steps first, then those it reaches outside.
    fn number_places(&mut self) {
        let mut local = Vec::with_capacity(self.rows.len());
        for task in &self.tasks.0 {
            let rows = self.rows_at[task.supernodes.start]..self.rows_at[task.supernodes.end];
            let places = Places { steps: self.steps_of(task), outer: self.outer_of(task) };
            local.extend(self.rows[rows].iter().map(|row| places.of(*row)));
        }
        let to_parent = |task: &Task| {
            let places = match task.parent {
                Some(up) => Places { steps: self.steps_of(&self.tasks.0[up]), outer: self.outer_of(&self.tasks.0[up]) },
                None => Places { steps: self.n..self.n + self.n_border, outer: &[] },
            };
            self.outer_of(task).iter().map(|row| places.of(*row)).collect()
        };
        let to_parent: Vec<Vec<u32>> = self.tasks.0.iter().map(to_parent).collect();
        for (task, to_parent) in self.tasks.0.iter_mut().zip(to_parent) {
            task.to_parent = to_parent;
        }
        self.local = local;
    }

    /// Dofs that are eliminated.
    pub fn n(&self) -> usize {
        self.n
    }

    /// Dofs that stay.
    pub fn n_border(&self) -> usize {
        self.n_border
    }

    /// Bytes that one factor takes, with the zeros that supernodes add.
    pub fn factor_bytes(&self, storage: Storage) -> u64 {
        let bytes = match storage {
            Storage::Double => 8u64,
            Storage::Single => 4,
        };
        bytes.saturating_mul(self.n_values() as u64)
    }

    /// Bytes that elimination needs in addition to the factor when one thread does it: what waits for its parent, and the largest front.
    pub fn stack_bytes(&self) -> u64 {
        8u64.saturating_mul(self.stack as u64)
    }

    /// Entries of a factor, with the zeros that supernodes add.
    pub(super) fn n_values(&self) -> usize {
        self.values_at[self.values_at.len() - 1]
    }

    pub(super) fn supernode(&self, s: usize) -> Supernode<'_> {
        Supernode {
            steps: self.first[s]..self.first[s + 1],
            below: &self.rows[self.rows_at[s]..self.rows_at[s + 1]],
            local: &self.local[self.rows_at[s]..self.rows_at[s + 1]],
            values: self.values_at[s]..self.values_at[s + 1],
            n_children: self.n_children[s] as usize,
        }
    }

    pub(super) fn tasks(&self) -> &Tasks {
        &self.tasks
    }

    /// Steps of a task's columns.
    pub(super) fn steps_of(&self, task: &Task) -> Range<usize> {
        self.first[task.supernodes.start]..self.first[task.supernodes.end]
    }

    /// Entries of the factor in a task's columns.
    pub(super) fn values_of(&self, task: &Task) -> Range<usize> {
        self.values_at[task.supernodes.start]..self.values_at[task.supernodes.end]
    }

    /// Later steps that a task's columns reach.
    pub(super) fn outer_of(&self, task: &Task) -> &[u32] {
        &self.rows[self.rows_at[task.supernodes.end - 1]..self.rows_at[task.supernodes.end]]
    }

    /// Dof of the pencil at each step, the border excluded.
    pub(super) fn given(&self) -> &[u32] {
        &self.given
    }

    /// Step of each dof of the pencil, the border included.
    pub(super) fn step(&self) -> &[u32] {
        &self.step
    }
}

/// The places of a task.
struct Places<'a> {
    steps: Range<usize>,
    outer: &'a [u32],
}

impl Places<'_> {
    fn of(&self, row: u32) -> u32 {
        match (row as usize).checked_sub(self.steps.start) {
            Some(own) if own < self.steps.len() => own as u32,
            _ => (self.steps.len() + self.outer.partition_point(|outer| *outer < row)) as u32,
        }
    }
}

/// Operations of the dense elimination of a supernode.
fn work_of_supernode((steps, below): (&[usize], &usize)) -> f64 {
    let (size, below) = ((steps[1] - steps[0]) as f64, *below as f64);
    size.powi(3) / 3.0 + size * size * below + size * below * below
}

/// Rows below the triangle of every supernode: those of its children and of the matrix.
fn rows(pencil: Pencil<'_>, tree: &EliminationTree, supernodes: &Supernodes, rows_at: &[usize]) -> Result<Vec<u32>> {
    let n_rows = rows_at[rows_at.len() - 1];
    let mut rows = Vec::new();
    let room = fallibly(|| rows.try_reserve_exact(n_rows));
    room.map_err(|_| Error::OutOfMemory { what: "the structure of the factor" })?;
    let mut seen_by = vec![NONE; tree.step.len()];
    let mut last_child = vec![NONE; supernodes.parent.len()];
    let mut sibling_before = vec![NONE; supernodes.parent.len()];
    for s in 0..supernodes.parent.len() {
        let steps = supernodes.first[s]..supernodes.first[s + 1];
        let start = rows.len();
        let mut take = |row: u32, rows: &mut Vec<u32>| {
            if row as usize >= steps.end && seen_by[row as usize] != s as u32 {
                seen_by[row as usize] = s as u32;
                rows.push(row);
            }
        };
        let mut child = last_child[s];
        while child != NONE {
            for at in rows_at[child as usize]..rows_at[child as usize + 1] {
                take(rows[at], &mut rows);
            }
            child = sibling_before[child as usize];
        }
        for dof in &tree.given[steps.clone()] {
            for matrix in [pencil.stiffness, pencil.mass] {
                matrix.entries(*dof as usize).for_each(|(col, _)| take(tree.step[col], &mut rows));
            }
        }
        rows[start..].sort_unstable();
        assert!(rows.len() == rows_at[s + 1], "supernode {s} has other rows than its column count");
        let up = supernodes.parent[s];
        if up != NONE {
            sibling_before[s] = last_child[up as usize];
            last_child[up as usize] = s as u32;
        }
    }
    Ok(rows)
}
