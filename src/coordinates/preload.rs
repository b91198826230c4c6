//! K of a preloaded state against its internal forces.
//!
//! ```text
//! q    n        internal forces f and moments m at the nodes, the derivative of the elements' energy W
//! C    n × 6    the six unit motions of every body
//! G    n × 3    what rotations θ make of q: θ × f at displacements, ½ θ × m at rotations
//! ```
//! W does not change when the body moves as a whole. Its derivative along translations gives Σ f = 0 and K_T C = 0; along rotations
//! Σ x × f + m = 0 and, because q turns with the body, K_T (θ × x) = θ × f node by node. So translations are free, a rotation is only
//! where it turns no force, and whatever K makes of the others has to be in q. Half of the moments: K_T is symmetric, the second
//! derivative of W by the rotation vectors of the nodes. That by one rotation after the other makes θ × m and has the skew part
//! ½ m × on the diagonal, which is what the symmetric one lacks.

use super::motions::{AXES, Body, Motions};
use super::nodes::{FIRST_ROTATION, NOTICEABLE, Nodes};
use crate::dense;
use crate::error::{Error, Result};
use crate::partition::TiedNodes;
use supel_runtime::MOTIONS;
use supel_runtime::motion::{IDENTITY_3, cross};

/// Difference of K and the internal forces relative to the largest force, beyond rounding of K. Coordinates of five digits leave 1e-5 of
/// the terms of K, where a preload to a strain of a thousandth makes 1e-3 of them.
const OTHER_FORCES: f64 = 1e-2;
/// Share of the terms of K that five digits of the coordinates leave, and that is no force. At the nodes of a rigid patch, whose arms turn
/// with the forces, differences are compared with the largest force of patches: a larger one somewhere else excuses nothing.
const OF_COORDINATES: f64 = 2e-5;
/// Resultant of the internal forces relative to its terms: what four digits of them leave.
const UNBALANCED: f64 = 1e-4;
/// Internal force at a tied node relative to the largest that is none: what six digits leave.
const NO_FORCE: f64 = 1e-6;

/// Confirms that K and the internal forces are of one state; `tied` are the nodes of patches.
pub(super) fn confirmed(motions: &Motions<'_>, nodes: &Nodes, forces: &[f64], tied: &TiedNodes) -> Result<()> {
    refuse_held(motions, nodes)?;
    motions.bodies.iter().try_for_each(|body| refuse_unbalanced(motions, body, forces))?;
    let turned = Turned::of(motions, nodes, forces);
    turned.refuse_misfit(motions, &tied_rows(motions, tied))?;
    refuse_tied(motions, forces, tied)
}

/// The rows whose nodes belong to rigid patches.
fn tied_rows(motions: &Motions<'_>, tied: &TiedNodes) -> Vec<bool> {
    let Some(dofs) = &motions.model.dofs else { return vec![false; motions.sites.len()] };
    dofs.iter().map(|dof| dof.is_some_and(|dof| tied.rigid.contains(&dof.node))).collect()
}

/// Refuses a K that supports have taken rows out of: their part of the forces is missing.
fn refuse_held(motions: &Motions<'_>, nodes: &Nodes) -> Result<()> {
    match (0..motions.sites.len()).find(|row| nodes.is_touched(*row)) {
        Some(row) => {
            Err(Error::PreloadHeld { n_touched: nodes.n_touched(), n_nodes: nodes.count(), dof: motions.name_of(row) })
        }
        None => Ok(()),
    }
}

/// Refuses internal forces that do work along a motion of the body as a whole.
fn refuse_unbalanced(motions: &Motions<'_>, body: &Body, forces: &[f64]) -> Result<()> {
    // No lever is longer than the body, whose size the rotations have as their unit.
    let lever = |row: usize| (0..6).fold(0.0, |max: f64, j| max.max(motions.centred[(row, j)].abs()));
    let terms: f64 = body.rows.iter().map(|row| lever(*row) * forces[*row].abs()).sum();
    for (motion, name) in MOTIONS.iter().enumerate() {
        let work = |row: &usize| motions.centred[(*row, motion)] * forces[*row];
        let share = body.rows.iter().map(work).sum::<f64>().abs() / terms;
        let worst = body.rows.iter().max_by(|a, b| work(a).abs().total_cmp(&work(b).abs()));
        if let Some(worst) = worst.filter(|_| terms > 0.0 && (share.is_nan() || share > UNBALANCED)) {
            return Err(Error::PreloadUnbalanced {
                motion: name,
                share,
                limit: UNBALANCED,
                dof: motions.name_of(*worst),
            });
        }
    }
    Ok(())
}

