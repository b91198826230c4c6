//! The job that reduces a superelement again, as it is: its interfaces, its method, its modes.

use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::path::Path;

use faer::Mat;
use serde::Deserialize;
use supel_runtime::{Coordinate, Flag, InterfaceNode, Metadata, Method, Superelement};

use super::assumed::assumed;
use super::job_text::{JobText, LoadColumn, Map, Mass, ModelFiles, Modes, Relief, Selection, rows};
use super::left_behind::not_of_a_model;
use super::names::Names;
use super::strainless_motion::{gives_way, is_held_and_gives_way, rotations_held_alone};
use crate::dense;
use crate::error::{Error, Result};
use crate::input::condensed_digits::{FEWEST_DIGITS, digits};
use crate::input::strainless::{Condensed, condensed_stiffness, mass_or_unit, masses, places};
use crate::input::superelement_file::{NO_STIFFNESS, has_free_dof};
use crate::job::{AssumesJob, Mechanisms};
use crate::report::printable;

/// The job that reduces the superelement in the file `path` as it is, TOML: its matrices, its nodes and its loads are read of that file. With
/// it what the job leaves behind, in words, where it does.
///
/// # Errors
/// [`Error::NoModel`]; [`Error::NameNotText`]; [`Error::DenseEigen`].
pub fn job_of(superelement: &Superelement, path: &Path) -> Result<(String, Option<String>)> {
    let file = path.file_name().and_then(OsStr::to_str);
    let file = file.ok_or_else(|| Error::NameNotText { key: "JOB", path: path.to_owned() })?;
    let is_superelement = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("supel"));
    let names = Names::starting_with(&if is_superelement { path.with_extension("") } else { path.to_owned() });
    let remedy = "see docs/export.md, \"Reducing again\"";
    let job = job(superelement)?.map_err(|found| Error::NoModel { path: path.to_owned(), found, remedy })?;
    let left = not_of_a_model(superelement).join(", ");
    let words = format!("supel: {}: its own job does not carry on {left}", printable(&path.display().to_string()));
    Ok((job.render(&ModelFiles::of_superelement(file, &names)), (!left.is_empty()).then_some(words)))
}

/// The job, or why there is none.
pub(super) fn job(superelement: &Superelement) -> Result<std::result::Result<JobText, &'static str>> {
    let labels = superelement.metadata().interface_labels();
    let condensed = condensed_stiffness(superelement)?;
    if let Some(why) = no_job(superelement, &condensed) {
        return Ok(Err(why));
    }
    let [stiffness, rigid] = [&condensed.stiffness, &superelement.tensors().rigid_body_modes].map(dense::unpacked);
    let matrices = [stiffness, mass_or_unit(superelement), rigid];
    let digits = digits(matrices.each_ref().map(Mat::as_ref), &places(superelement))?;
    if digits.is_some_and(|digits| digits < FEWEST_DIGITS) {
        return Ok(Err("lets rigid-body motion pass to fewer than four digits of its stiffness"));
    }
    let without_nodes = without_nodes(superelement)?;
    let has_map = !labels.is_empty() && without_nodes.is_none();
    let mut remarks: Vec<String> = without_nodes.into_iter().map(str::to_owned).collect();
    let assumes = assumed(superelement);
    let held = if has_map { held(superelement.metadata()) } else { held_interfaces(superelement.metadata()) };
    let mass = if superelement.tensors().mass.rows() > 0 { Mass::InFile } else { Mass::None };
    let (method, relief) = match method(superelement) {
        _ if mass == Mass::None => ("guyan", Relief::NotAsked),
        ("mixed-interface", relief) if held.is_empty() => {
            remarks.push(HELD_IN_PART.to_owned());
            ("craig-bampton", relief)
        }
        own => own,
    };
    Ok(Ok(JobText {
        remarks,
        map: if has_map { Map::Nodes } else { Map::Rows },
        mass,
        units: superelement.metadata().units.clone(),
        held_rotations: if has_map {
            with_held_alone((superelement, &assumes), &matrices)?
        } else {
            held_rotations(superelement)
        },
        mechanisms: match gives_way_inside(superelement, &matrices)? {
            true => Mechanisms::Accept,
            false => mechanisms(superelement),
        },
        digits,
        assumes,
        interfaces: if has_map || labels.is_empty() {
            interfaces(superelement, &labels)
        } else {
            interfaces_of_rows(superelement)
        },
        fixed: Vec::new(),
        loads: loads(superelement),
        method,
        modes: (method != "guyan").then(|| Modes::Count(n_modes(superelement))),
        relief,
        held: (method == "mixed-interface").then_some(held),
    }))
}

