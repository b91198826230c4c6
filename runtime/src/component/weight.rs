//! Loads of gravity that are the weight of a body: UᵀĜ = (m I; x̃_m).

use super::dense;
use crate::elementary::sqrt;
use crate::motion::{Matrix6, Vector3, Vector6, skew, transposed_times_6};

/// What the entries of UᵀĜ may differ from those of a weight: loads of gravity may be printed with six digits.
const OF_A_WEIGHT: f64 = 1e-5;

/// Mass m and moment of mass x_m that loads of gravity are the weight of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Weight {
    pub(super) mass: f64,
    pub(super) moment: Vector3,
}

impl Weight {
    /// From Ĝ, rows of three, and U of the nodes; `None` where UᵀĜ is not (m I; x̃_m). `rigid_mass` gives the size of x_m.
    pub(super) fn of(gravity: &[Vector3], rigid: &[Matrix6], rigid_mass: &Matrix6) -> Option<Self> {
        let columns: [Vector6; 3] = core::array::from_fn(|c| on_frame(gravity, rigid, |row| row[c]));
        let entry = |i: usize, c: usize| columns[c][i];
        let mass = (entry(0, 0) + entry(1, 1) + entry(2, 2)) / 3.0;
        let moment = [(5, 1), (3, 2), (4, 0)].map(|(i, c)| 0.5 * (entry(i, c) - entry(c + 3, i - 3)));
        let arms = (3..6).map(|i| rigid_mass[i][i].abs()).sum::<f64>() * mass.abs();
        let limits = [OF_A_WEIGHT * mass.abs(), OF_A_WEIGHT * sqrt(arms)];
        let turned = skew(&moment);
        let is_weight = (0..3).all(|i| {
            let straight = |c: usize| if i == c { mass } else { 0.0 };
            (0..3).all(|c| {
                (entry(i, c) - straight(c)).abs() <= limits[0] && (entry(3 + i, c) - turned[i][c]).abs() <= limits[1]
            })
        });
        is_weight.then_some(Self { mass, moment })
    }
}

/// Σ U_jᵀ f_j of a load with one value for each coordinate.
pub(super) fn on_frame(gravity: &[Vector3], rigid: &[Matrix6], value: impl Fn(&Vector3) -> f64) -> Vector6 {
    let mut sum = [0.0; 6];
    for (rigid, rows) in rigid.iter().zip(gravity.as_chunks::<6>().0) {
        sum = dense::plus_scaled(&sum, 1.0, &transposed_times_6(rigid, &rows.each_ref().map(&value)));
    }
    sum
}
