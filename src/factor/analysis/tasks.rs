//! Tasks: subtrees small enough for one thread, and single supernodes above them.
//!
//! The cut depends on the work alone, never on the number of threads, and whatever a task takes over from its children it
//! takes in their order: the same bits for any number of threads.

use std::ops::Range;
use std::sync::atomic::{AtomicUsize, Ordering};

use super::order::NONE;
use super::supernodes::Supernodes;

/// Parts of the whole work that the largest subtree done by one thread may make up: enough to keep 16 threads busy.
const PARTS: f64 = 64.0;
/// Operations below which a subtree is not worth a task: a tenth of a millisecond.
const SMALLEST: f64 = 2e6;

/// Supernodes that one thread eliminates one after the other.
#[derive(Clone, Debug)]
pub(in crate::factor) struct Task {
    /// Its supernodes; the last one is the root of all others that reach beyond the task.
    pub(in crate::factor) supernodes: Range<usize>,
    /// The task that takes over what is left for later columns; none where only the border is left.
    pub(in crate::factor) parent: Option<usize>,
    /// Tasks that it takes over from.
    pub(in crate::factor) children: Vec<usize>,
    /// Where the parent keeps each later step that the task reaches.
    pub(in crate::factor) to_parent: Vec<u32>,
}

/// All tasks, children before parents.
#[derive(Clone, Debug, Default)]
pub(in crate::factor) struct Tasks(pub(in crate::factor) Vec<Task>);

impl Tasks {
    /// Cuts the forest; `flops` is the work of each supernode.
    pub(super) fn new(supernodes: &Supernodes, flops: &[f64]) -> Self {
        let n = flops.len();
        let mut below = flops.to_vec();
        let mut first_of_subtree: Vec<usize> = (0..n).collect();
        for s in 0..n {
            if supernodes.parent[s] != NONE {
                let up = supernodes.parent[s] as usize;
                below[up] += below[s];
                first_of_subtree[up] = first_of_subtree[up].min(first_of_subtree[s]);
            }
        }
        let largest = (flops.iter().sum::<f64>() / PARTS).max(SMALLEST);
        let is_whole = |s: usize| below[s] <= largest;
        let mut tasks: Vec<Task> = Vec::new();
        let mut task_of = vec![NONE; n];
        // Subtrees that reach nothing beyond them, not even the border, may share a task.
        let is_island = |s: usize| supernodes.parent[s] == NONE && supernodes.n_below[s] == 0;
        let (mut start_of_islands, mut work_of_islands) = (None, 0.0);
        for s in 0..n {
            let up = supernodes.parent[s];
            if is_whole(s) && up != NONE && is_whole(up as usize) {
                continue;
            }
            let mut start = if is_whole(s) { first_of_subtree[s] } else { s };
            if is_whole(s) && is_island(s) {
                start = *start_of_islands.get_or_insert(start);
                work_of_islands += below[s];
                let follows = (s + 1..n).find(|next| !(is_whole(*next) && supernodes.parent[*next] != NONE));
                if work_of_islands < SMALLEST && follows.is_some_and(|next| is_whole(next) && is_island(next)) {
                    continue;
                }
            }
            (start_of_islands, work_of_islands) = (None, 0.0);
            task_of[s] = tasks.len() as u32;
            tasks.push(Task { supernodes: start..s + 1, parent: None, children: Vec::new(), to_parent: Vec::new() });
        }
        for t in 0..tasks.len() {
            let root = tasks[t].supernodes.end - 1;
            if supernodes.parent[root] != NONE {
                // The parent of a task's root is never inside a larger whole subtree, so it has a task of its own.
                let up = task_of[supernodes.parent[root] as usize] as usize;
                tasks[t].parent = Some(up);
                tasks[up].children.push(t);
            }
        }
        Self(tasks)
    }

    /// Runs every task after its children, side by side where there are threads.
    pub(in crate::factor) fn leaves_first(&self, work: impl Fn(usize) + Sync) {
        if rayon::current_num_threads() == 1 {
            return (0..self.0.len()).for_each(work);
        }
        let waiting: Vec<AtomicUsize> = self.0.iter().map(|task| AtomicUsize::new(task.children.len())).collect();
        let (waiting, work) = (&waiting, &work);
        let climb = move |leaf: usize| {
            let mut at = leaf;
            loop {
                work(at);
                match self.0[at].parent {
                    Some(up) if waiting[up].fetch_sub(1, Ordering::AcqRel) == 1 => at = up,
                    _ => break,
                }
            }
        };
        rayon::scope(|scope| {
            // A thread takes what was spawned last, another steals what was spawned first: they start at both ends.
            for leaf in (0..self.0.len()).rev().filter(|t| self.0[*t].children.is_empty()) {
                scope.spawn(move |_| climb(leaf));
            }
        });
    }

    /// Runs every task after its parent, side by side where there are threads.
    pub(in crate::factor) fn roots_first(&self, work: impl Fn(usize) + Sync) {
        if rayon::current_num_threads() == 1 {
            return (0..self.0.len()).rev().for_each(work);
        }
        let work = &work;
        rayon::scope(|scope| {
            for root in (0..self.0.len()).filter(|t| self.0[*t].parent.is_none()) {
                scope.spawn(move |scope| self.descend(scope, root, work));
            }
        });
    }

    fn descend<'s>(&'s self, scope: &rayon::Scope<'s>, at: usize, work: &'s (impl Fn(usize) + Sync)) {
        work(at);
        for child in &self.0[at].children {
            scope.spawn(move |scope| self.descend(scope, *child, work));
        }
    }
}