/// Why nothing reduces a superelement, whatever its numbers. An interface that just holds its component has no stiffness but rounding. A mass
/// that is singular by its method is that of no model, and internal forces of a preloaded component are not in its file.
fn no_job(superelement: &Superelement, condensed: &Condensed) -> Option<&'static str> {
    let is_marked = |flag: &Flag| superelement.metadata().flags.contains(flag);
    let reasons = [
        (superelement.n_interface() == 0, "has no interface, to which it could be reduced"),
        (
            superelement.n_rigid() >= superelement.n_coordinates(),
            "has an interface that just holds it, and no stiffness",
        ),
        (is_marked(&Flag::SingularMass), "has the singular mass of MacNeal's method, which is that of no model"),
        (is_marked(&Flag::Preloaded), "is preloaded, and its internal forces are not in its file"),
        (has_free_dof(superelement, condensed), NO_STIFFNESS),
    ];
    reasons.into_iter().find_map(|(is_so, why)| is_so.then_some(why))
}

/// Why a job does without the map and the nodes that there are.
fn without_nodes(superelement: &Superelement) -> Result<Option<&'static str>> {
    if superelement.has_rigid_amplitudes() {
        return Ok(Some(MOVING_ROWS));
    }
    let rigid = dense::unpacked(&superelement.tensors().rigid_body_modes);
    Ok(is_held_and_gives_way((&places(superelement), &masses(superelement)), rigid.as_ref())?.then_some(HELD_ROWS))
}

/// What the job says where amplitudes move.
pub(super) const MOVING_ROWS: &str =
    "Modal amplitudes move with rigid-body motion, which the positions of nodes cannot say: the job has rows only.";
/// What the job says where supports hold a mechanism.
pub(super) const HELD_ROWS: &str =
    "Supports hold what the nodes say of rigid-body motion, and it moves otherwise: the job has rows only.";

/// Rotations that supports hold alone, as the job of the superelement says.
pub(super) fn held_rotations(superelement: &Superelement) -> Vec<String> {
    let held = superelement.metadata().job["model"]["held_rotations"].as_array().into_iter().flatten();
    held.filter_map(|direction| direction.as_str().map(str::to_owned)).collect()
}

/// Rotations that supports hold alone, by the job and by the motions of the superelement: its job may hold them as dofs that are at rest.
fn with_held_alone(
    (superelement, assumes): (&Superelement, &AssumesJob),
    [k, m, u]: &[Mat<f64>; 3],
) -> Result<Vec<String>> {
    let rows = (&*places(superelement), &*masses(superelement));
    let found = rotations_held_alone(rows, [k.as_ref(), m.as_ref()], (u.as_ref(), assumes))?;
    let all: BTreeSet<String> =
        held_rotations(superelement).into_iter().chain(found.iter().map(ToString::to_string)).collect();
    Ok(all.into_iter().collect())
}

/// Whether the superelement has motions without energy that its nodes do not explain: the reduction that made it found them, and the digits of
/// its matrices are those of all of it.
fn gives_way_inside(superelement: &Superelement, [k, m, u]: &[Mat<f64>; 3]) -> Result<bool> {
    gives_way((&places(superelement), &masses(superelement)), [k.as_ref(), m.as_ref()], u.as_ref())
}

/// What the job of the superelement says of mechanisms.
pub(super) fn mechanisms(superelement: &Superelement) -> Mechanisms {
    Mechanisms::deserialize(&superelement.metadata().job["model"]["mechanisms"]).unwrap_or_default()
}

/// One table for each interface; rows where there are no nodes.
fn interfaces(superelement: &Superelement, labels: &[i64]) -> Vec<Selection> {
    let mut selections = Vec::new();
    let nodes = &superelement.metadata().interface_nodes;
    if nodes.is_empty() && superelement.n_interface() > 0 {
        let (name, nodes) = ("interface".to_owned(), rows(0..superelement.n_interface()));
        selections.push(Selection { name, nodes, dofs: None });
    }
    let mut first = 0;
    while first < nodes.len() {
        let n = nodes[first..].iter().take_while(|node| node.name == nodes[first].name).count();
        let of_interface = &labels[first..first + n];
        // A node of two interfaces has dofs of both.
        let is_shared = of_interface.iter().any(|label| labels.iter().filter(|other| *other == label).count() > 1);
        let dofs = is_shared.then(|| directions(&nodes[first]));
        selections.push(Selection { name: nodes[first].name.clone(), nodes: of_interface.to_vec().into(), dofs });
        first += n;
    }
    selections
}

/// One table of rows for each interface.
fn interfaces_of_rows(superelement: &Superelement) -> Vec<Selection> {
    let metadata = superelement.metadata();
    let name_of = |coordinate: &Coordinate| match coordinate {
        Coordinate::Interface { node, .. } => metadata.interface_nodes[*node].name.clone(),
        _ => "interface".to_owned(),
    };
    let names: Vec<String> = metadata.coordinates[..superelement.n_interface()].iter().map(name_of).collect();
    let mut first = 0;
    let of_name = |name: &[String]| {
        let own = first..first + name.len();
        first = own.end;
        Selection { name: name[0].clone(), nodes: rows(own), dofs: None }
    };
    names.chunk_by(|a, b| a == b).map(of_name).collect()
}

