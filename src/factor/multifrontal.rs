//! Multifrontal elimination: one dense front for each supernode, taken over by its parent (Duff, Reid 1983).
//!
//! ```text
//! front of s   columns of the matrix + rests of the children
//! eliminated   columns of L, and a rest for the parent
//! ```
//! Inside a task the rests lie on a stack, the children's on top; between tasks they are handed over one by one. What reaches the border
//! is the Schur complement.

use std::sync::{Mutex, OnceLock};

use faer::dyn_stack::MemBuffer;
use faer::{Mat, MatMut, MatRef};

use super::Analysis;
use super::analysis::{Supernode, Task};
use super::elimination::{self, Kind, Pivots, eliminate_columns, outer_product};
use super::matrix::Shifted;

/// What is kept of L.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Keep {
    /// Everything, for solves.
    Factor,
    /// The pivots alone, for counting.
    Pivots,
}

/// The numbers of a factor.
#[derive(Debug)]
pub(super) struct Numbers {
    /// Those of each task.
    tasks: Vec<TaskNumbers>,
    /// What elimination left of the border, both triangles.
    pub(super) schur: Mat<f64>,
}

/// The numbers that one task computes.
#[derive(Debug, Default)]
struct TaskNumbers {
    /// Entries of L by supernodes; none where only the pivots are kept.
    values: Vec<f64>,
    diagonal: Vec<f64>,
    subdiagonal: Vec<f64>,
    order: Vec<u32>,
}

/// The numbers of one supernode.
#[derive(Clone, Copy, Debug)]
pub(super) struct Eliminated<'a> {
    /// L_11 and L_21.
    pub(super) trapezoid: MatRef<'a, f64>,
    /// Diagonal of B; of a definite matrix the squares of the diagonal of L.
    pub(super) diagonal: &'a [f64],
    /// Couplings of pivots of order two.
    pub(super) subdiagonal: &'a [f64],
    /// Column of its panel at each place.
    pub(super) order: &'a [u32],
}

impl Numbers {
    /// Supernode `s` of task `t`; the factor was kept.
    pub(super) fn supernode<'a>(&'a self, analysis: &Analysis, t: usize, s: usize) -> Eliminated<'a> {
        let (numbers, task) = (&self.tasks[t], &analysis.tasks().0[t]);
        let node = analysis.supernode(s);
        let (size, start) = (node.steps.len(), node.steps.start - analysis.steps_of(task).start);
        let first = node.values.start - analysis.values_of(task).start;
        let values = &numbers.values[first..first + node.values.len()];
        Eliminated {
            trapezoid: MatRef::from_column_major_slice(values, size + node.below.len(), size),
            diagonal: &numbers.diagonal[start..start + size],
            subdiagonal: &numbers.subdiagonal[start..start + size],
            order: &numbers.order[start..start + size],
        }
    }

    /// All supernodes of a factor that was kept, in order of elimination.
    pub(super) fn supernodes<'a>(
        &'a self,
        analysis: &'a Analysis,
    ) -> impl Iterator<Item = (Supernode<'a>, Eliminated<'a>)> {
        analysis.tasks().0.iter().enumerate().flat_map(move |(t, task)| {
            task.supernodes.clone().map(move |s| (analysis.supernode(s), self.supernode(analysis, t, s)))
        })
    }

    /// Diagonal and couplings of B, by steps.
    pub(super) fn pivots(&self) -> impl Iterator<Item = (f64, f64)> {
        self.tasks.iter().flat_map(|task| task.diagonal.iter().copied().zip(task.subdiagonal.iter().copied()))
    }
}

/// Why there is no factor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Stop {
    /// The first step, in order of elimination, whose pivot is not positive.
    NotPositive(usize),
    /// No memory.
    NoMemory,
}

/// The part of a factor that is still to be computed.
struct Part<'a> {
    values: &'a mut [f64],
    pivots: Pivots<'a>,
}

/// Rows and entries that a child leaves to its parent: a lower triangle, by columns of full length.
struct Rest<'a> {
    rows: &'a [u32],
    values: &'a [f64],
}

/// Memory that a thread uses again for its next task.
struct Workspace {
    /// Row of the front at each step that is one of its rows.
    place: Vec<u32>,
    stack: RestStack,
    tools: Tools,
}

/// What the elimination of one supernode needs beside its front.
struct Tools {
    /// A trapezoid that is not kept.
    trapezoid: Vec<f64>,
    /// For the dense kernels.
    dense: MemBuffer,
}

impl Workspace {
    fn new(analysis: &Analysis) -> Self {
        let tools = Tools { trapezoid: Vec::new(), dense: MemBuffer::new(elimination::scratch()) };
        Self { place: vec![0; analysis.step().len()], stack: RestStack::default(), tools }
    }
}

