//! Multifrontal elimination: one dense front for each supernode, taken over by its parent (Duff, Reid 1983).
//!
//! ```text
//! front of s   columns of the matrix + rests of the children
//! eliminated   columns of L, and a rest for the parent
//! ```
//! Inside a task the rests lie on a stack, the children's on top; between tasks they are handed over one by one. What reaches
//! the border is the Schur complement.

mod assembly;
mod recorded;

use std::sync::{Mutex, OnceLock};

use bytemuck::Zeroable;
use faer::dyn_stack::MemBuffer;
use faer::{Mat, MatMut};
use rayon::prelude::*;

use super::Analysis;
use super::analysis::{Supernode, Task};
use super::elimination::{self, Kind, PANEL, Pivots, add_products, eliminate_columns, outer_product};
use super::entry::Entry;
use super::matrix::Shifted;
use super::panels::{self, Panels, Shape};
use crate::heap::fallibly;
use crate::tally;
pub(super) use assembly::Stop;
use assembly::{Places, Rest, RestStack, rest_len};

/// What is kept of L.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Keep {
    /// Everything, for solves.
    Factor,
    /// The pivots alone, for counting.
    Pivots,
}

/// The numbers of a factor whose entries are kept as T.
#[derive(Debug)]
pub(super) struct Numbers<T> {
    /// The numbers of each task.
    tasks: Vec<TaskNumbers<T>>,
    /// What elimination left of the border, both triangles.
    pub(super) schur: Mat<f64>,
    /// A bound of the largest entry of |L||B||Lᵀ| of an indefinite matrix: the largest of its diagonal with the row sums of |B|
    /// on that of B, which bounds the off-diagonal entries too (Cauchy and Schwarz).
    pub(super) largest_product: f64,
}

/// The numbers that one task computes.
#[derive(Debug, Default)]
struct TaskNumbers<T> {
    /// Entries of L by supernodes; none where only the pivots are kept.
    values: Vec<T>,
    diagonal: Vec<f64>,
    subdiagonal: Vec<f64>,
    order: Vec<u32>,
    largest_product: f64,
}

/// The numbers of one supernode.
#[derive(Clone, Copy, Debug)]
pub(super) struct Eliminated<'a, T> {
    /// L_11 and L_21.
    pub(super) panels: Panels<'a, T>,
    /// Diagonal of B; of a definite matrix the squares of the diagonal of L.
    pub(super) diagonal: &'a [f64],
    /// Couplings of pivots of order two.
    pub(super) subdiagonal: &'a [f64],
    /// Column of its panel at each place.
    pub(super) order: &'a [u32],
}

impl<T: Entry> Numbers<T> {
    /// Supernode `s` of task `t`; the factor was kept.
    pub(super) fn supernode<'a>(&'a self, analysis: &Analysis, t: usize, s: usize) -> Eliminated<'a, T> {
        let (numbers, task) = (&self.tasks[t], &analysis.tasks().0[t]);
        let node = analysis.supernode(s);
        let (size, start) = (node.steps.len(), node.steps.start - analysis.steps_of(task).start);
        let first = node.values.start - analysis.values_of(task).start;
        let values = &numbers.values[first..first + node.values.len()];
        Eliminated {
            panels: Panels::new(Shape { rows: size + node.below.len(), size }, values),
            diagonal: &numbers.diagonal[start..start + size],
            subdiagonal: &numbers.subdiagonal[start..start + size],
            order: &numbers.order[start..start + size],
        }
    }

    /// All supernodes of a factor that was kept, in order of elimination.
    pub(super) fn supernodes<'a>(
        &'a self,
        analysis: &'a Analysis,
    ) -> impl Iterator<Item = (Supernode<'a>, Eliminated<'a, T>)> {
        analysis.tasks().0.iter().enumerate().flat_map(move |(t, task)| {
            task.supernodes.clone().map(move |s| (analysis.supernode(s), self.supernode(analysis, t, s)))
        })
    }

    /// Where each step of an indefinite factor comes among the pivots; the border stays where it is.
    pub(super) fn places_of_pivots(&self, analysis: &Analysis) -> Vec<usize> {
        let mut places: Vec<usize> = (0..analysis.step().len()).collect();
        for (node, numbers) in self.supernodes(analysis) {
            for (panel, order) in numbers.order.chunks(PANEL).enumerate() {
                let first = node.steps.start + panel * PANEL;
                for (place, column) in order.iter().enumerate() {
                    places[first + *column as usize] = first + place;
                }
            }
        }
        places
    }

    /// Diagonal and couplings of B, by steps.
    pub(super) fn pivots(&self) -> impl Iterator<Item = (f64, f64)> {
        self.tasks.iter().flat_map(|task| task.diagonal.iter().copied().zip(task.subdiagonal.iter().copied()))
    }
}

