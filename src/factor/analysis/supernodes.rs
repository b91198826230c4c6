//! Supernodes: runs of columns with one pattern, joined where the zeros that joining stores cost less than what it saves.

use super::order::{EliminationTree, NONE};

/// Consecutive columns that are eliminated together, all in postorder.
#[derive(Clone, Debug)]
pub(super) struct Supernodes {
    /// First step of each supernode, and the number of steps.
    pub(super) first: Vec<usize>,
    /// Parent of each supernode, [`NONE`] for a root.
    pub(super) parent: Vec<u32>,
    /// Rows below the triangle.
    pub(super) n_below: Vec<usize>,
}

/// A supernode while it grows.
struct Group {
    first: usize,
    size: usize,
    below: usize,
    /// Entries that are not zeros put in by joining.
    entries: usize,
}

impl Group {
    fn stored(size: usize, below: usize) -> usize {
        size * (size + 1) / 2 + size * below
    }
}

/// Up to so many columns a join may store this share of zeros (Chen, Davis, Hager, Rajamanickam 2008). More zeros make larger
/// fronts, which gained no time on a solid of 123,486 dofs and cost a tenth of its memory.
const ALLOWED_ZEROS: [(usize, f64); 4] = [(6, 0.8), (16, 0.3), (48, 0.1), (usize::MAX, 0.02)];

impl Supernodes {
    pub(super) fn new(tree: &EliminationTree) -> Self {
        let mut groups: Vec<Group> = Vec::new();
        for group in columns_of_one_pattern(tree) {
            groups.push(group);
            // The child just before a supernode is the one that it can take in without moving columns.
            while let [.., child, parent] = groups.as_slice()
                && tree.parent[parent.first - 1] as usize >= parent.first
                && (tree.parent[parent.first - 1] as usize) < parent.first + parent.size
                && let Some(joined) = joined(child, parent)
            {
                groups.pop();
                groups.pop();
                groups.push(joined);
            }
        }
        let mut first: Vec<usize> = groups.iter().map(|group| group.first).collect();
        first.push(tree.parent.len());
        let mut of_step = vec![0u32; tree.parent.len()];
        for (s, range) in first.windows(2).enumerate() {
            of_step[range[0]..range[1]].fill(s as u32);
        }
        let parent_of = |s: usize| match tree.parent[first[s + 1] - 1] {
            NONE => NONE,
            up => of_step[up as usize],
        };
        Self {
            parent: (0..groups.len()).map(parent_of).collect(),
            n_below: groups.iter().map(|group| group.below).collect(),
            first,
        }
    }
}

/// Runs of columns in which each column has the pattern of the one before it without its diagonal.
fn columns_of_one_pattern(tree: &EliminationTree) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    for (step, count) in tree.counts.iter().enumerate() {
        let count = *count as usize;
        let continues =
            step > 0 && tree.parent[step - 1] as usize == step && tree.counts[step - 1] as usize == count + 1;
        match groups.last_mut() {
            Some(group) if continues => group.size += 1,
            _ => groups.push(Group { first: step, size: 1, below: 0, entries: 0 }),
        }
        let group = groups.last_mut().expect("a group was just made");
        group.below = count - 1;
        group.entries = Group::stored(group.size, group.below);
    }
    groups
}

/// Both in one, if that is worth its zeros. All rows of the child lie in the parent's columns and rows.
fn joined(child: &Group, parent: &Group) -> Option<Group> {
    let size = child.size + parent.size;
    let entries = child.entries + parent.entries;
    let stored = Group::stored(size, parent.below);
    let zeros = (stored - entries) as f64 / stored as f64;
    let is_worth_it = ALLOWED_ZEROS.iter().any(|(columns, allowed)| size <= *columns && zeros <= *allowed);
    is_worth_it.then_some(Group { first: child.first, size, below: parent.below, entries })
}
