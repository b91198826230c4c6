//! `supel certify`: eigenpairs or a superelement of another program, held against the matrices of their model.

use std::path::PathBuf;

use supel_runtime::MatrixKind;

use super::answer::{Program, Terminal};
use super::certify_command::CertifyCommand;
use super::exit_code::ExitCode;
use super::judging::{Answer, Strictness};
use super::outputs::{Outputs, refuse_unwritable};
use super::overwriting::{self, Named, OwnFiles};
use super::pipeline::Pipeline;
use super::progress::StageLine;
use super::rehearsal::{self, Rehearsed};
use super::unmet::unmet;
use super::{memory, process};
use crate::certification::{PairFiles, ReducedFiles, ResultFiles};
use crate::error::Result;
use crate::input::{self, ValueSource};
use crate::job::{Job, MatrixJob};
use crate::memory_forecast::Resources;
use crate::verification::check::Verdict;

pub(super) fn run(command: &CertifyCommand, pipeline: Pipeline, terminal: &mut Terminal<'_>) -> Result<ExitCode> {
    let job = &command.subject.job;
    let (results, matrices) = result_files(&command.files);
    let mut inputs = overwriting::inputs(job, None);
    let of_matrices = matrices.iter().map(|matrix| &matrix.file);
    inputs.extend(results.iter().chain(of_matrices).map(|path| ("the result", input::file_of(path))));
    let own = OwnFiles::of(&inputs, &outputs(command))?;
    refuse_unwritable(&own)?;
    let resources = Resources { memory_bytes: memory::available_bytes(), cache: None };
    let rehearsed = match terminal.program {
        Program::Supel => {
            let job = Job { matrices, ..job.clone() };
            rehearsal::rehearse(&job, &results, resources.allowed(&job))?
        }
        Program::Other => Rehearsed::Nothing,
    };
    if command.answer != Answer::Nothing {
        terminal.tell_threads(command.subject.threads);
    }
    let threads = process::threads(command.subject.threads.used)?;
    let mut stage_line = StageLine::new(terminal.progress);
    let certify = || (pipeline.certify)(job, &command.files, command.band, (resources, &mut stage_line));
    let report = threads.install(certify).map_err(|error| rehearsed.judge(error))?;
    drop(stage_line);
    let reservations = command.strictness.reservations();
    let mut staged = Outputs::new(&own);
    let html = command.html.iter().map(|path| (path, report.to_html(reservations)));
    let junit = command.junit.iter().map(|path| (path, report.to_junit(reservations)));
    for (path, text) in html.chain(junit) {
        staged.stage(path, text.as_bytes())?;
    }
    let answer = match command.answer {
        Answer::Text => Some(report.to_text(reservations, terminal.paint)),
        Answer::Json => Some(report.to_json()?),
        Answer::Nothing => None,
    };
    staged.commit()?;
    answer.iter().for_each(|answer| terminal.answer(answer));
    if command.answer == Answer::Nothing {
        let lines = unmet(report.checks(), &report.model().warnings, command.strictness);
        lines.iter().for_each(|line| terminal.complain(line));
    }
    Ok(match (report.verdict(), command.strictness) {
        (Verdict::Info | Verdict::Pass, _) | (Verdict::Warn, Strictness::Normal) => ExitCode::Done,
        (Verdict::Warn, Strictness::Strict) | (Verdict::Fail, _) => ExitCode::CheckFailed,
    })
}

/// The files of the result: those of columns, and matrices.
fn result_files(files: &ResultFiles) -> (Vec<PathBuf>, Vec<MatrixJob>) {
    match files {
        ResultFiles::Pairs(PairFiles { shapes, values }) => {
            let values = match values {
                Some((_, ValueSource::File(path))) => Some(path.clone()),
                Some((_, ValueSource::List(_))) | None => None,
            };
            (std::iter::once(shapes.clone()).chain(values).collect(), Vec::new())
        }
        ResultFiles::Superelement(ReducedFiles { basis, stiffness, mass }) => {
            let matrix = |(name, file): (&str, &PathBuf)| MatrixJob {
                name: name.to_owned(),
                file: file.clone(),
                kind: MatrixKind::Other,
                layout: None,
            };
            (vec![basis.clone()], [("stiffness", stiffness), ("mass", mass)].map(matrix).into())
        }
    }
}

fn outputs(command: &CertifyCommand) -> Vec<Named> {
    let files = [("--html", &command.html), ("--junit", &command.junit)];
    files.into_iter().filter_map(|(key, path)| Some((key, path.clone()?))).collect()
}
