//! Whether file and job describe the same component: M-26, M-06.

use supel_runtime::{Coordinate, DropCause, RigidBodyModes, Superelement};

use super::asked::AskedModes;
use super::columns::Named;
use super::motions::KnownMotions;
use super::projection::Projected;
use crate::audit::content::flags;
use crate::audit::flaw::flaw;
use crate::audit::jobs::differences;
use crate::audit::kept_job::band;
use crate::audit::mass::is_of_a_body;
use crate::audit::version::kept_job;
use crate::dofs::Direction;
use crate::eigen::rows_with_mass;
use crate::error::Result;
use crate::input::InputFacts;
use crate::job::{Boundary, Job};
use crate::partition::{DofOrigin, Frame, InterfaceNode, OF_THE_MODEL, Partition, ReducedDof};
use crate::plan::{Mass, Plan};
use crate::verification::check::{Check, Limits};

/// M-26: digests of the inputs. Other files may hold the same matrices, which the other checks tell.
pub(super) fn digests(superelement: &Superelement, facts: &InputFacts) -> Check {
    let recorded = &superelement.metadata().inputs;
    let known = facts.digests();
    let differs = |role: &str, digest: &str| recorded.get(role).is_none_or(|recorded| recorded != digest);
    let others = known.iter().filter(|(role, digest)| differs(role, digest)).map(|(role, _)| role.as_str());
    let unknown = recorded.keys().map(String::as_str).filter(|role| !known.contains_key(*role));
    let others: Vec<&str> = others.chain(unknown).collect();
    Check {
        id: "M-26",
        name: "it was made from the files of the job",
        equation: "number of input files with another digest",
        value: others.len() as f64,
        limits: Limits::default(),
        fail_above: Check::NEVER,
        worst: (!others.is_empty()).then(|| others.join(", ")),
    }
}

/// M-26: interface coordinates, one by one.
pub(super) fn interface(superelement: &Superelement, partition: &Partition) -> Check {
    let stored = stored(superelement);
    let has_nodes = !superelement.metadata().interface_nodes.is_empty();
    let asked = if has_nodes { nodes_asked(partition) } else { rows_asked(partition) };
    let first = stored.iter().zip(&asked).find(|(a, b)| a != b);
    let n_different = stored.iter().zip(&asked).filter(|(a, b)| a != b).count() + stored.len().abs_diff(asked.len());
    let worst = match first {
        Some((a, b)) => Some(format!("{a} in the file, {b} by the job")),
        None if n_different > 0 => {
            Some(format!("{} coordinates in the file, {} by the job", stored.len(), asked.len()))
        }
        None => None,
    };
    Check {
        id: "M-26",
        name: "interface is that of the job",
        equation: "number of interface coordinates at another node, position, direction or axes",
        value: n_different as f64,
        limits: Limits::default(),
        fail_above: 0.0,
        worst,
    }
}

fn stored(superelement: &Superelement) -> Vec<String> {
    let (metadata, frames) = (superelement.metadata(), &superelement.tensors().interface_frames);
    let of = |coordinate: &Coordinate| match *coordinate {
        Coordinate::Interface { node: node_index, direction } => {
            let node = &metadata.interface_nodes[node_index];
            let direction = format!("{direction:?}").to_lowercase();
            Some(described(&node.name, node.label, &direction, node.position) + &turned(frames[node_index]))
        }
        Coordinate::InterfaceRow { row } => Some(format!("row {}", row + 1)),
        _ => None,
    };
    metadata.coordinates.iter().filter_map(of).collect()
}

/// Interface coordinates by the job, for a file that names no nodes.
fn rows_asked(partition: &Partition) -> Vec<String> {
    let of = |dof: &ReducedDof| match dof.origin {
        DofOrigin::Row(row) => format!("row {}", partition.model.rows.of(row) + 1),
        DofOrigin::PatchNode(node, _) | DofOrigin::Distortion(node, _) => format!("row {}", node + 1),
    };
    partition.dofs[partition.n_internal..].iter().map(of).collect()
}

