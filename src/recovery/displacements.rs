//! Displacements of recovered nodes, W q, with W q̇ and W q̈.

use std::fmt::Write;

use supel_runtime::Recovery;

use super::product::times;
use super::sheet::{Sheet, end_row};
use super::state::{Order, State};

/// Motion of the recovered nodes, a row for each node and direction.
pub struct Displacements<'a> {
    recovery: &'a Recovery,
}

impl<'a> Displacements<'a> {
    /// By the rows W of a file.
    pub fn new(recovery: &'a Recovery) -> Self {
        Self { recovery }
    }
}

impl Sheet for Displacements<'_> {
    fn columns(&self, orders: &[Order]) -> Vec<&'static str> {
        ["node", "dof"].into_iter().chain(orders.iter().map(|order| order.name())).collect()
    }

    fn rows(&self, state: &State, start: &str, text: &mut String) -> Result<(), String> {
        for (i, dof) in self.recovery.dofs().iter().enumerate() {
            let of = |order| state.of(order).map(|q| times(self.recovery.rows(), i, q));
            let values: Vec<f64> = Order::ALL.into_iter().filter_map(of).collect();
            let _ = write!(text, "{start}{},{}", dof.node, dof.direction);
            end_row(text, &values, || format!("the motion of node {} {}", dof.node, dof.direction))?;
        }
        Ok(())
    }
}
