//! From the matrices of a superelement to a component.
//!
//! The file's coordinates are q = (displacement and rotation of each node in the inertial frame; η). Those of the component
//! without deformation are ΔU_j and η', with
//!
//! q = A (ΔU; η'), A = [D, 0; N P, I], D_j = [I, −x̃_j; 0, I] (the corrected (92)), P the mean over the nodes.
//!
//! N is the part of the geometric rigid-body modes in the modal amplitudes. It is zero for every basis whose interface
//! nodes carry the rigid-body motion, (24); Rubin's in Herting's variables where the internal stiffness is singular has
//! rigid-body amplitudes, which must not grow with the motion: η' is what they differ from the mean of the nodes.

use alloc::vec::Vec;

use super::acts_on::ActsOn;
use super::dense;
use super::error::ComponentError;
use super::frame_condition::{FloatingFrame, FrameRounding};
use super::identity::Identity;
use super::load_map::LoadVectors;
use super::measures::Measures;
use super::modal_component::{Matrices, ModalComponent};
use super::recovery_map::RecoveryMap;
use super::weight::Weight;
use crate::coordinate::Coordinate;
use crate::direction::Direction;
use crate::elementary::sqrt;
use crate::matrix::Matrix;
use crate::metadata::{Flag, MOTIONS, RigidBodyModes};
use crate::motion::{
    IDENTITY_3, IDENTITY_6, Matrix6, Vector3, Vector6, ZERO_3, blocks, dot, multiply_6, skew, transposed_times_6,
};
use crate::superelement::Superelement;

/// Largest force that a rigid-body motion may make, relative to the sum of the magnitudes of its parts; where one node just holds the
/// component, with those of its inertia in the first mode.
///
/// Matrices in full precision give 1e-14; ones printed with six digits give 1e-6, and a component of those is free, too.
/// One that is held by its stiffness gives a number of order one; on one node, one whose mount has more than 0.3 % of the first mode's
/// frequency is refused.
const FREE: f64 = 1e-5;

/// Forces of rigid-body motion below this are rounding, also in matrices that were printed with twelve digits.
const UNDAMPED: f64 = 1e-10;

/// The damping in proportion to a stiffness has its residual; forces this much larger are not rounding.
const ABOVE_THE_STIFFNESS: f64 = 10.0;

/// Smallest pivot of the rigid-body mass scaled to unit diagonal: of a body ten thousand times its size away from the
/// origin.
const SMALLEST_PIVOT: f64 = 1e-9;

impl ModalComponent {
    /// A component with motion-based measures of deformation.
    ///
    /// # Errors
    ///
    /// The errors of [`with_measures`](Self::with_measures).
    pub fn new(superelement: &Superelement, frame: FloatingFrame) -> Result<Self, ComponentError> {
        Self::with_measures(superelement, frame, Measures::MotionBased)
    }

    /// A component of `superelement`; costs O(r³).
    ///
    /// # Errors
    ///
    /// [`ComponentError`]: a preloaded stiffness; interface nodes without all six dofs, bare interface rows, no interface node at all; several
    /// bodies in one superelement or one that is held; a mass that leaves the mass-weighted floating frame undefined.
    ///
    /// Source: paper, eq. (92) and the remark after (93); section 2.4 of the corrections.
    pub fn with_measures(
        superelement: &Superelement,
        frame: FloatingFrame,
        measures: Measures,
    ) -> Result<Self, ComponentError> {
        check_interface(superelement)?;
        let tensors = superelement.tensors();
        let positions = tensors.interface_positions.clone();
        let (n_modal, n_nodal) = (superelement.n_modal(), 6 * positions.len());
        let shifts: Vec<Matrix6> = positions.iter().map(shift).collect();
        let in_modes = rigid_amplitudes(superelement);
        let rigid_modes = [shifts.as_flattened(), &in_modes].concat();
        let magnitudes = magnitudes(&tensors.stiffness, superelement);
        let units: Vec<f64> = magnitudes.iter().step_by(magnitudes.len().isqrt() + 1).copied().collect();
        let (residual, motion) = rigid_force(&tensors.stiffness, &magnitudes, &units, &rigid_modes);
        if residual > FREE {
            return Err(ComponentError::NotFree { motion: MOTIONS[motion], residual, limit: FREE });
        }
        let change = change_of_coordinates(&shifts, &in_modes, Measures::MotionBased);
        let nodal = Matrices::new(superelement, &change);
        let rigid = vec![IDENTITY_6; positions.len()];
        let mut frame = match frame {
            FloatingFrame::MassWeighted => times(&nodal.mass, &with_zeros(&rigid, n_modal)),
            FloatingFrame::Rigid => with_zeros(&rigid, n_modal),
        };
        dense::apply_to_rows(&normalisation(&dense::block_sum(&frame, rigid.iter()))?, &mut frame);
        let (measured, rigid, change) = match measures {
            Measures::MotionBased => (None, rigid, change),
            Measures::Classical => {
                let change = change_of_coordinates(&shifts, &in_modes, measures);
                // Y of the classical measures is D⁻ᵀY: the same condition to first order.
                for (rows, shift) in frame[..n_nodal].as_chunks_mut::<6>().0.iter_mut().zip(&shifts) {
                    *rows = dense::turned_rows(&unshifted(shift), rows);
                }
                (Some(Matrices::new(superelement, &change)), shifts, change)
            }
        };
        let matrices = measured.as_ref().unwrap_or(&nodal);
        let momenta = times(&matrices.mass, &with_zeros(&rigid, n_modal));
        let gravity = match &tensors.gravity {
            Some(gravity) => transposed_product(&change, gravity),
            None => momenta.iter().map(|row| [row[0], row[1], row[2]]).collect(),
        };
        let damping_is_symmetric = matrices.damping.as_ref().is_none_or(|c| dense::is_symmetric(c, n_nodal + n_modal));
        let rigid_mass = dense::block_sum(&momenta, rigid.iter());
        Ok(Self {
            identity: Identity::new(),
            measures,
            n_modal,
            weight: Weight::of(&gravity, &rigid, &rigid_mass),
            rigid_mass,
            recovery: tensors.recovery.as_ref().map(|recovery| RecoveryMap::new(recovery, &change)),
            loads: load_vectors(superelement, &change),
            validity: superelement.metadata().validity.clone(),
            rigid_motion_residual: residual,
            frame_rounding: FrameRounding::new(&frame, &positions),
            damping_is_symmetric,
            damping_acts_on: damping_acts_on(superelement, &rigid_modes, residual),
            positions,
            nodal,
            measured,
            rigid,
            momenta,
            frame,
            gravity,
        })
    }
}

