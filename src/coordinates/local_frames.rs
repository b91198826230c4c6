//! Nodes in frames of their own: rows that the map calls ux, uy and uz and that lie along other axes.
//!
//! ```text
//! T    rows of the nodes at which a translation makes a force, n_T
//! F    n_T × 3    those forces, (K C)_T of the three translations
//! D    n_T × 3    K_TT⁻¹ F: how far the rows of T, let go, are from the translation of all others
//! R    n_T × 3    C_T − D, how they move then
//! r    n × 3      K C − K_{·T} D, the forces that are left
//! ```
//! A support makes forces under translation, and so do rows in a frame that the map does not know. Let go, they differ. Nodes near a
//! support stay behind, and the others feel what holds them: r is not zero. Nodes in frames of their own go along with the others as
//! far as these, seen in their own axes: the rows of R are of unit length and at right angles node by node, and no force is left.
//! Coordinates take no part in this, because a translation needs none.
//!
//! Rows of T that K couples are one cluster and are judged together. A turned node touches its neighbours, as a support does. Nearer than
//! four elements the two are in one cluster, which the support holds: the frame is not told from it.

use std::collections::{BTreeMap, BTreeSet};

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};

use super::motions::Motions;
use super::nodes::{FIRST_ROTATION, Nodes, noticeable_force};
use crate::dense;
use crate::error::{Error, Result};
use crate::factor::{Cholesky, SolveOperator};
use crate::model::{Bodies, Model};
use crate::number::{counted, quantity};
use crate::partition::{DofOrigin, Held, Partition};
use crate::sparse::principal;

/// Angle up to which a frame is that of the map: what directions of five digits leave.
const ALIGNED: f64 = 1e-5;
/// How far R Rᵀ may be from the identity, relative to how far R is from C. Nodes near a support stay behind by as much as they are off: of
/// D with a share d along any axes the ratio is d (2 − d) over √3 d at least, which is 0.58 and more. Frames leave rounding, 0.05 with six
/// digits of K.
const STAYS_BEHIND: f64 = 0.3;
/// Nodes that a message names.
const SHOWN_NODES: usize = 3;

/// Refuses rows in frames that the map does not know, whatever they cost: they look like supports, and nothing holds them.
///
/// What a support touches as well is left alone, and so are bodies of which every node is touched: there the motions without energy tell.
pub(super) fn refuse_local_frames(motions: &Motions<'_>, nodes: &Nodes) -> Result<()> {
    let mut turned = turned_in_clusters(motions, nodes)?;
    turned.extend(motions.bodies.iter().filter_map(|body| turned_alone(motions, nodes, &body.rows)));
    let angle = turned.iter().fold(0.0, |max: f64, (_, angle)| max.max(*angle));
    match turned.first() {
        Some((first, _)) if angle > ALIGNED => {
            let shown = turned.iter().take(SHOWN_NODES).map(|(row, _)| node_name(motions, *row)).collect::<Vec<_>>();
            let found = format!(
                "{} along axes of their own, turned by up to {} rad against those of the map, and nothing holds them: {}",
                counted(turned.len(), "node has rows", "nodes have rows"),
                quantity(angle, 2),
                shown.join(", "),
            );
            Err(Error::CoordinatesDoNotFit { found, energy: angle, expected: ALIGNED, dof: motions.name_of(*first) })
        }
        _ => Ok(()),
    }
}

/// The nodes along axes of their own among those that nothing holds and that others around them tell from supports.
fn turned_in_clusters(motions: &Motions<'_>, nodes: &Nodes) -> Result<Vec<(usize, f64)>> {
    let clusters = clusters(motions, nodes);
    if clusters.is_empty() {
        return Ok(Vec::new());
    }
    // What K_TT lets go without a force tells nothing of supports.
    let Some(behind) = let_go(motions, &clusters.concat())? else { return Ok(Vec::new()) };
    Ok(clusters.iter().filter_map(|rows| turned_nodes(motions, nodes, rows, &behind)).flatten().collect())
}

