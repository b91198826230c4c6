//! What was typed after `supel certify`, checked.

use std::path::PathBuf;

use super::judging::{Answer, Strictness};
use super::selection_flags::numbers;
use super::subject_command::SubjectCommand;
use super::subject_flags::CertifyFlags;
use crate::certification::{Band, PairFiles, ReducedFiles, ResultFiles};
use crate::error::{Error, Result};
use crate::input::{ValueSource, ValueUnit};
use crate::job::ends_in;

/// A result to be held against its model.
#[derive(Debug)]
pub(super) struct CertifyCommand {
    pub(super) subject: SubjectCommand,
    pub(super) files: ResultFiles,
    pub(super) band: Option<Band>,
    pub(super) html: Option<PathBuf>,
    pub(super) junit: Option<PathBuf>,
    pub(super) answer: Answer,
    pub(super) strictness: Strictness,
}

impl CertifyCommand {
    /// # Errors
    /// Those of [`SubjectCommand::build`]; [`Error::FlagText`] for a band that is none; [`Error::OutputName`] for an output whose name
    /// ends otherwise.
    pub(super) fn build(flags: CertifyFlags) -> Result<Self> {
        let CertifyFlags { subject, result, rows, html, junit, json, quiet, strict, .. } = flags;
        let CertifyFlags { hz, rad_per_s, eigenvalues, reduced_stiffness, reduced_mass, band, .. } = flags;
        let units =
            [(ValueUnit::Hertz, hz), (ValueUnit::RadPerSecond, rad_per_s), (ValueUnit::Eigenvalue, eigenvalues)];
        let values = units.into_iter().find_map(|(unit, text)| Some((unit, value_source(&text?))));
        let files = match (reduced_stiffness, reduced_mass) {
            (Some(stiffness), Some(mass)) => ResultFiles::Superelement(ReducedFiles { basis: result, stiffness, mass }),
            _ => ResultFiles::Pairs(PairFiles { shapes: result, values }),
        };
        for (key, path, ending) in [("--html", &html, ".html"), ("--junit", &junit, ".xml")] {
            path.as_deref().map_or(Ok(()), |path| ends_in(key, path, ending))?;
        }
        let strictness = Strictness::from(strict);
        let SubjectCommand { job, threads } = SubjectCommand::build(subject, rows, 0)?;
        Ok(Self {
            subject: SubjectCommand { job: strictness.reading(job), threads },
            files,
            band: band.as_deref().map(band_of).transpose()?,
            html,
            junit,
            answer: Answer::from((json, quiet)),
            strictness,
        })
    }
}

/// Numbers between commas, or a file.
fn value_source(text: &str) -> ValueSource {
    match numbers::<f64>(text).filter(|numbers| numbers.iter().all(|number| number.is_finite())) {
        Some(numbers) => ValueSource::List(numbers),
        None => ValueSource::File(text.into()),
    }
}

fn band_of(text: &str) -> Result<Band> {
    let wrong = || Error::FlagText {
        flag: "--band",
        text: text.to_owned(),
        expected: "two frequencies in Hz, the lower one first, as in 0,1000",
    };
    match numbers::<f64>(text).ok_or_else(wrong)?[..] {
        [from_hz, to_hz] if (0.0..to_hz).contains(&from_hz) && to_hz <= 1e100 => Ok(Band { from_hz, to_hz }),
        _ => Err(wrong()),
    }
}
