//! The columns that retained modes make: the one place where the methods differ once their modes are known.

use super::dynamic::{DynamicColumns, fixed_interface_columns, modal_columns, mode_acceleration_columns};
use crate::modes::{Boundary, Component, Retained};

/// The columns of Ψ_D of the retained modes: Craig and Bampton keep the fixed-interface modes as they are (38), Herting's
/// method accelerates the free-free ones (23), (37).
pub fn retained_columns(component: Component<'_>, retained: &Retained) -> DynamicColumns {
    let Component { partition, factor, rigid, constraint, .. } = component;
    match retained.boundary {
        Boundary::FixedInterface => fixed_interface_columns(&retained.modes),
        Boundary::FreeInterface if component.is_modal() => modal_columns(rigid, &retained.modes),
        Boundary::FreeInterface => mode_acceleration_columns(partition, factor, constraint, rigid, &retained.modes),
    }
}