/// Eliminates all but the border of `matrix`.
pub(super) fn eliminate(
    analysis: &Analysis,
    matrix: &Shifted<'_>,
    kind: Kind,
    keep: Keep,
) -> std::result::Result<Numbers, Stop> {
    let tasks = analysis.tasks();
    let numbers: Vec<OnceLock<TaskNumbers>> = tasks.0.iter().map(|_| OnceLock::new()).collect();
    let rests: Vec<Mutex<Handed>> = tasks.0.iter().map(|_| Mutex::new(Ok(Vec::new()))).collect();
    let workspaces = Mutex::new(Vec::new());
    tasks.from_leaves(|t| {
        let task = &tasks.0[t];
        let handed: std::result::Result<Vec<_>, _> = task.children.iter().map(|child| take(&rests[*child])).collect();
        let done = handed.and_then(|handed| {
            let mut workspace = lock(&workspaces).pop().unwrap_or_else(|| Workspace::new(analysis));
            let done = Run { analysis, matrix, kind, task }.numbers(keep, &handed, &mut workspace);
            lock(&workspaces).push(workspace);
            done
        });
        *lock(&rests[t]) = done.map(|(computed, rest)| {
            numbers[t].get_or_init(|| computed);
            rest
        });
    });
    let mut schur = matrix.border();
    let mut stop = None;
    for (t, task) in tasks.0.iter().enumerate().filter(|(_, task)| task.parent.is_none()) {
        match take(&rests[t]) {
            Ok(rest) => add_to_border(analysis, task, &rest, &mut schur),
            Err(found) => stop = Some(stop.map_or(found, |before: Stop| before.min(found))),
        }
    }
    for j in 0..schur.ncols() {
        for i in 0..j {
            schur[(i, j)] = schur[(j, i)];
        }
    }
    let tasks = numbers.into_iter().map(|numbers| numbers.into_inner().unwrap_or_default()).collect();
    stop.map_or(Ok(Numbers { tasks, schur }), Err)
}

/// The rest of a task, or why there is none.
type Handed = std::result::Result<Vec<f64>, Stop>;

pub(super) fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

fn take(rest: &Mutex<Handed>) -> Handed {
    std::mem::replace(&mut *lock(rest), Ok(Vec::new()))
}

/// Zeros, where there is memory for them.
fn zeros(len: usize) -> std::result::Result<Vec<f64>, Stop> {
    let mut values = Vec::new();
    values.try_reserve_exact(len).map_err(|_| Stop::NoMemory)?;
    values.resize(len, 0.0);
    Ok(values)
}

/// One task with all it needs to know.
struct Run<'a> {
    analysis: &'a Analysis,
    matrix: &'a Shifted<'a>,
    kind: Kind,
    task: &'a Task,
}

impl Run<'_> {
    /// The numbers of the task, and what it leaves to its parent.
    fn numbers(
        &self,
        keep: Keep,
        handed: &[Vec<f64>],
        workspace: &mut Workspace,
    ) -> std::result::Result<(TaskNumbers, Vec<f64>), Stop> {
        let n_steps = self.analysis.steps_of(self.task).len();
        let n_values = if keep == Keep::Factor { self.analysis.values_of(self.task).len() } else { 0 };
        let mut numbers = TaskNumbers {
            values: zeros(n_values)?,
            diagonal: zeros(n_steps)?,
            subdiagonal: zeros(n_steps)?,
            order: vec![0; n_steps],
        };
        let pivots = Pivots {
            diagonal: &mut numbers.diagonal,
            subdiagonal: &mut numbers.subdiagonal,
            order: &mut numbers.order,
        };
        let rest = self.eliminate(Part { values: &mut numbers.values, pivots }, handed, workspace)?;
        Ok((numbers, rest))
    }

    /// Eliminates the columns of the task; gives what it leaves to its parent.
    fn eliminate(
        &self,
        mut part: Part<'_>,
        handed: &[Vec<f64>],
        workspace: &mut Workspace,
    ) -> std::result::Result<Vec<f64>, Stop> {
        let Workspace { place, stack, tools } = workspace;
        stack.clear();
        let root = self.task.supernodes.end - 1;
        for s in self.task.supernodes.start..root {
            let node = self.analysis.supernode(s);
            let (children, rest) = stack.open(self.analysis, &node, node.below.len().pow(2))?;
            self.eliminate_supernode(&node, &children, (part.take(&node), rest), place, tools)?;
            stack.close(s, &node);
        }
        let node = self.analysis.supernode(root);
        let mut last = zeros(node.below.len().pow(2))?;
        // The children of a task's root lie on the stack, or each of them is a task's root itself.
        let (inside, _) = stack.open(self.analysis, &node, 0)?;
        let children = if self.task.children.is_empty() { inside } else { self.handed_over(handed) };
        self.eliminate_supernode(&node, &children, (part.take(&node), &mut last), place, tools)?;
        Ok(last)
    }

    /// Assembles and eliminates one front; `rest` is what its parent will take over.
    fn eliminate_supernode(
        &self,
        node: &Supernode<'_>,
        children: &[Rest<'_>],
        (mut part, rest): (Part<'_>, &mut [f64]),
        place: &mut [u32],
        tools: &mut Tools,
    ) -> std::result::Result<(), Stop> {
        let (size, b) = (node.steps.len(), node.below.len());
        let values = if part.values.is_empty() {
            tools.trapezoid.clear();
            tools.trapezoid.resize(node.values.len(), 0.0);
            tools.trapezoid.as_mut_slice()
        } else {
            part.values
        };
        let mut trapezoid = MatMut::from_column_major_slice_mut(values, size + b, size);
        for (at, row) in node.below.iter().enumerate() {
            place[*row as usize] = (size + at) as u32;
        }
        self.matrix.add_columns(self.analysis, node, place, trapezoid.as_mut());
        let places: Vec<Places> = children.iter().map(|child| Places::new(child.rows, node, place)).collect();
        for (child, places) in children.iter().zip(&places) {
            places.add_columns(child.values, trapezoid.as_mut());
        }
        eliminate_columns(self.kind, trapezoid.as_mut(), &mut part.pivots, &mut tools.dense)
            .map_err(|column| Stop::NotPositive(node.steps.start + column))?;
        let mut rest = MatMut::from_column_major_slice_mut(rest, b, b);
        outer_product(self.kind, trapezoid.as_ref().subrows(size, b), &part.pivots, rest.as_mut());
        for (child, places) in children.iter().zip(&places) {
            places.add_rest(child.values, rest.as_mut());
        }
        Ok(())
    }

    fn handed_over<'b>(&'b self, handed: &'b [Vec<f64>]) -> Vec<Rest<'b>> {
        let tasks = self.task.children.iter().map(|child| &self.analysis.tasks().0[*child]);
        tasks.zip(handed).map(|(task, values)| Rest { rows: self.analysis.outer_of(task), values }).collect()
    }
}

impl<'a> Part<'a> {
    /// Splits off the part of the next supernode.
    fn take(&mut self, node: &Supernode<'_>) -> Part<'a> {
        let n_values = if self.values.is_empty() { 0 } else { node.values.len() };
        let n_steps = node.steps.len();
        Part { values: split(&mut self.values, n_values), pivots: self.pivots.split_off(n_steps) }
    }
}

/// The first `n` of what is left.
fn split<'a, T>(left: &mut &'a mut [T], n: usize) -> &'a mut [T] {
    left.split_off_mut(..n).expect("the supernodes make up the factor")
}

