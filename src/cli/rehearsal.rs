//! A child process reads HDF5 input before this one does.
//!
//! The HDF5 library parses metadata in C. On damaged metadata it can crash or run for ever, and supel cannot prevent that. So a child
//! process runs the readers on the files first. If the child crashes or does not end in time, the user gets an error that names the
//! file, and this process never opens it. Text is read by supel's own code and needs no rehearsal.

use std::io::{BufRead, Read, Write};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant};

use serde::{Deserialize, Serialize};
use supel_runtime::MatrixKind;

use super::exit_code::ExitCode;
use super::process;
use crate::error::{Error, Result};
use crate::input::{self, Allowance, MeshInput, SingleMatrix};
use crate::job::{Job, MatrixJob, ModelJob};

/// The hidden subcommand of the child.
pub(super) const SUBCOMMAND: &str = "rehearse-reading";

/// Time that any file has.
const LEAST_TIME: Duration = Duration::from_secs(120);
/// Bytes of a file that take a second more: a tenth of what the slowest disks and the strongest compression give.
const BYTES_PER_SECOND: u64 = 1 << 20;
/// How often it is asked whether the child has ended, at most.
const LONGEST_PAUSE: Duration = Duration::from_millis(20);

/// What the parent writes for the child: one line on its stdin, which stays open as long as its parent lives.
#[derive(Serialize, Deserialize)]
struct Task {
    /// None where the matrices alone are read.
    model: Option<ModelJob>,
    matrices: Vec<MatrixJob>,
    modes: Vec<PathBuf>,
    /// A mesh that is read for itself, with its cells.
    mesh: Option<PathBuf>,
    memory_bytes: Option<u64>,
}

/// What the child says on its stdout when the library has started and reading begins.
const STARTED: &[u8] = b"reading";
/// A lack of memory that the library does not tell from damage.
const NO_MEMORY: Error = Error::OutOfMemory { what: "what the HDF5 library needs to read the input" };

/// What a rehearsal has shown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rehearsed {
    /// The library reads the files to their ends.
    Sound,
    /// Nothing: there was none, or the child found an error that this process will find too.
    Nothing,
}

impl Rehearsed {
    /// The error of this process: what the library makes of a file that it has read before is not a fault of the file.
    pub(super) fn judge(self, error: Error) -> Error {
        if self == Self::Sound && error.code().starts_with("E-HDF5") { NO_MEMORY } else { error }
    }
}

/// Reads the HDF5 files of a job and of results that are read in addition to it in a child process, where there are any, in no more than
/// `memory_bytes`, and the cells of the mesh.
///
/// An error that the child finds in a file is not passed on: this process finds the same one.
///
/// # Errors
/// [`Error::Hdf5Crash`], [`Error::Hdf5Time`], [`Error::OutOfMemory`] and [`Error::RehearsalKilled`] by how the child ended;
/// [`Error::Rehearsal`] where it could not be started.
pub(super) fn rehearse(job: &Job, results: &[PathBuf], memory_bytes: Option<u64>) -> Result<Rehearsed> {
    let Some(path) = input::hdf5_file(job, results) else { return Ok(Rehearsed::Nothing) };
    let modes = job.reduction.modes_file().map(Path::to_owned).into_iter().chain(results.iter().cloned()).collect();
    let (model, matrices) = (Some(job.model.clone()), job.matrices.clone());
    rehearsed(&Task { model, matrices, modes, mesh: None, memory_bytes }, &path)
}

/// Reads one matrix in a child process, where the HDF5 library reads it.
///
/// # Errors
/// Those of [`rehearse`].
pub(super) fn rehearse_matrix(matrix: &SingleMatrix, memory_bytes: Option<u64>) -> Result<Rehearsed> {
    if !matrix.is_parsed_in_c() {
        return Ok(Rehearsed::Nothing);
    }
    let (file, layout) = (matrix.file.clone(), matrix.layout);
    let matrices = vec![MatrixJob { name: "the matrix".to_owned(), kind: MatrixKind::Damping, file, layout }];
    let task = Task { model: None, matrices, modes: Vec::new(), mesh: None, memory_bytes };
    rehearsed(&task, &matrix.path())
}

