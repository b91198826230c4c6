//! Loads of a unit gravity field on a component that the job holds or preloads, whose rigid-body modes are not the six unit motions.
//!
//! ```text
//! e       n × 3    unit translations of all rows, those that are held among them
//! TᵀMe    n' × 3   their inertia on the dofs that move: through the mass that couples these with held ones as well
//! ```

use faer::Mat;

use super::held::Held;
use super::transformation::Transformation;
use crate::dense;
use crate::model::Model;
use crate::sparse::product;

/// Loads of unit gravity fields along x, y and z.
#[derive(Clone, Debug)]
pub struct Gravity {
    /// TᵀMe, n' × 3.
    pub loads: Mat<f64>,
    /// The largest eᵀMe.
    pub mass: f64,
}

/// The loads of gravity on a model that is held or preloaded; none without a dof map, which tells directions.
pub(super) fn gravity(model: &Model, transformation: &Transformation, held: &Held) -> Option<Gravity> {
    let dofs = model.dofs.as_ref().filter(|_| held.count() > 0 || model.fit.is_preloaded())?;
    let moves = |row: usize, axis: usize| dofs[row].is_some_and(|dof| dof.direction as usize == axis);
    let unit = Mat::from_fn(dofs.len(), 3, |row, axis| f64::from(u8::from(moves(row, axis))));
    let momenta = product(&model.mass, unit.as_ref());
    let mut loads = Mat::zeros(transformation.dofs.len(), 3);
    for axis in 0..3 {
        for (row, momentum) in transformation.rows.iter().zip(dense::column(momenta.as_ref(), axis)) {
            row.entries().for_each(|(dof, factor)| loads[(dof as usize, axis)] += factor * momentum);
        }
    }
    let mass = dense::dots(unit.as_ref(), momenta.as_ref()).into_iter().fold(0.0, f64::max);
    Some(Gravity { loads, mass })
}