/// Where the next supernode of a factor goes.
struct Part<'a, T> {
    /// Room for the panels of those still to come; none where only the pivots are kept.
    values: Option<&'a mut [T]>,
    pivots: Pivots<'a>,
}

/// Memory that is used again for the next task.
struct Workspace {
    /// Row of the front at each step that is one of its rows.
    place: Vec<u32>,
    stack: RestStack,
    tools: Tools,
}

/// What the elimination of one supernode needs in addition to its front.
struct Tools {
    /// The trapezoid of the front.
    trapezoid: Vec<f64>,
    /// For the dense kernels.
    dense: MemBuffer,
}

impl Tools {
    /// Makes room for a trapezoid at once: memory that grows bit by bit is held twice each time.
    fn reserve(&mut self, len: usize) -> std::result::Result<(), Stop> {
        if len > self.trapezoid.len() {
            self.trapezoid = Vec::new();
            self.trapezoid = zeros(len)?;
        }
        Ok(())
    }
}

impl Workspace {
    fn new(analysis: &Analysis) -> Self {
        let tools = Tools { trapezoid: Vec::new(), dense: MemBuffer::new(elimination::scratch()) };
        Self { place: vec![0; analysis.step().len()], stack: RestStack::default(), tools }
    }
}

/// Eliminates all but the border of `matrix`.
pub(super) fn eliminate<T: Entry>(
    analysis: &Analysis,
    matrix: &Shifted<'_>,
    kind: Kind,
    keep: Keep,
) -> std::result::Result<Numbers<T>, Stop> {
    let tasks = analysis.tasks();
    let numbers: Vec<OnceLock<TaskNumbers<T>>> = tasks.0.iter().map(|_| OnceLock::new()).collect();
    let rests: Vec<Mutex<Handed>> = tasks.0.iter().map(|_| Mutex::new(Ok(Vec::new()))).collect();
    let workspaces = Mutex::new(Vec::new());
    tasks.leaves_first(|t| {
        let task = &tasks.0[t];
        let handed: Vec<Handed> = task.children.iter().map(|child| take(&rests[*child])).collect();
        let done = handed.into_iter().collect::<std::result::Result<Vec<_>, _>>().and_then(|handed| {
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
    let tasks: Vec<TaskNumbers<T>> =
        numbers.into_iter().map(|numbers| numbers.into_inner().unwrap_or_default()).collect();
    let largest_product = crate::dense::worst(tasks.iter().map(|task| task.largest_product));
    stop.map_or(Ok(Numbers { tasks, schur, largest_product }), Err)
}

/// The rest of a task, or why there is none.
type Handed = std::result::Result<Vec<f64>, Stop>;

pub(super) fn lock<T>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(std::sync::PoisonError::into_inner)
}

fn take(rest: &Mutex<Handed>) -> Handed {
    std::mem::replace(&mut *lock(rest), Ok(Vec::new()))
}

/// Zeros, where there is memory for them. Fresh memory is zero as the system hands it out, page by page to the thread that
/// touches it first: several of them, where a supernode is large.
fn zeros<T: Zeroable>(len: usize) -> std::result::Result<Vec<T>, Stop> {
    fallibly(|| bytemuck::allocation::try_zeroed_vec(len)).map_err(|()| Stop::NoMemory)
}

/// Writes zeros, by several threads into what several will work on.
fn clear(values: &mut [f64]) {
    const CHUNK: usize = 1 << 16;
    if values.len() > panels::PARALLEL_ABOVE {
        values.par_chunks_mut(CHUNK).for_each(|chunk| chunk.fill(0.0));
    } else {
        values.fill(0.0);
    }
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
    fn numbers<T: Entry>(
        &self,
        keep: Keep,
        handed: &[Vec<f64>],
        workspace: &mut Workspace,
    ) -> std::result::Result<(TaskNumbers<T>, Vec<f64>), Stop> {
        let n_steps = self.analysis.steps_of(self.task).len();
        let n_values = if keep == Keep::Factor { self.analysis.values_of(self.task).len() } else { 0 };
        let mut numbers = TaskNumbers {
            values: zeros(n_values)?,
            diagonal: zeros(n_steps)?,
            subdiagonal: zeros(n_steps)?,
            order: zeros(n_steps)?,
            largest_product: 0.0,
        };
        let pivots = Pivots {
            diagonal: &mut numbers.diagonal,
            subdiagonal: &mut numbers.subdiagonal,
            order: &mut numbers.order,
        };
        let part = Part { values: (keep == Keep::Factor).then_some(&mut numbers.values[..]), pivots };
        let (rest, largest_product) = self.eliminate(part, handed, workspace)?;
        numbers.largest_product = largest_product;
        Ok((numbers, rest))
    }

    /// Eliminates the columns of the task; gives what it leaves to its parent, and the largest product.
    fn eliminate<T: Entry>(
        &self,
        mut part: Part<'_, T>,
        handed: &[Vec<f64>],
        workspace: &mut Workspace,
    ) -> std::result::Result<(Vec<f64>, f64), Stop> {
        let mut largest = 0.0;
        let Workspace { place, stack, tools } = workspace;
        stack.clear();
        let largest_front = self.task.supernodes.clone().map(|s| self.analysis.supernode(s).n_trapezoid()).max();
        tools.reserve(largest_front.unwrap_or(0))?;
        let root = self.task.supernodes.end - 1;
        for s in self.task.supernodes.start..root {
            let node = self.analysis.supernode(s);
            let (children, rest) = stack.open(self.analysis, &node, rest_len(node.below.len()))?;
            let product = self.eliminate_supernode(&node, &children, (part.take(&node), rest), place, tools)?;
            largest = crate::dense::worst([largest, product]);
            stack.close(s, &node);
        }
        let node = self.analysis.supernode(root);
        let mut last = zeros(rest_len(node.below.len()))?;
        // The children of a task's root lie on the stack, or each of them is a task's root itself.
        let (inside, _) = stack.open(self.analysis, &node, 0)?;
        let children = if self.task.children.is_empty() { inside } else { self.handed_over(handed) };
        let product = self.eliminate_supernode(&node, &children, (part.take(&node), &mut last), place, tools)?;
        Ok((last, crate::dense::worst([largest, product])))
    }

    /// Assembles and eliminates one front; `rest` is what its parent will take over. Gives the largest product of its rows.
    fn eliminate_supernode<T: Entry>(
        &self,
        node: &Supernode<'_>,
        children: &[Rest<'_>],
        (mut part, rest): (Part<'_, T>, &mut [f64]),
        place: &mut [u32],
        tools: &mut Tools,
    ) -> std::result::Result<f64, Stop> {
        let (size, b) = (node.steps.len(), node.below.len());
        let values = &mut tools.trapezoid[..node.n_trapezoid()];
        clear(values);
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
        let (rest, products_left) = rest.split_at_mut(b * b);
        let mut rest = MatMut::from_column_major_slice_mut(rest, b, b);
        outer_product(self.kind, trapezoid.as_ref().subrows(size, b), &part.pivots, rest.as_mut());
        for (child, places) in children.iter().zip(&places) {
            places.add_rest(child.values, rest.as_mut());
        }
        if let Some(values) = part.values {
            panels::pack(trapezoid.as_ref(), values);
        }
        tally::eliminated(node.flops());
        if self.kind == Kind::Definite {
            return Ok(0.0);
        }
        let mut products = vec![0.0; size + b];
        for (child, places) in children.iter().zip(&places) {
            places.add_products(child.values, &mut products);
        }
        add_products(trapezoid.as_ref(), &part.pivots, &mut products);
        products_left.copy_from_slice(&products[size..]);
        Ok(crate::dense::worst(products[..size].iter().copied()))
    }

    fn handed_over<'b>(&'b self, handed: &'b [Vec<f64>]) -> Vec<Rest<'b>> {
        let tasks = self.task.children.iter().map(|child| &self.analysis.tasks().0[*child]);
        tasks.zip(handed).map(|(task, values)| Rest { rows: self.analysis.outer_of(task), values }).collect()
    }
}

impl<'a, T> Part<'a, T> {
    /// The part of the next supernode.
    fn take(&mut self, node: &Supernode<'_>) -> Part<'a, T> {
        let values = self.values.as_mut();
        let values = values.map(|left| left.split_off_mut(..node.values.len()).expect("room for the whole task"));
        Part { values, pivots: self.pivots.split_off(node.steps.len()) }
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
