//! The job kept in the file, and whether the rest of the file is what it asks for: M-26, M-06.

use std::collections::BTreeSet;

use supel_runtime::{Coordinate, DropCause, DroppedColumn, Generator, RigidBodyModes, Superelement};

use super::content::{Content, flags};
use super::flaw::flaw;
use super::mass::is_of_a_body;
use super::record;
use super::rigid_motion::is_nearly_unit;
use super::version::{applied, is_of_this_version};
use crate::job::{Axes, Boundary, DofUse, InterfaceJob, Job, Method, ModeOrigin, ModeSelection, NodeSelection};
use crate::partition::{Frame, OF_THE_MODEL, axes_of_job};
use crate::plan::{Plan, Unseen};
use crate::verification::check::{Check, Limits};

/// Method, units, interfaces, axes, band and recovery are those of the job kept in the file.
pub(super) fn agrees(content: &Content<'_>) -> Check {
    let tensors = content.superelement.tensors();
    let mut flaws = Vec::new();
    if let Some(job) = content.job() {
        flaws.extend(by_job(content, job).iter().map(ToString::to_string));
    }
    let nodes = content.superelement.metadata().interface_nodes.iter();
    if nodes.zip(&tensors.interface_frames).any(|(node, frame)| has_other_axes(content.job(), &node.name, frame)) {
        flaws.push("turned axes of interface nodes".to_owned());
    }
    flaws.extend(applied(content.superelement, made_by_none(content)));
    flaw("file is what its job asks for", "number of differences to the job kept in the file", &flaws)
}

/// Whether the axes of an interface node are others than the job gives. No matrix depends on them, and those of a hole are in the mesh.
fn has_other_axes(job: Option<&Job>, interface: &str, found: &Frame) -> bool {
    let asked = job.and_then(|job| job.interfaces.iter().find(|asked| asked.name == interface)?.axes.as_ref());
    match asked {
        Some(Axes::Hole) => false,
        Some(Axes::Given(given)) => axes_of_job(given).is_none_or(|asked| asked != *found),
        None => *found != OF_THE_MODEL,
    }
}

/// What no reduction by this version makes, and other programs and versions may.
fn made_by_none(content: &Content<'_>) -> Vec<String> {
    let (metadata, tensors) = (content.superelement.metadata(), content.superelement.tensors());
    let assumptions = content.plan.as_ref().map_or_else(Vec::new, Plan::assumptions);
    let found = [
        (content.plan.is_none(), "it is no job of the version that wrote it"),
        (tensors.damping.is_some() && !content.job().is_some_and(Job::has_damping), "damping"),
        (metadata.flags != flags(content.superelement, content.plan.as_ref()), "flags"),
        (metadata.validity.assumptions != assumptions, "assumptions about the simulation"),
        (!metadata.validity.unloaded.is_empty(), "unloaded directions"),
        (metadata.validity.gravity != content.plan.as_ref().and_then(Plan::gravity), "another direction of gravity"),
        (
            !metadata.inputs.contains_key("stiffness") || metadata.inputs.contains_key("mass") != content.has_mass(),
            "no digests",
        ),
    ];
    found.iter().filter(|(is_there, _)| *is_there).map(|(_, what)| (*what).to_owned()).collect()
}