/// The loads; with a residual vector where the superelement has one.
fn loads(superelement: &Superelement) -> Vec<LoadColumn> {
    let metadata = superelement.metadata();
    let load = |(column, name): (usize, &String)| {
        let is_its_own =
            |coordinate: &Coordinate| matches!(coordinate, Coordinate::ResidualVector { load } if *load == column);
        LoadColumn { name: name.clone(), residual: metadata.named_columns().any(is_its_own) }
    };
    metadata.load_names.iter().enumerate().map(load).collect()
}

fn directions(node: &InterfaceNode) -> Vec<String> {
    node.dofs.iter().map(ToString::to_string).collect()
}

/// Directions of interfaces that were held while the modes were computed: of a direction all nodes of an interface are held, or none.
fn held(metadata: &Metadata) -> Vec<String> {
    let of = |held: &usize| match &metadata.coordinates[*held] {
        Coordinate::Interface { node, direction } => {
            Some(format!("{}.{direction}", metadata.interface_nodes[*node].name))
        }
        _ => None,
    };
    let names: BTreeSet<String> = metadata.modes_held.iter().filter_map(of).collect();
    names.into_iter().collect()
}

/// The interfaces that were held while the modes were computed, where nothing else was; none otherwise.
fn held_interfaces(metadata: &Metadata) -> Vec<String> {
    let interface_of = |coordinate: &Coordinate| match coordinate {
        Coordinate::Interface { node, .. } => Some(metadata.interface_nodes[*node].name.clone()),
        _ => None,
    };
    let count = |coordinates: &mut dyn Iterator<Item = &Coordinate>| {
        let mut counts: BTreeMap<String, usize> = BTreeMap::new();
        coordinates.filter_map(interface_of).for_each(|name| *counts.entry(name).or_default() += 1);
        counts
    };
    let held = count(&mut metadata.modes_held.iter().map(|held| &metadata.coordinates[*held]));
    let all = count(&mut metadata.coordinates.iter());
    let is_whole = |(name, n): (&String, &usize)| all.get(name) == Some(n);
    if held.iter().all(is_whole) { held.into_keys().collect() } else { Vec::new() }
}

/// What the job says where it cannot hold what its superelement held.
const HELD_IN_PART: &str = "Rows of one interface cannot be held in part: the method is craig-bampton.";

/// How many modes it keeps again. Modes that were left out because others span them are found again, as far as there are coordinates for
/// them; modes that nothing starts or sees are not.
pub(super) fn n_modes(superelement: &Superelement) -> usize {
    let metadata = superelement.metadata();
    let is_mode = |coordinate: &&Coordinate| {
        coordinate.mode().is_some() || matches!(coordinate, Coordinate::ExpansionMode { .. })
    };
    let n_named = metadata.named_columns().filter(is_mode).count() - metadata.unseen_modes().count();
    let n_still = match metadata.method {
        Method::Herting | Method::Rubin | Method::Macneal => superelement.n_rigid(),
        Method::CraigBampton | Method::ModeAcceleration | Method::MixedInterface | Method::Guyan => {
            superelement.n_interface()
        }
    };
    n_named.min(superelement.n_coordinates().saturating_sub(n_still))
}

/// The method that makes the superelement of its own matrices, and whether inertia relief is to be asked for.
pub(super) fn method(superelement: &Superelement) -> (&'static str, Relief) {
    let (metadata, n_modes) = (superelement.metadata(), n_modes(superelement));
    let has_relief =
        metadata.coordinates.iter().any(|coordinate| matches!(coordinate, Coordinate::InertiaRelief { .. }));
    let relief = if has_relief { Relief::Asked } else { Relief::NotAsked };
    match metadata.method {
        Method::MixedInterface if n_modes > 0 && !metadata.interface_nodes.is_empty() => ("mixed-interface", relief),
        // Rows of one interface cannot be held in part.
        Method::CraigBampton | Method::ModeAcceleration | Method::MixedInterface if n_modes > 0 => {
            ("craig-bampton", relief)
        }
        Method::CraigBampton | Method::ModeAcceleration | Method::MixedInterface | Method::Guyan => ("guyan", relief),
        Method::Rubin if superelement.has_rigid_amplitudes() => ("rubin", Relief::NotAsked),
        // Any other file of Rubin's method is in Herting's coordinates.
        Method::Herting | Method::Rubin | Method::Macneal => ("herting", Relief::NotAsked),
    }
}
