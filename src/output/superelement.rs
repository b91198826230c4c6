//! The superelement from the results of the stages.

use std::num::NonZero;
use std::path::{Path, PathBuf};

use faer::{Mat, MatRef};
use supel_runtime::{self as file, Coordinate, Matrix, Metadata, Superelement, Tensors};

use super::recovery::{quantities, recovery};
use super::results::Results;
use crate::basis::DynamicCoordinate;
use crate::error::{Error, Result, json_value};
use crate::job::{Job, ModeSelection};
use crate::partition::{DofOrigin, Frame, OF_THE_MODEL};
use crate::plan::Mass;
use crate::verification::Evidence;
use crate::verification::check::{Check, Verdict};

/// Puts the units back and names every coordinate.
pub(super) fn superelement(results: &Results<'_>, verdict: Verdict) -> Result<Superelement> {
    let tensors = Tensors { recovery: recovery(results)?, quantities: quantities(results), ..tensors(results) };
    refuse_out_of_range(&tensors)?;
    let metadata = metadata(results, &tensors, verdict)?;
    Superelement::new(tensors, metadata)
        .map_err(|error| Error::of_superelement(&results.job().write.superelement, error))
}

/// What is finite in scaled units may leave the range of a double in the user's.
fn refuse_out_of_range(tensors: &Tensors) -> Result<()> {
    let mixing = tensors.mixing.iter().map(|mixing| ("the inertia-relief modes in the units of the matrices", mixing));
    let matrices = [("the reduced stiffness", &tensors.stiffness), ("the reduced mass", &tensors.mass)];
    let damping = tensors.damping.iter().map(|damping| ("the damping", damping));
    let further = tensors.matrices.iter().map(|matrix| ("a further matrix in the units of its coordinates", matrix));
    let loads = tensors.load_vectors.iter().map(|loads| ("a load in the units of its coordinates", loads));
    let rows = tensors.quantities.iter().map(|rows| ("a quantity in the units of its rows", rows));
    for (what, matrix) in matrices.into_iter().chain(mixing).chain(loads).chain(rows).chain(further).chain(damping) {
        if matrix.as_slice().iter().any(|value| !value.is_finite()) {
            return Err(Error::UnitRange { what, exponent: f64::MAX_EXP });
        }
    }
    if tensors.frequencies.contains(&f64::INFINITY) {
        return Err(Error::UnitRange { what: "the square of a frequency", exponent: f64::MAX_EXP });
    }
    Ok(())
}

fn tensors(results: &Results<'_>) -> Tensors {
    let evidence = &results.evidence;
    let (reduction, partition) = (evidence.reduction, evidence.partition);
    let (scaling, n_b) = (partition.scaling, partition.n_interface());
    let shape = scaling.shape_unit();
    // A coordinate's unit: one for an interface dof, that of a mass-normalised shape for a modal amplitude.
    let unit = |i: usize| if i < n_b { 1.0 } else { shape };
    let kept = results.kept();
    let rows = |a: &Mat<f64>| Matrix::from_fn(kept.len(), a.ncols(), |i, j| a[(kept[i], j)]);
    let both = |a: &Mat<f64>| Matrix::from_fn(kept.len(), kept.len(), |i, j| a[(kept[i], kept[j])]);
    let model = reduction.in_user_units(partition);
    let mut rigid_body_mass = reduction.rigid_body_mass.clone();
    rigid_body_mass *= faer::Scale(scaling.mass_unit());
    let nodes = named_nodes(results);
    let has_mass = results.plan.mass() == Mass::Reduced;
    let of_mass = |a: Matrix| if has_mass { a } else { Matrix::default() };
    Tensors {
        stiffness: both(&model.stiffness),
        mass: of_mass(both(&model.mass)),
        rigid_body_modes: rows(&model.rigid_body_modes),
        rigid_body_mass: of_mass(matrix(rigid_body_mass.as_ref())),
        interface_positions: nodes.iter().map(|node| node.position).collect(),
        interface_frames: frames(results, nodes.len()),
        frequencies: frequencies(results),
        mixing: mixing(results),
        gravity: reduction.gravity.as_ref().filter(|_| has_mass).map(|gravity| {
            rows(&Mat::from_fn(gravity.nrows(), 3, |i, j| gravity[(i, j)] * scaling.mass_unit() * unit(i)))
        }),
        load_vectors: load_vectors(results),
        matrices: model.matrices.iter().map(both).collect(),
        damping: evidence.damping.map(|damping| both(&damping.matrix)),
        ..Tensors::default()
    }
}