fn by_job(content: &Content<'_>, job: &Job) -> Vec<&'static str> {
    let (metadata, tensors) = (content.superelement.metadata(), content.superelement.tensors());
    let mut flaws = Vec::new();
    let mut expect = |holds: bool, what: &'static str| {
        if !holds {
            flaws.push(what);
        }
    };
    let method = job.reduction.method.in_file();
    expect(metadata.method == method, "another method");
    expect(metadata.units == job.model.units, "other units");
    let found: BTreeSet<&str> = metadata.interface_nodes.iter().map(|node| node.name.as_str()).collect();
    expect(found.is_empty() || content.plan.as_ref().is_some_and(|plan| are_asked(plan, &found)), "other interfaces");
    expect(are_in_order(content, job), "interfaces in another order");
    expect(found.is_empty() || labels(content) == labels_asked(job, &found), "other interface nodes");
    let is_by_rows = job.interfaces.iter().all(|interface| matches!(interface.nodes, NodeSelection::Rows { .. }));
    expect(
        metadata.interface_nodes.iter().all(|node| !is_patch(job, &node.name) || node.label.is_none()),
        "a labelled patch",
    );
    let asked = || content.plan.as_ref().map_or_else(Vec::new, rows_asked);
    expect(!found.is_empty() || !is_by_rows || rows(content) == asked(), "other interface rows");
    expect(found.is_empty() || metadata.modes_held == held_asked(content, job), "other dofs held for the modes");
    expect(metadata.validity.band_hz == band(content.superelement, job), "another band");
    let may_leave_out = content.plan.as_ref().is_some_and(|plan| plan.unseen() == Unseen::LeftOut);
    let is_unseen = |dropped: &DroppedColumn| dropped.cause == DropCause::Unseen;
    expect(may_leave_out || !metadata.dropped.iter().any(is_unseen), "modes left out as if nothing saw them");
    expect(metadata.load_names.iter().eq(job.loads.iter().map(|load| &load.name)), "other loads");
    expect(tensors.quantities.is_some() == job.write.quantities.is_some(), "other quantities");
    expect(tensors.damping.is_some() || !job.has_damping(), "no damping");
    let matrices = metadata.matrices.iter().map(|matrix| (&matrix.name, matrix.kind));
    expect(matrices.eq(job.matrices.iter().map(|matrix| (&matrix.name, matrix.kind))), "other matrices");
    let precision = job.write.recovery.as_ref().map(|recovery| recovery.precision);
    let recovery = tensors.recovery.as_ref();
    expect(recovery.map(supel_runtime::Recovery::precision) == precision, "another recovery");
    let has_positions = recovery.is_some_and(|recovery| recovery.positions().is_some());
    expect(has_positions == (recovery.is_some() && job.model.nodes.is_some()), "positions of recovered nodes");
    if let (Some(recovery), Some(NodeSelection::Labels(asked))) =
        (recovery, job.write.recovery.as_ref().map(|recovery| &recovery.nodes))
    {
        let mut found: Vec<i64> = recovery.dofs().iter().map(|dof| dof.node).collect();
        found.dedup();
        expect(found == *asked, "other recovered nodes");
    }
    flaws
}

/// Interface coordinates that the job holds while modes are computed.
fn held_asked(content: &Content<'_>, job: &Job) -> Vec<usize> {
    let metadata = content.superelement.metadata();
    let held = job.reduction.held.as_deref().unwrap_or_default();
    let named: Vec<_> = held
        .iter()
        .filter_map(|held| held.of(|name| metadata.interface_nodes.iter().any(|node| node.name == name)))
        .collect();
    let is_held = |coordinate: &Coordinate| match coordinate {
        Coordinate::Interface { node, direction } => {
            let name = &metadata.interface_nodes[*node].name;
            named.iter().any(|(held, of)| held == name && of.is_none_or(|of| of == *direction))
        }
        _ => false,
    };
    (0..content.n_b).filter(|at| is_held(&metadata.coordinates[*at])).collect()
}

/// Whether an interface is a rigid patch: one node that the model does not have.
fn is_patch(job: &Job, name: &str) -> bool {
    job.interfaces.iter().any(|interface| interface.name == name && interface.coupling.is_patch())
}

/// Labels of the interface nodes whose interface lists them.
fn labels(content: &Content<'_>) -> Vec<i64> {
    let is_listed = |name: &str| {
        let of = |job: &Job| {
            let interface = job.interfaces.iter().find(|interface| interface.name == name);
            interface.is_some_and(|interface| matches!(interface.nodes, NodeSelection::Labels(_)))
        };
        content.job().is_some_and(of)
    };
    let nodes = content.superelement.metadata().interface_nodes.iter();
    nodes.filter(|node| is_listed(&node.name)).filter_map(|node| node.label).collect()
}

/// Whether the interfaces of a file are those of the job: all that the scene says nothing of, carriers, and no others.
fn are_asked(plan: &Plan, found: &BTreeSet<&str>) -> bool {
    let (jobs, scene) = (&plan.job().interfaces, plan.statements());
    let carriers = scene.map_or(&[][..], |scene| &scene.prescribed);
    let names = jobs.iter().map(|job| job.name.as_str());
    let whole = names
        .clone()
        .filter(|name| scene.is_none_or(|scene| scene.use_of_whole(jobs, name) == Some(DofUse::Connected)));
    let needed: BTreeSet<&str> = whole.chain(carriers.iter().map(|carrier| carrier.name.as_str())).collect();
    let allowed: BTreeSet<&str> = needed.iter().copied().chain(names).collect();
    needed.is_subset(found) && found.is_subset(&allowed)
}

