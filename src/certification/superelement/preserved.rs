//! A foreign superelement at its interface: statics, frequencies under other boundaries and responses, as of a reduction of our own.

use faer::Mat;

use super::foreign::Foreign;
use super::judged::rigid;
use crate::dense;
use crate::eigen::Spectral;
use crate::error::Result;
use crate::factor::Analysis;
use crate::job::Job;
use crate::modes::Component;
use crate::partition::{InterfaceNode, Partition};
use crate::reduction::{Projection, Reduction};
use crate::sparse::product;
use crate::verification::check::Check;
use crate::verification::preservation::{Preservation, Unmade, unmade_check};
use crate::verification::{self, Evidence};

/// Share of rigid-body motion that amplitudes may have at the interface's side.
const BY_INTERFACE: f64 = 1e-6;

/// Compares at the interface; what could not be compared is a sentence of its own.
///
/// # Errors
/// No memory; a dense eigenproblem that does not converge.
pub fn preserved(
    own: &Evidence<'_>,
    analysis: &Analysis,
    foreign: &Foreign,
    job: &Job,
) -> Result<(Preservation, Vec<Check>)> {
    let Evidence { partition, factor, rigid: motions, constraint, .. } = *own;
    let component = Component::new(partition, analysis, factor, motions, Some(constraint));
    let found = rigid(component, foreign)?;
    let amplitudes = found.coordinates.as_ref().subrows(foreign.n_b, foreign.n_reduced() - foreign.n_b);
    let modal = dense::product(foreign.basis.as_ref().subcols(foreign.n_b, amplitudes.nrows()), amplitudes);
    let masses = dense::dots(modal.as_ref(), product(&partition.mass, modal.as_ref()).as_ref());
    let beside = dense::worst(masses.into_iter().map(|mass| mass.max(0.0).sqrt()).chain(found.left));
    // As far as the digits of the basis tell; what they leave of rigid-body motion is a matter of M-11.
    let by_interface = BY_INTERFACE.max(foreign.of_digits().min(MOST_EXCUSED[1]));
    if dense::worse(beside, by_interface) {
        let why = "the motion of its interface alone does not carry the component as a rigid body";
        let what = "statics, other boundaries and responses";
        let report = Preservation { not_compared: vec![format!("{what}: {why}")], ..Preservation::default() };
        let unmade = Unmade { what: format!("{what}: {why}"), is_of_reduced: false };
        return Ok((report, unmade_check(&[unmade]).into_iter().collect()));
    }
    let n_b = foreign.n_b;
    let reduction = Reduction {
        stiffness: foreign.stiffness.given.clone(),
        mass: foreign.mass.given.clone(),
        modal_mass: None,
        rigid_body_modes: Mat::from_fn(foreign.n_reduced(), motions.count(), |i, j| {
            if i < n_b { motions.modes[(partition.n_internal + i, j)] } else { 0.0 }
        }),
        gravity: None,
        loads: Mat::zeros(foreign.n_reduced(), 0),
        matrices: Vec::new(),
        cleared: Mat::zeros(n_b, foreign.n_reduced() - n_b),
        measured: Projection::default(),
        ..own.reduction.clone()
    };
    let evidence = Evidence { reduction: &reduction, unseen: &[], ..*own };
    let mut compared = verification::preservation_of_file((&evidence, own), analysis, job)?;
    // Its leading coordinates are not what a smaller superelement of its maker would have.
    compared.report.size_errors.clear();
    let top = job
        .scene
        .as_ref()
        .and_then(|scene| scene.band_hz)
        .map_or(f64::INFINITY, |[_, to]| partition.scaling.eigenvalue(to));
    let digits = Digits::of(partition, foreign, top)?;
    compared.checks.iter_mut().for_each(|check| digits.excuse(check));
    if compared.unmade.iter().any(|unmade| unmade.is_of_reduced) {
        let unmade = compared.checks.iter_mut().filter(|check| check.id == "M-33");
        unmade.for_each(|check| check.fail_above = Check::AT_LIMIT);
    }
    Ok((compared.report, compared.checks))
}

/// What the digits of K̂ and M̂ may make of comparisons.
struct Digits {
    /// Of an eigenvalue, relatively, whichever node of the interface is held.
    of_eigenvalue: f64,
    /// Of a stiffness, relative to that before condensation.
    of_stiffness: f64,
}

/// Relative change of an eigenvalue from which on it is that of rigid-body motion.
const FREE: f64 = 0.1;
/// The most that digits may excuse without a warning, and at all.
const MOST_EXCUSED: [f64; 2] = [1e-3, 1e-2];

impl Digits {
    /// Of every mode up to λ of `top`, free and with one node of the interface held at a time.
    fn of(partition: &Partition, foreign: &Foreign, top: f64) -> Result<Self> {
        let Foreign { stiffness, mass, n_b, .. } = foreign;
        if !foreign.has_few_digits() {
            return Ok(Self { of_eigenvalue: 0.0, of_stiffness: 0.0 });
        }
        let quotient = |i: usize| stiffness.given[(i, i)] / mass.given[(i, i)];
        let quotients = (0..foreign.n_reduced()).map(quotient).filter(|lambda| *lambda > 0.0 && lambda.is_finite());
        let least = quotients.fold(f64::INFINITY, f64::min);
        let mut of_eigenvalue = 0.0f64;
        for held in std::iter::once(Vec::new()).chain(held_nodes(partition)) {
            let moving: Vec<usize> = (0..foreign.n_reduced()).filter(|at| !held.contains(at)).collect();
            let [k, m] = [stiffness, mass].map(|pair| dense::part(pair.given.as_ref(), &moving));
            let Some(spectral) = Spectral::if_definite(k.as_ref(), m.as_ref(), least)? else { continue };
            for (mode, lambda) in
                spectral.eigenvalues().into_iter().enumerate().take_while(|(_, lambda)| *lambda <= top)
            {
                let mut q = vec![0.0; foreign.n_reduced()];
                moving.iter().zip(spectral.eigenvector(mode)).for_each(|(at, value)| q[*at] = value);
                // Rigid-body motion has energy of digits alone, and no frequency that could be off.
                let change = foreign.changed_by_digits(lambda, &q);
                if change < FREE {
                    of_eigenvalue = of_eigenvalue.max(change);
                }
            }
        }
        Ok(Self { of_eigenvalue, of_stiffness: *n_b as f64 * stiffness.rounding[0].max(stiffness.rounding[1]) })
    }

    /// Widens the limits of a check by what digits may make of it.
    fn excuse(&self, check: &mut Check) {
        let data = match check.id {
            "M-17" => self.of_stiffness,
            "M-24" => dense::NOISE_FACTOR * self.of_eigenvalue,
            _ => return,
        };
        let [limit, all] = MOST_EXCUSED.map(|most| data.min(most));
        check.limits.data = check.limits.data.max(limit);
        check.fail_above = check.fail_above.max(all);
    }
}

/// The interface dofs of each node, of which one at a time is held.
fn held_nodes(partition: &Partition) -> Vec<Vec<usize>> {
    let mut next = 0;
    let of_node = |node: &InterfaceNode| {
        // A node without directions is a list of rows.
        let n_dofs = if node.directions.is_empty() { node.n_nodes } else { node.directions.len() };
        next += n_dofs;
        (next - n_dofs..next).collect()
    };
    partition.interface.iter().map(of_node).collect()
}
