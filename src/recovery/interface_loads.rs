//! Forces on the interface and their resultants.
//!
//! ```text
//! F     r    K̂ q + Ĉ q̇ + M̂ q̈ − Ĝ g: what acts on the component from outside; of amplitudes nothing where the state obeys its equations
//! F_B   n_B  its part on the interface: forces and moments on each node
//! f, m  3    Σ F and Σ (M + x × F) about the origin of the model, over an interface and over all of them
//! ```
//! Ĉ is the damping of the file, if it has one, and Ĝ its loads of gravity.

use std::collections::BTreeMap;
use std::fmt::Write;

use supel_runtime::{Coordinate, Direction, Matrix, Superelement};

use super::product::times;
use super::sheet::{Sheet, end_row};
use super::state::{Order, State};
use crate::model::Site;
use crate::report::field;

/// Names of the components of a resultant, in the order of the directions.
const COMPONENTS: [&str; 6] = ["fx", "fy", "fz", "mx", "my", "mz"];

/// Forces on the interface, a row for each of its dofs and for each component of each resultant.
pub struct InterfaceLoads<'a> {
    superelement: &'a Superelement,
    /// Ĝ g, r values; none where nobody asked for gravity.
    weight: Option<Vec<f64>>,
}

impl<'a> InterfaceLoads<'a> {
    /// Without gravity.
    pub fn new(superelement: &'a Superelement) -> Self {
        Self { superelement, weight: None }
    }

    /// In a field of gravity by the loads of the file, r × 3.
    #[must_use]
    pub fn with_gravity(self, loads: &Matrix, field: &[f64; 3]) -> Self {
        Self { weight: Some((0..loads.rows()).map(|row| times(loads, row, field)).collect()), ..self }
    }

    /// F at an interface coordinate.
    fn force(&self, state: &State, row: usize) -> f64 {
        let tensors = self.superelement.tensors();
        let terms = [
            (Some(&tensors.stiffness), Order::Displacement),
            (tensors.damping.as_ref(), Order::Velocity),
            (Some(&tensors.mass).filter(|mass| mass.rows() > 0), Order::Acceleration),
        ];
        let products = terms.into_iter().filter_map(|(matrix, order)| Some(times(matrix?, row, state.of(order)?)));
        products.sum::<f64>() - self.weight.as_ref().map_or(0.0, |weight| weight[row])
    }
}

impl Sheet for InterfaceLoads<'_> {
    fn columns(&self, _: &[Order]) -> Vec<&'static str> {
        vec!["interface", "node", "component", "load"]
    }

    fn rows(&self, state: &State, start: &str, text: &mut String) -> Result<(), String> {
        let metadata = self.superelement.metadata();
        let mut of_interface: BTreeMap<&str, [f64; 6]> = BTreeMap::new();
        for (row, coordinate) in metadata.coordinates.iter().enumerate().filter(|(_, at)| at.is_interface()) {
            let force = self.force(state, row);
            let what = match coordinate {
                Coordinate::Interface { node, direction } => {
                    let node = &metadata.interface_nodes[*node];
                    let resultant = of_interface.entry(&node.name).or_default();
                    resultant
                        .iter_mut()
                        .zip(resultant_of(*direction, force, &node.position))
                        .for_each(|(a, b)| *a += b);
                    let label = node.label.map_or_else(String::new, |label| label.to_string());
                    format!("{},{label},{}", field(&node.name), COMPONENTS[*direction as usize])
                }
                Coordinate::InterfaceRow { row } => format!("rows:{row},,f"),
                _ => continue,
            };
            let _ = write!(text, "{start}{what}");
            end_row(text, &[force], || format!("the load {what}"))?;
        }
        let mut total = [0.0; 6];
        for (name, resultant) in &of_interface {
            total.iter_mut().zip(resultant).for_each(|(sum, value)| *sum += value);
            put(text, start, &field(name), resultant)?;
        }
        if of_interface.is_empty() { Ok(()) } else { put(text, start, "", &total) }
    }
}

/// The rows of a resultant; that of the whole component has no name.
fn put(text: &mut String, start: &str, name: &str, resultant: &[f64; 6]) -> Result<(), String> {
    for (component, value) in COMPONENTS.iter().zip(resultant) {
        let _ = write!(text, "{start}{name},all,{component}");
        end_row(text, &[*value], || format!("the resultant {component} of the loads on {name}"))?;
    }
    Ok(())
}

/// Force and moment about the origin that a load along a direction makes at a position.
fn resultant_of(direction: Direction, load: f64, position: &[f64; 3]) -> [f64; 6] {
    // Work on unit motions: a force makes as much on a turn as its moment.
    Site { position: *position, direction }.rigid_motion().map(|factor| load * factor)
}
