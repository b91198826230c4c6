//! Whether K and M have their rows in one order: the mass of an element couples the nodes that its stiffness couples.
//!
//! Springs, ties and lumped masses couple in K what M does not, and the added mass of a fluid or a mass element of several nodes couples in
//! M what K does not. In another order M does both, at nearly every node, which is [`super::apart`]. Of 33 sound pairs of real programs
//! none has a node apart where a dof map tells the nodes. By rows alone two have, a seventh and a tenth of their rows. With nodes of M
//! permuted all nodes are apart but for a few, and most of them with rows direction by direction.
//!
//! An order changes no count: the mass of the elements couples as many pairs of nodes as their stiffness. Where M couples fewer, a
//! lumped mass with that of a fluid between pairs of nodes for instance, other neighbours are no sign of an order.
//!
//! A mass that couples no rotation with another node, where K does, is none of the elements of beams and shells: it is lumped, and what it
//! couples was added, between the tubes of a bundle in a fluid for instance. As many tubes as nodes along each are the mesh in another
//! order, as far as pairs tell. Nothing of that is proof, and it is a warning.
//!
//! A diagonal mass couples nothing, and no order of it contradicts K here.

use super::apart::Apart;
use super::couplings::{Couplings, bits_of_rows};
use crate::dofs::RowNames;
use crate::error::{Error, Result};
use crate::model::finding::Finding;

/// Pairs of nodes that M couples, of those that K couples, from which on M is taken for the mass of the elements.
const LEAST_SHARE_OF_PAIRS: f64 = 0.75;
/// Pairs of rows likewise: the mass of a solid couples a row with one of three rows of a node, its stiffness with all three.
const LEAST_SHARE_OF_ROWS: f64 = LEAST_SHARE_OF_PAIRS / 3.0;

/// Nodes that a warning names.
const SHOWN_NODES: usize = 3;
/// Directions that are rotations.
const ROTATIONS: u8 = 0b11_1000;

/// Compares the nodes that M couples with those that K couples.
///
/// # Errors
/// [`Error::MassInAnotherOrder`] where more than half of all nodes are apart, or where M is that of the mesh in another order. Fewer are a
/// finding, and so are those of an added mass, where a dof map tells nodes; of rows alone K and M of one element may couple different ones.
pub(super) fn compared([stiffness, mass]: [&Couplings; 2], names: RowNames<'_>) -> Result<Option<Finding>> {
    let has_nodes = names.dofs.is_some();
    let (what, least_share) = if has_nodes { ("nodes", LEAST_SHARE_OF_PAIRS) } else { ("rows", LEAST_SHARE_OF_ROWS) };
    let n_nodes = mass.n_nodes();
    let Apart { nodes, moved, n_pairs: [of_mass, of_stiffness], .. } =
        Apart::of(n_nodes, |node| mass.others(node).collect(), |node| stiffness.others(node).collect());
    if (of_mass as f64) < least_share * of_stiffness as f64 {
        return Ok(None);
    }
    // The counts of rows alone prove nothing.
    let is_moved = has_nodes && !moved.is_empty();
    let name_of = |node: &u32| mass.rows(*node).next().map(|row| names.full(row));
    let proof = if is_moved { &moved } else { &nodes };
    let Some(first) = proof.first().and_then(name_of) else { return Ok(None) };
    let turns = |matrix: &Couplings| matrix.is_any_by(bits_of_rows(ROTATIONS));
    let is_of_elements = || !has_nodes || !turns(stiffness) || turns(mass);
    if (2 * nodes.len() > n_nodes || is_moved) && is_of_elements() {
        return Err(Error::MassInAnotherOrder { n_apart: proof.len(), n_nodes, what, first });
    }
    let at = proof.iter().take(SHOWN_NODES).filter_map(name_of).collect::<Vec<_>>().join(", ");
    Ok(has_nodes.then_some(Finding::MassCouplesOthers { n_apart: proof.len(), n_nodes, at }))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dofs::{Direction, Dof, FileRows};
    use crate::sparse::SparseMatrix;

    const N: usize = 8;

    /// Couplings of a matrix of eight rows, each that of a node.
    fn couplings(pairs: &[(usize, usize)], dofs: &[Option<Dof>]) -> Couplings {
        let (mut pointers, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
        for row in 0..N {
            let is_coupled = |col: &usize| *col == row || pairs.contains(&(row, *col)) || pairs.contains(&(*col, row));
            columns.extend((0..N).filter(is_coupled).map(|col| col as u32));
            values.resize(columns.len(), 1.0);
            pointers.push(columns.len());
        }
        let nodes: Vec<u32> = (0..N as u32).collect();
        Couplings::of(&SparseMatrix::new((N, N), pointers, columns, values), &nodes, Some(dofs))
    }

    /// The mass of a fluid between pairs of nodes that are no neighbours couples fewer than the elements do.
    #[test]
    fn a_mass_of_few_pairs_is_sound() {
        let dofs: Vec<Option<Dof>> = (0..N as i64).map(|node| Some(Dof { node, direction: Direction::Ux })).collect();
        let (rows, line) = (FileRows::default(), (1..N).map(|i| (i - 1, i)).collect::<Vec<_>>());
        let names = RowNames { rows: &rows, dofs: Some(&dofs) };
        let natural = couplings(&line, &dofs);
        let of_fluid = couplings(&[(0, 4), (1, 5), (2, 6), (3, 7)], &dofs);
        assert!(matches!(compared([&natural, &of_fluid], names), Ok(None)));
        let another = couplings(&[(0, 4), (4, 1), (1, 5), (5, 2), (2, 6), (6, 3), (3, 7)], &dofs);
        assert!(matches!(compared([&natural, &another], names), Err(Error::MassInAnotherOrder { .. })));
    }
}
