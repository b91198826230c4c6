//! Reduced matrices that name their rows, in the order of the columns of the basis.
//!
//! DMIG and the text files of Abaqus say which node and direction a row is, and the columns of a basis have no names. A column that alone
//! moves a row of the model, by one, is that row. Rows that are no such column are amplitudes, and keep their order among themselves.

use faer::Mat;

use super::files::{ForeignSuperelement, ReducedMatrix};
use super::interface::Interface;
use crate::dofs::{Dof, DofMap};
use crate::number::counted;
use crate::verification::check::{Check, Limits};

impl ForeignSuperelement {
    /// The superelement with its matrices in the order of its basis; and where they name their rows, what is to be known of that and whether
    /// the names are those of the columns. `is_of_model` tells the dofs of the model.
    #[must_use]
    pub(super) fn in_order_of_basis(
        mut self,
        interface: &Interface,
        is_of_model: impl Fn(&Dof) -> bool,
    ) -> (Self, Option<(String, Check)>) {
        let Some(dofs) = self.dofs.take() else { return (self, None) };
        let (order, n_named) = order(&dofs, interface);
        [&mut self.stiffness, &mut self.mass].into_iter().for_each(|matrix| matrix.reorder(&order));
        let note = match n_named {
            0 => "K̂ and M̂ name their rows, and no column of the basis is one of these: their rows are taken in the order of nodes and \
                  directions"
                .to_owned(),
            n => {
                let rows = counted(n, "row", "rows");
                format!("{rows} of K̂ and M̂ were put to the columns of the basis by node and direction, the others behind each other")
            }
        };
        (self, Some((note, names(&dofs, interface, is_of_model))))
    }
}

impl ReducedMatrix {
    fn reorder(&mut self, order: &[usize]) {
        let r = order.len();
        [&mut self.values, &mut self.sizes]
            .into_iter()
            .for_each(|matrix| *matrix = Mat::from_fn(r, r, |i, j| matrix[(order[i], order[j])]));
    }
}

/// For each column of the basis the row of the matrices, and how many of these have the name of the column.
fn order(dofs: &DofMap, interface: &Interface) -> (Vec<usize>, usize) {
    let named = |column: usize| {
        let own = interface.dofs.get(&column)?;
        dofs.iter().position(|dof| dof.as_ref() == Some(own))
    };
    let of_column: Vec<Option<usize>> = (0..dofs.len()).map(named).collect();
    let n_named = of_column.iter().flatten().count();
    let mut others = (0..dofs.len()).filter(|row| !of_column.contains(&Some(*row)));
    // As many rows are left as columns: the matrices have a row for each column.
    let order = of_column.iter().map(|row| row.or_else(|| others.next()).unwrap_or_default()).collect();
    (order, n_named)
}

/// C-13: columns that move a node and direction which no row has the name of, where rows have names that no column has. Whoever joins the
/// superelement by these joins other nodes. A name of another dof of the model fails; one that the model has not may be a number of its own.
fn names(dofs: &DofMap, interface: &Interface, is_of_model: impl Fn(&Dof) -> bool) -> Check {
    let columns: Vec<&Dof> = interface.dofs.values().collect();
    let rows: Vec<&Dof> = dofs.iter().flatten().collect();
    let lacking: Vec<&Dof> = columns.iter().copied().filter(|column| !rows.contains(column)).collect();
    let others: Vec<&Dof> = rows.iter().copied().filter(|row| !columns.contains(row)).collect();
    let wrong = others.iter().copied().find(|other| is_of_model(other));
    let first = lacking.first().zip(wrong.or(others.first().copied()));
    Check {
        id: "C-13",
        name: "rows are named as their columns move",
        equation: "columns whose node and direction no row of K̂ and M̂ is named by",
        value: lacking.len().min(others.len()) as f64,
        limits: Limits::default(),
        fail_above: if wrong.is_some() { 0.0 } else { Check::NEVER },
        worst: first
            .map(|(column, other)| format!("no row is named {column}, and no column moves {other}, as a row is named")),
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::dofs::Direction;
    use crate::verification::check::Verdict;

    #[test]
    fn rows_go_to_the_columns_of_their_names() {
        let dof = |node, direction| Dof { node, direction };
        let [ux, uy] = [Direction::Ux, Direction::Uy];
        let rows = vec![Some(dof(3, ux)), Some(dof(3, uy)), Some(dof(9, ux)), None, None];
        let of_columns = BTreeMap::from([(4, dof(3, ux)), (2, dof(9, ux)), (1, dof(7, ux))]);
        let interface = Interface { dofs: of_columns, ..Interface::default() };
        assert_eq!(order(&rows, &interface), (vec![1, 3, 2, 4, 0], 2));
    }

    #[test]
    fn names_of_other_nodes_fail_and_numbers_of_their_own_are_told() {
        let dof = |node| Dof { node, direction: Direction::Ux };
        let interface = Interface { dofs: BTreeMap::from([(0, dof(1)), (1, dof(2))]), ..Interface::default() };
        let is_of_model = |dof: &Dof| dof.node < 10;
        let verdict = |nodes: [Option<i64>; 3]| {
            let check = names(&nodes.map(|node| node.map(dof)).to_vec(), &interface, is_of_model);
            (check.verdict(), check.value)
        };
        assert_eq!(verdict([Some(1), Some(2), Some(901)]), (Verdict::Pass, 0.0), "an amplitude with a number");
        assert_eq!(verdict([None, Some(2), None]), (Verdict::Pass, 0.0), "no names, no contradiction");
        assert_eq!(verdict([Some(901), Some(2), None]), (Verdict::Warn, 1.0));
        assert_eq!(verdict([Some(3), Some(2), None]), (Verdict::Fail, 1.0));
        assert_eq!(verdict([Some(901), Some(3), None]), (Verdict::Fail, 2.0));
    }
}
