//! The body of the report from the results of the stages.

use super::results::Results;
use super::{expansion, mode_rows, rigid_body, scene, soft_rotation, warnings};
use crate::basis::DynamicCoordinate;
use crate::eigen::CLUSTER_GAP;
use crate::error::{Selector, Warning};
use crate::input::MatrixFacts;
use crate::input::{Faces, PatchFaces};
use crate::job::{Certify, InterfaceJob, ModeSelection, Origin};
use crate::model::RoundedCoordinates;
use crate::modes::CountedInterval;
use crate::number::{counted, quantity};
use crate::partition::{InterfaceNode, LoadFacts};
use crate::plan::Mass;
use crate::report::{
    Completeness, DroppedCoordinate, FacesReport, Generator, HeldReport, InterfacePosition, InterfaceReport,
    LoadReport, MassProperties, MatrixReport, ModelReport, PositionOrigin, ReductionReport, ReportBody, ResidualVector,
    RigidBodyModes, SkippedReport, TrustInterval,
};
use crate::rigid::ILL_CONDITIONED;
use crate::verification::Evidence;

pub(super) fn body(results: &Results<'_>) -> ReportBody {
    ReportBody {
        generator: Generator::default(),
        model: model(results),
        reduction: reduction(results),
        checks: results.checks(),
        warnings: warnings(results),
        completeness: completeness(results),
        trust_intervals: trust_intervals(results),
        rigid_body: rigid_body::evidence(results),
        preservation: results.preserved.report.clone(),
    }
}

fn skipped(results: &Results<'_>) -> Vec<SkippedReport> {
    let skipped = results.plan.skipped().into_iter();
    skipped.map(|(rule, what)| SkippedReport { rule: rule.name(), what }).collect()
}

fn model(results: &Results<'_>) -> ModelReport {
    let evidence = &results.evidence;
    let model = &evidence.partition.model;
    let stiffness = &results.input.matrices[0];
    let mut notes = results.input.notes.clone();
    notes.extend(model.findings.iter().map(ToString::to_string));
    notes.extend(warnings::refinement(results));
    notes.extend(without_gravity(results));
    let mass_properties = mass_properties(results);
    if mass_properties.mass.is_some() && evidence.partition.held.count() > 0 {
        notes.push("mass, centre and inertia are those of the whole component, held dofs included".to_owned());
    }
    ModelReport {
        n_dofs: model.n_dofs,
        n_nodes: model.n_nodes,
        n_bodies: model.n_bodies,
        held: held(results),
        stiffness: matrix(stiffness),
        mass: results.input.mass().map(matrix),
        files: results.input.files.clone(),
        mass_properties,
        rigid_body_modes: RigidBodyModes { count: evidence.rigid.count(), source: evidence.rigid.source },
        units: results.job().model.units.clone(),
        notes,
    }
}

/// What a model lacks because it is several bodies: motions that are combinations of theirs have no mass and no direction by themselves.
fn without_gravity(results: &Results<'_>) -> Option<String> {
    let (partition, reduction) = (&results.evidence.partition, &results.evidence.reduction);
    let n_bodies = partition.model.n_bodies;
    let is_meant = n_bodies > 1 && results.input.mass().is_some() && partition.sites().is_some();
    (is_meant && reduction.gravity.is_none()).then(|| {
        format!(
            "the model is {n_bodies} bodies: mass properties and loads of gravity are those of one free body and were not computed; \
             reduce each body by itself to have them"
        )
    })
}

fn matrix(facts: &MatrixFacts) -> MatrixReport {
    MatrixReport { n_nonzeros: facts.n_nonzeros, digits: facts.digits, digest: facts.digest.clone() }
}

fn held(results: &Results<'_>) -> Option<HeldReport> {
    let held = &results.evidence.partition.held;
    (held.count() > 0).then(|| HeldReport { n_dofs: held.count(), selections: held.selections.clone() })
}

