//! One of many jobs, run as it would run alone: by a process of its own where the program can start one.
//!
//! A process of its own has nothing to do with the others: not their memory, not their libraries in C, and what ends it ends nothing else.

use std::ffi::OsString;
use std::process::{Command, Stdio};

use super::answer::{Program, Terminal};
use super::exit_code::ExitCode;
use super::pipeline::Pipeline;

/// What a run left behind.
pub(super) struct Ended {
    /// The exit code; none where a signal ended it, or where it could not be started.
    pub(super) code: Option<ExitCode>,
    /// Its answer: a report, or the document of an error.
    pub(super) answer: serde_json::Value,
    /// Its lines on stderr.
    pub(super) said: String,
    /// Why there is no exit code.
    pub(super) cause: String,
}

impl Ended {
    pub(super) fn without_code(cause: String) -> Self {
        Self { code: None, answer: serde_json::Value::Null, said: String::new(), cause }
    }
}

/// Runs a command line, the program's name first, in this process.
pub(super) type RunLine = fn(Vec<OsString>, Pipeline, &mut Terminal<'_>) -> ExitCode;

/// Runs the command line of these words, without the program's name.
pub(super) fn run(program: Program, words: &[OsString], here: (Pipeline, RunLine)) -> Ended {
    match program {
        Program::Supel => in_process_of_its_own(words),
        Program::Other => in_this_process(words, here),
    }
}

fn in_process_of_its_own(words: &[OsString]) -> Ended {
    let started = std::env::current_exe().and_then(|program| {
        let mut command = Command::new(program);
        command.args(words).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn()
    });
    let mut child = match started {
        Ok(child) => child,
        Err(error) => return Ended::without_code(format!("it cannot be started: {error}")),
    };
    // Open as long as this process lives: a job does not outlive the run that it belongs to.
    let stdin = child.stdin.take();
    let output = match child.wait_with_output() {
        Ok(output) => output,
        Err(error) => return Ended::without_code(format!("it cannot be waited for: {error}")),
    };
    drop(stdin);
    Ended {
        code: output.status.code().map(ExitCode::of_process),
        answer: serde_json::from_slice(&output.stdout).unwrap_or_default(),
        said: String::from_utf8_lossy(&output.stderr).into_owned(),
        cause: output.status.to_string(),
    }
}

/// For a program that calls this library: there is no program to start.
fn in_this_process(words: &[OsString], (pipeline, run): (Pipeline, RunLine)) -> Ended {
    let (mut out, mut err) = (Vec::new(), Vec::new());
    let words = std::iter::once(OsString::from("supel")).chain(words.iter().cloned());
    let code = run(words.collect(), pipeline, &mut Terminal::plain(&mut out, &mut err));
    Ended {
        code: Some(code),
        answer: serde_json::from_slice(&out).unwrap_or_default(),
        said: String::from_utf8_lossy(&err).into_owned(),
        cause: String::new(),
    }
}
