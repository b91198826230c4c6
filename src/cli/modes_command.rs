//! What was typed after `supel modes`, checked.

use super::assembly_command::{AssemblyCommand, in_range};
use super::superelement_flags::ModesFlags;
use crate::assembly::Wanted;
use crate::error::Result;

/// Modes shown where the command line does not say how many.
const DEFAULT_COUNT: usize = 20;

/// The modes of an assembly.
#[derive(Debug)]
pub(super) struct ModesCommand {
    pub(super) assembly: AssemblyCommand,
    pub(super) wanted: Wanted,
    pub(super) answer: ModesAnswer,
}

/// What `supel modes` prints.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum ModesAnswer {
    Text,
    Json,
}

impl ModesCommand {
    pub(super) fn build(flags: ModesFlags) -> Result<Self> {
        let ModesFlags { files, assembly, count, up_to_hz, json } = flags;
        let wanted = match (count, up_to_hz) {
            (_, Some(hz)) => Wanted::UpTo(in_range("--up-to-hz", hz, "zero or more, and at most 1e100")?),
            (count, None) => Wanted::Count(count.map_or(DEFAULT_COUNT, |count| count as usize)),
        };
        Ok(Self {
            assembly: AssemblyCommand::build(&files, assembly)?,
            wanted,
            answer: if json { ModesAnswer::Json } else { ModesAnswer::Text },
        })
    }
}