/// The node of a body that is touched all over whose axes alone explain that: it is coupled with every other, as the one inside a block of
/// eight elements is. Let go by itself it leaves no force anywhere, which no support does.
fn turned_alone(motions: &Motions<'_>, nodes: &Nodes, rows: &[usize]) -> Option<(usize, f64)> {
    let stiffness = &motions.model.stiffness;
    let counts = |row: &usize| nodes.is_placed(*row) && stiffness.get(*row, *row).is_some_and(|own| *own > 0.0);
    // Of nearly every body the first rows tell.
    if rows.iter().any(|row| !nodes.is_touched(*row) && counts(row)) {
        return None;
    }
    let mut of_node: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    rows.iter().copied().filter(counts).for_each(|row| of_node.entry(nodes.of(row)).or_default().push(row));
    let n_around = |rows: &[usize]| {
        let entries = rows.iter().filter_map(|row| stiffness.outer_view(*row)).flat_map(|view| view.indices().to_vec());
        entries
            .map(|row| nodes.of(row as usize))
            .filter(|node| of_node.contains_key(node))
            .collect::<BTreeSet<_>>()
            .len()
    };
    let mut around_all = of_node.values().filter(|rows| n_around(rows) == of_node.len());
    around_all.find_map(|rows| turned_nodes(motions, nodes, rows, &let_go_alone(motions, rows)?)?.first().copied())
}

/// D of [`let_go`] for the rows of one node.
fn let_go_alone(motions: &Motions<'_>, rows: &[usize]) -> Option<Mat<f64>> {
    let entry = |i: usize, j: usize| motions.model.stiffness.get(rows[i], rows[j]).copied().unwrap_or(0.0);
    let own = Mat::from_fn(rows.len(), rows.len(), entry);
    let forces = Mat::from_fn(rows.len(), FIRST_ROTATION, |i, j| motions.forces[(rows[i], j)]);
    let answers = own.llt(Side::Lower).ok()?.solve(&forces);
    let mut behind = Mat::zeros(motions.sites.len(), FIRST_ROTATION);
    rows.iter().enumerate().for_each(|(i, row)| behind.as_mut().row_mut(*row).copy_from(answers.row(i)));
    Some(behind)
}

/// The rows of touched nodes that K couples, ascending, without those of bodies that are touched all over.
fn clusters(motions: &Motions<'_>, nodes: &Nodes) -> Vec<Vec<usize>> {
    let stiffness = crate::sparse::diagonal(&motions.model.stiffness);
    let is_touched = |row: &usize| nodes.is_touched(*row) && stiffness[*row] > 0.0;
    let of_body = |rows: &Vec<usize>| {
        let touched: Vec<usize> = rows.iter().copied().filter(is_touched).collect();
        let with_stiffness = rows.iter().filter(|row| nodes.is_placed(**row) && stiffness[**row] > 0.0).count();
        if touched.len() < with_stiffness { touched } else { Vec::new() }
    };
    let mut rows: Vec<usize> = motions.bodies.iter().flat_map(|body| of_body(&body.rows)).collect();
    rows.sort_unstable();
    let block = principal(&motions.model.stiffness, &rows, &[]);
    let node_of_row: Vec<u32> = rows.iter().map(|row| nodes.of(*row) as u32).collect();
    let parts = Bodies::of(&block, &node_of_row);
    let mut clusters = vec![Vec::new(); parts.n_bodies];
    rows.into_iter().zip(parts.of_row).for_each(|(row, part)| clusters[part as usize].push(row));
    clusters
}

/// D, n × 3: how far some rows, let go, are from the translation of all others, `None` where K does not hold them together.
fn let_go(motions: &Motions<'_>, rows: &[usize]) -> Result<Option<Mat<f64>>> {
    let model = motions.model;
    let n = motions.sites.len();
    let mut is_held = vec![true; n];
    rows.iter().for_each(|row| is_held[*row] = false);
    let held = Held::of_rows((0..n).filter(|row| is_held[*row]).collect());
    let part = Partition::with_held(Model { constraints: None, ..model.clone() }, &[], held)?;
    let analysis = part.analysis()?;
    let factor = match Cholesky::new(&analysis, part.pencil(), 0.0, &|dof| part.name_of(dof)) {
        Ok(factor) => factor,
        Err(Error::NotDefinite { .. } | Error::IndefiniteStiffness { .. }) => return Ok(None),
        Err(error) => return Err(error),
    };
    let row_of = |dof: usize| match part.dofs[dof].origin {
        DofOrigin::Row(row) => Some(row),
        _ => None,
    };
    let mut answers =
        Mat::from_fn(part.n_dofs(), FIRST_ROTATION, |dof, j| row_of(dof).map_or(0.0, |row| motions.forces[(row, j)]));
    factor.solve_in_place(answers.as_mut());
    let mut behind = Mat::zeros(n, FIRST_ROTATION);
    for (dof, row) in (0..part.n_dofs()).filter_map(|dof| row_of(dof).map(|row| (dof, row))) {
        behind.as_mut().row_mut(row).copy_from(answers.row(dof));
    }
    Ok(Some(behind))
}

