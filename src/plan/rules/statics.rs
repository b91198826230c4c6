//! Statics: what no mass, no mode and no displacement inside is needed for. K-1, K-2, K-16 to K-18.

use supel_runtime::{MatrixKind, Precision};

use crate::job::{Certify, ConstraintStorage, Job, Method, ReductionJob};
use crate::number::{bytes, counted};
use crate::plan::facts::{Facts, Hold};
use crate::plan::rule::Decision;
use crate::plan::scene::Scene;

/// Takes out of a job what equilibrium never needs: modes, damping, and matrices that act on velocities.
pub(super) fn leave_dynamics_out(scene: &Scene<'_>, job: &mut Job) {
    if !scene.is_static() {
        return;
    }
    let ReductionJob { eigensolver, .. } = job.reduction;
    job.reduction = ReductionJob { method: Method::Guyan, modes: None, inertia_relief: false, held: None, eigensolver };
    if scene.job.does_without_mass() {
        job.model.mass = None;
    }
    job.run.certify = Certify::None;
    job.damping = None;
    job.matrices.retain(|matrix| !acts_on_velocities(matrix.kind));
}

/// In which form the constraint modes are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Statics {
    /// Every column is stored.
    Stored,
    /// The factor makes columns again whenever they are needed, some at a time.
    ByFactor,
    /// As [`Self::ByFactor`]; the interface stiffness is what elimination leaves.
    Condensed,
    /// They are the rigid-body modes: the interface moves as one rigid body.
    Carried,
}

/// Bytes up to which the constraint modes are stored where no row of them is asked for.
const STORED_UP_TO: u64 = 1 << 30;

/// The form of the constraint modes of a model.
pub(in crate::plan) fn statics(scene: &Scene<'_>, facts: &Facts) -> Statics {
    let is_carried = scene.stated().is_some_and(|stated| !stated.prescribed.is_empty());
    let bytes = 8 * facts.n_internal as u64 * facts.n_interface as u64;
    match scene.job.run.constraint_modes {
        ConstraintStorage::Stored => Statics::Stored,
        // Rubin's static modes are made by a solve with all dofs, once.
        _ if facts.hold == Hold::Part => Statics::Stored,
        _ if is_carried && facts.n_interface == facts.n_rigid && facts.n_rigid > 0 => Statics::Carried,
        _ if facts.n_interface == 0 => Statics::Stored,
        // M̂ is made of constraint modes.
        _ if scene.is_static() && mass(scene) == Mass::NotAsked && !scene.recovers() => Statics::Condensed,
        ConstraintStorage::ByFactor => Statics::ByFactor,
        ConstraintStorage::Auto if scene.may_skip() && !scene.recovers() && bytes > STORED_UP_TO => Statics::ByFactor,
        ConstraintStorage::Auto => Statics::Stored,
    }
}

fn acts_on_velocities(kind: MatrixKind) -> bool {
    matches!(kind, MatrixKind::Damping | MatrixKind::Gyroscopic)
}

/// Whether the mass is part of what a run makes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Mass {
    /// It is read, reduced and checked.
    Reduced,
    /// Its file is not opened: K̂ is all there is.
    NotAsked,
}

/// Whether the mass is part of what a run makes.
pub(in crate::plan) fn mass(scene: &Scene<'_>) -> Mass {
    if scene.job.does_without_mass() { Mass::NotAsked } else { Mass::Reduced }
}

pub(in crate::plan) fn k1(scene: &Scene<'_>, _: Option<&Facts>) -> Decision {
    match (scene.is_static(), mass(scene)) {
        (true, Mass::NotAsked) => Decision::left_out(
            "the mass, modes and their counts, inertia relief, damping: the scene asks for statics alone",
        ),
        (true, Mass::Reduced) => Decision::left_out(
            "modes, their counts, damping: the scene asks for statics alone, in which gravity or other loads take the mass",
        ),
        (false, _) => Decision::kept("the scene does not say that statics is all it asks"),
    }
}

pub(in crate::plan) fn k2(scene: &Scene<'_>, facts: Option<&Facts>) -> Decision {
    match (scene.is_static(), scene.recovers(), facts) {
        (false, _, _) => Decision::kept("the scene does not say that statics is all it asks"),
        (true, true, _) => Decision::kept("`write` asks for rows of the constraint modes"),
        (true, false, _) if mass(scene) == Mass::Reduced => {
            Decision::kept("gravity or other loads take the mass, which is reduced by the constraint modes")
        }
        (true, false, None) => Decision::Open,
        (true, false, Some(facts)) => match statics(scene, facts) {
            Statics::Condensed => Decision::left_out(format!(
                "{} of the interior, and room for {}",
                counted(facts.n_interface, "solve", "solves"),
                bytes(8 * facts.n_internal as u64 * facts.n_interface as u64)
            )),
            Statics::Carried => Decision::kept("the constraint modes are rigid-body modes (K-10)"),
            Statics::Stored | Statics::ByFactor => Decision::kept("there is no interface, or the job stores the modes"),
        },
    }
}

pub(in crate::plan) fn k16(scene: &Scene<'_>, _: Option<&Facts>) -> Decision {
    match scene.recovers() {
        true => Decision::left_out("all rows of the basis but those that `write` asks for"),
        false => Decision::left_out("all rows of the basis: `write` asks for none"),
    }
}

pub(in crate::plan) fn k17(scene: &Scene<'_>, facts: Option<&Facts>) -> Decision {
    let Some(facts) = facts else { return Decision::Open };
    let size = bytes(8 * facts.n_internal as u64 * facts.n_interface as u64);
    match statics(scene, facts) {
        Statics::ByFactor => {
            Decision::left_out(format!("room for {size}: the factor makes columns when they are needed"))
        }
        Statics::Condensed => Decision::kept("there are no constraint modes to store (K-2)"),
        Statics::Carried => Decision::kept("the constraint modes are rigid-body modes (K-10)"),
        Statics::Stored => Decision::kept(format!("they take {size}, and are stored")),
    }
}

pub(in crate::plan) fn k18(scene: &Scene<'_>, _: Option<&Facts>) -> Decision {
    match scene.recovery() {
        Some(recovery) if recovery.precision == Precision::Single => {
            Decision::left_out("half the digits of the recovered rows: the job asks for single precision")
        }
        Some(_) => Decision::kept("the job asks for recovered rows in double precision"),
        None => Decision::kept(format!("{} to be stored", counted(0, "recovered row", "recovered rows"))),
    }
}
