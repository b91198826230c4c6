//! A superelement against the full matrices of its job.
//!
//! ```text
//! K, M    n' × n'   of the partition
//! K − σM  n' × n'   factored whole, σ < 0: no block of the interface, no constraint modes, no shift at zero
//! Q       n' × n_r  zero modes found by inverse iteration, also where coordinates are known
//! U       n' × k    static answers to loads on the interface, by conjugate gradients on K
//! X       n' × m    elastic modes by the other eigensolver
//! ```
//! Nothing here uses the factor of K_II at shift zero that the reduction rests on. An interior in equilibrium is
//! Ψ_S u_B, so U and Q show K̂_BB and M̂_BB without constraint modes: UᵀKU = U_Bᵀ K̂_BB U_B and likewise M̂.

mod full;
mod identity;
mod modes;
mod scaled;
mod statics;

use supel_runtime::Superelement;

use super::Audit;
use crate::error::Result;
use crate::factor::Analysis;
use crate::output::InputFacts;
use crate::partition::Partition;

use full::Full;
use scaled::Scaled;

/// Compares a superelement with the full matrices.
///
/// # Errors
/// K − σM is not definite; an eigensolver fails.
pub fn against_model(superelement: &Superelement, partition: &Partition, facts: &InputFacts) -> Result<Audit> {
    let mut audit = Audit::default();
    audit.checks.push(identity::digests(superelement, facts));
    audit.checks.push(identity::interface(superelement, partition));
    if superelement.n_interface() != partition.n_interface() {
        audit.notes.push("the interface of the job has another number of dofs: nothing else was compared".to_owned());
        return Ok(audit.sorted());
    }
    let scaled = Scaled::of(superelement, partition)?;
    let analysis = Analysis::new(partition.pencil())?;
    let full = Full::new(partition, &analysis)?;
    audit.checks.push(statics::rigid_body_count(&scaled, &full));
    if scaled.u.ncols() == full.rigid.count() {
        let witness = modes::Witness::of(superelement, &scaled, &full)?;
        audit.checks.push(witness.backward_error());
        audit.checks.push(witness.frequencies(&scaled));
        audit.checks.push(witness.count(&scaled)?);
        if scaled.n_b == 0 {
            audit.notes.push("no interface: its statics and its rigid-body motions were not compared".to_owned());
            return Ok(audit.sorted());
        }
        audit.checks.extend(statics::rigid_body_modes(&scaled, &full));
        let answers = statics::Answers::of(&scaled, &full)?;
        audit.checks.push(statics::solves(&full, &answers));
        audit.checks.push(statics::stiffness(&scaled, &full, &answers));
        audit.checks.push(statics::mass(&scaled, &full, &answers));
        audit.checks.extend(statics::gravity(&scaled, &full, &answers));
        match witness.shapes(&scaled, &full, &answers) {
            Some(check) => audit.checks.push(check),
            None => {
                audit.notes.push("rounding of the stiffness leaves the shapes of its modes open: not compared".into())
            }
        }
    } else {
        audit.notes.push("the model is held or free in another way: nothing else was compared".to_owned());
    }
    Ok(audit.sorted())
}
