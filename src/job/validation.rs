//! Checks of a job's values, made before any file is opened.

use std::collections::BTreeSet;
use std::path::Path;

use super::analysis::AnalysisJob;
use super::interface::{Axes, AxesGiven, Coupling, InterfaceJob, Origin, Weights};
use super::method::{Boundary, ModeOrigin};
use super::node_selection::NodeSelection;
use super::ranges::{self, positive, size};
use super::reduction::{ModeSelection, ModesJob};
use super::run::Skip;
use super::selection;
use super::statements;
use super::types::{Job, ModelState};
use crate::dofs::Direction;
use crate::error::{Error, Result, Selector};

pub(super) fn validate(job: &Job) -> Result<()> {
    model(job)?;
    super::added_mass::validate(&job.added_masses)?;
    interfaces(&job.interfaces)?;
    reduction(job)?;
    held(job)?;
    super::fixed::validate(&job.fixed)?;
    super::load::validate(&job.loads)?;
    super::matrix::validate(&job.matrices)?;
    job.damping.as_ref().map_or(Ok(()), super::damping::validate)?;
    let gravity = job.scene.as_ref().and_then(|scene| scene.gravity);
    job.model.assumes.as_ref().map_or(Ok(()), |assumes| super::assumes::validate(assumes, gravity))?;
    if let Some(scene) = &job.scene {
        super::scene_validation::validate(scene, &job.interfaces)?;
    }
    if let Some(memory) = job.run.memory_gib {
        positive("run.memory_gib", memory)?;
    }
    let write = &job.write;
    write.recovery.as_ref().map_or(Ok(()), super::recovery::validate)?;
    write.quantities.as_ref().map_or(Ok(()), super::quantities::validate)?;
    ends_in("write.superelement", &write.superelement, ".supel")?;
    let others = [
        ("write.report", write.report.as_deref(), ".json"),
        ("write.html", write.html.as_deref(), ".html"),
        ("write.junit", write.junit.as_deref(), ".xml"),
    ];
    others.into_iter().try_for_each(|(key, path, ending)| path.map_or(Ok(()), |path| ends_in(key, path, ending)))
}

fn reduction(job: &Job) -> Result<()> {
    // The band decides how many modes are kept where nothing else does.
    let has_band = job.scene.as_ref().is_some_and(|scene| scene.band_hz.is_some());
    let accepts_errors_of_modes = has_band && job.accepted().limits_modes();
    // Statics has no modes; with nothing skipped it is left to the method all the same.
    let is_static = job.scene.as_ref().is_some_and(|scene| scene.analysis == Some(AnalysisJob::Static));
    let needs_none = has_band || is_static && job.run.skip == Skip::ByScene;
    let job = &job.reduction;
    let method = job.method.key();
    // A static scene has no band that could say it.
    let by_band = if is_static { "" } else { " or { accept = true }, or a `band_hz` of the scene" };
    let computed =
        format!("expected how many modes {method} keeps: {{ count = 40 }} or {{ up_to_hz = 1000 }}{by_band}");
    let of_file = format!("expected the file of the modes that {method} takes: {{ file = \"modes.mtx\" }}");
    let refuse = |found, expected| Err(Error::JobModes { found, expected });
    match (job.method.modes(), &job.modes) {
        (ModeOrigin::Computed, None) if needs_none => Ok(()),
        (ModeOrigin::Computed, None) => refuse("missing", computed),
        (ModeOrigin::Computed, Some(ModesJob::File { .. })) => refuse("a file", computed),
        (ModeOrigin::File, None) => refuse("missing", of_file),
        (ModeOrigin::Computed, Some(ModesJob::Accepted { .. })) if !accepts_errors_of_modes => refuse(
            "accept = true",
            "expected a scene with a `band_hz` and with `frequency`, `response_db` or `internal_load` in its `accept`, which the modes have to meet"
                .to_owned(),
        ),
        (ModeOrigin::File, Some(ModesJob::Accepted { .. } | ModesJob::Computed(_))) => refuse("without a file", of_file),
        (ModeOrigin::None, Some(_)) => {
            refuse("given", format!("{method} keeps no modes: remove the key or use craig-bampton"))
        }
        (ModeOrigin::File, Some(ModesJob::File { file })) if file.as_os_str().is_empty() => {
            Err(Error::JobEmpty { key: "reduction.modes.file".to_owned(), expected: "the name of a file" })
        }
        (ModeOrigin::Computed, Some(ModesJob::Computed(ModeSelection::UpTo { up_to_hz }))) => {
            size("reduction.modes.up_to_hz", *up_to_hz)
        }
        _ => Ok(()),
    }
}