/// ΨᵀF in the user's units; none where the job has no loads.
fn load_vectors(results: &Results<'_>) -> Option<Matrix> {
    let (reduction, partition) = (results.evidence.reduction, results.evidence.partition);
    let (n_b, shape) = (partition.n_interface(), partition.scaling.shape_unit());
    let coordinate = |i: usize| if i < n_b { 1.0 } else { shape };
    let kept = results.kept();
    let entry = |i: usize, load: usize| {
        reduction.loads[(kept[i], load)] * partition.loads.facts[load].unit * coordinate(kept[i])
    };
    let n_loads = partition.loads.count();
    (n_loads > 0).then(|| Matrix::from_fn(kept.len(), n_loads, entry))
}

fn matrix(a: MatRef<'_, f64>) -> Matrix {
    Matrix::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)])
}

fn frequencies(results: &Results<'_>) -> Vec<f64> {
    let scaling = results.evidence.partition.scaling;
    let mut frequencies: Vec<f64> =
        results.eigenvalues().into_iter().map(|lambda| scaling.omega(lambda.max(0.0))).collect();
    // Rayleigh quotients of a repeated eigenvalue may come out a rounding apart in the wrong order.
    frequencies.sort_by(f64::total_cmp);
    frequencies
}

/// Stored dynamic modes = named modes · mixing, in the user's units; none where every column is its named mode.
fn mixing(results: &Results<'_>) -> Option<Matrix> {
    let evidence = &results.evidence;
    if evidence.basis.coordinates.iter().all(|c| matches!(c, DynamicCoordinate::FixedInterface(_))) {
        return None;
    }
    let scaling = evidence.partition.scaling;
    let mixing = evidence.basis.mixing_of_kept();
    // A named shape is mass-normalised in the user's units like the stored ones; an inertia-relief mode K_II⁻¹(MU)_I
    // carries the unit of M over that of K, and so does an expansion mode; a residual vector that of its load over that of K.
    let named_unit = |coordinate: DynamicCoordinate| match coordinate {
        DynamicCoordinate::RigidBody(_) => 1.0,
        DynamicCoordinate::InertiaRelief(_) => 1.0 / scaling.eigenvalue_unit(),
        DynamicCoordinate::FreeFree(_)
        | DynamicCoordinate::FixedInterface(_)
        | DynamicCoordinate::MixedInterface(_) => scaling.shape_unit(),
        DynamicCoordinate::Expansion(mode) => evidence.partition.expansion.facts[mode].unit / scaling.eigenvalue_unit(),
        DynamicCoordinate::ResidualVector(load) => evidence.partition.loads.facts[load].unit / scaling.stiffness_unit(),
    };
    let unit: Vec<f64> = evidence.basis.coordinates.iter().map(|c| scaling.shape_unit() / named_unit(*c)).collect();
    // A mode that is left out is orthogonal to all other columns, which have nothing of it.
    let n_b = evidence.partition.n_interface();
    let kept: Vec<usize> = results.kept().into_iter().filter_map(|at| at.checked_sub(n_b)).collect();
    Some(Matrix::from_fn(kept.len(), kept.len(), |i, j| mixing[(kept[i], kept[j])] * unit[kept[i]]))
}

/// Interface nodes of the file: those whose position is known. Without coordinates the interface is bare rows.
/// The axes of the nodes that have positions.
fn frames(results: &Results<'_>, n_nodes: usize) -> Vec<Frame> {
    let nodes = results.evidence.partition.interface.iter().take(n_nodes);
    nodes.map(|node| node.axes.unwrap_or(OF_THE_MODEL)).collect()
}

fn named_nodes(results: &Results<'_>) -> Vec<file::InterfaceNode> {
    let interface = &results.evidence.partition.interface;
    let named = interface.iter().map(|node| {
        Some(file::InterfaceNode {
            name: node.name.clone(),
            label: node.label,
            dofs: node.directions.clone(),
            position: node.position?,
        })
    });
    named.collect::<Option<Vec<_>>>().unwrap_or_default()
}