/// The mass properties of one body; of a component that the job holds, those that it has while it is free.
fn mass_properties(results: &Results<'_>) -> MassProperties {
    let evidence = &results.evidence;
    if results.plan.mass() == Mass::NotAsked {
        return MassProperties::default();
    }
    if evidence.partition.held.count() > 0 {
        let motions = evidence.partition.model.weight.as_ref().and_then(|weight| weight.motions.as_ref());
        return motions.map_or_else(MassProperties::default, |m_f| rigid_body::mass_properties(results, m_f.as_ref()));
    }
    if let Some(m_f) = evidence.partition.mass_of_preloaded_body() {
        return rigid_body::mass_properties(results, m_f);
    }
    if !evidence.rigid.is_classical {
        return MassProperties::default();
    }
    rigid_body::mass_properties(results, evidence.reduction.rigid_body_mass.as_ref())
}

fn reduction(results: &Results<'_>) -> ReductionReport {
    let evidence = &results.evidence;
    let basis = evidence.basis;
    let n_unseen = evidence.unseen.len();
    let is_relief = |c: &&DynamicCoordinate| matches!(c, DynamicCoordinate::InertiaRelief(_));
    let n_inertia_relief = basis.coordinates.iter().filter(is_relief).count();
    let is_rigid = |c: &&DynamicCoordinate| matches!(c, DynamicCoordinate::RigidBody(_));
    let n_rigid_body = basis.coordinates.iter().filter(is_rigid).count();
    let is_residual = |c: &&DynamicCoordinate| matches!(c, DynamicCoordinate::ResidualVector(_));
    let n_residual_vectors = basis.coordinates.iter().filter(is_residual).count();
    let is_expansion = |c: &&DynamicCoordinate| matches!(c, DynamicCoordinate::Expansion(_));
    let n_expansion_modes = basis.coordinates.iter().filter(is_expansion).count();
    ReductionReport {
        method: results.job().reduction.method,
        eigensolver: results.job().reduction.eigensolver,
        interfaces: interfaces(results),
        n_interface: evidence.partition.n_interface(),
        n_inertia_relief,
        n_modes: basis.n_dynamic()
            - n_inertia_relief
            - n_rigid_body
            - n_expansion_modes
            - n_residual_vectors
            - n_unseen,
        n_reduced: basis.n_reduced() - n_unseen,
        mass_rank: evidence.reduction.mass_rank().map(|rank| rank - n_unseen),
        modes_held: results.job().reduction.held.as_ref().map(|held| held.iter().map(|held| held.0.clone()).collect()),
        expansion: expansion::report(results),
        loads: loads(results),
        skipped: skipped(results),
        dropped: dropped(results),
        unseen: mode_rows::unseen(results),
        modes: mode_rows::modes(results),
    }
}

/// Columns that others span, then modes that nothing starts and nothing sees, with their frequencies.
fn dropped(results: &Results<'_>) -> Vec<DroppedCoordinate> {
    let Evidence { basis, unseen, partition, .. } = results.evidence;
    let spanned = basis.dropped.iter().map(|column| DroppedCoordinate {
        coordinate: column.coordinate.name(&partition.loads.facts),
        reason: format!("depends on the columns before it ({:.1e} of its length is left)", column.remaining),
    });
    let eigenvalues = results.eigenvalues();
    let unseen = unseen.iter().map(|mode| DroppedCoordinate {
        coordinate: format!("mode {}", mode.mode + 1),
        reason: format!("at {} Hz: {}", quantity(partition.scaling.hertz(eigenvalues[mode.mode]), 6), mode.reason()),
    });
    spanned.chain(unseen).collect()
}

/// One row for each load of the job, in its order.
fn loads(results: &Results<'_>) -> Vec<LoadReport> {
    let Evidence { partition, basis, answers, .. } = results.evidence;
    let report = |(load, facts): (usize, &LoadFacts)| {
        let is_kept = basis.coordinates.contains(&DynamicCoordinate::ResidualVector(load));
        let residual_vector = match (facts.has_residual_vector, is_kept) {
            (false, _) => ResidualVector::NotAsked,
            (true, true) => ResidualVector::Kept,
            (true, false) if answers.is_none() => ResidualVector::NoAnswer,
            (true, false) => ResidualVector::LeftOut,
        };
        LoadReport {
            name: facts.name.clone(),
            source: facts.source.clone(),
            digest: results.input.loads.get(&facts.name).cloned(),
            resultant: facts.resultant,
            residual_vector,
            lacking: results.findings.load_lacking.as_ref().map(|lacking| lacking[load]),
        }
    };
    partition.loads.facts.iter().enumerate().map(report).collect()
}