/// Where the rows of a child lie in the front of its parent, by runs of neighbours.
struct Places {
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
    fn new(rows: &[u32], node: &Supernode<'_>, place: &[u32]) -> Self {
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
    fn add_columns(&self, child: &[f64], mut trapezoid: MatMut<'_, f64>) {
        self.add(child, 0..self.n_columns, 0, trapezoid.as_mut());
    }

    /// Adds the child's other entries to the parent's own rest.
    fn add_rest(&self, child: &[f64], mut rest: MatMut<'_, f64>) {
        self.add(child, self.n_columns..self.n_rows, self.size, rest.as_mut());
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
struct RestStack {
    values: Vec<f64>,
    /// Supernodes and where their rests begin.
    held: Vec<(usize, usize)>,
    top: usize,
}

impl RestStack {
    fn clear(&mut self) {
        self.held.clear();
        self.top = 0;
    }

    /// The rests of a supernode's children, and room for its own above them.
    fn open<'b>(
        &'b mut self,
        analysis: &'b Analysis,
        node: &Supernode<'_>,
        room: usize,
    ) -> std::result::Result<(Vec<Rest<'b>>, &'b mut [f64]), Stop> {
        if let Some(more) = (self.top + room).checked_sub(self.values.len()) {
            self.values.try_reserve(more).map_err(|_| Stop::NoMemory)?;
            self.values.resize(self.top + room, 0.0);
        }
        let (below, above) = self.values.split_at_mut(self.top);
        let below = &*below;
        let children = self.held[self.held.len().saturating_sub(node.n_children)..].iter().map(|(child, start)| {
            let rows = analysis.supernode(*child).below;
            Rest { rows, values: &below[*start..start + rows.len() * rows.len()] }
        });
        Ok((children.collect(), &mut above[..room]))
    }

    /// Puts the rest of supernode `s` in the place of its children's.
    fn close(&mut self, s: usize, node: &Supernode<'_>) {
        let room = node.below.len().pow(2);
        let first_child = self.held.len() - node.n_children;
        let bottom = self.held.get(first_child).map_or(self.top, |(_, start)| *start);
        self.values.copy_within(self.top..self.top + room, bottom);
        self.held.truncate(first_child);
        self.held.push((s, bottom));
        self.top = bottom + room;
    }
}

/// Adds what the last task of a tree leaves.
fn add_to_border(analysis: &Analysis, task: &Task, rest: &[f64], schur: &mut Mat<f64>) {
    let rows = analysis.outer_of(task);
    let row = |at: usize| rows[at] as usize - analysis.n();
    for j in 0..rows.len() {
        for i in j..rows.len() {
            schur[(row(i), row(j))] += rest[j * rows.len() + i];
        }
    }
}
