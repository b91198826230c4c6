//! `supel recover`: states of a simulation expanded to what happens inside the component.

use std::path::Path;

use supel_runtime::{Flag, Precision, Recovery, Superelement, Verdict};

use super::answer::Terminal;
use super::exit_code::ExitCode;
use super::outputs::{Outputs, abandoned, writer};
use super::overwriting::{Named, OwnFiles};
use super::recover_command::RecoverCommand;
use super::unverified::refusal;
use crate::error::{Error, Result};
use crate::input;
use crate::number;
use crate::recovery::{
    Displacements, InterfaceLoads, MotionSeries, Order, Quantities, Sheet, SheetOutput, States, coordinate_names, fill,
};
use crate::report::printable;

pub(super) fn run(command: &RecoverCommand, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let (superelement, _) = input::superelement(&command.file)?;
    let verdict = superelement.metadata().verification.verdict;
    if command.unverified.refuses(verdict) {
        terminal.complain(&refusal(&command.file, "nothing recovered", "use"));
        return Ok(ExitCode::CheckFailed);
    }
    let sheets = sheets(command, &superelement)?;
    let points = command.vtkhdf.as_deref().map(|path| points(path, &command.file, &superelement)).transpose()?;
    let named = sheets.iter().map(|sheet| (sheet.flag, sheet.path.to_owned()));
    let outputs: Vec<Named> = named.chain(points.iter().map(|points| ("--vtkhdf", points.path.to_owned()))).collect();
    let own = OwnFiles::of(&inputs(command), &outputs)?;
    let complaints = abandoned(&own);
    let mut states = States::open(&command.states, &coordinate_names(&superelement))?;
    let n_states = write(&own, &mut states, &sheets, points.as_ref())?;
    let states = number::counted(n_states, "state", "states");
    for sheet in &sheets {
        let path = sheet.path.display().to_string();
        terminal.answer(&format!("{}: {} in {states}\n", printable(&path), sheet.content));
    }
    if let Some(Points { path, positions, .. }) = &points {
        let (path, nodes) = (path.display().to_string(), number::counted(positions.len() as u64, "node", "nodes"));
        terminal.answer(&format!("{}: motion of {nodes} in {states}\n", printable(&path)));
    }
    complaints.iter().for_each(|complaint| terminal.complain(complaint));
    Ok(if verdict == Verdict::Fail { ExitCode::CheckFailed } else { ExitCode::Done })
}

/// Results that are asked for, where they go and what they are.
struct Asked<'a> {
    flag: &'static str,
    path: &'a Path,
    content: String,
    sheet: Box<dyn Sheet + 'a>,
}

/// A series for ParaView that is asked for.
struct Points<'a> {
    path: &'a Path,
    recovery: &'a Recovery,
    positions: &'a [[f64; 3]],
}

fn points<'a>(path: &'a Path, file: &Path, superelement: &'a Superelement) -> Result<Points<'a>> {
    let recovery = superelement.tensors().recovery.as_ref();
    let recovery = recovery.ok_or_else(|| lacking(file, "recovered nodes", "--vtkhdf", "write.recovery"))?;
    let positions = recovery.positions();
    let positions =
        positions.ok_or_else(|| lacking(file, "positions of recovered nodes", "--vtkhdf", "model.nodes"))?;
    Ok(Points { path, recovery, positions })
}

fn sheets<'a>(command: &'a RecoverCommand, superelement: &'a Superelement) -> Result<Vec<Asked<'a>>> {
    let motion = command.output.as_deref().map(|path| motion(path, &command.file, superelement));
    let quantities = command.quantities.as_deref().map(|path| quantities(path, &command.file, superelement));
    let loads = command.loads.as_deref().map(|path| loads(path, command, superelement));
    [motion, quantities, loads].into_iter().flatten().collect()
}

fn motion<'a>(path: &'a Path, file: &Path, superelement: &'a Superelement) -> Result<Asked<'a>> {
    let recovery = superelement.tensors().recovery.as_ref();
    let recovery = recovery.ok_or_else(|| lacking(file, "recovered nodes", "--output", "write.recovery"))?;
    let rows = number::counted(recovery.dofs().len() as u64, "degree of freedom", "degrees of freedom");
    let digits = match recovery.precision() {
        Precision::Double => "",
        Precision::Single => ", to the seven digits of single precision",
    };
    let content = format!("motion of {rows}{digits}");
    Ok(Asked { flag: "--output", path, content, sheet: Box::new(Displacements::new(recovery)) })
}

