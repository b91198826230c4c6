//! Rigid masses at nodes, added to the mass matrix before anything is made of it.
//!
//! ```text
//! v = u̇ + θ̇ × r                                   velocity of the centre, r the way to it from the node
//! [ m I       −m r̃      ]
//! [ m r̃       J − m r̃ r̃ ]      6 × 6               of u and θ: 2T = m v² + θ̇ᵀJθ̇
//! ```

use std::collections::BTreeMap;

use faer::Mat;

use super::weight::directions_of;
use crate::dense;
use crate::dofs::{Direction, Dof};
use crate::error::{Error, Result};
use crate::input::Input;
use crate::job::AddedMassJob;
use crate::number;
use crate::sparse::{Declared, Triplets};

/// Roundings of an entry J + m (y² + z²), relative to the root of its diagonals: four of the product, one for each of the two sums.
const ROUNDINGS_OF_A_MASS: f64 = 6.0;

/// Adds the masses of a job to M, and says of each what was added, for the report.
///
/// # Errors
/// [`Error::AddedMass`] where a model has no dof map, a node has no dofs or no rotations that the mass needs, or an inertia is negative. A model
/// that moves in a plane needs no rotations out of it.
pub fn add_masses(input: &mut Input, masses: &[AddedMassJob]) -> Result<Vec<String>> {
    if masses.is_empty() {
        return Ok(Vec::new());
    }
    let mut added = Triplets::default();
    let has_no_such_motion = motions_out_of_plane(input);
    for job in masses {
        let rows = rows_of(input, job)?;
        let block = block(job)?;
        for (i, j) in (0..6).flat_map(|i| (0..6).map(move |j| (i, j))).filter(|at| block[*at] != 0.0) {
            let row = |axis: usize| rows.get(&Direction::ALL[axis]).copied();
            let is_missing = |axis: &usize| *axis >= 3 && row(*axis).is_none() && !has_no_such_motion[*axis];
            if let Some(axis) = [i, j].into_iter().find(is_missing) {
                let found = format!("no {}", Direction::ALL[axis]);
                return Err(refused(job, found, "rotations at the node of a mass with inertia or an offset"));
            }
            // Supports took a translation out, or the model moves in a plane.
            if let (Some(row), Some(column)) = (row(i), row(j)) {
                added.push(row, column, block[(i, j)]);
            }
        }
    }
    let (n, path) = (input.mass.matrix.rows(), input.mass.path.clone());
    let (added, _) = added.assemble(n, Declared::Whole, &path)?;
    input.mass.matrix = sprs::binop::csmat_binop(input.mass.matrix.view(), added.view(), |a, b| a + b);
    input.mass.notes.added += ROUNDINGS_OF_A_MASS * masses.len() as f64;
    masses.iter().map(in_words).collect()
}

/// What was added, as the report has it. A disc may be given by its polar inertia alone, and that is no inertia of a rigid body.
fn in_words(job: &AddedMassJob) -> Result<String> {
    /// What few digits of three moments leave of the inequality that those of a plate fulfil with a sign of equality.
    const DIGITS: f64 = 1e-2;
    let mass = match job.mass {
        0.0 => format!("inertia without mass added at node {}", job.node),
        mass => format!("mass added at node {}: {}", job.node, number::quantity(mass, 5)),
    };
    let Some(inertia) = job.inertia.filter(|inertia| inertia.iter().any(|value| *value != 0.0)) else {
        return Ok(mass);
    };
    let principal = dense::symmetric_eigen(inertia_tensor(inertia).as_ref())?.0;
    let [least, middle, most] = [0, 1, 2].map(|axis| principal[axis].max(0.0));
    let list = [least, middle, most].map(|value| number::quantity(value, 5)).join(", ");
    let is_of_body = most <= (1.0 + DIGITS) * (least + middle);
    let doubt = if is_of_body { "" } else { ", which no rigid body has: one is above the sum of the others" };
    Ok(format!("{mass} · principal inertias {list}{doubt}"))
}

/// The symmetric matrix of xx, yy, zz, xy, yz, zx.
pub(crate) fn inertia_tensor([xx, yy, zz, xy, yz, zx]: [f64; 6]) -> Mat<f64> {
    Mat::from_fn(3, 3, |i, j| [[xx, xy, zx], [xy, yy, yz], [zx, yz, zz]][i][j])
}

/// The directions that no node has, of a model that moves in a plane: along or about each axis, and never both. In other models nodes turn although
/// they have no rotations.
fn motions_out_of_plane(input: &Input) -> [bool; 6] {
    let has = directions_of(input.dofs.iter().flatten().flatten());
    let is_in_plane = has[3..].contains(&true) && (0..3).all(|axis| has[axis] != has[axis + 3]);
    has.map(|has| is_in_plane && !has)
}

/// Rows of the dofs of the node.
fn rows_of(input: &Input, job: &AddedMassJob) -> Result<BTreeMap<Direction, u32>> {
    let map = "a dof map, or nodes from which it follows";
    let dofs = input.dofs.as_ref().ok_or_else(|| refused(job, "no dof map".to_owned(), map))?;
    let of_node = |(row, dof): (usize, &Option<Dof>)| {
        dof.filter(|dof| dof.node == job.node).map(|dof| (dof.direction, row as u32))
    };
    let rows: BTreeMap<Direction, u32> = dofs.iter().enumerate().filter_map(of_node).collect();
    match rows.keys().any(|direction| !direction.is_rotation()) {
        true => Ok(rows),
        false => Err(refused(job, "no translation of that node".to_owned(), "a node whose translations have rows")),
    }
}

/// The mass matrix of one mass.
fn block(job: &AddedMassJob) -> Result<Mat<f64>> {
    let (m, [x, y, z]) = (job.mass, job.offset.unwrap_or_default());
    let inertia = inertia_tensor(job.inertia.unwrap_or_default());
    let least = dense::symmetric_eigen(inertia.as_ref())?.0[0];
    // A plate has no inertia to spare in one direction, and rounding may leave less than none.
    if least < -8.0 * f64::EPSILON * inertia.norm_max() {
        return Err(refused(job, format!("a principal inertia of {least:e}"), "none below zero"));
    }
    let skew = Mat::from_fn(3, 3, |i, j| [[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]][i][j]);
    Ok(Mat::from_fn(6, 6, |i, j| match (i < 3, j < 3) {
        (true, true) => f64::from(u8::from(i == j)) * m,
        (true, false) => -m * skew[(i, j - 3)],
        (false, true) => m * skew[(i - 3, j)],
        (false, false) => {
            let (i, j) = (i - 3, j - 3);
            let carried: f64 = (0..3).map(|k| skew[(k, i)] * skew[(k, j)]).sum();
            inertia[(i, j)] + m * carried
        }
    }))
}

fn refused(job: &AddedMassJob, found: String, expected: &'static str) -> Error {
    Error::AddedMass { node: job.node, found, expected }
}
