//! Recovered rows by themselves: they have to carry rigid-body motion, M-11.
//!
//! ```text
//! W Û   m × 6    displacements of the recovered nodes under the six unit motions
//! ```
//! A unit translation moves a node by that translation, and a unit rotation θ moves one at p by θ × p. Where the file does not say where a
//! recovered node is, that are nine numbers of each node for three unknown.

use supel_runtime::{Direction, Precision, RecoveredDof, RigidBodyModes, Superelement};

use super::content::Content;
use crate::dense::{self, NOISE_FACTOR, unpacked};
use crate::model::Site;
use crate::verification::check::{Check, Limits};
use crate::verification::limits::NOT_CARRIED;

/// Whether rigid-body motion ties recovered rows: where it is the six unit motions.
pub(super) fn is_tied(superelement: &Superelement) -> bool {
    superelement.metadata().model.rigid_body_modes == RigidBodyModes::Geometric && superelement.n_rigid() == 6
}

/// M-11: recovered rows carry rigid-body motion, where that is the six unit motions.
pub(super) fn rigid_motion(content: &Content<'_>) -> Option<Check> {
    let recovery = content.superelement.tensors().recovery.as_ref()?;
    if !is_tied(content.superelement) {
        return None;
    }
    let rows = unpacked(recovery.rows());
    let motion = dense::product(rows.as_ref(), content.u.as_ref());
    let terms = |i: usize, j: usize| (0..rows.ncols()).map(|k| (rows[(i, k)] * content.u[(k, j)]).abs()).sum::<f64>();
    // Lengths that displacements under rotations are compared with: those of the interface and of the recovered nodes themselves.
    let [of_rows, of_interface] = [&motion, &content.u].map(|a| a.as_ref().subcols(3, 3).norm_max());
    let size = of_rows.max(of_interface);
    let mut worst = (0.0, None);
    let mut rounding = 0.0f64;
    let dofs = recovery.dofs();
    let (mut first, mut places) = (0, recovery.positions().unwrap_or_default().iter());
    while first < dofs.len() {
        let n = dofs[first..].iter().take_while(|dof| dof.node == dofs[first].node).count();
        let displacement = |i: usize, j: usize| motion[(first + i, j)];
        let node = Node { dofs: &dofs[first..first + n], position: places.next(), displacement: &displacement };
        for (i, dof) in node.dofs.iter().enumerate() {
            for j in 0..6 {
                let unit = if j < 3 || is_rotation(dof.direction) { 1.0 } else { size };
                let error = node.error(i, j) / unit;
                rounding = rounding.max(terms(first + i, j) / unit);
                if dense::worse(error, worst.0) {
                    let direction = format!("{:?}", dof.direction).to_lowercase();
                    worst = (error, Some(format!("node {} {direction}", dof.node)));
                }
            }
        }
        first += n;
    }
    let digits = match recovery.precision() {
        Precision::Double => f64::EPSILON,
        Precision::Single => f64::from(f32::EPSILON),
    };
    let limits = Limits { engineering: 1e-12, arithmetic: NOISE_FACTOR * digits * rounding, data: 0.0 };
    Some(Check {
        id: "M-11",
        name: "recovered rows carry rigid-body motion",
        equation: "max |WÛ − motion of a point|, translations as they are, rotations over the distance",
        value: worst.0,
        limits: limits.capped(1e-4, 0.0),
        fail_above: (NOISE_FACTOR * limits.capped(1e-4, 0.0).value()).max(NOT_CARRIED),
        worst: worst.1,
    })
}

fn is_rotation(direction: Direction) -> bool {
    direction >= Direction::Rx
}

/// The recovered rows of a node under the unit motions.
struct Node<'a> {
    dofs: &'a [RecoveredDof],
    /// Where it is, as far as the file says it.
    position: Option<&'a [f64; 3]>,
    /// Displacement of a row under a unit motion.
    displacement: &'a dyn Fn(usize, usize) -> f64,
}

impl Node<'_> {
    /// How far a displacement is from that of a point.
    fn error(&self, i: usize, j: usize) -> f64 {
        let direction = self.dofs[i].direction as usize;
        let found = (self.displacement)(i, j);
        if j < 3 || is_rotation(self.dofs[i].direction) {
            return (found - f64::from(u8::from(direction == j))).abs();
        }
        if let Some(position) = self.position {
            let site = Site { position: *position, direction: self.dofs[i].direction };
            return (found - site.rigid_motion()[j]).abs();
        }
        // θ_b × p along a is ± the coordinate of the third axis, and nothing along b itself.
        let (a, b) = (direction, j - 3);
        if a == b {
            return found.abs();
        }
        let twin = self.dofs.iter().position(|dof| dof.direction as usize == b);
        twin.map_or(0.0, |twin| (found + (self.displacement)(twin, a + 3)).abs())
    }
}