/// What rotations make of the internal forces, next to what K makes of the rotations.
struct Turned {
    of_row: Vec<TurnedRow>,
    /// The largest |G|.
    largest: f64,
    /// The largest |G| over the terms of its row.
    largest_share: f64,
}

/// One row that a body has.
struct TurnedRow {
    row: usize,
    /// K C of the three rotations, as forces.
    found: [f64; 3],
    /// G, as forces.
    expected: [f64; 3],
    /// The terms of K, as forces.
    scale: f64,
    /// What rounding of K and of the levers can make of the difference.
    noise: f64,
    /// Size of the body, by which a rotation in its units is multiplied; twice for a moment.
    unit: f64,
}

impl Turned {
    fn of(motions: &Motions<'_>, nodes: &Nodes, forces: &[f64]) -> Self {
        let mut of_node = vec![[0.0; 6]; nodes.count()];
        for (row, site) in motions.sites.iter().enumerate() {
            site.iter().for_each(|site| of_node[nodes.of(row)][site.direction as usize] += forces[row]);
        }
        let (mut of_row, mut largest, mut largest_share) = (Vec::new(), 0.0f64, 0.0f64);
        for body in &motions.bodies {
            for row in body.rows.iter().copied() {
                let Some(site) = motions.sites[row] else { continue };
                let turned = of_node[nodes.of(row)];
                let [fx, fy, fz, mx, my, mz] = turned;
                // Moments count as forces at the size of the body.
                let (vector, share, as_force) = match site.direction.is_rotation() {
                    true => ([mx, my, mz], 0.5, 1.0 / body.frame.size),
                    false => ([fx, fy, fz], 1.0, 1.0),
                };
                let per_size = share * as_force / body.frame.size;
                let expected =
                    [0, 1, 2].map(|axis| per_size * cross(&IDENTITY_3[axis], &vector)[site.direction.axis()]);
                let found = [0, 1, 2].map(|axis| as_force * motions.forces[(row, FIRST_ROTATION + axis)]);
                let scale = as_force * motions.scale_of(row);
                let noise = NOTICEABLE * (motions.rounding_at(row) + body.lever_rounding) * scale;
                let size = expected.into_iter().fold(0.0, |max: f64, value| max.max(value.abs()));
                largest = largest.max(size);
                if size > noise {
                    largest_share = largest_share.max(if scale > 0.0 { size / scale } else { 1.0 });
                }
                of_row.push(TurnedRow { row, found, expected, scale, noise, unit: body.frame.size / as_force });
            }
        }
        Self { of_row, largest, largest_share }
    }

    /// Refuses forces that are lost in rounding of K, and those that K does not answer with; `is_tied` says which rows rigid patches have.
    fn refuse_misfit(&self, motions: &Motions<'_>, is_tied: &[bool]) -> Result<()> {
        if self.largest == 0.0 {
            return Err(Error::PreloadNone { largest: 0.0 });
        }
        let of_patches = self.of_row.iter().filter(|of_row| is_tied[of_row.row]);
        let largest_tied = dense::worst(of_patches.flat_map(|of_row| of_row.expected.map(f64::abs)));
        let limit = |of_row: &TurnedRow| match is_tied[of_row.row] {
            true => (OTHER_FORCES * largest_tied).max(OF_COORDINATES * of_row.scale).min(OTHER_FORCES * self.largest),
            false => OTHER_FORCES * self.largest,
        };
        let excesses = self.of_row.iter().flat_map(|of_row| {
            let allowed = of_row.noise + limit(of_row);
            (0..3).map(move |axis| ((of_row.found[axis] - of_row.expected[axis]).abs() - allowed, of_row, axis))
        });
        let Some((excess, worst, axis)) = excesses.max_by(|a, b| a.0.total_cmp(&b.0)) else { return Ok(()) };
        if !self.largest.is_finite() || excess.is_nan() || excess > 0.0 {
            let unit = motions.model.scaling.stiffness_unit() * worst.unit;
            return Err(Error::PreloadMisfit {
                axis: AXES[axis],
                dof: motions.name_of(worst.row),
                found: unit * worst.found[axis],
                expected: unit * worst.expected[axis],
                factor: self.factor(),
                limit: limit(worst) / self.largest,
            });
        }
        if self.largest_share == 0.0 {
            let scale = |of_row: &TurnedRow| of_row.noise / (NOTICEABLE * motions.rounding_at(of_row.row));
            let largest = self.of_row.iter().map(scale).fold(0.0, f64::max);
            return Err(Error::PreloadNone { largest: if largest > 0.0 { self.largest / largest } else { 0.0 } });
        }
        Ok(())
    }