fn metadata(results: &Results<'_>, tensors: &Tensors, verdict: Verdict) -> Result<Metadata> {
    let evidence = &results.evidence;
    let interface_nodes = named_nodes(results);
    let mut coordinates = interface_coordinates(results, &interface_nodes);
    let kept = results.kept().into_iter().filter_map(|at| at.checked_sub(evidence.partition.n_interface()));
    coordinates.extend(kept.map(|slot| dynamic_coordinate(results, tensors, evidence.basis.coordinates[slot])));
    let digests = results.input.digests();
    Ok(Metadata {
        generator: generator(evidence),
        method: results.job().reduction.method.in_file(),
        units: results.job().model.units.clone(),
        interface_nodes,
        coordinates,
        dropped: dropped(results, tensors),
        load_names: evidence.partition.loads.facts.iter().map(|load| load.name.clone()).collect(),
        quantities: evidence.partition.quantities.names.clone(),
        matrices: evidence.partition.matrices.iter().map(|carried| carried.facts.in_file()).collect(),
        modes_held: evidence.partition.modes_held(),
        validity: file::Validity {
            band_hz: band(results.job(), tensors),
            assumptions: results.plan.assumptions(),
            gravity: results.plan.gravity(),
            ..file::Validity::default()
        },
        flags: {
            let of_mass = evidence.reduction.modal_mass.iter().map(|_| file::Flag::SingularMass);
            results.plan.flags().into_iter().chain(of_mass).collect()
        },
        model: file::ModelSummary {
            n_dofs: evidence.partition.model.n_moving() as u64,
            rigid_body_modes: evidence.rigid.in_file(evidence.partition),
            mass_properties: mass_properties(results, tensors),
        },
        inputs: digests.into_iter().map(|(role, digest)| (role, digest.to_owned())).collect(),
        job: job_document(results.plan.given())?,
        verification: verification(&results.checks(), verdict),
    })
}

fn generator(evidence: &Evidence<'_>) -> file::Generator {
    let parts = evidence.partition.cache().map_or(0, |cache| cache.tally().parts);
    file::Generator {
        name: env!("CARGO_PKG_NAME").into(),
        version: env!("CARGO_PKG_VERSION").into(),
        parts_of_earlier_runs: NonZero::new(parts as u64),
    }
}

/// What was left out, in the order of the method: columns that others span, and modes that nothing starts and nothing sees.
fn dropped(results: &Results<'_>, tensors: &Tensors) -> Vec<file::DroppedColumn> {
    let Evidence { basis, unseen, partition, .. } = results.evidence;
    let of = |coordinate: DynamicCoordinate, reason: String, cause: file::DropCause| file::DroppedColumn {
        column: dynamic_coordinate(results, tensors, coordinate),
        reason,
        cause,
    };
    let spanned = basis.dropped.iter().map(|column| {
        let reason =
            format!("depends on the columns before it: {:.1e} of its length is left, 1e-8 is needed", column.remaining);
        (column.coordinate, of(column.coordinate, reason, file::DropCause::Spanned))
    });
    let unseen = unseen.iter().map(|mode| {
        let coordinate = basis.coordinates[mode.coordinate - partition.n_interface()];
        (coordinate, of(coordinate, mode.reason(), file::DropCause::Unseen))
    });
    // Relief comes before modes, and these before answers to loads.
    let place = |coordinate: DynamicCoordinate| match coordinate {
        DynamicCoordinate::RigidBody(index) => (0, index),
        DynamicCoordinate::InertiaRelief(index) => (1, index),
        DynamicCoordinate::FreeFree(mode)
        | DynamicCoordinate::FixedInterface(mode)
        | DynamicCoordinate::MixedInterface(mode) => (2, mode),
        DynamicCoordinate::Expansion(column) => (3, column),
        DynamicCoordinate::ResidualVector(load) => (4, load),
    };
    let mut all: Vec<(DynamicCoordinate, file::DroppedColumn)> = spanned.chain(unseen).collect();
    all.sort_by_key(|(coordinate, _)| place(*coordinate));
    all.into_iter().map(|(_, column)| column).collect()
}

/// The mass properties of one body that nothing holds: what moves of a held component has less mass than the whole.
fn mass_properties(results: &Results<'_>, tensors: &Tensors) -> Option<file::MassProperties> {
    let Evidence { partition, rigid, .. } = &results.evidence;
    if results.plan.mass() != Mass::Reduced || partition.held.count() > 0 {
        return None;
    }
    let of_preloaded = || {
        let unit = partition.scaling.mass_unit();
        partition.mass_of_preloaded_body().map(|m_f| Matrix::from_fn(6, 6, |i, j| unit * m_f[(i, j)]))
    };
    let of_the_body = || Matrix::from_fn(6, 6, |i, j| tensors.rigid_body_mass[(i, j)]);
    file::mass_properties(&if rigid.is_classical { of_the_body() } else { of_preloaded()? })
}

