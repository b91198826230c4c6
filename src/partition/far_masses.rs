//! Masses that lie so far from the node of their patch that M has not enough digits for both.
//!
//! ```text
//! M_p        6 × 6, of the node of a patch: m I, −m [r]×, J − m [r]×²
//! loss       1 / μ, μ the smallest eigenvalue of DM_pD with a unit diagonal
//! ```
//! A rotation about the centre of a large mass moves nothing but the rest of the patch. Described by a node elsewhere, it is a
//! rotation and a translation whose inertias m r² cancel, and ε m r² is what rounding of M leaves of the inertia of the rest.

use std::collections::BTreeMap;

use faer::Mat;

use super::interface_node::NodeNames;
use super::transformation::{DofOrigin, Transformation};
use crate::dense;
use crate::dofs::Direction;
use crate::model::{Finding, Site};
use crate::sparse::SparseMatrix;

/// Loss from which on rounding of products with M leaves more in single rows than M-02 lets pass, some 10⁻¹⁰ of their terms.
const FAR: f64 = 1e6;
/// Share of the loss that is left about the centre of the mass where the distance is what made it: a digit less.
const SHARE_OF_LOSS: f64 = 0.1;
/// Units of rounding that sums over a patch leave of a centre of mass, relative to how far its nodes are.
const ROUNDED: f64 = 64.0;

/// One finding for each patch whose mass is far from its node.
pub(super) fn far_masses(mass: &SparseMatrix, transformation: &Transformation, names: NodeNames<'_>) -> Vec<Finding> {
    let mut of_nodes: BTreeMap<usize, [Option<usize>; 6]> = BTreeMap::new();
    for (dof, reduced) in transformation.dofs.iter().enumerate() {
        if let DofOrigin::PatchNode(node, direction) = reduced.origin {
            of_nodes.entry(node).or_default()[direction as usize] = Some(dof);
        }
    }
    let of_node = |(node, dofs): (usize, [Option<usize>; 6])| {
        let dofs: Vec<usize> = dofs.into_iter().collect::<Option<_>>()?;
        let block = Mat::from_fn(6, 6, |i, j| mass.get(dofs[i], dofs[j]).copied().unwrap_or(0.0));
        let (loss, offset) = (loss_of(&block).filter(|loss| *loss >= FAR)?, offset_of(&block));
        let origin = transformation.dofs[dofs[0]].site?.position;
        if is_rounding(&block, offset, origin) {
            return None;
        }
        // Nodes on a line have next to no inertia about it, wherever they are described.
        if loss_of(&about(&block, offset)).is_some_and(|left| left > SHARE_OF_LOSS * loss) {
            return None;
        }
        let centre = [0, 1, 2].map(|axis| origin[axis] + offset[axis]);
        Some(Finding::MassFar { interface: names.of(node).to_owned(), centre, distance: dense::norm(&offset), loss })
    };
    of_nodes.into_iter().filter_map(of_node).collect()
}

/// How many times larger the terms of the smallest inertia are than what is left of them; none where some direction has no mass.
fn loss_of(block: &Mat<f64>) -> Option<f64> {
    let scale: Vec<f64> = (0..6).map(|i| 1.0 / block[(i, i)].sqrt()).collect();
    if !scale.iter().all(|scale| scale.is_finite()) {
        return None;
    }
    let scaled = Mat::from_fn(6, 6, |i, j| scale[i] * block[(i, j)] * scale[j]);
    let smallest = dense::symmetric_eigen(scaled.as_ref()).ok()?.0.first().copied()?;
    // Below its own rounding an eigenvalue is that.
    Some(1.0 / smallest.max(f64::EPSILON))
}

/// r: the way from the node to the centre of its mass.
fn offset_of(block: &Mat<f64>) -> [f64; 3] {
    let mass = (block[(0, 0)] + block[(1, 1)] + block[(2, 2)]) / 3.0;
    let skew = |i: usize, j: usize| 0.5 * (block[(i, 3 + j)] - block[(j, 3 + i)]) / mass;
    [skew(1, 2), skew(2, 0), skew(0, 1)]
}

/// Whether the centre of the mass is at the node, but for the rounding of coordinates and of their mean: nodes on a line whose node is
/// in their middle have no inertia about it but that of rounding.
fn is_rounding(block: &Mat<f64>, offset: [f64; 3], origin: [f64; 3]) -> bool {
    let trace = |from: usize| (from..from + 3).map(|i| block[(i, i)]).sum::<f64>();
    let gyration = (trace(3) / trace(0)).max(0.0).sqrt();
    dense::norm(&offset) <= ROUNDED * f64::EPSILON * (dense::norm(&origin) + gyration)
}

/// M_p of a node at a place r from the one it is given for, whose dofs are at −r from that one.
fn about(block: &Mat<f64>, place: [f64; 3]) -> Mat<f64> {
    let moved = motion_of_node(place.map(|x| -x));
    dense::product(moved.transpose(), dense::product(block.as_ref(), moved.as_ref()).as_ref())
}

/// The six dofs of a node at r from another one, by the motion of that one, 6 × 6.
fn motion_of_node(position: [f64; 3]) -> Mat<f64> {
    let rows = Direction::ALL.map(|direction| Site { position, direction }.rigid_motion());
    Mat::from_fn(6, 6, |i, j| rows[i][j])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// M of a mass m at r, and of a unit mass with inertia at the node.
    fn block(m: f64, r: [f64; 3]) -> Mat<f64> {
        let motion = motion_of_node(r);
        let turn = motion.subrows(0, 3);
        let far = dense::product(turn.transpose(), turn);
        Mat::from_fn(6, 6, |i, j| m * far[(i, j)] + if i == j { 1.0 } else { 0.0 })
    }

    #[test]
    fn the_centre_is_found_and_the_loss_is_that_of_the_smallest_inertia() {
        let far = block(1e6, [3.0, -2.0, 0.5]);
        let offset = offset_of(&far);
        for (found, expected) in offset.into_iter().zip([3.0, -2.0, 0.5]) {
            assert!((found - expected * 1e6 / (1e6 + 1.0)).abs() <= 1e-9, "{offset:?}");
        }
        // A rotation about the mass moves the unit at the node by r, of which m r² is a millionth part.
        let loss = loss_of(&far).expect("massive");
        assert!((1e5..1e8).contains(&loss), "{loss:e}");
        assert!(loss_of(&block(1e6, [0.0; 3])).expect("massive") < 2.0);
        assert!(loss_of(&about(&far, offset)).expect("massive") < 1e3);
        assert_eq!(loss_of(&Mat::zeros(6, 6)), None);
        assert!(!is_rounding(&far, offset, [0.0; 3]));
    }

    /// Six nodes of unit mass on a line that is along no axis, described by their mean.
    #[test]
    fn the_mean_of_a_line_is_not_far() {
        let places: Vec<[f64; 3]> = (0..6).map(|k| [0.6, 0.8, 0.1].map(|x| 0.3 + x * 0.1 * f64::from(k))).collect();
        let origin: [f64; 3] = std::array::from_fn(|axis| places.iter().map(|place| place[axis]).sum::<f64>() / 6.0);
        let mut line = Mat::zeros(6, 6);
        for place in &places {
            let motion = motion_of_node(std::array::from_fn(|axis| place[axis] - origin[axis]));
            let turn = motion.subrows(0, 3);
            line += dense::product(turn.transpose(), turn);
        }
        assert!(is_rounding(&line, offset_of(&line), origin));
        let elsewhere = about(&line, [1e-6, 0.0, 0.0]);
        assert!(!is_rounding(&elsewhere, offset_of(&elsewhere), origin));
    }
}
