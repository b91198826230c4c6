//! Rigid coupling: a patch of nodes moves with one node of six degrees of freedom as a rigid body.

use super::axes;
use super::elimination::{Terms, summed};
use super::interface_node::{InterfaceNode, Resolved, Rows};
use super::node_catalogue::NodeCatalogue;
use super::placement;
use super::sites::Sites;
use super::transformation_row::TransformationRow;
use crate::dense::rank_of_rows;
use crate::dofs::Direction;
use crate::error::{Error, Result};
use crate::job::InterfaceJob;

/// Smallest singular value of a patch's levers, relative to the largest and with rotations scaled to the patch's size,
/// below which the patch cannot move in six independent ways: far above rounding, far below any real patch.
const PATCH_RANK_TOLERANCE: f64 = 1e-8;

/// The node of a rigid patch with all rows of its nodes.
pub(super) fn node(catalogue: &NodeCatalogue, job: &InterfaceJob, labels: &[i64]) -> Result<Resolved> {
    let selector = job.selection().selector;
    let mut rows = Vec::new();
    for label in labels {
        rows.extend(catalogue.rows_of(&selector, *label)?.values());
    }
    Ok(Resolved::new(interface_node(catalogue, job, labels)?, Rows::Patch(rows)))
}

/// The node of a patch without its rows, at the place that the job asks for.
pub(super) fn interface_node(catalogue: &NodeCatalogue, job: &InterfaceJob, labels: &[i64]) -> Result<InterfaceNode> {
    let point = |label: &i64| {
        catalogue.position(*label).ok_or_else(|| Error::RigidNeedsCoordinates { interface: job.name.clone() })
    };
    let points = labels.iter().map(point).collect::<Result<Vec<[f64; 3]>>>()?;
    let (position, fit) = placement::place(job, &points)?;
    let mut directions = job.dofs.clone().unwrap_or_else(|| Direction::ALL.to_vec());
    directions.sort_unstable();
    Ok(InterfaceNode {
        name: job.name.clone(),
        label: None,
        position: Some(position),
        fit,
        axes: axes::of_nodes(job, Some(&points))?,
        directions,
        coupling: job.coupling,
        n_nodes: labels.len(),
    })
}

/// Whether the rows of a patch take part in a direction of its node.
pub(super) fn moves(sites: &Sites<'_>, (node, rows): (&InterfaceNode, &[usize]), direction: Direction) -> bool {
    let position = node.position.unwrap_or_default();
    rows.iter().any(|row| sites.lever(*row, position)[direction as usize] != 0.0)
}

/// How the rows of a patch follow the directions of its node, of which `columns` says what moves each: a dof, those of a carrier, or nothing.
///
/// # Errors
/// [`Error::PatchRank`] where the rows do not follow all of them independently.
pub(super) fn tied_rows(
    sites: &Sites<'_>,
    (node, rows): (&InterfaceNode, &[usize]),
    columns: &[Terms; 6],
) -> Result<Vec<TransformationRow>> {
    let levers = independent(sites, (node, rows), columns.iter().filter(|terms| !terms.is_empty()).count())?;
    let is_carried = columns.iter().any(|terms| terms.len() > 1);
    let entries_of = |lever: &[f64; 6]| {
        let moved = lever.iter().zip(columns).filter(|(factor, _)| **factor != 0.0);
        let entries: Terms =
            moved.flat_map(|(factor, terms)| terms.iter().map(move |(dof, share)| (*dof, factor * share))).collect();
        match if is_carried { summed(entries) } else { entries } {
            entries if entries.is_empty() => TransformationRow::Held,
            entries => TransformationRow::Tied(entries.into()),
        }
    };
    Ok(levers.iter().map(entries_of).collect())
}

/// How many motions of a node some rows tell apart: a rotation counts with the longest arm, so that the unit of length is none of the matter.
pub(super) fn rank_of_levers(levers: &[[f64; 6]]) -> usize {
    let is_rotation = |lever: &[f64; 6]| lever[..3].iter().all(|factor| *factor == 0.0);
    let arms = levers.iter().filter(|lever| !is_rotation(lever)).flat_map(|lever| &lever[3..]);
    let longest = arms.fold(0.0f64, |max, arm| max.max(arm.abs()));
    let unit = if longest > 0.0 { longest } else { 1.0 };
    let in_one_unit = |lever: &[f64; 6]| if is_rotation(lever) { lever.map(|factor| factor * unit) } else { *lever };
    rank_of_rows(&levers.iter().map(in_one_unit).collect::<Vec<_>>(), PATCH_RANK_TOLERANCE)
}

/// How the rows of a patch move with the six dofs of its node.
///
/// # Errors
/// [`Error::PatchRank`] where these are fewer than `expected` independent motions.
pub(super) fn independent(
    sites: &Sites<'_>,
    (node, rows): (&InterfaceNode, &[usize]),
    expected: usize,
) -> Result<Vec<[f64; 6]>> {
    let position = node.position.unwrap_or_default();
    let levers: Vec<[f64; 6]> = rows.iter().map(|row| sites.lever(*row, position)).collect();
    let rank = rank_of_levers(&levers);
    if rank < expected {
        return Err(Error::PatchRank { interface: node.name.clone(), n_rows: rows.len(), rank, expected });
    }
    Ok(levers)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two nodes that turn tell all six motions of theirs, whatever the unit of their distance.
    #[test]
    fn rotations_count_in_any_unit_of_length() {
        for length in [1e-9, 1.0, 1e9, 1e12] {
            let arm = [0.6, 0.5, -0.62].map(|x| x * length);
            let at = |r: [f64; 3]| {
                let translations = [
                    [1.0, 0.0, 0.0, 0.0, r[2], -r[1]],
                    [0.0, 1.0, 0.0, -r[2], 0.0, r[0]],
                    [0.0, 0.0, 1.0, r[1], -r[0], 0.0],
                ];
                let rotations = [0, 1, 2].map(|axis| std::array::from_fn(|j| f64::from(u8::from(j == 3 + axis))));
                (translations, rotations)
            };
            let (translations, rotations): (Vec<_>, Vec<_>) = [arm, arm.map(|x| -x)].map(at).into_iter().unzip();
            let without = translations.concat();
            assert_eq!(rank_of_levers(&without), 5, "{length:e}");
            assert_eq!(rank_of_levers(&[without, rotations.concat()].concat()), 6, "{length:e}");
        }
    }
}