/// Interface coordinates by the job, for a file that names nodes.
fn nodes_asked(partition: &Partition) -> Vec<String> {
    let of = |node: &InterfaceNode| -> Vec<String> {
        let position = node.position.unwrap_or_default();
        let axes = turned(node.axes.unwrap_or(OF_THE_MODEL));
        let name = |direction: &Direction| described(&node.name, node.label, &direction.to_string(), position) + &axes;
        node.directions.iter().map(name).collect()
    };
    partition.interface.iter().flat_map(of).collect()
}

/// The axes of a node in words, where they are not those of the model.
fn turned(frame: Frame) -> String {
    if frame == OF_THE_MODEL { String::new() } else { format!(" with the axes {frame:?}") }
}

fn described(name: &str, label: Option<i64>, direction: &str, position: [f64; 3]) -> String {
    let label = label.map(|label| format!(" node {label}")).unwrap_or_default();
    let [x, y, z] = position;
    format!("{name}{label} {direction} at ({x}, {y}, {z})")
}

/// M-06: the file has as many modes as the job asks for.
pub(super) fn n_modes(superelement: &Superelement, asked: &AskedModes) -> Check {
    let (stored, range) = (superelement.tensors().frequencies.len(), asked.n_asked());
    let expected = stored.clamp(range.start, range.end - 1);
    Check {
        id: "M-06",
        name: "it has the modes that the job asks for",
        equation: "|modes of the job − frequencies stated|",
        value: stored.abs_diff(expected) as f64,
        limits: Limits::default(),
        fail_above: 0.0,
        worst: Some(format!("{expected} asked for, {stored} stated{}", left_out(superelement))),
    }
}

/// How many of the modes stated have no coordinate because nothing starts or sees them, in words.
fn left_out(superelement: &Superelement) -> String {
    match superelement.metadata().unseen_modes().count() {
        0 => String::new(),
        n => format!(", {n} of them left out of the coordinates"),
    }
}

/// The places of the file's modal coordinates among the columns made again, where both are of the same kinds.
pub(super) fn places(superelement: &Superelement, projected: &Projected, boundary: Boundary) -> Option<Vec<usize>> {
    let coordinates = &superelement.metadata().coordinates[superelement.n_interface()..];
    let place = |coordinate: &Coordinate| projected.place_of(named(coordinate, boundary)?);
    coordinates.iter().map(place).collect()
}

pub(super) fn named(coordinate: &Coordinate, boundary: Boundary) -> Option<Named> {
    match (coordinate, boundary) {
        (Coordinate::RigidBodyMode { index }, _) => Some(Named::Rigid(*index)),
        (Coordinate::InertiaRelief { index }, _) => Some(Named::Relief(*index)),
        (Coordinate::ExpansionMode { column }, _) => Some(Named::Expansion(*column)),
        (Coordinate::ResidualVector { load }, _) => Some(Named::Residual(*load)),
        (Coordinate::ElasticMode { mode, .. }, Boundary::FreeInterface)
        | (Coordinate::FixedInterfaceMode { mode, .. }, Boundary::FixedInterface)
        | (Coordinate::MixedInterfaceMode { mode, .. }, Boundary::MixedInterface) => Some(Named::Mode(*mode)),
        _ => None,
    }
}

