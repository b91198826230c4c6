//! The connected parts of the interior once the interface is taken out: K_II and M_II have a block for each.

use super::metis::Graph;
use super::transformation::Transformation;
use super::transformation_row::TransformationRow;
use crate::model::Model;

/// Groups of internal dofs with the part that each belongs to.
pub(super) struct Parts {
    /// Number of the part of each group, in the order in which parts appear.
    pub(super) of_group: Vec<u32>,
    /// How many there are.
    pub(super) count: usize,
}

impl Parts {
    /// The parts of a graph of groups, and of what rows that follow several dofs couple in addition; `group_of` is that of a dof.
    pub(super) fn of(
        graph: &Graph,
        (model, transformation): (&Model, &Transformation),
        group_of: impl Fn(u32) -> Option<u32>,
    ) -> Self {
        let mut sets = Sets { above: (0..graph.weights.len() as u32).collect() };
        for (group, ends) in graph.starts.windows(2).enumerate() {
            for other in &graph.neighbours[ends[0] as usize..ends[1] as usize] {
                sets.join(group as u32, *other as u32);
            }
        }
        let first_of = |row: usize| transformation.rows[row].entries().find_map(|(dof, _)| group_of(dof));
        for (row, of_row) in transformation.rows.iter().enumerate() {
            let TransformationRow::Tied(entries) = of_row else { continue };
            let Some(first) = first_of(row) else { continue };
            entries.iter().filter_map(|(dof, _)| group_of(*dof)).for_each(|group| sets.join(first, group));
            for matrix in [&model.stiffness, &model.mass] {
                let columns = matrix.outer_view(row).map_or(&[][..], |row| row.into_raw_storage().0);
                columns.iter().filter_map(|col| first_of(*col as usize)).for_each(|group| sets.join(first, group));
            }
        }
        sets.numbered()
    }
}

/// Disjoint sets of numbers, each with a tree towards its least one.
struct Sets {
    above: Vec<u32>,
}

impl Sets {
    fn root(&mut self, mut at: u32) -> u32 {
        while self.above[at as usize] != at {
            let up = self.above[at as usize];
            self.above[at as usize] = self.above[up as usize];
            at = up;
        }
        at
    }

    fn join(&mut self, a: u32, b: u32) {
        let (a, b) = (self.root(a), self.root(b));
        self.above[a.max(b) as usize] = a.min(b);
    }

    fn numbered(mut self) -> Parts {
        let n = self.above.len();
        let (mut of_group, mut count) = (vec![0u32; n], 0);
        for at in 0..n as u32 {
            let root = self.root(at);
            of_group[at as usize] = match root == at {
                true => {
                    count += 1;
                    count - 1
                }
                // Roots are the least of their sets, numbered before.
                false => of_group[root as usize],
            };
        }
        Parts { of_group, count: count as usize }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sets_are_numbered_in_the_order_of_their_least_members() {
        let mut sets = Sets { above: (0..7).collect() };
        [(6, 2), (5, 1), (4, 6), (3, 3)].into_iter().for_each(|(a, b)| sets.join(a, b));
        let Parts { of_group, count } = sets.numbered();
        assert_eq!((of_group, count), (vec![0, 1, 2, 3, 2, 1, 2], 4));
    }
}
