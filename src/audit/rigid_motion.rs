//! Rigid-body motion of the superelement: M-05, M-12.

use faer::{Mat, Side};
use supel_runtime::{Coordinate, RigidBodyModes};

use super::content::Content;
use super::flaw::flaw;
use super::spectrum::Spectrum;
use crate::dense;
use crate::dofs::Direction;
use crate::eigen::{Equilibrated, NO_MASS, lowest_eigenpairs, zero};
use crate::error::Result;
use crate::model::Site;
use crate::verification::check::{Check, Limits};
use crate::verification::force;
use crate::verification::limits::Judged;

/// How far the first six columns of Û, behind which mechanisms come, are from the unit motions of the interface nodes, relative to the
/// largest displacement, and where; none where there are no nodes or fewer motions.
fn distance_to_unit_motions(content: &Content<'_>) -> Option<(f64, Option<String>)> {
    let metadata = content.superelement.metadata();
    if content.n_rigid() < 6 || metadata.interface_nodes.is_empty() {
        return None;
    }
    let positions = &content.superelement.tensors().interface_positions;
    let mut rebuilt = Mat::<f64>::zeros(content.n_reduced(), 6);
    for (i, coordinate) in metadata.coordinates.iter().enumerate() {
        if let Coordinate::Interface { node, direction } = *coordinate {
            let site = Site { position: positions[node], direction: Direction::ALL[direction as usize] };
            site.rigid_motion().into_iter().enumerate().for_each(|(j, value)| rebuilt[(i, j)] = value);
        }
    }
    let mut worst = (0.0, None);
    for j in 0..6 {
        let (stored, rebuilt) = (dense::column(content.u.as_ref(), j), dense::column(rebuilt.as_ref(), j));
        let largest = rebuilt.iter().fold(1.0f64, |max, value| max.max(value.abs()));
        // Amplitudes of rigid-body modes that are coordinates have a check of their own.
        for (i, (a, b)) in stored.iter().zip(rebuilt).enumerate().take(content.n_b) {
            if dense::worse((a - b).abs() / largest, worst.0) {
                worst = ((a - b).abs() / largest, Some(format!("rigid-body mode {}, {}", j + 1, content.name_of(i))));
            }
        }
    }
    Some(worst)
}

/// Both are made from the same numbers by one multiplication.
const SAME_NUMBERS: f64 = 1e-12;

/// M-05: Û built again from the positions of the interface nodes, where it is said to be the six unit motions.
pub(super) fn positions(content: &Content<'_>) -> Option<Check> {
    if content.superelement.metadata().model.rigid_body_modes != RigidBodyModes::Geometric {
        return None;
    }
    let worst = distance_to_unit_motions(content)?;
    Some(Check {
        id: "M-05",
        name: "rigid-body modes fit the interface nodes",
        equation: "max |Û − unit motions of the positions|, relative to the largest displacement",
        value: worst.0,
        limits: Limits { engineering: SAME_NUMBERS, ..Limits::default() },
        fail_above: 1e-9,
        worst: worst.1,
    })
}

/// Whether Û are the unit motions of the nodes, or those as K knows them where coordinates are rounded.
pub(super) fn is_nearly_unit(content: &Content<'_>) -> bool {
    /// What rounded coordinates leave at most.
    const ROUNDED: f64 = 1e-2;
    distance_to_unit_motions(content).is_some_and(|(distance, _)| distance <= ROUNDED)
}

/// M-26: rigid-body modes that are said to have no geometric meaning have none.
pub(super) fn declaration(content: &Content<'_>) -> Option<Check> {
    let has_mechanisms = content.n_rigid() > 6;
    if content.superelement.metadata().model.rigid_body_modes != RigidBodyModes::Algebraic || has_mechanisms {
        return None;
    }
    let (distance, _) = distance_to_unit_motions(content)?;
    let flaws = if distance <= SAME_NUMBERS { vec!["they are the six unit motions".to_owned()] } else { Vec::new() };
    let equation = "1 where Û declared algebraic is the unit motions of the positions, else 0";
    Some(flaw("rigid-body modes are what they are said to be", equation, &flaws))
}

/// M-12: K̂ Û makes no force, as the reduction measures it.
pub(super) fn null_space(content: &Content<'_>) -> Check {
    let name = |mode: usize, at: usize| format!("rigid-body mode {}, {}", mode + 1, content.name_of(at));
    let parts = (content.k.as_ref(), content.u.as_ref());
    force::of_rigid_motion(parts, &content.force_scales(), content.force_limits(), &name)
}

