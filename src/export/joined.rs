//! An assembly as one model: matrices, dof map and nodes of the whole, and the job that reduces it to one superelement.
//!
//! The components leave out modes from some frequency on, and a second reduction cannot have back what they left out. So the job keeps
//! modes up to the lowest of these frequencies and no further.

use std::collections::BTreeSet;

use faer::{Mat, MatRef};
use supel_runtime::{Direction, Flag, Matrix, Superelement};
use toml::Value;

use super::assumed::assumed_by_all;
use super::job_text::{JobText, LoadColumn, Map, Mass, Modes, Relief, Selection, rows};
use super::left_behind::not_of_a_model;
use super::model_job::{HELD_ROWS, MOVING_ROWS, held_rotations, mechanisms, method, n_modes};
use super::strainless_motion::{gives_way, is_held_and_gives_way, rotations_held_alone};
use crate::assembly::{Assembly, Component, JoinedModel, JoinedSelection, Members, Omitted};
use crate::dense;
use crate::error::Result;
use crate::input::condensed_digits::{FEWEST_DIGITS, digits, digits_of};
use crate::input::strainless::{self, balance, lengths};
use crate::job::Mechanisms;
use crate::number::quantity;

/// An assembly that leaves as one model.
#[derive(Clone, Debug)]
pub struct Joined {
    /// What is not carried, and why there is no job where there is none.
    pub notes: Vec<String>,
    pub(super) model: JoinedModel,
    pub(super) job: Option<JobText>,
}

impl Joined {
    /// The model of an assembly; `kept` names joined interfaces that remain interfaces.
    ///
    /// # Errors
    /// Those of [`Assembly::model`].
    pub fn new(assembly: &Assembly, kept: &[String]) -> Result<Self> {
        let mut model = assembly.model(kept)?;
        let lengths = lengths(&places(&model), &dense::diagonal(model.mass.as_ref()));
        balance(&mut model.stiffness, model.rigid.as_ref(), &lengths)?;
        let mut notes = assembly.notes.clone();
        notes.extend(assembly.joined_to_nothing().map(|name| format!("{name} is joined to nothing")));
        notes.extend(assembly.components.iter().filter_map(left_behind));
        let unseen = assembly.components.iter().filter_map(Component::unseen_modes);
        notes.extend(unseen.map(|unseen| format!("{unseen}: the whole has them in addition to what the model has")));
        notes.extend(
            assumed_by_all(assembly).sentences.into_iter().map(|sentence| format!("takes for granted: {sentence}")),
        );
        let digits = stated_digits(assembly, &model)?;
        let without = without_job(assembly, &model, digits);
        let job = match without {
            Some(why) => {
                notes.push(format!("there is no job that reduces it: {why}"));
                None
            }
            None => Some(job(assembly, &model, digits)?),
        };
        Ok(Self { notes, model, job })
    }
}

/// Direction and position of the rows of nodes.
fn places(model: &JoinedModel) -> Vec<Option<(Direction, [f64; 3])>> {
    model.rows.iter().map(|row| row.at.map(|(node, direction)| (direction, model.nodes[node].position))).collect()
}

/// A matrix for a file.
pub(super) fn packed(a: &faer::Mat<f64>) -> Matrix {
    Matrix::from_fn(a.nrows(), a.ncols(), |i, j| a[(i, j)])
}

/// What a component has that the model of the whole has not.
fn left_behind(component: &Component) -> Option<String> {
    let superelement = &component.superelement;
    let names = not_of_a_model(superelement);
    (!names.is_empty())
        .then(|| format!("{} has {}, which the model of the whole does not have", component.name, names.join(", ")))
}

/// The digits of the matrices of the whole, or those that a component that has fewer states of itself. One that its interface just
/// holds has no stiffness there but rounding, which is judged with the stiffness of the others.
fn stated_digits(assembly: &Assembly, model: &JoinedModel) -> Result<Option<i64>> {
    let mut least = digits([&model.stiffness, &model.mass, &model.rigid].map(Mat::as_ref), &places(model))?;
    for component in &assembly.components {
        let stiffness = strainless::condensed_stiffness(&component.superelement)?.stiffness;
        let own = digits_of(&component.superelement, &stiffness)?.filter(|own| *own >= FEWEST_DIGITS);
        least = least.into_iter().chain(own).min();
    }
    Ok(least)
}