/// M-26: modal coordinates and what was left out are the columns of the method, each once and in order.
pub(super) fn modal_coordinates(superelement: &Superelement, projected: &Projected, boundary: Boundary) -> Check {
    let metadata = superelement.metadata();
    let n_modes = superelement.tensors().frequencies.len();
    let is_mode = |named: &&Named| matches!(named, Named::Mode(_));
    let is_answer = |named: &&Named| matches!(named, Named::Expansion(_) | Named::Residual(_));
    let motions = projected.named.iter().filter(|named| !is_mode(named) && !is_answer(named)).copied();
    let answers = projected.named.iter().filter(is_answer).copied();
    let expected: Vec<Named> = motions.chain((0..n_modes).map(Named::Mode)).chain(answers).collect();
    let kept = metadata.coordinates[superelement.n_interface()..].iter();
    let kept: Vec<Option<Named>> = kept.map(|coordinate| named(coordinate, boundary)).collect();
    let dropped: Vec<Option<Named>> = metadata.dropped.iter().map(|dropped| named(&dropped.column, boundary)).collect();
    let place = |named: &Option<Named>| named.and_then(|named| expected.iter().position(|known| *known == named));
    let mut flaws = Vec::new();
    for (list, what) in [(&kept, "coordinate"), (&dropped, "column left out")] {
        let places: Vec<Option<usize>> = list.iter().map(place).collect();
        let out_of_order = (0..places.len()).find(|at| {
            places[*at].is_none() || (*at > 0 && places[*at - 1].is_some_and(|before| Some(before) >= places[*at]))
        });
        flaws.extend(out_of_order.map(|at| format!("modal {what} {} is not that of the method", at + 1)));
    }
    for named in &expected {
        let times = kept.iter().chain(&dropped).filter(|other| **other == Some(*named)).count();
        if times != 1 {
            flaws.push(format!("{named:?} is there {times} times").to_lowercase());
        }
    }
    flaw("modal coordinates are those of the method", "number of columns missing, repeated or out of order", &flaws)
}

/// M-06: a column that was left out has to depend on those that were kept before it. Where those that were kept are as many as the
/// interior has rows with mass they span all there is, and nothing is left of any other.
pub(super) fn dropped(
    superelement: &Superelement,
    (projected, partition): (&Projected, &Partition),
    boundary: Boundary,
) -> Option<Check> {
    /// A column keeps 1e-8 of its length at most, and its shape is that of another eigensolver.
    const LEFT: f64 = 1e-6;
    /// The most that rounding excuses: a column of which a hundredth is left is another one.
    const LARGEST_LEFT: f64 = 1e-2;
    let dropped = superelement.metadata().dropped.iter();
    let columns: Vec<_> = dropped.filter(|column| column.cause == DropCause::Spanned).collect();
    if columns.is_empty() {
        return None;
    }
    let mut kept = places(superelement, projected, boundary)?;
    kept.sort_unstable();
    let is_complete = kept.len() == rows_with_mass(partition.internal().mass);
    let span = projected.dependence.span(&kept);
    let (mut worst, mut rounding) = ((0.0, None), 0.0f64);
    for column in columns.iter().filter(|_| !is_complete) {
        let named = named(&column.column, boundary)?;
        let at = projected.place_of(named)?;
        let n_others = kept.partition_point(|other| *other < at);
        rounding = rounding.max(projected.rounding_of_share(at, &kept[..n_others]));
        // What lies within the error of the column is not known to be there.
        let remaining = projected.dependence.remaining(at, span.as_ref().subcols(0, n_others));
        let left = (remaining - projected.doubt(at)).max(0.0) * projected.length(at).min(1.0);
        if crate::dense::worse(left, worst.0) {
            worst = (left, Some(format!("{named:?}").to_lowercase()));
        }
    }
    let limits = Limits { engineering: LEFT, arithmetic: rounding.min(LARGEST_LEFT), data: 0.0 };
    Some(Check {
        id: "M-06",
        name: "columns left out depend on those that were kept",
        equation: "max ‖N_j − N_kept(…)‖ / ‖N_j‖, in the mass",
        value: worst.0,
        limits,
        fail_above: 10.0 * limits.value(),
        worst: worst.1,
    })
}