/// Reads one mesh with its cells in a child process, where the HDF5 library reads it.
///
/// # Errors
/// The errors of [`rehearse`].
pub(super) fn rehearse_mesh(path: &Path, memory_bytes: Option<u64>) -> Result<Rehearsed> {
    if !MeshInput::is_parsed_in_c(path) {
        return Ok(Rehearsed::Nothing);
    }
    let (matrices, modes, mesh) = (Vec::new(), Vec::new(), Some(path.to_owned()));
    rehearsed(&Task { model: None, matrices, modes, mesh, memory_bytes }, path)
}

fn rehearsed(task: &Task, path: &Path) -> Result<Rehearsed> {
    let failed = |source| Error::Rehearsal { source };
    let time = time_for(path);
    let mut child = std::env::current_exe().and_then(|program| start(&program)).map_err(failed)?;
    let mut stdin = child.stdin.take();
    let mut told = serde_json::to_vec(task).map_err(|error| failed(error.into()))?;
    told.push(b'\n');
    // A child that dies at once closes the pipe; how it ended says more than the broken pipe.
    let _ = stdin.as_mut().map(|stdin| stdin.write_all(&told));
    judged(&mut child, time, path)
}

fn start(program: &Path) -> std::io::Result<Child> {
    let mut command = Command::new(program);
    command.arg(SUBCOMMAND).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::null());
    command.spawn()
}

fn time_for(path: &Path) -> Duration {
    let bytes = std::fs::metadata(path).map_or(0, |file| file.len());
    LEAST_TIME + Duration::from_secs(bytes / BYTES_PER_SECOND)
}

/// How the child ended; none where it had to be killed.
fn end_within(time: Duration, child: &mut Child) -> std::io::Result<Option<ExitStatus>> {
    let start = Instant::now();
    let mut pause = Duration::from_millis(1);
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(Some(status));
        }
        if start.elapsed() >= time {
            child.kill()?;
            return child.wait().map(|_| None);
        }
        std::thread::sleep(pause);
        pause = (2 * pause).min(LONGEST_PAUSE);
    }
}

/// Tells memory, a crash, a signal from outside and a reading without end apart.
fn judged(child: &mut Child, time: Duration, path: &Path) -> Result<Rehearsed> {
    let ended = end_within(time, child).map_err(|source| Error::Rehearsal { source })?;
    let path = path.to_owned();
    let Some(status) = ended else { return Err(Error::Hdf5Time { path, seconds: time.as_secs() }) };
    match status.code() {
        Some(0) => Ok(Rehearsed::Sound),
        Some(code) if code == ExitCode::Resources as i32 => {
            Err(Error::OutOfMemory { what: "what the HDF5 input holds" })
        }
        Some(_) => Ok(Rehearsed::Nothing),
        None => Err(match signal_from_outside(status) {
            Some(signal) => Error::RehearsalKilled { path, signal },
            None if has_started(child) => Error::Hdf5Crash { path },
            // It has not seen the file: without memory the library recurses until its stack ends.
            None => NO_MEMORY,
        }),
    }
}

/// Whether a child that has ended had begun to read.
fn has_started(child: &mut Child) -> bool {
    let mut said = Vec::new();
    child.stdout.take().is_some_and(|mut stdout| stdout.read_to_end(&mut said).is_ok()) && said.starts_with(STARTED)
}

/// The signal that ended a process, unless it is one that a process brings on itself.
#[cfg(unix)]
fn signal_from_outside(status: ExitStatus) -> Option<i32> {
    use std::os::unix::process::ExitStatusExt;
    const OWN: [i32; 7] =
        [libc::SIGSEGV, libc::SIGBUS, libc::SIGABRT, libc::SIGFPE, libc::SIGILL, libc::SIGTRAP, libc::SIGSYS];
    status.signal().filter(|signal| !OWN.contains(signal))
}

