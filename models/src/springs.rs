//! Masses on springs of any network.

use crate::model::{Assembler, Model};

/// Masses on springs, without coordinates: `grounded` lists row and stiffness to the ground, `between` two rows and the stiffness.
pub fn springs(masses: &[f64], grounded: &[(u32, f64)], between: &[(u32, u32, f64)]) -> Model {
    let (mut stiffness, mut mass) = (Assembler::default(), Assembler::default());
    (0..).zip(masses).for_each(|(row, value)| mass.add(row, row, *value));
    grounded.iter().for_each(|(row, value)| stiffness.add(*row, *row, *value));
    for &(i, j, value) in between {
        for (row, column, sign) in [(i, i, 1.0), (j, j, 1.0), (i, j, -1.0), (j, i, -1.0)] {
            stiffness.add(row, column, sign * value);
        }
    }
    Model { n: masses.len(), ..Model::node_major(Vec::new(), &[], stiffness, mass) }
}
