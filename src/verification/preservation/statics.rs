//! Static stiffness at each interface, by direct solves with the full K and from the reduced matrices: M-17.
//!
//! ```text
//! R    n_h × m   motions of the interface: its dofs, or its six rigid motions where it has more than six dofs
//! X    n' × m    the full model with the interface moved by R and the other interfaces held
//! ```

use faer::linalg::solvers::Solve;
use faer::{Mat, MatRef, Side};

use super::super::check::{Check, Limits};
use super::super::evidence::Evidence;
use super::super::spectrum;
use super::interfaces::Interface;
use super::outcome::InterfaceStatics;
use crate::dense;
use crate::dofs::Direction;
use crate::factor::SolveOperator;
use crate::model::Site;
use crate::sparse::{absolute_energy, diagonal, product};

/// The static stiffness of every interface in both models. Interfaces without coordinates are shown dof by dof up to `shown` of them;
/// larger ones are named in `not_compared`.
pub(super) fn statics(
    evidence: &Evidence<'_>,
    interfaces: &[Interface],
    shown: usize,
    not_compared: &mut Vec<String>,
) -> Vec<InterfaceStatics> {
    let mut all = Vec::new();
    if !evidence.is_held() {
        let names = interfaces.iter().map(|interface| &interface.name);
        let why = "the component is free to move while they are held; M-17 compares the flexibility of the interface";
        not_compared.extend(names.map(|name| format!("static stiffness of {name}: {why}")));
        return all;
    }
    for interface in interfaces {
        match motions(evidence, interface, shown) {
            Some(motions) => all.push(compared(evidence, evidence.factor, interface, &motions)),
            None => not_compared.push(format!(
                "static stiffness of {}: {} dofs without coordinates have no rigid motions",
                interface.name,
                interface.dofs.len()
            )),
        }
    }
    all
}

/// Motions of an interface and what they are called.
struct Motions {
    names: Vec<String>,
    shapes: Mat<f64>,
}

fn motions(evidence: &Evidence<'_>, interface: &Interface, shown: usize) -> Option<Motions> {
    let partition = evidence.partition;
    let n_h = interface.dofs.len();
    let own = || Motions {
        names: interface.dofs.iter().map(|dof| partition.name_of(partition.n_internal + dof)).collect(),
        shapes: Mat::identity(n_h, n_h),
    };
    if n_h <= 6 {
        return Some(own());
    }
    let sites: Option<Vec<Site>> =
        interface.dofs.iter().map(|dof| partition.dofs[partition.n_internal + dof].site).collect();
    let Some(sites) = sites else { return (n_h <= shown).then(own) };
    let centre = [0, 1, 2].map(|axis| sites.iter().map(|site| site.position[axis]).sum::<f64>() / n_h as f64);
    let rigid = |site: &Site| site.rigid_motion_about(centre);
    let rows: Vec<[f64; 6]> = sites.iter().map(rigid).collect();
    // A straight row of translations does not move when it turns about itself.
    let moves = |motion: &usize| rows.iter().any(|row| row[*motion] != 0.0);
    let kept: Vec<usize> = (0..6).filter(moves).collect();
    Some(Motions {
        names: kept.iter().map(|motion| Direction::ALL[*motion].to_string()).collect(),
        shapes: Mat::from_fn(n_h, kept.len(), |i, j| rows[i][kept[j]]),
    })
}

fn compared(
    evidence: &Evidence<'_>,
    factor: &dyn SolveOperator,
    interface: &Interface,
    motions: &Motions,
) -> InterfaceStatics {
    let (full, uncondensed) = full_stiffness(evidence, factor, interface, motions.shapes.as_ref());
    let reduced = reduced_stiffness(evidence, interface, motions.shapes.as_ref());
    // A free mass has no stiffness to be measured by; it takes the largest of its interface, or of the component where the whole
    // interface is free: what the correction of (24) rounds there is a motion of the component.
    let largest_of = |sizes: &[f64]| sizes.iter().fold(0.0f64, |max, value| max.max(*value));
    let largest = match largest_of(&uncondensed) {
        0.0 => largest_of(&diagonal(&evidence.partition.stiffness)),
        largest => largest,
    };
    let own = |i: usize| if uncondensed[i] > 0.0 { uncondensed[i] } else { largest };
    let mut relative_difference = 0.0;
    for j in 0..full.ncols() {
        for i in 0..full.nrows() {
            let size = (own(i) * own(j)).sqrt();
            let difference = (full[(i, j)] - reduced[(i, j)]).abs();
            if difference != 0.0 && dense::worse(difference / size, relative_difference) {
                relative_difference = difference / size;
            }
        }
    }
    let unit = evidence.partition.scaling.stiffness_unit();
    let table = |a: &Mat<f64>| (0..a.nrows()).map(|i| (0..a.ncols()).map(|j| a[(i, j)] * unit).collect()).collect();
    InterfaceStatics {
        interface: interface.name.clone(),
        dofs: motions.names.clone(),
        full: table(&full),
        reduced: table(&reduced),
        relative_difference,
    }
}