/// Why nothing reduces the model.
fn without_job(assembly: &Assembly, model: &JoinedModel, digits: Option<i64>) -> Option<String> {
    let first = |is_one: &dyn Fn(&Superelement) -> bool| {
        assembly.components.iter().find(|component| is_one(&component.superelement)).map(|component| &component.name)
    };
    if let Some(name) = first(&|superelement| superelement.metadata().flags.contains(&Flag::Preloaded)) {
        return Some(format!("{name} is preloaded, and its internal forces are not in its file"));
    }
    if let Some(name) = first(&|superelement| superelement.n_interface() == 0) {
        return Some(format!("{name} has no interface, and its motion has no place"));
    }
    if model.n_interface() == 0 {
        return Some("no interface is left – keep one that is joined by --keep".to_owned());
    }
    if model.rigid.ncols() >= model.rows.len() || digits.is_some_and(|digits| digits < FEWEST_DIGITS) {
        return Some("its stiffness is nothing but rounding".to_owned());
    }
    None
}

fn job(assembly: &Assembly, model: &JoinedModel, digits: Option<i64>) -> Result<JobText> {
    let superelements = || assembly.components.iter().map(|component| &component.superelement);
    let (method, relief) = method_of_whole(assembly);
    let band = band(assembly);
    let n_still = if matches!(method, "herting" | "rubin") { model.rigid.ncols() } else { model.n_interface() };
    let n_left = (model.rows.len() - model.n_fixed()).saturating_sub(n_still);
    let count = superelements().map(n_modes).sum::<usize>().min(n_left);
    let modes = match band {
        Ok(Some((hz, _))) => Some(Modes::UpTo(hz)),
        Ok(None) | Err(_) => (count > 0).then_some(Modes::Count(count)),
    };
    let method = if modes.is_none() { "guyan" } else { method };
    let loads = model.load_names.iter();
    let without_nodes = if superelements().any(Superelement::has_rigid_amplitudes) {
        Some(MOVING_ROWS)
    } else {
        is_held_and_gives_way((&places(model), &dense::diagonal(model.mass.as_ref())), model.rigid.as_ref())?
            .then_some(HELD_ROWS)
    };
    let assumes = assumed_by_all(assembly);
    let mut held: BTreeSet<String> = superelements().flat_map(held_rotations).collect();
    if without_nodes.is_none() {
        let rows = (&*places(model), &*dense::diagonal(model.mass.as_ref()));
        let found = rotations_held_alone(rows, matrices(model), (model.rigid.as_ref(), &assumes))?;
        held.extend(found.iter().map(ToString::to_string));
    }
    let mut remarks = remarks(assembly, &band);
    remarks.extend(without_nodes.map(str::to_owned));
    let on_held = model.loads_on_held.iter();
    remarks.extend(on_held.map(|name| format!("The load {name} is left out: all of it is on held dofs.")));
    let selection = |own: &JoinedSelection| match without_nodes {
        Some(_) => selection_of_rows(own, model),
        None => selection(own),
    };
    Ok(JobText {
        remarks,
        map: if model.nodes.is_empty() || without_nodes.is_some() { Map::Rows } else { Map::Nodes },
        mass: Mass::InFile,
        units: superelements().find_map(|superelement| superelement.metadata().units.clone()),
        held_rotations: held.into_iter().collect(),
        mechanisms: mechanisms_of_whole(assembly, model)?,
        digits,
        assumes,
        interfaces: model.interfaces.iter().map(selection).collect(),
        fixed: model.fixed.iter().map(selection).collect(),
        loads: loads.map(|(name, residual)| LoadColumn { name: name.clone(), residual: *residual }).collect(),
        method,
        modes: modes.filter(|_| method != "guyan"),
        relief,
        held: None,
    })
}

fn matrices(model: &JoinedModel) -> [MatRef<'_, f64>; 2] {
    [model.stiffness.as_ref(), model.mass.as_ref()]
}

/// Mechanisms are meant where a component says so, and where one was found in a component or joints leave one.
fn mechanisms_of_whole(assembly: &Assembly, model: &JoinedModel) -> Result<Mechanisms> {
    let is_said = |component: &Component| mechanisms(&component.superelement) == Mechanisms::Accept;
    let rows = (&*places(model), &*dense::diagonal(model.mass.as_ref()));
    let is_meant = assembly.components.iter().any(is_said) || gives_way(rows, matrices(model), model.rigid.as_ref())?;
    Ok(if is_meant { Mechanisms::Accept } else { Mechanisms::Warn })
}