impl Matrices {
    /// AᵀK̂A, AᵀM̂A and AᵀĈA.
    fn new(superelement: &Superelement, change: &[f64]) -> Self {
        let tensors = superelement.tensors();
        Self {
            stiffness: congruence(&tensors.stiffness, change),
            mass: congruence(&tensors.mass, change),
            damping: tensors.damping.as_ref().map(|damping| congruence(damping, change)),
        }
    }
}

fn check_interface(superelement: &Superelement) -> Result<(), ComponentError> {
    let metadata = superelement.metadata();
    if metadata.flags.contains(&Flag::Preloaded) {
        return Err(ComponentError::Preloaded);
    }
    if metadata.flags.contains(&Flag::StiffnessOnly) {
        return Err(ComponentError::NoMass);
    }
    let is_row = |coordinate: &&Coordinate| matches!(coordinate, Coordinate::InterfaceRow { .. });
    let count = metadata.coordinates.iter().filter(is_row).count();
    if count > 0 {
        return Err(ComponentError::InterfaceRows { count });
    }
    if metadata.interface_nodes.is_empty() {
        return Err(ComponentError::NoInterfaceNodes);
    }
    for (node, interface) in metadata.interface_nodes.iter().enumerate() {
        let missing: Vec<Direction> = Direction::ALL.into_iter().filter(|d| !interface.dofs.contains(d)).collect();
        if !missing.is_empty() {
            return Err(ComponentError::MissingDofs { node, name: interface.name.clone(), missing });
        }
    }
    match superelement.n_rigid() {
        found @ 7.. => Err(ComponentError::Mechanism { found }),
        _ => Ok(()),
    }
}

/// D = [I, −x̃; 0, I].
fn shift(position: &Vector3) -> Matrix6 {
    blocks(&IDENTITY_3, &skew(&position.map(|x| -x)), &ZERO_3, &IDENTITY_3)
}

/// D⁻¹ = [I, x̃; 0, I].
fn unshifted(shift: &Matrix6) -> Matrix6 {
    core::array::from_fn(|i| core::array::from_fn(|j| if i == j { 1.0 } else { -shift[i][j] }))
}

/// N, a row of six for each modal amplitude.
fn rigid_amplitudes(superelement: &Superelement) -> Vec<Vector6> {
    let (modes, n_nodal) = (&superelement.tensors().rigid_body_modes, superelement.n_interface());
    let geometric = superelement.metadata().model.rigid_body_modes == RigidBodyModes::Geometric && modes.cols() == 6;
    let entry = |i: usize, a: usize| if geometric { modes[(n_nodal + i, a)] } else { 0.0 };
    (0..superelement.n_modal()).map(|i| core::array::from_fn(|a| entry(i, a))).collect()
}

/// U of the nodes and zeros for the modal amplitudes, r × 6.
fn with_zeros(rigid: &[Matrix6], n_modal: usize) -> Vec<Vector6> {
    [rigid.as_flattened(), &vec![[0.0; 6]; n_modal]].concat()
}

