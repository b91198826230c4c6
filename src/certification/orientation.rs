//! Whether a square set of modes has them in its columns or in its rows.
//!
//! All n modes of n rows in a dataset of HDF5 look alike as h5py writes them and as MATLAB does, which stores the transpose. Modes satisfy
//! K x = ρ M x, and the rows of their matrix do not.

use super::claims::Claims;
use crate::dense;
use crate::input::{ForeignModes, Orientation};
use crate::partition::Partition;
use crate::sparse::product;

/// What is said of modes that were found in the rows of a square dataset.
const TRANSPOSED: &str = "the dataset is square: by the force that is left over its modes are those that MATLAB stores, the transpose of \
                          what h5py would write";

/// The modes along the axes of the model, the way round that leaves less force over, and a note where that is not the way in which they
/// were read. What is a row of the files, and along which axes, is known once it is known which way round they are.
pub fn right_way_round(partition: &Partition, modes: ForeignModes) -> (ForeignModes, Option<&'static str>) {
    if modes.orientation == Orientation::Known {
        return (modes.along_model(), None);
    }
    let n = modes.columns.len();
    let of_row = |row: usize| modes.columns.iter().map(|column| column[row]).collect();
    let transposed = ForeignModes { columns: (0..n).map(of_row).collect(), ..modes.clone() }.along_model();
    let modes = modes.along_model();
    match left_over(partition, &transposed) < left_over(partition, &modes) {
        true => (transposed, Some(TRANSPOSED)),
        false => (modes, None),
    }
}

/// The mean of ‖Kx − ρMx‖ / (‖Kx‖ + |ρ|‖Mx‖) over shapes x; infinite where a shape is none.
fn left_over(partition: &Partition, modes: &ForeignModes) -> f64 {
    let Ok(claims) = Claims::of(partition, modes, None) else { return f64::INFINITY };
    let [forces, momenta] =
        [&partition.stiffness, &partition.mass].map(|matrix| product(matrix, claims.shapes.as_ref()));
    let of_shape = |at: usize| {
        let [shape, force, momentum] = [&claims.shapes, &forces, &momenta].map(|a| dense::column(a.as_ref(), at));
        let rho = dense::dot(shape, force) / dense::dot(shape, momentum);
        let rest: Vec<f64> = force.iter().zip(momentum).map(|(force, momentum)| force - rho * momentum).collect();
        let share = dense::norm(&rest) / (dense::norm(force) + (rho * dense::norm(momentum)).abs());
        // A shape without mass has no quotient.
        if share.is_finite() { share } else { 1.0 }
    };
    (0..claims.count()).map(of_shape).sum::<f64>() / claims.count() as f64
}
