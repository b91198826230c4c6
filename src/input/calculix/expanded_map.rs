//! The node that each row of a dof map stands for, where several were made of one.

use std::collections::BTreeMap;
use std::ops::Range;

use super::expansion::Expansion;
use crate::dofs::{Dof, DofMap};

/// A dof map in which every row has the node that CalculiX made.
#[derive(Debug)]
pub(super) struct ExpandedMap {
    pub(super) dofs: DofMap,
    /// Labels whose rows could be those of several nodes that were made of them: supports have taken rows out.
    pub(super) unsure: Vec<i64>,
}

/// Replaces labels that repeat by those of the nodes that were made of them; none where there are more rows than nodes.
///
/// Rows come in the order of the labels that CalculiX uses inside: first those of nodes in the deck, then those of nodes that were made,
/// in the order of the nodes of which they were made. Rows of one node have ascending directions.
pub(super) fn expanded_map(dofs: &[Option<Dof>], expansion: &Expansion) -> Option<ExpandedMap> {
    let runs = runs(dofs);
    let mut of_label: BTreeMap<i64, Vec<usize>> = BTreeMap::new();
    for (at, (label, _)) in runs.iter().enumerate() {
        of_label.entry(*label).or_default().push(at);
    }
    let mut map = dofs.to_vec();
    let mut unsure = Vec::new();
    for (label, at) in of_label {
        let Some(made) = expansion.made_of.get(&label) else { continue };
        // A node of the deck keeps rows where a load or a constraint is on it. Its run stands away from those of the nodes made of it.
        let is_apart = at.len() > made.len() || at.windows(2).next().is_some_and(|pair| pair[1] > pair[0] + 1);
        let of_made = if is_apart { &at[1..] } else { &at[..] };
        if of_made.len() > made.len() {
            return None;
        }
        if of_made.len() < made.len() {
            unsure.push(label);
        }
        for (run, node) in of_made.iter().zip(made) {
            for row in runs[*run].1.clone() {
                map[row] = map[row].map(|dof| Dof { node: *node, ..dof });
            }
        }
    }
    Some(ExpandedMap { dofs: map, unsure })
}

/// The rows of each node, as far as labels and directions tell.
fn runs(dofs: &[Option<Dof>]) -> Vec<(i64, Range<usize>)> {
    let mut runs: Vec<(i64, Range<usize>)> = Vec::new();
    let mut last: Option<Dof> = None;
    for (row, dof) in dofs.iter().enumerate() {
        let Some(dof) = *dof else {
            last = None;
            continue;
        };
        match runs.last_mut() {
            Some((_, rows)) if last.is_some_and(|last| last.node == dof.node && last.direction < dof.direction) => {
                rows.end = row + 1;
            }
            _ => runs.push((dof.node, row..row + 1)),
        }
        last = Some(dof);
    }
    runs
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dofs::Direction;

    fn map(rows: &[(i64, usize)]) -> Vec<Option<Dof>> {
        rows.iter().map(|(node, at)| Some(Dof { node: *node, direction: Direction::ALL[*at - 1] })).collect()
    }

    fn expansion(of: &[(i64, &[i64])]) -> Expansion {
        let made_of = of.iter().map(|(label, made)| (*label, made.iter().copied().collect())).collect();
        Expansion { made_of, n_incompatible: 0 }
    }

    /// Node 15 has a row of its own, node 1 lost rows to a support, and nodes 3 are solid.
    #[test]
    fn rows_in_the_order_that_calculix_writes() {
        let dofs = map(&[(3, 1), (3, 2), (15, 3), (1, 3), (15, 1), (15, 2), (15, 1), (15, 2), (15, 3)]);
        let made = expansion(&[(1, &[22, 23]), (15, &[24, 26])]);
        let found = expanded_map(&dofs, &made).expect("a map");
        let nodes: Vec<i64> = found.dofs.iter().flatten().map(|dof| dof.node).collect();
        assert_eq!(nodes, [3, 3, 15, 22, 24, 24, 26, 26, 26]);
        assert_eq!(found.unsure, [1]);
        assert!(expanded_map(&dofs, &expansion(&[(15, &[24])])).is_none(), "more rows than nodes");
    }
}
