//! Directions in which interface nodes move as internal dofs do, because the interface was asked for without them.

use super::partition::Partition;
use super::transformation::DofOrigin;
use crate::dofs::{Direction, Dof};
use crate::error::{Error, Result};
use crate::job::Support;

impl Partition {
    /// Refuses masses and springs on an interface that moves in a translation which is no interface dof: nothing could act on it there.
    ///
    /// # Errors
    /// [`Error::BoundaryDofs`].
    pub(crate) fn refuse_partly_loaded(&self, supports: &[Support]) -> Result<()> {
        let loaded =
            supports.iter().filter(|support| matches!(support, Support::Loaded { .. } | Support::Sprung { .. }));
        for support in loaded {
            let left_out = self.internal_directions(support.interface().unwrap_or_default());
            let of_translations = left_out.into_iter().filter(|direction| !direction.is_rotation());
            let found: Vec<String> = of_translations.map(|direction| direction.to_string()).collect();
            if !found.is_empty() {
                let name = support.interface().unwrap_or_default().to_owned();
                return Err(Error::BoundaryDofs { boundary: support.to_string(), name, left_out: found.join(" ") });
            }
        }
        Ok(())
    }

    /// Directions in which nodes of an interface move as internal dofs.
    pub(crate) fn internal_directions(&self, interface: &str) -> Vec<Direction> {
        let own = || self.interface.iter().enumerate().filter(|(_, node)| node.name == interface);
        let is_own = |origin: DofOrigin, dof: Option<Dof>| match (origin, dof) {
            (DofOrigin::PatchNode(number, direction), _) => own().any(|(at, _)| at == number).then_some(direction),
            (DofOrigin::Row(_), Some(dof)) => {
                own().any(|(_, node)| node.label == Some(dof.node)).then_some(dof.direction)
            }
            (DofOrigin::Row(_) | DofOrigin::Distortion(..), _) => None,
        };
        let internal = &self.dofs[..self.n_internal];
        let mut found: Vec<Direction> =
            internal.iter().filter_map(|reduced| is_own(reduced.origin, reduced.dof)).collect();
        found.sort_unstable();
        found.dedup();
        found
    }
}
