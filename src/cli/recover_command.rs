//! What was typed after `supel recover`, checked.

use std::path::PathBuf;

use super::superelement_flags::RecoverFlags;
use super::unverified::Unverified;
use crate::error::{Error, Result};
use crate::job::ends_in;
use crate::recovery::StateFiles;

/// Expand states of a simulation.
#[derive(Debug)]
pub(super) struct RecoverCommand {
    pub(super) file: PathBuf,
    pub(super) states: StateFiles,
    /// Where the motion of the recovered nodes goes.
    pub(super) output: Option<PathBuf>,
    /// Where it goes as a series for ParaView.
    pub(super) vtkhdf: Option<PathBuf>,
    /// Where the quantities go.
    pub(super) quantities: Option<PathBuf>,
    /// Where the loads on the interface go.
    pub(super) loads: Option<PathBuf>,
    /// The field of gravity in which they act.
    pub(super) gravity: Option<[f64; 3]>,
    pub(super) unverified: Unverified,
}

impl RecoverCommand {
    pub(super) fn build(flags: RecoverFlags) -> Result<Self> {
        let RecoverFlags { file, state, velocity, acceleration, output, vtkhdf, quantities, loads, .. } = flags;
        for (flag, path) in [("--output", &output), ("--quantities", &quantities), ("--loads", &loads)] {
            path.as_ref().map_or(Ok(()), |path| ends_in(flag, path, ".csv"))?;
        }
        vtkhdf.as_ref().map_or(Ok(()), |path| ends_in("--vtkhdf", path, ".vtkhdf"))?;
        Ok(Self {
            file,
            states: StateFiles { displacement: state, velocity, acceleration },
            output,
            vtkhdf,
            quantities,
            loads,
            gravity: flags.gravity.as_deref().map(acceleration_of).transpose()?,
            unverified: flags.allow_unverified.into(),
        })
    }
}

/// Three numbers.
fn acceleration_of(text: &str) -> Result<[f64; 3]> {
    let number = |word: &str| word.trim().parse().ok().filter(|value: &f64| value.is_finite());
    let numbers: Option<Vec<f64>> = text.split(',').map(number).collect();
    let wrong = || Error::FlagText {
        flag: "--gravity",
        text: text.to_owned(),
        expected: "an acceleration along x, y and z, as in --gravity=0,0,-9.81",
    };
    numbers.and_then(|numbers| numbers.try_into().ok()).ok_or_else(wrong)
}
