//! What the file records beside its matrices: that it is whole, the verification of its making, the job: M-26.

use std::collections::BTreeSet;

use supel_runtime::{Direction, RigidBodyModes, Superelement, Verdict};

use super::content::Content;
use crate::job::Method;
use crate::verification::check::{Check, Limits};

fn flaw(name: &'static str, equation: &'static str, flaws: &[String]) -> Check {
    Check {
        id: "M-26",
        name,
        equation,
        value: flaws.len() as f64,
        limits: Limits::default(),
        fail_above: 0.0,
        worst: (!flaws.is_empty()).then(|| flaws.join(", ")),
    }
}

/// M-26: the bytes of the file are those that its content makes: nothing is hidden in it, the digest holds.
pub fn rewritten(superelement: &Superelement, bytes: &[u8]) -> Check {
    let is_same = superelement.to_bytes().is_ok_and(|sealed| sealed.bytes == bytes);
    let flaws = if is_same { Vec::new() } else { vec!["its content written again gives other bytes".to_owned()] };
    flaw("file is whole", "1 where its content written again is not the file, else 0", &flaws)
}

/// M-26: the recorded verification and the job agree with the rest.
pub(super) fn checks(content: &Content<'_>) -> Vec<Check> {
    vec![recorded(content), job(content)]
}

/// A superelement that was written although a check failed stays one.
fn recorded(content: &Content<'_>) -> Check {
    let verification = &content.superelement.metadata().verification;
    let failed = verification.checks.iter().filter(|check| check.verdict == Verdict::Fail);
    let mut flaws: Vec<String> = failed.map(|check| format!("{} failed", check.id)).collect();
    if flaws.is_empty() && verification.verdict == Verdict::Fail {
        flaws.push("not verified".to_owned());
    }
    flaw("no check failed when it was made", "number of failed checks on record", &flaws)
}

/// Method, units, interfaces and axes are those of the job kept in the file.
fn job(content: &Content<'_>) -> Check {
    let metadata = content.superelement.metadata();
    let mut flaws = Vec::new();
    if let Some(job) = &content.job {
        let method = match job.reduction.method {
            Method::CraigBampton => supel_runtime::Method::CraigBampton,
            Method::Herting => supel_runtime::Method::Herting,
        };
        if method != metadata.method {
            flaws.push("another method".to_owned());
        }
        if job.model.units != metadata.units {
            flaws.push("other units".to_owned());
        }
        let asked: BTreeSet<&str> = job.interfaces.iter().map(|interface| interface.name.as_str()).collect();
        let found: BTreeSet<&str> = metadata.interface_nodes.iter().map(|node| node.name.as_str()).collect();
        if !found.is_empty() && found != asked {
            flaws.push("other interfaces".to_owned());
        }
    }
    // No job turns the axes of an interface node, and the matrices are in the inertial frame whatever the axes.
    let inertial = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    if content.superelement.tensors().interface_frames.iter().any(|frame| *frame != inertial) {
        flaws.push("turned axes of interface nodes".to_owned());
    }
    flaw("file is what its job asks for", "number of differences to the job kept in the file", &flaws)
}

/// What the file alone cannot show.
pub(super) fn notes(content: &Content<'_>) -> Vec<String> {
    let (metadata, tensors) = (content.superelement.metadata(), content.superelement.tensors());
    let mut notes = Vec::new();
    if content.job.is_none() {
        notes.push("the job kept in the file is of another version; what it expects was not compared".to_owned());
    }
    if metadata.model.rigid_body_modes == RigidBodyModes::Algebraic && content.n_rigid() > 0 {
        notes.push("the rigid-body modes have no geometric meaning; mass and centre were not compared".to_owned());
    }
    if content.n_rigid() == 0 {
        notes.push("the component is held: no rigid-body motion ties its stiffness and mass together".to_owned());
    }
    let beyond = [
        ("damping", tensors.damping.is_some()),
        ("load_vectors", tensors.load_vectors.is_some()),
        ("recovery", tensors.recovery.is_some()),
    ];
    notes.extend(
        beyond.iter().filter(|(_, is_there)| *is_there).map(|(name, _)| format!("`{name}` needs the full model")),
    );
    let has_rotations = metadata.interface_nodes.iter().any(|node| node.dofs.iter().any(|dof| *dof >= Direction::Rx));
    if has_rotations && content.boundary == crate::modes::Boundary::FixedInterface && content.n_rigid() > 0 {
        notes.push("what couples rotations of the interface to the modes in M̂ needs the full model".to_owned());
    }
    notes
}