    /// The factor of the internal forces that comes nearest to K.
    fn factor(&self) -> f64 {
        let pairs = || {
            let of_row = |row: &TurnedRow| [0, 1, 2].map(|axis| [row.found[axis], row.expected[axis] / self.largest]);
            self.of_row.iter().flat_map(of_row)
        };
        let along: f64 = pairs().map(|[found, expected]| found * expected).sum();
        let square: f64 = pairs().map(|[_, expected]| expected * expected).sum();
        along / square / self.largest
    }
}

/// Refuses internal forces at nodes that averages or constraints tie to rotations: the force keeps its direction while its arm turns, which
/// is a stiffness that a congruence of K does not have. That of rigid patches is known; a mean motion and a row of G are linear, and do not
/// say how their arms turn.
fn refuse_tied(motions: &Motions<'_>, forces: &[f64], tied: &TiedNodes) -> Result<()> {
    let model = motions.model;
    let largest = forces.iter().enumerate().filter(|(row, _)| !turns(motions, *row));
    let largest = largest.map(|(_, force)| force.abs()).fold(0.0, f64::max);
    let size = |row: usize| match motions.bodies.iter().find(|body| body.rows.binary_search(&row).is_ok()) {
        Some(body) if turns(motions, row) => body.frame.size,
        _ => 1.0,
    };
    let share = |row: usize| forces[row].abs() / size(row) / largest;
    let node = |row: usize| model.dofs.as_ref().and_then(|dofs| dofs[row]).map(|dof| dof.node);
    let is_averaged = |row: &usize| node(*row).is_some_and(|node| tied.average.contains(&node));
    let of_averages = (0..forces.len()).filter(is_averaged).map(|row| (row, "an average"));
    let constraints = model.constraints.iter().flat_map(|constraints| &constraints.list);
    // What follows a node of a patch has the arm that this has.
    let is_of_patch = |(row, _): &(u32, f64)| node(*row as usize).is_some_and(|node| tied.contains(node));
    let has_arms = |terms: &[(u32, f64)]| terms.iter().any(is_of_patch) || !is_without_arm(motions, terms);
    let with_arms = constraints.filter(|constraint| has_arms(&constraint.terms));
    let of_constraints =
        with_arms.flat_map(|constraint| &constraint.terms).map(|(row, _)| (*row as usize, "a constraint"));
    // NaN is refused: without any force nothing is tied.
    let refused =
        of_averages.chain(of_constraints).find(|(row, _)| forces[*row] != 0.0 && dense::worse(share(*row), NO_FORCE));
    match refused {
        Some((row, tie)) => {
            Err(Error::PreloadTied { dof: motions.name_of(row), tie, share: share(row), limit: NO_FORCE })
        }
        None => Ok(()),
    }
}

fn turns(motions: &Motions<'_>, row: usize) -> bool {
    motions.sites[row].is_some_and(|site| site.direction.is_rotation())
}

/// Whether a constraint ties displacements along one axis alone, as the tie of two meshes does: no arm turns.
fn is_without_arm(motions: &Motions<'_>, terms: &[(u32, f64)]) -> bool {
    let mut directions = terms.iter().map(|(row, _)| motions.sites[*row as usize].map(|site| site.direction));
    let first = directions.next().flatten();
    first.is_some_and(|first| !first.is_rotation() && directions.all(|direction| direction == Some(first)))
}