/// The first row and the angle of each node of a cluster that lies along axes of its own; nothing where something holds the cluster.
fn turned_nodes(
    motions: &Motions<'_>,
    nodes: &Nodes,
    cluster: &[usize],
    behind: &Mat<f64>,
) -> Option<Vec<(usize, f64)>> {
    if is_held(motions, cluster, behind) {
        return None;
    }
    let mut of_node: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let displaces = |row: &usize| motions.sites[*row].is_some_and(|site| !site.direction.is_rotation());
    cluster.iter().copied().filter(displaces).for_each(|row| of_node.entry(nodes.of(row)).or_default().push(row));
    let (mut stays, mut off) = (0.0f64, 0.0f64);
    let mut turned = Vec::new();
    for rows in of_node.into_values() {
        let difference = Mat::from_fn(rows.len(), FIRST_ROTATION, |i, j| behind[(rows[i], j)]);
        let moved = Mat::from_fn(rows.len(), FIRST_ROTATION, |i, j| motions.centred[(rows[i], j)] - difference[(i, j)]);
        let lengths = dense::product(moved.as_ref(), moved.transpose());
        for i in 0..rows.len() {
            (0..rows.len()).for_each(|j| stays = stays.max((lengths[(i, j)] - f64::from(u8::from(i == j))).abs()));
        }
        // ‖R − C‖² = 8 sin²(θ/2) of a rotation by θ.
        let square: f64 = difference.col_iter().flat_map(|column| column.iter().copied()).map(|x| x * x).sum();
        off = off.max(square.sqrt());
        turned.push((rows[0], 2.0 * (square / 8.0).sqrt().min(1.0).asin()));
    }
    let worst = turned.iter().fold(0.0, |max: f64, (_, angle)| max.max(*angle));
    // What rows that were taken out around a node hold of it looks the same.
    turned.retain(|(row, angle)| *angle > STAYS_BEHIND * worst && !nodes.is_near_lack(nodes.of(*row)));
    (stays <= STAYS_BEHIND * off).then_some(turned)
}

/// Whether a force is left at the rows of a cluster or at those that K couples with it. No two clusters are coupled, so that each is let
/// go by itself.
fn is_held(motions: &Motions<'_>, cluster: &[usize], behind: &Mat<f64>) -> bool {
    let stiffness = &motions.model.stiffness;
    let coupled = |row: usize| stiffness.outer_view(row).into_iter().flat_map(|view| view.indices().to_vec());
    let around: BTreeSet<usize> = cluster.iter().flat_map(|row| coupled(*row)).map(|row| row as usize).collect();
    around.into_iter().any(|row| {
        let mut left: [f64; FIRST_ROTATION] = std::array::from_fn(|j| motions.forces[(row, j)]);
        for (col, value) in stiffness.outer_view(row).iter().flat_map(|view| view.iter()) {
            if cluster.binary_search(&col).is_ok() {
                left.iter_mut().enumerate().for_each(|(j, force)| *force -= value * behind[(col, j)]);
            }
        }
        left.iter().any(|force| force.abs() > noticeable_force(motions, row))
    })
}

fn node_name(motions: &Motions<'_>, row: usize) -> String {
    let dof = motions.model.dofs.as_ref().and_then(|dofs| dofs[row]);
    dof.map_or_else(|| motions.name_of(row), |dof| format!("node {}", dof.node))
}