/// Herting's method where all components are in its coordinates, Rubin's where an interface leaves rigid-body motion free, Guyan's where none has modes; modes with the interface held otherwise.
fn method_of_whole(assembly: &Assembly) -> (&'static str, Relief) {
    let methods: Vec<(&str, Relief)> =
        assembly.components.iter().map(|component| method(&component.superelement)).collect();
    let relief =
        if methods.iter().any(|(_, relief)| *relief == Relief::Asked) { Relief::Asked } else { Relief::NotAsked };
    let with_modes: Vec<&str> = methods.iter().map(|(method, _)| *method).filter(|method| *method != "guyan").collect();
    match with_modes.first() {
        None => ("guyan", relief),
        Some(_) if with_modes.iter().all(|method| matches!(*method, "herting" | "rubin")) => {
            (if with_modes.contains(&"rubin") { "rubin" } else { "herting" }, Relief::NotAsked)
        }
        Some(_) => ("craig-bampton", relief),
    }
}

/// The lowest frequency from which on a component leaves modes out, with its name; none where none leaves any out.
///
/// # Errors
/// The name of a component that does not say, and why it does not.
fn band(assembly: &Assembly) -> std::result::Result<Option<(f64, &str)>, (&str, &str)> {
    let mut lowest: Option<(f64, &str)> = None;
    for component in &assembly.components {
        match &component.omitted {
            Omitted::Nothing => {}
            Omitted::Above { hz, .. } => {
                lowest = lowest.filter(|(least, _)| least <= hz).or(Some((*hz, &component.name)));
            }
            Omitted::Unknown { why } | Omitted::InDoubt { why } => return Err((&component.name, why)),
        }
    }
    Ok(lowest)
}

/// What the job says of itself.
fn remarks(assembly: &Assembly, band: &std::result::Result<Option<(f64, &str)>, (&str, &str)>) -> Vec<String> {
    let names: Vec<&str> = assembly.components.iter().map(|component| component.name.as_str()).collect();
    let mut remarks = vec![format!("Superelements joined: {}.", names.join(", "))];
    remarks.extend(assembly.joints.iter().map(|joint| format!("{} = {} are one.", joint.a, joint.b)));
    remarks.extend(assembly.loaded.iter().map(|loaded| {
        let [mass, x, y, z] =
            [loaded.mass.mass, loaded.mass.inertia[0], loaded.mass.inertia[1], loaded.mass.inertia[2]];
        format!("The mass has {mass} at {}, and moments of inertia {x}, {y}, {z}.", loaded.name)
    }));
    remarks.push(
        "Its frequencies are not below those of the full models, joined: `supel modes` bounds the difference."
            .to_owned(),
    );
    remarks.push(match band {
        Ok(Some((hz, name))) => format!(
            "{name} leaves out modes from {} Hz on. No reduction brings them back: do not ask for modes above that.",
            quantity(*hz, 6)
        ),
        Ok(None) => "The components leave out nothing.".to_owned(),
        Err((name, why)) => format!("From which frequency on {name} leaves out modes is not known: {why}."),
    });
    remarks
}

/// Labels of nodes are their numbers from one.
fn selection(selection: &JoinedSelection) -> Selection {
    let name = selection.name.clone();
    match &selection.members {
        Members::Rows(of) => Selection { name, nodes: rows(of.iter().copied()), dofs: None },
        Members::Nodes { nodes, dofs } => {
            let labels: Vec<i64> = nodes.iter().map(|node| label(*node)).collect();
            let dofs = dofs.as_ref().map(|dofs| dofs.iter().map(ToString::to_string).collect());
            Selection { name, nodes: Value::from(labels), dofs }
        }
    }
}

/// The rows of a selection.
fn selection_of_rows(selection: &JoinedSelection, model: &JoinedModel) -> Selection {
    let has = |(node, direction): (usize, Direction)| match &selection.members {
        Members::Nodes { nodes, dofs } => {
            nodes.contains(&node) && dofs.as_ref().is_none_or(|dofs| dofs.contains(&direction))
        }
        Members::Rows(_) => false,
    };
    let own: Vec<usize> = match &selection.members {
        Members::Rows(own) => own.clone(),
        Members::Nodes { .. } => (0..model.rows.len()).filter(|row| model.rows[*row].at.is_some_and(has)).collect(),
    };
    Selection { name: selection.name.clone(), nodes: rows(own), dofs: None }
}

/// The label of a node.
pub(super) fn label(node: usize) -> i64 {
    node as i64 + 1
}
