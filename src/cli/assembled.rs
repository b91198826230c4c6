//! The assembly of a command line, made of the files that it names.

use supel_runtime::{Superelement, Verdict};

use super::assembly_command::AssemblyCommand;
use super::memory;
use crate::assembly::{self, Assembly, Component};
use crate::error::{Error, Result};
use crate::input;
use crate::memory_forecast::Resources;

/// The files of an assembly, before anything is joined.
pub(super) struct Files {
    /// Each with the name of its component.
    read: Vec<(String, Superelement)>,
    /// BLAKE3, one for each component.
    pub(super) digests: Vec<String>,
}

impl Files {
    /// # Errors
    /// Those of reading superelements; [`Error::MemoryAssembly`].
    pub(super) fn read(command: &AssemblyCommand) -> Result<Self> {
        let (mut read, mut digests) = (Vec::new(), Vec::new());
        for (name, path) in &command.components {
            let (superelement, _) = input::superelement(path)?;
            let bytes = superelement.to_bytes().map_err(|error| Error::of_superelement(path, error))?;
            digests.push(bytes.digest);
            read.push((name.clone(), superelement));
        }
        let n = read.iter().map(|(_, superelement)| superelement.n_coordinates()).sum();
        assembly::within_memory(n, Resources { memory_bytes: memory::available_bytes(), cache: None })?;
        Ok(Self { read, digests })
    }

    /// What each file records of its verification.
    pub(super) fn verdicts(&self) -> impl Iterator<Item = Verdict> {
        self.read.iter().map(|(_, superelement)| superelement.metadata().verification.verdict)
    }

    /// The components, joined, held and loaded.
    ///
    /// # Errors
    /// Those of [`Component::new`], [`Assembly::join`], [`Assembly::fix`] and [`Assembly::load`].
    pub(super) fn assembled(self, command: &AssemblyCommand) -> Result<Assembly> {
        let mut components = Vec::new();
        for (name, superelement) in self.read {
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
        Ok(assembly)
    }
}
