//! The component as a rigid body, in the user's units.

use faer::MatRef;
use supel_runtime::Matrix;

use super::results::Results;
use crate::error::Warning;
use crate::report::{EffectiveMass, Grounding, MassProperties, MassRoute, RigidBodyEvidence};
use crate::verification::{self, Evidence, Restraint};

/// What verification found of it.
pub(super) fn evidence(results: &Results<'_>) -> RigidBodyEvidence {
    let found = &results.findings.rigid_body;
    let scaling = results.evidence.partition.scaling;
    let grounding = found.grounding.iter().map(|direction| Grounding {
        direction: direction.direction.clone(),
        energy_ratio: direction.energy_ratio,
        force_ratio: direction.force_ratio,
        worst: direction.worst.clone(),
    });
    RigidBodyEvidence {
        mass_routes: mass_routes(results),
        // Rounding may leave a zero eigenvalue on either side of zero.
        frequencies_hz: found.eigenvalues.iter().map(|l| scaling.hertz(l.abs())).collect(),
        grounding: grounding.collect(),
        effective_mass: effective_mass(results),
    }
}

fn mass_routes(results: &Results<'_>) -> Vec<MassRoute> {
    let mut routes = Vec::new();
    if let Some(found) = &results.findings.rigid_body.routes {
        let by =
            [("geometry", &found.geometry), ("stiffness", &found.stiffness), ("eigenvectors", &found.eigenvectors)];
        for (route, m_f) in by {
            routes.push(MassRoute { route, properties: mass_properties(results, m_f.as_ref()) });
        }
    }
    if let Some(expect) = &results.job().model.expect {
        let properties = MassProperties { mass: expect.mass, cg: expect.cg, inertia: None };
        routes.push(MassRoute { route: "expected", properties });
    }
    routes
}

/// Mass, centre and inertia from M_F of the six unit motions, 6 × 6 in scaled units; nothing where it is not that.
pub(super) fn mass_properties(results: &Results<'_>, m_f: MatRef<'_, f64>) -> MassProperties {
    let unit = results.evidence.partition.scaling.mass_unit();
    // The motions of mechanisms come after the six of the body.
    let n = m_f.nrows().min(6);
    let m_f = Matrix::from_fn(n, n, |i, j| m_f[(i, j)] * unit);
    supel_runtime::mass_properties(&m_f).map_or_else(MassProperties::default, |known| MassProperties {
        mass: Some(known.mass),
        cg: Some(known.center_of_mass),
        inertia: Some(known.inertia),
    })
}

fn effective_mass(results: &Results<'_>) -> Vec<EffectiveMass> {
    let Some(found) = &results.findings.rigid_body.effective_mass else {
        return Vec::new();
    };
    let mut cumulated = vec![0.0; found.directions.len()];
    let row = |(mode, share): (usize, &Vec<f64>)| {
        cumulated.iter_mut().zip(share).for_each(|(sum, share)| *sum += share);
        EffectiveMass { mode: mode + 1, share: share.clone(), cumulated: cumulated.clone() }
    };
    found.shares.iter().enumerate().map(row).collect()
}

/// A warning where a spring, a support left in K or wrong coordinates hold what should be free.
pub(super) fn grounded(results: &Results<'_>) -> Option<Warning> {
    let grounding = &results.findings.rigid_body.grounding;
    let worst = grounding
        .iter()
        .filter(|g| g.restraint == Restraint::Grounded)
        .max_by(|a, b| a.energy_ratio.total_cmp(&b.energy_ratio))?;
    let at = worst.worst.as_ref().map(|dof| format!("; the largest force is at {dof}")).unwrap_or_default();
    Some(Warning {
        code: "W-GROUNDED",
        message: format!(
            "the component is nearly free but not quite: {} has {:.1e} of the energy of the first elastic mode{at}; look \
             for a weak spring to the ground, a support or a constraint left in the stiffness, rounded coordinates, or a \
             stiffness of fewer digits than its numbers show: state `stiffness_digits` then",
            worst.direction, worst.energy_ratio
        ),
    })
}

/// What the job expects and nothing in the model could be compared with.
pub(super) fn expectation_unchecked(results: &Results<'_>) -> Option<Warning> {
    let Evidence { partition, rigid, .. } = results.evidence;
    // The motions of a free body have its mass and its centre.
    let expect = results.job().model.expect.as_ref().filter(|_| !rigid.is_classical)?;
    let lacks = verification::not_comparable(expect, partition);
    (!lacks.is_empty()).then(|| Warning {
        code: "W-EXPECT-UNCHECKED",
        message: format!("not compared with what the job expects: {}", lacks.join("; ")),
    })
}