/// M-05: what the stiffest rigid-body motion costs, relative to the first elastic mode.
pub(super) fn energy(content: &Content<'_>, spectrum: &Spectrum) -> Check {
    let elastic = spectrum.of_energies(content);
    let momenta = dense::product(content.m.as_ref(), content.u.as_ref());
    let forces = dense::product(content.k.as_ref(), content.u.as_ref());
    let inertia = |j: usize| dense::dot(dense::column(content.u.as_ref(), j), dense::column(momenta.as_ref(), j));
    let largest = (0..content.n_rigid()).map(inertia).fold(0.0, f64::max);
    // What a motion without inertia costs has nothing to be compared with: its forces are looked at, in M-12.
    let has_inertia = |j: &usize| content.motions.massless.ncols() == 0 || inertia(*j) > NO_MASS * largest;
    let mut worst = (0.0, None);
    for j in (0..content.n_rigid()).filter(has_inertia) {
        let (u, inertia) = (dense::column(content.u.as_ref(), j), inertia(j));
        let energy = dense::dot(u, dense::column(forces.as_ref(), j));
        let ratio = energy.abs() / (elastic * inertia);
        // None that has none by its own account is told from rounding.
        let ratio = if inertia > 0.0 { ratio } else { f64::NAN };
        if dense::worse(ratio, worst.0) {
            worst = (ratio, Some(format!("rigid-body mode {}", j + 1)));
        }
    }
    let Judged { limits, fail_above } = content.energy_limits(elastic);
    Check {
        id: "M-05",
        name: "rigid-body motion costs no energy",
        equation: "max ûᵀK̂û / (λ₁ ûᵀM̂û)",
        value: worst.0,
        limits,
        fail_above,
        worst: worst.1,
    }
}

/// M-12: with the rigid-body modes lifted to the first elastic eigenvalue no motion without energy is left.
pub(super) fn zero_modes(content: &Content<'_>) -> Result<Check> {
    let (n_r, n_massive) = (content.n_rigid(), content.n_massive());
    let motions = content.motions.massive.as_ref();
    let momenta = dense::product(content.m.as_ref(), motions);
    let mut lifted = content.k_of_pencil.clone();
    let mut is_independent = true;
    if n_massive > 0 {
        let mut gram = dense::gram(motions, momenta.as_ref());
        dense::symmetrise(&mut gram);
        let d: Vec<f64> = (0..n_massive).map(|i| dense::power_of_two_root(gram[(i, i)])).collect();
        let scaled = Mat::from_fn(n_massive, n_massive, |i, j| gram[(i, j)] * d[i] * d[j]);
        match scaled.llt(Side::Lower) {
            Ok(factor) => {
                let mut half = Mat::from_fn(n_massive, content.n_reduced(), |i, j| momenta[(j, i)] * d[i]);
                let par = faer::Par::Seq;
                faer::linalg::triangular_solve::solve_lower_triangular_in_place(factor.L(), half.as_mut(), par);
                dense::add_product(lifted.as_mut(), content.first, half.transpose(), half.as_ref());
                dense::symmetrise(&mut lifted);
            }
            Err(_) => is_independent = false,
        }
    }
    let (values, shapes) = lowest_eigenpairs(lifted.as_ref(), content.m.as_ref(), content.first, content.n_reduced())?;
    let is_zero = |j: &usize| values[*j] <= zero_level(content, dense::column(shapes.as_ref(), *j));
    let n_more = (0..values.len()).filter(is_zero).count();
    let text = format!("{} zero modes, {n_r} rigid-body modes", n_r + n_more);
    Ok(Check {
        id: "M-12",
        name: "no other motion is free",
        equation: "zero eigenvalues of (K̂, M̂) within their rounding beyond n_r",
        value: if is_independent { n_more as f64 } else { f64::NAN },
        limits: Limits::default(),
        fail_above: 0.0,
        worst: Some(if is_independent { text } else { "the rigid-body modes are not independent".to_owned() }),
    })
}

/// λ up to which a motion of unit modal mass costs no energy, by the criterion of the reduction: K̂ of a file has double precision.
fn zero_level(content: &Content<'_>, v: &[f64]) -> f64 {
    let r = content.n_reduced();
    // Where one patch holds the component, K̂_ii of its node is rounding, and no unit for the entries next to it.
    let norms = Equilibrated::of_dense(content.k.as_ref(), content.m.as_ref(), content.scale.clone());
    let row = |i: usize| (0..r).map(|j| (content.k[(i, j)] * v[j]).abs()).sum::<f64>();
    let terms: f64 = (0..r).map(|i| v[i].abs() * row(i)).sum();
    let floor = norms.stiffness_norm * norms.scaled_norm(v).powi(2);
    zero::level(0.0, f64::EPSILON * terms, f64::EPSILON * floor)
}