/// Checks that what is held is there with the method that takes it, and names interfaces.
fn held(Job { reduction, interfaces, scene, .. }: &Job) -> Result<()> {
    let held = match (&reduction.held, reduction.method.boundary() == Boundary::MixedInterface) {
        (Some(held), true) => held,
        (None, false) => return Ok(()),
        (found, _) => {
            let found = if found.is_some() { "given" } else { "missing" };
            return Err(Error::JobHeld { found, method: reduction.method.key() });
        }
    };
    let carriers = scene.iter().flat_map(|scene| &scene.prescribed).map(|carrier| carrier.name.as_str());
    let names: BTreeSet<&str> = interfaces.iter().map(|interface| interface.name.as_str()).chain(carriers).collect();
    if let Some(scene) = scene {
        held.iter().try_for_each(|held| statements::refuse_held(scene, interfaces, held))?;
    }
    match held.iter().find(|held| held.of(|name| names.contains(name)).is_none()) {
        None => Ok(()),
        Some(held) => {
            let known = names.into_iter().map(str::to_owned).collect();
            Err(Error::HeldInterface { held: held.0.clone(), known })
        }
    }
}

fn model(job: &Job) -> Result<()> {
    let model = &job.model;
    if model.mass.is_none() && !job.does_without_mass() {
        return Err(Error::JobMass);
    }
    if let Some((role, _)) = model.files().find(|(_, path)| path.as_os_str().is_empty()) {
        return Err(Error::JobEmpty { key: format!("model.{role}"), expected: "the name of a file" });
    }
    match (model.state, &model.internal_forces) {
        (ModelState::Preloaded, None) => return Err(Error::JobPreload { found: "missing" }),
        (ModelState::Unloaded, Some(_)) => return Err(Error::JobPreload { found: "given" }),
        (ModelState::Preloaded, Some(_)) | (ModelState::Unloaded, None) => {}
    }
    let stated = [("model.stiffness_digits", model.stiffness_digits), ("model.mass_digits", model.mass_digits)];
    for (key, digits) in stated {
        digits.map_or(Ok(()), |digits| ranges::digits(key, digits))?;
    }
    let Some(expect) = &model.expect else { return Ok(()) };
    if let Some(mass) = expect.mass {
        size("model.expect.mass", mass)?;
    }
    expect.cg.map_or(Ok(()), |cg| ranges::point("model.expect.cg", &cg))
}

fn interfaces(interfaces: &[InterfaceJob]) -> Result<()> {
    for (interface_idx, interface) in interfaces.iter().enumerate() {
        let place = format!("interface[{interface_idx}]");
        if interface.name.trim().is_empty() {
            return Err(Error::JobEmpty { key: format!("{place}.name"), expected: "a name" });
        }
        let earlier = interfaces.iter().take(interface_idx);
        if earlier.clone().any(|other| other.name == interface.name) {
            return Err(Error::InterfaceTwice { name: interface.name.clone() });
        }
        selection::validate(&interface.selection(), &place)?;
        selection::directions(&interface.selection(), &place)?;
        coupling(interface, &place)?;
        axes(interface, &place)?;
        weights(interface, &place)?;
        earlier.clone().try_for_each(|other| overlap(other, interface))?;
    }
    Ok(())
}

fn coupling(interface: &InterfaceJob, place: &str) -> Result<()> {
    let conflict = |key: &str, situation, remedy| {
        let (selector, key) = (Selector::Interface(interface.name.clone()), key.to_owned());
        Err(Error::InterfaceConflict { selector, key, situation, remedy })
    };
    let is_rows = matches!(interface.nodes, NodeSelection::Rows { .. });
    let is_patch = interface.coupling.is_patch();
    match &interface.origin {
        _ if is_rows && is_patch => {
            let key = format!("coupling = \"{}\"", interface.coupling.name());
            conflict(&key, "rows, which have no position", ", or give nodes")
        }
        _ if is_rows && interface.dofs.is_some() => {
            conflict("dofs", "rows, each of which is one degree of freedom", "")
        }
        Origin::Point(_) | Origin::Area | Origin::Hole | Origin::Sphere if !is_patch => {
            conflict("origin", "a direct coupling, whose nodes stay where they are", ", or set coupling = \"rigid\"")
        }
        Origin::Point(point) => ranges::point(&format!("{place}.origin"), point),
        Origin::Centroid | Origin::Area | Origin::Hole | Origin::Sphere => Ok(()),
    }
}