/// On the whole motion where the damping of the file resists rigid-body motion, or makes forces on it, C U or CᵀU, by more
/// than what `residual` says of the accuracy of the stiffness.
fn damping_acts_on(superelement: &Superelement, rigid_modes: &[Vector6], residual: f64) -> ActsOn {
    let limit = UNDAMPED.max(ABOVE_THE_STIFFNESS * residual);
    let Some(damping) = &superelement.tensors().damping else { return ActsOn::Deformation };
    let transposed = Matrix::from_fn(damping.cols(), damping.rows(), |i, j| damping[(j, i)]);
    let units = units(superelement);
    let force = |c: &Matrix| rigid_force(c, &magnitudes(c, superelement), &units, rigid_modes).0;
    if force(damping).max(force(&transposed)) > limit { ActsOn::Motion } else { ActsOn::Deformation }
}

/// What the entries of a stiffness or damping A are measured by, r × r: |A|, and |A| + λ|M| for a component that one node just
/// holds, with λ the lowest quotient A_ηη / M_ηη of a modal coordinate.
///
/// There A_BB is rounding alone and cannot be compared with itself; the file says that all six motions are free, and a spring that it
/// does not know of shows by the square of its frequency over that of the first mode.
fn magnitudes(a: &Matrix, superelement: &Superelement) -> Vec<f64> {
    let (m, n_nodal) = (&superelement.tensors().mass, superelement.n_interface());
    let just_held = n_nodal == 6 && superelement.tensors().rigid_body_modes.cols() == 6;
    let quotients = (n_nodal..a.rows()).map(|i| a[(i, i)] / m[(i, i)]);
    let lowest = quotients.filter(|quotient| *quotient > 0.0 && quotient.is_finite()).reduce(f64::min);
    let inertia = lowest.filter(|_| just_held).unwrap_or(0.0);
    a.as_slice().iter().zip(m.as_slice()).map(|(a, m)| a.abs() + inertia * m.abs()).collect()
}

/// K_ii + λ M_ii with λ the largest K_jj / M_jj: by their roots forces of all kinds become comparable. The diagonal of a damping
/// will not do, which a skew matrix has not, nor that of K alone, which is rounding where one node just holds the component.
fn units(superelement: &Superelement) -> Vec<f64> {
    let (k, m) = (&superelement.tensors().stiffness, &superelement.tensors().mass);
    let quotients = (0..k.rows()).map(|i| k[(i, i)] / m[(i, i)]);
    let largest = quotients.filter(|quotient| *quotient > 0.0 && quotient.is_finite()).reduce(f64::max);
    (0..k.rows()).map(|i| k[(i, i)] + largest.unwrap_or(1.0) * m[(i, i)]).collect()
}

/// Largest force that a column of U makes, relative to the sum of the magnitudes of its parts, r × r, and that column. Each
/// row is measured by the root of its entry of `units`.
fn rigid_force(a: &Matrix, magnitudes: &[f64], units: &[f64], u: &[Vector6]) -> (f64, usize) {
    let r = u.len();
    let ratio = |column: usize| {
        let (mut force, mut parts) = (0.0_f64, 0.0_f64);
        let rows = a.as_slice().chunks_exact(r).zip(magnitudes.chunks_exact(r)).zip(units);
        for ((row, magnitudes), unit) in rows.filter(|(_, unit)| **unit > 0.0) {
            let scale = sqrt(*unit).recip();
            let terms = row.iter().zip(u).map(|(entry, motion)| scale * entry * motion[column]);
            force = force.max(terms.sum::<f64>().abs());
            parts =
                parts.max(magnitudes.iter().zip(u).map(|(entry, motion)| scale * entry * motion[column].abs()).sum());
        }
        if parts > 0.0 { force / parts } else { 0.0 }
    };
    (0..6)
        .map(|column| (ratio(column), column))
        .fold((0.0, 0), |worst, next| if next.0 > worst.0 { next } else { worst })
}

/// A, r × r; with the classical measures D is the identity and P takes the D⁻¹ of the file's coordinates.
fn change_of_coordinates(shifts: &[Matrix6], in_modes: &[Vector6], measures: Measures) -> Vec<f64> {
    let (k, n_nodal) = (shifts.len(), 6 * shifts.len());
    let r = n_nodal + in_modes.len();
    let mut change = vec![0.0; r * r];
    for (i, row) in change.chunks_exact_mut(r).enumerate() {
        row[i] = 1.0;
        for (block, shift) in row[..n_nodal].as_chunks_mut::<6>().0.iter_mut().zip(shifts) {
            let share = |n: &Vector6| n.map(|x| x / k as f64);
            match measures {
                Measures::MotionBased if i >= n_nodal => *block = share(&in_modes[i - n_nodal]),
                Measures::Classical if i >= n_nodal => {
                    *block = transposed_times_6(&unshifted(shift), &share(&in_modes[i - n_nodal]));
                }
                _ => {}
            }
        }
        if measures == Measures::MotionBased && i < n_nodal {
            row[i / 6 * 6..i / 6 * 6 + 6].copy_from_slice(&shifts[i / 6][i % 6]);
        }
    }
    change
}