/// Whether the interfaces of a file stand in the order of the job. Carriers of the scene may stand anywhere.
fn are_in_order(content: &Content<'_>, job: &Job) -> bool {
    let asked: Vec<&str> = job.interfaces.iter().map(|interface| interface.name.as_str()).collect();
    let nodes = content.superelement.metadata().interface_nodes.iter();
    let places = nodes.filter_map(|node| asked.iter().position(|name| *name == node.name));
    places.is_sorted()
}

/// Labels that the interfaces of the file list by the job, those of patches left out: a patch is one node without a label.
fn labels_asked(job: &Job, found: &BTreeSet<&str>) -> Vec<i64> {
    let is_there = |interface: &&InterfaceJob| found.contains(interface.name.as_str());
    let direct = job.interfaces.iter().filter(|interface| !interface.coupling.is_patch()).filter(is_there);
    let listed = direct.filter_map(|interface| match &interface.nodes {
        NodeSelection::Labels(labels) => Some(labels.clone()),
        _ => None,
    });
    listed.flatten().collect()
}

/// Interface rows of the file.
fn rows(content: &Content<'_>) -> Vec<u64> {
    let coordinates = content.superelement.metadata().coordinates.iter();
    let of = |coordinate: &Coordinate| match coordinate {
        Coordinate::InterfaceRow { row } => Some(*row),
        _ => None,
    };
    coordinates.filter_map(of).collect()
}

fn rows_asked(plan: &Plan) -> Vec<u64> {
    let (job, scene) = (plan.job(), plan.statements());
    let is_kept =
        |name: &str| scene.is_none_or(|scene| scene.use_of(&job.interfaces, (name, None)) == DofUse::Connected);
    let of = |nodes: &NodeSelection| match nodes {
        NodeSelection::Rows { rows } => rows.iter().map(|row| *row as u64).collect(),
        _ => Vec::new(),
    };
    let kept = job.interfaces.iter().filter(|interface| is_kept(&interface.name));
    kept.flat_map(|interface| of(&interface.nodes)).collect()
}

/// The band that a reduction states: as far as the job asks for modes, or as far as there are.
pub(super) fn band(superelement: &Superelement, job: &Job) -> Option<[f64; 2]> {
    match job.reduction.wanted() {
        ModeSelection::UpTo { up_to_hz } => Some([0.0, up_to_hz]),
        ModeSelection::Count { .. } => {
            superelement.tensors().frequencies.last().map(|omega| [0.0, omega / std::f64::consts::TAU])
        }
    }
}

/// M-06: there are as many modes as the job kept in the file counts, or none beyond its band; fewer than counted and than the
/// model has dofs for are a warning, because a mass of low rank has no more.
pub(super) fn n_modes(content: &Content<'_>) -> Option<Check> {
    /// A mode on the edge of a band belongs to it.
    const EDGE: f64 = 1e-6;
    let stated = content.superelement.tensors().frequencies.as_slice();
    let (value, words) = match content.job()?.reduction.wanted() {
        ModeSelection::Count { count } => {
            let n_without = match content.boundary {
                Boundary::FixedInterface => content.n_b,
                Boundary::FreeInterface => content.n_rigid(),
                Boundary::MixedInterface => {
                    content.superelement.metadata().modes_held.len() + content.n_passing().unwrap_or(content.n_rigid())
                }
            };
            let n_dofs = usize::try_from(content.superelement.metadata().model.n_dofs).unwrap_or(usize::MAX);
            let most = count.min(n_dofs.saturating_sub(n_without));
            let text = format!("{count} asked for, {} stated", stated.len());
            (most.saturating_sub(stated.len()), text)
        }
        ModeSelection::UpTo { up_to_hz } => {
            let limit = up_to_hz * std::f64::consts::TAU * (1.0 + EDGE);
            let n_beyond = stated.iter().filter(|omega| **omega > limit).count();
            (n_beyond, format!("{n_beyond} beyond the band of {up_to_hz} Hz"))
        }
    };
    Some(Check {
        id: "M-06",
        name: "modes are those that its job asks for",
        equation: "number of modes short of the count, or beyond the band",
        value: value as f64,
        limits: Limits::default(),
        fail_above: Check::NEVER,
        worst: (value > 0).then_some(words),
    })
}