fn interface_coordinates(results: &Results<'_>, nodes: &[file::InterfaceNode]) -> Vec<Coordinate> {
    if !nodes.is_empty() {
        let of_node = |(index, node): (usize, &file::InterfaceNode)| {
            let dofs = node.dofs.clone();
            dofs.into_iter().map(move |direction| Coordinate::Interface { node: index, direction })
        };
        return nodes.iter().enumerate().flat_map(of_node).collect();
    }
    let partition = results.evidence.partition;
    let rows = partition.dofs[partition.n_internal..].iter().map(|dof| match dof.origin {
        DofOrigin::Row(row) => Coordinate::InterfaceRow { row: partition.model.rows.of(row) as u64 },
        // A rigid node has a position, so that an interface with one is never bare rows.
        DofOrigin::PatchNode(node, _) | DofOrigin::Distortion(node, _) => Coordinate::InterfaceRow { row: node as u64 },
    });
    rows.collect()
}

fn dynamic_coordinate(results: &Results<'_>, tensors: &Tensors, coordinate: DynamicCoordinate) -> Coordinate {
    let errors = &results.evidence.retained.modes.errors;
    let frequency = |mode: usize| tensors.frequencies[mode] / std::f64::consts::TAU;
    let bar = |mode: usize| Some(errors[mode].bar_of(frequency(mode))).filter(|bar: &f64| bar.is_finite());
    match coordinate {
        DynamicCoordinate::RigidBody(index) => Coordinate::RigidBodyMode { index },
        DynamicCoordinate::InertiaRelief(index) => Coordinate::InertiaRelief { index },
        DynamicCoordinate::Expansion(column) => Coordinate::ExpansionMode { column },
        DynamicCoordinate::ResidualVector(load) => Coordinate::ResidualVector { load },
        DynamicCoordinate::FreeFree(mode) => {
            Coordinate::ElasticMode { mode, frequency_hz: frequency(mode), error_bar_hz: bar(mode) }
        }
        DynamicCoordinate::FixedInterface(mode) => {
            Coordinate::FixedInterfaceMode { mode, frequency_hz: frequency(mode), error_bar_hz: bar(mode) }
        }
        DynamicCoordinate::MixedInterface(mode) => {
            Coordinate::MixedInterfaceMode { mode, frequency_hz: frequency(mode), error_bar_hz: bar(mode) }
        }
    }
}

/// From zero to the frequency the modes reach.
fn band(job: &Job, tensors: &Tensors) -> Option<[f64; 2]> {
    match job.reduction.wanted() {
        ModeSelection::UpTo { up_to_hz } => Some([0.0, up_to_hz]),
        ModeSelection::Count { .. } => tensors.frequencies.last().map(|omega| [0.0, omega / std::f64::consts::TAU]),
    }
}

/// The job with its paths relative to the superelement's folder, so that the file does not depend on where that is; without
/// pages for people and machines, which change nothing of the superelement.
///
/// # Errors
/// [`crate::error::Error::NotJson`] where the path of a file is not UTF-8.
pub fn job_document(job: &Job) -> Result<serde_json::Value> {
    let folder = job.write.superelement.parent().unwrap_or(Path::new("")).to_owned();
    let mut job = job.clone();
    (job.write.html, job.write.junit) = (None, None);
    for (_, path) in job.paths_mut() {
        *path = relative_to(path, &folder);
    }
    json_value("the job", &job)
}

/// The way from a folder to a path: up to where the two part, then down.
fn relative_to(path: &Path, folder: &Path) -> PathBuf {
    if path.is_absolute() != folder.is_absolute() {
        return path.to_owned();
    }
    let shared = path.components().zip(folder.components()).take_while(|(a, b)| a == b).count();
    let up = folder.components().skip(shared).map(|_| std::path::Component::ParentDir);
    up.chain(path.components().skip(shared)).collect()
}

fn verification(checks: &[Check], verdict: Verdict) -> file::Verification {
    let verdict_of = |verdict: Verdict| match verdict {
        Verdict::Info | Verdict::Pass => file::Verdict::Pass,
        Verdict::Warn => file::Verdict::Warn,
        Verdict::Fail => file::Verdict::Fail,
    };
    let summary = |check: &Check| file::CheckSummary {
        id: check.id.to_owned(),
        value: Some(check.value).filter(|value| value.is_finite()),
        limit: check.limits.value(),
        verdict: verdict_of(check.verdict()),
    };
    // The file keeps what was judged; values that are only shown have no limit to be kept with.
    let judged = checks.iter().filter(|check| check.is_judged());
    file::Verification { verdict: verdict_of(verdict), checks: judged.map(summary).collect() }
}
