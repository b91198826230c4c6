//! Transformation matrices that give loads and accelerations of a component from those of its coordinates, as pyYeti and MYSTRAN have them.
//!
//! ```text
//! F = IFLTMD q + IFLTMV q̇ + IFLTMA q̈    n_B      forces on the interface: rows of K̂, Ĉ and M̂
//! R                                      n_B × 6   motion of the interface in the six unit motions of the model
//! NET… = Rᵀ IF…                          6 × r     their resultant, force and moment about the origin of the model
//! CGATM = C M_F⁻¹ Ûᵀ M̂                   6 × r     acceleration of the centre of mass c, and angular acceleration
//! C                                      6 × 6     a_c = a + α × c
//! ```
//! M_F⁻¹ Ûᵀ M̂ q̈ is the rigid-body acceleration of the same momentum as q̈, which is the load on the component over its inertia.

use faer::linalg::solvers::Solve;
use faer::{Mat, Side};
use supel_runtime::{Coordinate, Matrix, RigidBodyModes, Superelement};

use crate::dense::{self, unpacked};
use crate::model::Site;

/// One of the matrices.
pub(super) struct Transformation {
    /// Its name in OUTPUT4.
    pub(super) name: &'static str,
    /// How the name of its Matrix Market file ends.
    pub(super) ending: &'static str,
    /// What it is, for people.
    pub(super) content: &'static str,
    /// Its rows by the coordinates of the superelement.
    pub(super) matrix: Matrix,
}

/// The matrices that a superelement has: no forces by accelerations without a mass, none without an interface, no resultants where the interface has no nodes, no acceleration of the
/// centre of mass where that is not known.
pub(super) fn transformations(superelement: &Superelement) -> Vec<Transformation> {
    if superelement.n_interface() == 0 {
        return Vec::new();
    }
    let tensors = superelement.tensors();
    let of = |matrix: &Matrix| Matrix::from_fn(superelement.n_interface(), matrix.cols(), |i, j| matrix[(i, j)]);
    let sources = [
        (ACCELERATION, Some(&tensors.mass).filter(|mass| mass.rows() > 0)),
        (VELOCITY, tensors.damping.as_ref()),
        (DISPLACEMENT, Some(&tensors.stiffness)),
    ];
    let lever = lever(superelement);
    let mut all = Vec::new();
    for ([own, net], matrix) in sources {
        let Some(rows) = matrix.map(of) else { continue };
        let resultant = lever.as_ref().map(|lever| resultant(lever, &rows));
        all.push(named(own, rows));
        all.extend(resultant.map(|resultant| named(net, resultant)));
    }
    let centre = acceleration_of_centre(superelement);
    all.extend(centre.map(|matrix| named(OF_CENTRE, matrix)));
    all
}

type Words = [&'static str; 3];

const ACCELERATION: [Words; 2] = [
    ["IFLTMA", "ltm-acceleration.mtx", "forces on the interface by accelerations"],
    ["NETLTMA", "net-ltm-acceleration.mtx", "resultant of the forces on the interface by accelerations"],
];
const VELOCITY: [Words; 2] = [
    ["IFLTMV", "ltm-velocity.mtx", "forces on the interface by velocities"],
    ["NETLTMV", "net-ltm-velocity.mtx", "resultant of the forces on the interface by velocities"],
];
const DISPLACEMENT: [Words; 2] = [
    ["IFLTMD", "ltm-displacement.mtx", "forces on the interface by displacements"],
    ["NETLTMD", "net-ltm-displacement.mtx", "resultant of the forces on the interface by displacements"],
];
const OF_CENTRE: Words = ["CGATM", "cg-atm.mtx", "acceleration of the centre of mass"];

fn named([name, ending, content]: Words, matrix: Matrix) -> Transformation {
    Transformation { name, ending, content, matrix }
}

/// R, a row for each interface coordinate; none where these are rows without nodes.
fn lever(superelement: &Superelement) -> Option<Vec<[f64; 6]>> {
    let metadata = superelement.metadata();
    let of_interface = metadata.coordinates.iter().take(superelement.n_interface());
    let motion = |coordinate: &Coordinate| match coordinate {
        Coordinate::Interface { node, direction } => {
            let position = metadata.interface_nodes[*node].position;
            Some(Site { position, direction: *direction }.rigid_motion())
        }
        _ => None,
    };
    of_interface.map(motion).collect()
}

/// Rᵀ F.
fn resultant(lever: &[[f64; 6]], rows: &Matrix) -> Matrix {
    let entry = |component: usize, j: usize| (0..rows.rows()).map(|i| lever[i][component] * rows[(i, j)]).sum();
    Matrix::from_fn(6, rows.cols(), entry)
}

/// C M_F⁻¹ Ûᵀ M̂, where Û has the six unit motions and each of them moves a mass.
fn acceleration_of_centre(superelement: &Superelement) -> Option<Matrix> {
    let (metadata, tensors) = (superelement.metadata(), superelement.tensors());
    let is_classical = metadata.model.rigid_body_modes == RigidBodyModes::Geometric && superelement.n_rigid() == 6;
    let [x, y, z] = metadata.model.mass_properties.filter(|_| is_classical)?.center_of_mass;
    let mass = unpacked(&tensors.rigid_body_mass);
    // Translations and rotations have units of their own.
    let scale: Vec<f64> = (0..6).map(|i| dense::power_of_two_root(mass[(i, i)])).collect();
    let scaled = Mat::from_fn(6, 6, |i, j| mass[(i, j)] * scale[i] * scale[j]);
    let momenta = dense::gram(unpacked(&tensors.rigid_body_modes).as_ref(), unpacked(&tensors.mass).as_ref());
    let momenta = Mat::from_fn(6, momenta.ncols(), |i, j| momenta[(i, j)] * scale[i]);
    let rigid = scaled.llt(Side::Lower).ok()?.solve(&momenta);
    let about_origin = |i: usize, j: usize| rigid[(i, j)] * scale[i];
    // (α × c) by components of α.
    let turn = [[0.0, z, -y], [-z, 0.0, x], [y, -x, 0.0]];
    let entry = |i: usize, j: usize| match turn.get(i) {
        Some(row) => about_origin(i, j) + (0..3).map(|k| row[k] * about_origin(3 + k, j)).sum::<f64>(),
        None => about_origin(i, j),
    };
    Some(Matrix::from_fn(6, tensors.mass.cols(), entry))
}