/// M-26: every mode and every inertia relief is a coordinate or was left out by name; what is there belongs to the method, and
/// mass properties, gravity and mixing are there where they belong.
pub(super) fn accounts(content: &Content<'_>) -> Check {
    let (metadata, tensors) = (content.superelement.metadata(), content.superelement.tensors());
    let modal = || metadata.named_columns().skip(content.n_b);
    let mut flaws = Vec::new();
    let n_modes = tensors.frequencies.len();
    let mut modes: Vec<usize> = modal().filter_map(|coordinate| coordinate.mode().map(|(mode, _)| mode)).collect();
    modes.sort_unstable();
    if modes != (0..n_modes).collect::<Vec<_>>() {
        flaws.push(format!("of {n_modes} modes {} are coordinates or left out by name", modes.len()));
    }
    let frequency = |coordinate: &Coordinate| {
        coordinate
            .mode()
            .and_then(|(mode, hertz)| Some((hertz, tensors.frequencies.get(mode)? / std::f64::consts::TAU)))
    };
    let differs = |(stated, known): (f64, f64)| (stated - known).abs() > 8.0 * f64::EPSILON * known;
    if modal().filter_map(frequency).any(differs) {
        flaws.push("a mode has two frequencies".to_owned());
    }
    let is_of_boundary = |coordinate: &Coordinate| match coordinate {
        Coordinate::FixedInterfaceMode { .. } => content.boundary == Boundary::FixedInterface,
        Coordinate::ElasticMode { .. } => content.boundary == Boundary::FreeInterface,
        Coordinate::MixedInterfaceMode { .. } => content.boundary == Boundary::MixedInterface,
        _ => true,
    };
    if !modal().all(is_of_boundary) {
        flaws.push("modes of both boundaries".to_owned());
    }
    if metadata.dropped.iter().any(|dropped| dropped.column.is_interface()) {
        flaws.push("an interface coordinate left out".to_owned());
    }
    let is_unseen = |dropped: &&DroppedColumn| dropped.cause == DropCause::Unseen;
    if metadata.dropped.iter().filter(is_unseen).any(|dropped| dropped.column.mode().is_none()) {
        flaws.push("something other than a mode left out as if nothing saw it".to_owned());
    }
    if let Some(method) = Method::of_file(metadata.method) {
        flaws.extend(of_method(content, method).iter().map(ToString::to_string));
        flaws.extend(applied(content.superelement, with_method(content)));
    }
    flaw("its parts belong together", "number of parts missing, surplus or of another method", &flaws)
}

