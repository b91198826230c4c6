//! `supel modes`: the modes of superelements that are joined, held and loaded at their interfaces.

use super::answer::Terminal;
use super::exit_code::ExitCode;
use super::memory;
use super::modes_command::{ModesAnswer, ModesCommand};
use super::superelement_file;
use crate::assembly::{self, Assembly, Component};
use crate::error::{Error, Result};
use crate::memory_forecast::Resources;
use crate::report::ModesReport;

pub(super) fn run(command: &ModesCommand, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let mut read = Vec::new();
    let mut digests = Vec::new();
    for (name, path) in &command.components {
        let (superelement, _) = superelement_file::read(path)?;
        let bytes = superelement.to_bytes().map_err(|error| Error::of_superelement(path, error))?;
        digests.push(bytes.digest);
        read.push((name.clone(), superelement));
    }
    let n = read.iter().map(|(_, superelement)| superelement.n_coordinates()).sum();
    assembly::within_memory(n, Resources { memory_bytes: memory::available_bytes() })?;
    let mut components = Vec::new();
    for (name, superelement) in read {
        components.push(Component::new(name, superelement)?);
    }
    let mut assembly = Assembly::new(components)?;
    for (a, b) in &command.joins {
        assembly.join(a, b)?;
    }
    for selection in &command.fixes {
        assembly.fix(selection)?;
    }
    for (selection, mass) in &command.masses {
        assembly.load(selection, *mass)?;
    }
    let modes = assembly.modes(command.wanted)?;
    let report = ModesReport { assembly: &assembly, digests: &digests, modes: &modes };
    match command.answer {
        ModesAnswer::Text => terminal.answer(&report.to_text(terminal.paint)),
        ModesAnswer::Json => terminal.answer(&report.to_json()?),
    }
    Ok(ExitCode::Done)
}