#[cfg(not(unix))]
fn signal_from_outside(_: ExitStatus) -> Option<i32> {
    None
}

/// What the child does: reads the HDF5 files of the model that comes through stdin, forgets them, and ends with its parent.
///
/// # Errors
/// [`Error::Rehearsal`] where no model comes; [`Error::OutOfMemory`]. What else is wrong with the files, the parent finds itself.
pub(super) fn read_from_stdin() -> Result<ExitCode> {
    let failed = |source| Error::Rehearsal { source };
    let mut line = String::new();
    std::io::stdin().lock().read_line(&mut line).map_err(failed)?;
    let task: Task = serde_json::from_str(&line).map_err(|error| failed(error.into()))?;
    process::end_with_parent()?;
    let threads = process::threads(2)?;
    input::start_hdf5()?;
    let mut stdout = std::io::stdout();
    stdout.write_all(STARTED).and_then(|()| stdout.flush()).map_err(failed)?;
    let files = (task.model.as_ref(), task.matrices.as_slice(), task.modes.as_slice());
    let allowance = Allowance::of(task.memory_bytes);
    let read = || match &task.mesh {
        Some(path) => MeshInput::read(path, &allowance).map(drop),
        None => input::read_hdf5_parts(files, &allowance),
    };
    match threads.install(read) {
        Ok(()) => Ok(ExitCode::Done),
        Err(error @ Error::OutOfMemory { .. }) => Err(error),
        Err(_) => Ok(ExitCode::InputData),
    }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;

    fn judged_after(script: &str) -> std::result::Result<Rehearsed, &'static str> {
        let script = format!("ulimit -c 0; {script}");
        let mut child = Command::new("sh").args(["-c", &script]).stdout(Stdio::piped()).spawn().expect("a shell");
        judged(&mut child, Duration::from_secs(600), Path::new("a.h5")).map_err(|error| error.code())
    }

    #[test]
    fn how_the_child_ended_tells_what_was_wrong() {
        assert_eq!(judged_after("exit 0"), Ok(Rehearsed::Sound));
        assert_eq!(judged_after("exit 3"), Ok(Rehearsed::Nothing), "this process finds the same error");
        assert_eq!(judged_after("exit 6"), Err("E-OUT-OF-MEMORY"));
        for own in ["SEGV", "BUS", "ABRT"] {
            assert_eq!(judged_after(&format!("printf reading; kill -{own} $$")), Err("E-HDF5-CRASH"));
            assert_eq!(judged_after(&format!("kill -{own} $$")), Err("E-OUT-OF-MEMORY"), "before it saw the file");
        }
        for from_outside in ["KILL", "TERM"] {
            assert_eq!(judged_after(&format!("printf reading; kill -{from_outside} $$")), Err("E-CHILD-KILLED"));
        }
    }

    #[test]
    fn a_child_that_does_not_end_is_killed() {
        let mut child = Command::new("sleep").arg("600").spawn().expect("started");
        let error = judged(&mut child, Duration::from_millis(50), Path::new("a.h5")).expect_err("no end");
        assert_eq!((error.code(), error.class() as u8), ("E-HDF5-TIME", 3));
    }

    #[test]
    fn what_was_read_before_is_not_damaged() {
        let damaged = || Error::Hdf5Open { path: "a.h5".into(), reason: String::new() };
        assert_eq!(Rehearsed::Sound.judge(damaged()).code(), "E-OUT-OF-MEMORY");
        assert_eq!(Rehearsed::Nothing.judge(damaged()).code(), "E-HDF5-OPEN");
        assert_eq!(Rehearsed::Sound.judge(Error::NoMass).code(), "E-NO-MASS");
    }
}
