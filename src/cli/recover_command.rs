//! What was typed after `supel recover`, checked.

use std::path::PathBuf;

use super::flags::RecoverFlags;
use super::unverified::Unverified;
use crate::error::Result;
use crate::expansion::StateFiles;
use crate::job::ends_in;

/// Expand states of a simulation.
#[derive(Debug)]
pub(super) struct RecoverCommand {
    pub(super) file: PathBuf,
    pub(super) states: StateFiles,
    /// Where the motion of the recovered nodes goes.
    pub(super) output: PathBuf,
    pub(super) unverified: Unverified,
}

impl RecoverCommand {
    pub(super) fn build(flags: RecoverFlags) -> Result<Self> {
        let RecoverFlags { file, state, velocity, acceleration, output, allow_unverified } = flags;
        ends_in("--output", &output, ".csv")?;
        Ok(Self {
            file,
            states: StateFiles { displacement: state, velocity, acceleration },
            output,
            unverified: Unverified::of(allow_unverified),
        })
    }
}