/// One row for each interface of the job, in its order.
fn interfaces(results: &Results<'_>) -> Vec<InterfaceReport> {
    let partition = results.evidence.partition;
    let mut rows: Vec<InterfaceReport> = Vec::new();
    for node in &partition.interface {
        let n_dofs = if node.directions.is_empty() { node.n_nodes } else { node.directions.len() };
        let origin = origin(node, &results.job().interfaces);
        let faces = |position| faces((node, position), origin, &results.input.faces);
        let at = node.position.map(|position| {
            let (faces, faces_unknown) = faces(position);
            InterfacePosition {
                node: node.label,
                position,
                origin,
                faces,
                faces_unknown,
                fit: node.fit,
                axes: node.axes,
            }
        });
        match rows.last_mut().filter(|row| row.name == node.name) {
            Some(row) => {
                row.n_nodes += node.n_nodes;
                row.n_dofs += n_dofs;
                row.at.extend(at);
            }
            None => rows.push(InterfaceReport {
                name: node.name.clone(),
                coupling: node.coupling,
                n_nodes: node.n_nodes,
                n_dofs,
                at: at.into_iter().collect(),
            }),
        }
    }
    rows
}

/// How far the mean of a patch's nodes is from the centroid of its faces, or why that is not known.
fn faces(
    (node, position): (&InterfaceNode, [f64; 3]),
    origin: PositionOrigin,
    known: &[PatchFaces],
) -> (Option<FacesReport>, Option<String>) {
    let selector = Selector::Interface(node.name.clone());
    let found = known.iter().find(|faces| origin == PositionOrigin::MeanOfNodes && faces.of == selector);
    match found.map(|found| &found.faces) {
        None => (None, None),
        Some(Faces::Unknown { reason }) => (None, Some(reason.clone())),
        Some(Faces::Known { faces, centroid, .. }) => {
            let offset = (0..3).map(|axis| (centroid[axis] - position[axis]).powi(2)).sum::<f64>();
            (Some(FacesReport { count: faces.len(), centroid: *centroid, distance: offset.sqrt() }), None)
        }
    }
}

/// Where the place of an interface node comes from.
fn origin(node: &InterfaceNode, jobs: &[InterfaceJob]) -> PositionOrigin {
    let job = jobs.iter().find(|job| job.name == node.name);
    match job.map(|job| &job.origin) {
        _ if !node.coupling.is_patch() => PositionOrigin::Node,
        Some(Origin::Point(_)) => PositionOrigin::Job,
        Some(Origin::Area) => PositionOrigin::CentroidOfFaces,
        Some(Origin::Hole) => PositionOrigin::Hole,
        Some(Origin::Sphere) => PositionOrigin::Sphere,
        Some(Origin::Centroid) | None => PositionOrigin::MeanOfNodes,
    }
}

fn warnings(results: &Results<'_>) -> Vec<Warning> {
    let evidence = &results.evidence;
    let mut warnings = results.input.warnings.clone();
    let ratio = evidence.rank.singular_ratio;
    if ratio < ILL_CONDITIONED {
        warnings.push(Warning {
            code: "W-INTERFACE-ILL",
            message: format!(
                "the interface reacts one rigid-body motion {:.0} times worse than another; digits are lost there",
                1.0 / ratio
            ),
        });
    }
    warnings.extend(rigid_body::grounded(results));
    for finding in evidence.partition.model.findings.iter().chain(&evidence.partition.findings) {
        warnings.extend(finding.warning().map(|code| Warning { code, message: finding.to_string() }));
    }
    if let Some(RoundedCoordinates { misfit: Some(misfit), .. }) = evidence.partition.fit.rounded() {
        warnings.push(Warning {
            code: "W-COORD-ROUNDED",
            message: format!(
                "the coordinates are rounded, or those of another state: by them the rotation about {} costs {:.1e} of {}, most \
                 of it at {}{}",
                misfit.rotation,
                misfit.energy,
                misfit.of,
                misfit.at,
                if evidence.rigid.count() > 0 { "; rigid-body modes were taken from the matrices" } else { "" }
            ),
        });
    }
    warnings.extend(warnings::of_motions(results));
    warnings.extend(soft_rotation::soft_rotation(results));
    warnings.extend(warnings::equal_weights(results));
    warnings.extend(warnings::penalties(results));
    warnings.extend(warnings::heavy_rows(results));
    warnings.extend(warnings::data_precision(results));
    warnings.extend(warnings::mixed_precision(results));
    warnings.extend(rigid_body::expectation_unchecked(results));
    warnings.extend(number_of_modes(results));
    warnings.extend(expansion::not_followed(results));
    warnings.extend(scene::warnings(results));
    if let Some(certificate) = evidence.certificate.filter(|certificate| certificate.doubt() > 1.0) {
        warnings.push(Warning {
            code: "W-COUNT-LIKELY",
            message: format!(
                "the Sturm count is likely, not certain: its pivots grew {:.1} times more than its signs can be trusted with",
                certificate.doubt()
            ),
        });
    }
    warnings
}