/// What the method of a file says of its columns, whoever made them.
fn of_method(content: &Content<'_>, method: Method) -> Vec<&'static str> {
    let (metadata, tensors) = (content.superelement.metadata(), content.superelement.tensors());
    let modal = || metadata.named_columns().skip(content.n_b);
    let mut flaws = Vec::new();
    let mut expect = |holds: bool, what: &'static str| {
        if !holds {
            flaws.push(what);
        }
    };
    let n_r = content.n_rigid();
    let is_modal = is_modal(content);
    let of_method = method.boundary().holding(metadata.modes_held.len(), content.n_b);
    let boundary = if is_modal { Boundary::FreeInterface } else { of_method };
    expect(tensors.frequencies.is_empty() || content.boundary == boundary, "modes of another boundary");
    expect(metadata.modes_held.is_empty() || method.boundary() == Boundary::MixedInterface, "dofs held for the modes");
    let numbers = |pick: fn(&Coordinate) -> Option<usize>| -> Vec<usize> {
        let mut numbers: Vec<usize> = modal().filter_map(pick).collect();
        numbers.sort_unstable();
        numbers
    };
    let relief = numbers(|coordinate| match coordinate {
        Coordinate::InertiaRelief { index } => Some(*index),
        _ => None,
    });
    let rigid = numbers(|coordinate| match coordinate {
        Coordinate::RigidBodyMode { index } => Some(*index),
        _ => None,
    });
    let residual = numbers(|coordinate| match coordinate {
        Coordinate::ResidualVector { load } => Some(*load),
        _ => None,
    });
    let expansion = numbers(|coordinate| match coordinate {
        Coordinate::ExpansionMode { column } => Some(*column),
        _ => None,
    });
    let is_expanded = method.modes() == ModeOrigin::File || expansion.is_empty();
    expect(is_expanded && expansion == (0..expansion.len()).collect::<Vec<_>>(), "expansion modes");
    let asks = |job: &Job| -> Vec<usize> {
        (0..job.loads.len()).filter(|load| job.loads[*load].residual && !is_modal).collect()
    };
    expect(content.job().is_none_or(|job| residual == asks(job)), "residual vectors");
    let all = |is_there: bool| if is_there { (0..n_r).collect() } else { Vec::new() };
    // Where it is no part of the method, a job may still ask for it.
    let relieved = match &content.plan {
        _ if is_modal => Vec::new(),
        Some(plan) => plan.relief().motions(n_r, metadata.model.rigid_body_modes),
        None => all(method.has_inertia_relief() || !relief.is_empty()),
    };
    let is_attached = content.is_attached() && method.has_attachment_modes();
    let relieved = if is_attached { Vec::new() } else { relieved };
    expect(relief == relieved, "inertia relief");
    expect(rigid == all(is_modal || is_attached), "rigid-body coordinates");
    // Mass properties and gravity take the six unit motions, which are the first six of seven and more.
    let is_told = metadata.model.rigid_body_modes == RigidBodyModes::Geometric || n_r > 6 || is_nearly_unit(content);
    let is_of_model = content.holds_dofs() || content.is_preloaded();
    expect(tensors.gravity.is_none() || is_told || is_of_model, "rigid-body modes said to be algebraic");
    flaws
}

/// What this version writes with the columns of a method, and other programs and versions need not.
fn with_method(content: &Content<'_>) -> Vec<String> {
    let (metadata, tensors) = (content.superelement.metadata(), content.superelement.tensors());
    let mut modal = metadata.coordinates[content.n_b..].iter();
    let is_mixed = modal.any(|coordinate| !matches!(coordinate, Coordinate::FixedInterfaceMode { .. }));
    let is_free = tensors.gravity.is_some() && !content.holds_dofs();
    let is_geometric = metadata.model.rigid_body_modes == RigidBodyModes::Geometric;
    let found = [
        (tensors.mixing.is_some() != is_mixed, "mixing"),
        (
            match (content.is_preloaded(), metadata.model.mass_properties.is_some()) {
                // What tells a preloaded body from several is the mass of the model.
                (true, has_properties) => has_properties && !is_free,
                (false, has_properties) => has_properties != (is_free && is_of_a_body(content.m_f.as_ref())),
            },
            "gravity without mass properties, or these without it",
        ),
        (tensors.gravity.is_none() && is_geometric && content.has_mass(), "no gravity"),
    ];
    found.iter().filter(|(is_there, _)| *is_there).map(|(_, what)| (*what).to_owned()).collect()
}

/// Whether the columns are the modes of a free component without interface.
fn is_modal(content: &Content<'_>) -> bool {
    content.n_b == 0 && content.n_rigid() > 0
}

/// M-26: the program that made it, as far as this one can speak for it. What a file says of that is no reason to believe the rest of
/// it: where it names another version, the rules of this one are not held against it, and that leaves a doubt.
pub(super) fn other_version(content: &Content<'_>) -> Check {
    let worst = (!is_of_this_version(content.superelement)).then(|| {
        let Generator { name, version, .. } = &content.superelement.metadata().generator;
        let mut unlike = made_by_none(content);
        unlike.extend(with_method(content));
        unlike.extend(record::of_version(content));
        let unlike = if unlike.is_empty() { String::new() } else { format!("; it differs in: {}", unlike.join(", ")) };
        format!("what depends on the version was not checked, because the file says {name} {version}{unlike}")
    });
    Check {
        id: "M-26",
        name: "it was made by this version",
        equation: "1 where another program or version is named, else 0",
        value: f64::from(u8::from(worst.is_some())),
        limits: Limits::default(),
        fail_above: Check::NEVER,
        worst,
    }
}
