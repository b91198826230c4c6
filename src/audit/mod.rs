//! Checks made from a superelement that was written earlier: from its file alone, or against the full matrices.
//!
//! ```text
//! K̂, M̂   r × r      as they are in the file
//! Û       r × n_r
//! ω       n_modes    rad/s
//! ```
//! A file holds some facts more than once, and they have to agree: K̂ and M̂ give the frequencies, M̂ and Û the mass and the loads of gravity, the positions of
//! the interface nodes the rigid-body modes. The identifiers are those of the report.

mod attached;
mod content;
mod damping;
mod flaw;
mod inertia_relief;
mod jobs;
mod kept_job;
mod mass;
mod model;
mod named_modes;
mod notes;
mod record;
mod recovery;
mod reproduction;
mod residual_vectors;
mod rigid_motion;
mod spectrum;
mod version;

use supel_runtime::Superelement;

use crate::error::Result;
use crate::verification;
use crate::verification::check::{Check, Verdict};
use crate::verification::preservation::Accuracy;

use content::Content;
use notes::Compared;

pub(crate) use flaw::flaw;
pub use model::{Reference, reduction_of};
pub use notes::Unvouched;
pub use record::rewritten;
pub use reproduction::reproduced;
pub(crate) use spectrum::{condition_of, negative_mass};
pub use version::{is_of_this_version, kept_job};

/// The result of an audit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Audit {
    /// The measures, in the order of their identifiers.
    pub checks: Vec<Check>,
    /// What could not be judged, one sentence each.
    pub notes: Vec<String>,
    /// Fields whose content this comparison cannot confirm.
    pub unvouched: Vec<Unvouched>,
}

impl Audit {
    /// The worst verdict of the checks.
    pub fn verdict(&self) -> Verdict {
        self.checks.iter().map(Check::verdict).fold(Verdict::Pass, Verdict::max)
    }

    /// Nothing but a note.
    pub(crate) fn unlike(note: &str) -> Self {
        Self { notes: vec![note.to_owned()], ..Self::default() }
    }

    /// What the scene accepts, M-29 to M-31, of a comparison with the full model.
    pub(crate) fn of_accuracy(compared: &verification::Compared) -> Self {
        Self { checks: compared.report.accuracy.iter().filter_map(Accuracy::check).collect(), ..Self::default() }
    }

    /// Joins this result with another one.
    pub(crate) fn joined(mut self, other: Self) -> Self {
        self.checks.extend(other.checks);
        self.notes.extend(other.notes);
        self.sorted()
    }

    /// Puts the checks in the order of their identifiers; those of one identifier stay as they were made.
    fn sorted(mut self) -> Self {
        self.checks.sort_by_key(|check| check.id);
        self
    }
}

/// Checks every part of a superelement against the rest of it.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub fn of_file(superelement: &Superelement) -> Result<Audit> {
    let content = Content::of(superelement, None)?;
    let mut audit = checked(&content)?;
    audit.checks.extend(kept_job::n_modes(&content));
    let audit = audit.sorted();
    Ok(Audit { unvouched: notes::fields(superelement, Compared::Alone), ..audit })
}

/// Checks a superelement against the rest of itself and against the reference, which also says how much rounding may change.
///
/// # Errors
/// A dense eigenproblem that does not converge.
pub fn against(superelement: &Superelement, reference: &Reference<'_>) -> Result<Audit> {
    let by_itself = checked(&Content::of(superelement, Some(reference.noise()))?)?;
    let audit = by_itself.joined(reference.against(superelement)?);
    Ok(Audit { unvouched: notes::fields(superelement, Compared::WithJob), ..audit })
}

fn checked(content: &Content<'_>) -> Result<Audit> {
    let mut audit = Audit::default();
    match content.has_mass() {
        true => audit.checks.extend(of_pencil(content)?),
        false => audit.checks.extend(of_stiffness(content)?),
    }
    audit.checks.extend(rigid_motion::declaration(content));
    audit.checks.push(kept_job::accounts(content));
    audit.checks.push(record::verdicts(content));
    audit.checks.push(record::consistent(content)?);
    audit.checks.push(kept_job::agrees(content));
    audit.checks.push(kept_job::other_version(content));
    audit.notes = notes::notes(content);
    Ok(audit.sorted())
}

/// The checks of K̂ where it is all there is.
fn of_stiffness(content: &Content<'_>) -> Result<Vec<Check>> {
    let spectrum = spectrum::Spectrum::of(content)?;
    let mut checks: Vec<Check> = rigid_motion::positions(content).into_iter().collect();
    checks.push(rigid_motion::null_space(content));
    checks.push(rigid_motion::zero_modes(content)?);
    checks.push(spectrum::block_coupling(content));
    checks.push(spectrum::symmetry(content));
    checks.push(spectrum::definiteness(content, &spectrum));
    checks.extend(recovery::rigid_motion(content));
    Ok(checks)
}

/// The checks of K̂ and M̂ together.
fn of_pencil(content: &Content<'_>) -> Result<Vec<Check>> {
    let spectrum = spectrum::Spectrum::of(content)?;
    let mut checks = vec![spectrum::modal_masses(content)?];
    checks.extend(rigid_motion::positions(content));
    checks.push(rigid_motion::null_space(content));
    checks.push(rigid_motion::energy(content, &spectrum));
    checks.push(rigid_motion::zero_modes(content)?);
    match content.is_attached() {
        true => checks.extend(attached::checks(content)?),
        false => checks.push(spectrum::block_coupling(content)),
    }
    checks.push(spectrum::frequencies(content, &spectrum));
    checks.extend(named_modes::mixing(content));
    checks.extend(named_modes::residual(content));
    checks.extend(mass::rigid_body_mass(content));
    checks.extend(mass::of_a_body(content));
    checks.extend(mass::of_inertia(content));
    checks.extend(mass::stated(content));
    checks.extend(mass::expected(content));
    checks.extend(mass::gravity(content));
    checks.extend(inertia_relief::identity(content));
    checks.extend((!content.is_attached()).then(|| residual_vectors::identity(content)).flatten());
    checks.push(spectrum::condition(content)?);
    checks.push(spectrum::symmetry(content));
    checks.push(spectrum::definiteness(content, &spectrum));
    checks.extend(recovery::rigid_motion(content));
    checks.extend(damping::of_file(content)?);
    Ok(checks)
}