/// M-26: all that the file says of itself is what a reduction by the job makes.
pub(super) fn statements(
    superelement: &Superelement,
    (partition, plan): (&Partition, &Plan),
    motions: &KnownMotions,
) -> Check {
    let (metadata, tensors, job) = (superelement.metadata(), superelement.tensors(), plan.job());
    let mut flaws = Vec::new();
    let mut expect = |holds: bool, what: &str| {
        if !holds {
            flaws.push(what.to_owned());
        }
    };
    let method = job.reduction.method.in_file();
    expect(metadata.method == method, "another method");
    expect(metadata.units == job.model.units, "other units");
    expect(metadata.model.n_dofs == partition.model.n_moving() as u64, "another number of degrees of freedom");
    let rigid = if motions.is_geometric() { RigidBodyModes::Geometric } else { RigidBodyModes::Algebraic };
    expect(metadata.model.rigid_body_modes == rigid, "rigid-body modes of another kind");
    let is_known = motions.is_of_a_body() || partition.mass_of_preloaded_body().is_some_and(is_of_a_body);
    let has_properties = plan.mass() == Mass::Reduced && is_known && partition.held.count() == 0;
    expect(metadata.model.mass_properties.is_some() == has_properties, "mass properties");
    let has_mass = plan.mass() == Mass::Reduced;
    let has_gravity = has_mass && (motions.is_classical() || partition.gravity.is_some());
    expect(tensors.gravity.is_some() == has_gravity, "gravity");
    expect(tensors.damping.is_some() == job.has_damping(), "damping");
    let matrices = partition.matrices.iter().map(|carried| carried.facts.in_file());
    expect(metadata.matrices.iter().cloned().eq(matrices), "further matrices");
    let names = partition.loads.facts.iter().map(|load| &load.name);
    expect(metadata.load_names.iter().eq(names), "loads");
    expect(metadata.quantities == partition.quantities.names, "quantities");
    expect(metadata.flags == flags(superelement, Some(plan)), "flags");
    expect(metadata.modes_held == partition.modes_held(), "other dofs held for the modes");
    expect(metadata.validity.assumptions == plan.assumptions(), "assumptions about the simulation");
    expect(metadata.validity.unloaded.is_empty(), "unloaded directions");
    expect(metadata.validity.gravity == plan.gravity(), "another direction of gravity");
    expect(metadata.validity.band_hz == band(superelement, job), "another band");
    let asked = job.write.recovery.as_ref().map(|recovery| recovery.precision);
    let recovery = tensors.recovery.as_ref();
    expect(recovery.is_some() == asked.is_some(), "recovery");
    if let (Some(recovery), Some(asked)) = (recovery, asked) {
        expect(recovery.precision() == asked, "recovery in another precision");
        let is_row = |(found, row): (&supel_runtime::RecoveredDof, &(usize, crate::dofs::Dof))| {
            found.node == row.1.node && found.direction as usize == row.1.direction as usize
        };
        let n_alike = recovery.dofs().iter().zip(&partition.recovered.rows).filter(|pair| is_row(*pair)).count();
        let n = partition.recovered.rows.len();
        expect(n_alike == n && recovery.dofs().len() == n, "recovered degrees of freedom");
        expect(recovery.positions() == partition.recovered.positions.as_deref(), "positions of recovered nodes");
        let faces = partition.recovered.faces.as_ref().filter(|faces| faces.count() > 0);
        expect(recovery.faces() == faces, "faces between recovered nodes");
    }
    flaw(
        "it says of itself what the job makes",
        "number of statements that are not those of a reduction by the job",
        &flaws,
    )
}

/// M-26: the job kept in the file asks for what the job at hand asks for, and in the same way.
pub(super) fn jobs(superelement: &Superelement, job: &Job) -> Result<Vec<Check>> {
    let name = "the job kept in it is the job";
    let equation = "number of keys that decide what is made and differ; paths may differ";
    let Some(kept) = kept_job(superelement) else {
        return Ok(vec![flaw(name, equation, &["it is of another version".to_owned()])]);
    };
    let found = differences(&kept, job)?;
    let way = flaw("it was made in the way of the job", "number of keys that decide how and differ", &found.way);
    Ok(vec![flaw(name, equation, &found.wanted), Check { fail_above: Check::NEVER, ..way }])
}