/// AᵀB, as many rows as A has columns; A is mostly zeros.
fn transposed_times(change: &[f64], b: &[f64], cols: usize) -> Vec<f64> {
    let r = change.len().isqrt();
    let mut product = vec![0.0; r * cols];
    for (factors, row) in change.chunks_exact(r).zip(b.chunks_exact(cols)) {
        for (target, factor) in product.chunks_exact_mut(cols).zip(factors).filter(|(_, factor)| **factor != 0.0) {
            dense::add_scaled(target, *factor, row);
        }
    }
    product
}

/// AᵀKA; symmetric to the bit where K is.
fn congruence(k: &Matrix, change: &[f64]) -> Vec<f64> {
    let r = k.rows();
    let transposed = |a: &[f64]| -> Vec<f64> { (0..r * r).map(|i| a[i % r * r + i / r]).collect() };
    // Aᵀ(AᵀK)ᵀ = (AᵀKA)ᵀ.
    let half = transposed_times(change, k.as_slice(), r);
    let product = transposed(&transposed_times(change, &transposed(&half), r));
    if dense::is_symmetric(k.as_slice(), r) {
        let mirrored = transposed(&product);
        return product.iter().zip(&mirrored).map(|(a, b)| 0.5 * (a + b)).collect();
    }
    product
}

/// AᵀĜ, a row of three for each coordinate.
fn transposed_product(change: &[f64], gravity: &Matrix) -> Vec<Vector3> {
    transposed_times(change, gravity.as_slice(), 3).as_chunks::<3>().0.to_vec()
}

/// AᵀL, load by load.
fn load_vectors(superelement: &Superelement, change: &[f64]) -> LoadVectors {
    let names = superelement.metadata().load_names.clone();
    let Some(loads) = &superelement.tensors().load_vectors else { return LoadVectors { names, values: Vec::new() } };
    let (r, n_loads) = (loads.rows(), loads.cols());
    let product = transposed_times(change, loads.as_slice(), n_loads);
    LoadVectors { names, values: (0..n_loads * r).map(|index| product[index % r * n_loads + index / r]).collect() }
}

/// M U, a row of six for each coordinate.
fn times(mass: &[f64], rigid: &[Vector6]) -> Vec<Vector6> {
    mass.chunks_exact(rigid.len()).map(|row| dense::columns_times(rigid, row)).collect()
}

/// (YᵀU)⁻¹.
fn normalisation(product: &Matrix6) -> Result<Matrix6, ComponentError> {
    inverse_in_scale(product).ok_or_else(|| no_frame(product))
}

/// The inverse, found in the scale of the diagonal; `None` where it is singular.
fn inverse_in_scale(a: &Matrix6) -> Option<Matrix6> {
    let scale: Vector6 = core::array::from_fn(|i| sqrt(a[i][i]).recip());
    let scaled =
        |a: &Matrix6| -> Matrix6 { core::array::from_fn(|i| core::array::from_fn(|j| scale[i] * a[i][j] * scale[j])) };
    dense::inverse(&scaled(a), SMALLEST_PIVOT).map(|inverse| scaled(&inverse))
}

/// Why YᵀU is singular: the mass of a body that is only far away is not, once it is turned to the centre of mass c by
/// TᵀYᵀU T with T = [I, c̃; 0, I].
fn no_frame(product: &Matrix6) -> ComponentError {
    let mass = (product[0][0] + product[1][1] + product[2][2]) / 3.0;
    let centre = [(1, 5), (2, 3), (0, 4)].map(|(i, j)| product[i][j] / mass);
    let about = blocks(&IDENTITY_3, &skew(&centre), &ZERO_3, &IDENTITY_3);
    let turned = multiply_6(&dense::transposed(&about), &multiply_6(product, &about));
    if inverse_in_scale(&turned).is_none() {
        return ComponentError::MasslessMotion;
    }
    let hidden = |a: usize| product[a][a] / turned[a][a];
    let axis = (3..6).fold(3, |most, axis| if hidden(axis) > hidden(most) { axis } else { most });
    ComponentError::FarFromOrigin {
        distance: sqrt(dot(&centre, &centre)),
        radius: sqrt(turned[axis][axis] / mass),
        limit: sqrt(SMALLEST_PIVOT).recip(),
    }
}