fn quantities<'a>(path: &'a Path, file: &Path, superelement: &'a Superelement) -> Result<Asked<'a>> {
    let rows = superelement.tensors().quantities.as_ref();
    let rows = rows.ok_or_else(|| lacking(file, "quantities", "--quantities", "write.quantities"))?;
    let content = number::counted(rows.rows() as u64, "quantity", "quantities");
    let sheet = Box::new(Quantities::new(&superelement.metadata().quantities, rows));
    Ok(Asked { flag: "--quantities", path, content, sheet })
}

fn loads<'a>(path: &'a Path, command: &RecoverCommand, superelement: &'a Superelement) -> Result<Asked<'a>> {
    if superelement.n_interface() == 0 {
        return Err(lacking(&command.file, "interface", "--loads", "[[interface]]"));
    }
    let has_acceleration = command.states.path(Order::Acceleration).is_some();
    if has_acceleration && superelement.metadata().flags.contains(&Flag::StiffnessOnly) {
        return Err(lacking(&command.file, "mass", "--acceleration", "scene.analysis"));
    }
    let sheet = InterfaceLoads::new(superelement);
    let sheet = match (&command.gravity, &superelement.tensors().gravity) {
        (None, _) => sheet,
        (Some(field), _) if !superelement.metadata().validity.allows_gravity(*field) => {
            return Err(lacking(&command.file, "answer to gravity along that direction", "--gravity", "scene.gravity"));
        }
        (Some(field), Some(of_file)) => sheet.with_gravity(of_file, field),
        (Some(_), None) => {
            return Err(lacking(&command.file, "loads of gravity", "--gravity", key_of_gravity(superelement)));
        }
    };
    let inertia = if has_acceleration { "" } else { ", without those of inertia," };
    Ok(Asked { flag: "--loads", path, content: format!("loads on the interface{inertia}"), sheet: Box::new(sheet) })
}

/// What puts loads of gravity into a file: directions and coordinates, and where its job has both, one body that is free or one that is held.
fn key_of_gravity(superelement: &Superelement) -> &'static str {
    let model = &superelement.metadata().job["model"];
    match model["dofs"].is_null() || model["nodes"].is_null() {
        true => "model.dofs and model.nodes",
        false => "a model of one free body with six rigid-body motions, or with [[fixed]]",
    }
}

/// What the file lacks for what a flag wants, and the key of the job that writes it.
fn lacking(file: &Path, missing: &'static str, wanted: &'static str, key: &'static str) -> Error {
    Error::NoRecovery { path: file.to_owned(), missing, wanted, key }
}

fn inputs(command: &RecoverCommand) -> Vec<Named> {
    let tables =
        Order::ALL.into_iter().filter_map(|order| Some(("a table of states", command.states.path(order)?.to_owned())));
    std::iter::once(("the superelement", command.file.clone())).chain(tables).collect()
}

/// Writes all sheets and the series, and gives them their names when all are complete.
fn write(own: &OwnFiles, states: &mut States, sheets: &[Asked<'_>], points: Option<&Points<'_>>) -> Result<u64> {
    let mut writers = sheets.iter().map(|asked| writer(own, asked.path)).collect::<Result<Vec<_>>>()?;
    let staged = points.map(|points| writer(own, points.path)).transpose()?;
    let mut series = match points.zip(staged.as_ref()) {
        Some((Points { path, recovery, positions }, staged)) => {
            Some(MotionSeries::create(staged.path(), path, recovery, positions, &states.orders())?)
        }
        None => None,
    };
    let both = sheets.iter().zip(&mut writers);
    let mut to_fill: Vec<SheetOutput<'_>> =
        both.map(|(asked, out)| SheetOutput { sheet: asked.sheet.as_ref(), path: asked.path, out }).collect();
    let n_states = fill(states, &mut to_fill, series.as_mut())?;
    drop(to_fill);
    series.map_or(Ok(()), MotionSeries::finish)?;
    let mut outputs = Outputs::new(own);
    for writer in writers.into_iter().chain(staged) {
        outputs.push(writer.finish().map_err(Error::of_writing)?);
    }
    outputs.commit()?;
    Ok(n_states)
}
