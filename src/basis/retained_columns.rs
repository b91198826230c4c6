//! The columns that retained modes make: the one place where the methods differ once their modes are known.

use super::dynamic::{DynamicColumns, fixed_interface_columns, modal_columns, mode_acceleration_columns};
use crate::job::{Columns, Method};
use crate::modes::{Component, Retained};

/// The columns of Ψ_D of the retained modes. A free component without interface has its rigid-body and elastic modes. Of others
/// Craig and Bampton keep the fixed-interface modes as they are (38), Herting's method accelerates the free-free ones (23), (37).
pub fn retained_columns(component: Component<'_>, method: Method, retained: &Retained) -> DynamicColumns {
    let Component { partition, factor, rigid, constraint, .. } = component;
    match method.columns() {
        _ if component.is_modal() => modal_columns(rigid, &retained.modes),
        Columns::Modes => fixed_interface_columns(&retained.modes),
        Columns::ModeAcceleration => mode_acceleration_columns(partition, factor, constraint, rigid, &retained.modes),
    }
}