fn axes(interface: &InterfaceJob, place: &str) -> Result<()> {
    let conflict = |situation, remedy| {
        let selector = Selector::Interface(interface.name.clone());
        Err(Error::InterfaceConflict { selector, key: "axes".to_owned(), situation, remedy })
    };
    match &interface.axes {
        None => Ok(()),
        Some(_) if matches!(interface.nodes, NodeSelection::Rows { .. }) => {
            conflict("rows, which have no axes", ", or give nodes")
        }
        Some(Axes::Hole) if !interface.coupling.is_patch() => {
            conflict("a direct coupling, whose nodes have no hole", ", or set coupling = \"rigid\"")
        }
        Some(Axes::Hole) => Ok(()),
        Some(Axes::Given(AxesGiven { z, x })) => {
            ranges::direction(&format!("{place}.axes.z"), z)?;
            ranges::direction(&format!("{place}.axes.x"), x)
        }
    }
}

fn weights(interface: &InterfaceJob, place: &str) -> Result<()> {
    let conflict = |situation, remedy| {
        let selector = Selector::Interface(interface.name.clone());
        Err(Error::InterfaceConflict { selector, key: "weights".to_owned(), situation, remedy })
    };
    let Some(weights) = &interface.weights else { return Ok(()) };
    if interface.coupling != Coupling::Average {
        return conflict("a coupling that takes no mean", ", or set coupling = \"average\"");
    }
    let Weights::Given(given) = weights else { return Ok(()) };
    let NodeSelection::Labels(labels) = &interface.nodes else {
        return conflict("a selection whose order the job does not say", ", or list the nodes");
    };
    if given.len() != labels.len() {
        let (n_weights, n_nodes) = (given.len(), labels.len());
        return Err(Error::WeightCount { interface: interface.name.clone(), n_weights, n_nodes });
    }
    given.iter().enumerate().try_for_each(|(at, weight)| ranges::size(&format!("{place}.weights[{at}]"), *weight))
}

/// Two interfaces may share a node only where both couple directly and claim different directions of it.
fn overlap(first: &InterfaceJob, second: &InterfaceJob) -> Result<()> {
    let direct = !first.coupling.is_patch() && !second.coupling.is_patch();
    let claims = |interface: &InterfaceJob, direction| match &interface.dofs {
        Some(directions) => directions.contains(&direction),
        None => true,
    };
    if direct && !Direction::ALL.iter().any(|direction| claims(first, *direction) && claims(second, *direction)) {
        return Ok(());
    }
    let shared = match (&first.nodes, &second.nodes) {
        (NodeSelection::Labels(a), NodeSelection::Labels(b)) => first_shared(a, b).map(|label| format!("node {label}")),
        (NodeSelection::Rows { rows: a }, NodeSelection::Rows { rows: b }) => {
            first_shared(a, b).map(|row| format!("row {row}"))
        }
        (NodeSelection::Group(a), NodeSelection::Group(b)) if a == b => Some(a.clone()),
        _ => None,
    };
    match shared {
        Some(what) => Err(Error::InterfaceOverlap { first: first.name.clone(), second: second.name.clone(), what }),
        None => Ok(()),
    }
}

/// Refuses a name of an output that has another ending.
///
/// # Errors
/// [`Error::OutputName`].
pub(crate) fn ends_in(key: &'static str, path: &Path, expected: &'static str) -> Result<()> {
    // `name.supel`, not a bare `.supel`, which would be a hidden file without a name.
    // `x.supel/` is the name of a folder, although it has the file name `x.supel`.
    let has_ending = path.as_os_str().as_encoded_bytes().ends_with(expected.as_bytes());
    let is_named = has_ending && path.file_name().is_some_and(|name| name.len() > expected.len());
    if is_named { Ok(()) } else { Err(Error::OutputName { key, path: path.to_owned(), expected }) }
}

fn first_shared<T: Ord + Copy>(a: &[T], b: &[T]) -> Option<T> {
    let known: BTreeSet<T> = a.iter().copied().collect();
    b.iter().copied().find(|item| known.contains(item))
}