/// Why there are no more modes, and how far that is proved.
fn reason(results: &Results<'_>) -> String {
    let Some(certificate) = results.evidence.certificate else {
        return "that there is no other is not certified".to_owned();
    };
    let (n_counted, n_finite) = (certificate.n_counted, certificate.n_finite.unwrap_or(usize::MAX));
    if n_counted >= n_finite {
        return format!(
            "there is no other, since the mass matrix leaves {} finite, those of rigid-body motion included",
            counted(n_finite, "frequency", "frequencies")
        );
    }
    format!(
        "a Sturm count finds no other below {:.3e} Hz; that there is none above is not proved, since the mass matrix may leave \
         {} finite and {n_counted} are known",
        results.evidence.partition.scaling.hertz(certificate.count.sigma),
        counted(n_finite, "frequency", "frequencies")
    )
}

/// What is to be said of the number of modes.
fn number_of_modes(results: &Results<'_>) -> Option<Warning> {
    let modes = &results.evidence.retained.modes;
    let found = modes.count();
    match results.job().reduction.wanted() {
        ModeSelection::Count { count } if found < count => Some(Warning {
            code: "W-FEWER-MODES",
            message: format!(
                "{} asked for; the search ended with {found}: {}",
                counted(count, "mode was", "modes were"),
                reason(results)
            ),
        }),
        ModeSelection::UpTo { up_to_hz } => {
            let limit = modes.searched_to.filter(|limit| *limit > 0.0)?;
            let is_on_edge = |lambda: &&f64| (**lambda - limit).abs() <= CLUSTER_GAP * limit;
            let n_on_edge = modes.lambda.iter().rev().take_while(is_on_edge).count();
            (n_on_edge > 0).then(|| Warning {
                code: "W-BAND-EDGE",
                message: format!(
                    "{n_on_edge} of the modes lie on the end of the band at {up_to_hz} Hz, within {:.0e} of it; they were kept",
                    0.5 * CLUSTER_GAP
                ),
            })
        }
        ModeSelection::Count { .. } => None,
    }
}

/// The counts as frequencies.
fn trust_intervals(results: &Results<'_>) -> Vec<TrustInterval> {
    let scaling = results.evidence.partition.scaling;
    let Some(certificate) = results.evidence.certificate else {
        return Vec::new();
    };
    let interval = |counted: &CountedInterval| TrustInterval {
        from_hz: scaling.hertz(counted.from),
        to_hz: scaling.hertz(counted.to),
        kind: mode_rows::kind(certificate.boundary),
        n_counted: counted.n_counted,
        n_found: counted.n_found,
        pivot_growth: counted.growth,
    };
    certificate.intervals.iter().map(interval).collect()
}

fn completeness(results: &Results<'_>) -> Completeness {
    let of_file = results.evidence.partition.expansion.count() > 0;
    match (results.evidence.certificate, results.job().run.certify) {
        (None, _) if of_file => Completeness::NotCertified {
            reason: "they come from a file, which may leave out any others; a count knows computed modes only"
                .to_owned(),
        },
        (Some(certificate), _) => Completeness::SturmCount {
            below_hz: results.evidence.partition.scaling.hertz(certificate.count.sigma),
            n_counted: certificate.n_counted,
            n_found: certificate.n_found,
            doubt: certificate.doubt(),
        },
        (None, Certify::None) => Completeness::NotCertified { reason: "--certify none was asked".to_owned() },
        (None, Certify::Count | Certify::Full) => {
            Completeness::NotCertified { reason: "the count could not be taken".to_owned() }
        }
    }
}
