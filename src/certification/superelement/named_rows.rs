//! Reduced matrices that name their rows, in the order of the columns of the basis.
//!
//! DMIG and the text files of Abaqus say which node and direction a row is, and the columns of a basis have no names. A column that alone
//! moves a row of the model, by one, is that row. Rows that are no such column are amplitudes, and keep their order among themselves.

use faer::Mat;

use super::files::{ForeignSuperelement, ReducedMatrix};
use super::interface::Interface;
use crate::dofs::DofMap;
use crate::number::counted;

impl ForeignSuperelement {
    /// The superelement with its matrices in the order of its basis, and what is to be known of that where they name their rows.
    #[must_use]
    pub(super) fn in_order_of_basis(mut self, interface: &Interface) -> (Self, Option<String>) {
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
        (self, Some(note))
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

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use super::*;
    use crate::dofs::{Direction, Dof};

    #[test]
    fn rows_go_to_the_columns_of_their_names() {
        let dof = |node, direction| Dof { node, direction };
        let [ux, uy] = [Direction::Ux, Direction::Uy];
        let rows = vec![Some(dof(3, ux)), Some(dof(3, uy)), Some(dof(9, ux)), None, None];
        let of_columns = BTreeMap::from([(4, dof(3, ux)), (2, dof(9, ux)), (1, dof(7, ux))]);
        let interface = Interface { dofs: of_columns, ..Interface::default() };
        assert_eq!(order(&rows, &interface), (vec![1, 3, 2, 4, 0], 2));
    }
}