/// Share of its terms that an energy keeps at least where it is one.
const CANCELLED: f64 = 1e-10;

/// XᵀKX with the interior at rest, and its diagonal while the interior was still held.
///
/// X comes from solves of its own and one step of refinement with the residual of the full K; neither the constraint
/// modes nor their correction take part.
fn full_stiffness(
    evidence: &Evidence<'_>,
    factor: &dyn SolveOperator,
    interface: &Interface,
    motions: MatRef<'_, f64>,
) -> (Mat<f64>, Vec<f64>) {
    let partition = evidence.partition;
    let (n_i, n) = (partition.n_internal, partition.n_dofs());
    let mut x = Mat::zeros(n, motions.ncols());
    for (row, dof) in interface.dofs.iter().enumerate() {
        for j in 0..motions.ncols() {
            x[(n_i + dof, j)] = motions[(row, j)];
        }
    }
    let forces = product(&partition.stiffness, x.as_ref());
    let held = dense::gram(x.as_ref(), forces.as_ref());
    let moved = x.clone();
    for _ in 0..2 {
        let mut unbalanced = product(&partition.stiffness, x.as_ref()).as_ref().subrows(0, n_i).to_owned();
        factor.solve_in_place(unbalanced.as_mut());
        let mut internal = x.as_mut().subrows_mut(0, n_i);
        internal -= &unbalanced;
    }
    let mut stiffness = dense::gram(x.as_ref(), product(&partition.stiffness, x.as_ref()).as_ref());
    dense::symmetrise(&mut stiffness);
    // An interface that is the whole component moves without energy: its terms are the size then, and not what they leave.
    let terms = absolute_energy(&partition.stiffness, moved.as_ref());
    let size = |j: usize| if held[(j, j)] > CANCELLED * terms[j] { held[(j, j)] } else { terms[j] };
    (stiffness, (0..held.ncols()).map(size).collect())
}

/// Rᵀ(K̂_hh − K̂_hη K̂_ηη⁻¹ K̂_ηh)R.
fn reduced_stiffness(evidence: &Evidence<'_>, interface: &Interface, motions: MatRef<'_, f64>) -> Mat<f64> {
    let k = evidence.reduction.stiffness.as_ref();
    let n_b = evidence.partition.n_interface();
    let (n_h, n_eta) = (interface.dofs.len(), k.nrows() - n_b);
    let mut condensed = Mat::from_fn(n_h, n_h, |i, j| k[(interface.dofs[i], interface.dofs[j])]);
    let coupling = Mat::from_fn(n_eta, n_h, |i, j| k[(n_b + i, interface.dofs[j])]);
    if coupling.norm_max() > 0.0
        && let Ok(factor) = k.submatrix(n_b, n_b, n_eta, n_eta).to_owned().llt(Side::Lower)
    {
        let answer = factor.solve(&coupling);
        dense::add_product(condensed.as_mut(), -1.0, coupling.transpose(), answer.as_ref());
    }
    let mut stiffness = dense::product(motions.transpose(), dense::product(condensed.as_ref(), motions).as_ref());
    dense::symmetrise(&mut stiffness);
    stiffness
}

/// M-17.
pub(super) fn check(evidence: &Evidence<'_>, statics: &[InterfaceStatics]) -> Option<Check> {
    let mut worst = (0.0, None);
    for interface in statics {
        if dense::worse(interface.relative_difference, worst.0) {
            worst = (interface.relative_difference, Some(interface.interface.clone()));
        }
    }
    // Both sides are sums of the same terms before they cancel.
    let limits = Limits { engineering: 1e-10, ..spectrum::zero_level(evidence) };
    (!statics.is_empty()).then(|| Check {
        id: "M-17",
        name: "static stiffness of the interfaces is preserved",
        equation: "max |K_full − K_reduced|_ij / √(K_ii K_jj), the other interfaces held",
        value: worst.0,
        limits,
        fail_above: limits.value().max(1e-6),
        worst: worst.1,
    })
}
